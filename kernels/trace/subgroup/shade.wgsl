// Second pass of a frame of packets: what follows from the nearest hits of primary rays, with secondary rays one by
// one. One invocation per pixel, as in trace/render.wgsl. Twin: src/workloads/trace/render.rs.

//!include trace/path.wgsl
//!slot update
//!slot secondary

@compute @workgroup_size(GROUP_SIZE)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) local_index: u32,
) {
    lane = local_index;
    let place = place_in_band(group);
    if (!is_in_band(place)) {
        return;
    }
    let pixel = pixel_index(place);
    var path = start_path(place);
    resume(pixel);
    shade_primary(place, &path, pixels[pixel].triangle);
    store(pixel, path.first_triangle, path.first_t, rgba8(path.colour));
}
