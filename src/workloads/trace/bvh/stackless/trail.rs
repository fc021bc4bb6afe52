//! BVH with a restart trail. Twin of `kernels/trace/bvh/stackless/trail.wgsl`.

use super::KIND;
use super::layout::{INDEX, LinkedBvh};
use crate::math::{MISS, Ray, ray_box};
use crate::workloads::trace::algorithm::{Parameters, Traversal};
use crate::workloads::trace::bvh::BvhNode;
use crate::workloads::trace::bvh::stack::{LEAF, leaf_triangle_refs, overlaps};
use crate::workloads::trace::bvh::widened::{self, Widening};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::simt::{
    Event::{Leaf, Restart, Step, Test},
    Lockstep,
    Part::One,
    Read, maybe, repeat,
};
use crate::workloads::trace::traverse::{Best, STACK_SIZE, TraverseIndependent, Triangles};

/// From the root to each leaf.
pub static TRAIL: Traversal = Traversal {
    kernel: "trace/bvh/stackless/trail.wgsl",
    structure: &KIND,
    parameters: |s| Parameters::of(&[widened::parameter(s)]),
    twin: Some(|input| {
        let tree: &LinkedBvh = input.structure()?;
        let widening = Widening::around(&input, tree.bvh.nodes[0].corners());
        Ok(input.with(ByTrail { triangles: input.triangles(), tree, widening }))
    }),
    lockstep: Some(|_| LOCKSTEP),
    ..Traversal::INDEPENDENT
};

/// How its lanes wait for each other.
const LOCKSTEP: Lockstep = Lockstep::apart(&[repeat(&[
    repeat(&[One(Step), maybe(&[One(Restart)])]),
    maybe(&[One(Leaf), repeat(&[One(Test)]), maybe(&[One(Restart)])]),
])])
.reading(&[Read::pair::<BvhNode>(Step)]);

struct ByTrail<'a> {
    triangles: Triangles<'a>,
    tree: &'a LinkedBvh,
    widening: Widening,
}

/// A way down.
struct Descent {
    /// Reference of the node that it has come to.
    node: u32,
    /// Levels above it.
    level: usize,
    /// Level at which the farther child is the next.
    pop_level: Option<usize>,
    /// For each level true where the nearer child is done, or where there is no other one.
    done: [bool; STACK_SIZE],
}

impl ByTrail<'_> {
    fn root(&self) -> u32 {
        self.tree.reference(&self.tree.bvh.nodes[0])
    }

    /// Begins anew at the root, with the farther child at the deepest level that has one left. False if none has.
    #[inline(always)]
    fn restart<C: Count>(&self, descent: &mut Descent, count: &mut C) -> bool {
        descent.done[descent.level] = false;
        let Some(level) = descent.done[..descent.level].iter().rposition(|done| !done) else { return false };
        descent.done[level + 1..descent.level].fill(false);
        descent.done[level] = true;
        count.restart();
        (descent.node, descent.level, descent.pop_level) = (self.root(), 0, Some(level));
        true
    }

    /// Goes down, nearer child first, to a leaf; false if none is left.
    #[inline(always)]
    fn walk_to_leaf<C: Count>(&self, ray: &Ray, t: f32, descent: &mut Descent, count: &mut C) -> bool {
        let pairs = self.tree.bvh.nodes.as_chunks::<2>().0;
        while descent.node & LEAF == 0 {
            count.inner();
            count.read(descent.node & INDEX);
            count.box_tests(2);
            let [left, right] = &pairs[(descent.node & INDEX) as usize / 2];
            let (min, max) = left.corners();
            let l = ray_box(ray, min, max);
            let (min, max) = right.corners();
            let r = ray_box(ray, min, max);
            let level = descent.level;
            let next = match (overlaps(l, t), overlaps(r, t)) {
                (true, true) if (r.0 < l.0) != descent.done[level] => right,
                (true, true) => left,
                (hit_left, hit_right) if (hit_left || hit_right) && descent.pop_level != Some(level) => {
                    descent.done[level] = true;
                    if hit_left { left } else { right }
                }
                _ if self.restart(descent, count) => continue,
                _ => return false,
            };
            descent.node = self.tree.reference(next);
            descent.level = level + 1;
        }
        true
    }
}

impl TraverseIndependent for ByTrail<'_> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        let mut best = Best::before(limit);
        let wide = self.widening.widened(ray);
        let (min, max) = self.tree.bvh.nodes[0].corners();
        if !overlaps(ray_box(&wide, min, max), limit) {
            return MISS;
        }
        let mut descent = Descent { node: self.root(), level: 0, pop_level: None, done: [false; STACK_SIZE] };
        while self.walk_to_leaf(&wide, best.t, &mut descent, count) {
            count.leaf();
            let (first, triangle_refs) = leaf_triangle_refs(descent.node);
            if self.triangles.test::<ANY, C>(ray, first, triangle_refs, &mut best, count)
                || !self.restart(&mut descent, count)
            {
                break;
            }
        }
        best.triangle_ref
    }
}
