//! Traversals: the twins of the kernels in `kernels/trace/STRUCTURE/`, one file each. Each has one loop for nearest hit
//! and any hit; [`Traverse`] is its form for a whole work-group of 64 rays, which packets need.

use crate::math::{MISS, Ray, T_MAX, Vertex};
use crate::workloads::trace::TriangleRef;
use crate::workloads::trace::count::{Count, CountOff, Counters, Tally};
use crate::workloads::trace::intersect::{TriangleHit, TriangleTest};
use crate::workloads::trace::simt::Stream;
use glam::Vec3A;

/// Rays of a work-group.
pub const GROUP: usize = 64;

/// Entries of a full stack, with the one at the bottom; deeper trees are refused when they are prepared.
pub const STACK_SIZE: usize = 96;

/// One value per ray of a work-group.
pub type Lanes<T> = [T; GROUP];

/// A traversal of a work-group's rays. Bit `i` of `alive` says whether ray `i` takes part.
pub trait Traverse: Sync {
    /// For each ray the triangle reference of its nearest hit before `limit`, with `ANY` of some hit there, or
    /// [`MISS`].
    fn traverse<const ANY: bool, C: Count>(
        &self,
        rays: &Lanes<Ray>,
        limit: f32,
        alive: u64,
        counters: &mut Lanes<C>,
    ) -> Lanes<u32>;

    /// The nearest hits of the primary rays of 8 x 8 pixels in Morton order.
    fn primary_hits<C: Count>(&self, rays: &Lanes<Ray>, alive: u64, counters: &mut Lanes<C>) -> Lanes<u32> {
        self.traverse::<false, C>(rays, T_MAX, alive, counters)
    }
}

/// What rays search for.
#[derive(Clone, Copy, Debug)]
pub enum Search {
    /// The nearest hit of the primary rays of 8 x 8 pixels in Morton order.
    Primary,
    /// The nearest hit.
    Nearest,
    /// Any hit before this distance.
    Any(f32),
}

/// A [`Traverse`] behind a pointer: frames are compiled once, and not once for each traversal.
pub trait Traverser: Sync {
    /// Counts nothing.
    fn uncounted(&self, search: Search, rays: &Lanes<Ray>, alive: u64) -> Lanes<u32>;

    /// Adds to `counters` of rays of a type.
    fn counted(&self, of: (usize, Search), rays: &Lanes<Ray>, alive: u64, counters: &mut Lanes<Counters>)
    -> Lanes<u32>;

    /// Appends to `streams`.
    fn recorded(&self, search: Search, rays: &Lanes<Ray>, alive: u64, streams: &mut Lanes<Stream>) -> Lanes<u32>;
}

impl<T: Traverse> Traverser for T {
    fn uncounted(&self, search: Search, rays: &Lanes<Ray>, alive: u64) -> Lanes<u32> {
        find(self, search, rays, alive, &mut [CountOff; GROUP])
    }

    fn counted(
        &self,
        (_, search): (usize, Search),
        rays: &Lanes<Ray>,
        alive: u64,
        counters: &mut Lanes<Counters>,
    ) -> Lanes<u32> {
        find(self, search, rays, alive, counters)
    }

    fn recorded(&self, search: Search, rays: &Lanes<Ray>, alive: u64, streams: &mut Lanes<Stream>) -> Lanes<u32> {
        find(self, search, rays, alive, streams)
    }
}

fn find<T: Traverse, C: Count>(
    traversal: &T,
    search: Search,
    rays: &Lanes<Ray>,
    alive: u64,
    counters: &mut Lanes<C>,
) -> Lanes<u32> {
    match search {
        Search::Primary => traversal.primary_hits(rays, alive, counters),
        Search::Nearest => traversal.traverse::<false, C>(rays, T_MAX, alive, counters),
        Search::Any(limit) => traversal.traverse::<true, C>(rays, limit, alive, counters),
    }
}

