//! kd-tree.

use super::{KIND, check};
use crate::math::{Aabb, Ray, ray_box};
use crate::scene::Scene;
use crate::workloads::trace::common::check::{Expected, Verdict};
use crate::workloads::trace::common::memory::{self, rt2};
use crate::workloads::trace::common::properties::Leaves;
use crate::workloads::trace::common::sah::CostModel;
use crate::workloads::trace::structure::finite;
use crate::workloads::trace::{Properties, Structure, StructureKind, TriangleRef};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use std::any::Any;
use std::borrow::Cow;

/// A node: 8 bytes, depth-first order, the left child follows its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct KdNode {
    /// Inner node: the split plane's coordinate (bits of an f32). Leaf: first triangle reference.
    pub word: u32,
    /// Low two bits: split axis, or 3 for a leaf. High 30 bits: index of the right child, or number of triangle
    /// references.
    pub link: u32,
}

/// A built kd-tree. `nodes[0]` is the root; an empty scene has one empty leaf.
#[derive(Clone, Debug)]
pub struct KdTree {
    /// The root's cell: box around everything.
    pub bounds: Aabb,
    /// Depth-first.
    pub nodes: Vec<KdNode>,
    /// Leaf by leaf; a triangle is in every leaf that its box overlaps.
    pub triangle_refs: Vec<TriangleRef>,
    /// Levels of inner nodes on the longest way from the root to a leaf.
    pub depth: u32,
}

impl KdTree {
    /// Calls `visit` with every node, its cell and its depth, in the order of the nodes.
    ///
    /// For trees that are known to be sound (see [`Structure::validate`]); links that lead nowhere or backwards are not
    /// followed.
    pub fn for_each_cell(&self, mut visit: impl FnMut(KdNode, &Aabb, u32)) {
        let mut waiting = vec![(0, self.bounds, 0)];
        while let Some((index, cell, depth)) = waiting.pop() {
            let Some(&node) = self.nodes.get(index as usize) else { continue };
            visit(node, &cell, depth);
            if node.is_leaf() {
                continue;
            }
            let (mut left, mut right) = (cell, cell);
            left.max[node.axis()] = node.split();
            right.min[node.axis()] = node.split();
            if node.right() > index {
                waiting.push((node.right(), right, depth + 1));
            }
            waiting.push((index + 1, left, depth + 1));
        }
    }
}

impl KdTree {
    /// Where a ray is inside the tree, from its start to `limit`; `None` if it is not.
    #[inline(always)]
    pub(crate) fn interval(&self, ray: &Ray, limit: f32) -> Option<(f32, f32)> {
        let (near, far) = ray_box(ray, self.bounds.min.into(), self.bounds.max.into());
        let (t_min, t_max) = (near.max(0.0), far.min(limit));
        (near <= far && t_min <= t_max).then_some((t_min, t_max))
    }
}

/// `KdTree` of `kernels/trace/kdtree/node.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct KdTreeUniform {
    pub bounds_min: Vec3,
    pub pad0: u32,
    pub bounds_max: Vec3,
    pub pad1: u32,
}

impl Structure for KdTree {
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
        bytemuck::bytes_of(&KdTreeUniform { bounds_min, pad0: 0, bounds_max, pad1: 0 }).to_vec()
    }

    fn stack_depth(&self) -> u32 {
        self.depth
    }

    fn properties(&self, scene: &Scene) -> Properties {
        let leaves = Leaves::of(self.nodes.iter().filter(|n| n.is_leaf()).map(|n| n.count()));
        let common = Properties::of_references(&self.triangle_refs, scene);
        leaves.into_properties(self.nodes.len(), self.depth, CostModel::default().kdtree(self), common)
    }

    fn thesis_bytes(&self, scene: &Scene) -> u64 {
        let (nodes, vertices) = (self.nodes.len() as u64, scene.vertices.len() as u64);
        memory::kdtree_bytes(nodes, self.triangle_refs.len() as u64, vertices)
    }

    fn rt2_bytes(&self) -> u64 {
        let leaves = self.nodes.iter().filter(|node| node.is_leaf()).count();
        rt2::kdtree_bytes(leaves as u64, self.triangle_refs.len() as u64)
    }

    fn check(&self, expected: &Expected) -> Verdict {
        check::check(self, expected)
    }
}

impl KdNode {
    /// A leaf.
    pub fn leaf(first: u32, count: u32) -> KdNode {
        KdNode { word: first, link: count << 2 | 3 }
    }

    /// An inner node.
    pub fn inner(axis: u32, split: f32, right: u32) -> KdNode {
        KdNode { word: split.to_bits(), link: right << 2 | axis }
    }

    /// True for a leaf.
    pub fn is_leaf(self) -> bool {
        self.link & 3 == 3
    }

    /// Split axis of an inner node.
    pub fn axis(self) -> usize {
        (self.link & 3) as usize
    }

    /// Split plane of an inner node.
    pub fn split(self) -> f32 {
        f32::from_bits(self.word)
    }

    /// The distances at which a ray is in the plane of an inner node, the smallest and the greatest: different only
    /// where the direction is zero, an interval around the ray for a plane that it lies in.
    #[inline(always)]
    pub fn distances(self, ray: &Ray) -> (f32, f32) {
        let (axis, split) = (self.axis(), self.split());
        let inv = ray.inv_direction[axis];
        ((split - ray.origin_min[axis]) * inv, (split - ray.origin_max[axis]) * inv)
    }

    /// Right child of an inner node.
    pub fn right(self) -> u32 {
        self.link >> 2
    }

    /// First triangle reference of a leaf.
    pub fn first(self) -> u32 {
        self.word
    }

    /// Number of triangle references of a leaf.
    pub fn count(self) -> u32 {
        self.link >> 2
    }
}
