//! What decides about planes through a BVH node: equal bins on an axis, and the parts of triangles inside of them.

use crate::workloads::trace::bvh::bins::Rows;
use crate::workloads::trace::bvh::clip::Clipper;
use crate::workloads::trace::common::prims::{CHUNK, Prim, SHARED};
use rayon::prelude::*;

/// Most bins per axis.
pub const MAX_SPATIAL_BINS: usize = 128;

/// References of a bin: those that begin there, those that end there, and the box around all parts inside.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Rows,
    enter: u32,
    exit: u32,
}

impl Bin {
    const EMPTY: Bin = Bin { bounds: Rows::EMPTY, enter: 0, exit: 0 };

    fn merge(&mut self, other: &Bin) {
        self.bounds.grow(other.bounds.min, other.bounds.max);
        self.enter += other.enter;
        self.exit += other.exit;
    }
}

/// The same without clipping: the boxes around the whole of those that begin there, and of those that end there.
#[derive(Clone, Copy)]
struct Ends {
    begin: Rows,
    end: Rows,
    enter: u32,
    exit: u32,
}

impl Ends {
    const EMPTY: Ends = Ends { begin: Rows::EMPTY, end: Rows::EMPTY, enter: 0, exit: 0 };

    fn merge(&mut self, other: &Ends) {
        self.begin.grow(other.begin.min, other.begin.max);
        self.end.grow(other.end.min, other.end.max);
        self.enter += other.enter;
        self.exit += other.exit;
    }
}

/// Fills one array of bins; where there are many references, several threads fill one each.
fn filled<T: Copy + Send + Sync>(
    references: &[Prim],
    bins: usize,
    empty: T,
    fill: impl Fn(&[Prim], &mut [T]) + Sync,
    merge: fn(&mut T, &T),
) -> Vec<T> {
    let part = |references: &[Prim]| {
        let mut part = vec![empty; bins];
        fill(references, &mut part);
        part
    };
    if references.len() <= SHARED {
        return part(references);
    }
    let parts: Vec<Vec<T>> = references.par_chunks(CHUNK).map(part).collect();
    let mut all = vec![empty; bins];
    parts.iter().for_each(|part| all.iter_mut().zip(part).for_each(|(all, part)| merge(all, part)));
    all
}

/// A border between bins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    pub axis: usize,
    pub at: f32,
}

/// Equal bins over a node's extent on one axis.
pub(crate) struct BinGrid {
    axis: usize,
    min: f32,
    /// Bins per unit of length.
    scale: f32,
    bins: usize,
    /// Where bins begin, and where the last one ends.
    borders: [f32; MAX_SPATIAL_BINS + 1],
    /// About 1 over the scene's extent.
    unit: f32,
}

impl BinGrid {
    /// `None` for an extent that cannot be divided.
    pub fn new(bounds: &Rows, axis: usize, bins: usize, unit: f32) -> Option<BinGrid> {
        let (min, max) = (bounds.min[axis], bounds.max[axis]);
        let scale = bins as f32 / (max - min);
        if !(scale > 0.0 && scale < f32::INFINITY) {
            return None;
        }
        let mut borders = [max; MAX_SPATIAL_BINS + 1];
        let step = (f64::from(max) - f64::from(min)) / bins as f64;
        let border = |i: u32| (f64::from(min) + step * f64::from(i)) as f32;
        borders[..bins].iter_mut().zip(0..).for_each(|(place, i)| *place = border(i));
        Some(BinGrid { axis, min, scale, bins, borders, unit })
    }

    /// The bin of any coordinate: -1 below all bins, their number above.
    #[inline(always)]
    fn place(&self, coordinate: f32) -> i32 {
        let bin = (coordinate - self.min) * self.scale;
        if bin < 0.0 { -1 } else { (bin as i32).min(self.bins as i32) }
    }

    /// The first and the last bin that a reference occupies.
    #[inline(always)]
    fn occupied(&self, reference: &Prim) -> (usize, usize) {
        let bin = |coordinate: f32| self.place(coordinate).clamp(0, self.bins as i32 - 1) as usize;
        (bin(reference.min[self.axis]), bin(reference.max[self.axis]))
    }

