// Speculative while-while (Aila and Laine 2009): the first leaf is postponed, and the walk goes on to a second one
// before the triangles of both are tested. Rays that share an instruction stream leave the loop over nodes less often,
// for visits that a hit in the first leaf would have spared. Twin: src/workloads/trace/bvh/loops.rs.

//!include trace/bvh/pairs.wgsl

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    if (!alive) {
        return MISS;
    }
    var best = Best(limit, MISS);
    let wide = widened(ray);
    var walk = start_walk(wide, limit);
    loop {
        let t = select(limit, best.t, CULL);
        walk_to_leaf(wide, t, &walk);
        let postponed = walk.node;
        if (postponed == EMPTY) {
            break;
        }
        mark_turn();
        pop(t, &walk);
        walk_to_leaf(wide, t, &walk);
        count_leaf();
        if (test_triangles(ray, leaf_first(postponed), leaf_count(postponed), any, &best)) {
            break;
        }
        if (walk.node != EMPTY) {
            count_leaf();
            if (test_triangles(ray, leaf_first(walk.node), leaf_count(walk.node), any, &best)) {
                break;
            }
            pop(select(limit, best.t, CULL), &walk);
        }
    }
    return best.triangle_ref;
}
