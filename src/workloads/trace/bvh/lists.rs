//! The triangles of a BVH node in the order of the centres of their boxes, and the cheapest border between two of them.

use crate::workloads::trace::bvh::bins::Rows;
use crate::workloads::trace::common::prims::{CHUNK, Prim, SHARED};
use rayon::prelude::*;

/// Place of a triangle in the order on an axis: the centre of its box (twice it, `min + max`), and for equal ones the
/// triangle's index. No two triangles of a node share a place.
#[inline(always)]
pub(crate) fn place(prim: &Prim, axis: usize) -> u64 {
    let bits = (prim.min[axis] + prim.max[axis]).to_bits();
    // Floats in the order of unsigned integers
    let key = if bits >> 31 == 1 { !bits } else { bits | 1 << 31 };
    u64::from(key) << 32 | u64::from(prim.triangle())
}

/// Sorts by [`place`].
pub(crate) fn sort(list: &mut [Prim], axis: usize) {
    if list.len() > SHARED {
        list.par_sort_unstable_by_key(|prim| place(prim, axis));
    } else {
        list.sort_unstable_by_key(|prim| place(prim, axis));
    }
}

/// A copy that is sorted by [`place`]; keys are sorted first, and boxes moved once.
pub(crate) fn sorted(prims: &[Prim], axis: usize) -> Vec<Prim> {
    // The number of a box takes the place of its triangle, which ascends with it.
    let numbered = |(number, prim): (usize, &Prim)| place(prim, axis) >> 32 << 32 | number as u64;
    let mut keys: Vec<u64> = prims.par_iter().enumerate().map(numbered).collect();
    keys.par_sort_unstable();
    keys.par_iter().with_min_len(CHUNK).map(|&key| prims[key as u32 as usize]).collect()
}

/// The box around some boxes.
pub(crate) fn around(list: &[Prim]) -> Rows {
    let part = |part: &[Prim]| {
        let mut rows = Rows::EMPTY;
        part.iter().for_each(|prim| rows.grow(prim.min, prim.max));
        rows
    };
    if list.len() <= SHARED {
        return part(list);
    }
    let parts: Vec<Rows> = list.par_chunks(CHUNK).map(part).collect();
    union(&parts)
}

fn union(boxes: &[Rows]) -> Rows {
    boxes.iter().fold(Rows::EMPTY, |mut all, rows| {
        all.grow(rows.min, rows.max);
        all
    })
}

/// A border in a sorted list.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Border {
    pub axis: usize,
    /// How many lie before it.
    pub position: usize,
    /// Half the surface area of either side's box, in units of the scene, times the number of triangles there.
    pub cost: f32,
}

impl Border {
    pub const NONE: Border = Border { axis: 0, position: 0, cost: f32::INFINITY };

    /// The cheaper one; of equal costs the first.
    pub fn or(self, other: Border) -> Border {
        if other.cost < self.cost { other } else { self }
    }
}

/// Finds the cheapest border of a list that is sorted on `axis`, if it is cheaper than `best`. `unit`: about 1 over the
/// scene's extent.
pub(crate) fn cheapest(list: &[Prim], axis: usize, unit: f32, costs: &mut Vec<f32>, best: Border) -> Border {
    let sweep = Sweep { list, axis, unit };
    if list.len() <= SHARED {
        return best.or(sweep.part(0, list.len(), Rows::EMPTY, Rows::EMPTY, costs));
    }
    // Each part by itself, once it is known what lies before and behind: the same boxes, and so the same costs.
    let boxes: Vec<Rows> = list.par_chunks(CHUNK).map(around).collect();
    let mut behind = vec![Rows::EMPTY; boxes.len()];
    for i in (1..boxes.len()).rev() {
        behind[i - 1] = union(&[behind[i], boxes[i]]);
    }
    let mut before = vec![Rows::EMPTY; boxes.len()];
    for i in 1..boxes.len() {
        before[i] = union(&[before[i - 1], boxes[i - 1]]);
    }
    let part = |i: usize| {
        let end = list.len().min((i + 1) * CHUNK);
        sweep.part(i * CHUNK, end, before[i], behind[i], &mut Vec::with_capacity(CHUNK))
    };
    let parts: Vec<Border> = (0..boxes.len()).into_par_iter().map(part).collect();
    parts.into_iter().fold(best, Border::or)
}

