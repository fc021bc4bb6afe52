//! BVH builder: top down, SAH over binned centroids, until at most `max_leaf` triangles are left.

use crate::error::{Error, Result};
use crate::scene::Scene;
use crate::workloads::trace::bvh::bins::{Binning, Item, Rows, Splitter};
use crate::workloads::trace::bvh::partition::{Partitioner, Sides, centroid_bounds, halve};
use crate::workloads::trace::bvh::{Bvh, BvhNode, MAX_DEPTH, MAX_REFERENCES};
use crate::workloads::trace::common::part::{Below, Part};
use crate::workloads::trace::common::prims::{self, CHUNK, Prim};
use crate::workloads::trace::common::sah::{CostModel, half_area, unit};
use rayon::prelude::*;

/// What can be set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Bins per axis, 2 to 32.
    pub bins: usize,
    /// No leaf has more triangles than this, 1 to [`crate::workloads::trace::bvh::MAX_LEAF`].
    pub max_leaf: usize,
    /// A node that could be a leaf is split all the same where that is cheaper. An infinite cost of a step makes it a
    /// leaf always.
    pub cost: CostModel,
    /// Levels of inner nodes that no tree exceeds, 1 to [`crate::workloads::trace::bvh::DEPTH_LIMIT`].
    pub max_depth: u32,
}

impl Default for Config {
    /// What explains the published node counts best.
    fn default() -> Self {
        let cost = CostModel { traversal: f64::INFINITY, intersection: 1.0 };
        Config { bins: 16, max_leaf: 4, cost, max_depth: MAX_DEPTH }
    }
}

/// Subtrees of at most this many triangles are built by one thread into one vector. A constant, so that the tree does
/// not depend on the number of threads.
const TASK: usize = 1024;

/// Builds a BVH over all triangles that can be hit, on the threads of the current rayon pool.
pub fn build(scene: &Scene, config: &Config) -> Result<Bvh> {
    let item = |prim: Prim| {
        let [a, b, c] = scene.corners(prim.triangle());
        Item { prim, centroid3: (a + b + c).extend(1.0) }
    };
    let (mut items, bounds) = prims::gather(scene, Item::NONE, item, |item| &item.prim)?;
    if items.is_empty() {
        return Ok(Bvh { bounds, nodes: vec![BvhNode::NONE; 2], triangle_refs: Vec::new(), depth: 0, spatial: None });
    }
    check_number(scene, items.len())?;
    check_depth(items.len(), config.max_leaf, config.max_depth)?;
    let builder = Builder { config: *config, unit: unit(&bounds) };
    let rows = Rows { min: bounds.min.extend(0.0), max: bounds.max.extend(0.0) };
    let part = builder.grow(&mut items, 0, rows, 0);
    let depth = part.depth;
    let triangle_ref = |item: &Item| prims::triangle_ref(scene, item.prim.triangle());
    let (nodes, triangle_refs) = rayon::join(
        || part.into_nodes().0,
        || {
            let triangle_refs = items.par_iter().with_min_len(CHUNK).map(triangle_ref).collect();
            drop(items);
            triangle_refs
        },
    );
    Ok(Bvh { bounds, nodes, triangle_refs, depth, spatial: None })
}

struct Builder {
    config: Config,
    unit: f32,
}

/// Buffers of one thread, reused from node to node.
struct Scratch {
    splitter: Splitter,
    partitioner: Partitioner,
    nodes: Vec<BvhNode>,
}

impl Builder {
    /// Builds the subtree of `items`, whose triangle references will begin at `first`; sides of large nodes in
    /// parallel.
    fn grow(&self, items: &mut [Item], first: u32, bounds: Rows, depth: u32) -> Part<BvhNode> {
        let mut scratch = Scratch {
            splitter: Splitter::new(self.unit),
            partitioner: Partitioner::new(),
            nodes: Vec::with_capacity(if items.len() <= TASK { items.len() / 4 * 3 } else { 0 }),
        };
        if items.len() <= TASK {
            let (root, depth) = self.subtree(items, first, bounds, depth, &mut scratch);
            return Part { root, below: Below::Nodes(scratch.nodes, Vec::new()), depth };
        }
        let sides = self.partition(items, depth, &mut scratch);
        let (left, right) = items.split_at_mut(sides.mid);
        let (a, b) = rayon::join(
            || self.grow(left, first, sides.left, depth + 1),
            || self.grow(right, first + sides.mid as u32, sides.right, depth + 1),
        );
        Part::of(BvhNode::inner(&bounds, 0), [a, b])
    }

