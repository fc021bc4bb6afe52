//! The test of T. Möller and B. Trumbore (1997), two-sided. Twin of `kernels/trace/intersect/moller_trumbore.wgsl`.
//!
//! It rounds barycentric coordinates per triangle, so that a ray through an edge may miss both triangles. The interval
//! of the triangle's own box bounds the distance, as in every test (see [`crate::math`]).

use crate::math::{Ray, ray_box};
use crate::workloads::trace::intersect::TriangleHit;
use glam::Vec3A;

/// Determinants below this are parallel or degenerate; keeps the division finite.
pub const DETERMINANT_MIN: f32 = 1.0e-30;

/// Numerators of distance and barycentric coordinates over the common denominator `det >= 0`.
struct Solution {
    t: f32,
    u: f32,
    v: f32,
    det: f32,
}

#[inline(always)]
fn solve(ray: &Ray, [v0, v1, v2]: [Vec3A; 3]) -> Solution {
    let e1 = v1 - v0;
    let e2 = v2 - v0;
    let p = ray.direction.cross(e2);
    let signed_det = e1.dot(p);
    let sign = if signed_det < 0.0 { -1.0 } else { 1.0 };
    let s = ray.origin - v0;
    let q = s.cross(e1);
    Solution { t: e2.dot(q) * sign, u: s.dot(p) * sign, v: ray.direction.dot(q) * sign, det: signed_det * sign }
}

impl Solution {
    /// The hit, and whether the ray passes the triangle's own box.
    #[inline(always)]
    fn hit(&self, ray: &Ray, [v0, v1, v2]: [Vec3A; 3]) -> (TriangleHit, bool) {
        let det = self.det.max(DETERMINANT_MIN);
        let (near, far) = ray_box(ray, v0.min(v1).min(v2), v0.max(v1).max(v2));
        // Only the clamped distance is compared: whether a hit counts must not depend on the order of the tests.
        let t = (self.t / det).max(near).min(far);
        let (u, v) = (self.u / det, self.v / det);
        (TriangleHit { t, u, v, w: 1.0 - u - v }, near <= far)
    }
}

/// The hit of a two-sided triangle at a distance `0 < t <= t_max`.
// Comparisons are written so that NaN, which degenerate input may bring, fails them.
#[inline(always)]
pub fn intersect(ray: &Ray, corners: [Vec3A; 3], t_max: f32) -> Option<TriangleHit> {
    let s = solve(ray, corners);
    if !(s.det >= DETERMINANT_MIN && s.u >= 0.0 && s.u <= s.det && s.v >= 0.0 && s.u + s.v <= s.det) {
        return None;
    }
    let (hit, in_box) = s.hit(ray, corners);
    (in_box && hit.t > 0.0 && hit.t <= t_max).then_some(hit)
}

/// Distance and barycentric coordinates of a triangle that [`intersect`] has hit.
#[inline(always)]
pub fn surface(ray: &Ray, corners: [Vec3A; 3]) -> TriangleHit {
    solve(ray, corners).hit(ray, corners).0
}
