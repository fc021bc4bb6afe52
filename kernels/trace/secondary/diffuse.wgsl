// One ray from the surface that the primary ray hits. The colour is that of the surface that this ray finds, ambient
// and diffuse, lit from where the ray comes from; or the background. Twin: src/workloads/trace/secondary.rs.

//!include trace/secondary/above.wgsl

const DIFFUSE: u32 = 4u;

fn shade_primary(place: vec2<u32>, path: ptr<function, Path>, triangle_ref: u32) {
    let surface = surface_of(PRIMARY, path, triangle_ref);
    if (!group_any((*path).alive)) {
        return;
    }
    if ((*path).alive) {
        begin_ray(DIFFUSE);
    }
    (*path).ray = ray_above(surface, place, 0u);
    let seen = surface_of(DIFFUSE, path, nearest_hit((*path).ray, (*path).alive));
    if ((*path).alive) {
        let material = read_material(seen.material);
        let cosine = max(-dot3(seen.normal, (*path).ray.direction), 0.0);
        (*path).colour = material.ambient + material.diffuse * cosine;
    }
}
