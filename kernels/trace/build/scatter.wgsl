// Keys and triangles move to their places by one digit; those of equal digits keep their order. Twin of the sort:
// src/workloads/trace/build/codes.rs.

//!include trace/build/job.wgsl
//!include trace/build/digits.wgsl
//!slot order

@group(0) @binding(3) var<storage, read_write> sorted_keys: array<u32>;
@group(0) @binding(4) var<storage, read_write> sorted: array<u32>;

@compute @workgroup_size(WORKER_GROUP)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let worker = id.x;
    if (worker >= job.workers) {
        return;
    }
    let first = worker * job.chunk;
    for (var i = first; i < min(first + job.chunk, job.count); i += 1u) {
        let key = keys[i];
        let counter = digit_of(key) * job.workers + worker;
        let place = table[counter];
        table[counter] = place + 1u;
        sorted_keys[place] = key;
        sorted[place] = triangle_at(i);
    }
}
