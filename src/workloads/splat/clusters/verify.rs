//! Clusters of a device against the twins: each stage is computed again from what the device made of the stages before.

use super::setting::{ClusterSetting, HierarchyBy};
use super::unique::{self, Numbered};
use super::{Bounds, Clusters, KeyLayout, NONE, Nodes, Placement, bounds, hierarchy, keys};
use crate::record::row::{Check, Metric};
use crate::workloads::splat::samples::Samples;
use crate::workloads::splat::verify::{Exactness, SHARE, same};
use glam::Vec4;
use rayon::ThreadPool;
use std::fmt::Debug;

/// Where a device rounds differently, positions may be off by this share of the largest coordinate.
pub const CLOSE: f32 = 1e-5;

/// Compares clusters with the twins; the threads are those of `pool`.
pub fn check(
    pool: &ThreadPool,
    found: &Clusters,
    samples: &Samples,
    (setting, layout, placement): (&ClusterSetting, &KeyLayout, &Placement),
    field_of_view: f32,
    exactness: Exactness,
) -> Vec<Check> {
    let borders = layout.borders(field_of_view);
    let (positions, own_keys) = pool.install(|| keys::of(setting.normals, layout, placement, &borders, samples));
    let mut checks = vec![match exactness {
        Exactness::Bits => same("positions along the axes", "the twin's", &found.positions, &positions, 0),
        Exactness::Close => near(&found.positions, &positions),
    }];
    // The border between two normals' cells may be elsewhere, that of slices may not: depths are given
    let most = if exactness == Exactness::Close { (own_keys.len() / SHARE).max(1) } else { 0 };
    checks.push(equal("keys", &found.keys, &own_keys, most));
    // What is no key of the layout cannot be numbered
    let possible = |key: u32| if key >> layout.key_bits() == 0 { key } else { NONE };
    let given: Vec<u32> = found.keys.iter().map(|&key| possible(key)).collect();
    let Numbered { identifiers, cluster_keys } = pool.install(|| unique::number(setting.unique, layout, &given));
    checks.push(equal("keys of clusters", &found.cluster_keys, &cluster_keys, 0));
    checks.push(equal("identifiers", &found.identifiers, &identifiers, 0));
    let boxes = bounds::boxes(found.boxes.len(), &found.positions, &found.identifiers);
    checks.push(equal("boxes of clusters", &words(&found.boxes), &words(&boxes), 0));
    let complete = found.boxes.len() == found.cluster_keys.len();
    let message = format!("{} clusters have {} boxes", found.cluster_keys.len(), found.boxes.len());
    checks.push(Check { ok: complete, message, metrics: Vec::new() });
    checks.extend(nodes(found, setting.hierarchy, layout));
    checks
}

/// Masks and boxes of nodes, from keys and boxes of clusters.
fn nodes(found: &Clusters, by: HierarchyBy, layout: &KeyLayout) -> Vec<Check> {
    let of_layout = |(key, _): &(&u32, &Bounds)| *key >> layout.key_bits() == 0;
    match (&found.nodes, by) {
        (None, HierarchyBy::None) => Vec::new(),
        (Some(Nodes { masks, boxes }), HierarchyBy::Masks) => {
            let (keys, own): (Vec<u32>, Vec<Bounds>) =
                found.cluster_keys.iter().zip(&found.boxes).filter(of_layout).unzip();
            let expected = hierarchy::nodes(layout, &keys, &own);
            vec![
                equal("masks of nodes", masks, &expected.masks, 0),
                equal("boxes of nodes", &words(boxes), &words(&expected.boxes), 0),
            ]
        }
        (nodes, _) => {
            let message = format!("nodes exist: {}, the hierarchy is {by:?}", nodes.is_some());
            vec![Check { ok: false, message, metrics: Vec::new() }]
        }
    }
}

fn words(boxes: &[Bounds]) -> Vec<[u32; 6]> {
    boxes.iter().map(Bounds::words).collect()
}

/// Two arrays, of whose elements at most so many may differ.
fn equal<T: PartialEq + Debug>(what: &str, found: &[T], expected: &[T], most: usize) -> Check {
    let differs = |index: &usize| found[*index] != expected[*index];
    let length = found.len().min(expected.len());
    let differing = (0..length).filter(differs).count() + found.len().abs_diff(expected.len());
    let message = match (0..length).find(differs) {
        None if differing == 0 => format!("{what}: all {length} are the twin's"),
        None => format!("{what}: there are {} instead of {}", found.len(), expected.len()),
        Some(at) => {
            let (is, should) = (&found[at], &expected[at]);
            format!(
                "{what}: {differing} of {length} differ (at most {most}); the first is {at}: {is:?}, not {should:?}"
            )
        }
    };
    Check { ok: differing <= most, message, metrics: vec![Metric::new("differing", differing)] }
}

/// Positions where a device rounds differently.
fn near(found: &[Vec4], expected: &[Vec4]) -> Check {
    let largest = expected.iter().map(|v| v.abs().max_element()).fold(0.0, f32::max);
    let off = |(a, b): (&Vec4, &Vec4)| !((*a - *b).abs().max_element() <= largest * CLOSE);
    let differing = found.iter().zip(expected).filter(|&pair| off(pair)).count() + found.len().abs_diff(expected.len());
    let message = format!("positions along the axes: {differing} differ by more than {CLOSE} of the largest");
    Check { ok: differing == 0, message, metrics: vec![Metric::new("differing", differing)] }
}
