//! Triangles along the Morton curve. Twin of `kernels/trace/build/{codes,count,scatter}.wgsl`.
//!
//! G. M. Morton: A Computer Oriented Geodetic Data Base, 1966. Codes have ten bits an axis; each axis of the box
//! around all triangles is divided by its own extent.

use crate::math::Aabb;
use crate::workloads::trace::common::prims::{CHUNK, Prim};
use glam::Vec3;
use rayon::prelude::*;

/// Cells on each axis.
pub const CELLS: f32 = 1024.0;

/// An axis of a smaller extent than 2^-100 has one cell: the number of cells per unit is finite, and numbers that a
/// device takes for zero, being denormal, are none that decide a cell.
pub const SMALLEST_EXTENT: f32 = f32::from_bits((127 - 100) << 23);

/// The cells of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cells {
    /// Half the corner where they begin.
    pub lo: Vec3,
    /// Cells per half unit.
    pub scale: Vec3,
}

/// Half the centroid of a triangle's box: so it is finite in every scene.
fn half_centroid(prim: &Prim) -> Vec3 {
    prim.min.truncate() * 0.25 + prim.max.truncate() * 0.25
}

impl Cells {
    /// Cells of the box around all triangles.
    pub fn of(bounds: &Aabb) -> Cells {
        let (lo, hi) = (bounds.min * 0.5, bounds.max * 0.5);
        let extent = hi - lo;
        let scale = Vec3::select(extent.cmpgt(Vec3::splat(SMALLEST_EXTENT)), CELLS / extent, Vec3::ZERO);
        Cells { lo, scale }
    }

    /// The Morton code of a triangle, 30 bits.
    pub fn code(&self, prim: &Prim) -> u32 {
        let cell = (half_centroid(prim) - self.lo) * self.scale;
        let [x, y, z] = cell.min(Vec3::splat(CELLS - 1.0)).to_array().map(|x| spread(x as u32));
        x | y << 1 | z << 2
    }
}

/// Two zeros behind each of the lower ten bits.
fn spread(x: u32) -> u32 {
    let x = (x | x << 16) & 0x0300_00ff;
    let x = (x | x << 8) & 0x0300_f00f;
    let x = (x | x << 4) & 0x030c_30c3;
    (x | x << 2) & 0x0924_9249
}

/// Triangles in the order of their Morton codes; those of equal codes in the order of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Sorted {
    /// Morton codes, ascending.
    pub keys: Vec<u32>,
    /// For each code, the number of its box.
    pub order: Vec<u32>,
}

impl Sorted {
    /// Sorts boxes; `bounds` is around all.
    pub fn of(prims: &[Prim], bounds: &Aabb) -> Sorted {
        let cells = Cells::of(bounds);
        let pair = |(i, prim): (usize, &Prim)| u64::from(cells.code(prim)) << 32 | i as u64;
        let mut pairs: Vec<u64> = prims.par_iter().with_min_len(CHUNK).enumerate().map(pair).collect();
        pairs.par_sort_unstable();
        let half = |shift: u32| pairs.par_iter().with_min_len(CHUNK).map(move |&pair| (pair >> shift) as u32).collect();
        Sorted { keys: half(32), order: half(0) }
    }
}