struct Sweep<'a> {
    list: &'a [Prim],
    axis: usize,
    unit: f32,
}

impl Sweep<'_> {
    /// The cheapest border before one of the triangles `from..to`; what lies before and behind them has these boxes.
    fn part(&self, from: usize, to: usize, before: Rows, behind: Rows, costs: &mut Vec<f32>) -> Border {
        let Sweep { list, axis, unit } = *self;
        let part = &list[from..to];
        costs.clear();
        costs.resize(part.len(), 0.0);
        let mut right = behind;
        let mut count = (list.len() - to) as f32;
        for (prim, cost) in part.iter().zip(costs.iter_mut()).rev() {
            right.grow(prim.min, prim.max);
            count += 1.0;
            *cost = right.half_area(unit) * count;
        }
        let mut best = Border { axis, ..Border::NONE };
        let mut left = before;
        let mut count = from as f32;
        for ((prim, &right), position) in part.iter().zip(costs.iter()).zip(from..) {
            let cost = left.half_area(unit) * count + right;
            if cost < best.cost && position > 0 {
                best = Border { axis, position, cost };
            }
            left.grow(prim.min, prim.max);
            count += 1.0;
        }
        best
    }
}

/// What goes to the left of a border, by [`place`].
#[derive(Clone, Copy)]
pub(crate) struct Pivot {
    axis: usize,
    /// Twice the centre of the first box on the right side.
    key: f32,
    triangle: u32,
}

impl Pivot {
    /// The border before `first`.
    pub fn before(first: &Prim, axis: usize) -> Pivot {
        Pivot { axis, key: first.min[axis] + first.max[axis], triangle: first.triangle() }
    }

    #[inline(always)]
    fn is_left(&self, prim: &Prim) -> bool {
        let key = prim.min[self.axis] + prim.max[self.axis];
        (key < self.key) | ((key == self.key) & (prim.triangle() < self.triangle))
    }

    /// Moves what goes left to the front; both sides keep their order.
    pub fn partition(&self, list: &mut [Prim], scratch: &mut Vec<Prim>) {
        scratch.resize(scratch.len().max(list.len()), Prim::NONE);
        let (mut left, mut right) = (0, 0);
        for i in 0..list.len() {
            let prim = list[i];
            let is_left = usize::from(self.is_left(&prim));
            list[left] = prim;
            scratch[right] = prim;
            left += is_left;
            right += 1 - is_left;
        }
        list[left..].copy_from_slice(&scratch[..right]);
    }

    /// Both sides in their order; `position` go left.
    pub fn sides(&self, list: &[Prim], position: usize) -> [Vec<Prim>; 2] {
        let mut left = Vec::with_capacity(position + 1);
        let mut right = Vec::with_capacity(list.len() - position + 1);
        for prim in list {
            // Written to both, kept in one
            let (l, r) = (left.len(), right.len());
            let is_left = usize::from(self.is_left(prim));
            left.push(*prim);
            right.push(*prim);
            left.truncate(l + is_left);
            right.truncate(r + 1 - is_left);
        }
        [left, right]
    }
}

/// Both lists together, in the order on `axis` that each of them has.
pub(crate) fn merged(mut list: Vec<Prim>, mut others: Vec<Prim>, axis: usize) -> Vec<Prim> {
    if others.is_empty() {
        return list;
    }
    sort(&mut others, axis);
    // From the back, into the room behind the list
    let (mut from, mut to) = (list.len(), list.len() + others.len());
    list.resize(to, Prim::NONE);
    while let Some(other) = others.last() {
        to -= 1;
        if from > 0 && place(&list[from - 1], axis) > place(other, axis) {
            from -= 1;
            list[to] = list[from];
        } else {
            list[to] = *other;
            others.pop();
        }
    }
    list
}
