//! Builder of bounding interval hierarchies: halves boxes of a grid over the scene, each on its longest axis.
//!
//! C. Wächter and A. Keller: Instant Ray Tracing: The Bounding Interval Hierarchy, 2006. Triangles go to the side on
//! which the centre of their box lies; a box with all centres on one side is halved again without a node. The planes of
//! a node are the largest coordinate of its lower and the smallest of its upper child. Ours: where centres cannot be
//! separated, and near the greatest depth, a node's triangles are halved.

use crate::error::Result;
use crate::scene::Scene;
use crate::workloads::trace::bih::{Bih, BihNode, MAX_DEPTH};
use crate::workloads::trace::common::part::{Below, Part, PartNode};
use crate::workloads::trace::common::prims::{self, CHUNK, Prim};
use glam::{DVec3, Vec4};
use rayon::prelude::*;

/// What can be set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// No leaf has more triangles than this, at least 1.
    pub max_leaf: usize,
}

impl Default for Config {
    /// As many as the leaves of the trees that it is compared with.
    fn default() -> Self {
        Config { max_leaf: 3 }
    }
}

/// Subtrees of at most this many triangles are built by one thread into one vector. A constant, so that the tree does
/// not depend on the number of threads.
const TASK: usize = 1024;

/// Builds a hierarchy over all triangles that can be hit, on the threads of the current rayon pool.
///
/// # Errors
/// [`crate::Error::Refused`] if there are more triangles than a structure can hold.
pub fn build(scene: &Scene, config: &Config) -> Result<Bih> {
    let (mut prims, bounds) = prims::prims(scene)?;
    if prims.is_empty() {
        return Ok(Bih { bounds, nodes: vec![BihNode::NONE; 2], triangle_refs: Vec::new(), depth: 0 });
    }
    let grid = GridBox { min: bounds.min.as_dvec3(), max: bounds.max.as_dvec3() };
    let part = Builder { config: *config }.grow(&mut prims, Node { first: 0, grid, depth: 0 });
    let depth = part.depth;
    let (nodes, _) = part.into_nodes();
    let triangle_ref = |prim: &Prim| prims::triangle_ref(scene, prim.triangle());
    let triangle_refs = prims.par_iter().with_min_len(CHUNK).map(triangle_ref).collect();
    Ok(Bih { bounds, nodes, triangle_refs, depth })
}

struct Builder {
    config: Config,
}

/// What is known of a node before it is built.
#[derive(Clone, Copy)]
struct Node {
    /// First triangle reference.
    first: u32,
    grid: GridBox,
    depth: u32,
}

/// A box that was made by halving the scene's, in f64, so that it can be halved as often as it takes.
#[derive(Clone, Copy)]
struct GridBox {
    min: DVec3,
    max: DVec3,
}

/// A plane between centres: twice the coordinate, as centres are kept.
struct Middle {
    axis: usize,
    twice: f64,
}

/// Where a node's triangles are divided.
struct Sides {
    axis: usize,
    /// How many are in the lower child.
    position: usize,
    children: [Node; 2],
}

#[derive(Default)]
struct Scratch {
    prims: Vec<Prim>,
    nodes: Vec<BihNode>,
}

impl Builder {
    /// Builds a subtree; sides of large nodes in parallel.
    fn grow(&self, prims: &mut [Prim], node: Node) -> Part<BihNode> {
        let mut scratch = Scratch::default();
        if prims.len() <= TASK.max(self.config.max_leaf) {
            let (root, depth) = self.subtree(prims, node, &mut scratch);
            return Part { root, below: Below::Nodes(scratch.nodes, Vec::new()), depth };
        }
        let Sides { axis, position, children } = divide(prims, node, &mut scratch.prims);
        drop(scratch);
        let (low, high) = prims.split_at_mut(position);
        let root = inner(axis, low, high, 0);
        let (a, b) = rayon::join(|| self.grow(low, children[0]), || self.grow(high, children[1]));
        Part::of(root, [a, b])
    }

