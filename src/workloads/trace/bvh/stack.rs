//! BVH, one ray at a time with a private stack, nearer child first. Twin of `kernels/trace/bvh/stack.wgsl`, and of
//! every kernel with the loops of `kernels/trace/bvh/walk.wgsl`; other forms of the loops are in [`super::loops`].
//!
//! With `cull=off`, boxes are never compared with the nearest hit so far: a ray visits every node that it meets before
//! its limit, as in a thesis of 2010 (the source `rt2`).

use crate::math::{Ray, ray_box};
use crate::workloads::trace::algorithm::{Algorithm, Parameter, Parameters, Traversal};
use crate::workloads::trace::bvh::loops::{self, Form, LOOP};
use crate::workloads::trace::bvh::widened::{self, Widening};
use crate::workloads::trace::bvh::{Bvh, BvhNode, KIND, PLOC, TOP_DOWN};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::cpu::TwinInput;
use crate::workloads::trace::options::{Axis, GROUP, Kind, OptionInfo};
use crate::workloads::trace::selection::Selection;
use crate::workloads::trace::traverse::{Best, STACK_SIZE, TraverseIndependent, Triangles};
use glam::Vec3A;

/// A stack per ray in the same BVH as that of packets.
pub static BVH_STACK: Algorithm = Algorithm {
    name: "bvh-stack",
    alias: "",
    summary: "the same BVH, one ray per thread with a stack of its own",
    paper: "Wald 2007; Wald, Boulos and Shirley 2007; Stich et al. 2009; Aila and Laine 2009",
    builder: &TOP_DOWN,
    traversal: |_| &STACK,
    options: &[LOOP, CULL, GROUP],
};

/// A stack per ray in a BVH of a state-of-the-art builder.
pub static PLOC_STACK: Algorithm = Algorithm {
    name: "ploc-stack",
    alias: "",
    summary: "BVH built by obvhs (PLOC with reinsertion; as bvh where that takes too long), a stack per ray",
    paper: "Meister and Bittner 2018",
    builder: &PLOC,
    traversal: |_| &STACK,
    options: &[LOOP, CULL, GROUP],
};

/// Depth first, nearer child first.
pub static STACK: Traversal = Traversal {
    kernel: "trace/bvh/stack.wgsl",
    structure: &KIND,
    parameters: |s| loops::with_form(parameters(s), Form::of(s)),
    slots: loops::slots,
    twin: Some(loops::twin),
    leaf_order: true,
    lockstep: Some(loops::lockstep),
    ..Traversal::INDEPENDENT
};

/// The parameters of the loops.
pub(in crate::workloads::trace) fn parameters(s: &Selection) -> Parameters {
    Parameters::of(&[("CULL", Parameter::Flag(s.value("cull") == "on")), widened::parameter(s)])
}

/// Which boxes are compared with hits.
pub(in crate::workloads::trace) const CULL: OptionInfo = OptionInfo::new(
    Axis::Traversal,
    "cull",
    "on",
    "leave out boxes that begin behind the nearest hit so far: those of children, and those from the stack",
    Kind::Word(&["on", "off"]),
);

/// The parameters without options.
pub fn defaults() -> Parameters {
    loops::with_form(Parameters::of(&[("CULL", Parameter::Flag(true)), widened::flag(false)]), Form::WhileWhile)
}

/// What a node leads to, in one word (`kernels/trace/bvh/node.wgsl`): the left child of an inner node, which the right
/// one follows, or with the top bit set four bits of count and 27 bits of first triangle reference.
pub const LEAF: u32 = 0x8000_0000;

/// A leaf without triangle references: the bottom of every stack, and an empty tree's root.
pub const EMPTY: u32 = LEAF;

/// First triangle reference and count of a leaf's reference.
#[inline(always)]
pub fn leaf_triangle_refs(reference: u32) -> (u32, u32) {
    (reference & 0x07ff_ffff, reference >> 27 & 15)
}

/// True if a box with this interval contains a point of the ray from its start to `t`.
#[inline(always)]
pub fn overlaps((near, far): (f32, f32), t: f32) -> bool {
    near.max(0.0) <= far.min(t)
}

/// Pairs of siblings, in whichever layout.
pub(in crate::workloads::trace) trait Pairs: Sync {
    /// One of two siblings.
    type Node;

    /// The box around everything, and what it leads to.
    fn root(&self) -> (Vec3A, Vec3A, u32);

    /// The children of an inner node, left and right.
    fn children(&self, reference: u32) -> &[Self::Node; 2];

    /// The box of a node.
    fn corners(&self, node: &Self::Node) -> (Vec3A, Vec3A);

    /// What a node leads to.
    fn reference(&self, node: &Self::Node) -> u32;
}

impl Pairs for Bvh {
    type Node = BvhNode;

    fn root(&self) -> (Vec3A, Vec3A, u32) {
        let (min, max) = self.nodes[0].corners();
        (min, max, self.nodes[0].reference())
    }

    #[inline(always)]
    fn children(&self, reference: u32) -> &[BvhNode; 2] {
        &self.nodes.as_chunks().0[reference as usize / 2]
    }

    #[inline(always)]
    fn corners(&self, node: &BvhNode) -> (Vec3A, Vec3A) {
        node.corners()
    }

    #[inline(always)]
    fn reference(&self, node: &BvhNode) -> u32 {
        node.reference()
    }
}

