//! Linear BVH: the binary radix tree over Morton codes, whose small subtrees are leaves. Twin of
//! `kernels/trace/build/{list,nodes,leaves,refit,top}.wgsl`.
//!
//! T. Karras: Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d Trees, 2012. Ours: boxes go up level
//! by level instead of by atomic counters alone, since a pass of a device is sure to see only what earlier passes
//! wrote; and the children of the k-th inner node that is no part of a leaf are the k-th pair of nodes.

use super::Input;
use super::codes::Sorted;
use super::tree::{self, Range};
use crate::error::Result;
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::bvh::{Bvh, BvhNode};
use crate::workloads::trace::common::prims::{self, CHUNK, Prim};
use rayon::prelude::*;

/// Builds a BVH over all triangles that can be hit, with leaves of at most `max_leaf` of them, at least 1.
///
/// # Errors
/// [`crate::Error::Refused`] for more triangles than a BVH can hold.
pub fn build(scene: &Scene, max_leaf: u32) -> Result<Bvh> {
    let (prims, bounds) = match Input::of(scene, max_leaf)? {
        Input::Leaf(bvh) => return Ok(bvh),
        Input::Prims(prims, bounds) => (prims, bounds),
    };
    let Sorted { keys, order } = Sorted::of(&prims, &bounds);
    let inner = (0..keys.len() - 1).into_par_iter().with_min_len(CHUNK);
    let ranges: Vec<Option<Range>> = inner.map(|i| tree::range(&keys, i, max_leaf)).collect();
    let mut kept = 0;
    let rank = |range: &Option<Range>| {
        let rank = kept;
        kept += u32::from(range.is_some());
        rank
    };
    let ranks: Vec<u32> = ranges.iter().map(rank).collect();
    let mut emission = Emission {
        prims: &prims,
        order: &order,
        ranges: &ranges,
        ranks: &ranks,
        max_leaf,
        nodes: vec![BvhNode::NONE; 2 + 2 * kept as usize],
        depth: 0,
    };
    emission.nodes[0] = emission.node(0, (0, keys.len() as u32 - 1), 0);
    let Emission { nodes, depth, .. } = emission;
    let sorted: Vec<Prim> = order.par_iter().with_min_len(CHUNK).map(|&i| prims[i as usize]).collect();
    Ok(Bvh { bounds, nodes, triangle_refs: prims::triangle_refs(scene, &sorted), depth, spatial: None })
}

/// Nodes with boxes, from the bottom up.
struct Emission<'a> {
    prims: &'a [Prim],
    order: &'a [u32],
    ranges: &'a [Option<Range>],
    ranks: &'a [u32],
    max_leaf: u32,
    nodes: Vec<BvhNode>,
    depth: u32,
}

impl Emission<'_> {
    /// The node over the sorted triangles `first` to `last`, which is inner node `index` unless it is a leaf.
    fn node(&mut self, index: u32, (first, last): (u32, u32), depth: u32) -> BvhNode {
        let range = self.ranges.get(index as usize).copied().flatten();
        let Some(range) = range.filter(|_| last - first >= self.max_leaf) else {
            self.depth = self.depth.max(depth);
            let leaf = &self.order[first as usize..=last as usize];
            let bounds = leaf.iter().fold(Aabb::EMPTY, |all, &i| all.union(self.prims[i as usize].aabb()));
            return BvhNode { min: bounds.min.into(), first, max: bounds.max.into(), count: last - first + 1 };
        };
        let pair = 2 + 2 * self.ranks[index as usize];
        let left = self.node(range.split, (first, range.split), depth + 1);
        let right = self.node(range.split + 1, (range.split + 1, last), depth + 1);
        self.nodes[pair as usize..pair as usize + 2].copy_from_slice(&[left, right]);
        BvhNode::around(&left, &right, pair)
    }
}
