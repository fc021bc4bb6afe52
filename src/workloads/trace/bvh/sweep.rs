//! BVH builder: top down, SAH over all borders between triangles on all axes, until at most `max_leaf` triangles are
//! left; with spatial splits where they are asked for ([`super::spatial`]).
//!
//! I. Wald, S. Boulos, P. Shirley: Ray Tracing Deformable Scenes using Dynamic Bounding Volume Hierarchies, 2007. On
//! each axis the triangles are in the order of their boxes' centres. Either they are sorted once, and each split
//! filters the three lists, or one list is sorted in every node anew: the same tree.

use crate::error::Result;
use crate::scene::Scene;
use crate::workloads::trace::bvh::bins::Rows;
use crate::workloads::trace::bvh::build::{check_depth, check_number, is_near_the_bottom};
use crate::workloads::trace::bvh::clip::Clipper;
use crate::workloads::trace::bvh::lists::{Border, Pivot, around, cheapest, sort, sorted};
use crate::workloads::trace::bvh::spatial::{FEW_LEAVES, MOST_REFERENCES, Sides, Spatial, SpatialConfig, Tally};
use crate::workloads::trace::bvh::{Bvh, BvhNode, MAX_DEPTH, MAX_REFERENCES};
use crate::workloads::trace::common::part::{Below, Part};
use crate::workloads::trace::common::prims::{self, CHUNK, Prim, SHARED};
use crate::workloads::trace::common::sah::{CostModel, unit};
use rayon::prelude::*;

/// When triangles are sorted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sorting {
    /// Once on each axis.
    Once,
    /// In each node, on each axis.
    EveryNode,
}

/// What can be set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// No leaf has more triangles than this, 1 to [`crate::workloads::trace::bvh::MAX_LEAF`].
    pub max_leaf: usize,
    /// A node that could be a leaf is split all the same where that is cheaper. An infinite cost of a step makes it a
    /// leaf always.
    pub cost: CostModel,
    /// Levels of inner nodes that no tree exceeds, 1 to [`crate::workloads::trace::bvh::DEPTH_LIMIT`].
    pub max_depth: u32,
    /// Has no effect on the tree. Spatial splits need lists that are sorted once.
    pub sorting: Sorting,
    /// True to split on the longest axis of a node's box only.
    pub longest_axis: bool,
    /// With spatial splits.
    pub spatial: Option<SpatialConfig>,
}

impl Default for Config {
    /// The tree of the source `rt2` but for its leaves of three triangles.
    fn default() -> Self {
        let cost = CostModel { traversal: f64::INFINITY, intersection: 1.0 };
        let sorting = Sorting::Once;
        Config { max_leaf: 4, cost, max_depth: MAX_DEPTH, sorting, longest_axis: false, spatial: None }
    }
}

/// Subtrees of at most this many references are built by one thread into one vector. A constant, so that the tree does
/// not depend on the number of threads.
const TASK: usize = 1024;

/// A split is of no use unless it costs less than this share of the node itself: equal boxes are halved instead, since
/// rounding would decide about them.
const USEFUL: f32 = 1.0 - 1.0e-6;