/// A ray's stack (`kernels/trace/bvh/walk.wgsl`); the lowest entry is EMPTY.
pub(in crate::workloads::trace) struct Stack {
    /// References of nodes.
    pub node: [u32; STACK_SIZE],
    /// Distances at which the nodes' boxes begin.
    pub t: [f32; STACK_SIZE],
    /// Number of entries.
    pub depth: usize,
}

impl Stack {
    /// Only the lowest entry.
    #[inline(always)]
    pub fn new() -> Stack {
        Stack { node: [EMPTY; STACK_SIZE], t: [-1.0; STACK_SIZE], depth: 1 }
    }

    /// The node on top, if its box begins before `t`; or the next one of which that is true, or EMPTY.
    #[inline(always)]
    pub fn pop<C: Count>(&mut self, t: f32, count: &mut C) -> u32 {
        loop {
            self.depth -= 1;
            if self.depth > 0 {
                count.pop();
            }
            if self.t[self.depth] <= t {
                return self.node[self.depth];
            }
        }
    }

    /// Adds a node on top.
    #[inline(always)]
    pub fn push(&mut self, node: u32, t: f32) {
        self.node[self.depth] = node;
        self.t[self.depth] = t;
        self.depth += 1;
    }
}

/// How to go down in a tree of boxes.
pub(in crate::workloads::trace) trait Down: Sync {
    /// The box around everything, and what it leads to.
    fn root(&self) -> (Vec3A, Vec3A, u32);

    /// Goes down, nearest child first, to a leaf, or to EMPTY if no box that begins before `t` is left.
    fn walk_to_leaf<C: Count>(&self, ray: &Ray, t: f32, from: u32, stack: &mut Stack, count: &mut C) -> u32;
}

/// In pairs of boxes (`kernels/trace/bvh/pairs.wgsl`).
pub(in crate::workloads::trace) struct InPairs<'a, P>(pub &'a P);

impl<P: Pairs> Down for InPairs<'_, P> {
    fn root(&self) -> (Vec3A, Vec3A, u32) {
        self.0.root()
    }

    #[inline(always)]
    fn walk_to_leaf<C: Count>(&self, ray: &Ray, t: f32, from: u32, stack: &mut Stack, count: &mut C) -> u32 {
        let mut reference = from;
        while reference & LEAF == 0 {
            reference = self.step_down(ray, t, reference, stack, count);
        }
        reference
    }
}

impl<P: Pairs> InPairs<'_, P> {
    /// Goes down from an inner node: to its nearer child, or to what the stack has where neither is hit before `t`.
    #[inline(always)]
    pub(super) fn step_down<C: Count>(&self, ray: &Ray, t: f32, from: u32, stack: &mut Stack, count: &mut C) -> u32 {
        let pairs = self.0;
        count.inner();
        count.read(from);
        count.box_tests(2);
        let [left, right] = pairs.children(from);
        let (min, max) = pairs.corners(left);
        let l = ray_box(ray, min, max);
        let (min, max) = pairs.corners(right);
        let r = ray_box(ray, min, max);
        match (overlaps(l, t), overlaps(r, t)) {
            (true, true) => {
                let (near, far) = if r.0 < l.0 { (right, left) } else { (left, right) };
                stack.push(pairs.reference(far), l.0.max(r.0));
                pairs.reference(near)
            }
            (true, false) => pairs.reference(left),
            (false, true) => pairs.reference(right),
            (false, false) => stack.pop(t, count),
        }
    }
}

/// See the module.
pub(in crate::workloads::trace) struct StackSearch<'a, D> {
    pub(super) triangles: Triangles<'a>,
    pub(super) down: D,
    pub(super) widening: Widening,
    root: (Vec3A, Vec3A, u32),
    cull: bool,
}

impl<'a, D: Down> StackSearch<'a, D> {
    /// A traversal of a built tree.
    pub fn new(input: &TwinInput<'a>, down: D) -> Self {
        let root = down.root();
        let (cull, widening) = (input.method.parameters.flag("CULL"), Widening::around(input, (root.0, root.1)));
        StackSearch { triangles: input.triangles(), down, widening, root, cull }
    }

    /// The reference at which a ray begins.
    #[inline(always)]
    pub(super) fn start(&self, wide: &Ray, limit: f32) -> u32 {
        let (min, max, root) = self.root;
        if overlaps(ray_box(wide, min, max), limit) { root } else { EMPTY }
    }

    /// Boxes are looked at up to this distance.
    #[inline(always)]
    pub(super) fn reach(&self, best: &Best, limit: f32) -> f32 {
        if self.cull { best.t } else { limit }
    }
}

impl<D: Down> TraverseIndependent for StackSearch<'_, D> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        let mut best = Best::before(limit);
        let mut stack = Stack::new();
        let wide = self.widening.widened(ray);
        let mut reference = self.start(&wide, limit);
        loop {
            reference = self.down.walk_to_leaf(&wide, self.reach(&best, limit), reference, &mut stack, count);
            if reference == EMPTY {
                return best.triangle_ref;
            }
            count.leaf();
            let (first, triangle_refs) = leaf_triangle_refs(reference);
            if self.triangles.test::<ANY, C>(ray, first, triangle_refs, &mut best, count) {
                return best.triangle_ref;
            }
            reference = stack.pop(self.reach(&best, limit), count);
        }
    }
}
