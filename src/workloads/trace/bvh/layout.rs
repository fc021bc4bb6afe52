//! Bounding volume hierarchy.

use super::bins::Rows;
use super::{KIND, check};
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::common::check::{Expected, Verdict};
use crate::workloads::trace::common::memory::{self, rt2};
use crate::workloads::trace::common::part::{Base, PartNode};
use crate::workloads::trace::common::properties::Leaves;
use crate::workloads::trace::common::sah::CostModel;
use crate::workloads::trace::{Properties, Structure, StructureKind, TriangleRef};
use bytemuck::{Pod, Zeroable};
use glam::{Vec3A, Vec4};
use std::any::Any;
use std::borrow::Cow;

/// A node: 32 bytes, so that two siblings are one 64-byte read.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct BvhNode {
    /// Smallest corner.
    pub min: [f32; 3],
    /// Inner node: index of the left child, always even; the right child follows it. Leaf: first triangle reference.
    pub first: u32,
    /// Largest corner.
    pub max: [f32; 3],
    /// Leaf: number of triangle references, 1 to [`MAX_LEAF`]. Inner node: 0.
    pub count: u32,
}

/// Most triangle references a leaf may have: traversals pack a leaf into one word, four bits of it are the count.
pub const MAX_LEAF: u32 = 15;

/// Most triangle references of a tree: 27 bits of that word are the first of a leaf.
pub const MAX_REFERENCES: usize = 1 << 27;

/// Greatest depth of a tree unless another one is asked for. Traversals size their stacks by [`Bvh::depth`].
pub const MAX_DEPTH: u32 = 60;

/// Greatest depth that can be asked for.
pub const DEPTH_LIMIT: u32 = 440;

impl BvhNode {
    /// An empty leaf: the dummy sibling of the root, and the root of an empty scene. Its box contains nothing.
    pub const NONE: BvhNode = BvhNode { min: [f32::MAX; 3], first: 0, max: [f32::MIN; 3], count: 0 };

    /// The node's box.
    pub fn aabb(&self) -> Aabb {
        Aabb { min: self.min.into(), max: self.max.into() }
    }

    /// What the node leads to in one word, as traversals and their stacks hold it (`kernels/trace/bvh/node.wgsl`): the
    /// left child of an inner node; of a leaf the top bit, four bits of count and 27 bits of first triangle reference.
    /// The root of an empty scene is a leaf without triangle references.
    #[inline(always)]
    pub fn reference(&self) -> u32 {
        if self.count > 0 || self.first == 0 { 1 << 31 | self.count << 27 | self.first } else { self.first }
    }

    /// Both corners, loaded as 16-byte rows (see [`crate::math::Ray`] on the hidden fourth lane).
    #[inline(always)]
    pub fn corners(&self) -> (Vec3A, Vec3A) {
        let rows: &[Vec4; 2] = bytemuck::cast_ref(self);
        (Vec3A::from_vec4(rows[0]), Vec3A::from_vec4(rows[1]))
    }
}

impl BvhNode {
    pub(crate) fn leaf(bounds: &Rows, first: u32, count: u32) -> BvhNode {
        let Aabb { min, max } = bounds.aabb();
        BvhNode { min: min.to_array(), first, max: max.to_array(), count }
    }

    pub(crate) fn inner(bounds: &Rows, first: u32) -> BvhNode {
        BvhNode::leaf(bounds, first, 0)
    }

    /// An inner node over two others.
    pub(crate) fn around(left: &BvhNode, right: &BvhNode, first: u32) -> BvhNode {
        let Aabb { min, max } = left.aabb().union(right.aabb());
        BvhNode { min: min.to_array(), first, max: max.to_array(), count: 0 }
    }
}

impl PartNode for BvhNode {
    const NONE: BvhNode = BvhNode::NONE;

    fn moved(self, base: Base) -> BvhNode {
        BvhNode { first: self.first + if self.count == 0 { base.node } else { base.triangle }, ..self }
    }
}

/// A built BVH. `nodes[0]` is the root, `nodes[1]` its dummy sibling (a copy of an empty leaf that no traversal
/// visits), so siblings always lie at an even index and the next. A root that is a leaf has `count > 0`; an empty scene
/// has `nodes[0].count == 0` with `first == 0`, which no inner node can have.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// Box around everything.
    pub bounds: Aabb,
    /// Nodes, pairs together.
    pub nodes: Vec<BvhNode>,
    /// Leaf by leaf.
    pub triangle_refs: Vec<TriangleRef>,
    /// Levels of inner nodes on the longest way from the root to a leaf: what a stack must hold.
    pub depth: u32,
    /// Of a builder with spatial splits.
    pub spatial: Option<SpatialSplits>,
}

/// Spatial splits of a BVH.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpatialSplits {
    /// Inner nodes that are split so.
    pub count: u32,
    /// The largest share of such a node's volume that lies in both children, before whole references are put on one
    /// side: 0 to 1.
    pub overlap: f32,
}

impl Structure for Bvh {
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

    /// With references in place of links, so that kernels need not read two words to know where a node leads.
    fn nodes(&self) -> Cow<'_, [u8]> {
        let packed = self.nodes.iter().map(|node| BvhNode { first: node.reference(), ..*node });
        let mut bytes = Vec::with_capacity(self.node_bytes());
        packed.for_each(|node| bytes.extend_from_slice(bytemuck::bytes_of(&node)));
        Cow::Owned(bytes)
    }

    fn uniform(&self) -> Vec<u8> {
        Vec::new()
    }

    fn stack_depth(&self) -> u32 {
        self.depth
    }

    fn properties(&self, scene: &Scene) -> Properties {
        let leaves = Leaves::of(self.nodes.iter().map(|n| n.count).filter(|&count| count > 0));
        let common = Properties {
            spatial_splits: self.spatial.map(|splits| splits.count),
            spatial_overlap: self.spatial.map(|splits| f64::from(splits.overlap)),
            ..Properties::of_references(&self.triangle_refs, scene)
        };
        leaves.into_properties(self.nodes.len(), self.depth, CostModel::default().bvh(self), common)
    }

    fn thesis_bytes(&self, scene: &Scene) -> u64 {
        memory::bvh_bytes(self.nodes.len() as u64, scene.vertices.len() as u64)
    }

    fn rt2_bytes(&self) -> u64 {
        // A node has room for three triangle numbers. Without the root's dummy sibling
        let fits = self.nodes.iter().all(|node| node.count <= 3);
        if fits { rt2::bvh_bytes(self.nodes.len() as u64 - 1) } else { 0 }
    }

    fn check(&self, expected: &Expected) -> Verdict {
        check::check(self, expected)
    }
}
