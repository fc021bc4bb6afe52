//! BVH, one ray at a time with a private stack, nearer child first. Twin of `kernels/traverse/bvh_stack.wgsl`.

use super::{Best, TraverseAlone, Triangles};
use crate::accel::bvh::{Bvh, BvhNode};
use crate::cpu::count::Count;
use crate::math::{Ray, T_MAX, ray_box};

/// Entries of the private stack; deeper trees are refused when they are prepared.
pub const STACK_SIZE: usize = 128;

/// A node in one word, so that a stack entry needs no read when it is popped: the left child of an inner node, or with
/// the top bit set four bits of count and 27 bits of first record (`kernels/lib/bvh.wgsl`).
pub const LEAF: u32 = 0x8000_0000;

/// A leaf without records: the end, and an empty tree's root.
pub const EMPTY: u32 = LEAF;

/// The root's reference.
#[inline(always)]
pub fn root_reference(root: &BvhNode) -> u32 {
    if root.first == 0 && root.count == 0 { EMPTY } else { node_reference(root) }
}

/// Packs a node's reference.
#[inline(always)]
pub fn node_reference(node: &BvhNode) -> u32 {
    if node.count > 0 { LEAF | node.count << 27 | node.first } else { node.first }
}

/// First record and count of a leaf's reference.
#[inline(always)]
pub fn leaf_records(reference: u32) -> (u32, u32) {
    (reference & 0x07ff_ffff, reference >> 27 & 15)
}

/// True if a ray that has found something at `t` still wants a box with this interval.
#[inline(always)]
pub fn wanted((near, far): (f32, f32), t: f32) -> bool {
    near <= far && near <= t && far >= 0.0
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

    /// The loop of both functions: `leaf` is called with first record and count, and returns the distance beyond which
    /// nothing is of interest any more; a negative one ends the traversal.
    #[inline(always)]
    fn walk<C: Count>(&self, ray: &Ray, mut t: f32, count: &mut C, mut leaf: impl FnMut(u32, u32, &mut C) -> f32) {
        let mut stack = [EMPTY; STACK_SIZE];
        let mut depth = 1; // the lowest entry is EMPTY
        let root = &self.pairs[0][0];
        let (min, max) = root.corners();
        let mut node = if wanted(ray_box(ray, min, max), t) { root_reference(root) } else { EMPTY };
        let pop = |node: &mut u32, depth: &mut usize, stack: &[u32; STACK_SIZE], count: &mut C| {
            *depth -= 1;
            *node = stack[*depth];
            if *node != EMPTY {
                count.pop();
            }
        };
        loop {
            // Down, nearer child first, until the node is a leaf or nothing is left
            while node & LEAF == 0 {
                count.inner();
                let [left, right] = &self.pairs[node as usize / 2];
                let (min, max) = left.corners();
                let l = ray_box(ray, min, max);
                let (min, max) = right.corners();
                let r = ray_box(ray, min, max);
                match (wanted(l, t), wanted(r, t)) {
                    (true, true) => {
                        let (near, far) = if l.0 <= r.0 { (left, right) } else { (right, left) };
                        stack[depth] = node_reference(far);
                        depth += 1;
                        node = node_reference(near);
                    }
                    (true, false) => node = node_reference(left),
                    (false, true) => node = node_reference(right),
                    (false, false) => pop(&mut node, &mut depth, &stack, count),
                }
            }
            if node == EMPTY {
                return;
            }
            count.leaf();
            let (first, records) = leaf_records(node);
            t = leaf(first, records, count);
            if t < 0.0 {
                return;
            }
            pop(&mut node, &mut depth, &stack, count);
        }
    }
}

impl TraverseAlone for BvhStack<'_> {
    fn nearest_hit<C: Count>(&self, ray: &Ray, count: &mut C) -> u32 {
        let mut best = Best::NONE;
        self.walk(ray, T_MAX, count, |first, records, count| {
            self.triangles.test_records(ray, first, records, &mut best, count);
            best.t
        });
        best.record
    }

    fn any_hit<C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> bool {
        let mut blocked = false;
        self.walk(ray, limit, count, |first, records, count| {
            blocked = self.triangles.any_record_blocks(ray, first, records, limit, count);
            if blocked { -1.0 } else { limit }
        });
        blocked
    }
}
