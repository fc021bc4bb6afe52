//! BVH without a stack: links lead back to parents. Twin of `kernels/trace/bvh/stackless/parent.wgsl`.
//!
//! Hapala et al. (2011) choose the nearer child by the split axis of the builder; here it is the axis on which the
//! children's middles are farthest apart, which every tree has.

use super::KIND;
use super::layout::{INDEX, LinkedBvh};
use crate::math::{MISS, Ray, ray_box};
use crate::workloads::trace::algorithm::{Parameters, Traversal};
use crate::workloads::trace::bvh::BvhNode;
use crate::workloads::trace::bvh::stack::{EMPTY, LEAF, leaf_triangle_refs, overlaps};
use crate::workloads::trace::bvh::widened::{self, Widening};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::simt::{
    Event::{Child, Leaf, Rope, Step, Test, Turn},
    Lockstep, Mark,
    Part::One,
    Read, maybe, repeat,
};
use crate::workloads::trace::traverse::{Best, TraverseIndependent, Triangles};

/// Nearer sibling, then the other one, then back to the parent.
pub static PARENT: Traversal = Traversal {
    kernel: "trace/bvh/stackless/parent.wgsl",
    structure: &KIND,
    parameters: |s| Parameters::of(&[widened::parameter(s)]),
    twin: Some(|input| {
        let tree: &LinkedBvh = input.structure()?;
        let widening = Widening::around(&input, tree.bvh.nodes[0].corners());
        Ok(input.with(ByParent { triangles: input.triangles(), tree, widening }))
    }),
    lockstep: Some(|_| LOCKSTEP),
    ..Traversal::INDEPENDENT
};

/// How its lanes wait for each other.
const LOCKSTEP: Lockstep = Lockstep::apart(&[repeat(&[
    repeat(&[One(Turn), maybe(&[One(Child)]), repeat(&[One(Rope)]), maybe(&[One(Step)])]),
    maybe(&[One(Leaf), repeat(&[One(Test)]), repeat(&[One(Rope)])]),
])])
.reading(&[Read::one::<BvhNode>(Turn), Read { bytes: 4, ..Read::one::<BvhNode>(Rope) }]);

struct ByParent<'a> {
    triangles: Triangles<'a>,
    tree: &'a LinkedBvh,
    widening: Widening,
}

/// Which of two siblings the ray meets first: 0 for the left one, 1 for the right one. `word` is a link or a reference.
#[inline(always)]
fn nearer(ray: &Ray, word: u32) -> u32 {
    let order = word >> 28 & 7;
    let descends = ray.direction[(order & 3) as usize] < 0.0;
    u32::from(descends != (order >= 4))
}

impl ByParent<'_> {
    /// The node that comes after `index` and all below it: the nearest sibling that is yet to be tested, or MISS.
    #[inline(always)]
    fn after<C: Count>(&self, ray: &Ray, mut index: u32, count: &mut C) -> u32 {
        while index != 0 {
            let link = self.tree.link(index);
            if index & 1 == nearer(ray, link) {
                return index ^ 1;
            }
            count.rope();
            count.read(index);
            index = link & INDEX;
        }
        MISS
    }

    /// The first leaf from a node on whose box begins before `t`: its index, or MISS, and its reference.
    #[inline(always)]
    fn next_leaf<C: Count>(&self, ray: &Ray, t: f32, mut index: u32, count: &mut C) -> (u32, u32) {
        while index != MISS {
            count.mark(Mark::Turn);
            count.read(index);
            let node = &self.tree.bvh.nodes[index as usize];
            if index != 0 {
                count.box_test();
            }
            let (min, max) = node.corners();
            if !overlaps(ray_box(ray, min, max), t) {
                index = self.after(ray, index, count);
                continue;
            }
            let reference = self.tree.reference(node);
            if reference & LEAF != 0 {
                return (index, reference);
            }
            count.inner();
            index = (reference & INDEX) + nearer(ray, reference);
        }
        (MISS, EMPTY)
    }
}

impl TraverseIndependent for ByParent<'_> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        let mut best = Best::before(limit);
        let wide = self.widening.widened(ray);
        let (mut index, mut reference) = self.next_leaf(&wide, limit, 0, count);
        while index != MISS {
            count.leaf();
            let (first, triangle_refs) = leaf_triangle_refs(reference);
            if self.triangles.test::<ANY, C>(ray, first, triangle_refs, &mut best, count) {
                break;
            }
            let next = self.after(&wide, index, count);
            (index, reference) = self.next_leaf(&wide, best.t, next, count);
        }
        best.triangle_ref
    }
}
