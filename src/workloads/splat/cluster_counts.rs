//! What frames with clusters consist of, over all frames of a path.

use super::clusters::layout::{KeyLayout, LEVELS};
use super::clusters::setting::{BoundsBy, HierarchyBy};
use super::clusters::{Clusters, NONE};
use super::count::digits;
use super::directions::DIRECTIONS;
use super::gathering::Gathering;
use super::splatting::counts::Walked;
use super::splatting::setting::Gather;
use crate::record::row::Metric;
use crate::record::statistics::round;

/// Upper ends of the histogram of photons in a cluster, with the names of its bins.
const BINS: [(u32, &str); 9] = [
    (0, "photons-0"),
    (9, "photons-1-9"),
    (31, "photons-10-31"),
    (99, "photons-32-99"),
    (315, "photons-100-315"),
    (999, "photons-316-999"),
    (3161, "photons-1000-3161"),
    (9999, "photons-3162-9999"),
    (u32::MAX, "photons-10000-"),
];

/// Six coordinates of a box.
const BOX_WORDS: u64 = 6;

/// The work of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameCounts {
    /// Clusters.
    pub clusters: u64,
    /// Clusters, or nodes of the level that has the buckets, that photons are walked to.
    pub targets: u64,
    /// Pairs of a photon and a cluster that it touches.
    pub assignments: u64,
    /// Most photons of a cluster.
    pub fullest: u64,
    /// Boxes that photons are tested against, in one walk.
    pub box_tests: u64,
    /// Pairs of a sample and a photon of its cluster.
    pub evaluations: u64,
    /// Pixels with a sample.
    pub samples: u64,
    /// Nodes with children, by level.
    pub nodes: [u64; LEVELS as usize],
    /// Clusters by their number of photons, as in [`BINS`].
    pub histogram: [u64; BINS.len()],
}

impl FrameCounts {
    /// Counts a frame. Photons are walked to clusters, or to the nodes of the level that has the buckets; `target` is
    /// the index of the one that a cluster's samples read.
    pub fn new(
        clusters: &Clusters,
        layout: &KeyLayout,
        Walked { box_tests, per_cluster, .. }: &Walked,
        target: impl Fn(u32) -> usize,
    ) -> FrameCounts {
        let box_tests = *box_tests;
        let mut counts = FrameCounts { clusters: clusters.cluster_keys.len() as u64, box_tests, ..Default::default() };
        // Of the nodes of a level many do not exist
        let mut targets: Vec<usize> = (0..clusters.cluster_keys.len() as u32).map(&target).collect();
        targets.sort_unstable();
        targets.dedup();
        for photons in targets.into_iter().filter_map(|target| per_cluster.get(target).copied()) {
            counts.assignments += u64::from(photons);
            counts.targets += 1;
            counts.fullest = counts.fullest.max(photons.into());
            let bin = BINS.iter().position(|(most, _)| photons <= *most).unwrap_or(BINS.len() - 1);
            counts.histogram[bin] += 1;
        }
        for &identifier in clusters.identifiers.iter().filter(|identifier| **identifier != NONE) {
            counts.samples += 1;
            counts.evaluations += u64::from(per_cluster.get(target(identifier)).copied().unwrap_or(0));
        }
        if let Some(nodes) = &clusters.nodes {
            for level in 0..LEVELS {
                let [begin, end] = [level, level + 1].map(|level| layout.level_offset(level) as usize);
                let masks = nodes.masks.get(begin..end).unwrap_or_default();
                counts.nodes[level as usize] = masks.iter().filter(|mask| **mask != 0).count() as u64;
            }
        }
        counts
    }
}

