//! A packet of primary rays on a tree of up to eight children a node. Twin of `kernels/trace/subgroup/packet.wgsl`,
//! `children.wgsl` and `leaf.wgsl`: what is a lane there is an index here.
//!
//! A cluster of eight lanes goes through the tree with one stack. All rays of a packet are compared with a child at
//! once, by the interval of their inverse directions; only rays in rows that met the node's box are then compared with
//! what is left. A ray counts what its row is made to test: nodes and leaves that the row wants, and the children that
//! are left; every ray of a packet counts what is taken from its stack.

use crate::math::{MISS, Ray, T_MAX, ray_box};
use crate::workloads::trace::bvh::stack::{EMPTY, LEAF, StackSearch, leaf_triangle_refs, overlaps};
use crate::workloads::trace::bvh::widened::Widening;
use crate::workloads::trace::count::Count;
use crate::workloads::trace::cpu::TwinInput;
use crate::workloads::trace::traverse::{Best, GROUP, Lanes, Traverse, Triangles};
use crate::workloads::trace::wide::Wide;
use crate::workloads::trace::wide::stack::Sorted;
use glam::Vec3A;

/// Lanes of a cluster.
const CLUSTER: usize = 8;

/// The key of no child.
const NONE: u32 = u32::MAX;

/// The bits of a key that are a distance; below are the rows that want the child, and its number.
const DISTANCE_BITS: u32 = 0xffff_f800;

/// Primary rays in packets, others one by one.
pub struct Packets<'a> {
    tree: &'a Wide,
    triangles: Triangles<'a>,
    widening: Widening,
    /// Rays of a packet.
    rays: usize,
    one_by_one: StackSearch<'a, Sorted<'a>>,
}

/// A node's children that rows want, and what they lead to.
type Children = [(u32, u32); CLUSTER];

/// The rays of a packet, and what they have hit.
struct Packet<'r, C> {
    rays: &'r [Ray],
    /// For box tests.
    wide: Vec<Ray>,
    nearest: Vec<Best>,
    alive: Vec<bool>,
    counters: &'r mut [C],
    inverse: (Vec3A, Vec3A),
    /// The largest `origin_min`, and the smallest `origin_max`.
    origin: (Vec3A, Vec3A),
    /// The largest distance of a nearest hit.
    farthest: f32,
}

impl<'a> Packets<'a> {
    /// A traversal of a built tree.
    pub fn new(input: &TwinInput<'a>, tree: &'a Wide) -> Packets<'a> {
        let (min, max, _) = tree.root();
        Packets {
            tree,
            triangles: input.triangles(),
            widening: Widening::around(input, (min, max)),
            rays: CLUSTER * input.method.parameters.word("RAYS") as usize,
            one_by_one: StackSearch::new(input, Sorted(tree)),
        }
    }

    /// The interval of distances in a box for all directions in the packet's interval.
    fn packet_box<C>(packet: &Packet<C>, min: Vec3A, max: Vec3A) -> (f32, f32) {
        let (lo, hi) = packet.inverse;
        let (from_lo, from_hi) = (min - packet.origin.0, max - packet.origin.1);
        let products = [from_lo * lo, from_lo * hi, from_hi * lo, from_hi * hi];
        let [a, b, c, d] = products;
        (a.min(b).min(c.min(d)).max_element(), a.max(b).max(c.max(d)).min_element())
    }

    fn test_children<C: Count>(&self, node: u32, rows: u32, packet: &mut Packet<C>) -> Children {
        let mut children = [(NONE, EMPTY); CLUSTER];
        let slots = self.tree.node(node).iter().enumerate().filter(|(_, slot)| !slot.is_empty());
        for (number, slot) in slots {
            let (min, max) = self.tree.planes.corners(slot.min, slot.max);
            let interval = Self::packet_box(packet, min, max);
            if !overlaps(interval, packet.farthest) {
                continue;
            }
            let mut wanted = 0;
            for i in packet.of_rows(rows) {
                packet.counters[i].box_test();
                if overlaps(ray_box(&packet.wide[i], min, max), packet.nearest[i].t) {
                    wanted |= 1 << (i / CLUSTER);
                }
            }
            if wanted != 0 {
                let distance = if interval.0 > 0.0 { interval.0 } else { 0.0 };
                let key = distance.to_bits() & DISTANCE_BITS | wanted << 3 | number as u32;
                children[number] = (key, slot.reference);
            }
        }
        children
    }

    fn test_leaf<C: Count>(&self, reference: u32, rows: u32, packet: &mut Packet<C>) {
        let (first, count) = leaf_triangle_refs(reference);
        for i in packet.of_rows(rows) {
            let (ray, counters) = (&packet.rays[i], &mut packet.counters[i]);
            counters.leaf();
            self.triangles.test::<false, C>(ray, first, count, &mut packet.nearest[i], counters);
        }
        let alive = packet.nearest.iter().zip(&packet.alive).filter(|(_, alive)| **alive);
        packet.farthest = alive.fold(-1.0, |t, (best, _)| t.max(best.t));
    }

    /// Finds the nearest hits, nearer children first.
    fn trace<C: Count>(&self, packet: &mut Packet<C>) {
        let all_rows = packet.all_rows();
        let mut stack: Vec<Children> = Vec::new();
        let (mut node, mut rows) = (0, all_rows);
        loop {
            for i in packet.of_rows(rows) {
                packet.counters[i].inner();
            }
            let mut children = self.test_children(node, rows, packet);
            // Through leaves, to the next node
            loop {
                let least = children.iter().map(|child| child.0).min().unwrap_or(NONE);
                if least == NONE || f32::from_bits(least & DISTANCE_BITS) > packet.farthest {
                    let Some(popped) = stack.pop() else { return };
                    for i in packet.of_rows(all_rows) {
                        packet.counters[i].pop();
                    }
                    children = popped;
                    continue;
                }
                rows = least >> 3 & 255;
                let child = &mut children[least as usize & 7];
                let reference = child.1;
                child.0 = NONE;
                if reference & LEAF == 0 {
                    if children.iter().any(|child| child.0 != NONE) {
                        stack.push(children);
                    }
                    node = reference;
                    break;
                }
                self.test_leaf(reference, rows, packet);
            }
        }
    }
}

