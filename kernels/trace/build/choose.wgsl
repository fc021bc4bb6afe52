// Which clusters remain, and which of them merge with a partner: words for prefix sums. Twin: `merge` of
// src/workloads/trace/build/ploc.rs.

//!include trace/build/job.wgsl

@group(0) @binding(1) var<storage, read> partners: array<u32>;
@group(0) @binding(2) var<storage, read_write> remaining: array<u32>;
@group(0) @binding(3) var<storage, read_write> merging: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < job.count; i += job.stride) {
        let partner = partners[i];
        let is_mutual = partner != i && partners[partner] == i;
        remaining[i] = select(1u, 0u, is_mutual && partner < i);
        merging[i] = select(0u, 1u, is_mutual && i < partner);
    }
}
