// Bounding interval hierarchy, one ray per invocation with a private stack, nearer child first (Wächter and Keller
// 2006). Twin: src/workloads/trace/bih/stack.rs.
//
// A node has two planes on one axis: where its lower child ends, and where its upper child begins. Between them may be
// a gap, through which a ray goes without entering either child.

//!include lib/independent.wgsl

struct Bih {
    bounds_min: vec3<f32>,
    pad0: u32,
    bounds_max: vec3<f32>,
    pad1: u32,
}

@group(0) @binding(7) var<uniform> tree: Bih;

var<private> stack: array<u32, STACK_SIZE>; // nodes to visit
var<private> stack_min: array<f32, STACK_SIZE>; // the part of the ray inside
var<private> stack_max: array<f32, STACK_SIZE>;

struct Walk {
    node: u32,
    t_min: f32,
    t_max: f32,
    depth: u32, // entries on the stack
    done: bool,
}

// A node's three words, packed by src/workloads/trace/bih/layout.rs. Two nodes share three texels.
fn read_node(i: u32) -> vec3<u32> {
    let place = i * 3u / 2u;
    let first = read_node8(place);
    let second = read_node8(place + 1u);
    return select(vec3<u32>(first, second.x), vec3<u32>(first.y, second), (i & 1u) == 1u);
}

fn is_leaf(node: vec3<u32>) -> bool {
    return (node.x & 3u) == 3u;
}

fn start_walk(ray: Ray, limit: f32) -> Walk {
    let interval = ray_box(ray, tree.bounds_min, tree.bounds_max);
    let t_min = max(interval.x, 0.0);
    let t_max = min(interval.y, limit);
    return Walk(0u, t_min, t_max, 0u, !(interval.x <= interval.y && t_min <= t_max));
}

// Takes the next node that the ray enters before `t`, if there is any.
fn pop(t: f32, walk: ptr<function, Walk>) {
    while ((*walk).depth > 0u) {
        count_pop();
        (*walk).depth -= 1u;
        let top = (*walk).depth;
        if (stack_min[top] <= t) {
            (*walk).node = stack[top];
            (*walk).t_min = stack_min[top];
            (*walk).t_max = min(stack_max[top], t);
            return;
        }
    }
    (*walk).done = true;
}

// Goes one inner node down, or to the next node of the stack where the ray enters neither child.
fn descend(ray: Ray, node: vec3<u32>, t: f32, walk: ptr<function, Walk>) {
    let axis = node.x & 3u;
    let inv = on_axis(ray.inv_direction, axis);
    // Distances to where the lower child ends and where the upper one begins, as in ray_box
    let t_low = (bitcast<f32>(node.y) - on_axis(ray.origin_max, axis)) * inv;
    let t_high = (bitcast<f32>(node.z) - on_axis(ray.origin_min, axis)) * inv;
    let backwards = inv < 0.0;
    let near_end = min((*walk).t_max, select(t_low, t_high, backwards));
    let far_begin = max((*walk).t_min, select(t_high, t_low, backwards));
    let near = (node.x >> 2u) + u32(backwards);
    let far = (node.x >> 2u) + u32(!backwards);
    let enters_near = (*walk).t_min <= near_end;
    let enters_far = far_begin <= (*walk).t_max;
    if (enters_near) {
        if (enters_far) {
            stack[(*walk).depth] = far;
            stack_min[(*walk).depth] = far_begin;
            stack_max[(*walk).depth] = (*walk).t_max;
            (*walk).depth += 1u;
        }
        (*walk).node = near;
        (*walk).t_max = near_end;
    } else if (enters_far) {
        (*walk).node = far;
        (*walk).t_min = far_begin;
    } else {
        count_skip();
        pop(t, walk);
    }
}

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    if (!alive) {
        return MISS;
    }
    var best = Best(limit, MISS);
    var walk = start_walk(ray, limit);
    while (!walk.done) {
        let node = read_node(walk.node);
        if (is_leaf(node)) {
            count_leaf();
            if (test_triangles(ray, node.x >> 2u, node.y, any, &best)) {
                break;
            }
            pop(best.t, &walk);
        } else {
            count_inner();
            descend(ray, node, best.t, &walk);
        }
    }
    return best.triangle_ref;
}
