//! Ray/triangle tests. Twins of `kernels/trace/intersect/`, file by file and operation for operation.
//!
//! Each test has two functions: one that decides whether a triangle is hit, and one that gives distance and barycentric
//! coordinates of a triangle that was hit, which cannot miss: a device may compile two copies of the same test
//! differently, and a surface must not vanish between them.

pub mod moller_trumbore;
pub mod watertight;

use crate::math::Ray;
use glam::Vec3A;

/// Which ray/triangle test is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TriangleTest {
    /// The test of [`watertight`]: no ray passes between two triangles that share an edge.
    #[default]
    Watertight,
    /// The test of [`moller_trumbore`], which loses rays at edges.
    MollerTrumbore,
}

/// A triangle that was hit: distance and barycentric coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Distance, `0 < t <= t_max`.
    pub t: f32,
    /// Weight of the second corner.
    pub u: f32,
    /// Weight of the third corner.
    pub v: f32,
    /// Weight of the first corner.
    pub w: f32,
}

impl TriangleTest {
    /// The hit of a two-sided triangle at a distance `0 < t <= t_max`.
    #[inline(always)]
    pub fn intersect(self, ray: &Ray, corners: [Vec3A; 3], t_max: f32) -> Option<TriangleHit> {
        match self {
            TriangleTest::Watertight => watertight::intersect(ray, corners, t_max),
            TriangleTest::MollerTrumbore => moller_trumbore::intersect(ray, corners, t_max),
        }
    }

    /// Distance and barycentric coordinates of a triangle that [`TriangleTest::intersect`] has hit.
    #[inline(always)]
    pub fn surface(self, ray: &Ray, corners: [Vec3A; 3]) -> TriangleHit {
        match self {
            TriangleTest::Watertight => watertight::surface(ray, corners),
            TriangleTest::MollerTrumbore => moller_trumbore::surface(ray, corners),
        }
    }
}
