// How many of each worker's inner nodes have more triangles than a leaf may have. Twin:
// src/workloads/trace/build/tree.rs.

//!include trace/build/job.wgsl
//!include trace/build/radix_tree.wgsl

@group(0) @binding(2) var<storage, read_write> numbers: array<u32>;

@compute @workgroup_size(WORKER_GROUP)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x < job.workers) {
        let first = id.x * job.chunk;
        var number = 0u;
        for (var i = first; i < min(first + job.chunk, job.count); i += 1u) {
            number += select(0u, 1u, is_kept(i32(i)));
        }
        numbers[id.x] = number;
    }
}
