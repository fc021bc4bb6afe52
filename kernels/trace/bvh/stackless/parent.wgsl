// BVH without a stack (Hapala et al. 2011): links lead back to parents. Twin:
// src/workloads/trace/bvh/stackless/parent.rs.
//
// Which child comes first follows from the ray's direction alone, so that it is known again on the way back: a node
// that is the nearer one leads to its sibling, the farther one to its parent.

//!include lib/independent.wgsl
//!include trace/bvh/stackless/node.wgsl

// Where a search stands.
struct Place {
    index: u32,     // of the node; MISS after the last one
    reference: u32, // of the leaf that was found
}

// The node that comes after `index` and all below it: the nearest sibling that is yet to be tested, or MISS.
fn after(ray: Ray, index: u32) -> u32 {
    var node = index;
    while (node != 0u) {
        let link = read_link(node);
        if ((node & 1u) == nearer(ray, order_of(link))) {
            return node ^ 1u;
        }
        count_rope();
        node = link & INDEX;
    }
    return MISS;
}

// The first leaf from a node on whose box begins before `t`.
fn next_leaf(ray: Ray, t: f32, start: u32) -> Place {
    var index = start;
    while (index != MISS) {
        mark_turn();
        let node = read_node(index);
        if (index != 0u) {
            count_box_test();
        }
        if (!overlaps(ray_box(ray, node.lo, node.hi), t)) {
            index = after(ray, index);
        } else if (is_leaf(node.reference)) {
            return Place(index, node.reference);
        } else {
            count_inner();
            index = (node.reference & INDEX) + nearer(ray, order_of(node.reference));
        }
    }
    return Place(MISS, EMPTY);
}

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    if (!alive) {
        return MISS;
    }
    var best = Best(limit, MISS);
    let wide = widened(ray);
    var place = next_leaf(wide, limit, 0u);
    while (place.index != MISS) {
        count_leaf();
        if (test_triangles(ray, leaf_first(place.reference), leaf_count(place.reference), any, &best)) {
            break;
        }
        place = next_leaf(wide, best.t, after(wide, place.index));
    }
    return best.triangle_ref;
}
