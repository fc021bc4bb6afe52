//! kd-tree without a full stack: restart (Foley and Sugerman 2005), pushdown and short stack (Horn et al. 2007). Twin of
//! `kernels/traverse/kdtree.wgsl`.

use super::{Best, TraverseAlone, Triangles};
use crate::accel::kdtree::{KdNode, KdTree as Tree};
use crate::accel::method::KdSearch;
use crate::cpu::count::Count;
use crate::math::{MISS, Ray, T_MAX, ray_box};

/// Entries that the twin of the thesis's kernel has room for.
pub const SMALL: usize = KdSearch::THESIS.stack as usize;

/// See the module. Has room for `MOST` entries of a short stack: clearing a larger one would cost every ray.
pub struct KdTree<'a, const MOST: usize> {
    /// Records and vertices.
    pub triangles: Triangles<'a>,
    /// The tree.
    pub tree: &'a Tree,
    /// What happens after a leaf.
    pub search: KdSearch,
}

#[derive(Clone, Copy, Default)]
struct Entry {
    node: u32,
    t_min: f32,
    t_max: f32,
}

struct Descent<const MOST: usize> {
    node: u32,
    t_min: f32,
    t_max: f32,
    /// Where the ray leaves the tree, or its limit.
    t_end: f32,
    /// Where the last restart set out, -1 before the first one.
    t_restart: f32,
    restart_node: u32,
    /// The ray has not branched yet: the restart node follows.
    pushdown: bool,
    /// Entries of the ring.
    ring: usize,
    /// Entries ever pushed less those popped; modulo `ring` it is a place in it.
    top: usize,
    /// Entries that are still in the ring.
    held: usize,
    stack: [Entry; MOST],
}

impl<const MOST: usize> Descent<MOST> {
    /// Go one inner node down.
    #[inline]
    fn descend(&mut self, ray: &Ray, node: KdNode) {
        let axis = node.axis();
        let inv = ray.inv_direction[axis];
        let t_split = (node.split() - ray.origin[axis]) * inv;
        // Ordered along the ray. A plane behind the origin has t_split < 0 <= t_min: only the far side is left, which
        // is the side of the origin, as in the thesis. A cell so thin that its ends round to one distance is visited
        // all the same, as a triangle may lie in it alone; only a restart passes everything at its own distance, or it
        // would find the leaf it came from for ever.
        let (left, right) = (self.node + 1, node.right());
        let (near, far) = if inv < 0.0 { (right, left) } else { (left, right) };
        if t_split > self.t_max {
            self.node = near;
        } else if t_split < self.t_min || t_split <= self.t_restart {
            self.node = far;
        } else {
            if self.ring > 0 {
                self.stack[self.top % self.ring] = Entry { node: far, t_min: t_split, t_max: self.t_max };
                self.top += 1;
                self.held = (self.held + 1).min(self.ring);
            }
            self.node = near;
            self.t_max = t_split;
            self.pushdown = false;
        }
        if self.pushdown {
            self.restart_node = self.node;
        }
    }

    /// Leave a leaf: pop, or restart behind it. False at the end of the ray.
    #[inline]
    fn leave_leaf<C: Count>(&mut self, count: &mut C) -> bool {
        if self.held > 0 {
            count.pop();
            self.top -= 1;
            self.held -= 1;
            let entry = self.stack[self.top % self.ring];
            (self.node, self.t_min, self.t_max) = (entry.node, entry.t_min, entry.t_max);
            return true;
        }
        if self.t_max >= self.t_end {
            return false;
        }
        count.restart();
        self.t_min = self.t_max;
        self.t_restart = self.t_max;
        self.t_max = self.t_end;
        self.node = self.restart_node;
        true
    }
}

impl<const MOST: usize> KdTree<'_, MOST> {
    #[inline]
    fn start_descent(&self, ray: &Ray, limit: f32) -> Option<Descent<MOST>> {
        let (near, far) = ray_box(ray, self.tree.bounds.min.into(), self.tree.bounds.max.into());
        let t_min = near.max(0.0);
        let t_end = far.min(limit);
        (near <= far && t_min <= t_end).then_some(Descent {
            node: 0,
            t_min,
            t_max: t_end,
            t_end,
            t_restart: -1.0,
            restart_node: 0,
            pushdown: self.search.pushdown,
            ring: (self.search.stack as usize).min(MOST),
            top: 0,
            held: 0,
            stack: [Entry::default(); MOST],
        })
    }
}

impl<const MOST: usize> TraverseAlone for KdTree<'_, MOST> {
    fn nearest_hit<C: Count>(&self, ray: &Ray, count: &mut C) -> u32 {
        let mut best = Best::NONE;
        let Some(mut d) = self.start_descent(ray, T_MAX) else {
            return MISS;
        };
        loop {
            let node = self.tree.nodes[d.node as usize];
            if node.is_leaf() {
                count.leaf();
                self.triangles.test_records(ray, node.first(), node.count(), &mut best, count);
                // Exactly at the leaf's border the next leaf may hold a triangle at the same distance with a lower index
                if best.t < d.t_max || !d.leave_leaf(count) {
                    return best.record;
                }
            } else {
                count.inner();
                d.descend(ray, node);
            }
        }
    }

    fn any_hit<C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> bool {
        let Some(mut d) = self.start_descent(ray, limit) else {
            return false;
        };
        loop {
            let node = self.tree.nodes[d.node as usize];
            if node.is_leaf() {
                count.leaf();
                if self.triangles.any_record_blocks(ray, node.first(), node.count(), limit, count) {
                    return true;
                }
                if !d.leave_leaf(count) {
                    return false;
                }
            } else {
                count.inner();
                d.descend(ray, node);
            }
        }
    }
}
