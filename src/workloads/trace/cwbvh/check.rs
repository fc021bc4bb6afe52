//! Invariants of a compressed wide BVH.
//!
//! A node's planes are its own, so that a child may reach a little out of its parent. What a ray must pass to reach a
//! leaf is the intersection of all boxes on the way: that has to hold the leaf's triangles.

use super::layout::{CwChild, CwNode, Cwbvh, INNER, WIDTH};
use crate::math::Aabb;
use crate::workloads::trace::bvh::DEPTH_LIMIT;
use crate::workloads::trace::bvh::cover::Cover;
use crate::workloads::trace::common::check::{Expected, Verdict, ensure};
use glam::Vec3A;

pub(crate) fn check(tree: &Cwbvh, expected: &Expected) -> Verdict {
    let count = tree.nodes.len();
    ensure!(count > 0, "no nodes");
    if expected.hittable.is_empty() {
        ensure!(count == 1 && tree.nodes[0] == CwNode::EMPTY, "no triangles, but nodes");
        ensure!(tree.triangle_refs.is_empty() && tree.depth == 0, "no triangles, but triangle references or a depth");
        return Ok(());
    }
    let mut divided = vec![0_u8; expected.boxes.len()];
    tree.triangle_refs
        .iter()
        .for_each(|r| divided[r.triangle as usize] = divided[r.triangle as usize].saturating_add(1));
    let mut walk = Walk {
        tree,
        seen: vec![false; count],
        used: vec![false; tree.triangle_refs.len()],
        cover: Cover::new(expected),
        is_divided: divided.iter().any(|&times| times > 1),
        depth: 0,
    };
    walk.node(0, 1, tree.bounds)?;
    ensure!(walk.depth == tree.depth, "depth is {}, the field says {}", walk.depth, tree.depth);
    if let Some(node) = walk.seen.iter().position(|&seen| !seen) {
        return Err(format!("node {node} cannot be reached"));
    }
    if let Some(triangle_ref) = walk.used.iter().position(|&used| !used) {
        return Err(format!("triangle reference {triangle_ref} is in no leaf"));
    }
    walk.cover.check()
}

struct Walk<'a> {
    tree: &'a Cwbvh,
    /// Nodes that were visited.
    seen: Vec<bool>,
    /// Triangle references that a leaf has.
    used: Vec<bool>,
    cover: Cover<'a>,
    /// A triangle has several references.
    is_divided: bool,
    depth: u32,
}

impl Walk<'_> {
    /// Checks a node and all below it, which rays reach through a box; returns the box around the parts of triangles
    /// there.
    fn node(&mut self, index: u32, depth: u32, way: Aabb) -> Result<Aabb, String> {
        let Some(seen) = self.seen.get_mut(index as usize) else {
            return Err(format!("node {index} lies behind the last one"));
        };
        ensure!(!*seen, "node {index} is reached twice");
        *seen = true;
        ensure!(depth <= DEPTH_LIMIT, "node {index} lies deeper than {DEPTH_LIMIT}");
        self.depth = self.depth.max(depth);
        let node = self.tree.nodes[index as usize];
        let grid = node.grid();
        ensure!(grid.step.to_array().iter().all(|step| step.is_normal()), "node {index} has steps {}", grid.step);
        ensure!(grid.lo.is_finite(), "node {index} begins at {}", grid.lo);
        let mut contents = [None; WIDTH];
        for place in 0..WIDTH {
            let what = format!("child {place} of node {index}");
            check_meta(&node, place, &what)?;
            let Some(child) = node.child(place) else { continue };
            let own = grid.aabb(node.numbers(place));
            let way = Aabb { min: way.min.max(own.min), max: way.max.min(own.max) };
            let content = match child {
                CwChild::Node(next) => self.node(next, depth + 1, way)?,
                CwChild::Leaf(first, count) => self.leaf(&what, first, count, way)?,
            };
            contents[place] = Some(content);
        }
        let filled = contents.iter().flatten().count();
        let least = if self.seen.len() == 1 { 1 } else { 2 };
        ensure!(filled >= least, "node {index} has {filled} children");
        let around = contents.iter().flatten().fold(Aabb::EMPTY, |all, content| all.union(*content));
        if !self.is_divided {
            ensure!(
                grid.lo == Vec3A::from(around.min),
                "node {index} begins at {}, its content at {}",
                grid.lo,
                around.min
            );
            for (place, content) in contents.iter().enumerate() {
                let (own, Some(content)) = (node.numbers(place), content) else { continue };
                let fitting = grid.numbers(*content);
                let same = grid.aabb(own) == grid.aabb(fitting);
                ensure!(same, "child {place} of node {index} has planes {own:?}, around its content are {fitting:?}");
            }
        }
        Ok(around)
    }

    /// The box around a leaf's triangles, as far as rays reach them.
    fn leaf(&mut self, what: &str, first: u32, count: u32, way: Aabb) -> Result<Aabb, String> {
        let range = first as usize..first as usize + count as usize;
        let Some(triangle_refs) = self.tree.triangle_refs.get(range.clone()) else {
            return Err(format!("{what} reaches behind the last triangle reference"));
        };
        if let Some(again) = range.clone().find(|&i| self.used[i]) {
            return Err(format!("{what} has triangle reference {again}, which another leaf has as well"));
        }
        self.used[range].fill(true);
        self.cover.leaf(what, way, triangle_refs)
    }
}

/// Checks the word of a child, and that an empty place has no box.
fn check_meta(node: &CwNode, place: usize, what: &str) -> Verdict {
    let (meta, is_inner) = (node.meta[place], node.inner >> place & 1 == 1);
    let (bits, low) = (meta >> 5, meta & 31);
    if is_inner {
        ensure!(bits == 1 && low == INNER + place as u8, "{what} is a node, but its word is {meta}");
    } else if meta == 0 {
        ensure!(node.numbers(place) == ([0; 3], [0; 3]), "{what} is empty, but has a box");
    } else {
        ensure!([1, 3, 7].contains(&bits), "{what} is a leaf, but its word is {meta}");
        ensure!(u32::from(low) + bits.count_ones() <= u32::from(INNER), "{what} begins at offset {low}");
    }
    Ok(())
}
