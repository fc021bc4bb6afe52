//! The modern baseline: obvhs builds by PLOC with reinsertion, and its tree is copied into this crate's layout.
//!
//! D. Meister and J. Bittner: Parallel Locally-Ordered Clustering for BVH Construction, 2018, and Parallel Reinsertion
//! for BVH Optimization, 2018. The presets are obvhs's own.

use super::bvh::{Bvh, BvhNode, MAX_DEPTH, MAX_LEAF};
use super::prims;
use crate::error::{Error, Result};
use crate::math::Aabb;
use crate::scene::Scene;
use glam::Vec3;
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::triangle::Triangle;
use rayon::prelude::*;

/// Names of obvhs's presets, cheapest first.
pub const PRESETS: [&str; 6] = ["fastest", "very-fast", "fast", "medium", "slow", "very-slow"];

/// How far a box of a split triangle is moved outwards, in units of the scene's largest extent or coordinate. obvhs
/// clips exactly to the split plane, and a hit there, computed in f32, may lie just outside of both halves.
const SPLIT_MARGIN: f32 = 1.0 / (1 << 18) as f32;

/// The parameters of a preset; `None` if there is no such preset.
pub fn preset(name: &str) -> Option<BvhBuildParams> {
    let params = match name {
        "fastest" => BvhBuildParams::fastest_build(),
        "very-fast" => BvhBuildParams::very_fast_build(),
        "fast" => BvhBuildParams::fast_build(),
        "medium" => BvhBuildParams::medium_build(),
        "slow" => BvhBuildParams::slow_build(),
        "very-slow" => BvhBuildParams::very_slow_build(),
        _ => return None,
    };
    Some(BvhBuildParams { max_prims_per_leaf: params.max_prims_per_leaf.min(MAX_LEAF), ..params })
}

/// Builds a BVH over all triangles that can be hit, on the threads of the current rayon pool.
pub fn build(scene: &Scene, params: BvhBuildParams) -> Result<Bvh> {
    let prims = prims::prims(scene)?;
    let bounds = prims::bounds(&prims);
    if prims.is_empty() {
        return Ok(Bvh { bounds, nodes: vec![BvhNode::NONE; 2], records: Vec::new(), depth: 0 });
    }
    // obvhs multiplies extents in f32: it gets the scene scaled to about 1, and only the tree is taken from it.
    let scale = scale(&bounds);
    let triangles: Vec<Triangle> = prims
        .par_iter()
        .map(|prim| {
            let [v0, v1, v2] = scene.corners(prim.triangle()).map(|c| (c.as_dvec3() * scale).as_vec3a());
            Triangle { v0, v1, v2 }
        })
        .collect();
    let tree = build_bvh2_from_tris(&triangles, params, &mut Default::default());
    let mut copy = Copy {
        scene,
        tree: &tree,
        triangles: prims.iter().map(|p| p.triangle()).collect(),
        scale,
        margin: params.pre_split.then(|| margin(&bounds)),
        nodes: vec![BvhNode::NONE; 2],
        records: Vec::with_capacity(tree.primitive_indices.len()),
        depth: 0,
    };
    copy.nodes[0] = copy.node(0, 0)?;
    Ok(Bvh { bounds, nodes: copy.nodes, records: copy.records, depth: copy.depth })
}

/// A power of two that brings the largest coordinate near 1.
fn scale(bounds: &Aabb) -> f64 {
    let largest = f64::from(bounds.min.abs().max(bounds.max.abs()).max_element());
    if largest > 0.0 { largest.log2().floor().exp2().recip() } else { 1.0 }
}

fn margin(bounds: &Aabb) -> f32 {
    let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
    SPLIT_MARGIN * largest.max(bounds.extent().max_element()).min(f32::MAX)
}

struct Copy<'a> {
    scene: &'a Scene,
    tree: &'a Bvh2,
    /// Index in the scene of every triangle that obvhs was given.
    triangles: Vec<u32>,
    scale: f64,
    /// Set if triangles may have been split.
    margin: Option<f32>,
    nodes: Vec<BvhNode>,
    records: Vec<super::Record>,
    depth: u32,
}

impl Copy<'_> {
    /// Copies the subtree below `from`, depth first; returns its root, with boxes fitted to the triangles themselves.
    fn node(&mut self, from: usize, depth: u32) -> Result<BvhNode> {
        let node = self.tree.nodes[from];
        if node.is_leaf() {
            self.depth = self.depth.max(depth);
            return Ok(self.leaf(&node));
        }
        if depth == MAX_DEPTH {
            return Err(Error::argument(
                "ploc",
                format!("obvhs built a tree of more than {MAX_DEPTH} levels over {}", self.scene.name),
                "try another preset",
            ));
        }
        let pair = self.nodes.len();
        self.nodes.extend([BvhNode::NONE; 2]);
        let left = self.node(node.first_index as usize, depth + 1)?;
        let right = self.node(node.first_index as usize + 1, depth + 1)?;
        self.nodes[pair] = left;
        self.nodes[pair + 1] = right;
        let bounds = left.aabb().union(right.aabb());
        Ok(BvhNode { min: bounds.min.into(), first: pair as u32, max: bounds.max.into(), count: 0 })
    }

    fn leaf(&mut self, node: &obvhs::bvh2::node::Bvh2Node) -> BvhNode {
        let range = node.first_index as usize..(node.first_index + node.prim_count) as usize;
        let mut triangles: Vec<u32> =
            self.tree.primitive_indices[range].iter().map(|&i| self.triangles[i as usize]).collect();
        // Two halves of a split triangle may have met again.
        triangles.sort_unstable();
        triangles.dedup();
        let limit = self.margin.map(|margin| {
            let back = |v: glam::Vec3A| (v.as_dvec3() / self.scale).as_vec3();
            let (min, max) = (back(node.aabb().min), back(node.aabb().max));
            Aabb { min: min - Vec3::splat(margin), max: max + Vec3::splat(margin) }
        });
        let first = self.records.len() as u32;
        let mut bounds = Aabb::EMPTY;
        for &triangle in &triangles {
            let whole = Aabb::from_points(self.scene.corners(triangle).map(Vec3::from));
            bounds = bounds.union(match limit {
                Some(limit) => Aabb { min: whole.min.max(limit.min), max: whole.max.min(limit.max) },
                None => whole,
            });
            self.records.push(prims::record(self.scene, triangle));
        }
        BvhNode { min: bounds.min.into(), first, max: bounds.max.into(), count: triangles.len() as u32 }
    }
}