/// Builds a BVH over all triangles that can be hit, on the threads of the current rayon pool.
pub fn build(scene: &Scene, config: &Config) -> Result<Bvh> {
    let (prims, bounds) = prims::prims(scene)?;
    if prims.is_empty() {
        return Ok(Bvh { bounds, nodes: vec![BvhNode::NONE; 2], triangle_refs: Vec::new(), depth: 0, spatial: None });
    }
    check_number(scene, prims.len())?;
    check_depth(prims.len(), config.max_leaf, config.max_depth)?;
    let rows = Rows { min: bounds.min.extend(0.0), max: bounds.max.extend(0.0) };
    let unit = unit(&bounds);
    let spatial = config.spatial.map(|spatial| {
        let (clipper, root) = (Clipper::new(scene, &bounds), rows.half_area(unit));
        Spatial { config: spatial, clipper, unit, root, few: FEW_LEAVES * config.max_leaf, tally: Tally::default() }
    });
    let most = (MOST_REFERENCES * prims.len()).min(MAX_REFERENCES).max(prims.len());
    let root = Node { bounds: rows, depth: 0, spare: if spatial.is_some() { most - prims.len() } else { 0 } };
    let builder = Builder { config: *config, unit, spatial };
    let part = match config.sorting {
        Sorting::Once => {
            let (x, (y, z)) =
                rayon::join(|| sorted(&prims, 0), || rayon::join(|| sorted(&prims, 1), || sorted(&prims, 2)));
            drop(prims);
            builder.grow([x, y, z], root)
        }
        Sorting::EveryNode => builder.grow([prims], root),
    };
    let spatial = builder.spatial.map(|spatial| spatial.tally.splits());
    let depth = part.depth;
    let (nodes, triangles) = part.into_nodes();
    let triangle_ref = |&triangle: &u32| prims::triangle_ref(scene, triangle);
    let triangle_refs = triangles.par_iter().with_min_len(CHUNK).map(triangle_ref).collect();
    Ok(Bvh { bounds, nodes, triangle_refs, depth, spatial })
}

struct Builder<'a> {
    config: Config,
    unit: f32,
    spatial: Option<Spatial<'a>>,
}

/// What is known of a node before it is built.
#[derive(Clone, Copy)]
struct Node {
    bounds: Rows,
    depth: u32,
    /// References that its subtree may add. What is left over at a node is divided between its children by their
    /// numbers of references, so that it does not depend on which of them is built first.
    spare: usize,
}

impl Node {
    fn children(&self, bounds: [Rows; 2], counts: [usize; 2], spare: usize) -> [Node; 2] {
        let left = (spare as u64 * counts[0] as u64 / (counts[0] + counts[1]) as u64) as usize;
        let child = |bounds, spare| Node { bounds, depth: self.depth + 1, spare };
        [child(bounds[0], left), child(bounds[1], spare - left)]
    }
}

/// How a node is split.
enum Split {
    At(Border),
    /// By a plane; the references of both sides.
    Divided(Box<Sides>),
}

/// Buffers of one thread, reused from node to node.
#[derive(Default)]
struct Scratch {
    costs: Vec<f32>,
    prims: Vec<Prim>,
    nodes: Vec<BvhNode>,
    triangles: Vec<u32>,
}

