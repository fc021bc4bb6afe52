//! Where to split a large kd-tree cell: min-max binning.
//!
//! M. Shevtsov, A. Soupikov, A. Kapustin: Highly Parallel Fast KD-tree Construction for Interactive Ray Tracing of
//! Dynamic Scenes, 2007. Per axis one array counts the boxes that begin in a bin and one those that end in it.

use crate::math::Aabb;
use crate::workloads::trace::common::prims::{CHUNK, Prim};
use crate::workloads::trace::kdtree::build::Split;
use glam::{Vec3, Vec4};
use rayon::prelude::*;

/// Triangles that one thread counts.
const SHARE: usize = 4 * CHUNK;

/// Most bins per axis.
pub const MAX_BINS: usize = 64;

/// The borders of one axis's bins, which are the candidate planes.
///
/// A bin's number is defined by the planes themselves (the multiplication is a first guess, corrected by comparing), so
/// that counting by bins and comparing a box with the chosen plane cannot disagree through rounding.
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
        if self.planes[bin] <= x && x < self.planes[bin + 1] { bin } else { self.hint(x) }
    }

    #[cold]
    fn hint(&self, x: f32) -> usize {
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
    fn new(over: &Aabb, bins: usize) -> Guess {
        let extent = over.max - over.min;
        let scale = Vec3::select(extent.cmpgt(Vec3::ZERO), bins as f32 / extent, Vec3::ZERO).min(Vec3::splat(f32::MAX));
        Guess { min: over.min.extend(0.0), scale: scale.extend(0.0), most: Vec4::splat(bins as f32 - 0.01) }
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

/// What one chunk of triangles counts.
struct Tally {
    axes: [Counts; 3],
    /// By axis, boxes that lie in the lower and in the upper border of what the bins are spread over.
    borders: [[u32; 3]; 2],
}

impl Tally {
    const ZERO: Tally = Tally { axes: [Counts::ZERO; 3], borders: [[0; 3]; 2] };

    fn merge(&mut self, other: &Tally) {
        self.axes.iter_mut().zip(&other.axes).for_each(|(total, part)| total.merge(part));
        let borders = self.borders.as_flattened_mut().iter_mut().zip(other.borders.as_flattened());
        borders.for_each(|(total, part)| *total += part);
    }

    /// Notes the axes, as bits, on which a box lies in a border. Few boxes do.
    #[cold]
    fn lies(&mut self, in_lower: u32, in_upper: u32) {
        for (border, bits) in self.borders.iter_mut().zip([in_lower, in_upper]) {
            (0..3).for_each(|axis| border[axis] += bits >> axis & 1);
        }
    }
}

/// The cheapest plane for the triangles `own` (numbers in `prims`) on any axis; none that cuts off less than `thin`.
/// Candidates lie between `bins` equal slices of `over`, a part of the cell outside of which there is nothing of them;
/// so do its borders, if they are not the cell's.
pub(crate) fn find(prims: &[Prim], own: &[u32], cell: &Aabb, over: &Aabb, bins: usize, thin: f32) -> Option<Split> {
    let axes = [0, 1, 2].map(|a| Axis::new(over.min[a], over.max[a], bins));
    let guess = Guess::new(over, bins);
    // The cell's own border is no candidate, and nothing lies there that need be counted.
    let lower = Vec3::select(over.min.cmpgt(cell.min), over.min, Vec3::NEG_INFINITY).extend(f32::NEG_INFINITY);
    let upper = Vec3::select(over.max.cmplt(cell.max), over.max, Vec3::INFINITY).extend(f32::INFINITY);
    let count = |chunk: &[u32]| {
        let mut tally = Tally::ZERO;
        for prim in chunk.iter().map(|&i| &prims[i as usize]) {
            let (min_guess, max_guess) = (guess.of(prim.min), guess.of(prim.max));
            for (a, (axis, counts)) in axes.iter().zip(&mut tally.axes).enumerate() {
                let (begin, top) = (axis.bin(prim.min[a], min_guess[a]), axis.bin(prim.max[a], max_guess[a]));
                // A box that ends in a plane ends below it. There is no plane below bin 0.
                let end = top - usize::from(axis.planes[top] == prim.max[a]);
                counts.begin[begin] += 1;
                counts.end[end] += 1;
                if end < begin {
                    counts.planar[begin] += 1;
                }
            }
            let (in_lower, in_upper) = (prim.max.cmple(lower).bitmask(), prim.min.cmpge(upper).bitmask());
            if in_lower | in_upper != 0 {
                tally.lies(in_lower, in_upper);
            }
        }
        tally
    };
    let total = if own.len() <= SHARE {
        count(own)
    } else {
        let mut total = Tally::ZERO;
        own.par_chunks(SHARE).map(count).collect::<Vec<_>>().iter().for_each(|part| total.merge(part));
        total
    };
    let mut best: Option<Split> = None;
    for a in 0..3 {
        let sides = Sides::new(cell, a, thin);
        let [in_lower, in_upper] = total.borders.map(|border| border[a] as usize);
        sides.offer(lower[a], 0, in_lower, own.len() - in_lower, &mut best);
        sweep(&axes[a], &total.axes[a], own.len(), &sides, &mut best);
        sides.offer(upper[a], own.len() - in_upper, in_upper, 0, &mut best);
    }
    best
}

/// One sweep over the planes between an axis's bins. Both sides' areas are linear in the plane's coordinate.
fn sweep(axis: &Axis, counts: &Counts, triangles: usize, sides: &Sides, best: &mut Option<Split>) {
    let (mut left, mut right) = (0, triangles);
    for bin in 1..axis.bins {
        left += counts.begin[bin - 1] as usize;
        right -= counts.end[bin - 1] as usize;
        let planar = counts.planar[bin] as usize;
        // Of planes that round to the same coordinate only the last has counted all that ends or lies there.
        if axis.planes[bin] < axis.planes[bin + 1] {
            // Boxes in the plane have ended below it without having begun: they are on neither side yet.
            sides.offer(axis.planes[bin], left, planar, right, best);
        }
    }
}

/// For sweeps in f32: the area on the left of a plane is `section + rim * (plane - min)`; those on both sides together
/// are `both`, which is more than the cell's since the plane itself counts twice. Nothing is divided here.
pub(crate) struct Areas {
    min: f32,
    max: f32,
    thin: f32,
    section: f32,
    rim: f32,
    both: f32,
}

impl Areas {
    /// By axis; and the area of the cell in the same units, `None` if it is none.
    ///
    /// `unit` is about 1 over the extent of some larger cell: with it, products of lengths neither overflow nor vanish.
    /// Planes that cut off less than `thin` are not [`Areas::allows`]ed.
    #[inline(always)]
    pub fn new(cell: &Aabb, unit: f32, thin: f32) -> Option<([Areas; 3], f32)> {
        let [x, y, z] = ((cell.max - cell.min) * unit).to_array();
        let areas = |a: usize, section: f32, rim: f32, area: f32| Areas {
            min: cell.min[a],
            max: cell.max[a],
            thin,
            section,
            rim: rim * unit,
            both: area + section,
        };
        let (yz, zx, xy) = (y * z, z * x, x * y);
        let area = yz + zx + xy;
        let of = [areas(0, yz, y + z, area), areas(1, zx, z + x, area), areas(2, xy, x + y, area)];
        (area > 0.0 && area < f32::INFINITY).then_some((of, area))
    }

    /// True if the plane lies inside the cell, and not too near to its border.
    #[inline(always)]
    pub fn allows(&self, plane: f32) -> bool {
        inside(plane, self.min, self.max, self.thin)
    }

    /// Area times tests on both sides of a plane: `left_area left + right_area right`.
    #[inline(always)]
    pub fn cost(&self, plane: f32, right: f32, left_minus_right: f32) -> f32 {
        self.both * right + (self.section + self.rim * (plane - self.min)) * left_minus_right
    }

    /// [`Areas::cost`] of four planes.
    #[inline(always)]
    pub fn costs(&self, planes: Vec4, right: Vec4, left_minus_right: Vec4) -> Vec4 {
        self.both * right + (self.section + self.rim * (planes - self.min)) * left_minus_right
    }
}

/// True if the plane cuts at least `thin` off the cell on both sides, and is not its border.
#[inline(always)]
fn inside(plane: f32, min: f32, max: f32, thin: f32) -> bool {
    min < plane && plane < max && min + thin <= plane && plane <= max - thin
}

/// The areas of both sides of a plane, as functions of its coordinate.
pub(crate) struct Sides {
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

    /// Takes the plane if it is cheaper than the best so far; never one on the border of the cell, or too near to it.
    #[inline(always)]
    pub fn offer(&self, plane: f32, left: usize, planar: usize, right: usize, best: &mut Option<Split>) {
        if !inside(plane, self.min, self.max, self.thin) {
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
