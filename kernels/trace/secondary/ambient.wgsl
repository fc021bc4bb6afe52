// Ambient occlusion: AMBIENT_RAYS rays from the surface that the primary ray hits, which end at the first hit or at a
// tenth of the scene's diagonal. The colour is the share of them that hits nothing. Twin:
// src/workloads/trace/secondary.rs.

//!include trace/secondary/above.wgsl

const AMBIENT: u32 = 3u;

fn shade_primary(place: vec2<u32>, path: ptr<function, Path>, triangle_ref: u32) {
    let surface = surface_of(PRIMARY, path, triangle_ref);
    if (!group_any((*path).alive)) {
        return;
    }
    var open = 0u; // rays that hit nothing
    for (var i = 0u; i < AMBIENT_RAYS; i += 1u) {
        if ((*path).alive) {
            begin_ray(AMBIENT);
        }
        if (!any_hit(ray_above(surface, place, i), frame.ambient_reach, (*path).alive)) {
            open += 1u;
        }
    }
    if ((*path).alive) {
        (*path).colour = vec3<f32>(f32(open) * (1.0 / f32(AMBIENT_RAYS)));
    }
}
