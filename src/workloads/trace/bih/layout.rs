//! Bounding interval hierarchy.

use super::{KIND, check};
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::common::check::{Expected, Verdict};
use crate::workloads::trace::common::memory::rt2;
use crate::workloads::trace::common::part::{Base, PartNode};
use crate::workloads::trace::common::properties::Leaves;
use crate::workloads::trace::structure::finite;
use crate::workloads::trace::{Properties, Structure, StructureKind, TriangleRef};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use std::any::Any;
use std::borrow::Cow;

/// A node: 12 bytes. Kernels read two of them as three words of 8 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct BihNode {
    /// Low two bits: axis, or 3 for a leaf. High 30 bits: index of the lower child, which the upper one follows, or
    /// first triangle reference.
    pub link: u32,
    /// Inner node: where the lower child ends and where the upper child begins (bits of an f32 each). Leaf: number of
    /// triangle references, and 0.
    pub words: [u32; 2],
}

impl BihNode {
    /// A leaf.
    pub fn leaf(first: u32, count: u32) -> BihNode {
        BihNode { link: first << 2 | 3, words: [count, 0] }
    }

    /// An inner node.
    pub fn inner(axis: usize, child: u32, low_end: f32, high_begin: f32) -> BihNode {
        BihNode { link: child << 2 | axis as u32, words: [low_end.to_bits(), high_begin.to_bits()] }
    }

    /// True for a leaf.
    pub fn is_leaf(self) -> bool {
        self.link & 3 == 3
    }

    /// Axis of an inner node's planes.
    pub fn axis(self) -> usize {
        (self.link & 3) as usize
    }

    /// Lower child of an inner node.
    pub fn child(self) -> u32 {
        self.link >> 2
    }

    /// Largest coordinate of the lower child.
    pub fn low_end(self) -> f32 {
        f32::from_bits(self.words[0])
    }

    /// Smallest coordinate of the upper child.
    pub fn high_begin(self) -> f32 {
        f32::from_bits(self.words[1])
    }

    /// First triangle reference of a leaf.
    pub fn first(self) -> u32 {
        self.link >> 2
    }

    /// Number of triangle references of a leaf.
    pub fn count(self) -> u32 {
        self.words[0]
    }
}

impl PartNode for BihNode {
    const NONE: BihNode = BihNode { link: 3, words: [0; 2] };

    fn moved(self, base: Base) -> BihNode {
        let by = if self.is_leaf() { base.triangle } else { base.node };
        BihNode { link: self.link + (by << 2), ..self }
    }
}

/// A built hierarchy. `nodes[0]` is the root, `nodes[1]` an empty leaf that no traversal visits, so that siblings lie
/// at an even index and the next. An empty scene has two empty leaves.
#[derive(Clone, Debug)]
pub struct Bih {
    /// Box around everything.
    pub bounds: Aabb,
    /// Nodes, pairs together.
    pub nodes: Vec<BihNode>,
    /// Leaf by leaf.
    pub triangle_refs: Vec<TriangleRef>,
    /// Levels of inner nodes on the longest way from the root to a leaf: what a stack must hold.
    pub depth: u32,
}

/// `Bih` of `kernels/trace/bih/stack.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct BihUniform {
    pub bounds_min: Vec3,
    pub pad0: u32,
    pub bounds_max: Vec3,
    pub pad1: u32,
}

impl Structure for Bih {
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
        size_of_val(self.nodes.as_slice())
    }

    fn nodes(&self) -> Cow<'_, [u8]> {
        Cow::Borrowed(bytemuck::cast_slice(&self.nodes))
    }

    fn uniform(&self) -> Vec<u8> {
        let Aabb { min: bounds_min, max: bounds_max } = finite(self.bounds);
        bytemuck::bytes_of(&BihUniform { bounds_min, pad0: 0, bounds_max, pad1: 0 }).to_vec()
    }

    fn stack_depth(&self) -> u32 {
        self.depth
    }

    fn properties(&self, scene: &Scene) -> Properties {
        // Without the root's dummy sibling, and its one leaf for an empty scene
        let nodes = self.nodes.iter().enumerate().filter(|(i, _)| *i != 1);
        let leaves = Leaves::of(nodes.filter(|(_, n)| n.is_leaf()).map(|(_, n)| n.count()));
        let common = Properties::of_references(&self.triangle_refs, scene);
        leaves.into_properties(self.nodes.len(), self.depth, None, common)
    }

    fn rt2_bytes(&self) -> u64 {
        // Without the root's dummy sibling
        rt2::bih_bytes(self.nodes.len() as u64 - 1, self.triangle_refs.len() as u64)
    }

    fn check(&self, expected: &Expected) -> Verdict {
        check::check(self, expected)
    }
}
