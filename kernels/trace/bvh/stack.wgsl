// BVH, one ray per invocation with a private stack, nearer child first. Twin: src/workloads/trace/bvh/stack.rs.
//
// Two loops alternate (Aila and Laine 2009): down to a leaf, then through its triangles. Where several rays share an
// instruction stream, none of them pays for both in every step. The stack keeps the distance of each node's box, so
// that a node that lies beyond a hit found meanwhile is dropped without being read. Without CULL, boxes are compared
// with the ray's limit only, and never with a hit.

//!include lib/independent.wgsl
//!include trace/bvh/node.wgsl
//!include trace/bvh/widened.wgsl

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
    return Walk(select(EMPTY, root.reference, overlaps(ray_box(ray, root.lo, root.hi), limit)), 1u);
}

// Pops the next node whose box begins before `t`, or EMPTY.
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

// Goes down, nearer child first, to a leaf, or to EMPTY if no box that begins before `t` is left.
fn walk_to_leaf(ray: Ray, t: f32, walk: ptr<function, Walk>) {
    while (!is_leaf((*walk).node)) {
        count_inner();
        add_boxes(2u);
        let left = read_node((*walk).node);
        let right = read_node((*walk).node + 1u);
        let l = ray_box(ray, left.lo, left.hi);
        let r = ray_box(ray, right.lo, right.hi);
        let hit_left = overlaps(l, t);
        let hit_right = overlaps(r, t);
        let right_first = !hit_left || (hit_right && r.x < l.x);
        (*walk).node = select(left.reference, right.reference, right_first);
        if (hit_left && hit_right) {
            stack[(*walk).depth] = select(right.reference, left.reference, right_first);
            stack_t[(*walk).depth] = max(l.x, r.x);
            (*walk).depth += 1u;
        }
        if (!hit_left && !hit_right) {
            pop(t, walk);
        }
    }
}

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    if (!alive) {
        return MISS;
    }
    var best = Best(limit, MISS);
    let wide = widened(ray);
    var walk = start_walk(wide, limit);
    loop {
        walk_to_leaf(wide, select(limit, best.t, CULL), &walk);
        if (walk.node == EMPTY) {
            break;
        }
        count_leaf();
        if (test_triangles(ray, leaf_first(walk.node), leaf_count(walk.node), any, &best)) {
            break;
        }
        pop(select(limit, best.t, CULL), &walk);
    }
    return best.triangle_ref;
}
