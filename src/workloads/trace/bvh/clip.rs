//! The part of a triangle on either side of a plane, as a box that is safe to cull by.

use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::bvh::bins::Rows;
use crate::workloads::trace::common::prims::Prim;
use glam::{Vec4, Vec4Swizzles};

/// A clipped box grows by this share of the scene's largest extent, and by this share of its largest coordinate: the
/// ray/triangle test accepts hits that lie outside of the triangle by some roundings, and corners of the clipped
/// triangle are rounded as well.
const EXTENT_SHARE: f32 = 1.0e-6;
const COORDINATE_SHARE: f32 = 1.0 / (1 << 22) as f32;

/// Clips triangles of a scene.
pub(crate) struct Clipper<'a> {
    scene: &'a Scene,
    margin: Vec4,
}

impl<'a> Clipper<'a> {
    pub fn new(scene: &'a Scene, bounds: &Aabb) -> Clipper<'a> {
        let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
        let margin = bounds.extent().max_element() * EXTENT_SHARE + largest * COORDINATE_SHARE;
        Clipper { scene, margin: Vec4::splat(margin.clamp(f32::MIN_POSITIVE, f32::MAX)) }
    }

    /// Corners of the triangle of a reference; their fourth lanes mean nothing.
    #[inline(always)]
    pub fn corners(&self, reference: &Prim) -> [Vec4; 3] {
        self.scene.corners(reference.triangle()).map(|corner| corner.extend(1.0))
    }

    /// The boxes of what lies on the lower and the upper side of a plane across the box of a reference: each the box of
    /// the triangle's part there, grown by the margin, and cut off at the plane and at the box of the reference. `None`
    /// for a side on which the box is empty.
    #[inline]
    pub fn cut(&self, reference: &Prim, axis: usize, plane: f32) -> [Option<Prim>; 2] {
        let corners = self.corners(reference);
        let (mut low, mut high) = (Rows::EMPTY, Rows::EMPTY);
        let mut from = corners[2];
        for to in corners {
            let (a, b) = (from[axis], to[axis]);
            if b <= plane {
                low.grow(to, to);
            }
            if b >= plane {
                high.grow(to, to);
            }
            if (a < plane && plane < b) || (b < plane && plane < a) {
                let crossing = from + (to - from) * ((plane - a) / (b - a));
                low.grow(crossing, crossing);
                high.grow(crossing, crossing);
            }
            from = to;
        }
        let mut lower = self.within(low, reference);
        lower.max[axis] = lower.max[axis].min(plane);
        let mut upper = self.within(high, reference);
        upper.min[axis] = upper.min[axis].max(plane);
        [lower, upper].map(|side| side.min.xyz().cmple(side.max.xyz()).all().then_some(side))
    }

    /// A box with the margin, inside the box of a reference.
    #[inline(always)]
    fn within(&self, part: Rows, reference: &Prim) -> Prim {
        let min = (part.min - self.margin).max(reference.min);
        let max = (part.max + self.margin).min(reference.max);
        Prim { min: min.with_w(reference.min.w), max: max.with_w(reference.max.w) }
    }
}
