// The inner nodes that are kept, one after another. Twin: src/workloads/trace/build/lbvh.rs.

//!include trace/build/job.wgsl

@group(0) @binding(1) var<storage, read> ranks: array<u32>; // nodes that are kept before each, and their number
@group(0) @binding(2) var<storage, read_write> kept: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < job.count; i += job.stride) {
        let rank = ranks[i];
        if (ranks[i + 1u] != rank) {
            kept[rank] = i;
        }
    }
}
