//! BVH, one ray at a time with a private stack, nearer child first. Twin of `kernels/trace/bvh/stack.wgsl`.

use crate::math::{Ray, T_MAX, ray_box};
use crate::workloads::trace::bvh::{Bvh, BvhNode};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::traverse::{Best, TraverseIndependent, Triangles};

/// Entries of the stack, with the one at the bottom; deeper trees are refused when they are prepared.
pub const STACK_SIZE: usize = 96;

/// What a node leads to, in one word (`kernels/trace/bvh/node.wgsl`): the left child of an inner node, which the right one
/// follows, or with the top bit set four bits of count and 27 bits of first triangle reference.
pub const LEAF: u32 = 0x8000_0000;

/// A leaf without triangle references: the bottom of every stack, and an empty tree's root.
pub const EMPTY: u32 = LEAF;

const BOTTOM: u32 = u32::MAX;

/// First triangle reference and count of a leaf's reference.
#[inline(always)]
pub fn leaf_triangle_refs(reference: u32) -> (u32, u32) {
    (reference & 0x07ff_ffff, reference >> 27 & 15)
}

/// True if a ray that has found something at `t` still wants a box with this interval.
#[inline(always)]
pub fn wanted((near, far): (f32, f32), t: f32) -> bool {
    near.max(0.0) <= far.min(t)
}

/// See the module.
pub struct BvhStack<'a> {
    triangles: Triangles<'a>,
    /// Siblings together.
    pairs: &'a [[BvhNode; 2]],
}

impl<'a> BvhStack<'a> {
    /// A traversal of a built BVH.
    pub fn new(triangles: Triangles<'a>, bvh: &'a Bvh) -> Self {
        BvhStack { triangles, pairs: bvh.nodes.as_chunks().0 }
    }

    /// The loop of both functions: `leaf` is called with first triangle reference and count, and returns the distance beyond which
    /// nothing is of interest any more; a negative one ends the traversal.
    #[inline(always)]
    fn walk<C: Count>(&self, ray: &Ray, mut t: f32, count: &mut C, mut leaf: impl FnMut(u32, u32, &mut C) -> f32) {
        let mut stack_node = [BOTTOM; STACK_SIZE];
        let mut stack_t = [-1.0f32; STACK_SIZE];
        let mut depth = 1; // entries with BOTTOM
        // What the next node whose box begins before `t` leads to, or EMPTY
        let pop = |t: f32, depth: &mut usize, nodes: &[u32; STACK_SIZE], ts: &[f32; STACK_SIZE], count: &mut C| loop {
            *depth -= 1;
            let node = nodes[*depth];
            if node == BOTTOM {
                return EMPTY;
            }
            count.pop();
            if ts[*depth] <= t {
                return self.pairs[node as usize / 2][node as usize % 2].reference();
            }
        };
        let root = &self.pairs[0][0];
        let (min, max) = root.corners();
        let mut reference = if wanted(ray_box(ray, min, max), t) { root.reference() } else { EMPTY };
        loop {
            // Go down, nearer child first, until the node is a leaf or nothing is left
            while reference & LEAF == 0 {
                count.inner();
                let [left, right] = &self.pairs[reference as usize / 2];
                let (min, max) = left.corners();
                let l = ray_box(ray, min, max);
                let (min, max) = right.corners();
                let r = ray_box(ray, min, max);
                reference = match (wanted(l, t), wanted(r, t)) {
                    (true, true) => {
                        let right_first = r.0 < l.0;
                        stack_node[depth] = reference + !right_first as u32;
                        stack_t[depth] = l.0.max(r.0);
                        depth += 1;
                        if right_first { right.reference() } else { left.reference() }
                    }
                    (true, false) => left.reference(),
                    (false, true) => right.reference(),
                    (false, false) => pop(t, &mut depth, &stack_node, &stack_t, count),
                }
            }
            if reference == EMPTY {
                return;
            }
            count.leaf();
            let (first, triangle_refs) = leaf_triangle_refs(reference);
            t = leaf(first, triangle_refs, count);
            if t < 0.0 {
                return;
            }
            reference = pop(t, &mut depth, &stack_node, &stack_t, count);
        }
    }
}

impl TraverseIndependent for BvhStack<'_> {
    fn nearest_hit<C: Count>(&self, ray: &Ray, count: &mut C) -> u32 {
        let mut best = Best::NONE;
        self.walk(ray, T_MAX, count, |first, triangle_refs, count| {
            self.triangles.test_triangles(ray, first, triangle_refs, &mut best, count);
            best.t
        });
        best.triangle_ref
    }

    fn any_hit<C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> bool {
        let mut blocked = false;
        self.walk(ray, limit, count, |first, triangle_refs, count| {
            blocked = self.triangles.any_triangle_occludes(ray, first, triangle_refs, limit, count);
            if blocked { -1.0 } else { limit }
        });
        blocked
    }
}
