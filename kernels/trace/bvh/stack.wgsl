// BVH, one ray per invocation with a private stack, nearer child first. Twin: src/workloads/trace/bvh/stack.rs.
//
// Two loops in turn (Aila and Laine 2009): down to a leaf, then through its triangles. Where several rays share an
// instruction stream, none of them pays for both in every step. The stack keeps the distance of each node's box, so
// that a node that lies beyond a hit found meanwhile is dropped without being read.

//!include lib/independent.wgsl
//!include trace/bvh/node.wgsl

var<private> stack: array<u32, STACK_SIZE>; // references, which need no read when they are popped
var<private> stack_t: array<f32, STACK_SIZE>;

struct Walk {
    node: u32,  // reference of the node to visit
    depth: u32, // entries on the stack; the lowest one is EMPTY and never dropped
}

fn start_walk(ray: Ray, limit: f32) -> Walk {
    let root = read_node(0u);
    stack[0] = EMPTY;
    stack_t[0] = -1.0;
    return Walk(select(EMPTY, root.reference, wanted(ray_box(ray, root.lo, root.hi), limit)), 1u);
}

// The next node whose box begins before `t`, or EMPTY.
fn pop(t: f32, walk: ptr<function, Walk>) {
    loop {
        (*walk).depth -= 1u;
        if ((*walk).depth > 0u) {
            count_pop();
        }
        if (stack_t[(*walk).depth] <= t) {
            break;
        }
    }
    (*walk).node = stack[(*walk).depth];
}

// Go down, nearer child first, until the node is a leaf or nothing is left. Boxes beyond `t` are of no interest.
fn walk_to_leaf(ray: Ray, t: f32, walk: ptr<function, Walk>) {
    while (!is_leaf((*walk).node)) {
        count_inner();
        let left = read_node((*walk).node);
        let right = read_node((*walk).node + 1u);
        let l = ray_box(ray, left.lo, left.hi);
        let r = ray_box(ray, right.lo, right.hi);
        let go_left = wanted(l, t);
        let go_right = wanted(r, t);
        let right_first = !go_left || (go_right && r.x < l.x);
        (*walk).node = select(left.reference, right.reference, right_first);
        if (go_left && go_right) {
            stack[(*walk).depth] = select(right.reference, left.reference, right_first);
            stack_t[(*walk).depth] = max(l.x, r.x);
            (*walk).depth += 1u;
        }
        if (!go_left && !go_right) {
            pop(t, walk);
        }
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
        if (walk.node == EMPTY) {
            break;
        }
        count_leaf();
        let first = leaf_first(walk.node);
        for (var i = first; i < first + leaf_count(walk.node); i += 1u) {
            count_test();
            test_triangle(ray, i, &best);
        }
        pop(best.t, &walk);
    }
    return best.triangle_ref;
}

fn any_hit(ray: Ray, limit: f32, alive: bool) -> bool {
    if (!alive) {
        return false;
    }
    var walk = start_walk(ray, limit);
    loop {
        walk_to_leaf(ray, limit, &walk);
        if (walk.node == EMPTY) {
            break;
        }
        count_leaf();
        let first = leaf_first(walk.node);
        for (var i = first; i < first + leaf_count(walk.node); i += 1u) {
            count_test();
            if (triangle_occludes(ray, i, limit)) {
                return true;
            }
        }
        pop(limit, &walk);
    }
    return false;
}
