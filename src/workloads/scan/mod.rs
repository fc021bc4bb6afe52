//! Exclusive prefix sums of 32-bit words, a primitive of workloads: each word becomes the sum of the words before it.
//!
//! Levels of groups of [`GROUP_ELEMENTS`] words: each level but the top is reduced to one sum a group, which is the
//! next level (n, n / 512, n / 512^2 words, ..). The top level is one group. Then every level from the top down is
//! scanned group by group, on top of the sums before its groups. That reads the words twice and writes them once
//! (Dotsenko et al. 2008, Merrill and Grimshaw 2009); inside a group it is Blelloch's work-efficient sweep up and down.

pub mod exclusive;
mod gpu;
mod kernels;
pub mod reduce;

pub use gpu::{Job, Scan};
pub use kernels::kernels;

use crate::error::{Error, Result};

/// Words of a group.
pub const GROUP_ELEMENTS: u32 = 512;

/// Invocations of a group.
pub const GROUP_SIZE: u32 = 64;

/// How a device scans.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Options {
    /// Sums over a group by operations of subgroups instead of sweeps in work-group memory.
    pub subgroups: bool,
}

/// The lengths of all levels, from the values to the top, which is at most [`GROUP_ELEMENTS`] long.
fn levels(length: u32) -> Vec<u32> {
    let next = |&length: &u32| (length > GROUP_ELEMENTS).then(|| length.div_ceil(GROUP_ELEMENTS));
    std::iter::successors(Some(length), next).collect()
}

/// The sum of the words before each word, and the sum of all.
///
/// # Errors
/// [`Error::Refused`] if the sum of all is 2^32 or more.
pub fn exclusive(values: &[u32]) -> Result<(Vec<u32>, u32)> {
    let (mut level, mut wrapped) = (values.to_vec(), false);
    let mut below = Vec::new();
    while level.len() > GROUP_ELEMENTS as usize {
        let (sums, sums_wrap) = reduce::sums(&level);
        wrapped |= sums_wrap;
        below.push(std::mem::replace(&mut level, sums));
    }
    let (total, total_wraps) = exclusive::scan_top(&mut level);
    while let Some(mut lower) = below.pop() {
        exclusive::scan_groups(&mut lower, &level);
        level = lower;
    }
    Ok((level, checked(total, wrapped || total_wraps)?))
}

fn checked(total: u32, wrapped: bool) -> Result<u32> {
    if wrapped {
        let hint = "use a smaller input";
        return Err(Error::too_large("a prefix sum", "its total is 2^32 or more, a word holds 2^32 - 1", hint));
    }
    Ok(total)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_is_a_512th_of_the_one_below() {
        for (length, expected) in [
            (0, vec![0]),
            (1, vec![1]),
            (512, vec![512]),
            (513, vec![513, 2]),
            (1 << 18, vec![1 << 18, 512]),
            ((1 << 18) + 1, vec![(1 << 18) + 1, 513, 2]),
            (1 << 23, vec![1 << 23, 16_384, 32]),
            (u32::MAX, vec![u32::MAX, 1 << 23, 16_384, 32]),
        ] {
            assert_eq!(levels(length), expected);
        }
    }
}
