// The boxes of one level of inner nodes. A node whose last child gets its box here is put on the list of the next level.
// Twin: src/workloads/trace/build/lbvh.rs.

//!include trace/build/job.wgsl
//!include trace/build/ordered.wgsl
//!include trace/build/lists.wgsl

@group(0) @binding(1) var<storage, read> list: array<u32>;

fn box_of(node: u32) -> Box {
    return Box(ordered(nodes[node * 2u].xyz), ordered(nodes[node * 2u + 1u].xyz));
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = atomicLoad(&lengths[job.level]);
    for (var i = id.x; i < count; i += job.stride) {
        let rank = list[i];
        let pair = 2u + 2u * rank;
        let box = around(box_of(pair), box_of(pair + 1u));
        let slot = slots[rank];
        nodes[slot * 2u] = vec4<u32>(floats(box.lo), pair);
        nodes[slot * 2u + 1u] = vec4<u32>(floats(box.hi), 0u);
        if (slot > 0u) {
            let parent = slot / 2u - 1u;
            if (atomicSub(&waiting[parent], 1u) == 1u) {
                next[atomicAdd(&lengths[job.level + 1u], 1u)] = parent;
            }
        }
    }
}
