//! kd-tree builder: top down, greedy SAH on boxes; binned above, exact below, or exact at all sizes ([`super::sort`]).
//!
//! A triangle goes to every side that its box reaches into. A box that merely touches the plane stays on its own side,
//! and one that lies in the plane goes to the cheaper side. No plane ever lies on the border of the cell that it
//! splits, so no cell is flat unless the whole scene is.

use crate::error::{Error, Result};
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::TriangleRef;
use crate::workloads::trace::common::prims::triangle_ref;
use crate::workloads::trace::common::prims::{self, Prim};
use crate::workloads::trace::common::sah::{CostModel, half_area, unit};
use crate::workloads::trace::kdtree::bins;
use crate::workloads::trace::kdtree::events::Sorted;
use crate::workloads::trace::kdtree::exact::{self, Begin};
use crate::workloads::trace::kdtree::sort;
use crate::workloads::trace::kdtree::{KdNode, KdTree};
use glam::{BVec4A, Vec4};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Greatest depth of any tree.
pub const MAX_DEPTH: u32 = 60;

/// Most leaves and triangle references together: links have 30 bits, and a device's buffers are smaller still.
pub const MAX_LEAVES_AND_REFS: usize = 1 << 28;

/// Sides with fewer triangles than this together are built one after the other.
const TASK: usize = 2048;

/// What can be set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// How planes are found.
    pub method: Method,
    /// Bins per axis in the upper levels, 2 to 64.
    pub bins: usize,
    /// What the bins are spread over.
    pub spread: Spread,
    /// Nodes with fewer triangles are split by the exact sweep.
    pub exact_below: usize,
    /// `K_t` and `K_i`.
    pub cost: CostModel,
    /// Nodes of at most so many triangles are always leaves.
    pub small_leaf: usize,
    /// Greatest depth, at most [`MAX_DEPTH`]; `None` is `8 + 1.3 log2(triangles)`.
    pub max_depth: Option<u32>,
    /// Thinnest slice that a split may cut off, as a share of the scene's diagonal. No cell is flat with zero, either,
    /// unless the scene is.
    pub thin: f32,
}

/// How planes are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// By bins in large nodes, by the exact sweep in small ones.
    Bins,
    /// By the exact sweep at all sizes.
    Sweep(Sorting),
}

/// When the events of the exact sweep are sorted. Both give the same tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sorting {
    /// Once, in O(N log N): a node's lists are filtered into its children's.
    Once,
    /// Anew in each node, in O(N log^2 N).
    EveryNode,
}

/// What the bins of a node are spread over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spread {
    /// The node's cell.
    Cell,
    /// What the triangles' boxes take up of the cell. The borders of that are candidates as well.
    Content,
}

impl Default for Config {
    /// What explains the published trees best.
    fn default() -> Self {
        Config {
            method: Method::Bins,
            bins: 32,
            spread: Spread::Content,
            exact_below: 129,
            cost: CostModel::default(),
            small_leaf: 2,
            max_depth: Some(MAX_DEPTH),
            thin: 2.0e-6,
        }
    }
}

/// A plane that splits a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Split {
    pub axis: usize,
    pub plane: f32,
    /// Side of the triangles that lie in the plane.
    pub planar_left: bool,
    /// Triangles on the left, planar ones included where they go there.
    pub left: usize,
    /// Triangles on the right, likewise.
    pub right: usize,
    /// `A_left N_left + A_right N_right`, half areas.
    pub weighted: f64,
}

/// Rules and budget, shared by all threads.
pub(crate) struct Builder {
    pub config: Config,
    pub max_depth: u32,
    /// No slice is cut off that is thinner than this.
    pub thin: f32,
    /// So few triangles are a leaf: they cost no more than a step, or are not to be split.
    never_split: usize,
    /// Most leaves and triangle references.
    pub limit: usize,
    charged: AtomicUsize,
}

impl Builder {
    /// True if a node must be a leaf without looking for a split.
    pub fn must_stop(&self, triangles: usize, depth: u32) -> bool {
        depth >= self.max_depth || triangles <= self.never_split
    }

    /// True if a split is cheaper than testing the triangles of a cell of this area; `weighted` is the sum over both
    /// sides of area times triangles.
    pub fn pays(&self, triangles: usize, weighted: f64, area: f64) -> bool {
        let cost = &self.config.cost;
        cost.traversal * area + cost.intersection * weighted < cost.leaf(triangles as u32) * area
    }

    /// Charges leaves and triangle references to the budget.
    pub fn charge(&self, leaves_and_refs: usize) {
        self.charged.fetch_add(leaves_and_refs, Relaxed);
    }

    /// True if the tree has become too large: it will be thrown away.
    pub fn over_budget(&self) -> bool {
        self.charged.load(Relaxed) > self.limit
    }

