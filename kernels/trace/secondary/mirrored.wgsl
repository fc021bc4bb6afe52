// Light and shadow rays, and with BOUNCES the segments that follow in mirrors. Twin: src/workloads/trace/secondary.rs.

fn shade_primary(place: vec2<u32>, path: ptr<function, Path>, triangle_ref: u32) {
    if (!follow_hit(PRIMARY, path, triangle_ref)) {
        return;
    }
    for (var bounce = 1u; bounce <= BOUNCES; bounce += 1u) {
        if (!group_any((*path).alive) || !follow(REFLECTED, path)) {
            break;
        }
    }
}
