// The inner nodes that are kept, one after another. Twin: src/workloads/trace/build/lbvh.rs.

//!include trace/build/job.wgsl
//!include trace/build/radix_tree.wgsl

@group(0) @binding(2) var<storage, read> places: array<u32>; // nodes that are kept before those of each worker
@group(0) @binding(3) var<storage, read_write> kept: array<u32>;

@compute @workgroup_size(WORKER_GROUP)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x < job.workers) {
        let first = id.x * job.chunk;
        var place = places[id.x];
        for (var i = first; i < min(first + job.chunk, job.count); i += 1u) {
            if (is_kept(i32(i))) {
                kept[place] = i;
                place += 1u;
            }
        }
    }
}
