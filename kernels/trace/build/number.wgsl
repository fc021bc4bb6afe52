// Which inner nodes are no part of a leaf, the last one first: words for a prefix sum. Twin: `pairs` of
// src/workloads/trace/build/ploc.rs.

//!include trace/build/job.wgsl

@group(0) @binding(1) var<storage, read> triangles: array<u32>; // of each inner node
@group(0) @binding(2) var<storage, read_write> kept: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < job.count; i += job.stride) {
        kept[i] = select(0u, 1u, triangles[job.count - 1u - i] > job.max_leaf);
    }
}
