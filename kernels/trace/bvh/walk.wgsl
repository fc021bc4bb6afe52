// A tree of boxes, one ray per invocation with a private stack. read_root reads the root, and walk_to_leaf goes down.
// Twin: src/workloads/trace/bvh/stack.rs.
//
// Two loops alternate (Aila and Laine 2009): down to a leaf, then through its triangles. Where several rays share an
// instruction stream, none of them pays for both in every step. Without CULL, boxes are compared with the ray's limit
// only, and never with a hit.
//
// The stack keeps the distance of each node's box, so that a node that lies beyond a hit found meanwhile is dropped
// without being read.

//!include trace/bvh/widened.wgsl

var<private> stack: array<u32, STACK_SIZE>; // references, which need no read when they are popped
var<private> stack_t: array<f32, STACK_SIZE>;

struct Walk {
    node: u32,  // reference of the node to visit
    depth: u32, // entries on the stack; the lowest one is EMPTY and never dropped
}

fn start_walk(ray: Ray, limit: f32) -> Walk {
    let root = read_root();
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
