//! Spatial splits: a node is divided by a plane, and triangles across it become two references with a smaller box each.
//! A reference is here a triangle and the box of a part of it; in a leaf it becomes a triangle reference.
//!
//! M. Stich, H. Friedrich, A. Dietrich: Spatial Splits in Bounding Volume Hierarchies, 2009. A spatial split is tried
//! where the sides of the best object split overlap by at least `alpha` of the root's surface; bins are filled by
//! clipping triangles at every border; a reference across the chosen plane goes to one side as a whole where that is
//! cheaper. Ours are: the margin of clipped boxes (`clip.rs`), the bound on references (`Sides::spare`), and that small
//! nodes are not divided (`FEW_LEAVES`).

use crate::workloads::trace::bvh::SpatialSplits;
use crate::workloads::trace::bvh::bins::Rows;
use crate::workloads::trace::bvh::clip::Clipper;
use crate::workloads::trace::bvh::lists::merged;
use crate::workloads::trace::bvh::spatial_bins::{BinGrid, Plane};
use crate::workloads::trace::common::prims::Prim;
use glam::{DVec3, Vec4};
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// What can be set about spatial splits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpatialConfig {
    /// The overlap at which a spatial split is tried, as a share of the root's surface.
    pub alpha: f32,
    /// Bins per axis, 2 to 128.
    pub bins: usize,
    /// Levels of inner nodes that may be split so, the root's the first.
    pub depth: u32,
    /// True to try them where the overlap is below `alpha` and not where it is above.
    pub below: bool,
}

impl Default for SpatialConfig {
    /// Of the paper; its 48 levels and the number of bins are those of public builders.
    fn default() -> Self {
        SpatialConfig { alpha: 1.0e-5, bins: 32, depth: 48, below: false }
    }
}

/// Most references for each triangle of a scene, all triangles together. Beyond it there are object splits only.
pub(crate) const MOST_REFERENCES: usize = 4;

/// So many leaves' references are few (see [`Spatial::few`]): below, plane after plane divides the same triangles and
/// hardly any surface is saved (sponza, leaves of three: 1.44 references a triangle in place of 1.22, for 1.6 % of the
/// cost).
pub(crate) const FEW_LEAVES: usize = 4;

/// The two sides of a divided node: lists sorted on each axis.
pub(crate) struct Sides {
    pub lists: [[Vec<Prim>; 3]; 2],
    pub bounds: [Rows; 2],
    /// References that the subtrees may add.
    pub spare: usize,
}

/// Finds and makes spatial splits.
pub(crate) struct Spatial<'a> {
    pub config: SpatialConfig,
    pub clipper: Clipper<'a>,
    /// About 1 over the scene's extent.
    pub unit: f32,
    /// Half the root's surface, in that unit.
    pub root: f32,
    /// Nodes of at most so many references are split between references only.
    pub few: usize,
    pub tally: Tally,
}

/// What is known of the splits made so far, by all threads.
#[derive(Default)]
pub(crate) struct Tally {
    count: AtomicU32,
    /// Bits of an f32: those of numbers that are not negative have their order.
    overlap: AtomicU32,
}

impl Tally {
    /// Adds a split whose sides are these boxes before whole references are put on one side.
    fn add(&self, left: &Rows, right: &Rows) {
        let volume = |min: Vec4, max: Vec4| (max - min).truncate().as_dvec3().max(DVec3::ZERO).element_product();
        let common = volume(left.min.max(right.min), left.max.min(right.max));
        let whole = volume(left.min.min(right.min), left.max.max(right.max));
        let share = if common > 0.0 { (common / whole) as f32 } else { 0.0 };
        self.count.fetch_add(1, Relaxed);
        self.overlap.fetch_max(share.to_bits(), Relaxed);
    }

    pub fn splits(&self) -> SpatialSplits {
        SpatialSplits { count: self.count.load(Relaxed), overlap: f32::from_bits(self.overlap.load(Relaxed)) }
    }
}

