//! Invariants of a BVH.

use crate::math::Aabb;
use crate::workloads::trace::bvh::cover::Cover;
use crate::workloads::trace::bvh::{Bvh, BvhNode, DEPTH_LIMIT, MAX_LEAF};
use crate::workloads::trace::common::check::{Expected, Verdict, ensure, same};

pub(crate) fn check(bvh: &Bvh, expected: &Expected) -> Verdict {
    let count = bvh.nodes.len();
    ensure!(count >= 2 && count.is_multiple_of(2), "{count} nodes: an even number, at least 2, is needed");
    ensure!(bvh.nodes[1] == BvhNode::NONE, "the root's sibling is no dummy");
    if expected.hittable.is_empty() {
        ensure!(bvh.nodes[0] == BvhNode::NONE && count == 2, "no triangles, but nodes");
        ensure!(bvh.triangle_refs.is_empty() && bvh.depth == 0, "no triangles, but triangle references or a depth");
        return Ok(());
    }
    let mut walk = Walk { bvh, seen: vec![false; count], next_ref: 0, cover: Cover::new(expected), depth: 0 };
    walk.seen[1] = true;
    let root = walk.node(0, 0)?;
    ensure!(same(root, bvh.bounds), "the root's box {root:?} is not the bounds");
    ensure!(walk.depth == bvh.depth, "depth is {}, the field says {}", walk.depth, bvh.depth);
    ensure!(
        walk.next_ref == bvh.triangle_refs.len(),
        "{} triangle references, {} in leaves",
        bvh.triangle_refs.len(),
        walk.next_ref
    );
    if let Some(node) = walk.seen.iter().position(|&seen| !seen) {
        return Err(format!("node {node} cannot be reached"));
    }
    walk.cover.check()
}

struct Walk<'a> {
    bvh: &'a Bvh,
    seen: Vec<bool>,
    next_ref: usize,
    cover: Cover<'a>,
    depth: u32,
}

impl Walk<'_> {
    /// Checks a node and all below it; returns its box.
    fn node(&mut self, index: usize, depth: u32) -> Result<Aabb, String> {
        ensure!(!self.seen[index], "node {index} is reached twice");
        self.seen[index] = true;
        ensure!(depth <= DEPTH_LIMIT, "node {index} lies deeper than {DEPTH_LIMIT}");
        let node = self.bvh.nodes[index];
        let tight = if node.count > 0 { self.leaf(index, &node, depth)? } else { self.inner(index, &node, depth)? };
        ensure!(same(node.aabb(), tight), "node {index} has box {:?}, its content {tight:?}", node.aabb());
        Ok(node.aabb())
    }

    fn inner(&mut self, index: usize, node: &BvhNode, depth: u32) -> Result<Aabb, String> {
        let first = node.first as usize;
        ensure!(first.is_multiple_of(2) && first >= 2, "the children of node {index} begin at {first}");
        ensure!(first + 1 < self.bvh.nodes.len(), "the children of node {index} lie behind the last node");
        let left = self.node(first, depth + 1)?;
        let right = self.node(first + 1, depth + 1)?;
        Ok(left.union(right))
    }

    /// The box around the leaf's triangles, each clipped to the leaf.
    fn leaf(&mut self, index: usize, node: &BvhNode, depth: u32) -> Result<Aabb, String> {
        self.depth = self.depth.max(depth);
        ensure!(node.count <= MAX_LEAF, "leaf {index} has {} triangle references, more than {MAX_LEAF}", node.count);
        ensure!(
            node.first as usize == self.next_ref,
            "leaf {index} begins at triangle reference {}, not at {} behind its neighbour",
            node.first,
            self.next_ref
        );
        let range = self.next_ref..self.next_ref + node.count as usize;
        let Some(triangle_refs) = self.bvh.triangle_refs.get(range.clone()) else {
            return Err(format!("leaf {index} reaches behind the last triangle reference"));
        };
        self.next_ref = range.end;
        self.cover.leaf(&format!("leaf {index}"), node.aabb(), triangle_refs)
    }
}
