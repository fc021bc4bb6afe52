// Which inner nodes of the binary radix tree have more triangles than a leaf: words for a prefix sum. Twin:
// src/workloads/trace/build/tree.rs.

//!include trace/build/job.wgsl
//!include trace/build/radix_tree.wgsl

@group(0) @binding(2) var<storage, read_write> flags: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var index = id.x; index < job.count; index += job.stride) {
        let i = i32(index);
        let key = keys[i];
        let side = side_of(key, i);
        let end = i + i32(job.max_leaf) * side.step;
        flags[index] = select(0u, 1u, common_bits(key, i, end) > side.least);
    }
}
