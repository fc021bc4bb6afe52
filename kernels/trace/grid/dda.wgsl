// Uniform grid: 3D-DDA after Fujimoto et al. 1986 and Amanatides and Woo 1987. Twin: src/workloads/trace/grid/dda.rs.

//!include lib/independent.wgsl
//!include trace/grid/walk.wgsl

fn nearest_hit(ray: Ray, alive: bool) -> u32 {
    var best = no_best();
    if (!alive) {
        return MISS;
    }
    var walk = start_walk(ray, T_MAX);
    if (!walk.inside) {
        return MISS;
    }
    loop {
        var way = OUTSIDE;
        loop {
            // Test everything in this cell
            count_inner();
            let cell = read_cell(walk.cell);
            for (var i = cell.x; i < cell.x + cell.y; i += 1u) {
                count_test();
                test_triangle(ray, i, &best);
            }
            // A hit ends the search only inside this cell: in front of a farther one something nearer may lie. At the very
            // border the next cell may hold a triangle at the same distance with a lower index.
            let border = nearest_border(walk);
            if (best.t < border.t) {
                break;
            }
            way = advance(ray, border, &walk);
            if (way != INSIDE) {
                break;
            }
        }
        if (way != TIED || !cross_borders(ray, &walk, &best)) {
            break;
        }
    }
    return best.triangle_ref;
}

fn any_hit(ray: Ray, limit: f32, alive: bool) -> bool {
    if (!alive) {
        return false;
    }
    var walk = start_walk(ray, limit);
    if (!walk.inside) {
        return false;
    }
    var best = no_best(); // of the cells between tied borders
    loop {
        var way = OUTSIDE;
        loop {
            count_inner();
            let cell = read_cell(walk.cell);
            for (var i = cell.x; i < cell.x + cell.y; i += 1u) {
                count_test();
                if (triangle_occludes(ray, i, limit)) {
                    return true;
                }
            }
            let border = nearest_border(walk);
            if (border.t > limit) {
                return false;
            }
            way = advance(ray, border, &walk);
            if (way != INSIDE) {
                break;
            }
        }
        if (way != TIED || !cross_borders(ray, &walk, &best) || best.t < limit) {
            break;
        }
    }
    return best.t < limit;
}