    /// Builds the subtree of some triangles.
    fn grow(&self, prims: &[Prim], side: Side, cell: Aabb, depth: u32) -> Part {
        let Side { own, content } = side;
        let count = own.len();
        if count < self.config.exact_below {
            let prims: Vec<Prim> = own.iter().map(|&i| prims[i as usize]).collect();
            let events = [0, 1, 2].map(|axis| {
                let mut sorted = Sorted::default();
                sorted.fill((0..).zip(&prims), axis, &cell);
                sorted
            });
            let begin = Begin { prims: &prims, events: Some(events), cell, depth, unit: unit(&cell) };
            return Part::Subtree(exact::build(self, begin));
        }
        let split = if self.must_stop(count, depth) || self.over_budget() {
            None
        } else {
            bins::find(prims, &own, &cell, &self.over(&cell, content), self.config.bins, self.thin)
                .filter(|split| self.pays(count, split.weighted, half_area(&cell)))
        };
        let Some(split) = split else {
            self.charge(1 + count);
            return Part::Subtree(Subtree::leaf(prims, &own));
        };
        let (left, right) = partition(prims, &own, &split);
        drop(own);
        let (left_cell, right_cell) = halves(&cell, split.axis, split.plane);
        let a = || self.grow(prims, left, left_cell, depth + 1);
        let b = || self.grow(prims, right, right_cell, depth + 1);
        Part::Inner(split.axis, split.plane, Box::new(both(split.left + split.right > TASK, a, b)))
    }

    /// What a node's bins are spread over.
    fn over(&self, cell: &Aabb, content: Aabb) -> Aabb {
        match self.config.spread {
            Spread::Cell => *cell,
            Spread::Content => Aabb { min: content.min.max(cell.min), max: content.max.min(cell.max) },
        }
    }
}

/// The triangles of a node.
struct Side {
    /// Numbers in the list of all, ascending.
    own: Vec<u32>,
    /// The box around their boxes, which may reach out of the node's cell.
    content: Aabb,
}

/// Both sides' triangles, in their order. Every triangle is written to both, and only the sides that it belongs to
/// advance (each has room for one more) and grow: no branch to mispredict.
fn partition(prims: &[Prim], own: &[u32], split: &Split) -> (Side, Side) {
    let Split { axis, plane, planar_left, .. } = *split;
    let (mut left, mut right) = (vec![0; split.left + 1], vec![0; split.right + 1]);
    let (mut left_count, mut right_count) = (0, 0);
    let mut around = [(Vec4::INFINITY, Vec4::NEG_INFINITY); 2];
    for &i in own {
        let prim = &prims[i as usize];
        let (min, max) = (prim.min[axis], prim.max[axis]);
        let planar = (min == plane) & (max == plane);
        left[left_count] = i;
        right[right_count] = i;
        let goes = [(min < plane) | (planar & planar_left), (max > plane) | (planar & !planar_left)];
        left_count += usize::from(goes[0]);
        right_count += usize::from(goes[1]);
        for (around, goes) in around.iter_mut().zip(goes) {
            let goes = BVec4A::splat(goes);
            around.0 = around.0.min(Vec4::select(goes, prim.min, Vec4::INFINITY));
            around.1 = around.1.max(Vec4::select(goes, prim.max, Vec4::NEG_INFINITY));
        }
    }
    debug_assert_eq!((left_count, right_count), (split.left, split.right));
    left.truncate(split.left);
    right.truncate(split.right);
    let [of_left, of_right] = around.map(|(min, max)| Aabb { min: min.truncate(), max: max.truncate() });
    (Side { own: left, content: of_left }, Side { own: right, content: of_right })
}

/// Does two things, at the same time if they are large.
pub(crate) fn both<A: Send, B: Send>(
    large: bool,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    if large { rayon::join(a, b) } else { (a(), b()) }
}

/// The cells on both sides of a plane.
pub(crate) fn halves(cell: &Aabb, axis: usize, plane: f32) -> (Aabb, Aabb) {
    let (mut left, mut right) = (*cell, *cell);
    left.max[axis] = plane;
    right.min[axis] = plane;
    (left, right)
}

/// A finished subtree in depth-first order: links count from its first node, leaves from its first triangle.
#[derive(Default)]
pub(crate) struct Subtree {
    pub nodes: Vec<KdNode>,
    /// Triangles, leaf by leaf.
    pub triangles: Vec<u32>,
    /// Levels of inner nodes.
    pub depth: u32,
}

impl Subtree {
    pub fn leaf(prims: &[Prim], own: &[u32]) -> Subtree {
        let triangles: Vec<u32> = own.iter().map(|&i| prims[i as usize].triangle()).collect();
        Subtree { nodes: vec![KdNode::leaf(0, triangles.len() as u32)], triangles, depth: 0 }
    }
}

/// A part of a tree that is not put together yet.
pub(crate) enum Part {
    Subtree(Subtree),
    Inner(usize, f32, Box<(Part, Part)>),
}

