// The search of a kd-tree without a full stack: restart (Foley and Sugerman 2005), pushdown and a short stack of
// SHORT_STACK entries (Horn et al. 2007), in the thesis's order. Twin: `search` in
// src/workloads/trace/kdtree/search.rs.
//
// A restart resumes by the path taken, not by the distance reached: from afar, many cells have ends that round to the
// same distance, and none of them may be skipped or visited endlessly.

//!include trace/kdtree/node.wgsl

const RING: u32 = max(SHORT_STACK, 1u);

//!slot short_stack

struct Descent {
    node: u32,
    t_min: f32,
    t_max: f32,
    t_begin: f32,      // where the ray enters the tree, or 0
    t_end: f32,        // where the ray leaves the tree, or its limit
    restart_node: u32,
    pushdown: bool,    // the ray has not branched yet: the restart node follows
    top: u32,          // entries ever pushed less those popped; modulo RING it is a place in the ring
    held: u32,         // entries that are still in the ring
    // The trail (after Laine 2010): one bit for each branch on the way from restart_node to node, the deepest in the
    // lowest bit; set where the ray is on the far side, so that both sides are done when it comes back
    trail_low: u32,
    trail_high: u32,
    branches: u32,     // bits of the trail
    replay: u32,       // branches of the trail that a restart still has to go through
    in_plane: bool,    // the ray has branched at a plane that it lies in: far sides do not begin behind near ones
    inside: bool,
}

fn start_descent(ray: Ray, limit: f32) -> Descent {
    let interval = ray_box(ray, tree.bounds_min, tree.bounds_max);
    var d: Descent;
    d.t_begin = max(interval.x, 0.0);
    d.t_end = min(interval.y, limit);
    d.t_min = d.t_begin;
    d.t_max = d.t_end;
    d.pushdown = PUSHDOWN;
    d.inside = interval.x <= interval.y && d.t_begin <= d.t_end;
    return d;
}

// Goes one inner node down.
fn descend(ray: Ray, node: vec2<u32>, d: ptr<function, Descent>) {
    let inv = on_axis(ray.inv_direction, split_axis(node));
    let plane = plane_distances(ray, node);
    // Ordered along the ray. A plane behind the origin has plane.y < 0 <= t_min: only the far side is left, which is
    // the side of the origin, as in the thesis. A cell whose two ends round to one distance is still visited, as a
    // triangle may lie in it alone.
    let left = (*d).node + 1u;
    let right = right_child(node);
    let near = select(left, right, inv < 0.0);
    let far = select(right, left, inv < 0.0);
    if (plane.x > (*d).t_max) {
        (*d).node = near;
    } else if (plane.y < (*d).t_min) {
        (*d).node = far;
    } else {
        branch(near, far, plane, d);
    }
    if ((*d).pushdown) {
        (*d).restart_node = (*d).node;
    }
}

// The ray overlaps both children: goes to the near one, or after a restart to the one that the trail says.
fn branch(near: u32, far: u32, plane: vec2<f32>, d: ptr<function, Descent>) {
    (*d).pushdown = false;
    (*d).in_plane = (*d).in_plane || plane.x != plane.y;
    let t_far = max((*d).t_min, plane.x);
    if ((*d).replay > 0u) {
        (*d).replay -= 1u;
        let word = select((*d).trail_low, (*d).trail_high, (*d).replay >= 32u);
        if (((word >> ((*d).replay & 31u)) & 1u) == 1u) {
            (*d).node = far;
            (*d).t_min = t_far;
            return;
        }
    } else {
        (*d).trail_high = ((*d).trail_high << 1u) | ((*d).trail_low >> 31u);
        (*d).trail_low = (*d).trail_low << 1u;
        (*d).branches += 1u;
    }
    if (SHORT_STACK > 0u) {
        let place = stack_place((*d).top % RING);
        stack_node[place] = far;
        stack_min[place] = t_far;
        stack_max[place] = (*d).t_max;
        (*d).top += 1u;
        (*d).held = min((*d).held + 1u, SHORT_STACK);
    }
    (*d).node = near;
    (*d).t_max = min((*d).t_max, plane.y);
}

// Takes the lowest `bits` bits from the trail, at most 63.
fn shorten_trail(bits: u32, d: ptr<function, Descent>) {
    var rest = bits;
    if (rest >= 32u) {
        (*d).trail_low = (*d).trail_high;
        (*d).trail_high = 0u;
        rest -= 32u;
    }
    if (rest > 0u) {
        (*d).trail_low = ((*d).trail_low >> rest) | ((*d).trail_high << (32u - rest));
        (*d).trail_high = (*d).trail_high >> rest;
    }
    (*d).branches -= bits;
}

// True if nothing nearer than `t` can follow. Exactly at the border of this leaf's cell the next leaf may hold a
// triangle at the same distance with a lower index.
fn ends_before(t: f32, d: Descent) -> bool {
    return t < d.t_max && !d.in_plane;
}

// Leaves a leaf: goes to the far side of the deepest branch that is on its near side, by a pop or by a restart. False
// where there is none.
fn leave_leaf(d: ptr<function, Descent>) -> bool {
    var done = countTrailingZeros(~(*d).trail_low);
    if (done == 32u) {
        done += countTrailingZeros(~(*d).trail_high);
    }
    if (done >= (*d).branches) {
        return false;
    }
    shorten_trail(done, d);
    (*d).trail_low |= 1u;
    if ((*d).held > 0u) {
        count_pop();
        (*d).top -= 1u;
        (*d).held -= 1u;
        let place = stack_place((*d).top % RING);
        (*d).node = stack_node[place];
        (*d).t_min = stack_min[place];
        (*d).t_max = stack_max[place];
    } else {
        count_restart();
        (*d).node = (*d).restart_node;
        (*d).t_min = (*d).t_begin;
        (*d).t_max = (*d).t_end;
        (*d).replay = (*d).branches;
    }
    return true;
}

// The triangle reference of the nearest hit before `limit`, with `any` of some hit there, or MISS. `found` is what
// another search of the same ray has found already.
fn search(ray: Ray, limit: f32, any: bool, found: Best) -> u32 {
    var best = found;
    var d = start_descent(ray, limit);
    if (!d.inside) {
        return best.triangle_ref;
    }
    loop {
        let node = read_kd_node(d.node);
        if (is_leaf(node)) {
            count_leaf();
            if (test_triangles(ray, leaf_first(node), leaf_count(node), any, &best)) {
                break;
            }
            if (ends_before(best.t, d) || !leave_leaf(&d)) {
                break;
            }
        } else {
            count_inner();
            descend(ray, node, &d);
        }
    }
    return best.triangle_ref;
}
