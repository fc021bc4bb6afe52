//! Boxes, rays, and the ray/box test. The ray/triangle tests are in [`crate::workloads::trace::intersect`].
//!
//! This is the twin of `kernels/lib/geom.wgsl`, operation for operation: on a device that neither contracts nor
//! approximates (lavapipe), both give the same bits.
//!
//! **Why all traversals agree.** All tests compute a distance along an axis as `(plane - origin) * inverse direction`.
//! Subtraction and multiplication round monotonically, so a box inside another box has a computed interval inside the
//! other's computed interval, without any epsilon. The ray/triangle tests make a triangle's distance part of that
//! order: a hit counts only where the ray passes the triangle's own box by that same test, and its distance is clamped
//! into the box's interval. So no enclosing node, cell or leaf can be culled by rounding while the triangle inside it
//! is hit, and every structure finds exactly the hits of brute force.
//!
//! **Directions with a component of zero.** On such an axis distances to planes are `difference * 2^80`: far beyond
//! every hit, or zero for a plane that the ray lies in. Zero would cut the interval at the ray's start, on one of the
//! two sides of the plane. So lower planes are compared with an origin that is shifted up a little, and upper planes
//! with one that is shifted down ([`Ray::origin_min`], [`Ray::origin_max`]): a box that contains the origin on that
//! axis, its borders included, spans -2^50 to 2^50 at least. The shift is the same for all planes, so the order of
//! distances is kept.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec3A, Vec4};

/// Index of a triangle, node or triangle reference that does not exist.
pub const MISS: u32 = u32::MAX;

/// A distance beyond every hit. It is finite because WGSL lets an implementation assume that there are no infinities.
pub const T_MAX: f32 = 3.0e38;

/// Replaces `1 / 0`, see [`inverse`]: 2^80. A coordinate of up to 1e13 multiplied by it is still a float.
pub const INVERSE_OF_ZERO: f32 = (1_u128 << 80) as f32;

/// Added to both ends of a triangle's interval on an axis on which the direction is zero: 2^49, farther than any hit.
/// The planes of boxes are moved by [`PLANE_SHIFT_MIN`] there, which is more.
pub const SLACK: f32 = (1_u64 << 49) as f32;

/// On an axis on which the direction is zero, a plane within this share of the origin's coordinate counts as one that
/// the ray lies in: 2^-20. It is above the rounding of coordinates, so that the shifted origin always differs.
pub const PLANE_SHIFT: f32 = 1.0 / (1 << 20) as f32;

/// Smallest such shift: 2^-30. Times [`INVERSE_OF_ZERO`] it is 2^50, twice [`SLACK`].
pub const PLANE_SHIFT_MIN: f32 = 1.0 / (1 << 30) as f32;

/// An axis-aligned box. Empty when `min > max` on any axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The smallest coordinate on each axis.
    pub min: Vec3,
    /// The largest coordinate on each axis.
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

    /// The centre; NaN for [`Aabb::EMPTY`].
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

/// A ray with the values that box and triangle tests precompute. Distances along it are in units of `direction`'s
/// length.
///
/// The fourth, hidden lane of the vectors is 1: box tests load whole 16-byte rows whose last word is an index, and an
/// index read as a float is denormal, which costs a hundred cycles unless something ordinary is subtracted from it.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// The point at which the ray starts.
    pub origin: Vec3A,
    /// The direction; need not be normalised.
    pub direction: Vec3A,
    /// `1 / direction` per component, see [`inverse`].
    pub inv_direction: Vec3A,
    /// `origin`, shifted up by a small amount on axes on which the direction is zero. The lower planes of boxes are
    /// compared with it, so that a ray in the lower plane of a box lies inside the box.
    pub origin_min: Vec3A,
    /// `origin`, shifted down by a small amount on axes on which the direction is zero. The upper planes of boxes are
    /// compared with it.
    pub origin_max: Vec3A,
    /// Powers of two near the direction's components, see [`crate::workloads::trace::intersect::watertight`].
    pub scale: Vec3A,
    /// `scale`, but zero on axes on which the direction is zero; the major axis always has `scale`.
    pub shear: Vec3A,
    /// [`SLACK`] on axes on which the direction is zero, and zero on the others.
    pub slack: Vec3A,
    /// The axis of the largest direction component; of equal components, the first.
    pub major: usize,
}

