//! A BVH with links from each node to its parent.

use super::KIND;
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::bvh::stack::LEAF;
use crate::workloads::trace::bvh::{Bvh, BvhNode};
use crate::workloads::trace::common::check::{Expected, Verdict, ensure};
use crate::workloads::trace::{Properties, Structure, StructureKind, TriangleRef};
use std::any::Any;
use std::borrow::Cow;

/// Bits of a node's index in a link and in the reference of an inner node; the order of siblings is above them. A tree
/// of at most 2^27 references has fewer nodes.
pub(super) const INDEX: u32 = (1 << 28) - 1;

/// A BVH, and what leads through it without a stack.
#[derive(Clone, Debug)]
pub struct LinkedBvh {
    /// The tree.
    pub bvh: Bvh,
    /// For each pair of siblings the index of their parent, and their order.
    pub links: Vec<u32>,
}

/// How two siblings lie to each other: the axis on which their middles are farthest apart, and 4 if the right one lies
/// lower on it.
fn order(left: &BvhNode, right: &BvhNode) -> u32 {
    let middle = |node: &BvhNode, axis: usize| f64::from(node.min[axis]) + f64::from(node.max[axis]);
    let apart = [0, 1, 2].map(|axis| middle(right, axis) - middle(left, axis));
    let mut widest = 0;
    for axis in [1, 2] {
        if apart[axis].abs() > apart[widest].abs() {
            widest = axis;
        }
    }
    widest as u32 | if apart[widest] < 0.0 { 4 } else { 0 }
}

impl LinkedBvh {
    /// Adds links to a tree.
    pub fn new(bvh: Bvh) -> LinkedBvh {
        let mut links = vec![0; bvh.nodes.len() / 2];
        for (index, node) in (0..).zip(&bvh.nodes) {
            if node.count == 0 && node.first != 0 {
                links[node.first as usize / 2] = index;
            }
        }
        for (link, [left, right]) in links.iter_mut().zip(bvh.nodes.as_chunks().0).skip(1) {
            *link |= order(left, right) << 28;
        }
        LinkedBvh { bvh, links }
    }

    /// What a node leads to, as in other BVHs, and for an inner node the order of its children.
    #[inline(always)]
    pub(super) fn reference(&self, node: &BvhNode) -> u32 {
        let reference = node.reference();
        if reference & LEAF != 0 { reference } else { reference | self.links[reference as usize / 2] & !INDEX }
    }

    /// The link of a node.
    #[inline(always)]
    pub(super) fn link(&self, index: u32) -> u32 {
        self.links[index as usize / 2]
    }
}

impl Structure for LinkedBvh {
    fn kind(&self) -> &'static StructureKind {
        &KIND
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn bounds(&self) -> Aabb {
        self.bvh.bounds
    }

    fn triangle_refs(&self) -> &[TriangleRef] {
        &self.bvh.triangle_refs
    }

    /// Links lie where the nodes of other BVHs have the number of triangle references, which references hold as well.
    fn node_bytes(&self) -> usize {
        self.bvh.node_bytes()
    }

    fn nodes(&self) -> Cow<'_, [u8]> {
        let packed = (0..).zip(&self.bvh.nodes).map(|(index, node)| BvhNode {
            first: self.reference(node),
            count: self.link(index),
            ..*node
        });
        let mut bytes = Vec::with_capacity(self.node_bytes());
        packed.for_each(|node| bytes.extend_from_slice(bytemuck::bytes_of(&node)));
        Cow::Owned(bytes)
    }

    fn uniform(&self) -> Vec<u8> {
        Vec::new()
    }

    /// Of the trail: it has a bit for each level.
    fn stack_depth(&self) -> u32 {
        self.bvh.depth
    }

    fn properties(&self, scene: &Scene) -> Properties {
        self.bvh.properties(scene)
    }

    fn check(&self, expected: &Expected) -> Verdict {
        self.bvh.check(expected)?;
        let (nodes, links) = (&self.bvh.nodes, &self.links);
        ensure!(links.len() * 2 == nodes.len(), "{} links for {} nodes", links.len(), nodes.len());
        ensure!(links[0] == 0, "the root has the link {:#x}", links[0]);
        for (pair, (&link, [left, right])) in links.iter().zip(nodes.as_chunks().0).enumerate().skip(1) {
            let parent = nodes.get((link & INDEX) as usize);
            let is_parent = parent.is_some_and(|node| node.count == 0 && node.first as usize == 2 * pair);
            ensure!(is_parent, "the link of nodes {} and {} is not to their parent", 2 * pair, 2 * pair + 1);
            let expected = order(left, right);
            ensure!(
                link >> 28 == expected,
                "nodes {} and {} have the order {}, not {expected}",
                2 * pair,
                2 * pair + 1,
                link >> 28
            );
        }
        Ok(())
    }
}
