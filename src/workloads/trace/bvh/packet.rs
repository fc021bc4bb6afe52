//! BVH walked by a packet of 64 rays with one shared stack (Günther et al. 2007) and the thesis's corrected vote. Twin
//! of `kernels/trace/bvh/packet.wgsl`: what its barriers keep in step stands here as one loop over the rays after another.

use crate::math::{Ray, ray_box};
use crate::workloads::trace::bvh::stack::{EMPTY, LEAF, STACK_SIZE, leaf_triangle_refs, wanted};
use crate::workloads::trace::bvh::{Bvh as Tree, BvhNode};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::method::Vote;
use crate::workloads::trace::traverse::{Best, GROUP, Lanes, Traverse, Triangles, bits};

/// See the module.
pub struct Bvh<'a> {
    triangles: Triangles<'a>,
    pairs: &'a [[BvhNode; 2]],
    vote: Vote,
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
    /// A traversal of a built BVH.
    pub fn new(triangles: Triangles<'a>, bvh: &'a Tree, vote: Vote) -> Self {
        Bvh { triangles, pairs: bvh.nodes.as_chunks().0, vote }
    }

    fn start_packet(&self) -> Packet {
        Packet { stack: [0; STACK_SIZE], depth: 0, next: self.pairs[0][0].reference(), popped: false }
    }

    /// Both children's boxes against every ray, the wishes added up, and the packet's next node.
    fn visit_inner<C: Count>(
        &self,
        rays: &Lanes<Ray>,
        packet: &mut Packet,
        t: impl Fn(usize) -> f32,
        alive: u64,
        counters: &mut Lanes<C>,
    ) {
        let [left, right] = &self.pairs[packet.next as usize / 2];
        let (left_min, left_max) = left.corners();
        let (right_min, right_max) = right.corners();
        let (mut wants_left, mut wants_right, mut wants_both) = (false, false, false);
        let mut votes = 0; // for the right child first
        for lane in bits(alive) {
            counters[lane].inner();
            let l = ray_box(&rays[lane], left_min, left_max);
            let r = ray_box(&rays[lane], right_min, right_max);
            match (wanted(l, t(lane)), wanted(r, t(lane))) {
                (true, true) => {
                    wants_both = true;
                    votes += (r.0 < l.0) as i32 - (l.0 < r.0) as i32;
                }
                (true, false) => {
                    wants_left = true;
                    votes -= 1;
                }
                (false, true) => {
                    wants_right = true;
                    votes += 1;
                }
                (false, false) if self.vote == Vote::Original => votes += if r.0 < l.0 { 1 } else { -1 },
                (false, false) => {}
            }
        }
        // The sum's sign decides; the kernel's exact counts are booleans here
        let (left, right) = (left.reference(), right.reference());
        if wants_both || (wants_left && wants_right) {
            let (first, second) = if votes > 0 { (right, left) } else { (left, right) };
            packet.stack[packet.depth] = second;
            packet.depth += 1;
            packet.go(first);
        } else if wants_left {
            packet.go(left);
        } else if wants_right {
            packet.go(right);
        } else {
            packet.pop();
        }
        packet.announce(alive, counters);
    }
}

impl Traverse for Bvh<'_> {
    fn nearest_hits<C: Count>(&self, rays: &Lanes<Ray>, alive: u64, counters: &mut Lanes<C>) -> Lanes<u32> {
        let mut best = [Best::NONE; GROUP];
        let mut packet = self.start_packet();
        while packet.next != EMPTY {
            if packet.next & LEAF != 0 {
                let (first, triangle_refs) = leaf_triangle_refs(packet.next);
                for lane in bits(alive) {
                    counters[lane].leaf();
                    self.triangles.test_triangles(
                        &rays[lane],
                        first,
                        triangle_refs,
                        &mut best[lane],
                        &mut counters[lane],
                    );
                }
                packet.pop();
                packet.announce(alive, counters);
            } else {
                self.visit_inner(rays, &mut packet, |lane| best[lane].t, alive, counters);
            }
        }
        best.map(|best| best.triangle_ref)
    }

    fn any_hits<C: Count>(&self, rays: &Lanes<Ray>, limit: f32, alive: u64, counters: &mut Lanes<C>) -> u64 {
        let mut searching = alive; // a ray that is blocked has no more wishes
        let mut packet = self.start_packet();
        while packet.next != EMPTY {
            if packet.next & LEAF != 0 {
                let (first, triangle_refs) = leaf_triangle_refs(packet.next);
                for lane in bits(searching) {
                    let counted = &mut counters[lane];
                    counted.leaf();
                    if self.triangles.any_triangle_occludes(&rays[lane], first, triangle_refs, limit, counted) {
                        searching &= !(1 << lane);
                    }
                }
                // The packet ends as soon as every ray is blocked
                if searching == 0 {
                    break;
                }
                packet.pop();
                packet.announce(searching, counters);
            } else {
                self.visit_inner(rays, &mut packet, |_| limit, searching, counters);
            }
        }
        alive & !searching
    }
}
