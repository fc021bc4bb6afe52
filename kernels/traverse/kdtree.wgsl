// kd-tree without a full stack: restart (Foley and Sugerman 2005), pushdown and a short stack of SHORT_STACK entries (Horn
// et al. 2007), in the thesis's order. Twin: src/cpu/traverse/kdtree.rs.

//!include lib/alone.wgsl

const RING: u32 = max(SHORT_STACK, 1u);

//!slot short_stack

struct Descent {
    node: u32,
    t_min: f32,
    t_max: f32,
    t_end: f32,        // where the ray leaves the tree, or its limit
    t_restart: f32,    // where the last restart set out, -1 before the first one
    restart_node: u32,
    pushdown: bool,    // the ray has not branched yet: the restart node follows
    top: u32,          // entries ever pushed less those popped; modulo RING it is a place in the ring
    held: u32,         // entries that are still in the ring
    inside: bool,
}

fn start_descent(ray: Ray, limit: f32) -> Descent {
    let interval = ray_box(ray, structure.bounds_min, structure.bounds_max);
    let t_min = max(interval.x, 0.0);
    let t_end = min(interval.y, limit);
    return Descent(0u, t_min, t_end, t_end, -1.0, 0u, PUSHDOWN, 0u, 0u, interval.x <= interval.y && t_min <= t_end);
}

// Go one inner node down.
fn descend(ray: Ray, node: vec2<u32>, d: ptr<function, Descent>) {
    let axis = node.y & 3u;
    let split = bitcast<f32>(node.x);
    let origin = select(select(ray.origin.z, ray.origin.y, axis == 1u), ray.origin.x, axis == 0u);
    let inv = select(select(ray.inv_direction.z, ray.inv_direction.y, axis == 1u), ray.inv_direction.x, axis == 0u);
    let t_split = (split - origin) * inv;
    // Ordered along the ray. A plane behind the origin has t_split < 0 <= t_min: only the far side is left, which is
    // the side of the origin, as in the thesis. A cell so thin that its ends round to one distance is visited all the
    // same, as a triangle may lie in it alone; only a restart passes everything at its own distance, or it would
    // find the leaf it came from for ever.
    let left = (*d).node + 1u;
    let right = node.y >> 2u;
    let near = select(left, right, inv < 0.0);
    let far = select(right, left, inv < 0.0);
    if (t_split > (*d).t_max) {
        (*d).node = near;
    } else if (t_split < (*d).t_min || t_split <= (*d).t_restart) {
        (*d).node = far;
    } else {
        if (SHORT_STACK > 0u) {
            let place = stack_place((*d).top % RING);
            stack_node[place] = far;
            stack_min[place] = t_split;
            stack_max[place] = (*d).t_max;
            (*d).top += 1u;
            (*d).held = min((*d).held + 1u, SHORT_STACK);
        }
        (*d).node = near;
        (*d).t_max = t_split;
        (*d).pushdown = false;
    }
    if ((*d).pushdown) {
        (*d).restart_node = (*d).node;
    }
}

// Leave a leaf: pop, or restart behind it. False at the end of the ray.
fn leave_leaf(d: ptr<function, Descent>) -> bool {
    if ((*d).held > 0u) {
        count_pop();
        (*d).top -= 1u;
        (*d).held -= 1u;
        let place = stack_place((*d).top % RING);
        (*d).node = stack_node[place];
        (*d).t_min = stack_min[place];
        (*d).t_max = stack_max[place];
        return true;
    }
    if ((*d).t_max >= (*d).t_end) {
        return false;
    }
    count_restart();
    (*d).t_min = (*d).t_max;
    (*d).t_restart = (*d).t_max;
    (*d).t_max = (*d).t_end;
    (*d).node = (*d).restart_node;
    return true;
}

fn nearest_hit(ray: Ray, alive: bool) -> u32 {
    var best = no_best();
    if (!alive) {
        return MISS;
    }
    var d = start_descent(ray, T_MAX);
    if (!d.inside) {
        return MISS;
    }
    loop {
        let node = read_pair(d.node); // word, link: src/accel/kdtree.rs
        if ((node.y & 3u) == 3u) {
            count_leaf();
            for (var i = node.x; i < node.x + (node.y >> 2u); i += 1u) {
                count_test();
                test_record(ray, i, &best);
            }
            // Exactly at the leaf's border the next leaf may hold a triangle at the same distance with a lower index
            if (best.t < d.t_max || !leave_leaf(&d)) {
                break;
            }
        } else {
            count_inner();
            descend(ray, node, &d);
        }
    }
    return best.record;
}

fn any_hit(ray: Ray, limit: f32, alive: bool) -> bool {
    if (!alive) {
        return false;
    }
    var d = start_descent(ray, limit);
    if (!d.inside) {
        return false;
    }
    loop {
        let node = read_pair(d.node); // word, link: src/accel/kdtree.rs
        if ((node.y & 3u) == 3u) {
            count_leaf();
            for (var i = node.x; i < node.x + (node.y >> 2u); i += 1u) {
                count_test();
                if (record_blocks(ray, i, limit)) {
                    return true;
                }
            }
            if (!leave_leaf(&d)) {
                break;
            }
        } else {
            count_inner();
            descend(ray, node, &d);
        }
    }
    return false;
}
