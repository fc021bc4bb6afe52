//! What a check has reached of a tree whose nodes have several children: every node and every triangle reference once.

use crate::math::Aabb;
use crate::workloads::trace::TriangleRef;
use crate::workloads::trace::bvh::DEPTH_LIMIT;
use crate::workloads::trace::bvh::cover::Cover;
use crate::workloads::trace::common::check::{Expected, Verdict, ensure};

pub(in crate::workloads::trace) struct Reached<'a> {
    nodes: Vec<bool>,
    in_leaves: Vec<bool>,
    triangle_refs: &'a [TriangleRef],
    cover: Cover<'a>,
    depth: u32,
}

impl<'a> Reached<'a> {
    /// Nothing yet, of so many nodes.
    pub fn new(nodes: usize, triangle_refs: &'a [TriangleRef], expected: &'a Expected) -> Reached<'a> {
        Reached {
            nodes: vec![false; nodes],
            in_leaves: vec![false; triangle_refs.len()],
            triangle_refs,
            cover: Cover::new(expected),
            depth: 0,
        }
    }

    /// A node at a depth of 1 or more, before anything of it is read.
    pub fn node(&mut self, index: usize, depth: u32) -> Verdict {
        let Some(reached) = self.nodes.get_mut(index) else {
            return Err(format!("node {index} lies behind the last one"));
        };
        ensure!(!*reached, "node {index} is reached twice");
        *reached = true;
        ensure!(depth <= DEPTH_LIMIT, "node {index} lies deeper than {DEPTH_LIMIT}");
        self.depth = self.depth.max(depth);
        Ok(())
    }

    /// The number of a node's children: only a root that is the one node may have a single one.
    pub fn children(&self, index: usize, count: usize) -> Verdict {
        let least = if self.nodes.len() == 1 { 1 } else { 2 };
        ensure!(count >= least, "node {index} has {count} children");
        Ok(())
    }

    /// The box around a leaf's triangles, each clipped to the box through which rays reach them.
    pub fn leaf(&mut self, what: &str, (first, count): (u32, u32), way: Aabb) -> Result<Aabb, String> {
        let range = first as usize..first as usize + count as usize;
        let Some(triangle_refs) = self.triangle_refs.get(range.clone()) else {
            return Err(format!("{what} reaches behind the last triangle reference"));
        };
        if let Some(again) = range.clone().find(|&i| self.in_leaves[i]) {
            return Err(format!("{what} has triangle reference {again}, which another leaf has as well"));
        }
        self.in_leaves[range].fill(true);
        self.cover.leaf(what, way, triangle_refs)
    }

    /// The end: all was reached, to this depth.
    pub fn all(self, depth: u32) -> Verdict {
        ensure!(self.depth == depth, "depth is {}, the field says {depth}", self.depth);
        if let Some(node) = self.nodes.iter().position(|&reached| !reached) {
            return Err(format!("node {node} cannot be reached"));
        }
        if let Some(triangle_ref) = self.in_leaves.iter().position(|&reached| !reached) {
            return Err(format!("triangle reference {triangle_ref} is in no leaf"));
        }
        self.cover.check()
    }
}
