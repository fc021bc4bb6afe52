//! Boxes, rays, triangles, and the two tests: ray/box and ray/triangle.
//!
//! This is the twin of `kernels/lib/geom.wgsl`, operation for operation: on a device that neither contracts nor
//! approximates (lavapipe), both give the same bits.
//!
//! **Why all traversals agree.** Both tests compute a distance along an axis as `(plane - origin) * inverse direction`.
//! Subtraction and multiplication round monotonically, so a box inside another box has a computed interval inside the
//! other's computed interval, without any epsilon. [`intersect`] makes a triangle's distance part of that order: a hit
//! counts only where the ray passes the triangle's own box by that same test, and its distance is clamped into the
//! box's interval. So no enclosing node, cell or leaf can be culled by rounding while the triangle inside it is hit,
//! and every structure finds exactly the hits of brute force.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec3A, Vec4};

/// No triangle, no record.
pub const MISS: u32 = u32::MAX;

/// Farther than any hit. Not infinity: WGSL lets an implementation assume that there is none.
pub const T_MAX: f32 = 3.0e38;

/// Stands for `1 / 0`: a direction component of zero is treated as this small a slope (see [`inverse`]).
pub const INVERSE_OF_ZERO: f32 = 1.0e30;

/// Determinants below this are parallel or degenerate; keeps the division finite.
pub const DETERMINANT_MIN: f32 = 1.0e-30;

/// An axis-aligned box. Empty when `min > max` on any axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest corner.
    pub min: Vec3,
    /// Largest corner.
    pub max: Vec3,
}

impl Aabb {
    /// The box that contains nothing and is neutral for [`Aabb::union`].
    pub const EMPTY: Aabb = Aabb { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The smallest box around some points.
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Aabb {
        points.into_iter().fold(Aabb::EMPTY, |b, p| Aabb { min: b.min.min(p), max: b.max.max(p) })
    }

    /// The smallest box around both.
    pub fn union(self, other: Aabb) -> Aabb {
        Aabb { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Edge lengths; negative for an empty box.
    pub fn extent(self) -> Vec3 {
        self.max - self.min
    }

    /// The middle.
    pub fn center(self) -> Vec3 {
        (self.min + self.max) * 0.5
    }

    /// Length of the diagonal.
    pub fn diagonal(self) -> f32 {
        self.extent().length()
    }

    /// Half the surface area; zero for an empty box.
    pub fn half_area(self) -> f32 {
        let e = self.extent().max(Vec3::ZERO);
        e.x * e.y + e.y * e.z + e.z * e.x
    }

    /// True if it contains no point.
    pub fn is_empty(self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// True if `other` lies inside (an empty box lies inside every box).
    pub fn contains(self, other: Aabb) -> bool {
        other.is_empty() || (self.min.cmple(other.min).all() && self.max.cmpge(other.max).all())
    }
}

/// A ray with everything that the tests need. Distances along it are in units of `direction`'s length.
///
/// The fourth, hidden lane of the vectors is 1: box tests load whole 16-byte rows whose last word is an index, and an
/// index read as a float is denormal, which costs a hundred cycles unless something ordinary is subtracted from it.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3A,
    /// Where it goes; need not be normalised.
    pub direction: Vec3A,
    /// `1 / direction` per component, see [`inverse`].
    pub inv_direction: Vec3A,
}

impl Ray {
    /// A ray from `origin` along `direction`.
    #[inline]
    pub fn new(origin: Vec3A, direction: Vec3A) -> Ray {
        let one = |v: Vec3A| Vec3A::from_vec4(Vec4::new(v.x, v.y, v.z, 1.0));
        Ray { origin: one(origin), direction, inv_direction: one(inverse(direction)) }
    }

    /// The point at distance `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3A {
        self.origin + self.direction * t
    }
}

/// `1 / direction` per component. A component so small that the quotient would leave the range of floats counts as
/// positive and has the inverse [`INVERSE_OF_ZERO`].
#[inline]
pub fn inverse(direction: Vec3A) -> Vec3A {
    let one = |d: f32| if d.abs() < 1.0 / INVERSE_OF_ZERO { INVERSE_OF_ZERO } else { 1.0 / d };
    Vec3A::new(one(direction.x), one(direction.y), one(direction.z))
}

/// A found hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance in units of the ray direction's length.
    pub t: f32,
    /// Index of the triangle in the scene, [`MISS`] if there is none.
    pub triangle: u32,
}

impl Hit {
    /// No hit.
    pub const NONE: Hit = Hit { t: T_MAX, triangle: MISS };
}

/// The interval of distances inside the box: `(near, far)`, empty when `near > far`.
///
/// Slab test with min and max only, after Smits; the interval is not clamped to the ray's start.
#[inline(always)]
pub fn ray_box(ray: &Ray, min: Vec3A, max: Vec3A) -> (f32, f32) {
    let a = (min - ray.origin) * ray.inv_direction;
    let b = (max - ray.origin) * ray.inv_direction;
    (a.min(b).max_element(), a.max(b).min_element())
}

/// A triangle that was hit: distance and barycentric coordinates (of the second and the third corner).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Distance, `0 < t <= t_max`.
    pub t: f32,
    /// Weight of the second corner.
    pub u: f32,
    /// Weight of the third corner.
    pub v: f32,
}

