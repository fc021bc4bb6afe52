// Every triangle: ground truth for small scenes. Twin: src/cpu/traverse/brute.rs.

//!include lib/alone.wgsl

fn nearest_hit(ray: Ray, alive: bool) -> u32 {
    var best = no_best();
    if (alive) {
        for (var i = 0u; i < structure.records; i += 1u) {
            count_test();
            test_record(ray, i, &best);
        }
    }
    return best.record;
}

fn any_hit(ray: Ray, limit: f32, alive: bool) -> bool {
    if (alive) {
        for (var i = 0u; i < structure.records; i += 1u) {
            count_test();
            if (record_blocks(ray, i, limit)) {
                return true;
            }
        }
    }
    return false;
}