    /// Builds a subtree on one thread, depth first; returns its root and its depth.
    fn subtree(
        &self,
        items: &mut [Item],
        first: u32,
        bounds: Rows,
        depth: u32,
        scratch: &mut Scratch,
    ) -> (BvhNode, u32) {
        if items.len() <= self.config.max_leaf && !self.is_worth_splitting(items, &bounds, depth, scratch) {
            return (BvhNode::leaf(&bounds, first, items.len() as u32), 0);
        }
        let sides = self.partition(items, depth, scratch);
        let pair = scratch.nodes.len();
        scratch.nodes.extend([BvhNode::NONE; 2]);
        let (left, right) = items.split_at_mut(sides.mid);
        let (a, a_depth) = self.subtree(left, first, sides.left, depth + 1, scratch);
        let (b, b_depth) = self.subtree(right, first + sides.mid as u32, sides.right, depth + 1, scratch);
        scratch.nodes[pair..pair + 2].copy_from_slice(&[a, b]);
        (BvhNode::inner(&bounds, pair as u32), 1 + a_depth.max(b_depth))
    }

    /// True if a node of few triangles costs less, by the surface area heuristic, with two leaves than as one.
    fn is_worth_splitting(&self, items: &[Item], bounds: &Rows, depth: u32, scratch: &mut Scratch) -> bool {
        let CostModel { traversal, intersection } = self.config.cost;
        if !traversal.is_finite() || items.len() < 2 || is_near_the_bottom(items.len(), depth, self.config.max_depth) {
            return false;
        }
        let Some(split) = scratch.splitter.find(items, &self.binning(items)) else { return false };
        let tests = |sides: &Rows, count: usize| half_area(&sides.aabb()) * count as f64;
        let split_tests = tests(&split.left, split.left_count) + tests(&split.right, items.len() - split.left_count);
        let whole_tests = tests(bounds, items.len());
        traversal * half_area(&bounds.aabb()) + intersection * split_tests < intersection * whole_tests
    }

    /// Bins for the centroids of a node.
    fn binning(&self, items: &[Item]) -> Binning {
        // Most nodes are small. Half the bins do there (bunny: 0.1 % on the cost), since more would stay empty. At
        // least four bins are used.
        let Config { bins, .. } = self.config;
        let bins = if items.len() <= 2 * bins { bins.div_ceil(2).max(bins.min(4)) } else { bins };
        Binning::new(&centroid_bounds(items), bins)
    }

    /// Reorders `items` into two non-empty sides.
    fn partition(&self, items: &mut [Item], depth: u32, scratch: &mut Scratch) -> Sides {
        if is_near_the_bottom(items.len(), depth, self.config.max_depth) {
            return halve(items);
        }
        let binning = self.binning(items);
        let Some(split) = scratch.splitter.find(items, &binning) else { return halve(items) };
        let mid = scratch.partitioner.shared(items, |item| binning.of(item)[split.axis] <= split.bin);
        debug_assert_eq!(mid, split.left_count);
        Sides { mid, left: split.left, right: split.right }
    }
}

/// True if halving `items` from here on just keeps within the greatest depth: below this depth there are only median
/// splits, so that it holds.
pub(crate) fn is_near_the_bottom(items: usize, depth: u32, max_depth: u32) -> bool {
    depth + halvings(items) >= max_depth
}

/// Refuses more triangles than the references of a tree can name.
pub(crate) fn check_number(scene: &Scene, triangles: usize) -> Result<()> {
    if triangles <= MAX_REFERENCES {
        return Ok(());
    }
    let problem = format!("{triangles} triangles are more than a BVH can hold ({MAX_REFERENCES})");
    Err(Error::too_large(&scene.name, problem, "use a smaller scene"))
}

/// Refuses a greatest depth that does not hold even if every node is halved.
pub(crate) fn check_depth(items: usize, max_leaf: usize, max_depth: u32) -> Result<()> {
    match items.div_ceil(max_leaf).next_power_of_two().trailing_zeros() {
        levels if levels <= max_depth => Ok(()),
        levels => {
            let problem = format!("{items} triangles may take {levels} levels, more than {max_depth}");
            Err(Error::too_large("the tree", problem, "set a greater max_depth"))
        }
    }
}

/// Levels that are enough for so many items if every node is halved.
fn halvings(items: usize) -> u32 {
    usize::BITS - items.leading_zeros()
}