/// Ray/triangle test after Möller and Trumbore, two-sided, division only for hits; `Some` where `0 < t <= t_max`.
///
/// What makes it order-consistent with [`ray_box`] is described at the head of this module.
// Comparisons are written so that NaN, which degenerate input may bring, fails them.
#[inline(always)]
pub fn intersect(ray: &Ray, v0: Vec3A, v1: Vec3A, v2: Vec3A, t_max: f32) -> Option<TriangleHit> {
    let e1 = v1 - v0;
    let e2 = v2 - v0;
    let p = ray.direction.cross(e2);
    let signed_det = e1.dot(p);
    let sign = if signed_det < 0.0 { -1.0 } else { 1.0 };
    let det = signed_det * sign;
    if !(det >= DETERMINANT_MIN) {
        return None;
    }
    let s = ray.origin - v0;
    let u = s.dot(p) * sign;
    if !(u >= 0.0 && u <= det) {
        return None;
    }
    let q = s.cross(e1);
    let v = ray.direction.dot(q) * sign;
    if !(v >= 0.0 && u + v <= det) {
        return None;
    }
    // Only the clamped distance is compared: whether a hit counts must not depend on the order of the tests.
    let t = e2.dot(q) * sign / det;
    let (near, far) = ray_box(ray, v0.min(v1).min(v2), v0.max(v1).max(v2));
    let t = t.max(near).min(far);
    if near > far || !(t > 0.0 && t <= t_max) {
        return None;
    }
    Some(TriangleHit { t, u: u / det, v: v / det })
}

/// A vertex as the device sees it: 32 bytes, two vec4 (SPEC section 1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Vertex {
    /// Position.
    pub position: Vec3,
    /// Zero; WGSL's vec4.
    pub pad0: f32,
    /// Unit normal, or zero where none could be computed.
    pub normal: Vec3,
    /// Zero; WGSL's vec4.
    pub pad1: f32,
}

impl Vertex {
    /// A vertex.
    pub fn new(position: Vec3, normal: Vec3) -> Vertex {
        Vertex { position, pad0: 0.0, normal, pad1: 0.0 }
    }

    /// The position, loaded as one 16-byte row.
    #[inline(always)]
    pub fn position_a(&self) -> Vec3A {
        let rows: &[Vec4; 2] = bytemuck::cast_ref(self);
        Vec3A::from_vec4(rows[0])
    }

    /// The normal, loaded as one 16-byte row.
    #[inline(always)]
    pub fn normal_a(&self) -> Vec3A {
        let rows: &[Vec4; 2] = bytemuck::cast_ref(self);
        Vec3A::from_vec4(rows[1])
    }
}
