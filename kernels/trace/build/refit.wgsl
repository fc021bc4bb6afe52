// The boxes of one level of inner nodes. A node whose last child gets its box here is put on the list of the next
// level. Twin: src/workloads/trace/build/lbvh.rs.

//!include trace/build/refit_node.wgsl

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = atomicLoad(&lengths[job.level]);
    for (var i = id.x; i < count; i += job.stride) {
        let parent = refit(list[i], job.level + 1u);
        if (parent != NONE) {
            next[atomicAdd(&lengths[job.level + 1u], 1u)] = parent;
        }
    }
}
