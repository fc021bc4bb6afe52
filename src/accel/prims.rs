//! What builders sort: the box of every triangle that can be hit, 32 bytes each, and the records they end up as.

use super::Record;
use crate::error::{Error, Result};
use crate::math::Aabb;
use crate::scene::Scene;
use bytemuck::Zeroable;
use glam::{Vec3A, Vec4};
use rayon::prelude::*;

/// Most triangles that a structure can hold: kd-tree links have 30 bits, and a triangle's index must survive as the
/// hidden lane of a float vector (see [`Prim`]).
pub const MAX_TRIANGLES: usize = 1 << 29;

/// Triangles handled together where work is shared out between threads: a constant, so that no result depends on the
/// number of threads.
pub const CHUNK: usize = 8192;

/// Added to an index that rides along as a float: without it the lane would be denormal, and a multiplication that
/// meets a denormal number costs a hundred cycles. With it every index below 2^29 is an ordinary float.
const TAG: u32 = 0x4000_0000;

/// The box of one triangle and its index, in two 16-byte rows.
///
/// The fourth lanes are `min: 1.0` and `max: index + 0x40000000` as bits; arithmetic on whole rows may do with them
/// what it likes, since only copies are ever asked for the index.
#[derive(Clone, Copy, Debug, Zeroable)]
#[repr(C)]
pub struct Prim {
    /// Smallest corner.
    pub min: Vec4,
    /// Largest corner, and the triangle's index.
    pub max: Vec4,
}

impl Prim {
    /// Stands where no triangle has been put yet.
    pub const NONE: Prim = Prim { min: Vec4::ONE, max: Vec4::ONE };

    /// Index of the triangle in the scene.
    #[inline(always)]
    pub fn triangle(&self) -> u32 {
        self.max.w.to_bits() ^ TAG
    }

    /// The box alone.
    pub fn aabb(&self) -> Aabb {
        Aabb { min: self.min.truncate(), max: self.max.truncate() }
    }
}

/// The one place that decides which triangles a structure holds: those whose corners are all finite. A triangle with
/// any other corner has no box, so it is left out by every builder, and can never be hit.
#[inline]
pub fn is_hittable(corners: &[Vec3A; 3]) -> bool {
    corners.iter().all(|c| c.is_finite())
}

/// The box of triangle `index`, or `None` if it cannot be hit.
#[inline]
pub fn prim(scene: &Scene, index: u32) -> Option<Prim> {
    let corners = scene.corners(index);
    if !is_hittable(&corners) {
        return None;
    }
    let [a, b, c] = corners;
    // Adding zero turns a -0 into a +0, so that boxes do not depend on the order in which corners are met.
    let min = a.min(b).min(c) + Vec3A::ZERO;
    let max = a.max(b).max(c) + Vec3A::ZERO;
    Some(Prim { min: min.extend(1.0), max: max.extend(f32::from_bits(index | TAG)) })
}

/// The boxes of all triangles that can be hit, in scene order.
pub fn prims(scene: &Scene) -> Result<Vec<Prim>> {
    gather(scene, Prim::NONE, |prim| prim, |prim| prim)
}

/// Something made of the box of every triangle that can be hit, in scene order. `none` must hold [`Prim::NONE`].
pub(super) fn gather<T: Copy + Send + Sync>(
    scene: &Scene,
    none: T,
    make: impl Fn(Prim) -> T + Sync,
    prim_of: impl Fn(&T) -> &Prim + Sync,
) -> Result<Vec<T>> {
    let count = scene.triangles.len();
    if count >= MAX_TRIANGLES {
        return Err(Error::argument(
            &scene.name,
            format!("{count} triangles are more than a structure can hold ({})", MAX_TRIANGLES - 1),
            "use a smaller scene",
        ));
    }
    let indices = (0..count as u32).into_par_iter().with_min_len(CHUNK);
    let mut items: Vec<T> = indices.map(|i| prim(scene, i).map_or(none, &make)).collect();
    let is_none = |item: &T| prim_of(item).max.w == Prim::NONE.max.w;
    if items.par_iter().with_min_len(CHUNK).any(is_none) {
        items.retain(|item| !is_none(item));
    }
    Ok(items)
}

/// The box around some prims; [`Aabb::EMPTY`] around none.
pub fn bounds(prims: &[Prim]) -> Aabb {
    bounds_by(prims, |prim| prim)
}

pub(super) fn bounds_by<T: Sync>(items: &[T], prim_of: impl Fn(&T) -> &Prim + Sync) -> Aabb {
    let around = |chunk: &[T]| {
        let start = (Vec4::INFINITY, Vec4::NEG_INFINITY);
        chunk.iter().map(&prim_of).fold(start, |(min, max), p| (min.min(p.min), max.max(p.max)))
    };
    let boxes: Vec<_> = items.par_chunks(CHUNK).map(around).collect();
    let aabb = |(min, max): (Vec4, Vec4)| Aabb { min: min.truncate(), max: max.truncate() };
    boxes.into_iter().fold(Aabb::EMPTY, |all, rows| all.union(aabb(rows)))
}

/// The record of triangle `index`.
#[inline]
pub fn record(scene: &Scene, index: u32) -> Record {
    Record { vertices: scene.triangles[index as usize].vertices, triangle: index }
}

/// The records of some prims, in their order.
pub fn records(scene: &Scene, prims: &[Prim]) -> Vec<Record> {
    prims.par_iter().with_min_len(CHUNK).map(|p| record(scene, p.triangle())).collect()
}
