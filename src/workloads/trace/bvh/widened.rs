//! Rays whose box tests are a little wider, for trees with clipped boxes. Twin of
//! `kernels/trace/bvh/widened.wgsl`.
//!
//! The ray/triangle test accepts hits that lie outside of a triangle by some roundings of distances from the ray's
//! origin. The triangle's own box is safe all the same (see [`crate::math`]), but not a box around a part of it.
//! Builders that clip give boxes a margin for rays that start near the scene; this one grows with the distance, so that
//! nothing is lost from afar. It is the same for all boxes, which keeps their order.

use super::{Bvh, ploc};
use crate::math::Ray;
use crate::workloads::trace::algorithm::Parameter;
use crate::workloads::trace::cpu::TwinInput;
use crate::workloads::trace::selection::Selection;
use crate::workloads::trace::traverse::Lanes;
use glam::Vec3A;
use std::borrow::Cow;

/// The flag of the kernels.
const NAME: &str = "WIDENED";

/// By how much every box grows, as a share of the largest distance on an axis between the origin and the scene: 2^-20,
/// sixteen roundings.
const SHARE: f32 = 1.0 / (1 << 20) as f32;

/// The parameter of every traversal of BVHs: true for selections whose builder clips triangles.
pub(in crate::workloads::trace) fn parameter(s: &Selection) -> (&'static str, Parameter) {
    let presplit = |preset: &str| ploc::preset(preset).is_some_and(|params| params.pre_split);
    flag(s.find("build") == Some("spatial") || s.find("preset").is_some_and(presplit))
}

/// The parameter with this value.
pub(in crate::workloads::trace) fn flag(is_clipped: bool) -> (&'static str, Parameter) {
    (NAME, Parameter::Flag(is_clipped))
}

/// Whether rays are widened, and the root's box.
#[derive(Clone, Copy)]
pub struct Widening {
    root: Option<(Vec3A, Vec3A)>,
}

impl Widening {
    /// As the method says.
    pub(super) fn of(input: &TwinInput, bvh: &Bvh) -> Widening {
        Widening::around(input, bvh.nodes[0].corners())
    }

    /// The same for a tree with this box around everything.
    pub(in crate::workloads::trace) fn around(input: &TwinInput, root: (Vec3A, Vec3A)) -> Widening {
        Widening { root: input.method.parameters.flag(NAME).then_some(root) }
    }

    /// The rays of a work-group for box tests.
    pub(super) fn all<'r>(&self, rays: &'r Lanes<Ray>) -> Cow<'r, Lanes<Ray>> {
        if self.root.is_some() { Cow::Owned(rays.each_ref().map(|ray| self.widened(ray))) } else { Cow::Borrowed(rays) }
    }

    /// The ray for box tests.
    #[inline(always)]
    pub(in crate::workloads::trace) fn widened(&self, ray: &Ray) -> Ray {
        let Some((min, max)) = self.root else { return *ray };
        let reach = (min - ray.origin).abs().max((max - ray.origin).abs());
        let margin = Vec3A::splat(reach.max_element() * SHARE);
        Ray { origin_min: ray.origin_min + margin, origin_max: ray.origin_max - margin, ..*ray }
    }
}
