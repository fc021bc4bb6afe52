//! The pixels at which references are computed.

use super::random::mix;
use crate::workloads::size::Size;

/// `wanted` different pixels of an image in ascending order, or all of them if there are fewer. Rows from the top are
/// cut into that many runs of equal length, up to a pixel; each run gives one pixel, chosen by a hash of its number.
pub fn fixed_pixels(size: Size, wanted: u32) -> Vec<u32> {
    let pixels = size.pixels() as u64;
    let runs = u64::from(wanted).min(pixels);
    let first = |run: u64| run * pixels / runs;
    let pixel = |run: u64| (first(run) + mix(run) % (first(run + 1) - first(run))) as u32;
    (0..runs).map(pixel).collect()
}
