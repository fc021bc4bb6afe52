// BVH, one ray per invocation with a private stack, nearer child first. Twin: src/cpu/traverse/bvh_stack.rs.
//
// Two loops in turn (Aila and Laine 2009): down to a leaf, then through its triangles. Where several rays share an
// instruction stream, none of them pays for both in every step.

//!include lib/alone.wgsl
//!include lib/bvh.wgsl

var<private> stack: array<u32, STACK_SIZE>;

struct Walk {
    node: u32,
    depth: u32, // entries on the stack; the lowest is EMPTY
}

fn start_walk(ray: Ray, limit: f32) -> Walk {
    let root = nodes[0];
    stack[0] = EMPTY;
    return Walk(select(EMPTY, root_reference(), wanted(ray_box(ray, root.lo, root.hi), limit)), 1u);
}

fn pop(walk: ptr<function, Walk>) {
    (*walk).depth -= 1u;
    (*walk).node = stack[(*walk).depth];
    if ((*walk).node != EMPTY) {
        count_pop();
    }
}

// Go down, nearer child first, until the node is a leaf or nothing is left. Boxes beyond `t` are of no interest.
fn walk_to_leaf(ray: Ray, t: f32, walk: ptr<function, Walk>) {
    while (!is_leaf((*walk).node)) {
        count_inner();
        let left = nodes[(*walk).node];
        let right = nodes[(*walk).node + 1u];
        let l = ray_box(ray, left.lo, left.hi);
        let r = ray_box(ray, right.lo, right.hi);
        let go_left = wanted(l, t);
        let go_right = wanted(r, t);
        let left_reference = node_reference(left.first, left.count);
        let right_reference = node_reference(right.first, right.count);
        let left_first = go_left && (l.x <= r.x || !go_right);
        if (go_left && go_right) {
            stack[(*walk).depth] = select(left_reference, right_reference, left_first);
            (*walk).depth += 1u;
        }
        if (go_left || go_right) {
            (*walk).node = select(right_reference, left_reference, left_first);
        } else {
            pop(walk);
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
            test_record(ray, i, &best);
        }
        pop(&walk);
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
        if (walk.node == EMPTY) {
            break;
        }
        count_leaf();
        let first = leaf_first(walk.node);
        for (var i = first; i < first + leaf_count(walk.node); i += 1u) {
            count_test();
            if (record_blocks(ray, i, limit)) {
                return true;
            }
        }
        pop(&walk);
    }
    return false;
}
