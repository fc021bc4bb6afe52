// The reference estimate of indirect light: every sample over all photons. One invocation per pixel. Twin:
// src/workloads/splat/estimate.rs.

//!include lib/geom.wgsl
//!include splat/list.wgsl
//!include splat/random.wgsl

struct EstimateJob {
    first_pixel: u32, // of this dispatch
    end_pixel: u32,
    row_groups: u32,
    slots: u32,       // most photons
    radius2: f32,     // square of the radius
    peak: f32,        // the kernel's value at distance 0
    one: f32,
    pad: u32,
}

@group(0) @binding(0) var<uniform> job: EstimateJob;
@group(0) @binding(1) var<storage, read> samples: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> normals: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> directions: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluxes: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> photons: array<u32>; // the first word is their number
@group(0) @binding(7) var<storage, read_write> irradiance: array<vec4<f32>>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = job.first_pixel + list_index(group, local_index, job.row_groups);
    if (pixel >= job.end_pixel) {
        return;
    }
    var sum = vec3<f32>(0.0, 0.0, 0.0);
    let sample = samples[pixel];
    if (sample.w > 0.0) {
        let normal = normals[pixel].xyz;
        let count = min(photons[0], job.slots);
        // A sum for each block of photons first: in single precision one sum of all would lose too much
        for (var first = 0u; first < count; first += BLOCK) {
            let end = min(first + BLOCK, count);
            var block = vec3<f32>(0.0, 0.0, 0.0);
            for (var i = first; i < end; i += 1u) {
                let way = positions[i].xyz - sample.xyz;
                let square = dot3(way, way);
                if (square < job.radius2) {
                    let facing = -dot3(normal, directions[i].xyz);
                    if (facing > 0.0) {
                        var share = job.peak;
                        if (!CONSTANT_KERNEL) {
                            share = job.peak * (job.one - square / job.radius2);
                        }
                        if (COSINE_WEIGHT) {
                            share = facing * share;
                        }
                        block += flushed(fluxes[i].xyz * share);
                    }
                }
            }
            sum += block;
        }
    }
    irradiance[pixel] = vec4<f32>(sum, 0.0);
}
