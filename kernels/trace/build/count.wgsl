// How many keys of each worker have each digit. Twin of the sort: src/workloads/trace/build/codes.rs.

//!include trace/build/job.wgsl
//!include trace/build/digits.wgsl

@compute @workgroup_size(WORKER_GROUP)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let worker = id.x;
    if (worker >= job.workers) {
        return;
    }
    for (var digit = 0u; digit < DIGITS; digit += 1u) {
        table[digit * job.workers + worker] = 0u;
    }
    let first = worker * job.chunk;
    for (var i = first; i < min(first + job.chunk, job.count); i += 1u) {
        table[digit_of(keys[i]) * job.workers + worker] += 1u;
    }
}
