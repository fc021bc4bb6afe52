//! What builders sort: the box of every triangle that can be hit, 32 bytes each, and the triangle references they end
//! up as.

use crate::error::{Error, Result};
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::TriangleRef;
use bytemuck::Zeroable;
use glam::{Vec3A, Vec4};
use rayon::prelude::*;

/// Most triangles that a structure can hold: kd-tree links have 30 bits, and a triangle's index must survive as the
/// hidden lane of a float vector (see [`Prim`]).
pub const MAX_TRIANGLES: usize = 1 << 29;

/// Triangles handled together where work is shared out between threads: a constant, so that no result depends on the
/// number of threads. Small, so that no thread waits long for the one that began last.
pub const CHUNK: usize = 2048;

/// Nodes of more triangles than this are worked on by several threads at once; smaller nodes are built in parallel with
/// each other instead.
pub(crate) const SHARED: usize = 32_768;

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
    /// A placeholder where no triangle has been put yet.
    pub const NONE: Prim = Prim { min: Vec4::ONE, max: Vec4::ONE };

    /// Index of the triangle in the scene.
    #[inline(always)]
    pub fn triangle(&self) -> u32 {
        self.max.w.to_bits() ^ TAG
    }

    /// True for [`Prim::NONE`] alone.
    #[inline(always)]
    fn is_none(&self) -> bool {
        self.max.w == Prim::NONE.max.w
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

/// The boxes of all triangles that can be hit, in scene order, and the box around them; [`Aabb::EMPTY`] around none.
pub fn prims(scene: &Scene) -> Result<(Vec<Prim>, Aabb)> {
    gather(scene, Prim::NONE, |prim| prim, |prim| prim)
}

/// Something made of the box of every triangle that can be hit, in scene order, and the box around them all. `none`
/// must hold [`Prim::NONE`].
pub(crate) fn gather<T: Copy + Send + Sync>(
    scene: &Scene,
    none: T,
    make: impl Fn(Prim) -> T + Sync,
    prim_of: impl Fn(&T) -> &Prim + Sync,
) -> Result<(Vec<T>, Aabb)> {
    let count = scene.triangles.len();
    if count >= MAX_TRIANGLES {
        return Err(Error::too_large(
            &scene.name,
            format!("{count} triangles are more than a structure can hold ({})", MAX_TRIANGLES - 1),
            "use a smaller scene",
        ));
    }
    let indices = (0..count as u32).into_par_iter().with_min_len(CHUNK);
    let mut items: Vec<T> = indices.map(|i| prim(scene, i).map_or(none, &make)).collect();
    // Whether any is missing comes out of the pass that the box takes anyway.
    let mut all = around(&items, &prim_of);
    if all.none > 0 {
        items.retain(|item| !prim_of(item).is_none());
        all = around(&items, &prim_of);
    }
    Ok((items, all.bounds))
}

/// What lies around some items, and how many of them are [`Prim::NONE`].
struct Around {
    bounds: Aabb,
    none: usize,
}

fn around<T: Sync>(items: &[T], prim_of: impl Fn(&T) -> &Prim + Sync) -> Around {
    let part = |chunk: &[T]| {
        let (mut min, mut max, mut none) = (Vec4::INFINITY, Vec4::NEG_INFINITY, 0);
        for prim in chunk.iter().map(&prim_of) {
            (min, max) = (min.min(prim.min), max.max(prim.max));
            none += usize::from(prim.is_none());
        }
        Around { bounds: Aabb { min: min.truncate(), max: max.truncate() }, none }
    };
    let parts: Vec<Around> = items.par_chunks(CHUNK).map(part).collect();
    parts.iter().fold(Around { bounds: Aabb::EMPTY, none: 0 }, |all, part| Around {
        bounds: all.bounds.union(part.bounds),
        none: all.none + part.none,
    })
}

/// The triangle reference of triangle `index`.
#[inline]
pub fn triangle_ref(scene: &Scene, index: u32) -> TriangleRef {
    TriangleRef { vertices: scene.triangles[index as usize].vertices, triangle: index }
}

/// The triangle references of some prims, in their order.
pub fn triangle_refs(scene: &Scene, prims: &[Prim]) -> Vec<TriangleRef> {
    prims.par_iter().with_min_len(CHUNK).map(|p| triangle_ref(scene, p.triangle())).collect()
}
