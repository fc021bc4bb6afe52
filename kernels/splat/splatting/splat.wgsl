// Photons on their way to clusters: what a photon touches is counted, listed, or gets its flux. One invocation per
// photon. Twins: src/workloads/splat/splatting/lists.rs and buckets.rs.

//!include splat/list.wgsl
//!include splat/splatting/walk.wgsl
//!slot visit
//!slot walk

@compute @workgroup_size(GROUP_SIZE)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local_index: u32,
) {
    let index = list_index(group, local_index, groups.x);
    if (index < min(state[0], job.slots)) {
        let photon = photon_of(index);
        begin(photon);
        walk(photon);
    }
}
