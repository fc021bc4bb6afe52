//! What is known of a driver's structure: the triangles that it is built of.

use super::KIND;
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::common::check::{Expected, Verdict, ensure};
use crate::workloads::trace::{Properties, Structure, StructureKind, TriangleRef};
use std::any::Any;
use std::borrow::Cow;

/// Triangles in the order in which a driver gets them.
#[derive(Clone, Debug)]
pub struct SortedTriangles {
    /// Box around all of them.
    pub bounds: Aabb,
    /// One per triangle that can be hit.
    pub triangle_refs: Vec<TriangleRef>,
}

impl Structure for SortedTriangles {
    fn kind(&self) -> &'static StructureKind {
        &KIND
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn triangle_refs(&self) -> &[TriangleRef] {
        &self.triangle_refs
    }

    /// The size of the driver's nodes is not known.
    fn node_bytes(&self) -> usize {
        0
    }

    fn nodes(&self) -> Cow<'_, [u8]> {
        Cow::Borrowed(&[])
    }

    fn uniform(&self) -> Vec<u8> {
        Vec::new()
    }

    fn properties(&self, _scene: &Scene) -> Properties {
        Properties::default()
    }

    fn check(&self, expected: &Expected) -> Verdict {
        let mut triangles: Vec<u32> = self.triangle_refs.iter().map(|r| r.triangle).collect();
        triangles.sort_unstable();
        ensure!(triangles == expected.hittable, "the triangle references are not all triangles, each once");
        Ok(())
    }
}