impl dyn Traverser + '_ {
    /// The triangle reference of each ray's nearest hit, or [`MISS`]. `kind` is the type of the rays.
    pub fn nearest_hits<C: Tally>(
        &self,
        kind: usize,
        rays: &Lanes<Ray>,
        alive: u64,
        counters: &mut Lanes<C>,
    ) -> Lanes<u32> {
        C::traverse(self, (kind, Search::Nearest), rays, alive, counters)
    }

    /// The same for the primary rays of 8 x 8 pixels in Morton order.
    pub fn primary_hits<C: Tally>(&self, rays: &Lanes<Ray>, alive: u64, counters: &mut Lanes<C>) -> Lanes<u32> {
        C::traverse(self, (0, Search::Primary), rays, alive, counters)
    }

    /// One bit for each ray that hits anything at a distance below `limit`.
    pub fn any_hits<C: Tally>(
        &self,
        kind: usize,
        rays: &Lanes<Ray>,
        limit: f32,
        alive: u64,
        counters: &mut Lanes<C>,
    ) -> u64 {
        let found = C::traverse(self, (kind, Search::Any(limit)), rays, alive, counters);
        set_of(bits(alive).filter(|&lane| found[lane] != MISS))
    }
}

/// A traversal whose rays do not wait for each other (`kernels/lib/independent.wgsl`).
pub trait TraverseIndependent: Sync {
    /// The triangle reference of the nearest hit before `limit`, with `ANY` of some hit there, or [`MISS`].
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32;
}

impl<T: TraverseIndependent> Traverse for T {
    fn traverse<const ANY: bool, C: Count>(
        &self,
        rays: &Lanes<Ray>,
        limit: f32,
        alive: u64,
        counters: &mut Lanes<C>,
    ) -> Lanes<u32> {
        let mut found = [MISS; GROUP];
        for lane in bits(alive) {
            found[lane] = TraverseIndependent::traverse::<ANY, C>(self, &rays[lane], limit, &mut counters[lane]);
        }
        found
    }
}

/// The bits of these indices.
pub fn set_of(lanes: impl Iterator<Item = usize>) -> u64 {
    lanes.fold(0, |set, lane| set | 1 << lane)
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

/// The nearest hit so far. Of equal distances the lower triangle index wins, so that the order of tests does not
/// matter.
#[derive(Clone, Copy)]
pub struct Best {
    /// Its distance; the limit of the search as long as nothing is hit.
    pub t: f32,
    /// Its triangle in the scene; 0 as long as nothing is hit, since no index is lower: nothing at the limit is a hit.
    pub triangle: u32,
    /// Its triangle reference in the structure, or [`MISS`].
    pub triangle_ref: u32,
}

impl Best {
    /// The begin of a search for hits before `limit`.
    #[inline(always)]
    pub fn before(limit: f32) -> Best {
        Best { t: limit, triangle: 0, triangle_ref: MISS }
    }
}

impl Triangles<'_> {
    #[inline(always)]
    fn corners(&self, triangle_ref: &TriangleRef) -> [Vec3A; 3] {
        triangle_ref.vertices.map(|v| self.vertices[v as usize].position_a())
    }

    /// Tests one triangle.
    #[inline(always)]
    pub fn hit(&self, ray: &Ray, triangle_ref: &TriangleRef, limit: f32) -> Option<TriangleHit> {
        self.test.intersect(ray, self.corners(triangle_ref), limit)
    }

    /// Distance and barycentric coordinates of a triangle reference that was hit.
    #[inline(always)]
    pub fn surface(&self, ray: &Ray, triangle_ref: &TriangleRef) -> TriangleHit {
        self.test.surface(ray, self.corners(triangle_ref))
    }

    /// Tests the triangles of a leaf or cell for the nearest hit; with `ANY`, only up to the first one that is hit.
    /// True if that ends the search.
    #[inline(always)]
    pub fn test<const ANY: bool, C: Count>(
        &self,
        ray: &Ray,
        first: u32,
        count: u32,
        best: &mut Best,
        counted: &mut C,
    ) -> bool {
        for (triangle_ref, index) in self.triangle_refs[first as usize..][..count as usize].iter().zip(first..) {
            counted.test();
            counted.read(index);
            if let Some(hit) = self.hit(ray, triangle_ref, best.t)
                && (hit.t < best.t || (!ANY && triangle_ref.triangle < best.triangle))
            {
                *best = Best { t: hit.t, triangle: triangle_ref.triangle, triangle_ref: index };
                if ANY {
                    return true;
                }
            }
        }
        false
    }
}
