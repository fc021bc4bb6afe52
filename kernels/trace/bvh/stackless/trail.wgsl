// BVH with a restart trail (Laine 2010): one bit a level instead of a stack, and a new descent from the root after each
// leaf. Twin: src/workloads/trace/bvh/stackless/trail.rs.
//
// The bit of a level is set where the nearer child is done, or where there is no other one. As a number whose highest
// bit is that of the root, the trail only grows.

//!include lib/independent.wgsl
//!include trace/bvh/stackless/node.wgsl

var<private> trail: array<u32, STACK_SIZE / 32u>;

struct Descent {
    node: u32,      // reference
    level: u32,     // levels above it
    pop_level: u32, // level at which the farther child is the next; MISS in the first descent
}

fn is_done(level: u32) -> bool {
    return ((trail[level >> 5u] >> (level & 31u)) & 1u) != 0u;
}

fn set_done(level: u32, done: bool) {
    let bit = 1u << (level & 31u);
    let others = trail[level >> 5u] & ~bit;
    trail[level >> 5u] = others | select(0u, bit, done);
}

// Begins anew at the root, with the farther child at the deepest level that has one left. False if none has.
fn restart(descent: ptr<function, Descent>) -> bool {
    var level = (*descent).level;
    set_done(level, false);
    loop {
        if (level == 0u) {
            return false;
        }
        level -= 1u;
        if (!is_done(level)) {
            break;
        }
        set_done(level, false);
    }
    set_done(level, true);
    count_restart();
    *descent = Descent(read_node(0u).reference, 0u, level);
    return true;
}

// Goes down, nearer child first, to a leaf; false if none is left.
fn walk_to_leaf(ray: Ray, t: f32, descent: ptr<function, Descent>) -> bool {
    while (!is_leaf((*descent).node)) {
        count_inner();
        add_boxes(2u);
        let first = (*descent).node & INDEX;
        let left = read_node(first);
        let right = read_node(first + 1u);
        let l = ray_box(ray, left.lo, left.hi);
        let r = ray_box(ray, right.lo, right.hi);
        let hit_left = overlaps(l, t);
        let hit_right = overlaps(r, t);
        let level = (*descent).level;
        if (hit_left && hit_right) {
            let takes_right = (r.x < l.x) != is_done(level);
            (*descent).node = select(left.reference, right.reference, takes_right);
            (*descent).level = level + 1u;
        } else if ((hit_left || hit_right) && level != (*descent).pop_level) {
            set_done(level, true);
            (*descent).node = select(right.reference, left.reference, hit_left);
            (*descent).level = level + 1u;
        } else if (!restart(descent)) {
            return false;
        }
    }
    return true;
}

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    if (!alive) {
        return MISS;
    }
    var best = Best(limit, MISS);
    let wide = widened(ray);
    let root = read_node(0u);
    if (!overlaps(ray_box(wide, root.lo, root.hi), limit)) {
        return MISS;
    }
    for (var i = 0u; i < STACK_SIZE / 32u; i += 1u) {
        trail[i] = 0u;
    }
    var descent = Descent(root.reference, 0u, MISS);
    loop {
        if (!walk_to_leaf(wide, best.t, &descent)) {
            break;
        }
        count_leaf();
        if (test_triangles(ray, leaf_first(descent.node), leaf_count(descent.node), any, &best)) {
            break;
        }
        if (!restart(&descent)) {
            break;
        }
    }
    return best.triangle_ref;
}