impl<C> Packet<'_, C> {
    fn all_rows(&self) -> u32 {
        (0..self.rays.len()).filter(|&i| self.alive[i]).fold(0, |rows, i| rows | 1 << (i / CLUSTER))
    }

    /// The rays of these rows that are in the image.
    fn of_rows(&self, rows: u32) -> Vec<usize> {
        (0..self.rays.len()).filter(|&i| self.alive[i] && rows >> (i / CLUSTER) & 1 == 1).collect()
    }
}

impl Traverse for Packets<'_> {
    fn traverse<const ANY: bool, C: Count>(
        &self,
        rays: &Lanes<Ray>,
        limit: f32,
        alive: u64,
        counters: &mut Lanes<C>,
    ) -> Lanes<u32> {
        Traverse::traverse::<ANY, C>(&self.one_by_one, rays, limit, alive, counters)
    }

    fn primary_hits<C: Count>(&self, rays: &Lanes<Ray>, alive: u64, counters: &mut Lanes<C>) -> Lanes<u32> {
        let mut found = [MISS; GROUP];
        for first in (0..GROUP).step_by(self.rays).filter(|first| alive >> first << (GROUP - self.rays) != 0) {
            let rays = &rays[first..][..self.rays];
            let wide: Vec<Ray> = rays.iter().map(|ray| self.widening.widened(ray)).collect();
            let least = |of: fn(&Ray) -> Vec3A| wide.iter().map(of).reduce(Vec3A::min).unwrap_or_default();
            let most = |of: fn(&Ray) -> Vec3A| wide.iter().map(of).reduce(Vec3A::max).unwrap_or_default();
            let mut packet = Packet {
                rays,
                inverse: (least(|ray| ray.inv_direction), most(|ray| ray.inv_direction)),
                origin: (most(|ray| ray.origin_min), least(|ray| ray.origin_max)),
                wide: wide.clone(),
                nearest: vec![Best::before(T_MAX); self.rays],
                alive: (first..first + self.rays).map(|lane| alive >> lane & 1 == 1).collect(),
                counters: &mut counters[first..][..self.rays],
                farthest: T_MAX,
            };
            self.trace(&mut packet);
            for (found, best) in found[first..].iter_mut().zip(&packet.nearest) {
                *found = best.triangle_ref;
            }
        }
        found
    }
}
