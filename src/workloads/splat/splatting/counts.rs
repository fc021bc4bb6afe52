//! The work of photons on their way to clusters, counted by the twin.

use super::walk::Walk;
use crate::workloads::splat::photons::Photons;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

/// Counts of a frame's walk.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Walked {
    /// Distances to boxes of nodes and clusters.
    pub box_tests: u64,
    /// Photons of each cluster or node.
    pub per_cluster: Vec<u32>,
    /// Pairs of photon and cluster that touch, but whose normals face away.
    pub cone_rejections: u64,
}

impl Walked {
    /// Photons of all clusters together.
    pub fn assignments(&self) -> u64 {
        self.per_cluster.iter().map(|&count| u64::from(count)).sum()
    }
}

/// Counts what the photons do.
pub fn walked(pool: &ThreadPool, walk: &Walk, photons: &Photons) -> Walked {
    let counts: Vec<AtomicU32> = (0..walk.targets()).map(|_| AtomicU32::new(0)).collect();
    let of = |photon: usize| {
        let tests = walk.photon(photons, photon, |target| {
            counts[target as usize].fetch_add(1, Ordering::Relaxed);
        });
        (tests.boxes, tests.cones)
    };
    let add = |a: (u64, u64), b: (u64, u64)| (a.0 + b.0, a.1 + b.1);
    let (box_tests, cone_rejections) =
        pool.install(|| (0..photons.len()).into_par_iter().map(of).reduce(|| (0, 0), add));
    Walked { box_tests, per_cluster: counts.into_iter().map(AtomicU32::into_inner).collect(), cone_rejections }
}
