//! Invariants of a BVH.
//!
//! A builder may divide a triangle into several references. The leaf of each holds a part of the triangle's box, which
//! a builder enlarges so that no hit is lost; what is asked of all of them together is that they cover the triangle.

use crate::math::Aabb;
use crate::workloads::trace::bvh::cover::is_covered;
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
    let mut walk = Walk {
        bvh,
        expected,
        seen: vec![false; count],
        next_ref: 0,
        covered: vec![Covered::NEVER; expected.boxes.len()],
        parts: Vec::new(),
        depth: 0,
    };
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
    for &triangle in &expected.hittable {
        let covered = &walk.covered[triangle as usize];
        ensure!(covered.times > 0, "triangle {triangle} is in no leaf");
        // A triangle split by the builder is in several leaves whose boxes together must span it.
        ensure!(
            same(covered.span, expected.aabb(triangle)),
            "the leaves of triangle {triangle} span {:?} of its box {:?}",
            covered.span,
            expected.aabb(triangle)
        );
    }
    walk.check_parts()
}

#[derive(Clone)]
struct Covered {
    times: u32,
    /// Box around the triangle's box clipped to each of its leaves.
    span: Aabb,
}

impl Covered {
    const NEVER: Covered = Covered { times: 0, span: Aabb::EMPTY };
}

struct Walk<'a> {
    bvh: &'a Bvh,
    expected: &'a Expected<'a>,
    seen: Vec<bool>,
    next_ref: usize,
    covered: Vec<Covered>,
    /// Triangle and part of its box of every reference.
    parts: Vec<(u32, Aabb)>,
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
        let leaf = node.aabb();
        let mut tight = Aabb::EMPTY;
        for (i, triangle_ref) in triangle_refs.iter().enumerate() {
            let triangle = triangle_ref.triangle;
            ensure!(
                triangle_refs[..i].iter().all(|r| r.triangle != triangle),
                "leaf {index} has triangle {triangle} twice"
            );
            let whole = self.expected.aabb(triangle);
            let part = Aabb { min: whole.min.max(leaf.min), max: whole.max.min(leaf.max) };
            ensure!(!part.is_empty(), "triangle {triangle} lies outside its leaf {index}");
            let covered = &mut self.covered[triangle as usize];
            covered.times += 1;
            covered.span = covered.span.union(part);
            self.parts.push((triangle, part));
            tight = tight.union(part);
        }
        Ok(tight)
    }

    /// Checks that the leaves of every triangle that is divided hold all of it.
    fn check_parts(mut self) -> Verdict {
        self.parts.sort_by_key(|(triangle, _)| *triangle);
        for parts in self.parts.chunk_by(|(a, _), (b, _)| a == b).filter(|parts| parts.len() > 1) {
            let triangle = parts[0].0;
            let corners = self.expected.corners(triangle);
            ensure!(
                is_covered(corners, parts.iter().map(|(_, part)| *part)),
                "the {} leaves of triangle {triangle} do not cover it",
                parts.len()
            );
        }
        Ok(())
    }
}