/// Metrics of frames: means and maxima, each frame, nodes by level, and the histogram of the first frame.
pub fn metrics(frames: &[FrameCounts], gathering: &Gathering) -> Vec<Metric> {
    let Some(first) = frames.first() else { return Vec::new() };
    let mean = |of: &dyn Fn(&FrameCounts) -> u64| {
        digits(frames.iter().map(|frame| of(frame) as f64).sum::<f64>() / frames.len() as f64)
    };
    let most = |of: &dyn Fn(&FrameCounts) -> u64| frames.iter().map(of).max().unwrap_or(0);
    let empty: u64 = frames.iter().map(|frame| frame.histogram[0]).sum();
    let targets: u64 = frames.iter().map(|frame| frame.targets).sum();
    let in_global_memory = gathering.clusters.bounds == BoundsBy::Direct;
    let atomics = |frame: &FrameCounts| BOX_WORDS * frame.samples;
    let mut metrics = vec![
        Metric::new("clusters_mean", mean(&|frame| frame.clusters)),
        Metric::new("clusters_max", most(&|frame| frame.clusters)),
        Metric::new("assignments_mean", mean(&|frame| frame.assignments)),
        Metric::new("assignments_max", most(&|frame| frame.assignments)),
        Metric::new("fullest_cluster", most(&|frame| frame.fullest)),
        Metric::new("fullest_cluster_mean", mean(&|frame| frame.fullest)),
        Metric::new("box_tests_mean", mean(&|frame| frame.box_tests)),
        Metric::new("atomics_bounds_mean", if in_global_memory { mean(&atomics) } else { 0.0 }),
        Metric::new("local_atomics_bounds_mean", if in_global_memory { 0.0 } else { mean(&atomics) }),
        Metric::new("empty_cluster_pct", round(100.0 * empty as f64 / targets.max(1) as f64, 4)),
    ];
    match gathering.gather {
        Gather::Buckets(_) => {
            metrics.push(Metric::new("bucket_directions_mean", mean(&|frame| u64::from(DIRECTIONS) * frame.samples)));
        }
        _ => metrics.push(Metric::new("photon_evaluations_mean", mean(&|frame| frame.evaluations))),
    }
    if gathering.clusters.hierarchy == HierarchyBy::Masks {
        metrics.push(Metric::new("inner_nodes_mean", mean(&|frame| frame.nodes.iter().sum())));
        for level in 0..LEVELS as usize {
            metrics.push(Metric::of(&format!("level-{level}"), "nodes", mean(&|frame| frame.nodes[level])));
        }
    }
    for (number, frame) in (1..).zip(frames) {
        let of = format!("frame-{number}");
        metrics.push(Metric::of(&of, "clusters", frame.clusters));
        metrics.push(Metric::of(&of, "assignments", frame.assignments));
        metrics.push(Metric::of(&of, "fullest", frame.fullest));
        metrics.push(Metric::of(&of, "box_tests", frame.box_tests));
        metrics.push(Metric::of(&of, "evaluations", frame.evaluations));
    }
    for ((_, name), count) in BINS.iter().zip(first.histogram) {
        metrics.push(Metric::of(name, "clusters", count));
    }
    metrics
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workloads::splat::technique::Technique;

    #[test]
    fn every_cluster_is_in_a_bin_and_every_sample_counts_its_photons() {
        let clusters =
            Clusters { identifiers: vec![0, 0, 2, NONE, 1], cluster_keys: vec![7, 8, 9], ..Clusters::default() };
        let gathering = Gathering::from(Technique::default().estimate(1.0));
        let size = crate::workloads::size::Size { width: 5, height: 1 };
        let layout = KeyLayout::new(&gathering.clusters, size, 60.0, (1.0, 1e4)).unwrap();
        let walked = Walked { box_tests: 123, per_cluster: vec![10, 0, 40_000], ..Walked::default() };
        let counts = FrameCounts::new(&clusters, &layout, &walked, |identifier| identifier as usize);
        assert_eq!((counts.assignments, counts.fullest, counts.samples), (40_010, 40_000, 4));
        assert_eq!(counts.evaluations, 10 + 10 + 40_000);
        assert_eq!(counts.histogram, [1, 0, 1, 0, 0, 0, 0, 0, 1]);
        let metrics = metrics(&[counts.clone(), counts], &gathering);
        let of = |name: &str| metrics.iter().find(|metric| metric.name == name).map(|metric| metric.value.clone());
        assert_eq!(of("empty_cluster_pct"), Some(Metric::new("", 33.3333).value));
        assert_eq!(of("atomics_bounds_mean"), Some(Metric::new("", 24.0).value));
    }
}
