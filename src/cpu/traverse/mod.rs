//! Traversals: the twins of `kernels/traverse/`, one file each. All have the same two functions, nearest hit and any
//! hit; [`Traverse`] is their form for a whole work-group of 64 rays, which the packet traversal needs.

pub mod brute;
pub mod bvh;
pub mod bvh_stack;
pub mod grid;
pub mod grid_coop;
pub mod grid_packet;
pub mod kdtree;

use super::count::Count;
use crate::accel::Record;
use crate::intersect::{TriangleHit, TriangleTest};
use crate::math::{MISS, Ray, T_MAX, Vertex};
use glam::Vec3A;

/// Rays of a work-group.
pub const GROUP: usize = 64;

/// One value per ray of a work-group.
pub type Lanes<T> = [T; GROUP];

/// A traversal of a work-group's rays. Bit `i` of `alive` says whether ray `i` takes part.
pub trait Traverse: Sync {
    /// The record of each ray's nearest hit, or [`MISS`].
    fn nearest_hits<C: Count>(&self, rays: &Lanes<Ray>, alive: u64, counters: &mut Lanes<C>) -> Lanes<u32>;

    /// One bit for each ray that hits anything at a distance below `limit`.
    fn any_hits<C: Count>(&self, rays: &Lanes<Ray>, limit: f32, alive: u64, counters: &mut Lanes<C>) -> u64;
}

/// A traversal whose rays do not wait for each other (`kernels/lib/alone.wgsl`).
pub trait TraverseAlone: Sync {
    /// The record of the nearest hit, or [`MISS`].
    fn nearest_hit<C: Count>(&self, ray: &Ray, count: &mut C) -> u32;

    /// True if anything is hit at a distance below `limit`.
    fn any_hit<C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> bool;
}

impl<T: TraverseAlone> Traverse for T {
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

/// Vertices and records: the twin of what `kernels/lib/scene.wgsl` binds.
#[derive(Clone, Copy)]
pub struct Triangles<'a> {
    /// Of the scene.
    pub vertices: &'a [Vertex],
    /// Of the structure.
    pub records: &'a [Record],
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
    /// Record in the structure.
    pub record: u32,
}

impl Best {
    /// Nothing yet.
    pub const NONE: Best = Best { t: T_MAX, triangle: MISS, record: MISS };
}

impl Triangles<'_> {
    #[inline(always)]
    fn corners(&self, record: &Record) -> [Vec3A; 3] {
        record.vertices.map(|v| self.vertices[v as usize].position_a())
    }

    /// Tests one record.
    #[inline(always)]
    pub fn hit(&self, ray: &Ray, record: &Record, limit: f32) -> Option<TriangleHit> {
        self.test.intersect(ray, self.corners(record), limit)
    }

    /// Distance and barycentric coordinates of a record that was hit.
    #[inline(always)]
    pub fn surface(&self, ray: &Ray, record: &Record) -> TriangleHit {
        self.test.surface(ray, self.corners(record))
    }

    /// Tests the records of a leaf or cell and keeps the nearest hit.
    #[inline(always)]
    pub fn test_records<C: Count>(&self, ray: &Ray, first: u32, count: u32, best: &mut Best, counted: &mut C) {
        for (record, index) in self.records[first as usize..][..count as usize].iter().zip(first..) {
            counted.test();
            if let Some(hit) = self.hit(ray, record, best.t)
                && (hit.t < best.t || record.triangle < best.triangle)
            {
                *best = Best { t: hit.t, triangle: record.triangle, record: index };
            }
        }
    }

    /// True if one of the records is hit at a distance below `limit`.
    #[inline(always)]
    pub fn any_record_blocks<C: Count>(&self, ray: &Ray, first: u32, count: u32, limit: f32, counted: &mut C) -> bool {
        self.records[first as usize..][..count as usize].iter().any(|record| {
            counted.test();
            self.hit(ray, record, limit).is_some_and(|hit| hit.t < limit)
        })
    }
}
