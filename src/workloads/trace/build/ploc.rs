//! Parallel locally-ordered clustering, without reinsertion: triangles along the Morton curve are clusters, and in each
//! pass those merge that are each other's best partner within `radius` places. Twin of
//! `kernels/trace/build/{clusters,search,choose,merge,descend}.wgsl`.
//!
//! D. Meister and J. Bittner: Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction, 2018.
//! Ours: of equally good partners the one whose place differs in lower bits is taken, so that equal boxes merge in
//! pairs; and after a pass in which less than a 64th of the clusters merged (from pass 64 on, an eighth), as where
//! boxes lie inside each other, all merge in pairs. So there are never more than some 200 passes, and no tree is
//! deeper.

use super::Input;
use super::codes::Sorted;
use crate::error::Result;
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::bvh::{Bvh, BvhNode};
use crate::workloads::trace::common::prims::{self, CHUNK, Prim};
use crate::workloads::trace::common::sah::unit;
use glam::Vec3;
use rayon::prelude::*;

/// After a pass in which fewer than one in so many clusters merged, all of the next one merge: in the first [`EARLY`]
/// passes, and in those behind them.
const FEW: [u32; 2] = [64, 8];

/// Passes in which few merges will do.
const EARLY: usize = 64;

/// What can be set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// How many places away on the curve partners are looked for, at least 1.
    pub radius: u32,
    /// Most triangles of a leaf, at least 1.
    pub max_leaf: u32,
}

/// True if all clusters merge in the pass after one in which `merges` of `clusters` pairs merged, the `passes`-th one.
pub(super) fn is_forced(merges: u32, clusters: u32, passes: usize) -> bool {
    u64::from(merges) * u64::from(FEW[usize::from(passes >= EARLY)]) < u64::from(clusters)
}

/// An inner node while the tree grows. Nodes are numbered: first the sorted triangles, then inner nodes as they are
/// made.
#[derive(Clone, Copy)]
struct Inner {
    children: [u32; 2],
    bounds: Aabb,
    triangles: u32,
}

/// A cluster: its box in units of about the scene's extent, and its node.
#[derive(Clone, Copy)]
struct Cluster {
    min: Vec3,
    max: Vec3,
    node: u32,
}

/// A number that no device takes for another: what is denormal is zero.
fn flushed(x: Vec3) -> Vec3 {
    Vec3::select(x.abs().cmpge(Vec3::splat(f32::MIN_POSITIVE)), x, Vec3::ZERO)
}

impl Cluster {
    fn of(bounds: &Aabb, unit: f32, node: u32) -> Cluster {
        Cluster { min: flushed(flushed(bounds.min) * unit), max: flushed(flushed(bounds.max) * unit), node }
    }

    /// Half the surface of a box around both.
    fn cost(&self, other: &Cluster) -> f32 {
        let e = flushed(self.max.max(other.max) - self.min.min(other.min));
        let sides = flushed(e * Vec3::new(e.y, e.z, e.x));
        sides.x + sides.y + sides.z
    }
}

/// Builds a BVH over all triangles that can be hit.
///
/// # Errors
/// [`crate::Error::Refused`] for more triangles than a BVH can hold.
pub fn build(scene: &Scene, config: &Config) -> Result<Bvh> {
    let (prims, bounds) = match Input::of(scene, config.max_leaf)? {
        Input::Leaf(bvh) => return Ok(bvh),
        Input::Prims(prims, bounds) => (prims, bounds),
    };
    let Sorted { order, .. } = Sorted::of(&prims, &bounds);
    let unit = unit(&bounds);
    let cluster = |(i, &prim): (usize, &u32)| Cluster::of(&prims[prim as usize].aabb(), unit, i as u32);
    let mut clusters: Vec<Cluster> = order.par_iter().with_min_len(CHUNK).enumerate().map(cluster).collect();
    let mut growing = Growing { prims: &prims, order: &order, inner: Vec::with_capacity(order.len()) };
    let (mut forced, mut passes) = (false, 0);
    while clusters.len() > 1 {
        passes += 1;
        let before = clusters.len() as u32;
        let partners = partners(&clusters, config.radius, forced);
        clusters = growing.merge(&clusters, &partners);
        forced = is_forced(before - clusters.len() as u32, before, passes);
    }
    let nodes = vec![BvhNode::NONE; 2 + 2 * growing.inner.iter().filter(|n| n.triangles > config.max_leaf).count()];
    let refs = Vec::with_capacity(order.len());
    let mut emission = Emission { pairs: growing.pairs(config.max_leaf), growing, nodes, sorted: refs, depth: 0 };
    let root = emission.growing.nodes() - 1;
    emission.nodes[0] = emission.node(root, config.max_leaf, 0);
    let Emission { nodes, sorted, depth, .. } = emission;
    Ok(Bvh { bounds, nodes, triangle_refs: prims::triangle_refs(scene, &sorted), depth, spatial: None })
}

