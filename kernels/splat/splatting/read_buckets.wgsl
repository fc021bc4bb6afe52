// The irradiance of each sample by the sums of its cluster. One invocation per pixel. Twin: `irradiance` of
// src/workloads/splat/splatting/buckets.rs.

//!include lib/geom.wgsl
//!include splat/list.wgsl
//!include splat/random.wgsl

struct ReadJob {
    pixels: u32,
    row_groups: u32,
    capacity: u32, // clusters or nodes that there are buckets for
    shift: u32,    // of a cluster's key to its node
    factor: f32,   // on the sum over directions
    pad0: u32,
    pad1: u32,
    pad2: u32,
    directions: array<vec4<f32>, 54>, // unit vectors
}

@group(0) @binding(0) var<uniform> job: ReadJob;
@group(0) @binding(1) var<storage, read> normals: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> identifiers: array<u32>;
@group(0) @binding(3) var<storage, read> cluster_keys: array<u32>;
@group(0) @binding(4) var<storage, read> words: array<u32>;
@group(0) @binding(5) var<storage, read> state: array<u32>; // the second word is the bits of the scale
@group(0) @binding(6) var<storage, read_write> irradiance: array<vec4<f32>>;

fn value(at: u32) -> f32 {
    if (FIXED) {
        return f32(words[at]);
    }
    return bitcast<f32>(words[at]);
}

fn of_sample(cluster: u32, normal: vec3<f32>) -> vec3<f32> {
    var place = cluster;
    if (NODES) {
        place = cluster_keys[cluster] >> job.shift;
    }
    var sum = vec3<f32>(0.0, 0.0, 0.0);
    if (place >= job.capacity) {
        return sum;
    }
    for (var direction = 0u; direction < 54u; direction += 1u) {
        let facing = dot3(normal, job.directions[direction].xyz);
        if (facing > 0.0) {
            let at = place * BUCKET_WORDS + 3u * direction;
            sum += flushed(vec3<f32>(value(at), value(at + 1u), value(at + 2u)) * (2.0 * facing));
        }
    }
    if (FIXED) {
        let scale = bitcast<f32>(state[1]);
        if (scale == 0.0) {
            return vec3<f32>(0.0, 0.0, 0.0);
        }
        sum = sum / scale;
    }
    return flushed(flushed(sum) * job.factor);
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = list_index(group, local_index, job.row_groups);
    if (pixel >= job.pixels) {
        return;
    }
    var sum = vec3<f32>(0.0, 0.0, 0.0);
    let cluster = identifiers[pixel];
    if (cluster != NONE) {
        sum = of_sample(cluster, normals[pixel].xyz);
    }
    irradiance[pixel] = vec4<f32>(sum, 0.0);
}
