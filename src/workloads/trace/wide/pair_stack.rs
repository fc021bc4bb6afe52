//! BVH with quantised boxes, one ray at a time with a private stack: the loops of
//! [`crate::workloads::trace::bvh::stack`]. Twin of `kernels/trace/wide/pair_stack.wgsl`.

use super::{PAIRS, QUANTISED, Slot, Wide};
use crate::workloads::trace::algorithm::{Algorithm, Traversal};
use crate::workloads::trace::bvh::loops::WHILE_WHILE;
use crate::workloads::trace::bvh::stack::{CULL, InPairs, Pairs, StackSearch, parameters};
use crate::workloads::trace::options::GROUP;
use crate::workloads::trace::simt::{Event::Step, Lockstep, Read};
use glam::Vec3A;

/// `bvh-stack` with nodes of half the bytes.
pub static BVH_QUANTISED: Algorithm = Algorithm {
    name: "bvh-quantised",
    alias: "",
    summary: "the BVH of bvh-stack with 16 bits a plane, one ray per thread with a stack of its own",
    paper: "Ylitie, Karras and Laine 2017; Aila and Laine 2009",
    builder: &QUANTISED,
    traversal: |_| &PAIR_STACK,
    options: &[CULL, GROUP],
};

/// Depth first, nearer child first.
pub static PAIR_STACK: Traversal = Traversal {
    kernel: "trace/wide/pair_stack.wgsl",
    structure: &PAIRS,
    parameters,
    twin: Some(|input| {
        let tree: &Wide = input.structure()?;
        Ok(input.with(StackSearch::new(&input, InPairs(tree))))
    }),
    leaf_order: true,
    lockstep: Some(|_| LOCKSTEP),
    ..Traversal::INDEPENDENT
};

/// How its lanes wait for each other.
const LOCKSTEP: Lockstep = WHILE_WHILE.reading(&[Read::one::<[Slot; 2]>(Step)]);

impl Pairs for Wide {
    type Node = Slot;

    fn root(&self) -> (Vec3A, Vec3A, u32) {
        Wide::root(self)
    }

    #[inline(always)]
    fn children(&self, reference: u32) -> &[Slot; 2] {
        &self.slots.as_chunks().0[reference as usize]
    }

    #[inline(always)]
    fn corners(&self, node: &Slot) -> (Vec3A, Vec3A) {
        node.corners(&self.planes)
    }

    #[inline(always)]
    fn reference(&self, node: &Slot) -> u32 {
        node.reference
    }
}
