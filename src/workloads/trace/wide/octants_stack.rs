//! Trees of four or eight children a node, one ray at a time: children in the order of their places, flipped by the
//! signs of the ray's direction. Twin of `kernels/trace/wide/octants.wgsl`.
//!
//! An entry of the stack is a node and the children that are still to be visited: one entry a level, no distances.

use super::{EIGHT, FOUR, Wide};
use crate::math::{MISS, Ray, ray_box};
use crate::workloads::trace::algorithm::{Parameter, Parameters, Traversal};
use crate::workloads::trace::bvh::stack::{EMPTY, LEAF, leaf_triangle_refs, overlaps};
use crate::workloads::trace::bvh::widened::{self, Widening};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::cpu::Twin;
use crate::workloads::trace::simt::{
    Event::{Child, Leaf, Pop, Step, Test},
    Lockstep,
    Part::One,
    Read, choice, maybe, repeat,
};
use crate::workloads::trace::traverse::{Best, STACK_SIZE, TraverseIndependent, Triangles};
use crate::workloads::trace::wide::layout::Slot;
use glam::Vec3A;

/// In trees of four children a node.
pub static OCTANTS4: Traversal = Traversal {
    kernel: "trace/wide/octants.wgsl",
    structure: &FOUR,
    parameters: |s| Parameters::of(&[("WIDTH", Parameter::Word(4)), widened::parameter(s)]),
    twin: Some(TWIN),
    leaf_order: true,
    lockstep: Some(|_| LOCKSTEP4),
    ..Traversal::INDEPENDENT
};

/// How its lanes wait for each other.
const LOCKSTEP: Lockstep = Lockstep::apart(&[repeat(&[
    choice(&[maybe(&[One(Leaf), repeat(&[One(Test)])]), maybe(&[One(Step), repeat(&[One(Child)])])]),
    maybe(&[One(Pop)]),
])]);

const LOCKSTEP4: Lockstep = LOCKSTEP.reading(&[Read::one::<[Slot; 4]>(Step)]);

const LOCKSTEP8: Lockstep = LOCKSTEP.reading(&[Read::one::<[Slot; 8]>(Step)]);

/// In trees of eight.
pub static OCTANTS8: Traversal = Traversal {
    structure: &EIGHT,
    parameters: |s| Parameters::of(&[("WIDTH", Parameter::Word(8)), widened::parameter(s)]),
    lockstep: Some(|_| LOCKSTEP8),
    ..OCTANTS4
};

const TWIN: Twin = |input| {
    let tree: &Wide = input.structure()?;
    let (min, max, root) = tree.root();
    let widening = Widening::around(&input, (min, max));
    Ok(input.with(Octants { triangles: input.triangles(), tree, root: (min, max, root), widening, axes: tree.axes() }))
};

struct Octants<'a> {
    triangles: Triangles<'a>,
    tree: &'a Wide,
    root: (Vec3A, Vec3A, u32),
    widening: Widening,
    /// Of the bits of a place.
    axes: Vec<usize>,
}

impl Octants<'_> {
    /// The bits of a place that the ray's direction flips.
    #[inline(always)]
    fn flipped_bits(&self, direction: Vec3A) -> u32 {
        let bit = |(bit, &axis): (usize, &usize)| u32::from(direction[axis] < 0.0) << bit;
        self.axes.iter().enumerate().map(bit).sum()
    }

    /// The children that the ray meets before `t`, a bit for each by its place in the ray's order.
    #[inline(always)]
    fn visit<C: Count>(&self, ray: &Ray, node: u32, t: f32, flips: u32, count: &mut C) -> u32 {
        count.inner();
        count.read(node);
        let mut hits = 0;
        for (i, child) in (0..).zip(self.tree.node(node)).filter(|(_, child)| !child.is_empty()) {
            count.box_test();
            let (min, max) = child.corners(&self.tree.planes);
            if overlaps(ray_box(ray, min, max), t) {
                hits |= 1 << (i ^ flips);
            }
        }
        hits
    }
}

impl TraverseIndependent for Octants<'_> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        let mut best = Best::before(limit);
        let wide = self.widening.widened(ray);
        let (min, max, root) = self.root;
        if root == EMPTY || !overlaps(ray_box(&wide, min, max), limit) {
            return MISS;
        }
        let flips = self.flipped_bits(ray.direction);
        let (mut next, mut node, mut hits) = (root, 0, 0_u32);
        let (mut stack, mut depth) = ([(0, 0); STACK_SIZE], 0);
        loop {
            if next & LEAF != 0 {
                count.leaf();
                let (first, triangle_refs) = leaf_triangle_refs(next);
                if self.triangles.test::<ANY, C>(ray, first, triangle_refs, &mut best, count) {
                    break;
                }
            } else {
                if hits != 0 {
                    stack[depth] = (node, hits);
                    depth += 1;
                }
                node = next;
                hits = self.visit(&wide, node, best.t, flips, count);
            }
            if hits == 0 {
                if depth == 0 {
                    break;
                }
                count.pop();
                depth -= 1;
                (node, hits) = stack[depth];
            }
            let place = hits.trailing_zeros() ^ flips;
            hits &= hits - 1;
            next = self.tree.node(node)[place as usize].reference;
        }
        best.triangle_ref
    }
}
