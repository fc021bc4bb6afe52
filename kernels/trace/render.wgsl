// One frame, or a band of its rows: ray generation, traversal, shading and secondary rays in one dispatch.
// One invocation per pixel, GROUP_WIDTH x GROUP_HEIGHT neighbouring pixels (8x8 as a rule) per work-group. Twin:
// src/workloads/trace/render.rs.

//!include trace/pixel.wgsl

@compute @workgroup_size(GROUP_SIZE)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) local_index: u32,
) {
    lane = local_index;
    render_pixel(place_in_band(group));
}
