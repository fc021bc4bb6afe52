//! A watertight ray/triangle test in distance space. Twin of `kernels/trace/intersect/watertight.wgsl`.
//!
//! Each corner is mapped by the box test's own operations, `p = (corner - origin) * inverse direction`: its distances
//! along the ray by axis. In this space the ray is the diagonal, and the smallest and largest coordinates of the three
//! corners are the interval of the triangle's own box, since the map is monotone.
//!
//! Along the diagonal the corners are projected to the plane across the ray's major axis k: `q = p * scale - p.k *
//! scale`, with powers of two near the direction's components as scale, which changes no bit but keeps products in
//! range. Every corner so has one rounded 2D position per ray, whichever triangle asks, and the ray is the point 0. It
//! is inside a triangle if the signs of the three edge functions agree. Such a sign is found by comparing two rounded
//! products. Rounding is monotone, so a sign is never wrong; it may only be zero where the exact one is not. Two
//! triangles that share an edge compare the same two numbers. So the accepted area of a triangle covers the triangle of
//! its rounded corners, these cover the mesh without gaps, and a ray through an edge or a vertex hits at least one of
//! its triangles. A triangle seen edge-on, whose signs are all zero, is missed. A nearly edge-on triangle may be hit
//! outside its area where two signs round to zero; the interval of its own box bounds that.
//!
//! No compiler can spoil this by contracting operations: comparisons are not contracted, and of the two products in `q`
//! the factor `scale` is a power of two, so that fusing changes nothing.
//!
//! On an axis on which the direction is zero, a corner's position is its own difference from the origin.

use crate::math::Ray;
use crate::workloads::trace::intersect::TriangleHit;
use glam::{Vec3A, Vec3Swizzles};

/// A triangle as a ray sees it.
struct Projected {
    /// Distances of the corners along the major axis.
    along: [f32; 3],
    /// Twice the signed areas of the triangles between the ray and the edge opposite each corner.
    edges: [f32; 3],
    /// The interval of the triangle's own box.
    near: f32,
    /// See `near`.
    far: f32,
    inside: bool,
}

#[inline(always)]
fn project(ray: &Ray, corners: [Vec3A; 3]) -> Projected {
    let p = corners.map(|corner| (corner - ray.origin) * ray.inv_direction);
    let along = p.map(|p| p[ray.major]);
    // The component of the major axis is 0, so that of a cross product's components only that of the major axis is not
    let [a, b, c]: [Vec3A; 3] = std::array::from_fn(|i| p[i] * ray.scale - Vec3A::splat(along[i]) * ray.shear);
    let products = |b: Vec3A, c: Vec3A| (b.yzx() * c.zxy(), b.zxy() * c.yzx());
    let sides = [products(b, c), products(c, a), products(a, b)];
    let [positive, negative] =
        [sides.iter().all(|(p, q)| p.cmpge(*q).all()), sides.iter().all(|(p, q)| p.cmple(*q).all())];
    Projected {
        along,
        edges: sides.map(|(p, q)| (p - q).element_sum()),
        near: (p[0].min(p[1]).min(p[2]) - ray.slack).max_element(),
        far: (p[0].max(p[1]).max(p[2]) + ray.slack).min_element(),
        inside: positive != negative,
    }
}

impl Projected {
    #[inline(always)]
    fn hit(&self) -> TriangleHit {
        let ([e0, e1, e2], [t0, t1, t2]) = (self.edges, self.along);
        let sum = e0 + e1 + e2;
        let scale = 1.0 / if sum == 0.0 { 1.0 } else { sum };
        let t = ((e0 * t0 + e1 * t1 + e2 * t2) * scale).max(self.near).min(self.far);
        TriangleHit { t, u: e1 * scale, v: e2 * scale, w: e0 * scale }
    }
}

/// The hit of a two-sided triangle at a distance `0 < t <= t_max`.
#[inline(always)]
pub fn intersect(ray: &Ray, corners: [Vec3A; 3], t_max: f32) -> Option<TriangleHit> {
    let projected = project(ray, corners);
    if !projected.inside || projected.near > projected.far {
        return None;
    }
    let hit = projected.hit();
    (hit.t > 0.0 && hit.t <= t_max).then_some(hit)
}

/// Distance and barycentric coordinates of a triangle that [`intersect`] has hit.
#[inline(always)]
pub fn surface(ray: &Ray, corners: [Vec3A; 3]) -> TriangleHit {
    project(ray, corners).hit()
}
