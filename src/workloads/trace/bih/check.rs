//! Invariants of a bounding interval hierarchy.

use crate::math::Aabb;
use crate::workloads::trace::bih::{Bih, BihNode, MAX_DEPTH};
use crate::workloads::trace::common::check::{Expected, Verdict, ensure};
use crate::workloads::trace::common::part::PartNode;

pub(crate) fn check(tree: &Bih, expected: &Expected) -> Verdict {
    let count = tree.nodes.len();
    ensure!(count >= 2 && count.is_multiple_of(2), "{count} nodes: an even number, at least 2, is needed");
    ensure!(tree.nodes[1] == BihNode::NONE, "the root's sibling is no dummy");
    if expected.hittable.is_empty() {
        ensure!(tree.nodes[0] == BihNode::NONE && count == 2, "no triangles, but nodes");
        ensure!(tree.triangle_refs.is_empty() && tree.depth == 0, "no triangles, but triangle references or a depth");
        return Ok(());
    }
    let listed = vec![false; expected.boxes.len()];
    let mut walk = Walk { tree, expected, seen: vec![false; count], listed, next_ref: 0, depth: 0 };
    walk.seen[1] = true;
    walk.node(0, 0)?;
    ensure!(walk.depth == tree.depth, "depth is {}, the field says {}", walk.depth, tree.depth);
    let references = tree.triangle_refs.len();
    ensure!(walk.next_ref == references, "{references} triangle references, {} in leaves", walk.next_ref);
    if let Some(node) = walk.seen.iter().position(|&seen| !seen) {
        return Err(format!("node {node} cannot be reached"));
    }
    match expected.hittable.iter().find(|&&triangle| !walk.listed[triangle as usize]) {
        Some(triangle) => Err(format!("triangle {triangle} is in no leaf")),
        None => Ok(()),
    }
}

struct Walk<'a> {
    tree: &'a Bih,
    expected: &'a Expected<'a>,
    seen: Vec<bool>,
    /// Triangles of leaves so far.
    listed: Vec<bool>,
    next_ref: usize,
    depth: u32,
}

impl Walk<'_> {
    /// Checks a node and all below it; returns the box around its triangles.
    fn node(&mut self, index: usize, depth: u32) -> Result<Aabb, String> {
        ensure!(!self.seen[index], "node {index} is reached twice");
        self.seen[index] = true;
        ensure!(depth <= MAX_DEPTH, "node {index} lies deeper than {MAX_DEPTH}");
        let node = self.tree.nodes[index];
        if node.is_leaf() { self.leaf(index, node, depth) } else { self.inner(index, node, depth) }
    }

    fn inner(&mut self, index: usize, node: BihNode, depth: u32) -> Result<Aabb, String> {
        let (child, axis) = (node.child() as usize, node.axis());
        ensure!(child.is_multiple_of(2) && child >= 2, "the children of node {index} begin at {child}");
        ensure!(child + 1 < self.tree.nodes.len(), "the children of node {index} lie behind the last node");
        let low = self.node(child, depth + 1)?;
        let high = self.node(child + 1, depth + 1)?;
        let (end, begin) = (node.low_end(), node.high_begin());
        ensure!(end == low.max[axis], "node {index}'s lower child ends at {}, its plane is {end}", low.max[axis]);
        ensure!(
            begin == high.min[axis],
            "node {index}'s upper child begins at {}, its plane is {begin}",
            high.min[axis]
        );
        Ok(low.union(high))
    }

    fn leaf(&mut self, index: usize, node: BihNode, depth: u32) -> Result<Aabb, String> {
        self.depth = self.depth.max(depth);
        let (first, count) = (node.first() as usize, node.count() as usize);
        ensure!(count > 0, "leaf {index} is empty");
        ensure!(node.words[1] == 0, "leaf {index} has a second word");
        ensure!(
            first == self.next_ref,
            "leaf {index} begins at triangle reference {first}, not at {} behind its neighbour",
            self.next_ref
        );
        let Some(triangle_refs) = self.tree.triangle_refs.get(first..first + count) else {
            return Err(format!("leaf {index} reaches behind the last triangle reference"));
        };
        self.next_ref += count;
        let mut around = Aabb::EMPTY;
        for triangle_ref in triangle_refs {
            let triangle = triangle_ref.triangle;
            let listed = &mut self.listed[triangle as usize];
            ensure!(!*listed, "leaf {index} has triangle {triangle}, which another place has as well");
            *listed = true;
            around = around.union(self.expected.aabb(triangle));
        }
        Ok(around)
    }
}
