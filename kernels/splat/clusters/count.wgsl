// The number of clusters, and the work-groups of dispatches over them. One invocation. Its twin is
// `Clusters::len` of src/workloads/splat/clusters/mod.rs.

struct CountJob {
    clusters: u32,   // most of them
    row_groups: u32, // most work-groups in a row
    pad0: u32,
    pad1: u32,
}

@group(0) @binding(0) var<uniform> job: CountJob;
@group(0) @binding(1) var<storage, read> total: array<u32>;
@group(0) @binding(2) var<storage, read_write> state: array<u32, 8>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    if (local_index + group.x + group.y > 0u) {
        return;
    }
    let clusters = min(total[0], job.clusters);
    let groups = (clusters + GROUP_SIZE - 1u) / GROUP_SIZE;
    state[0] = clusters;
    state[1] = 0u;
    state[2] = 0u;
    state[3] = 0u;
    state[4] = min(groups, job.row_groups);
    state[5] = (groups + job.row_groups - 1u) / job.row_groups;
    state[6] = 1u;
    state[7] = 0u;
}
