// Trees of WIDTH children a node, one ray per invocation with a private stack, nearest child first. Twin:
// src/workloads/trace/wide/stack.rs.
//
// Of the children that a ray meets, the nearest is next; the others are sorted into the stack, the nearest on top. Of
// equal distances the earlier slot comes first.

//!include lib/independent.wgsl
//!include trace/wide/node.wgsl
//!include trace/bvh/walk.wgsl

// Puts a child on the stack, below those from entry `base` on that are nearer or equally near.
fn insert(reference: u32, t: f32, base: u32, depth: u32) {
    var place = depth;
    while (place > base && stack_t[place - 1u] <= t) {
        stack[place] = stack[place - 1u];
        stack_t[place] = stack_t[place - 1u];
        place -= 1u;
    }
    stack[place] = reference;
    stack_t[place] = t;
}

// Goes down, nearest child first, to a leaf, or to EMPTY if no box that begins before `t` is left.
fn walk_to_leaf(ray: Ray, t: f32, walk: ptr<function, Walk>) {
    while (!is_leaf((*walk).node)) {
        count_inner();
        let base = (*walk).depth;
        var depth = base;
        var next = EMPTY;
        var next_t = 0.0;
        for (var i = 0u; i < WIDTH; i += 1u) {
            let child = read_slot((*walk).node * WIDTH + i);
            if (child.reference == EMPTY) {
                break;
            }
            count_box_test();
            let interval = ray_box(ray, child.lo, child.hi);
            if (!overlaps(interval, t)) {
                continue;
            }
            if (next == EMPTY) {
                next = child.reference;
                next_t = interval.x;
            } else {
                if (interval.x < next_t) {
                    stack[depth] = next;
                    stack_t[depth] = next_t;
                    next = child.reference;
                    next_t = interval.x;
                } else {
                    insert(child.reference, interval.x, base, depth);
                }
                depth += 1u;
            }
        }
        (*walk).depth = depth;
        (*walk).node = next;
        if (next == EMPTY) {
            pop(t, walk);
        }
    }
}
