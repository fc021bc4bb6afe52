// The irradiance of each sample over the photons of its cluster. One invocation per pixel. Twin:
// src/workloads/splat/splatting/per_sample.rs.

//!include splat/splatting/gathered.wgsl

@group(0) @binding(9) var<storage, read_write> irradiance: array<vec4<f32>>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = list_index(group, local_index, job.row_groups);
    if (pixel >= job.pixels) {
        return;
    }
    var sum = vec3<f32>(0.0, 0.0, 0.0);
    let cluster = identifiers[pixel];
    if (cluster != NONE) {
        let sample = samples[pixel].xyz;
        let normal = normals[pixel].xyz;
        let end = min(offsets[cluster + 1u], job.capacity);
        for (var first = min(offsets[cluster], job.capacity); first < end; first += BLOCK) {
            sum += block_sum(sample, normal, first, min(first + BLOCK, end));
        }
    }
    irradiance[pixel] = vec4<f32>(sum, 0.0);
}
