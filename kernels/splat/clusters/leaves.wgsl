// The last level of the masks: a bit for each key that exists. One invocation per cluster. Twin:
// src/workloads/splat/clusters/hierarchy.rs.

//!include splat/clusters/unique_job.wgsl

@group(0) @binding(1) var<storage, read> state: array<u32, 8>; // the first is the number of clusters
@group(0) @binding(2) var<storage, read> cluster_keys: array<u32>;
@group(0) @binding(3) var<storage, read_write> masks: array<atomic<u32>>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let cluster = list_index(group, local_index, job.row_groups);
    if (cluster < min(state[0], job.clusters)) {
        let key = cluster_keys[cluster];
        atomicOr(&masks[job.first_word + (key >> 5u)], 1u << (key & 31u));
    }
}
