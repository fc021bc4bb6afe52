// How many photons there are, and work-groups for one invocation each. One invocation.

struct PhotonGroupsJob {
    slots: u32,      // most photons
    row_groups: u32, // most work-groups in a row of a dispatch
    pad0: u32,
    pad1: u32,
}

@group(0) @binding(0) var<uniform> job: PhotonGroupsJob;
@group(0) @binding(1) var<storage, read> photons: array<u32>; // the first word is their number
@group(0) @binding(2) var<storage, read_write> state: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(local_invocation_index) local_index: u32) {
    if (local_index > 0u) {
        return;
    }
    let count = min(photons[0], job.slots);
    let groups = (count + GROUP_SIZE - 1u) / GROUP_SIZE;
    state[0] = count;
    state[4] = min(groups, job.row_groups);
    state[5] = (groups + job.row_groups - 1u) / job.row_groups;
    state[6] = 1u;
}
