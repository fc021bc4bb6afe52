// BVH, one ray per invocation with a private stack, nearer child first. Twin: src/cpu/traverse/bvh_stack.rs.
//
// Two loops in turn (Aila and Laine 2009): down to a leaf, then through its triangles. Where several rays share an
// instruction stream, none of them pays for both in every step. The stack keeps the distance of each node's box, so
// that a node that lies beyond a hit found meanwhile is dropped without being read.

//!include lib/alone.wgsl
//!include lib/bvh.wgsl

const BOTTOM: u32 = 0xffffffffu; // lies below all entries; no node's index

var<private> stack_node: array<u32, STACK_SIZE>;
var<private> stack_t: array<f32, STACK_SIZE>;

struct Walk {
    reference: u32, // of the node to visit
    depth: u32,     // entries on the stack with BOTTOM
}

fn start_walk(ray: Ray, limit: f32) -> Walk {
    let root = nodes[0];
    stack_node[0] = BOTTOM;
    stack_t[0] = -1.0;
    return Walk(select(EMPTY, root.reference, wanted(ray_box(ray, root.lo, root.hi), limit)), 1u);
}

// The index of the next node whose box begins before `t`, or BOTTOM.
fn pop(t: f32, walk: ptr<function, Walk>) -> u32 {
    loop {
        (*walk).depth -= 1u;
        if (stack_node[(*walk).depth] != BOTTOM) {
            count_pop();
        }
        if (stack_t[(*walk).depth] <= t) {
            break;
        }
    }
    return stack_node[(*walk).depth];
}

fn visit(node: u32, walk: ptr<function, Walk>) {
    (*walk).reference = EMPTY;
    if (node != BOTTOM) {
        (*walk).reference = nodes[node].reference;
    }
}

// Go down, nearer child first, until the node is a leaf or nothing is left. Boxes beyond `t` are of no interest.
fn walk_to_leaf(ray: Ray, t: f32, walk: ptr<function, Walk>) {
    while (!is_leaf((*walk).reference)) {
        count_inner();
        let left = (*walk).reference;
        let l = ray_box(ray, nodes[left].lo, nodes[left].hi);
        let r = ray_box(ray, nodes[left + 1u].lo, nodes[left + 1u].hi);
        let go_left = wanted(l, t);
        let go_right = wanted(r, t);
        let right_first = !go_left || (go_right && r.x < l.x);
        var node = left + u32(right_first);
        if (go_left && go_right) {
            stack_node[(*walk).depth] = left + u32(!right_first);
            stack_t[(*walk).depth] = max(l.x, r.x);
            (*walk).depth += 1u;
        }
        if (!go_left && !go_right) {
            node = pop(t, walk);
        }
        visit(node, walk);
    }
}

fn nearest_hit(ray: Ray, alive: bool) -> u32 {
    var best = no_best();
    if (!alive) {
        return MISS;
    }
    var walk = start_walk(ray, T_MAX);
    loop {
        walk_to_leaf(ray, best.t, &walk);
        if (walk.reference == EMPTY) {
            break;
        }
        count_leaf();
        let first = leaf_first(walk.reference);
        for (var i = first; i < first + leaf_count(walk.reference); i += 1u) {
            count_test();
            test_record(ray, i, &best);
        }
        visit(pop(best.t, &walk), &walk);
    }
    return best.record;
}

fn any_hit(ray: Ray, limit: f32, alive: bool) -> bool {
    if (!alive) {
        return false;
    }
    var walk = start_walk(ray, limit);
    loop {
        walk_to_leaf(ray, limit, &walk);
        if (walk.reference == EMPTY) {
            break;
        }
        count_leaf();
        let first = leaf_first(walk.reference);
        for (var i = first; i < first + leaf_count(walk.reference); i += 1u) {
            count_test();
            if (record_blocks(ray, i, limit)) {
                return true;
            }
        }
        visit(pop(limit, &walk), &walk);
    }
    return false;
}
