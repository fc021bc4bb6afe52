// Boxes of clusters by six atomic operations a sample. One invocation per pixel. Twin: `boxes` of
// src/workloads/splat/clusters/bounds.rs.

//!include splat/clusters/ordered.wgsl
//!include splat/clusters/unique_job.wgsl

@group(0) @binding(1) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> identifiers: array<u32>;
@group(0) @binding(3) var<storage, read_write> boxes: array<atomic<u32>>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = list_index(group, local_index, job.row_groups);
    if (pixel >= job.count || identifiers[pixel] >= job.clusters) {
        return;
    }
    let first = 6u * identifiers[pixel];
    let x = ordered(positions[pixel].x);
    let y = ordered(positions[pixel].y);
    let z = ordered(positions[pixel].z);
    atomicMin(&boxes[first], x);
    atomicMin(&boxes[first + 1u], y);
    atomicMin(&boxes[first + 2u], z);
    atomicMax(&boxes[first + 3u], x);
    atomicMax(&boxes[first + 4u], y);
    atomicMax(&boxes[first + 5u], z);
}
