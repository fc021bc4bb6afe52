//! The modern baseline: obvhs builds by PLOC with reinsertion, and its tree is copied into this crate's layout.
//!
//! D. Meister and J. Bittner: Parallel Locally-Ordered Clustering for BVH Construction, 2018, and Parallel Reinsertion
//! for BVH Optimization, 2018. The presets are obvhs's own.

use crate::error::Result;
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::bvh::build::check_number;
use crate::workloads::trace::bvh::ploc_passes;
use crate::workloads::trace::bvh::{Bvh, BvhNode, MAX_DEPTH, MAX_LEAF};
use crate::workloads::trace::common::prims::{self, Prim};
use crate::workloads::trace::common::sah::unit;
use glam::Vec3;
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::triangle::Triangle;
use rayon::prelude::*;

/// Names of obvhs's presets, cheapest first.
pub const PRESETS: [&str; 6] = ["fastest", "very-fast", "fast", "medium", "slow", "very-slow"];

/// How far a box of a split triangle is moved outwards, in units of the scene's largest extent or coordinate. obvhs
/// clips exactly to the split plane, and a hit there, computed in f32, may lie just outside of both halves.
const SPLIT_MARGIN: f32 = 1.0 / (1 << 18) as f32;

/// From this depth on, a subtree that would be too deep is balanced instead: half of [`MAX_DEPTH`] is enough for any
/// number of leaves that there can be.
const REBALANCE: u32 = MAX_DEPTH / 2;

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

/// PLOC's passes may look at `LOOKS_PER_TRIANGLE` nodes per triangle plus `LOOKS_BASE`, which is about 0.3 s at 137 ns
/// a look (search distance 14, one thread). Usual scenes take 3 per triangle.
const LOOKS_PER_TRIANGLE: u64 = 12;
const LOOKS_BASE: u64 = 1 << 21;

/// True if obvhs's time would grow with the square of the number of triangles (see [`ploc_passes`]).
fn is_endless(prims: &[Prim], bounds: &Aabb) -> bool {
    let most = LOOKS_PER_TRIANGLE * prims.len() as u64 + LOOKS_BASE;
    ploc_passes::looks(prims, bounds, unit(bounds), most) > most
}

/// What obvhs is given of a scene. It multiplies extents in f32, so it gets the scene scaled to about 1, and only the
/// tree is taken from it.
pub(in crate::workloads::trace) struct Given<'a> {
    pub scene: &'a Scene,
    /// Box around all triangles that can be hit.
    pub bounds: Aabb,
    /// Index in the scene of every triangle that can be hit.
    pub triangles: Vec<u32>,
    scale: f64,
    /// Set if triangles may be split.
    margin: Option<f32>,
}

impl<'a> Given<'a> {
    /// All triangles that can be hit; `None` where PLOC would take excessive time.
    ///
    /// # Errors
    /// [`crate::Error::Refused`] if there are more triangles than a structure can hold.
    pub fn of(scene: &'a Scene, pre_split: bool) -> Result<Option<Given<'a>>> {
        let (prims, bounds) = prims::prims(scene)?;
        check_number(scene, prims.len())?;
        if is_endless(&prims, &bounds) {
            return Ok(None);
        }
        let (scale, margin) = (scale(&bounds), pre_split.then(|| margin(&bounds)));
        Ok(Some(Given { scene, bounds, triangles: prims.iter().map(|p| p.triangle()).collect(), scale, margin }))
    }

    /// The triangles in obvhs's type.
    pub fn obvhs_triangles(&self) -> Vec<Triangle> {
        let scaled = |&triangle: &u32| {
            let [v0, v1, v2] = self.scene.corners(triangle).map(|c| (c.as_dvec3() * self.scale).as_vec3a());
            Triangle { v0, v1, v2 }
        };
        self.triangles.par_iter().map(scaled).collect()
    }

    /// The triangles of a leaf by obvhs's numbers, each once: two halves of a split triangle may have met again.
    pub fn leaf(&self, numbers: &[u32]) -> Vec<u32> {
        let mut triangles: Vec<u32> = numbers.iter().map(|&i| self.triangles[i as usize]).collect();
        triangles.sort_unstable();
        triangles.dedup();
        triangles
    }

    /// What a leaf with this box of obvhs's holds of its triangles, where they may be split.
    pub fn limit(&self, leaf: &obvhs::aabb::Aabb) -> Option<Aabb> {
        self.margin.map(|margin| {
            let back = |v: glam::Vec3A| (v.as_dvec3() / self.scale).as_vec3();
            let (min, max) = (back(leaf.min), back(leaf.max));
            Aabb { min: min - Vec3::splat(margin), max: max + Vec3::splat(margin) }
        })
    }

    /// The box of a triangle as far as it lies within a limit.
    pub fn part(&self, triangle: u32, limit: Option<Aabb>) -> Aabb {
        let whole = Aabb::from_points(self.scene.corners(triangle).map(Vec3::from));
        let within = |limit: Aabb| Aabb { min: whole.min.max(limit.min), max: whole.max.min(limit.max) };
        limit.map_or(whole, within)
    }
}

/// Builds a BVH over all triangles that can be hit, on the threads of the current rayon pool; `None` where PLOC would
/// take excessive time, as it does over many boxes that are equal, in a row or inside each other.
///
/// # Errors
/// [`crate::Error::Refused`] if there are more triangles than a structure can hold.
pub fn build(scene: &Scene, params: BvhBuildParams) -> Result<Option<Bvh>> {
    let Some(given) = Given::of(scene, params.pre_split)? else { return Ok(None) };
    let bounds = given.bounds;
    if given.triangles.is_empty() {
        let nodes = vec![BvhNode::NONE; 2];
        return Ok(Some(Bvh { bounds, nodes, triangle_refs: Vec::new(), depth: 0, spatial: None }));
    }
    let tree = build_bvh2_from_tris(&given.obvhs_triangles(), params, &mut Default::default());
    let mut copy = Copy {
        given: &given,
        tree: &tree,
        nodes: vec![BvhNode::NONE; 2],
        triangle_refs: Vec::with_capacity(tree.primitive_indices.len()),
        depth: 0,
        heights: Vec::new(),
    };
    copy.heights = copy.heights();
    copy.nodes[0] = copy.node(0, 0);
    Ok(Some(Bvh { bounds, nodes: copy.nodes, triangle_refs: copy.triangle_refs, depth: copy.depth, spatial: None }))
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
    given: &'a Given<'a>,
    tree: &'a Bvh2,
    nodes: Vec<BvhNode>,
    triangle_refs: Vec<crate::workloads::trace::TriangleRef>,
    depth: u32,
    heights: Vec<u32>,
}

impl Copy<'_> {
    /// Levels of inner nodes below every node of obvhs's tree. Without recursion: there is no bound on its depth, and
    /// over thousands of triangles in one place reinsertion makes it a chain.
    fn heights(&self) -> Vec<u32> {
        let mut parents_first = vec![0_usize];
        let mut next = 0;
        while let Some(node) = parents_first.get(next).map(|&i| &self.tree.nodes[i]) {
            if !node.is_leaf() {
                parents_first.extend([node.first_index as usize, node.first_index as usize + 1]);
            }
            next += 1;
        }
        let mut heights = vec![0; self.tree.nodes.len()];
        for &i in parents_first.iter().rev() {
            let node = &self.tree.nodes[i];
            if !node.is_leaf() {
                let first = node.first_index as usize;
                heights[i] = 1 + heights[first].max(heights[first + 1]);
            }
        }
        heights
    }

