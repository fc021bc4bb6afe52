// While-while (Aila and Laine 2009): two loops alternate, down to a leaf, then through its triangles. Where several
// rays share an instruction stream, none of them pays for both in every step. walk_to_leaf goes down. Twin:
// src/workloads/trace/bvh/stack.rs.
//
// Without CULL, boxes are compared with the ray's limit only, and never with a hit.

//!include trace/bvh/private_stack.wgsl

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    if (!alive) {
        return MISS;
    }
    var best = Best(limit, MISS);
    let wide = widened(ray);
    var walk = start_walk(wide, limit);
    loop {
        walk_to_leaf(wide, select(limit, best.t, CULL), &walk);
        if (walk.node == EMPTY) {
            break;
        }
        count_leaf();
        if (test_triangles(ray, leaf_first(walk.node), leaf_count(walk.node), any, &best)) {
            break;
        }
        pop(select(limit, best.t, CULL), &walk);
    }
    return best.triangle_ref;
}
