//! kd-tree without a full stack: restart (Foley and Sugerman 2005), pushdown and short stack (Horn et al. 2007). Twin of
//! `kernels/trace/kdtree/search.wgsl`.
//!
//! A restart resumes by the path taken, not by the distance reached: from afar, many cells have ends that round to the
//! same distance, and none of them may be skipped or visited endlessly.

use crate::math::{MISS, Ray, T_MAX, ray_box};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::kdtree::{KdNode, KdTree as Tree};
use crate::workloads::trace::method::KdSearch;
use crate::workloads::trace::traverse::{Best, TraverseIndependent, Triangles};

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
    /// Where the ray enters the tree, or 0.
    t_begin: f32,
    /// Where the ray leaves the tree, or its limit.
    t_end: f32,
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
    /// The trail (after Laine 2010): one bit for each branch on the way from `restart_node` to `node`, the deepest in the
    /// lowest bit; set where the ray is on the far side, so that both sides are done when it comes back.
    trail: u64,
    /// Bits of the trail.
    branches: u32,
    /// Branches of the trail that a restart still has to go through.
    replay: u32,
    /// The ray has branched at a plane that it lies in: the far sides do not begin behind the near ones.
    in_plane: bool,
}

impl<const MOST: usize> Descent<MOST> {
    /// Go one inner node down.
    #[inline]
    fn descend(&mut self, ray: &Ray, node: KdNode) {
        let axis = node.axis();
        let inv = ray.inv_direction[axis];
        // Different only where the direction is zero: an interval around the ray for a plane that it lies in
        let t_from = (node.split() - ray.origin_min[axis]) * inv;
        let t_to = (node.split() - ray.origin_max[axis]) * inv;
        // Ordered along the ray. A plane behind the origin has t_to < 0 <= t_min: only the far side is left, which is
        // the side of the origin, as in the thesis. A cell whose two ends round to one distance is still visited,
        // as a triangle may lie in it alone.
        let (left, right) = (self.node + 1, node.right());
        let (near, far) = if inv < 0.0 { (right, left) } else { (left, right) };
        if t_from > self.t_max {
            self.node = near;
        } else if t_to < self.t_min {
            self.node = far;
        } else {
            self.branch(near, far, t_from, t_to);
        }
        if self.pushdown {
            self.restart_node = self.node;
        }
    }

    /// Both children are wanted: go to the near one, or where a restart comes back, to the one that the trail says.
    #[inline]
    fn branch(&mut self, near: u32, far: u32, t_from: f32, t_to: f32) {
        self.pushdown = false;
        self.in_plane |= t_from != t_to;
        let t_far = self.t_min.max(t_from);
        if self.replay > 0 {
            self.replay -= 1;
            if self.trail >> self.replay & 1 == 1 {
                self.node = far;
                self.t_min = t_far;
                return;
            }
        } else {
            self.trail <<= 1;
            self.branches += 1;
        }
        if self.ring > 0 {
            self.stack[self.top % self.ring] = Entry { node: far, t_min: t_far, t_max: self.t_max };
            self.top += 1;
            self.held = (self.held + 1).min(self.ring);
        }
        self.node = near;
        self.t_max = self.t_max.min(t_to);
    }

    /// Leave a leaf: go to the far side of the deepest branch that is on its near side, by a pop or by a restart. False
    /// where there is none.
    #[inline]
    fn leave_leaf<C: Count>(&mut self, count: &mut C) -> bool {
        let done = self.trail.trailing_ones();
        if done >= self.branches {
            return false;
        }
        self.trail = self.trail >> done | 1;
        self.branches -= done;
        if self.held > 0 {
            count.pop();
            self.top -= 1;
            self.held -= 1;
            let entry = self.stack[self.top % self.ring];
            (self.node, self.t_min, self.t_max) = (entry.node, entry.t_min, entry.t_max);
        } else {
            count.restart();
            (self.node, self.t_min, self.t_max) = (self.restart_node, self.t_begin, self.t_end);
            self.replay = self.branches;
        }
        true
    }

    /// True if nothing nearer than `t` can follow. Exactly at the border of this leaf's cell the next leaf may hold a
    /// triangle at the same distance with a lower index.
    #[inline]
    fn ends_before(&self, t: f32) -> bool {
        t < self.t_max && !self.in_plane
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
            t_begin: t_min,
            t_end,
            restart_node: 0,
            pushdown: self.search.pushdown,
            ring: (self.search.stack as usize).min(MOST),
            top: 0,
            held: 0,
            stack: [Entry::default(); MOST],
            trail: 0,
            branches: 0,
            replay: 0,
            in_plane: false,
        })
    }
}

impl<const MOST: usize> TraverseIndependent for KdTree<'_, MOST> {
    fn nearest_hit<C: Count>(&self, ray: &Ray, count: &mut C) -> u32 {
        let mut best = Best::NONE;
        let Some(mut d) = self.start_descent(ray, T_MAX) else {
            return MISS;
        };
        loop {
            let node = self.tree.nodes[d.node as usize];
            if node.is_leaf() {
                count.leaf();
                self.triangles.test_triangles(ray, node.first(), node.count(), &mut best, count);
                if d.ends_before(best.t) || !d.leave_leaf(count) {
                    return best.triangle_ref;
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
                if self.triangles.any_triangle_occludes(ray, node.first(), node.count(), limit, count) {
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
