//! Traversals: the twins of the kernels in `kernels/trace/STRUCTURE/`, one file each. All have the same two functions, nearest hit and any
//! hit; [`Traverse`] is their form for a whole work-group of 64 rays, which the packet traversal needs.

use crate::math::{MISS, Ray, T_MAX, Vertex};
use crate::workloads::trace::TriangleRef;
use crate::workloads::trace::count::Count;
use crate::workloads::trace::intersect::{TriangleHit, TriangleTest};
use glam::Vec3A;

/// Rays of a work-group.
pub const GROUP: usize = 64;

/// One value per ray of a work-group.
pub type Lanes<T> = [T; GROUP];

/// A traversal of a work-group's rays. Bit `i` of `alive` says whether ray `i` takes part.
pub trait Traverse: Sync {
    /// The triangle reference of each ray's nearest hit, or [`MISS`].
    fn nearest_hits<C: Count>(&self, rays: &Lanes<Ray>, alive: u64, counters: &mut Lanes<C>) -> Lanes<u32>;

    /// One bit for each ray that hits anything at a distance below `limit`.
    fn any_hits<C: Count>(&self, rays: &Lanes<Ray>, limit: f32, alive: u64, counters: &mut Lanes<C>) -> u64;
}

/// A traversal whose rays do not wait for each other (`kernels/lib/independent.wgsl`).
pub trait TraverseIndependent: Sync {
    /// The triangle reference of the nearest hit, or [`MISS`].
    fn nearest_hit<C: Count>(&self, ray: &Ray, count: &mut C) -> u32;

    /// True if anything is hit at a distance below `limit`.
    fn any_hit<C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> bool;
}

impl<T: TraverseIndependent> Traverse for T {
    fn nearest_hits<C: Count>(&self, rays: &Lanes<Ray>, alive: u64, counters: &mut Lanes<C>) -> Lanes<u32> {
        let mut found = [MISS; GROUP];
        for lane in bits(alive) {
            found[lane] = self.nearest_hit(&rays[lane], &mut counters[lane]);
        }
        found
    }

    fn any_hits<C: Count>(&self, rays: &Lanes<Ray>, limit: f32, alive: u64, counters: &mut Lanes<C>) -> u64 {
        bits(alive)
            .filter(|&lane| self.any_hit(&rays[lane], limit, &mut counters[lane]))
            .fold(0, |set, lane| set | 1 << lane)
    }
}

/// The indices of the bits that are set, in ascending order.
pub fn bits(mut set: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = set.trailing_zeros() as usize;
        set &= set.wrapping_sub(1);
        (lane < GROUP).then_some(lane)
    })
}

/// Vertices and triangle references: the twin of what `kernels/trace/scene.wgsl` binds.
#[derive(Clone, Copy)]
pub struct Triangles<'a> {
    /// Of the scene.
    pub vertices: &'a [Vertex],
    /// Of the structure.
    pub triangle_refs: &'a [TriangleRef],
    /// The ray/triangle test.
    pub test: TriangleTest,
}

/// The nearest hit so far. Of equal distances the lower triangle index wins, so that the order of tests is no matter.
#[derive(Clone, Copy)]
pub struct Best {
    /// Distance.
    pub t: f32,
    /// Triangle in the scene.
    pub triangle: u32,
    /// TriangleRef in the structure.
    pub triangle_ref: u32,
}

impl Best {
    /// Nothing yet.
    pub const NONE: Best = Best { t: T_MAX, triangle: MISS, triangle_ref: MISS };
}

impl Triangles<'_> {
    #[inline(always)]
    fn corners(&self, triangle_ref: &TriangleRef) -> [Vec3A; 3] {
        triangle_ref.vertices.map(|v| self.vertices[v as usize].position_a())
    }

    /// Tests one triangle reference.
    #[inline(always)]
    pub fn hit(&self, ray: &Ray, triangle_ref: &TriangleRef, limit: f32) -> Option<TriangleHit> {
        self.test.intersect(ray, self.corners(triangle_ref), limit)
    }

    /// Distance and barycentric coordinates of a triangle reference that was hit.
    #[inline(always)]
    pub fn surface(&self, ray: &Ray, triangle_ref: &TriangleRef) -> TriangleHit {
        self.test.surface(ray, self.corners(triangle_ref))
    }

    /// Tests the triangle references of a leaf or cell and keeps the nearest hit.
    #[inline(always)]
    pub fn test_triangles<C: Count>(&self, ray: &Ray, first: u32, count: u32, best: &mut Best, counted: &mut C) {
        for (triangle_ref, index) in self.triangle_refs[first as usize..][..count as usize].iter().zip(first..) {
            counted.test();
            if let Some(hit) = self.hit(ray, triangle_ref, best.t)
                && (hit.t < best.t || triangle_ref.triangle < best.triangle)
            {
                *best = Best { t: hit.t, triangle: triangle_ref.triangle, triangle_ref: index };
            }
        }
    }

    /// True if one of the triangle references is hit at a distance below `limit`.
    #[inline(always)]
    pub fn any_triangle_occludes<C: Count>(
        &self,
        ray: &Ray,
        first: u32,
        count: u32,
        limit: f32,
        counted: &mut C,
    ) -> bool {
        self.triangle_refs[first as usize..][..count as usize].iter().any(|triangle_ref| {
            counted.test();
            self.hit(ray, triangle_ref, limit).is_some_and(|hit| hit.t < limit)
        })
    }
}
