// If-if (Aila and Laine 2009): one loop, in each turn a step down if the ray is at an inner node, and one triangle if
// it is at a leaf. Twin: src/workloads/trace/bvh/loops.rs.

//!include trace/bvh/pairs.wgsl

// Triangle references of a leaf that are yet to be tested.
struct Rest {
    next: u32,
    end: u32,
}

// Of the node that the walk has come to.
fn rest_of(node: u32) -> Rest {
    if (!is_leaf(node) || node == EMPTY) {
        return Rest(0u, 0u);
    }
    count_leaf();
    return Rest(leaf_first(node), leaf_first(node) + leaf_count(node));
}

// Software drivers end a loop after 65,535 turns (lavapipe), taking it for endless.
const TURNS: u32 = 32768u;

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    if (!alive) {
        return MISS;
    }
    var best = Best(limit, MISS);
    let wide = widened(ray);
    var walk = start_walk(wide, limit);
    var rest = rest_of(walk.node);
    while (walk.node != EMPTY) {
        for (var turn = 0u; turn < TURNS && walk.node != EMPTY; turn += 1u) {
            if (!is_leaf(walk.node)) {
                step_down(wide, select(limit, best.t, CULL), &walk);
                rest = rest_of(walk.node);
            }
            if (rest.next < rest.end) {
                if (test_triangles(ray, rest.next, 1u, any, &best)) {
                    return best.triangle_ref;
                }
                rest.next += 1u;
                if (rest.next == rest.end) {
                    pop(select(limit, best.t, CULL), &walk);
                    rest = rest_of(walk.node);
                }
            }
        }
    }
    return best.triangle_ref;
}
