//! The options of a structure: one string in a user's hand, four axes in a row.

use crate::record::row::Key;
use crate::workloads::trace::options::Axis;
use crate::workloads::trace::registry::algorithms;
use std::collections::BTreeMap;

/// Axes that hold the options of a structure, in the order of its name in full.
pub const OPTION_AXES: [&str; 4] = ["build", "traversal", "ray_options", "device_options"];

/// The options of a key that differ from the defaults, `key=value,...`, or `default`.
pub fn variant_of(key: &Key) -> String {
    let set: Vec<&str> = OPTION_AXES.iter().map(|axis| key.axis(axis)).filter(|o| !o.is_empty()).collect();
    if set.is_empty() { "default".to_owned() } else { set.join(",") }
}

/// The options of schema 1, which had them in one string, by the axis that the structure's registration gives them.
/// Options that are not registered any more are the builder's.
pub fn split_variant(structure: &str, variant: &str) -> BTreeMap<String, String> {
    let registered = algorithms().iter().find(|algorithm| algorithm.name == structure);
    let mut axes: BTreeMap<String, String> = OPTION_AXES.iter().map(|axis| (axis.to_string(), String::new())).collect();
    for option in variant.split(',').filter(|option| !option.is_empty() && *option != "default") {
        let name = option.split('=').next().unwrap_or(option);
        let info = registered.and_then(|algorithm| algorithm.options().find(|info| info.key == name));
        let options = axes.entry(info.map_or(Axis::Build, |info| info.axis).name().to_owned()).or_default();
        if !options.is_empty() {
            options.push(',');
        }
        options.push_str(option);
    }
    axes
}
