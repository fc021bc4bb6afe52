// Rays from a light to the samples, which are at distance 1. One invocation per pixel. Twin:
// src/workloads/splat/shadow.rs.

//!include lib/geom.wgsl
//!include splat/list.wgsl
//!include splat/rays.wgsl

struct ShadowJob {
    light: vec3<f32>,
    reach: f32,      // how far from a sample rays start at most
    pixels: u32,
    row_groups: u32,
    pad0: u32,
    pad1: u32,
}

@group(0) @binding(0) var<uniform> job: ShadowJob;
@group(0) @binding(1) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> rays: array<TraceRay>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = list_index(group, local_index, job.row_groups);
    if (pixel >= job.pixels) {
        return;
    }
    let sample = positions[pixel];
    if (sample.w <= 0.0) {
        rays[pixel] = no_ray();
        return;
    }
    let way = job.light - sample.xyz;
    let distance = sqrt(dot3(way, way));
    let start = select(job.light, sample.xyz + way * (job.reach / distance), distance > job.reach);
    rays[pixel] = trace_ray(start, sample.xyz - start);
}
