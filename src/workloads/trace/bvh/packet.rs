//! BVH walked by a packet of 64 rays with one shared stack (Günther et al. 2007) and the thesis's corrected vote. Twin
//! of `kernels/trace/bvh/packet.wgsl`: what its barriers keep in step is one loop over the rays after another here.

use crate::error::Result;
use crate::math::{Ray, ray_box};
use crate::workloads::trace::algorithm::{Algorithm, Parameter, Parameters, Traversal};
use crate::workloads::trace::bvh::stack::{EMPTY, LEAF, leaf_triangle_refs, overlaps};
use crate::workloads::trace::bvh::widened::{self, Widening};
use crate::workloads::trace::bvh::{Bvh as Tree, BvhNode, KIND, TOP_DOWN};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::cpu::TwinInput;
use crate::workloads::trace::options::{Axis, Kind, OptionInfo, PACKET};
use crate::workloads::trace::simt::{
    Event::{Leaf, Pop, Step, Test, Vote},
    Lockstep, Mark,
    Part::{All, One},
    Read, choice, maybe, repeat,
};
use crate::workloads::trace::traverse::{Best, GROUP, Lanes, STACK_SIZE, Traverse, Triangles, bits};

/// The BVH of the thesis.
pub static BVH: Algorithm = Algorithm {
    name: "bvh",
    alias: "bvh-packet",
    summary: "SAH BVH, packets of 8x8 rays with one shared stack (also: bvh-packet)",
    paper: "Wald 2007; Wald, Boulos and Shirley 2007; Stich et al. 2009; Günther et al. 2007",
    builder: &TOP_DOWN,
    traversal: |_| &SHARED_STACK,
    options: &[VOTE, PACKET],
};

/// The rays of a work-group with one stack.
pub static SHARED_STACK: Traversal = Traversal {
    kernel: "trace/bvh/packet.wgsl",
    structure: &KIND,
    parameters: |s| {
        let original_vote = ("ORIGINAL_VOTE", Parameter::Flag(s.value("vote") == "original"));
        Parameters::of(&[original_vote, widened::parameter(s)])
    },
    twin: Some(|input| Ok(input.with(Bvh::of(&input)?))),
    lockstep: Some(|_| LOCKSTEP),
    ..Traversal::COOPERATIVE
};

/// How its lanes wait for each other.
const LOCKSTEP: Lockstep = Lockstep::together(&[repeat(&[
    choice(&[maybe(&[One(Leaf), repeat(&[One(Test)])]), maybe(&[All(Step), maybe(&[All(Vote)])])]),
    maybe(&[All(Pop)]),
])])
.reading(&[Read::pair::<BvhNode>(Step)]);

/// In the original, rays that hit neither child vote as well, by which box begins first on their line.
const VOTE: OptionInfo = OptionInfo::new(
    Axis::Traversal,
    "vote",
    "corrected",
    "who votes on the order of children: rays that hit one (corrected), or all (original)",
    Kind::Word(&["corrected", "original"]),
);

/// See the module.
pub struct Bvh<'a> {
    triangles: Triangles<'a>,
    pairs: &'a [[BvhNode; 2]],
    original_vote: bool,
    widening: Widening,
}

/// What the work-group shares.
struct Packet {
    stack: [u32; STACK_SIZE],
    depth: usize,
    /// Node to visit.
    next: u32,
    /// True if it came from the stack.
    popped: bool,
}

impl Packet {
    fn go(&mut self, node: u32) {
        (self.next, self.popped) = (node, false);
    }

    fn pop(&mut self) {
        self.go(EMPTY);
        if self.depth > 0 {
            self.depth -= 1;
            (self.next, self.popped) = (self.stack[self.depth], true);
        }
    }

    fn announce<C: Count>(&self, alive: u64, counters: &mut Lanes<C>) {
        if self.popped {
            bits(alive).for_each(|lane| counters[lane].pop());
        }
    }
}

impl<'a> Bvh<'a> {
    fn of(input: &TwinInput<'a>) -> Result<Self> {
        let bvh: &Tree = input.structure()?;
        let original_vote = input.method.parameters.flag("ORIGINAL_VOTE");
        let widening = Widening::of(input, bvh);
        Ok(Bvh { triangles: input.triangles(), pairs: bvh.nodes.as_chunks().0, original_vote, widening })
    }

    fn start_packet(&self) -> Packet {
        Packet { stack: [0; STACK_SIZE], depth: 0, next: self.pairs[0][0].reference(), popped: false }
    }

    /// Tests both children's boxes against every ray, adds up the votes, and chooses the packet's next node.
    fn visit_inner<C: Count>(
        &self,
        rays: &Lanes<Ray>,
        packet: &mut Packet,
        best: &Lanes<Best>,
        alive: u64,
        counters: &mut Lanes<C>,
    ) {
        let [left, right] = &self.pairs[packet.next as usize / 2];
        let (left_min, left_max) = left.corners();
        let (right_min, right_max) = right.corners();
        let (mut any_left, mut any_right, mut any_both) = (false, false, false);
        let mut votes = 0; // for the right child first
        for lane in bits(alive) {
            counters[lane].inner();
            counters[lane].read(packet.next);
            counters[lane].box_tests(2);
            let l = ray_box(&rays[lane], left_min, left_max);
            let r = ray_box(&rays[lane], right_min, right_max);
            let t = best[lane].t;
            match (overlaps(l, t), overlaps(r, t)) {
                (true, true) => {
                    any_both = true;
                    votes += (r.0 < l.0) as i32 - (l.0 < r.0) as i32;
                }
                (true, false) => {
                    any_left = true;
                    votes -= 1;
                }
                (false, true) => {
                    any_right = true;
                    votes += 1;
                }
                (false, false) if self.original_vote => votes += if r.0 < l.0 { 1 } else { -1 },
                (false, false) => {}
            }
        }
        // The sum's sign decides; the kernel's exact counts are booleans here
        let (left, right) = (left.reference(), right.reference());
        if any_both || (any_left && any_right) {
            let (first, second) = if votes > 0 { (right, left) } else { (left, right) };
            bits(alive).for_each(|lane| counters[lane].mark(Mark::Vote));
            packet.stack[packet.depth] = second;
            packet.depth += 1;
            packet.go(first);
        } else if any_left {
            packet.go(left);
        } else if any_right {
            packet.go(right);
        } else {
            packet.pop();
        }
        packet.announce(alive, counters);
    }
}

impl Traverse for Bvh<'_> {
    fn traverse<const ANY: bool, C: Count>(
        &self,
        rays: &Lanes<Ray>,
        limit: f32,
        alive: u64,
        counters: &mut Lanes<C>,
    ) -> Lanes<u32> {
        let mut best = [Best::before(limit); GROUP];
        let mut searching = alive; // an occluded ray no longer votes
        let mut packet = self.start_packet();
        let wide = self.widening.all(rays);
        while packet.next != EMPTY {
            if packet.next & LEAF != 0 {
                let (first, triangle_refs) = leaf_triangle_refs(packet.next);
                for lane in bits(searching) {
                    let counted = &mut counters[lane];
                    counted.leaf();
                    if self.triangles.test::<ANY, C>(&rays[lane], first, triangle_refs, &mut best[lane], counted) {
                        searching &= !(1 << lane);
                    }
                }
                // The packet ends as soon as every ray is occluded
                if ANY && searching == 0 {
                    break;
                }
                packet.pop();
                packet.announce(searching, counters);
            } else {
                self.visit_inner(&wide, &mut packet, &best, searching, counters);
            }
        }
        best.map(|best| best.triangle_ref)
    }
}
