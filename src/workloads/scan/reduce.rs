//! Sums of groups of words. Twin of `kernels/scan/reduce.wgsl`.

use super::GROUP_ELEMENTS;
use rayon::prelude::*;

/// The sum of each group of words modulo 2^32, and whether one of them is 2^32 or more.
pub fn sums(values: &[u32]) -> (Vec<u32>, bool) {
    let groups = values.par_chunks(GROUP_ELEMENTS as usize);
    let sums: Vec<(u32, bool)> = groups.map(sum).collect();
    (sums.iter().map(|&(sum, _)| sum).collect(), sums.iter().any(|&(_, wraps)| wraps))
}

/// The sum of words modulo 2^32, and whether it is 2^32 or more.
pub fn sum(values: &[u32]) -> (u32, bool) {
    values.iter().fold((0, false), |(sum, wrapped), &value| {
        let (sum, wraps) = u32::overflowing_add(sum, value);
        (sum, wrapped || wraps)
    })
}
