//! Dividing the triangles of a BVH node into two sides.

use super::bvh_bins::{Item, Rows};
use super::prims::CHUNK;
use rayon::prelude::*;

/// Two sides of a split: where the right one begins, and their boxes.
pub(super) struct Sides {
    pub mid: usize,
    pub left: Rows,
    pub right: Rows,
}

/// The bounds of the (tripled) centroids.
#[inline(always)]
pub(super) fn centroid_bounds(items: &[Item]) -> Rows {
    let around = |items: &[Item]| {
        let mut rows = Rows::EMPTY;
        items.iter().for_each(|item| rows.grow(item.centroid3, item.centroid3));
        rows
    };
    if items.len() <= 4 * CHUNK {
        return around(items);
    }
    let chunks: Vec<Rows> = items.par_chunks(CHUNK).map(around).collect();
    chunks.iter().fold(Rows::EMPTY, |mut all, rows| {
        all.grow(rows.min, rows.max);
        all
    })
}

/// Stable partition without a branch per element: every element is written to both sides, and only one side advances.
#[inline(always)]
pub(super) fn partition(items: &mut [Item], scratch: &mut [Item], goes_left: impl Fn(&Item) -> bool) -> usize {
    let (mut left, mut right) = (0, 0);
    for i in 0..items.len() {
        let item = items[i];
        let flag = goes_left(&item) as usize;
        items[left] = item;
        scratch[right] = item;
        left += flag;
        right += 1 - flag;
    }
    items[left..].copy_from_slice(&scratch[..right]);
    left
}

/// The same partition by all threads: count, give every chunk its two places, and copy back.
pub(super) fn partition_in_chunks(
    items: &mut [Item],
    scratch: &mut [Item],
    goes_left: impl Fn(&Item) -> bool + Sync,
) -> usize {
    let counts: Vec<usize> =
        items.par_chunks(CHUNK).map(|chunk| chunk.iter().filter(|item| goes_left(item)).count()).collect();
    let mid = counts.iter().sum();
    let (mut left, mut right) = scratch.split_at_mut(mid);
    let mut places = Vec::with_capacity(counts.len());
    for (chunk, count) in items.chunks(CHUNK).zip(counts) {
        places.push((left.split_off_mut(..count), right.split_off_mut(..chunk.len() - count)));
    }
    items.par_chunks(CHUNK).zip(places).for_each(|(chunk, (left, right))| {
        let (mut left, mut right) = (left.into_iter().flatten(), right.into_iter().flatten());
        for item in chunk {
            let place = if goes_left(item) { left.next() } else { right.next() };
            *place.expect("counted before") = *item;
        }
    });
    items.par_chunks_mut(CHUNK).zip(scratch.par_chunks(CHUNK)).for_each(|(to, from)| to.copy_from_slice(from));
    mid
}

/// Where the centroids say nothing: half of them each, in the order in which they stand.
pub(super) fn halve(items: &[Item]) -> Sides {
    let mid = items.len() / 2;
    let around = |items: &[Item]| {
        let mut rows = Rows::EMPTY;
        items.iter().for_each(|p| rows.grow(p.prim.min, p.prim.max));
        rows
    };
    Sides { mid, left: around(&items[..mid]), right: around(&items[mid..]) }
}
