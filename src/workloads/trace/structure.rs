//! Acceleration structures: what the rest of the program asks of one. A structure is independent of the traversal that
//! walks it: the same [`Bvh`](super::bvh::Bvh) serves the packet and the stack traversal.

use super::Properties;
use super::common::check::{self, Expected, Verdict};
use crate::device::vulkan::Texel;
use crate::math::Aabb;
use crate::scene::Scene;
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use std::any::Any;
use std::borrow::Cow;
use std::fmt::Debug;

/// A triangle in a leaf or cell: 16 bytes, contiguous per leaf, repeated where a triangle lies in several leaves. The
/// fourth word is the triangle's index in the scene, so that equal distances are decided by the lower index everywhere;
/// the material is looked up by it, once per shaded hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct TriangleRef {
    /// Vertex indices.
    pub vertices: [u32; 3],
    /// Index of the triangle in the scene.
    pub triangle: u32,
}

/// What all structures of one layout have in common.
#[derive(Debug, PartialEq, Eq)]
pub struct StructureKind {
    /// A name for messages.
    pub name: &'static str,
    /// How kernels read the nodes: `read_node16` or `read_node8`.
    pub node_texel: Texel,
    /// True if traversals count cells where those of trees count inner nodes.
    pub has_cells: bool,
}

impl StructureKind {
    /// No structure: a placeholder of registrations that are not complete.
    pub(crate) const NONE: StructureKind =
        StructureKind { name: "nothing", node_texel: Texel::Bytes16, has_cells: false };
}

/// A built structure.
pub trait Structure: Debug + Send + Sync + 'static {
    /// The layout.
    fn kind(&self) -> &'static StructureKind;

    /// Itself; `downcast_ref` asks for its type.
    fn as_any(&self) -> &dyn Any;

    /// Box around all triangles.
    fn bounds(&self) -> Aabb;

    /// Triangle references, leaf by leaf or cell by cell.
    fn triangle_refs(&self) -> &[TriangleRef];

    /// The nodes or cells in memory.
    fn node_bytes(&self) -> usize;

    /// The nodes or cells as kernels read them.
    fn nodes(&self) -> Cow<'_, [u8]>;

    /// The contents of the uniform that the structure's kernels declare at binding 7; empty if they declare none.
    fn uniform(&self) -> Vec<u8>;

    /// Levels of inner nodes on the longest way from the root to a leaf, where traversals need a stack for them.
    fn stack_depth(&self) -> u32 {
        0
    }

    /// The columns of `structures.csv` that are known of it.
    fn properties(&self, scene: &Scene) -> Properties;

    /// Bytes as the thesis of 2009 counts them, vertices included; 0 for a structure that it does not count.
    fn thesis_bytes(&self, _scene: &Scene) -> u64 {
        0
    }

    /// Bytes by the memory model of the source `rt2`, without geometry; 0 for a structure that it does not describe.
    fn rt2_bytes(&self) -> u64 {
        0
    }

    /// Checks every invariant of its own. Bounds and triangle references have been checked before.
    ///
    /// # Errors
    /// The first broken invariant, in words.
    fn check(&self, expected: &Expected) -> Verdict;

    /// Checks every invariant against the scene that it was built from.
    ///
    /// # Errors
    /// The first broken invariant, in words.
    fn validate(&self, scene: &Scene) -> Result<(), String> {
        let expected = Expected::new(scene);
        check::common(self.bounds(), self.triangle_refs(), &expected)?;
        self.check(&expected)
    }

    /// Bytes of nodes or cells, and of triangle references: what a device must hold in addition to the vertices.
    fn structure_bytes(&self) -> u64 {
        (self.node_bytes() + size_of_val(self.triangle_refs())) as u64
    }
}

impl dyn Structure + '_ {
    /// The structure, if it has this type.
    pub fn downcast_ref<S: Structure>(&self) -> Option<&S> {
        self.as_any().downcast_ref()
    }
}

/// A box for a uniform: an empty one is infinite the wrong way round, and WGSL may assume that nothing is infinite.
pub(crate) fn finite(bounds: Aabb) -> Aabb {
    if bounds.is_empty() { Aabb { min: Vec3::ONE, max: Vec3::NEG_ONE } } else { bounds }
}
