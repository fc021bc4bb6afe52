// Every triangle: ground truth for small scenes. Twin: src/workloads/trace/brute/scan.rs.

//!include lib/independent.wgsl

struct Brute {
    triangle_refs: u32,
    pad0: u32,
    pad1: u32,
    pad2: u32,
}

@group(0) @binding(7) var<uniform> brute: Brute;

// Software drivers end a loop after 65,535 turns (lavapipe), taking it for endless.
const RUN: u32 = 32768u;

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    var best = Best(limit, MISS);
    if (alive) {
        for (var first = 0u; first < brute.triangle_refs; first += RUN) {
            if (test_triangles(ray, first, min(RUN, brute.triangle_refs - first), any, &best)) {
                break;
            }
        }
    }
    return best.triangle_ref;
}