    /// Copies the subtree below `from`, depth first; returns its root, with boxes fitted to the triangles themselves.
    fn node(&mut self, from: usize, depth: u32) -> BvhNode {
        let node = self.tree.nodes[from];
        if node.is_leaf() {
            return self.leaf(&node, depth);
        }
        if depth >= REBALANCE && depth + self.heights[from] > MAX_DEPTH {
            let leaves = self.leaves(from);
            return self.balanced(&leaves, depth);
        }
        let first = node.first_index as usize;
        self.pair(|copy| [copy.node(first, depth + 1), copy.node(first + 1, depth + 1)])
    }

    /// An inner node over the two children that `children` makes.
    fn pair(&mut self, children: impl FnOnce(&mut Self) -> [BvhNode; 2]) -> BvhNode {
        let pair = self.nodes.len();
        self.nodes.extend([BvhNode::NONE; 2]);
        let children = children(self);
        self.nodes[pair..pair + 2].copy_from_slice(&children);
        let bounds = children[0].aabb().union(children[1].aabb());
        BvhNode { min: bounds.min.into(), first: pair as u32, max: bounds.max.into(), count: 0 }
    }

    /// The leaves below a node, from left to right.
    fn leaves(&self, from: usize) -> Vec<usize> {
        let (mut leaves, mut waiting) = (Vec::new(), vec![from]);
        while let Some(i) = waiting.pop() {
            let node = &self.tree.nodes[i];
            if node.is_leaf() {
                leaves.push(i);
            } else {
                waiting.extend([node.first_index as usize + 1, node.first_index as usize]);
            }
        }
        leaves
    }

    /// A balanced tree over some of obvhs's leaves, in their order.
    fn balanced(&mut self, leaves: &[usize], depth: u32) -> BvhNode {
        if let [leaf] = *leaves {
            return self.leaf(&self.tree.nodes[leaf], depth);
        }
        let (left, right) = leaves.split_at(leaves.len() / 2);
        self.pair(|copy| [copy.balanced(left, depth + 1), copy.balanced(right, depth + 1)])
    }

    fn leaf(&mut self, node: &Bvh2Node, depth: u32) -> BvhNode {
        self.depth = self.depth.max(depth);
        let range = node.first_index as usize..(node.first_index + node.prim_count) as usize;
        let triangles = self.given.leaf(&self.tree.primitive_indices[range]);
        let limit = self.given.limit(node.aabb());
        let first = self.triangle_refs.len() as u32;
        let mut bounds = Aabb::EMPTY;
        for &triangle in &triangles {
            bounds = bounds.union(self.given.part(triangle, limit));
            self.triangle_refs.push(prims::triangle_ref(self.given.scene, triangle));
        }
        BvhNode { min: bounds.min.into(), first, max: bounds.max.into(), count: triangles.len() as u32 }
    }
}
