//! Bounding interval hierarchy, one ray at a time with a private stack, nearer child first. Twin of
//! `kernels/trace/bih/stack.wgsl`.
//!
//! C. Wächter and A. Keller: Instant Ray Tracing: The Bounding Interval Hierarchy, 2006.

use crate::math::{MISS, Ray, ray_box};
use crate::workloads::trace::algorithm::{Algorithm, Traversal};
use crate::workloads::trace::bih::{BUILDER, Bih as Tree, BihNode, KIND};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::options::GROUP;
use crate::workloads::trace::simt::{
    Event::{Leaf, Pop, Step, Test},
    Lockstep,
    Part::One,
    Read, choice, maybe, repeat,
};
use crate::workloads::trace::traverse::{Best, STACK_SIZE, TraverseIndependent, Triangles};

/// A stack per ray in a hierarchy of intervals.
pub static BIH: Algorithm = Algorithm {
    name: "bih",
    alias: "",
    summary: "bounding interval hierarchy, two planes a node, one ray per thread with a stack of its own",
    paper: "Wächter and Keller 2006",
    builder: &BUILDER,
    traversal: |_| &STACK,
    options: &[GROUP],
};

/// Depth first, nearer child first.
pub static STACK: Traversal = Traversal {
    kernel: "trace/bih/stack.wgsl",
    structure: &KIND,
    twin: Some(|input| Ok(input.with(BihStack { triangles: input.triangles(), tree: input.structure()? }))),
    lockstep: Some(|_| LOCKSTEP),
    ..Traversal::INDEPENDENT
};

/// How its lanes wait for each other.
const LOCKSTEP: Lockstep = Lockstep::apart(&[repeat(&[choice(&[
    maybe(&[One(Leaf), repeat(&[One(Test)]), repeat(&[One(Pop)])]),
    maybe(&[One(Step), repeat(&[One(Pop)])]),
])])])
.reading(&[Read::one::<BihNode>(Step), Read::one::<BihNode>(Leaf)]);

struct BihStack<'a> {
    triangles: Triangles<'a>,
    tree: &'a Tree,
}

/// A node, and the part of the ray inside.
#[derive(Clone, Copy, Default)]
struct Entry {
    node: u32,
    t_min: f32,
    t_max: f32,
}

struct Walk {
    at: Entry,
    stack: [Entry; STACK_SIZE],
    depth: usize,
}

impl Walk {
    /// Takes the next node that the ray enters before `t`; false if there is none.
    #[inline(always)]
    fn pop<C: Count>(&mut self, t: f32, count: &mut C) -> bool {
        while self.depth > 0 {
            count.pop();
            self.depth -= 1;
            let top = self.stack[self.depth];
            if top.t_min <= t {
                self.at = Entry { t_max: top.t_max.min(t), ..top };
                return true;
            }
        }
        false
    }

    /// Goes one inner node down, or to the next node of the stack where the ray enters neither child; false if there is
    /// none.
    #[inline(always)]
    fn descend<C: Count>(&mut self, ray: &Ray, node: BihNode, t: f32, count: &mut C) -> bool {
        let axis = node.axis();
        let inv = ray.inv_direction[axis];
        // Distances to where the lower child ends and where the upper one begins, as in ray_box
        let t_low = (node.low_end() - ray.origin_max[axis]) * inv;
        let t_high = (node.high_begin() - ray.origin_min[axis]) * inv;
        let backwards = inv < 0.0;
        let (end, begin) = if backwards { (t_high, t_low) } else { (t_low, t_high) };
        let (near_end, far_begin) = (self.at.t_max.min(end), self.at.t_min.max(begin));
        let (near, far) = (node.child() + u32::from(backwards), node.child() + u32::from(!backwards));
        let (enters_near, enters_far) = (self.at.t_min <= near_end, far_begin <= self.at.t_max);
        if enters_near {
            if enters_far {
                self.stack[self.depth] = Entry { node: far, t_min: far_begin, t_max: self.at.t_max };
                self.depth += 1;
            }
            self.at = Entry { node: near, t_max: near_end, ..self.at };
            return true;
        }
        if enters_far {
            self.at = Entry { node: far, t_min: far_begin, ..self.at };
            return true;
        }
        count.skip();
        self.pop(t, count)
    }
}

impl TraverseIndependent for BihStack<'_> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        let mut best = Best::before(limit);
        let (near, far) = ray_box(ray, self.tree.bounds.min.into(), self.tree.bounds.max.into());
        let (t_min, t_max) = (near.max(0.0), far.min(limit));
        if !(near <= far && t_min <= t_max) {
            return MISS;
        }
        let mut walk = Walk { at: Entry { node: 0, t_min, t_max }, stack: [Entry::default(); STACK_SIZE], depth: 0 };
        let mut goes_on = true;
        while goes_on {
            let node = self.tree.nodes[walk.at.node as usize];
            if node.is_leaf() {
                count.leaf();
                count.read(walk.at.node);
                if self.triangles.test::<ANY, C>(ray, node.first(), node.count(), &mut best, count) {
                    break;
                }
                goes_on = walk.pop(best.t, count);
            } else {
                count.inner();
                count.read(walk.at.node);
                goes_on = walk.descend(ray, node, best.t, count);
            }
        }
        best.triangle_ref
    }
}
