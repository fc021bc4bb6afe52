// A ray's private stack in a tree of boxes, whose root read_root reads. Twin: src/workloads/trace/bvh/stack.rs.
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
