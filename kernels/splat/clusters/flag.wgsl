// A flag for each key that exists: what the prefix sum makes identifiers of. One invocation per pixel. Twin: `flags` of
// src/workloads/splat/clusters/unique.rs.

//!include splat/clusters/unique_job.wgsl

@group(0) @binding(1) var<storage, read> keys: array<u32>;
@group(0) @binding(2) var<storage, read_write> places: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = list_index(group, local_index, job.row_groups);
    if (pixel < job.count && keys[pixel] != 0xffffffffu) {
        places[keys[pixel]] = 1u; // all store the same
    }
}
