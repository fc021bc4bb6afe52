//! kd-tree (SPEC section 3).

use crate::math::Aabb;
use crate::workloads::trace::TriangleRef;
use bytemuck::{Pod, Zeroable};

/// A node: 8 bytes, depth-first order, the left child follows its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct KdNode {
    /// Inner node: the split plane's coordinate (bits of an f32). Leaf: first triangle reference.
    pub word: u32,
    /// Low two bits: split axis, or 3 for a leaf. High 30 bits: index of the right child, or number of triangle references.
    pub link: u32,
}

/// A built kd-tree. `nodes[0]` is the root; an empty scene has one empty leaf.
#[derive(Clone, Debug)]
pub struct KdTree {
    /// The root's cell: box around everything.
    pub bounds: Aabb,
    /// Depth-first.
    pub nodes: Vec<KdNode>,
    /// Leaf by leaf; a triangle stands in every leaf that its box overlaps.
    pub triangle_refs: Vec<TriangleRef>,
    /// Levels of inner nodes on the longest way from the root to a leaf.
    pub depth: u32,
}

impl KdTree {
    /// Calls `visit` with every node, its cell and its depth, in the order of the nodes.
    ///
    /// For trees that are known to be sound (see [`crate::workloads::trace::Structure::validate`]); links that lead nowhere or backwards
    /// are not followed.
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
