//! Ropes: for every face of every leaf of a kd-tree, the node that lies behind it.
//!
//! S. Popov, J. Günther, H.-P. Seidel, P. Slusallek: Stackless KD-Tree Traversal for High Performance GPU Ray Tracing,
//! 2007. A node's ropes are its parent's, but for the face that is its parent's plane: behind that lies its sibling.
//! Before a node passes its ropes on, each is pushed down to the smallest node that still covers the node's face.

use crate::math::Aabb;
use crate::workloads::trace::kdtree::build::{both, halves};
use crate::workloads::trace::kdtree::rope_layout::{LEAF_ROWS, NO_ROPE, RopeLeaf, Row, leaf_count, node_rows};
use crate::workloads::trace::kdtree::{KdNode, KdTree};
use crate::workloads::trace::structure::finite;
use bytemuck::Zeroable;

/// Subtrees of fewer nodes are done by one thread.
const TASK: usize = 4096;

/// What lies behind the faces of a node: by axis the lower one, then the upper one.
type Ropes = [[u32; 3]; 2];

const LOW: usize = 0;
const HIGH: usize = 1;

/// The rows of a kd-tree with ropes: nodes, then leaves.
pub(crate) fn rows(tree: &KdTree, pushed: bool) -> Vec<Row> {
    let (nodes, first) = (&tree.nodes, node_rows(tree.nodes.len()));
    let leaf_rows = LEAF_ROWS * leaf_count(nodes.len());
    let mut rows = vec![[0; 4]; first + leaf_rows];
    let (node_rows, leaf_rows) = rows.split_at_mut(first);
    let mut row = first as u32;
    let halves: &mut [KdNode] = bytemuck::cast_slice_mut(node_rows);
    for (out, node) in halves.iter_mut().zip(nodes) {
        *out = *node;
        if node.is_leaf() {
            out.word = row;
            row += LEAF_ROWS as u32;
        }
    }
    let weave = Weave { nodes, pushed };
    weave.subtree(0, nodes.len(), &finite(tree.bounds), [[NO_ROPE; 3]; 2], bytemuck::cast_slice_mut(leaf_rows));
    rows
}

struct Weave<'a> {
    nodes: &'a [KdNode],
    pushed: bool,
}

impl Weave<'_> {
    /// Writes the leaves of a subtree of `size` nodes.
    fn subtree(&self, index: usize, size: usize, cell: &Aabb, mut ropes: Ropes, leaves: &mut [RopeLeaf]) {
        if self.pushed {
            self.push(&mut ropes, cell);
        }
        let node = self.nodes[index];
        if node.is_leaf() {
            let [low, high] = ropes;
            let (min, max) = (cell.min.to_array(), cell.max.to_array());
            let (first, count) = (node.first(), node.count());
            leaves[0] = RopeLeaf { min, first, max, count, low, high, ..RopeLeaf::zeroed() };
            return;
        }
        let (left, right) = (index + 1, node.right() as usize);
        let (left_size, right_size) = (right - left, size - (right - index));
        let (left_cell, right_cell) = halves(cell, node.axis(), node.split());
        let (mut left_ropes, mut right_ropes) = (ropes, ropes);
        left_ropes[HIGH][node.axis()] = right as u32;
        right_ropes[LOW][node.axis()] = left as u32;
        let (left_leaves, right_leaves) = leaves.split_at_mut(leaf_count(left_size));
        let a = || self.subtree(left, left_size, &left_cell, left_ropes, left_leaves);
        let b = || self.subtree(right, right_size, &right_cell, right_ropes, right_leaves);
        both(size > TASK, a, b);
    }

    /// Lets every rope of a cell end at the smallest node that covers its face.
    fn push(&self, ropes: &mut Ropes, cell: &Aabb) {
        for (side, ropes) in ropes.iter_mut().enumerate() {
            for (axis, rope) in ropes.iter_mut().enumerate().filter(|(_, rope)| **rope != NO_ROPE) {
                while let Some(child) = self.child_behind(*rope, axis, side, cell) {
                    *rope = child;
                }
            }
        }
    }

    /// The child of a node that covers a face of the cell, if one does alone.
    fn child_behind(&self, node: u32, axis: usize, side: usize, cell: &Aabb) -> Option<u32> {
        let inner = self.nodes[node as usize];
        if inner.is_leaf() {
            return None;
        }
        let (left, right) = (node + 1, inner.right());
        if inner.axis() == axis {
            // The child at the face
            return Some(if side == HIGH { left } else { right });
        }
        if inner.split() >= cell.max[inner.axis()] {
            Some(left)
        } else if inner.split() <= cell.min[inner.axis()] {
            Some(right)
        } else {
            None
        }
    }
}
