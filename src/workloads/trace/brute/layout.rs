//! All triangles in one run, without any structure: the ground truth for small scenes.

use super::KIND;
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::common::check::{Expected, Verdict, ensure};
use crate::workloads::trace::common::memory;
use crate::workloads::trace::{Properties, Structure, StructureKind, TriangleRef};
use bytemuck::{Pod, Zeroable};
use std::any::Any;
use std::borrow::Cow;

/// All triangles that can be hit.
#[derive(Clone, Debug)]
pub struct Brute {
    /// Box around all triangle references.
    pub bounds: Aabb,
    /// One per triangle, in scene order.
    pub triangle_refs: Vec<TriangleRef>,
}

/// `Brute` of `kernels/trace/brute/scan.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct BruteUniform {
    pub triangle_refs: u32,
    pub pad: [u32; 3],
}

impl Structure for Brute {
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

    fn node_bytes(&self) -> usize {
        0
    }

    fn nodes(&self) -> Cow<'_, [u8]> {
        Cow::Borrowed(&[])
    }

    fn uniform(&self) -> Vec<u8> {
        let uniform = BruteUniform { triangle_refs: self.triangle_refs.len() as u32, pad: [0; 3] };
        bytemuck::bytes_of(&uniform).to_vec()
    }

    fn properties(&self, _scene: &Scene) -> Properties {
        Properties::default()
    }

    fn thesis_bytes(&self, scene: &Scene) -> u64 {
        memory::grid_bytes(0, self.triangle_refs.len() as u64, scene.vertices.len() as u64)
    }

    fn check(&self, expected: &Expected) -> Verdict {
        let triangles: Vec<u32> = self.triangle_refs.iter().map(|r| r.triangle).collect();
        ensure!(triangles == expected.hittable, "the triangle references are not all triangles in scene order");
        Ok(())
    }
}
