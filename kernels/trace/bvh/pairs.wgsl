// Ways down through pairs of boxes, nearer child first: read_root, read_left and read_right read the nodes. Twin:
// src/workloads/trace/bvh/stack.rs.

//!include trace/bvh/private_stack.wgsl

// Goes down from an inner node: to its nearer child, or to what the stack has where neither is hit before `t`.
fn step_down(ray: Ray, t: f32, walk: ptr<function, Walk>) {
    count_inner();
    add_boxes(2u);
    let left = read_left((*walk).node);
    let right = read_right((*walk).node);
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

// Goes down to a leaf, or to EMPTY if no box that begins before `t` is left.
fn walk_to_leaf(ray: Ray, t: f32, walk: ptr<function, Walk>) {
    while (!is_leaf((*walk).node)) {
        step_down(ray, t, walk);
    }
}
