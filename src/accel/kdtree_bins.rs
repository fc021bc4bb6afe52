//! Where to split a large kd-tree cell: min-max binning.
//!
//! M. Shevtsov, A. Soupikov, A. Kapustin: Highly Parallel Fast KD-tree Construction for Interactive Ray Tracing of
//! Dynamic Scenes, 2007. Per axis one array counts the boxes that begin in a bin and one those that end in it.

use super::kdtree_build::Split;
use super::prims::{CHUNK, Prim};
use crate::math::Aabb;
use glam::{Vec3, Vec3A, Vec4};
use rayon::prelude::*;

/// Most bins per axis.
pub const MAX_BINS: usize = 64;

/// The borders of one axis's bins, which are the candidate planes.
///
/// A bin's number is defined by the planes themselves (the multiplication is a first guess, mended by comparing), so
/// that counting by bins and comparing a box with the chosen plane cannot disagree, whatever rounding does.
struct Axis {
    /// `planes[b]` lies below bin `b`; `planes[0]` is below everything, the one behind the last bin above everything.
    planes: [f32; MAX_BINS + 1],
    bins: usize,
}

impl Axis {
    fn new(min: f32, max: f32, bins: usize) -> Axis {
        let mut planes = [f32::INFINITY; MAX_BINS + 1];
        planes[0] = f32::NEG_INFINITY;
        let (lo, hi) = (f64::from(min), f64::from(max));
        for (b, plane) in planes[..bins].iter_mut().enumerate().skip(1) {
            *plane = (lo + (hi - lo) * b as f64 / bins as f64) as f32;
        }
        Axis { planes, bins }
    }

    /// How many planes lie at or below `x`: the bin in which a box that begins at `x` begins.
    #[inline(always)]
    fn bin(&self, x: f32, guess: u32) -> usize {
        let bin = guess as usize % MAX_BINS;
        if self.planes[bin] <= x && x < self.planes[bin + 1] { bin } else { self.mend(x) }
    }

    #[cold]
    fn mend(&self, x: f32) -> usize {
        self.planes[1..self.bins].partition_point(|&plane| plane <= x)
    }
}

/// First guesses for the bins of three coordinates at once.
struct Guess {
    min: Vec4,
    scale: Vec4,
    most: Vec4,
}

impl Guess {
    fn new(cell: &Aabb, bins: usize) -> Guess {
        let extent = cell.max - cell.min;
        let scale = Vec3::select(extent.cmpgt(Vec3::ZERO), bins as f32 / extent, Vec3::ZERO).min(Vec3::splat(f32::MAX));
        Guess { min: cell.min.extend(0.0), scale: scale.extend(0.0), most: Vec4::splat(bins as f32 - 0.01) }
    }

    /// The number is pushed into the low mantissa bits of a float: `2^15 + x` has the bits of `x * 256`.
    #[inline(always)]
    fn of(&self, corner: Vec4) -> [u32; 4] {
        let x = ((corner - self.min) * self.scale).max(Vec4::ZERO).min(self.most) + Vec4::splat(32_768.0);
        x.to_array().map(|f| f.to_bits() >> 8)
    }
}

/// Counts of one axis.
#[derive(Clone, Copy)]
struct Counts {
    /// Boxes that begin in a bin, a plane belonging to the bin above it.
    begin: [u32; MAX_BINS],
    /// Boxes that end in a bin, a plane belonging to the bin below it.
    end: [u32; MAX_BINS],
    /// Boxes that lie in the plane below a bin.
    planar: [u32; MAX_BINS],
}

impl Counts {
    const ZERO: Counts = Counts { begin: [0; MAX_BINS], end: [0; MAX_BINS], planar: [0; MAX_BINS] };

    fn merge(&mut self, other: &Counts) {
        for bin in 0..MAX_BINS {
            self.begin[bin] += other.begin[bin];
            self.end[bin] += other.end[bin];
            self.planar[bin] += other.planar[bin];
        }
    }
}

/// The cheapest of the planes between `bins` equal slices of the cell, on any axis.
pub(super) fn find(prims: &[Prim], cell: &Aabb, bins: usize, thin: f32) -> Option<Split> {
    let axes = [0, 1, 2].map(|a| Axis::new(cell.min[a], cell.max[a], bins));
    let guess = Guess::new(cell, bins);
    let count = |chunk: &[Prim]| {
        let mut counts = [Counts::ZERO; 3];
        for prim in chunk {
            let (min_guess, max_guess) = (guess.of(prim.min), guess.of(prim.max));
            for (a, (axis, counts)) in axes.iter().zip(&mut counts).enumerate() {
                let (begin, top) = (axis.bin(prim.min[a], min_guess[a]), axis.bin(prim.max[a], max_guess[a]));
                // A box that ends in a plane ends below it. There is no plane below bin 0.
                let end = top - usize::from(axis.planes[top] == prim.max[a]);
                counts.begin[begin] += 1;
                counts.end[end] += 1;
                if end < begin {
                    counts.planar[begin] += 1;
                }
            }
        }
        counts
    };
    let mut total = [Counts::ZERO; 3];
    for part in prims.par_chunks(4 * CHUNK).map(count).collect::<Vec<_>>() {
        total.iter_mut().zip(&part).for_each(|(total, part)| total.merge(part));
    }
    let mut best: Option<Split> = None;
    for a in 0..3 {
        sweep(a, &axes[a], &total[a], prims.len(), (cell, thin), &mut best);
    }
    best
}