impl Spatial<'_> {
    /// True if the sides of an object split overlap so much that a spatial split is tried, in a node of this depth and
    /// with so many references.
    pub fn is_worth_trying(&self, depth: u32, references: usize, left: &Rows, right: &Rows) -> bool {
        let common = Rows { min: left.min.max(right.min), max: left.max.min(right.max) };
        let extent = (common.max - common.min).truncate();
        let overlap = if extent.min_element() >= 0.0 { common.half_area(self.unit) } else { 0.0 };
        let threshold = self.config.alpha * self.root;
        let is_enough = if self.config.below { overlap < threshold } else { overlap >= threshold };
        depth < self.config.depth && references > self.few && is_enough
    }

    /// The cheapest plane between bins, if it costs less than `cost` and divides at most `spare` references.
    pub fn plane(
        &self,
        references: &[Prim],
        bounds: &Rows,
        axes: impl Iterator<Item = usize>,
        cost: f32,
        spare: usize,
    ) -> Option<Plane> {
        let mut best = (cost, None);
        for axis in axes {
            let Some(grid) = BinGrid::new(bounds, axis, self.config.bins, self.unit) else { continue };
            if grid.may_pay(references, best.0)
                && let Some((cost, plane)) = grid.cheapest(references, &self.clipper, spare, best.0)
            {
                best = (cost, Some(plane));
            }
        }
        best.1
    }

    /// Divides a node's references; `None` if one side would be empty.
    pub fn divide(&self, lists: [&[Prim]; 3], plane: Plane, spare: usize) -> Option<Sides> {
        let Plane { axis, at } = plane;
        let is_left = |r: &Prim| r.max[axis] <= at;
        let is_right = |r: &Prim| r.max[axis] > at && r.min[axis] >= at;
        let mut sides = [Side::EMPTY; 2];
        let mut across = Vec::new();
        for reference in lists[axis] {
            if is_left(reference) {
                sides[0].add(reference);
            } else if is_right(reference) {
                sides[1].add(reference);
            } else {
                across.push(reference);
            }
        }
        let mut divided = 0;
        let mut parts_of: [Vec<Prim>; 2] = Default::default();
        let mut parted = sides.map(|side| side.bounds);
        for reference in across {
            let parts = self.clipper.cut(reference, axis, at);
            for (bounds, part) in parted.iter_mut().zip(&parts) {
                part.iter().for_each(|part| bounds.grow(part.min, part.max));
            }
            let parts = self.place(reference, parts, &sides, divided < spare);
            divided += usize::from(parts.iter().all(Option::is_some));
            for ((side, list), part) in sides.iter_mut().zip(&mut parts_of).zip(parts) {
                part.iter().for_each(|part| side.add(part));
                list.extend(part);
            }
        }
        if sides.iter().any(|side| side.count == 0) {
            return None;
        }
        self.tally.add(&parted[0], &parted[1]);
        let side = |side: usize| {
            [0, 1, 2].map(|axis| {
                let goes = |r: &&Prim| if side == 0 { is_left(r) } else { is_right(r) };
                let whole: Vec<Prim> = lists[axis].iter().filter(goes).copied().collect();
                merged(whole, parts_of[side].clone(), axis)
            })
        };
        let (left, right) = rayon::join(|| side(0), || side(1));
        Some(Sides { lists: [left, right], bounds: sides.map(|side| side.bounds), spare: spare - divided })
    }

    /// Where a reference across a plane goes: both of its parts to their sides, or the whole to one of them, whatever
    /// is cheapest with what is there already; the whole where it may not be divided.
    fn place(
        &self,
        reference: &Prim,
        parts: [Option<Prim>; 2],
        sides: &[Side; 2],
        may_divide: bool,
    ) -> [Option<Prim>; 2] {
        let [Some(low), Some(high)] = parts else { return parts };
        let [left, right] = sides;
        let cost = |left: Side, right: Side| left.cost(self.unit) + right.cost(self.unit);
        let on_left = cost(left.with(reference), *right);
        let on_right = cost(*left, right.with(reference));
        if may_divide && cost(left.with(&low), right.with(&high)) < on_left.min(on_right) {
            parts
        } else if on_left <= on_right {
            [Some(*reference), None]
        } else {
            [None, Some(*reference)]
        }
    }
}

/// What has been put on one side of a plane.
#[derive(Clone, Copy)]
struct Side {
    bounds: Rows,
    count: usize,
}

impl Side {
    const EMPTY: Side = Side { bounds: Rows::EMPTY, count: 0 };

    fn add(&mut self, reference: &Prim) {
        self.bounds.grow(reference.min, reference.max);
        self.count += 1;
    }

    fn with(mut self, reference: &Prim) -> Side {
        self.add(reference);
        self
    }

    fn cost(&self, unit: f32) -> f32 {
        if self.count == 0 { 0.0 } else { self.bounds.half_area(unit) * self.count as f32 }
    }
}
