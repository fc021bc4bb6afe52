// Rays from the camera. One invocation per pixel. Twin: src/workloads/splat/camera.rs.

//!include lib/geom.wgsl
//!include splat/list.wgsl
//!include splat/rays.wgsl
//!include splat/view.wgsl

@group(0) @binding(1) var<storage, read_write> rays: array<TraceRay>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = list_index(group, local_index, view.row_groups);
    if (pixel >= view.pixels) {
        return;
    }
    let x = f32(pixel % view.width) + 0.5;
    let y = f32(pixel / view.width) + 0.5;
    rays[pixel] = trace_ray(view.origin, normalize3(view.corner + view.right * x + view.down * y));
}