impl Part {
    /// Numbers of nodes and of triangle references, and depth.
    fn size(&self) -> (usize, usize, u32) {
        match self {
            Part::Subtree(s) => (s.nodes.len(), s.triangles.len(), s.depth),
            Part::Inner(_, _, parts) => {
                let (a, b) = (parts.0.size(), parts.1.size());
                (1 + a.0 + b.0, a.1 + b.1, 1 + a.2.max(b.2))
            }
        }
    }

    /// Writes this part, whose first node is number `node` and whose first triangle reference is number `first` of the
    /// tree.
    fn place(self, scene: &Scene, nodes: &mut [KdNode], triangle_refs: &mut [TriangleRef], node: u32, first: u32) {
        match self {
            Part::Subtree(s) => {
                for (out, own) in nodes.iter_mut().zip(&s.nodes) {
                    *out = own.moved(node, first);
                }
                for (out, &triangle) in triangle_refs.iter_mut().zip(&s.triangles) {
                    *out = triangle_ref(scene, triangle);
                }
            }
            Part::Inner(axis, plane, parts) => {
                let (left, right) = *parts;
                let (left_nodes, left_refs, _) = left.size();
                let right_node = node + 1 + left_nodes as u32;
                nodes[0] = KdNode::inner(axis as u32, plane, right_node);
                let (a, b) = nodes[1..].split_at_mut(left_nodes);
                let (c, d) = triangle_refs.split_at_mut(left_refs);
                rayon::join(
                    || left.place(scene, a, c, node + 1, first),
                    || right.place(scene, b, d, right_node, first + left_refs as u32),
                );
            }
        }
    }
}

impl KdNode {
    fn moved(self, nodes: u32, triangle_refs: u32) -> KdNode {
        if self.is_leaf() {
            KdNode::leaf(self.first() + triangle_refs, self.count())
        } else {
            KdNode { link: self.link + (nodes << 2), ..self }
        }
    }
}

/// Most leaves and triangle references of the tree over so many triangles. The published trees have at most ten per
/// triangle. Where long triangles cross in a plane, splits that pay in the model double the triangle references from
/// level to level.
fn limit(triangles: usize) -> usize {
    (256 * triangles).min((1 << 26).max(32 * triangles)).clamp(1 << 16, MAX_LEAVES_AND_REFS)
}

/// The depth to try after one that made the tree too large.
fn shallower(depth: u32, triangles: usize) -> u32 {
    (depth * 3 / 4).min(automatic(triangles))
}

/// The depth that is given in the literature: `8 + 1.3 log2(triangles)`.
fn automatic(triangles: usize) -> u32 {
    (8.0 + 1.3 * (triangles.max(1) as f64).log2()).round() as u32
}

/// A kd-tree, and the depth that it was kept to.
pub struct KdBuilt {
    /// The tree.
    pub tree: KdTree,
    /// The greatest depth that it could have had.
    pub max_depth: u32,
    /// True if that is less than was asked for, since a deeper tree would have been too large.
    pub cut: bool,
}

/// Builds a kd-tree over all triangles that can be hit, on the threads of the current rayon pool. Where it would take
/// excessive memory it is built again, less deep.
///
/// # Errors
/// [`Error::Input`] if there are more triangles than a tree can hold.
pub fn build(scene: &Scene, config: &Config) -> Result<KdBuilt> {
    let (prims, bounds) = prims::prims(scene)?;
    let never_split = ((config.cost.traversal / config.cost.intersection) as usize).max(config.small_leaf);
    let asked = config.max_depth.unwrap_or(automatic(prims.len())).min(MAX_DEPTH);
    let mut builder = Builder {
        config: *config,
        max_depth: asked,
        thin: bounds.diagonal() * config.thin,
        never_split,
        limit: limit(prims.len()),
        charged: AtomicUsize::new(0),
    };
    let part = loop {
        let part = match config.method {
            Method::Sweep(sorting) => sort::grow(&builder, &prims, sorting, bounds),
            Method::Bins => {
                let all = Side { own: (0..prims.len() as u32).collect(), content: bounds };
                builder.grow(&prims, all, bounds, 0)
            }
        };
        if !builder.over_budget() {
            break part;
        }
        if builder.max_depth == 0 {
            return Err(Error::too_large(
                format!("kdtree over {}", scene.name),
                format!("takes more than {} leaves and triangle references", builder.limit),
                "use a smaller scene",
            ));
        }
        drop(part);
        builder.max_depth = shallower(builder.max_depth, prims.len());
        builder.charged = AtomicUsize::new(0);
    };
    let (node_count, ref_count, depth) = part.size();
    let mut nodes = vec![KdNode::leaf(0, 0); node_count];
    let mut triangle_refs = vec![TriangleRef { vertices: [0; 3], triangle: 0 }; ref_count];
    part.place(scene, &mut nodes, &mut triangle_refs, 0, 0);
    let tree = KdTree { bounds, nodes, triangle_refs, depth };
    Ok(KdBuilt { tree, max_depth: builder.max_depth, cut: builder.max_depth < asked })
}
