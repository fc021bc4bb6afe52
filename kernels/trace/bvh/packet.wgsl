// BVH walked by a packet: the 64 rays of a work-group share one stack and visit the same nodes (Günther et al. 2007),
// with the thesis's corrected vote: a ray that hits neither child does not vote (with ORIGINAL_VOTE it votes for the
// box that begins first on its line). Twin: src/workloads/trace/bvh/packet.rs.
//
// All invocations, at most 64, stay until the packet is done; rays that are not alive take part in the barriers only.

//!include lib/cooperative.wgsl
//!include trace/bvh/node.wgsl
//!include trace/bvh/widened.wgsl

var<workgroup> stack: array<u32, STACK_SIZE>;
var<workgroup> stack_depth: u32;
var<workgroup> next: vec2<u32>; // node to visit, and 1 if it came from the stack
var<workgroup> tally: atomic<u32>;

// The votes of all rays are added up in one word: how many rays hit only the left child, only the right one, both (7
// bits each, at most 64), and from bit 21 which one to visit first: 0 for left, 2 for right, 1 for none.
const LEFT_ONE: u32 = 1u;
const RIGHT_ONE: u32 = 1u << 7u;
const BOTH_ONE: u32 = 1u << 14u;
const VOTE_SHIFT: u32 = 21u;
const NO_VOTE: u32 = 1u << VOTE_SHIFT;

fn child_vote(l: vec2<f32>, r: vec2<f32>, hit_left: bool, hit_right: bool) -> u32 {
    if (hit_left && hit_right) {
        // Right first: +1. Left first: -1. Equally near: 0, which goes left.
        return BOTH_ONE | (u32(1 + i32(r.x < l.x) - i32(l.x < r.x)) << VOTE_SHIFT);
    }
    if (hit_left) {
        return LEFT_ONE;
    }
    if (hit_right) {
        return RIGHT_ONE | (2u << VOTE_SHIFT);
    }
    if (ORIGINAL_VOTE) {
        return select(0u, 2u, r.x < l.x) << VOTE_SHIFT;
    }
    return NO_VOTE;
}

// Chooses what the packet visits next, by the sum of votes. Called by invocation 0 only.
fn choose(left: u32, right: u32) {
    let sum = atomicExchange(&tally, 0u);
    let any_left = (sum & 127u) != 0u;
    let any_right = ((sum >> 7u) & 127u) != 0u;
    let any_both = ((sum >> 14u) & 127u) != 0u;
    if (any_both || (any_left && any_right)) {
        mark_vote();
        let right_first = (sum >> VOTE_SHIFT) > GROUP_SIZE;
        stack[stack_depth] = select(right, left, right_first);
        stack_depth += 1u;
        next = vec2<u32>(select(left, right, right_first), 0u);
    } else if (any_left) {
        next = vec2<u32>(left, 0u);
    } else if (any_right) {
        next = vec2<u32>(right, 0u);
    } else {
        pop();
    }
}

// Takes the next node from the stack. Called by invocation 0 only.
fn pop() {
    next = vec2<u32>(EMPTY, 0u);
    if (stack_depth > 0u) {
        stack_depth -= 1u;
        next = vec2<u32>(stack[stack_depth], 1u);
    }
}

// The packet's first node. Reached by the whole work-group; the answer is uniform.
fn start_packet() -> u32 {
    if (lane == 0u) {
        stack_depth = 0u;
        next = vec2<u32>(read_node(0u).reference, 0u);
    }
    return workgroupUniformLoad(&next).x;
}

// Tests both children's boxes against this ray, adds up the votes, and returns the packet's next node. Reached by the
// whole work-group; the answer is uniform.
fn visit_inner(ray: Ray, node: u32, t: f32, alive: bool) -> u32 {
    if (alive) {
        count_inner();
        add_boxes(2u);
    }
    let left = read_node(node);
    let right = read_node(node + 1u);
    let l = ray_box(ray, left.lo, left.hi);
    let r = ray_box(ray, right.lo, right.hi);
    atomicAdd(&tally, select(NO_VOTE, child_vote(l, r, overlaps(l, t), overlaps(r, t)), alive));
    workgroupBarrier();
    if (lane == 0u) {
        choose(left.reference, right.reference);
    }
    return announce(alive);
}

fn leave_leaf(alive: bool) -> u32 {
    if (lane == 0u) {
        pop();
    }
    return announce(alive);
}

fn announce(alive: bool) -> u32 {
    let chosen = workgroupUniformLoad(&next);
    if (alive && chosen.y == 1u) {
        count_pop();
    }
    return chosen.x;
}

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    var best = Best(limit, MISS);
    var searching = alive; // an occluded ray no longer votes
    var node = start_packet();
    let wide = widened(ray);
    while (node != EMPTY) {
        if (is_leaf(node)) {
            if (searching) {
                count_leaf();
                searching = !test_triangles(ray, leaf_first(node), leaf_count(node), any, &best);
            }
            // The packet ends as soon as every ray is occluded
            if (any && !group_any(searching)) {
                break;
            }
            node = leave_leaf(searching);
        } else {
            node = visit_inner(wide, node, best.t, searching);
        }
    }
    return best.triangle_ref;
}
