// The picture: direct light, and albedo / pi x irradiance. One invocation per pixel. Twin: src/workloads/splat/mix.rs.

//!include splat/list.wgsl

@group(0) @binding(0) var<uniform> list: List;
@group(0) @binding(1) var<storage, read> albedos: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> direct: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> irradiance: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> picture: array<vec4<f32>>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = list_index(group, local_index, list.row_groups);
    if (pixel < list.count) {
        picture[pixel] = direct[pixel] + albedos[pixel] * list.inverse_pi * irradiance[pixel];
    }
}