    /// False if no border between bins can cost less than `cost`: compares a lower bound that takes no clipping, from
    /// the boxes of the references that lie on either side as a whole.
    pub fn may_pay(&self, references: &[Prim], cost: f32) -> bool {
        let fill = |references: &[Prim], ends: &mut [Ends]| {
            for reference in references {
                let (first, last) = self.occupied(reference);
                ends[first].begin.grow(reference.min, reference.max);
                ends[first].enter += 1;
                ends[last].end.grow(reference.min, reference.max);
                ends[last].exit += 1;
            }
        };
        let ends = filled(references, self.bins, Ends::EMPTY, fill, Ends::merge);
        let side = |bounds: &Rows, count: u32| match count {
            0 => f32::INFINITY,
            count if bounds.min.x <= bounds.max.x => bounds.half_area(self.unit) * count as f32,
            _ => 0.0,
        };
        let mut right_cost = [0.0_f32; MAX_SPATIAL_BINS];
        let (mut right, mut count) = (Rows::EMPTY, 0);
        for i in (1..self.bins).rev() {
            right.grow(ends[i].begin.min, ends[i].begin.max);
            count += ends[i].exit;
            right_cost[i] = side(&right, count);
        }
        let (mut left, mut count) = (Rows::EMPTY, 0);
        (1..self.bins).any(|i| {
            left.grow(ends[i - 1].end.min, ends[i - 1].end.max);
            count += ends[i - 1].enter;
            side(&left, count) + right_cost[i] < cost
        })
    }

    /// The cheapest border, if it costs less than `best` and divides at most `spare` references, and its cost.
    pub fn cheapest(&self, references: &[Prim], clipper: &Clipper, spare: usize, best: f32) -> Option<(f32, Plane)> {
        let fill = |references: &[Prim], bins: &mut [Bin]| {
            let mut parts = [Rows::EMPTY; MAX_SPATIAL_BINS];
            references.iter().for_each(|reference| self.chop(reference, clipper, bins, &mut parts));
        };
        let bins = filled(references, self.bins, Bin::EMPTY, fill, Bin::merge);
        let mut right_cost = [(0.0_f32, 0); MAX_SPATIAL_BINS];
        let (mut right, mut count) = (Rows::EMPTY, 0);
        for i in (1..bins.len()).rev() {
            right.grow(bins[i].bounds.min, bins[i].bounds.max);
            count += bins[i].exit as usize;
            right_cost[i] = (right.half_area(self.unit) * count as f32, count);
        }
        let mut found = (best, None);
        let (mut left, mut count) = (Rows::EMPTY, 0);
        for i in 1..bins.len() {
            left.grow(bins[i - 1].bounds.min, bins[i - 1].bounds.max);
            count += bins[i - 1].enter as usize;
            let (right_cost, right_count) = right_cost[i];
            let cost = left.half_area(self.unit) * count as f32 + right_cost;
            let is_allowed = count > 0 && right_count > 0 && count + right_count - references.len() <= spare;
            if cost < found.0 && is_allowed {
                found = (cost, Some(Plane { axis: self.axis, at: self.borders[i] }));
            }
        }
        found.1.map(|plane| (found.0, plane))
    }

    /// Puts the parts of a reference into the bins that it occupies: the boxes around the triangle between two borders,
    /// without a margin, since bins only serve to compare costs. `parts` is room for them.
    #[inline]
    fn chop(&self, reference: &Prim, clipper: &Clipper, bins: &mut [Bin], parts: &mut [Rows; MAX_SPATIAL_BINS]) {
        let (first, last) = self.occupied(reference);
        bins[first].enter += 1;
        bins[last].exit += 1;
        if first == last {
            bins[first].bounds.grow(reference.min, reference.max);
            return;
        }
        parts[first..=last].fill(Rows::EMPTY);
        let corners = clipper.corners(reference);
        let places = corners.map(|corner| self.place(corner[self.axis]));
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let (corner, place) = (corners[i], places[i]);
            if (first as i32..=last as i32).contains(&place) {
                parts[place as usize].grow(corner, corner);
            }
            // Upwards along the edge, from border to border
            let (from, to) = if place <= places[j] { (i, j) } else { (j, i) };
            let (low, high) = (corners[from], corners[to]);
            let slope = (high - low) / (high[self.axis] - low[self.axis]);
            let borders = (places[from] + 1).max(first as i32)..=places[to].min(last as i32 + 1);
            for border in borders.map(|border| border as usize) {
                let crossing = low + slope * (self.borders[border] - low[self.axis]);
                if border > first {
                    parts[border - 1].grow(crossing, crossing);
                }
                if border <= last {
                    parts[border].grow(crossing, crossing);
                }
            }
        }
        for (bin, part) in bins[first..=last].iter_mut().zip(&parts[first..=last]) {
            bin.bounds.grow(part.min.max(reference.min), part.max.min(reference.max));
        }
    }
}
