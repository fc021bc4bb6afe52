//! Pictures of clusters: photons of each as a heat map, clusters and levels of the hierarchy in false colours.

use crate::error::Result;
use crate::record::picture;
use crate::workloads::size::Size;
use crate::workloads::splat::clusters::layout::{KeyLayout, LEVELS};
use crate::workloads::splat::clusters::{Clusters, NONE};
use crate::workloads::splat::gathered::{Scenery, of_walk};
use crate::workloads::splat::gathering::Gathering;
use crate::workloads::splat::splatting::counts;
use rayon::ThreadPool;

/// A pixel without a sample.
const BLACK: [u8; 4] = [0, 0, 0, 255];

/// A colour for a number, the same every time: neighbours differ.
fn false_colour(number: u32) -> [u8; 4] {
    let mut bits = number.wrapping_mul(0x9e37_79b1) ^ 0x85eb_ca6b;
    bits ^= bits >> 15;
    bits = bits.wrapping_mul(0xc2b2_ae35);
    bits ^= bits >> 13;
    let channel = |shift: u32| 48 + (bits >> shift & 0xff) as u8 / 255 * 40 + ((bits >> shift & 0xff) * 5 / 8) as u8;
    [channel(0), channel(8), channel(16), 255]
}

/// Each pixel's number as a colour; `None` is black.
fn coloured(size: Size, number: impl Fn(usize) -> Option<u32>) -> Vec<u8> {
    (0..size.pixels()).flat_map(|pixel| number(pixel).map_or(BLACK, false_colour)).collect()
}

/// Clusters in false colours.
pub fn clusters(clusters: &Clusters, size: Size) -> Vec<u8> {
    coloured(size, |pixel| Some(clusters.identifiers[pixel]).filter(|identifier| *identifier != NONE))
}

/// Four levels of the hierarchy, from 1 (top left) to 4, in false colours: every second pixel of each.
pub fn levels(clusters: &Clusters, layout: &KeyLayout, size: Size) -> Vec<u8> {
    let (width, half) = (size.width as usize, (size.width as usize / 2, size.height as usize / 2));
    coloured(size, |pixel| {
        let (x, y) = (pixel % width, pixel / width);
        let (right, below) = (x >= half.0, y >= half.1);
        let level = 1 + u32::from(right) + 2 * u32::from(below);
        let [x, y] = [(x, half.0, size.width), (y, half.1, size.height)].map(|(at, half, side)| {
            let at = if at >= half { at - half } else { at };
            (2 * at).min(side as usize - 1)
        });
        let key = clusters.keys[y * width + x];
        (key != NONE && level < LEVELS).then(|| layout.node_of(key, level))
    })
}

/// The photons of each pixel's cluster: white for the fullest.
///
/// # Errors
/// Those of the walk.
pub fn photons(pool: &ThreadPool, gathering: &Gathering, view: &Scenery, clusters: &Clusters) -> Result<Vec<u8>> {
    let walked = of_walk(gathering, view, clusters, LEVELS, |walk| Ok(counts::walked(pool, walk, view.photons)))?;
    let most = walked.per_cluster.iter().copied().max().unwrap_or(0);
    let of = |&identifier: &u32| walked.per_cluster.get(identifier as usize).copied().unwrap_or(0);
    let values: Vec<u32> = clusters.identifiers.iter().map(of).collect();
    Ok(picture::heat_map(&values, most))
}
