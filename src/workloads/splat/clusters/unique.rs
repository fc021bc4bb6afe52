//! The set of keys, and an identifier for each: three ways to the same set.

use super::lookup::before;
use super::setting::Unique;
use super::{KeyLayout, NONE};
use rayon::prelude::*;

/// Clusters by their keys.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Numbered {
    /// Cluster of each pixel's sample, or [`NONE`].
    pub identifiers: Vec<u32>,
    /// Key of each cluster.
    pub cluster_keys: Vec<u32>,
}

/// Numbers the keys of an image: ascending, or with [`Unique::Sort`] tile by tile. Keys have the bits of the layout, or
/// are [`NONE`].
pub fn number(unique: Unique, layout: &KeyLayout, keys: &[u32]) -> Numbered {
    match unique {
        Unique::Flags => flags(layout, keys),
        Unique::Sort => sort(layout, keys),
        Unique::Bits => bits(layout, keys),
    }
}

/// A flag for each possible key, and their prefix sum. Twin of `kernels/splat/clusters/flag.wgsl` and
/// `kernels/splat/clusters/assign.wgsl`.
fn flags(layout: &KeyLayout, keys: &[u32]) -> Numbered {
    let mut flags = vec![0; 1 << layout.key_bits()];
    keys.iter().filter(|&&key| key != NONE).for_each(|&key| flags[key as usize] = 1);
    let (places, count) = before(flags.into_iter());
    assigned(keys, count, |key| places[key as usize])
}

/// A bit for each possible key, and the prefix sum of the words' numbers of bits. Twin of
/// `kernels/splat/clusters/bit.wgsl`, `kernels/splat/clusters/popcount.wgsl` and `kernels/splat/clusters/assign.wgsl`.
fn bits(layout: &KeyLayout, keys: &[u32]) -> Numbered {
    let mut bits = vec![0_u32; 1 << (layout.key_bits() - 5)];
    keys.iter().filter(|&&key| key != NONE).for_each(|&key| bits[key as usize >> 5] |= 1 << (key & 31));
    let (places, count) = before(bits.iter().map(|word| word.count_ones()));
    assigned(keys, count, |key| {
        let word = key as usize >> 5;
        places[word] + (bits[word] & ((1 << (key & 31)) - 1)).count_ones()
    })
}

fn assigned(keys: &[u32], count: u32, place: impl Fn(u32) -> u32 + Sync) -> Numbered {
    let of = |&key: &u32| if key == NONE { NONE } else { place(key) };
    let identifiers: Vec<u32> = keys.par_iter().map(of).collect();
    let mut cluster_keys = vec![0; count as usize];
    for (&key, &identifier) in keys.iter().zip(&identifiers).filter(|(key, _)| **key != NONE) {
        cluster_keys[identifier as usize] = key;
    }
    Numbered { identifiers, cluster_keys }
}

/// The keys of each tile in their order, numbered tile by tile. Twin of `kernels/splat/clusters/sort.wgsl` and
/// `kernels/splat/clusters/number.wgsl`.
fn sort(layout: &KeyLayout, keys: &[u32]) -> Numbered {
    let (width, height, tile) = (layout.size.width, layout.size.height, layout.tile);
    let row = |y: u32, first: u32| {
        let (begin, end) = (y as usize * width as usize, (first + tile).min(width) as usize);
        &keys[begin + first as usize..begin + end]
    };
    let of_tile = |index: u32| {
        let (x, y) = (index % layout.columns * tile, index / layout.columns * tile);
        let mut own: Vec<u32> = (y..(y + tile).min(height)).flat_map(|y| row(y, x)).copied().collect();
        own.retain(|&key| key != NONE);
        own.sort_unstable();
        own.dedup();
        own
    };
    let tiles: Vec<Vec<u32>> = (0..layout.columns * layout.rows).into_par_iter().map(of_tile).collect();
    let (first, _) = before(tiles.iter().map(|keys| keys.len() as u32));
    let of = |(pixel, &key): (usize, &u32)| {
        let (x, y) = (pixel as u32 % width / tile, pixel as u32 / width / tile);
        let tile = (y * layout.columns + x) as usize;
        let place = tiles[tile].binary_search(&key);
        place.map_or(NONE, |place| first[tile] + place as u32)
    };
    Numbered { identifiers: keys.par_iter().enumerate().map(of).collect(), cluster_keys: tiles.concat() }
}
