//! The axes of a row: what was computed (conditions), how (options), and which rows differ in one of them alone.

use crate::record::row::Key;
use std::collections::BTreeMap;

/// Values by axis. An axis without effect is empty.
pub type Axes = BTreeMap<String, String>;

/// Axes that say what is computed. All others, but the technique, are options: how it is computed, or a variant of it.
pub const CONDITIONS: [&str; 8] =
    ["technique", "resolution", "tile", "radius", "paths", "frames", "camera_path", "light"];

/// The technique, its options, and the capacity of lists, which it alone may have.
pub const OF_TECHNIQUE: [&str; 11] =
    ["technique", "kernel", "weight", "form", "order", "tasks", "atomics", "share", "blur", "level", "capacity"];

/// What options are where nothing is said, which decides between values that equally many rows have.
pub const DEFAULTS: [(&str, &str); 22] = [
    ("kernel", "epanechnikov"),
    ("weight", "side"),
    ("form", "normalised"),
    ("order", "any"),
    ("tasks", "sample"),
    ("atomics", "fixed"),
    ("share", "all"),
    ("blur", "0"),
    ("level", "5"),
    ("key", "morton"),
    ("normals", "off"),
    ("unique", "flags"),
    ("bounds", "direct"),
    ("hierarchy", "masks"),
    ("space", "view"),
    ("capacity", "33554432"),
    ("sync", "device"),
    ("hits", "4"),
    ("seed", "1"),
    ("falloff", "square"),
    ("energy", "flux"),
    ("structure", "bvh-stack"),
];

/// Reads a key. The scene is no axis here; a row that was recorded before there were forms has the normalised one.
pub fn of(key: &Key) -> Axes {
    let mut axes = key.axes.clone();
    axes.remove("scene");
    axes.entry("form".into()).or_insert_with(|| "normalised".into());
    axes
}

/// The value of an axis; empty where it is absent or without effect.
pub fn value<'a>(axes: &'a Axes, axis: &str) -> &'a str {
    axes.get(axis).map_or("", String::as_str)
}

/// The axes in which two rows differ.
pub fn differing<'a>(a: &'a Axes, b: &'a Axes) -> Vec<&'a str> {
    let names = a.keys().chain(b.keys().filter(|name| !a.contains_key(*name))).map(String::as_str);
    names.filter(|name| value(a, name) != value(b, name)).collect()
}

/// True if two rows are equal in all axes but these.
pub fn same_but(a: &Axes, b: &Axes, but: &[&str]) -> bool {
    differing(a, b).iter().all(|axis| but.contains(axis))
}

/// The value of each option that most of these rows have; of equals the default one, then the first.
pub fn usual<'a>(rows: impl Iterator<Item = &'a Axes>) -> Axes {
    let mut counts: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    for axes in rows {
        for (axis, value) in axes.iter().filter(|(axis, value)| is_option(axis) && !value.is_empty()) {
            *counts.entry((axis, value)).or_default() += 1;
        }
    }
    let mut usual: BTreeMap<&str, ((usize, bool), &str)> = BTreeMap::new();
    for ((axis, value), count) in counts {
        let rank = (count, DEFAULTS.contains(&(axis, value)));
        if usual.get(axis).is_none_or(|(best, _)| rank > *best) {
            usual.insert(axis, (rank, value));
        }
    }
    usual.into_iter().map(|(axis, (_, value))| (axis.to_owned(), value.to_owned())).collect()
}

/// True for an option.
pub fn is_option(axis: &str) -> bool {
    !CONDITIONS.contains(&axis)
}

/// The options of a row that are not the usual ones. An empty value is no option.
pub fn unusual<'a>(axes: &'a Axes, usual: &Axes) -> Vec<(&'a str, &'a str)> {
    let pairs = axes.iter().map(|(axis, value)| (axis.as_str(), value.as_str()));
    pairs.filter(|(axis, value)| is_option(axis) && !value.is_empty() && self::value(usual, axis) != *value).collect()
}