    /// Builds a subtree on one thread, depth first; returns its root and its depth.
    fn subtree(&self, prims: &mut [Prim], node: Node, scratch: &mut Scratch) -> (BihNode, u32) {
        if prims.len() <= self.config.max_leaf {
            return (BihNode::leaf(node.first, prims.len() as u32), 0);
        }
        let Sides { axis, position, children } = divide(prims, node, &mut scratch.prims);
        let pair = scratch.nodes.len();
        scratch.nodes.extend([BihNode::NONE; 2]);
        let (low, high) = prims.split_at_mut(position);
        let root = inner(axis, low, high, pair as u32);
        let (a, a_depth) = self.subtree(low, children[0], scratch);
        let (b, b_depth) = self.subtree(high, children[1], scratch);
        scratch.nodes[pair..pair + 2].copy_from_slice(&[a, b]);
        (root, 1 + a_depth.max(b_depth))
    }
}

fn inner(axis: usize, low: &[Prim], high: &[Prim], child: u32) -> BihNode {
    let low_end = low.iter().fold(f32::NEG_INFINITY, |end, prim| end.max(prim.max[axis]));
    let high_begin = high.iter().fold(f32::INFINITY, |begin, prim| begin.min(prim.min[axis]));
    BihNode::inner(axis, child, low_end, high_begin)
}

/// Reorders a node's triangles into two sides, neither of them empty.
fn divide(prims: &mut [Prim], node: Node, scratch: &mut Vec<Prim>) -> Sides {
    let mut grid = node.grid;
    let halvings = usize::BITS - prims.len().leading_zeros();
    let middle = if node.depth + halvings >= MAX_DEPTH { None } else { grid.middle(prims) };
    let (mut low, mut high) = (grid, grid);
    let (axis, position) = match middle {
        Some(Middle { axis, twice }) => {
            low.max[axis] = 0.5 * twice;
            high.min[axis] = 0.5 * twice;
            (axis, partition(prims, scratch, |prim| f64::from(prim.min[axis] + prim.max[axis]) <= twice))
        }
        None => (grid.longest_axis(), prims.len() / 2),
    };
    let child = |first: usize, grid| Node { first: node.first + first as u32, grid, depth: node.depth + 1 };
    Sides { axis, position, children: [child(0, low), child(position, high)] }
}

impl GridBox {
    fn longest_axis(&self) -> usize {
        let extent = self.max - self.min;
        (0..3).rev().max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0)
    }

    /// Halves the box until there are centres on both sides; `None` where that never happens.
    fn middle(&mut self, prims: &[Prim]) -> Option<Middle> {
        let (mut min, mut max) = (Vec4::INFINITY, Vec4::NEG_INFINITY);
        for prim in prims {
            let centre = prim.min + prim.max;
            (min, max) = (min.min(centre), max.max(centre));
        }
        if min.truncate() == max.truncate() {
            return None;
        }
        loop {
            let axis = self.longest_axis();
            let middle = 0.5 * (self.min[axis] + self.max[axis]);
            if !(self.min[axis] < middle && middle < self.max[axis]) {
                return None;
            }
            let twice = 2.0 * middle;
            if f64::from(max[axis]) <= twice {
                self.max[axis] = middle;
            } else if f64::from(min[axis]) > twice {
                self.min[axis] = middle;
            } else {
                return Some(Middle { axis, twice });
            }
        }
    }
}

/// Moves what is low to the front; both sides keep their order. Returns how many are low.
fn partition(prims: &mut [Prim], scratch: &mut Vec<Prim>, is_low: impl Fn(&Prim) -> bool) -> usize {
    scratch.resize(scratch.len().max(prims.len()), Prim::NONE);
    let (mut low, mut high) = (0, 0);
    for i in 0..prims.len() {
        let prim = prims[i];
        let flag = usize::from(is_low(&prim));
        prims[low] = prim;
        scratch[high] = prim;
        low += flag;
        high += 1 - flag;
    }
    prims[low..].copy_from_slice(&scratch[..high]);
    low
}
