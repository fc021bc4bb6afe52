// Every triangle: ground truth for small scenes. Twin: src/workloads/trace/brute/scan.rs.

//!include lib/independent.wgsl

// Two loops, because software drivers end a single one after 65,535 turns (lavapipe), taking it for endless.
const RUN: u32 = 32768u;

fn nearest_hit(ray: Ray, alive: bool) -> u32 {
    var best = no_best();
    if (alive) {
        for (var first = 0u; first < structure.triangle_refs; first += RUN) {
            for (var i = first; i < min(first + RUN, structure.triangle_refs); i += 1u) {
                count_test();
                test_triangle(ray, i, &best);
            }
        }
    }
    return best.triangle_ref;
}

fn any_hit(ray: Ray, limit: f32, alive: bool) -> bool {
    if (alive) {
        for (var first = 0u; first < structure.triangle_refs; first += RUN) {
            for (var i = first; i < min(first + RUN, structure.triangle_refs); i += 1u) {
                count_test();
                if (triangle_occludes(ray, i, limit)) {
                    return true;
                }
            }
        }
    }
    return false;
}