/// The place of each cluster's best partner. With `forced`, that of its neighbour in a pair, or its own.
fn partners(clusters: &[Cluster], radius: u32, forced: bool) -> Vec<u32> {
    let count = clusters.len() as u32;
    let best = |i: u32| {
        if forced {
            return if i ^ 1 < count { i ^ 1 } else { i };
        }
        let own = &clusters[i as usize];
        let (mut best, mut least) = (i, f32::INFINITY);
        for j in i.saturating_sub(radius)..(i + radius + 1).min(count) {
            if j != i {
                let cost = own.cost(&clusters[j as usize]);
                if cost < least || (cost == least && i ^ j < i ^ best) {
                    (best, least) = (j, cost);
                }
            }
        }
        best
    };
    (0..count).into_par_iter().with_min_len(64).map(best).collect()
}

/// A tree that grows from its leaves.
struct Growing<'a> {
    prims: &'a [Prim],
    order: &'a [u32],
    inner: Vec<Inner>,
}

impl Growing<'_> {
    /// Nodes until now.
    fn nodes(&self) -> u32 {
        (self.order.len() + self.inner.len()) as u32
    }

    fn prim(&self, leaf: u32) -> Prim {
        self.prims[self.order[leaf as usize] as usize]
    }

    /// The inner node of a number; `None` for a triangle.
    fn inner(&self, node: u32) -> Option<&Inner> {
        self.inner.get((node as usize).checked_sub(self.order.len())?)
    }

    fn bounds(&self, node: u32) -> Aabb {
        self.inner(node).map_or_else(|| self.prim(node).aabb(), |inner| inner.bounds)
    }

    fn triangles(&self, node: u32) -> u32 {
        self.inner(node).map_or(1, |inner| inner.triangles)
    }

    /// The clusters after those that are each other's partners have merged, at the place of the lower one.
    fn merge(&mut self, clusters: &[Cluster], partners: &[u32]) -> Vec<Cluster> {
        let mut merged = Vec::with_capacity(clusters.len());
        for (i, (cluster, &partner)) in (0..).zip(clusters.iter().zip(partners)) {
            let is_mutual = partner != i && partners[partner as usize] == i;
            if !is_mutual {
                merged.push(*cluster);
            } else if i < partner {
                let other = &clusters[partner as usize];
                let children = [cluster.node, other.node];
                let [a, b] = children;
                let (min, max) = (cluster.min.min(other.min), cluster.max.max(other.max));
                merged.push(Cluster { min, max, node: self.nodes() });
                let bounds = self.bounds(a).union(self.bounds(b));
                self.inner.push(Inner { children, bounds, triangles: self.triangles(a) + self.triangles(b) });
            }
        }
        merged
    }

    /// For each inner node the pair of its children, the last node's first; those within leaves have none of their own.
    fn pairs(&self, max_leaf: u32) -> Vec<u32> {
        let mut next = 2;
        let pair = |inner: &Inner| {
            let pair = next;
            next += 2 * u32::from(inner.triangles > max_leaf);
            pair
        };
        let mut pairs: Vec<u32> = self.inner.iter().rev().map(pair).collect();
        pairs.reverse();
        pairs
    }
}

struct Emission<'a> {
    growing: Growing<'a>,
    pairs: Vec<u32>,
    nodes: Vec<BvhNode>,
    /// Leaf by leaf.
    sorted: Vec<Prim>,
    depth: u32,
}

impl Emission<'_> {
    /// A node and all below it.
    fn node(&mut self, node: u32, max_leaf: u32, depth: u32) -> BvhNode {
        let (bounds, triangles) = (self.growing.bounds(node), self.growing.triangles(node));
        let inner = self.growing.inner(node).filter(|inner| inner.triangles > max_leaf).copied();
        let Some(inner) = inner else {
            self.depth = self.depth.max(depth);
            let first = self.sorted.len() as u32;
            self.leaf(node);
            return BvhNode { min: bounds.min.into(), first, max: bounds.max.into(), count: triangles };
        };
        let pair = self.pairs[node as usize - self.growing.order.len()];
        for (side, child) in (0..).zip(inner.children) {
            self.nodes[pair as usize + side] = self.node(child, max_leaf, depth + 1);
        }
        BvhNode { min: bounds.min.into(), first: pair, max: bounds.max.into(), count: 0 }
    }

    /// The triangles below a node, from left to right.
    fn leaf(&mut self, node: u32) {
        match self.growing.inner(node).copied() {
            Some(inner) => inner.children.into_iter().for_each(|child| self.leaf(child)),
            None => self.sorted.push(self.growing.prim(node)),
        }
    }
}
