// BVH, one ray per invocation with a private stack, nearer child first. Twin: src/cpu/traverse/bvh_stack.rs.

//!include lib/alone.wgsl
//!include lib/bvh.wgsl

fn root_reference(ray: Ray, limit: f32) -> u32 {
    let root = nodes[0];
    if (wanted(ray_box(ray, root.lo, root.hi), limit)) {
        return node_reference(root.first, root.count);
    }
    return EMPTY;
}

fn nearest_hit(ray: Ray, alive: bool) -> u32 {
    var best = no_best();
    if (!alive) {
        return MISS;
    }
    var stack: array<u32, STACK_SIZE>;
    var depth = 0u;
    var node = root_reference(ray, T_MAX);
    loop {
        if (node == EMPTY) {
            break;
        }
        if (is_leaf(node)) {
            count_leaf();
            let first = leaf_first(node);
            for (var i = first; i < first + leaf_count(node); i += 1u) {
                count_test();
                test_record(ray, i, &best);
            }
            node = EMPTY;
        } else {
            count_inner();
            let left = nodes[node];
            let right = nodes[node + 1u];
            let l = ray_box(ray, left.lo, left.hi);
            let r = ray_box(ray, right.lo, right.hi);
            let go_left = wanted(l, best.t);
            let go_right = wanted(r, best.t);
            let left_reference = node_reference(left.first, left.count);
            let right_reference = node_reference(right.first, right.count);
            node = EMPTY;
            if (go_left && go_right) {
                let left_first = l.x <= r.x;
                node = select(right_reference, left_reference, left_first);
                stack[depth] = select(left_reference, right_reference, left_first);
                depth += 1u;
            } else if (go_left) {
                node = left_reference;
            } else if (go_right) {
                node = right_reference;
            }
        }
        if (node == EMPTY && depth > 0u) {
            count_pop();
            depth -= 1u;
            node = stack[depth];
        }
    }
    return best.record;
}

fn any_hit(ray: Ray, limit: f32, alive: bool) -> bool {
    if (!alive) {
        return false;
    }
    var stack: array<u32, STACK_SIZE>;
    var depth = 0u;
    var node = root_reference(ray, limit);
    loop {
        if (node == EMPTY) {
            break;
        }
        if (is_leaf(node)) {
            count_leaf();
            let first = leaf_first(node);
            for (var i = first; i < first + leaf_count(node); i += 1u) {
                count_test();
                if (record_blocks(ray, i, limit)) {
                    return true;
                }
            }
            node = EMPTY;
        } else {
            count_inner();
            let left = nodes[node];
            let right = nodes[node + 1u];
            let l = ray_box(ray, left.lo, left.hi);
            let r = ray_box(ray, right.lo, right.hi);
            let go_left = wanted(l, limit);
            let go_right = wanted(r, limit);
            let left_reference = node_reference(left.first, left.count);
            let right_reference = node_reference(right.first, right.count);
            node = EMPTY;
            if (go_left && go_right) {
                let left_first = l.x <= r.x;
                node = select(right_reference, left_reference, left_first);
                stack[depth] = select(left_reference, right_reference, left_first);
                depth += 1u;
            } else if (go_left) {
                node = left_reference;
            } else if (go_right) {
                node = right_reference;
            }
        }
        if (node == EMPTY && depth > 0u) {
            count_pop();
            depth -= 1u;
            node = stack[depth];
        }
    }
    return false;
}
