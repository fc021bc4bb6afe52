// First pass of a staged frame, or of a band of its rows: all primary rays, and a list of the pixels whose paths go on
// in a mirror. One invocation per pixel, as in trace/render.wgsl. Twin: src/workloads/trace/staged.rs.

//!include trace/path.wgsl
//!include trace/staged/list.wgsl
//!include trace/staged/append.wgsl

@compute @workgroup_size(GROUP_SIZE)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) local_index: u32,
) {
    lane = local_index;
    let place = place_in_band(group);
    var path = start_path(place);
    if (path.alive) {
        _ = follow(PRIMARY, &path);
    }
    if (is_in_band(place)) {
        let pixel = pixel_index(place);
        store(pixel, path.first_triangle, path.first_t, rgba8(path.colour));
        if (path.alive) {
            append(pixel, path);
        }
    }
}