/// One sweep over the borders of an axis. Both sides' areas are linear in the plane's coordinate.
fn sweep(
    a: usize,
    axis: &Axis,
    counts: &Counts,
    triangles: usize,
    (cell, thin): (&Aabb, f32),
    best: &mut Option<Split>,
) {
    let sides = Sides::new(cell, a, thin);
    let (mut left, mut right) = (0, triangles);
    for bin in 1..axis.bins {
        left += counts.begin[bin - 1] as usize;
        right -= counts.end[bin - 1] as usize;
        let planar = counts.planar[bin] as usize;
        // Boxes in the plane have ended below it without having begun: they are on neither side yet.
        sides.offer(axis.planes[bin], left, planar, right, best);
    }
}

/// For sweeps in f32. The left side's share of a cell's area is `at_min + per_length * (plane - min)`; both shares
/// together make `sum`, which is more than 1 since the plane itself counts twice.
pub(super) struct Shares {
    pub min: f32,
    pub max: f32,
    at_min: f32,
    per_length: f32,
    sum: f32,
    /// Planes outside these would cut off a slice that is too thin: they cost infinitely much.
    first: f32,
    last: f32,
}

impl Shares {
    /// By axis. An axis on which no plane fits into the cell, or shares leave the range of f32, has `max < min`.
    #[inline(always)]
    pub fn new(cell: &Aabb, thin: f32) -> [Shares; 3] {
        // Lengths in units of the longest: their products neither overflow nor vanish.
        let extent = Vec3A::from(cell.max) - Vec3A::from(cell.min);
        let unit = 1.0 / extent.max_element();
        let e = extent * unit;
        let (u, v) = (Vec3A::new(e.y, e.z, e.x), Vec3A::new(e.z, e.x, e.y));
        let per_area = 1.0 / e.dot(u);
        let (at_min, per_length) = (u * v * per_area, (u + v) * (per_area * unit));
        // An area of zero makes one of these infinite or NaN.
        let usable = extent.cmpgt(Vec3A::ZERO) & (at_min + per_length + extent).cmplt(Vec3A::INFINITY);
        [0, 1, 2].map(|a| Shares {
            min: cell.min[a],
            max: if usable.test(a) { cell.max[a] } else { f32::NEG_INFINITY },
            at_min: at_min[a],
            per_length: per_length[a],
            sum: 1.0 + at_min[a],
            first: cell.min[a] + thin,
            last: cell.max[a] - thin,
        })
    }

    /// Expected number of tests: with the share `p` on the left, `p left + (sum - p) right`.
    #[inline(always)]
    pub fn cost(&self, plane: f32, right: f32, left_minus_right: f32) -> f32 {
        let cost = self.sum * right + (self.at_min + self.per_length * (plane - self.min)) * left_minus_right;
        if plane < self.first || plane > self.last { f32::INFINITY } else { cost }
    }

    /// [`Shares::cost`] of four planes.
    #[inline(always)]
    pub fn costs(&self, planes: Vec4, right: Vec4, left_minus_right: Vec4) -> Vec4 {
        let costs = self.sum * right + (self.at_min + self.per_length * (planes - self.min)) * left_minus_right;
        let outside = planes.cmplt(Vec4::splat(self.first)) | planes.cmpgt(Vec4::splat(self.last));
        Vec4::select(outside, Vec4::INFINITY, costs)
    }
}

/// The areas of both sides of a plane, as functions of its coordinate.
pub(super) struct Sides {
    axis: usize,
    min: f32,
    max: f32,
    thin: f32,
    /// Area of the plane's section of the cell.
    section: f64,
    /// Half its circumference.
    rim: f64,
}

impl Sides {
    pub fn new(cell: &Aabb, axis: usize, thin: f32) -> Sides {
        let e = cell.max.as_dvec3() - cell.min.as_dvec3();
        let (u, v) = (e[(axis + 1) % 3], e[(axis + 2) % 3]);
        Sides { axis, min: cell.min[axis], max: cell.max[axis], thin, section: u * v, rim: u + v }
    }

    /// Takes the plane if it is cheaper than the best so far; never one on the border of the cell, or so near it that
    /// the slice would be too thin.
    #[inline(always)]
    pub fn offer(&self, plane: f32, left: usize, planar: usize, right: usize, best: &mut Option<Split>) {
        let inside = plane >= self.min + self.thin && plane <= self.max - self.thin;
        if !(inside && plane > self.min && plane < self.max) {
            return;
        }
        let left_area = self.section + self.rim * (f64::from(plane) - f64::from(self.min));
        let right_area = self.section + self.rim * (f64::from(self.max) - f64::from(plane));
        let planar_left = left_area <= right_area;
        let (left, right) = if planar_left { (left + planar, right) } else { (left, right + planar) };
        let weighted = left_area * left as f64 + right_area * right as f64;
        if best.is_none_or(|b| weighted < b.weighted) {
            *best = Some(Split { axis: self.axis, plane, planar_left, left, right, weighted });
        }
    }
}
