// The light of one lamp, added to the direct light of the samples that it reaches. One invocation per pixel. Twin:
// src/workloads/splat/direct.rs.

//!include lib/geom.wgsl
//!include splat/list.wgsl
//!include splat/rays.wgsl

struct DirectJob {
    light: vec3<f32>,
    pixels: u32,
    intensity: vec3<f32>,
    row_groups: u32,
    influence2: f32, // square of the radius of influence
    inverse_pi: f32,
    one: f32,
    is_first: u32,   // of the frame's lamps
}

struct Sample {
    way: vec3<f32>,  // to the light
    square: f32,     // of the way's length
    normal: vec3<f32>,
    albedo: vec3<f32>,
}

const SQUARE_MIN: f32 = 1.0e-30; // below it the light is at the sample itself

@group(0) @binding(0) var<uniform> job: DirectJob;
@group(0) @binding(1) var<storage, read> shadows: array<TraceHit>;
@group(0) @binding(2) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> normals: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> albedos: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> direct: array<vec4<f32>>;

// light_of(sample, pixel)
//!slot falloff

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = list_index(group, local_index, job.row_groups);
    if (pixel >= job.pixels) {
        return;
    }
    var light = vec3<f32>(0.0, 0.0, 0.0);
    if (job.is_first == 0u) {
        light = direct[pixel].xyz;
    }
    let position = positions[pixel];
    if (position.w > 0.0 && shadows[pixel].triangle == MISS) {
        let way = job.light - position.xyz;
        light += light_of(Sample(way, dot3(way, way), normals[pixel].xyz, albedos[pixel].xyz), pixel);
    }
    direct[pixel] = vec4<f32>(light, 0.0);
}
