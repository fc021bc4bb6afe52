// Trees of WIDTH children a node, one ray per invocation: children are visited in the order of their places, flipped by
// the signs of the ray's direction (Ylitie, Karras and Laine 2017). Twin: src/workloads/trace/wide/octants_stack.rs.
//
// An entry of the stack is a node and the children that are still to be visited: one entry a level, no distances.

//!include lib/independent.wgsl
//!include trace/wide/node.wgsl
//!include trace/bvh/widened.wgsl

var<private> stack: array<u32, STACK_SIZE>;
var<private> stack_hits: array<u32, STACK_SIZE>;

// The bits of a place that the ray's direction flips.
fn flipped_bits(direction: vec3<f32>) -> u32 {
    if (WIDTH == 4u) {
        let low = on_axis(direction, tree.axes & 3u) < 0.0;
        let high = on_axis(direction, tree.axes >> 2u) < 0.0;
        return u32(low) | (u32(high) << 1u);
    }
    return u32(direction.z < 0.0) | (u32(direction.y < 0.0) << 1u) | (u32(direction.x < 0.0) << 2u);
}

// The children that the ray meets before `t`, a bit for each by its place in the ray's order.
fn visit(ray: Ray, node: u32, t: f32, flips: u32) -> u32 {
    count_inner();
    var hits = 0u;
    for (var i = 0u; i < WIDTH; i += 1u) {
        let child = read_slot(node * WIDTH + i);
        if (child.reference != EMPTY) {
            count_box_test();
            if (overlaps(ray_box(ray, child.lo, child.hi), t)) {
                hits |= 1u << (i ^ flips);
            }
        }
    }
    return hits;
}

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    if (!alive) {
        return MISS;
    }
    var best = Best(limit, MISS);
    let wide = widened(ray);
    let root = read_root();
    if (root.reference == EMPTY || !overlaps(ray_box(wide, root.lo, root.hi), limit)) {
        return MISS;
    }
    let flips = flipped_bits(ray.direction);
    var next = root.reference;
    var node = 0u;
    var hits = 0u; // children of the node that are still to be visited
    var depth = 0u;
    loop {
        if (is_leaf(next)) {
            count_leaf();
            if (test_triangles(ray, leaf_first(next), leaf_count(next), any, &best)) {
                break;
            }
        } else {
            if (hits != 0u) {
                stack[depth] = node;
                stack_hits[depth] = hits;
                depth += 1u;
            }
            node = next;
            hits = visit(wide, node, best.t, flips);
        }
        if (hits == 0u) {
            if (depth == 0u) {
                break;
            }
            count_pop();
            depth -= 1u;
            node = stack[depth];
            hits = stack_hits[depth];
        }
        let place = firstTrailingBit(hits) ^ flips;
        hits &= hits - 1u;
        next = read_reference(node * WIDTH + place);
    }
    return best.triangle_ref;
}