impl Ray {
    /// A ray from `origin` along `direction`.
    #[inline]
    pub fn new(origin: Vec3A, direction: Vec3A) -> Ray {
        let with_lane = |v: Vec3A| Vec3A::from_vec4(Vec4::new(v.x, v.y, v.z, 1.0));
        let inv = inverse(direction);
        let parallel = inv.cmpeq(Vec3A::splat(INVERSE_OF_ZERO));
        let shift = (origin.abs() * PLANE_SHIFT).max(Vec3A::splat(PLANE_SHIFT_MIN));
        let shift = Vec3A::select(parallel, shift, Vec3A::ZERO);
        let scale = Vec3A::from_array(inv.to_array().map(power_below));
        let steep = inv.abs();
        let major = if steep.x <= steep.y && steep.x <= steep.z {
            0
        } else if steep.y <= steep.z {
            1
        } else {
            2
        };
        let mut shear = Vec3A::select(parallel, Vec3A::ZERO, scale);
        shear[major] = scale[major];
        Ray {
            origin: with_lane(origin),
            direction,
            inv_direction: with_lane(inv),
            origin_min: with_lane(origin + shift),
            origin_max: with_lane(origin - shift),
            scale,
            shear,
            slack: Vec3A::select(parallel, Vec3A::splat(SLACK), Vec3A::ZERO),
            major,
        }
    }

    /// The point at distance `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3A {
        self.origin + self.direction * t
    }
}

/// `1 / direction` per component. A component so small that the quotient would reach [`INVERSE_OF_ZERO`] counts as
/// zero, and [`INVERSE_OF_ZERO`] is its inverse.
#[inline]
pub fn inverse(direction: Vec3A) -> Vec3A {
    let one = |d: f32| if d.abs() <= 1.0 / INVERSE_OF_ZERO { INVERSE_OF_ZERO } else { 1.0 / d };
    Vec3A::new(one(direction.x), one(direction.y), one(direction.z))
}

/// The reciprocal of the largest power of two that is not above `|x|`, for a normal `x`.
#[inline]
fn power_below(x: f32) -> f32 {
    f32::from_bits(0x7f00_0000_u32.wrapping_sub(x.to_bits() & 0x7f80_0000))
}

/// The nearest intersection of a ray, or [`Hit::NONE`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance in units of the ray direction's length.
    pub t: f32,
    /// Index of the triangle in the scene, [`MISS`] if there is none.
    pub triangle: u32,
}

impl Hit {
    /// The result for a ray that hits nothing.
    pub const NONE: Hit = Hit { t: T_MAX, triangle: MISS };
}

/// The interval of distances that lie inside the box, as `(near, far)`; it is empty when `near > far`.
///
/// This is Smits's slab test with min and max only; the interval is not clamped to the ray's start.
///
/// A ray that lies in a border plane of the box is inside, at the lower and at the upper plane.
#[inline(always)]
pub fn ray_box(ray: &Ray, min: Vec3A, max: Vec3A) -> (f32, f32) {
    let a = (min - ray.origin_min) * ray.inv_direction;
    let b = (max - ray.origin_max) * ray.inv_direction;
    (a.min(b).max_element(), a.max(b).min_element())
}

/// A vertex as it is stored on the device: 32 bytes, two vec4.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Vertex {
    /// Position in the scene's coordinates in memory.
    pub position: Vec3,
    /// Padding of WGSL's vec4; always zero.
    pub pad0: f32,
    /// Unit normal, or zero where none could be computed.
    pub normal: Vec3,
    /// Padding of WGSL's vec4; always zero.
    pub pad1: f32,
}

impl Vertex {
    /// A vertex with zero padding.
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
