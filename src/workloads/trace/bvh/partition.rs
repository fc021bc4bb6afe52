//! Dividing the triangles of a BVH node into two sides.

use crate::workloads::trace::bvh::bins::{Item, Rows};
use crate::workloads::trace::common::prims::{CHUNK, SHARED};
use rayon::prelude::*;

/// Two sides of a split: where the right one begins, and their boxes.
pub(crate) struct Sides {
    pub mid: usize,
    pub left: Rows,
    pub right: Rows,
}

/// The bounds of the (tripled) centroids.
#[inline(always)]
pub(crate) fn centroid_bounds(items: &[Item]) -> Rows {
    let around = |items: &[Item]| {
        let mut rows = Rows::EMPTY;
        items.iter().for_each(|item| rows.grow(item.centroid3, item.centroid3));
        rows
    };
    if items.len() <= SHARED {
        return around(items);
    }
    let chunks: Vec<Rows> = items.par_chunks(CHUNK).map(around).collect();
    chunks.iter().fold(Rows::EMPTY, |mut all, rows| {
        all.grow(rows.min, rows.max);
        all
    })
}

/// Items looked at together by the partition of large nodes; offsets must fit into a byte.
const BLOCK: usize = 128;

/// Reorders items into those that go left and the others, in place and without a branch that depends on the items.
pub(crate) struct Partitioner {
    /// Where the right side of a small node waits. Small enough for the fastest cache, and to be touched only once.
    scratch: [Item; 2 * BLOCK],
    /// Offsets of the misplaced items in the block at the left end, and in that at the right end.
    misplaced: [[u8; BLOCK]; 2],
}

impl Partitioner {
    pub fn new() -> Partitioner {
        Partitioner { scratch: [Item::NONE; 2 * BLOCK], misplaced: [[0; BLOCK]; 2] }
    }

    /// Returns how many go left. Large nodes are halved, the halves partitioned side by side, and what then lies on the
    /// wrong side of the border is exchanged.
    pub fn shared(&mut self, items: &mut [Item], goes_left: impl Fn(&Item) -> bool + Copy + Sync) -> usize {
        if items.len() <= SHARED {
            return self.run(items, goes_left);
        }
        let (a, b) = items.split_at_mut(items.len() / 2);
        let (a_left, b_left) = rayon::join(|| self.shared(a, goes_left), || Partitioner::new().shared(b, goes_left));
        let exchanged = (a.len() - a_left).min(b_left);
        a[a_left..a_left + exchanged].swap_with_slice(&mut b[b_left - exchanged..b_left]);
        a_left + b_left
    }

    /// Returns how many go left.
    ///
    /// After S. Edelkamp and A. Weiss: BlockQuicksort, 2016: collects the misplaced items of one block at either end,
    /// swaps them pairwise, and moves on from the block that has none left.
    #[inline(always)]
    fn run(&mut self, items: &mut [Item], goes_left: impl Fn(&Item) -> bool) -> usize {
        let (mut from, mut to) = (0, items.len());
        // How many of the collected offsets have been used, and how many there are.
        let mut pending = [(0, 0); 2];
        while to - from > 2 * BLOCK {
            if pending[0].0 == pending[0].1 {
                let block = &items[from..from + BLOCK];
                pending[0] = (0, collect(&mut self.misplaced[0], block.iter().map(|item| !goes_left(item))));
            }
            if pending[1].0 == pending[1].1 {
                let block = &items[to - BLOCK..to];
                pending[1] = (0, collect(&mut self.misplaced[1], block.iter().rev().map(&goes_left)));
            }
            let swaps = (pending[0].1 - pending[0].0).min(pending[1].1 - pending[1].0);
            for i in 0..swaps {
                let left = self.misplaced[0][pending[0].0 + i] as usize;
                let right = self.misplaced[1][pending[1].0 + i] as usize;
                items.swap(from + left, to - 1 - right);
            }
            pending = pending.map(|(used, all)| (used + swaps, all));
            if pending[0].0 == pending[0].1 {
                from += BLOCK;
            }
            if pending[1].0 == pending[1].1 {
                to -= BLOCK;
            }
        }
        // What is left may contain a block that is partly done: it does not matter which part.
        from + self.small(&mut items[from..to], goes_left)
    }

    /// Stable, for few items: every item is written to both sides, and only one side advances.
    #[inline(always)]
    fn small(&mut self, items: &mut [Item], goes_left: impl Fn(&Item) -> bool) -> usize {
        let (mut left, mut right) = (0, 0);
        for i in 0..items.len() {
            let item = items[i];
            let flag = goes_left(&item) as usize;
            items[left] = item;
            self.scratch[right] = item;
            left += flag;
            right += 1 - flag;
        }
        items[left..].copy_from_slice(&self.scratch[..right]);
        left
    }
}

/// Lists the positions of the true flags; returns how many there are.
#[inline(always)]
fn collect(positions: &mut [u8; BLOCK], flags: impl Iterator<Item = bool>) -> usize {
    let mut count = 0;
    for (i, flag) in flags.take(BLOCK).enumerate() {
        positions[count] = i as u8;
        count += usize::from(flag);
    }
    count
}

/// Splits where centroids do not tell: half of the items on each side, in their order.
pub(crate) fn halve(items: &[Item]) -> Sides {
    let mid = items.len() / 2;
    let around = |items: &[Item]| {
        let mut rows = Rows::EMPTY;
        items.iter().for_each(|p| rows.grow(p.prim.min, p.prim.max));
        rows
    };
    Sides { mid, left: around(&items[..mid]), right: around(&items[mid..]) }
}
