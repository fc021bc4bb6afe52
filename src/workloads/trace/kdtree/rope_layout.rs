//! kd-tree with ropes: the tree, and for each leaf its box and what lies behind its six faces.

use super::{rope_build, rope_check};
use crate::device::vulkan::Texel;
use crate::math::{Aabb, MISS};
use crate::scene::Scene;
use crate::workloads::trace::common::check::{Expected, Verdict};
use crate::workloads::trace::common::memory::rt2;
use crate::workloads::trace::kdtree::{KdNode, KdTree};
use crate::workloads::trace::{Properties, Structure, StructureKind, TriangleRef};
use bytemuck::{Pod, Zeroable};
use std::any::Any;
use std::borrow::Cow;

pub(crate) static KIND: StructureKind =
    StructureKind { name: "kd-tree with ropes", node_texel: Texel::Bytes16, has_cells: false };

/// A rope of a face behind which there is nothing: one of the root's.
pub const NO_ROPE: u32 = MISS;

/// Rows of a leaf.
pub const LEAF_ROWS: usize = size_of::<RopeLeaf>() / size_of::<Row>();

/// 16 bytes, as kernels read them.
pub type Row = [u32; 4];

/// A leaf: 64 bytes, four rows.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct RopeLeaf {
    /// Smallest corner of its cell.
    pub min: [f32; 3],
    /// First triangle reference.
    pub first: u32,
    /// Largest corner of its cell.
    pub max: [f32; 3],
    /// Number of triangle references.
    pub count: u32,
    /// By axis, the node behind the lower face, or [`NO_ROPE`].
    pub low: [u32; 3],
    /// Always zero.
    pub pad0: u32,
    /// By axis, the node behind the upper face, or [`NO_ROPE`].
    pub high: [u32; 3],
    /// Always zero.
    pub pad1: u32,
}

impl RopeLeaf {
    /// The node behind the lower or the upper face on an axis, or [`NO_ROPE`].
    #[inline(always)]
    pub fn rope(&self, axis: usize, lower: bool) -> u32 {
        if lower { self.low[axis] } else { self.high[axis] }
    }

    /// The cell.
    pub fn cell(&self) -> Aabb {
        Aabb { min: self.min.into(), max: self.max.into() }
    }
}

/// A kd-tree with ropes.
#[derive(Clone, Debug)]
pub struct RopeTree {
    /// The tree without ropes.
    pub tree: KdTree,
    /// What kernels read: the tree's nodes, two in a row, where a leaf's first word is the number of its first row;
    /// then four rows a leaf ([`RopeLeaf`]), in the order of the tree.
    pub rows: Vec<Row>,
    /// Each rope ends at the smallest node that covers its face. Else at the largest that touches it.
    pub pushed: bool,
}

impl RopeTree {
    /// Ties ropes to a tree, on the threads of the current rayon pool.
    pub fn new(tree: KdTree, pushed: bool) -> RopeTree {
        let rows = rope_build::rows(&tree, pushed);
        RopeTree { tree, rows, pushed }
    }

    /// The node of this number, as kernels see it.
    #[inline(always)]
    pub fn node(&self, index: u32) -> KdNode {
        let row = &self.rows[index as usize / 2];
        let half = 2 * (index as usize % 2);
        KdNode { word: row[half], link: row[half + 1] }
    }

    /// The leaf whose first row is this one.
    #[inline(always)]
    pub fn leaf_at(&self, row: u32) -> &RopeLeaf {
        bytemuck::from_bytes(bytemuck::cast_slice(&self.rows[row as usize..][..LEAF_ROWS]))
    }

    /// All leaves, in the order of the tree.
    pub fn leaves(&self) -> &[RopeLeaf] {
        bytemuck::cast_slice(&self.rows[node_rows(self.tree.nodes.len())..])
    }

    /// The same, to be changed.
    pub fn leaves_mut(&mut self) -> &mut [RopeLeaf] {
        bytemuck::cast_slice_mut(&mut self.rows[node_rows(self.tree.nodes.len())..])
    }
}

/// Rows of so many nodes.
pub(crate) fn node_rows(nodes: usize) -> usize {
    nodes.div_ceil(2)
}

/// Leaves of a full binary tree of so many nodes.
pub(crate) fn leaf_count(nodes: usize) -> usize {
    nodes.div_ceil(2)
}

impl Structure for RopeTree {
    fn kind(&self) -> &'static StructureKind {
        &KIND
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn bounds(&self) -> Aabb {
        self.tree.bounds
    }

    fn triangle_refs(&self) -> &[TriangleRef] {
        &self.tree.triangle_refs
    }

    fn node_bytes(&self) -> usize {
        size_of_val(self.rows.as_slice())
    }

    fn nodes(&self) -> Cow<'_, [u8]> {
        Cow::Borrowed(bytemuck::cast_slice(&self.rows))
    }

    fn uniform(&self) -> Vec<u8> {
        self.tree.uniform()
    }

    fn properties(&self, scene: &Scene) -> Properties {
        self.tree.properties(scene)
    }

    fn rt2_bytes(&self) -> u64 {
        self.tree.rt2_bytes() + rt2::ropes_bytes(self.leaves().len() as u64)
    }

    fn check(&self, expected: &Expected) -> Verdict {
        self.tree.check(expected)?;
        rope_check::check(self)
    }
}
