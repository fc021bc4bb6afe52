//! Acceleration structures: what they look like in memory. A structure is independent of the traversal that walks it: the same
//! [`Bvh`](super::bvh::Bvh) serves the packet and the stack traversal.

use super::{bvh, grid, kdtree};
use crate::math::Aabb;
use bytemuck::{Pod, Zeroable};

/// A triangle as a leaf or cell stores it (SPEC section 1): 16 bytes, contiguous per leaf, repeated where a triangle
/// lies in several leaves. The fourth word is the triangle's index in the scene, so that equal distances are decided
/// by the lower index everywhere; the material is looked up by it, once per shaded hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct TriangleRef {
    /// Vertex indices.
    pub vertices: [u32; 3],
    /// Index of the triangle in the scene.
    pub triangle: u32,
}

/// All triangles in one run, without any structure: the ground truth for small scenes.
#[derive(Clone, Debug)]
pub struct Brute {
    /// Box around all triangle references.
    pub bounds: Aabb,
    /// One per triangle, in scene order.
    pub triangle_refs: Vec<TriangleRef>,
}

/// Any built structure.
#[derive(Clone, Debug)]
pub enum Structure {
    /// No structure.
    Brute(Brute),
    /// Uniform grid.
    Grid(grid::Grid),
    /// kd-tree.
    KdTree(kdtree::KdTree),
    /// Bounding volume hierarchy.
    Bvh(bvh::Bvh),
}
