//! The photons of each cluster: they are counted, the counts are added up, the lists are filled. Twin of
//! `kernels/splat/splatting/count.wgsl`, `fill.wgsl` and `order.wgsl`: its lists ascend.

use super::Lists;
use super::walk::Walk;
use crate::error::Result;
use crate::workloads::scan;
use crate::workloads::splat::photons::Photons;
use rayon::ThreadPool;
use rayon::prelude::*;

/// Photons that one thread walks with at a time.
const BAND: usize = 256;

/// The photons of each target of a walk, ascending.
///
/// # Errors
/// [`crate::Error::Refused`] for 2^32 entries or more.
pub fn lists(pool: &ThreadPool, walk: &Walk, photons: &Photons) -> Result<Lists> {
    let band = |first: usize| {
        let mut found = Vec::new();
        for photon in first..photons.len().min(first + BAND) {
            walk.photon(photons, photon, |target| found.push((target, photon as u32)));
        }
        found
    };
    let bands: Vec<Vec<(u32, u32)>> =
        pool.install(|| (0..photons.len()).into_par_iter().step_by(BAND).map(band).collect());
    let mut counts = vec![0; walk.targets() + 1];
    bands.iter().flatten().for_each(|&(target, _)| counts[target as usize] += 1);
    let (offsets, total) = scan::exclusive(&counts)?;
    let mut next = offsets.clone();
    let mut entries = vec![0; total as usize];
    for &(target, photon) in bands.iter().flatten() {
        let place = &mut next[target as usize];
        entries[*place as usize] = photon;
        *place += 1;
    }
    Ok(Lists { offsets, entries })
}

impl Lists {
    /// Lists.
    pub fn len(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// True if there is no list.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The list of a cluster, as far as its entries exist.
    pub fn of(&self, cluster: usize) -> &[u32] {
        let [first, end] = [0, 1].map(|more| (self.offsets[cluster + more] as usize).min(self.entries.len()));
        self.entries.get(first..end).unwrap_or_default()
    }
}
