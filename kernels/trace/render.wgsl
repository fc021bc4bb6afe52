// One frame, or a band of its rows: ray generation, traversal, shading and secondary rays in one dispatch.
// One invocation per pixel, GROUP_WIDTH x GROUP_HEIGHT neighbouring pixels (8x8 as a rule) per work-group. Twin:
// src/workloads/trace/render.rs.

//!include trace/path.wgsl

// shade_primary(place, &path, triangle_ref): what follows from the nearest hit of a primary ray
//!slot secondary

@compute @workgroup_size(GROUP_SIZE)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) local_index: u32,
) {
    lane = local_index;
    let place = place_in_band(group);
    var path = start_path(place);
    if (path.alive) {
        begin_ray(PRIMARY);
    }
    shade_primary(place, &path, nearest_hit(path.ray, path.alive));
    if (is_in_band(place)) {
        store(pixel_index(place), path.first_triangle, path.first_t, rgba8(path.colour));
    }
}
