// Boxes of clusters that contain nothing. One invocation per cluster. Twin: `boxes` of
// src/workloads/splat/clusters/bounds.rs.

//!include splat/clusters/unique_job.wgsl

@group(0) @binding(1) var<storage, read> state: array<u32, 8>; // the first is the number of clusters
@group(0) @binding(2) var<storage, read_write> boxes: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let cluster = list_index(group, local_index, job.row_groups);
    if (cluster >= min(state[0], job.clusters)) {
        return;
    }
    for (var i = 0u; i < 6u; i += 1u) {
        boxes[6u * cluster + i] = select(0u, 0xffffffffu, i < 3u);
    }
}
