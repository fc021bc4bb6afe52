//! What cases demand of a machine, before anything is read or opened.

use super::backend::CountedPixel;
use super::case::TraceCase;
use crate::device::Features;
use crate::harness::workload::{Case, Library};
use crate::scene::catalogue;
use std::collections::BTreeSet;

/// One line for the device's features, its largest image buffer, and the scenes of the catalogue.
pub fn of(cases: &[Case], library: &Library) -> Vec<String> {
    let parsed: Vec<TraceCase> = cases.iter().filter_map(|case| TraceCase::parse(case).ok()).collect();
    let mut needs = Vec::new();
    let features = parsed.iter().map(|case| case.selection.method().traversal.needs);
    let features: Features = features.flat_map(|features| features.iter().collect::<Vec<_>>()).collect();
    if !features.is_empty() {
        let names: Vec<String> = features.iter().map(|feature| format!("{feature:?}")).collect();
        needs.push(format!("a device with {}", names.join(", ")));
    }
    if let Some(pixels) = parsed.iter().map(|case| case.size.pixels()).max() {
        let mib = (pixels * size_of::<CountedPixel>()) as f64 / f64::from(1 << 20);
        needs.push(format!("{mib:.1} MiB of main memory for the largest image with its counters"));
    }
    let names: BTreeSet<&str> = cases.iter().map(|case| case.input.split(':').next().unwrap_or_default()).collect();
    let entries = names.into_iter().filter_map(catalogue::find);
    let scenes: Vec<String> = entries.map(|entry| format!("{} ({} triangles)", entry.name, entry.triangles)).collect();
    if !scenes.is_empty() {
        let folder = library.scenes_folder.as_ref().map_or("a folder of scenes".into(), |f| f.display().to_string());
        needs.push(format!("the catalogue's {} in {folder}", scenes.join(", ")));
    }
    needs
}