/// Lists of a node's references: one for each axis in its order (`K` = 3), or one in any order (`K` = 1).
impl Builder<'_> {
    /// Builds a subtree; sides of large nodes in parallel.
    fn grow<const K: usize>(&self, mut lists: [Vec<Prim>; K], node: Node) -> Part<BvhNode> {
        let mut scratch = Scratch::default();
        if lists[0].len() <= TASK {
            let (root, depth) = self.subtree(lists.each_mut().map(|list| &mut list[..]), node, &mut scratch);
            return Part { root, below: Below::Nodes(scratch.nodes, scratch.triangles), depth };
        }
        let split = self.split(lists.each_mut().map(|list| &mut list[..]), &node, &mut scratch.costs);
        let (sides, nodes) = match split {
            Split::At(border) => self.sides_of(lists, border, &node),
            Split::Divided(sides) => {
                drop(lists);
                let Sides { lists: [left, right], bounds, spare } = *sides;
                let nodes = node.children(bounds, [left[0].len(), right[0].len()], spare);
                // Only lists on three axes are divided
                ([left, right].map(|mut lists| std::array::from_fn(|axis| std::mem::take(&mut lists[axis]))), nodes)
            }
        };
        let [left, right] = sides;
        let (a, b) = rayon::join(|| self.grow(left, nodes[0]), || self.grow(right, nodes[1]));
        Part::of(BvhNode::around(&a.root, &b.root, 0), [a, b])
    }

    /// The lists of both sides of a border.
    fn sides_of<const K: usize>(
        &self,
        lists: [Vec<Prim>; K],
        border: Border,
        node: &Node,
    ) -> ([[Vec<Prim>; K]; 2], [Node; 2]) {
        let Border { axis, position, .. } = border;
        let list = &lists[axis % K];
        let pivot = Pivot::before(&list[position], axis);
        let (left, right) = rayon::join(|| around(&list[..position]), || around(&list[position..]));
        let nodes = node.children([left, right], [position, list.len() - position], node.spare);
        let filter = |(i, mut list): (usize, Vec<Prim>)| {
            if i == axis % K {
                let right = list.split_off(position);
                [list, right]
            } else {
                pivot.sides(&list, position)
            }
        };
        let lists: Vec<(usize, Vec<Prim>)> = lists.into_iter().enumerate().collect();
        let mut filtered: Vec<[Vec<Prim>; 2]> = lists.into_par_iter().map(filter).collect();
        let mut side = |side: usize| std::array::from_fn(|i| std::mem::take(&mut filtered[i][side]));
        ([side(0), side(1)], nodes)
    }

    /// Builds a subtree on one thread, depth first; returns its root and its depth.
    fn subtree<const K: usize>(
        &self,
        mut lists: [&mut [Prim]; K],
        node: Node,
        scratch: &mut Scratch,
    ) -> (BvhNode, u32) {
        let count = lists[0].len();
        let split = if count > 1 {
            self.split_or_leaf(lists.each_mut().map(|list| &mut **list), &node, &mut scratch.costs)
        } else {
            None
        };
        let Some(split) = split else { return (leaf(lists[0], &node.bounds, scratch), 0) };
        let pair = scratch.nodes.len();
        scratch.nodes.extend([BvhNode::NONE; 2]);
        let children = match split {
            Split::At(border) => {
                let (left, right, nodes) = self.partition(lists, border, &node, &mut scratch.prims);
                [self.subtree(left, nodes[0], scratch), self.subtree(right, nodes[1], scratch)]
            }
            Split::Divided(mut sides) => {
                let counts = sides.lists.each_ref().map(|lists| lists[0].len());
                let nodes = node.children(sides.bounds, counts, sides.spare);
                [0, 1].map(|side| {
                    let mut lists = sides.lists[side].each_mut().map(|list| &mut list[..]).into_iter();
                    let lists = std::array::from_fn(|_| lists.next().expect("three axes, of which all or one is used"));
                    self.subtree::<K>(lists, nodes[side], scratch)
                })
            }
        };
        let [(a, a_depth), (b, b_depth)] = children;
        scratch.nodes[pair..pair + 2].copy_from_slice(&[a, b]);
        (BvhNode::around(&a, &b, pair as u32), 1 + a_depth.max(b_depth))
    }

    /// `None` where a leaf is better.
    fn split_or_leaf<const K: usize>(
        &self,
        lists: [&mut [Prim]; K],
        node: &Node,
        costs: &mut Vec<f32>,
    ) -> Option<Split> {
        let (count, CostModel { traversal, intersection }) = (lists[0].len(), self.config.cost);
        if count > self.config.max_leaf {
            return Some(self.split(lists, node, costs));
        }
        if !traversal.is_finite() || is_near_the_bottom(count, node.depth, self.config.max_depth) {
            return None;
        }
        let border = self.border(lists, node, costs);
        let area = f64::from(node.bounds.half_area(self.unit));
        let split = traversal * area + intersection * f64::from(border.cost);
        (split < intersection * area * count as f64).then_some(Split::At(border))
    }

    fn split<const K: usize>(&self, mut lists: [&mut [Prim]; K], node: &Node, costs: &mut Vec<f32>) -> Split {
        let count = lists[0].len();
        let middle = |lists: [&mut [Prim]; K]| {
            let axis = longest_axis(&node.bounds);
            if K == 1 {
                sort(&mut *lists.into_iter().next().expect("one list"), axis);
            }
            Split::At(Border { axis, position: count / 2, cost: f32::INFINITY })
        };
        if is_near_the_bottom(count, node.depth, self.config.max_depth) {
            return middle(lists);
        }
        let border = self.border(lists.each_mut().map(|list| &mut **list), node, costs);
        let useful = node.bounds.half_area(self.unit) * count as f32 * USEFUL;
        let is_useful = border.cost < useful;
        if let (Some(spatial), [x, y, z]) = (&self.spatial, &lists[..]) {
            let lists: [&[Prim]; 3] = [x, y, z];
            let (left, right) = if is_useful {
                let list = lists[border.axis];
                (around(&list[..border.position]), around(&list[border.position..]))
            } else {
                (node.bounds, node.bounds)
            };
            let cost = border.cost.min(useful);
            let divided = spatial.is_worth_trying(node.depth, count, &left, &right).then(|| {
                let plane = spatial.plane(lists[0], &node.bounds, self.axes(&node.bounds), cost, node.spare)?;
                spatial.divide(lists, plane, node.spare)
            });
            if let Some(sides) = divided.flatten() {
                return Split::Divided(Box::new(sides));
            }
        }
        if is_useful { Split::At(border) } else { middle(lists) }
    }

    /// The axes on which borders are looked for.
    fn axes(&self, bounds: &Rows) -> impl Iterator<Item = usize> + use<> {
        let only = self.config.longest_axis.then(|| longest_axis(bounds));
        (0..3).filter(move |axis| only.is_none_or(|only| only == *axis))
    }

    /// The cheapest border on these axes, of which there are any between two triangles. A single list is left sorted on
    /// its axis.
    fn border<const K: usize>(&self, lists: [&mut [Prim]; K], node: &Node, costs: &mut Vec<f32>) -> Border {
        let mut best = Border::NONE;
        if K == 1 || lists[0].len() <= SHARED {
            let mut order = 0;
            for axis in self.axes(&node.bounds) {
                if K == 1 {
                    sort(lists[0], axis);
                    order = axis;
                }
                best = cheapest(lists[axis % K], axis, self.unit, costs, best);
            }
            if K == 1 && order != best.axis {
                sort(lists[0], best.axis);
            }
            return best;
        }
        let axes: Vec<usize> = self.axes(&node.bounds).collect();
        let found: Vec<Border> = axes
            .into_par_iter()
            .map(|axis| cheapest(lists[axis % K], axis, self.unit, &mut Vec::new(), Border::NONE))
            .collect();
        found.into_iter().fold(best, Border::or)
    }

    /// Reorders the lists of a node, each into both sides of a border.
    #[allow(clippy::type_complexity)]
    fn partition<'l, const K: usize>(
        &self,
        lists: [&'l mut [Prim]; K],
        border: Border,
        node: &Node,
        scratch: &mut Vec<Prim>,
    ) -> ([&'l mut [Prim]; K], [&'l mut [Prim]; K], [Node; 2]) {
        let Border { axis, position, .. } = border;
        let list = &lists[axis % K];
        let pivot = Pivot::before(&list[position], axis);
        let bounds = [around(&list[..position]), around(&list[position..])];
        let nodes = node.children(bounds, [position, list.len() - position], node.spare);
        let mut sides = lists.into_iter().enumerate().map(|(i, list)| {
            if i != axis % K {
                pivot.partition(list, scratch);
            }
            list.split_at_mut(position)
        });
        let mut pairs: [_; K] = std::array::from_fn(|_| sides.next().expect("each list has two sides"));
        let left = pairs.each_mut().map(|pair| std::mem::take(&mut pair.0));
        (left, pairs.map(|pair| pair.1), nodes)
    }
}

/// Appends a leaf; its triangles ascend.
fn leaf(list: &mut [Prim], bounds: &Rows, scratch: &mut Scratch) -> BvhNode {
    let first = scratch.triangles.len();
    scratch.triangles.extend(list.iter().map(Prim::triangle));
    scratch.triangles[first..].sort_unstable();
    BvhNode::leaf(bounds, first as u32, list.len() as u32)
}

/// The first of the axes on which a box is longest.
fn longest_axis(bounds: &Rows) -> usize {
    let extent = (bounds.max - bounds.min).truncate();
    (0..3).rev().max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0)
}
