//! Invariants of a kd-tree.

use crate::math::Aabb;
use crate::workloads::trace::common::check::{Expected, Verdict, ensure};
use crate::workloads::trace::kdtree::{KdNode, KdTree};

/// No builder goes deeper; keeps the recursion of a check within bounds.
const DEPTH_LIMIT: u32 = 1024;

pub(crate) fn check(tree: &KdTree, expected: &Expected) -> Verdict {
    let mut walk = Walk { tree, expected, next_ref: 0, depth: 0, leaf_starts: Vec::new() };
    let root = KdNode::leaf(0, 0);
    if expected.hittable.is_empty() {
        ensure!(
            tree.nodes == [root] && tree.triangle_refs.is_empty(),
            "no triangles, but nodes or triangle references"
        );
        ensure!(tree.depth == 0, "no triangles, but a depth");
        return Ok(());
    }
    // First the shape alone, so that nothing below follows a bad link.
    let end = walk.shape(0, 0)?;
    ensure!(end == tree.nodes.len(), "{} nodes, {end} reached", tree.nodes.len());
    ensure!(
        walk.next_ref == tree.triangle_refs.len(),
        "{} triangle references, {} in leaves",
        tree.triangle_refs.len(),
        walk.next_ref
    );
    ensure!(walk.depth == tree.depth, "depth is {}, the field says {}", walk.depth, tree.depth);
    walk.content(0, &tree.bounds, &expected.hittable)
}

struct Walk<'a> {
    tree: &'a KdTree,
    expected: &'a Expected<'a>,
    next_ref: usize,
    depth: u32,
    /// For every node, the first triangle reference of the leaves below it.
    leaf_starts: Vec<usize>,
}

impl Walk<'_> {
    /// Checks the links below a node; returns the node behind its subtree.
    fn shape(&mut self, index: usize, depth: u32) -> Result<usize, String> {
        ensure!(depth <= DEPTH_LIMIT, "node {index} lies deeper than {DEPTH_LIMIT}");
        let Some(&node) = self.tree.nodes.get(index) else {
            return Err(format!("node {index} is a child, but lies behind the last node"));
        };
        self.leaf_starts.push(self.next_ref);
        if node.is_leaf() {
            self.depth = self.depth.max(depth);
            ensure!(
                node.first() as usize == self.next_ref,
                "leaf {index} begins at triangle reference {}, not at {} behind its neighbour",
                node.first(),
                self.next_ref
            );
            self.next_ref += node.count() as usize;
            ensure!(
                self.next_ref <= self.tree.triangle_refs.len(),
                "leaf {index} reaches behind the last triangle reference"
            );
            return Ok(index + 1);
        }
        let right = self.shape(index + 1, depth + 1)?;
        ensure!(
            node.right() as usize == right,
            "the right child of node {index} is {}, but its left subtree ends at {right}",
            node.right()
        );
        self.shape(right, depth + 1)
    }

    /// Checks that the leaves below a node hold exactly the triangles whose boxes overlap them: `triangles` (ascending)
    /// are those of this node's cell.
    fn content(&self, index: usize, cell: &Aabb, triangles: &[u32]) -> Verdict {
        let node = self.tree.nodes[index];
        if node.is_leaf() {
            let triangle_refs = &self.tree.triangle_refs[node.first() as usize..(node.first() + node.count()) as usize];
            let mut found: Vec<u32> = triangle_refs.iter().map(|r| r.triangle).collect();
            found.sort_unstable();
            ensure!(found == triangles, "leaf {index} holds triangles {found:?} instead of {triangles:?}");
            return Ok(());
        }
        let (axis, split) = (node.axis(), node.split());
        ensure!(
            cell.min[axis] < split && split < cell.max[axis],
            "node {index} splits at {split}, not inside its cell from {} to {}",
            cell.min[axis],
            cell.max[axis]
        );
        let right_child = node.right() as usize;
        let in_plane = |t: &u32| {
            let b = self.expected.aabb(*t);
            b.min[axis] == split && b.max[axis] == split
        };
        // Triangles in the plane are on the side that the builder chose: look where they are.
        let on_left = if triangles.iter().any(in_plane) {
            let mut on_left: Vec<u32> = self.tree.triangle_refs
                [self.leaf_starts[index + 1]..self.leaf_starts[right_child]]
                .iter()
                .map(|r| r.triangle)
                .collect();
            on_left.sort_unstable();
            on_left
        } else {
            Vec::new()
        };
        let (mut left, mut right) = (Vec::new(), Vec::new());
        for t in triangles {
            let b = self.expected.aabb(*t);
            if in_plane(t) {
                if on_left.binary_search(t).is_ok() {
                    left.push(*t)
                } else {
                    right.push(*t)
                }
                continue;
            }
            if b.min[axis] < split {
                left.push(*t);
            }
            if b.max[axis] > split {
                right.push(*t);
            }
        }
        let (mut left_cell, mut right_cell) = (*cell, *cell);
        left_cell.max[axis] = split;
        right_cell.min[axis] = split;
        self.content(index + 1, &left_cell, &left)?;
        self.content(right_child, &right_cell, &right)
    }
}
