//! Invariants of a compressed wide BVH.
//!
//! A node's planes are its own, so that a child may reach a little out of its parent. What a ray must pass to reach a
//! leaf is the intersection of all boxes on the way: that has to hold the leaf's triangles.

use super::layout::{CwChild, CwNode, Cwbvh, INNER, WIDTH};
use crate::math::Aabb;
use crate::workloads::trace::common::check::{Expected, Verdict, ensure};
use crate::workloads::trace::wide::reached::Reached;
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
    let reached = Reached::new(count, &tree.triangle_refs, expected);
    let mut walk = Walk { tree, reached, is_divided: divided.iter().any(|&times| times > 1) };
    walk.node(0, 1, tree.bounds)?;
    walk.reached.all(tree.depth)
}

struct Walk<'a> {
    tree: &'a Cwbvh,
    reached: Reached<'a>,
    /// A triangle has several references.
    is_divided: bool,
}

impl Walk<'_> {
    /// Checks a node and all below it, which rays reach through a box; returns the box around the parts of triangles
    /// there.
    fn node(&mut self, index: u32, depth: u32, way: Aabb) -> Result<Aabb, String> {
        self.reached.node(index as usize, depth)?;
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
                CwChild::Leaf(first, count) => self.reached.leaf(&what, (first, count), way)?,
            };
            contents[place] = Some(content);
        }
        self.reached.children(index as usize, contents.iter().flatten().count())?;
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
