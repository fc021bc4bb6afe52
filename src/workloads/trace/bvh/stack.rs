//! BVH, one ray at a time with a private stack, nearer child first. Twin of `kernels/trace/bvh/stack.wgsl`.
//!
//! With `cull=off`, boxes are never compared with the nearest hit so far: a ray visits every node that it meets before
//! its limit, as in a thesis of 2010 (the source `rt2`).

use crate::math::{Ray, ray_box};
use crate::workloads::trace::algorithm::{Algorithm, Parameter, Parameters, Traversal};
use crate::workloads::trace::bvh::widened::{self, Widening};
use crate::workloads::trace::bvh::{Bvh, BvhNode, KIND, PLOC, TOP_DOWN};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::options::{Axis, GROUP, Kind, OptionInfo};
use crate::workloads::trace::traverse::{Best, STACK_SIZE, TraverseIndependent, Triangles};

/// A stack per ray in the same BVH as that of packets.
pub static BVH_STACK: Algorithm = Algorithm {
    name: "bvh-stack",
    alias: "",
    summary: "the same BVH, one ray per thread with a stack of its own",
    paper: "Wald 2007; Wald, Boulos and Shirley 2007; Stich et al. 2009; Aila and Laine 2009",
    builder: &TOP_DOWN,
    traversal: |_| &STACK,
    options: &[CULL, GROUP],
};

/// A stack per ray in a BVH of a state-of-the-art builder.
pub static PLOC_STACK: Algorithm = Algorithm {
    name: "ploc-stack",
    alias: "",
    summary: "BVH built by obvhs (PLOC with reinsertion; as bvh where that takes too long), a stack per ray",
    paper: "Meister and Bittner 2018",
    builder: &PLOC,
    traversal: |_| &STACK,
    options: &[CULL, GROUP],
};

/// Depth first, nearer child first.
pub static STACK: Traversal = Traversal {
    kernel: "trace/bvh/stack.wgsl",
    structure: &KIND,
    parameters: |s| {
        let cull = ("CULL", Parameter::Flag(s.value("cull") == "on"));
        Parameters::of(&[cull, widened::parameter(s)])
    },
    twin: Some(|input| {
        let parameters = input.method.parameters;
        let bvh = input.structure()?;
        Ok(input.with(BvhStack::new(input.triangles(), bvh, parameters.flag("CULL"), Widening::of(&input, bvh))))
    }),
    leaf_order: true,
    ..Traversal::INDEPENDENT
};

const CULL: OptionInfo = OptionInfo::new(
    Axis::Traversal,
    "cull",
    "on",
    "leave out boxes that begin behind the nearest hit so far: those of children, and those from the stack",
    Kind::Word(&["on", "off"]),
);

/// The parameters without options.
pub fn defaults() -> Parameters {
    Parameters::of(&[("CULL", Parameter::Flag(true)), widened::flag(false)])
}

/// What a node leads to, in one word (`kernels/trace/bvh/node.wgsl`): the left child of an inner node, which the right
/// one follows, or with the top bit set four bits of count and 27 bits of first triangle reference.
pub const LEAF: u32 = 0x8000_0000;

/// A leaf without triangle references: the bottom of every stack, and an empty tree's root.
pub const EMPTY: u32 = LEAF;

const BOTTOM: u32 = u32::MAX;

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

/// A ray's stack; the lowest entry is BOTTOM.
struct Stack {
    node: [u32; STACK_SIZE],
    /// Distance at which the node's box begins.
    t: [f32; STACK_SIZE],
    depth: usize,
}

/// See the module.
pub struct BvhStack<'a> {
    triangles: Triangles<'a>,
    /// Siblings together.
    pairs: &'a [[BvhNode; 2]],
    cull: bool,
    widening: Widening,
}

impl<'a> BvhStack<'a> {
    /// A traversal of a built BVH.
    pub fn new(triangles: Triangles<'a>, bvh: &'a Bvh, cull: bool, widening: Widening) -> Self {
        BvhStack { triangles, pairs: bvh.nodes.as_chunks().0, cull, widening }
    }

    /// The node on top of the stack, if its box begins before `t`; or the next one of which that is true, or EMPTY.
    #[inline(always)]
    fn pop<C: Count>(&self, t: f32, stack: &mut Stack, count: &mut C) -> u32 {
        loop {
            stack.depth -= 1;
            let node = stack.node[stack.depth];
            if node == BOTTOM {
                return EMPTY;
            }
            count.pop();
            if stack.t[stack.depth] <= t {
                return self.pairs[node as usize / 2][node as usize % 2].reference();
            }
        }
    }

    /// Goes down, nearer child first, to a leaf, or to EMPTY if no box that begins before `t` is left.
    #[inline(always)]
    fn walk_to_leaf<C: Count>(&self, ray: &Ray, t: f32, mut reference: u32, stack: &mut Stack, count: &mut C) -> u32 {
        while reference & LEAF == 0 {
            count.inner();
            count.box_tests(2);
            let [left, right] = &self.pairs[reference as usize / 2];
            let (min, max) = left.corners();
            let l = ray_box(ray, min, max);
            let (min, max) = right.corners();
            let r = ray_box(ray, min, max);
            reference = match (overlaps(l, t), overlaps(r, t)) {
                (true, true) => {
                    let right_first = r.0 < l.0;
                    stack.node[stack.depth] = reference + !right_first as u32;
                    stack.t[stack.depth] = l.0.max(r.0);
                    stack.depth += 1;
                    if right_first { right.reference() } else { left.reference() }
                }
                (true, false) => left.reference(),
                (false, true) => right.reference(),
                (false, false) => self.pop(t, stack, count),
            }
        }
        reference
    }
}

impl TraverseIndependent for BvhStack<'_> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        let mut best = Best::before(limit);
        let mut stack = Stack { node: [BOTTOM; STACK_SIZE], t: [-1.0; STACK_SIZE], depth: 1 };
        let root = &self.pairs[0][0];
        let (min, max) = root.corners();
        let wide = self.widening.widened(ray);
        let mut reference = if overlaps(ray_box(&wide, min, max), limit) { root.reference() } else { EMPTY };
        loop {
            let reach = if self.cull { best.t } else { limit };
            reference = self.walk_to_leaf(&wide, reach, reference, &mut stack, count);
            if reference == EMPTY {
                return best.triangle_ref;
            }
            count.leaf();
            let (first, triangle_refs) = leaf_triangle_refs(reference);
            if self.triangles.test::<ANY, C>(ray, first, triangle_refs, &mut best, count) {
                return best.triangle_ref;
            }
            let reach = if self.cull { best.t } else { limit };
            reference = self.pop(reach, &mut stack, count);
        }
    }
}
