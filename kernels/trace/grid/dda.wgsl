// Uniform grid: 3D-DDA after Fujimoto et al. 1986 and Amanatides and Woo 1987. Twin: src/workloads/trace/grid/dda.rs.

//!include lib/independent.wgsl
//!include trace/grid/walk.wgsl

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    if (!alive) {
        return MISS;
    }
    var walk = start_walk(ray, limit);
    if (!walk.inside) {
        return MISS;
    }
    var best = Best(limit, MISS);
    loop {
        var step = OUTSIDE;
        loop {
            count_inner();
            let cell = read_cell(walk.cell);
            if (test_triangles(ray, cell.x, cell.y, any, &best)) {
                break;
            }
            // A hit ends the search only inside this cell: in front of a farther one something nearer may lie. At the
            // very border the next cell may hold a triangle at the same distance with a lower index.
            let border = nearest_border(walk);
            if (best.t < border.t) {
                break;
            }
            step = advance(ray, border, &walk);
            if (step != INSIDE) {
                break;
            }
        }
        if (step != TIED || !cross_borders(ray, &walk, &best) || (any && best.triangle_ref != MISS)) {
            break;
        }
    }
    return best.triangle_ref;
}
