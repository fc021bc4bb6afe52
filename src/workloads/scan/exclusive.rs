//! The exclusive scan of each group of words, on top of what lies before the group. Twin of
//! `kernels/scan/exclusive.wgsl`.

use super::{GROUP_ELEMENTS, reduce};
use rayon::prelude::*;

/// Scans every group; `before` has the sum of the words before each of them.
pub fn scan_groups(values: &mut [u32], before: &[u32]) {
    values.par_chunks_mut(GROUP_ELEMENTS as usize).zip(before).for_each(|(group, &before)| scan(group, before));
}

/// Scans the level of one group. Returns the sum of all words modulo 2^32, and whether it is 2^32 or more.
pub fn scan_top(values: &mut [u32]) -> (u32, bool) {
    let total = reduce::sum(values);
    scan(values, 0);
    total
}

fn scan(group: &mut [u32], before: u32) {
    let mut running = before;
    for value in group {
        running = running.wrapping_add(std::mem::replace(value, running));
    }
}
