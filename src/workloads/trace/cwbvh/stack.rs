//! Compressed wide BVH, one ray at a time with a private stack of groups. Twin of `kernels/trace/cwbvh/stack.wgsl`.
//!
//! H. Ylitie, T. Karras and S. Laine 2017. A group is the children of a node that the ray meets: the first child's
//! index, and a mask. Its bits 24 to 31 are the children to visit, highest first: places flipped by the signs of the
//! ray's direction. Its low 8 bits are the node's inner children, from which a child's index follows. Ours: boxes are
//! decoded and tested like those of other trees, where the paper moves the ray into the node's grid; and triangles are
//! never postponed.

use super::layout::{CwChild, CwNode, Cwbvh, WIDTH};
use super::{BUILDER, KIND};
use crate::math::{MISS, Ray, ray_box};
use crate::workloads::trace::algorithm::{Algorithm, Parameters, Traversal};
use crate::workloads::trace::bvh::stack::{EMPTY, overlaps};
use crate::workloads::trace::bvh::widened::{self, Widening};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::options::GROUP;
use crate::workloads::trace::simt::{
    Event::{Child, Leaf, Pop, Step, Test},
    Lockstep,
    Part::One,
    Read, maybe, repeat,
};
use crate::workloads::trace::structure::finite;
use crate::workloads::trace::traverse::{Best, STACK_SIZE, TraverseIndependent, Triangles};
use glam::Vec3A;

/// Eight children a node of 80 bytes.
pub static CWBVH: Algorithm = Algorithm {
    name: "cwbvh",
    alias: "",
    summary: "compressed wide BVH: eight children in 80 bytes, visited by octants, a stack of groups per ray",
    paper: "Ylitie, Karras and Laine 2017",
    builder: &BUILDER,
    traversal: |_| &STACK,
    options: &[GROUP],
};

/// Groups of children by octants.
pub static STACK: Traversal = Traversal {
    kernel: "trace/cwbvh/stack.wgsl",
    structure: &KIND,
    parameters: |s| Parameters::of(&[widened::parameter(s)]),
    twin: Some(|input| {
        let tree: &Cwbvh = input.structure()?;
        let bounds = finite(tree.bounds);
        let root = (bounds.min.into(), bounds.max.into());
        let widening = Widening::around(&input, root);
        Ok(input.with(CwbvhStack { triangles: input.triangles(), tree, root, widening }))
    }),
    leaf_order: true,
    lockstep: Some(|_| LOCKSTEP),
    ..Traversal::INDEPENDENT
};

/// How its lanes wait for each other.
const LOCKSTEP: Lockstep = Lockstep::apart(&[repeat(&[
    One(Step),
    repeat(&[One(Child), maybe(&[One(Leaf)])]),
    repeat(&[One(Test)]),
    maybe(&[One(Pop)]),
])])
.reading(&[Read::one::<CwNode>(Step)]);

struct CwbvhStack<'a> {
    triangles: Triangles<'a>,
    tree: &'a Cwbvh,
    root: (Vec3A, Vec3A),
    widening: Widening,
}

/// Bits that flip a place's number, so that the first place to visit has the highest number.
#[inline(always)]
fn flipped_bits(direction: Vec3A) -> u32 {
    let backwards = |axis: usize| u32::from(direction[axis] < 0.0);
    7 - (backwards(2) | backwards(1) << 1 | backwards(0) << 2)
}

/// What the ray meets before `t`: inner children in bits 24 to 31, triangle references in the others.
#[inline(always)]
fn visit<C: Count>(ray: &Ray, node: &CwNode, t: f32, flips: u32, count: &mut C) -> u32 {
    let grid = node.grid();
    let mut hits = 0;
    for (i, place) in (0..WIDTH).zip(0..) {
        let Some(child) = node.child(i) else { continue };
        count.box_test();
        let (min, max) = node.numbers(i);
        let (min, max) = grid.corners(min, max);
        if overlaps(ray_box(ray, min, max), t) {
            hits |= match child {
                CwChild::Node(_) => 1 << (24 + (place ^ flips)),
                CwChild::Leaf(..) => {
                    count.leaf();
                    u32::from(node.meta[i] >> 5) << (node.meta[i] & 31)
                }
            };
        }
    }
    hits
}

impl TraverseIndependent for CwbvhStack<'_> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        let mut best = Best::before(limit);
        let wide = self.widening.widened(ray);
        if self.tree.root() == EMPTY || !overlaps(ray_box(&wide, self.root.0, self.root.1), limit) {
            return MISS;
        }
        let flips = flipped_bits(ray.direction);
        let (mut stack, mut depth) = ([(0_u32, 0_u32); STACK_SIZE], 0);
        let mut index = 0;
        loop {
            let node = &self.tree.nodes[index as usize];
            count.inner();
            count.read(index);
            let hits = visit(&wide, node, best.t, flips, count);
            let mut triangles = hits & 0xff_ffff;
            while triangles != 0 {
                let offset = triangles.ilog2();
                triangles ^= 1 << offset;
                if self.triangles.test::<ANY, C>(ray, node.first_ref + offset, 1, &mut best, count) {
                    return best.triangle_ref;
                }
            }
            let (mut first, mut mask) = (node.first_child, hits & 0xff00_0000 | u32::from(node.inner));
            if hits >> 24 == 0 {
                if depth == 0 {
                    return best.triangle_ref;
                }
                count.pop();
                depth -= 1;
                (first, mask) = stack[depth];
            }
            let bit = mask.ilog2();
            mask ^= 1 << bit;
            if mask >> 24 != 0 {
                stack[depth] = (first, mask);
                depth += 1;
            }
            let place = (bit - 24) ^ flips;
            index = first + (mask & 0xff & ((1 << place) - 1)).count_ones();
        }
    }
}
