// The number of keys of each word of bits: what the prefix sum makes places of. One invocation per word. Twin: `bits`
// of src/workloads/splat/clusters/unique.rs.

//!include splat/clusters/unique_job.wgsl

@group(0) @binding(1) var<storage, read> masks: array<u32>;
@group(0) @binding(2) var<storage, read_write> places: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let word = list_index(group, local_index, job.row_groups);
    if (word < job.count) {
        places[word] = countOneBits(masks[job.first_word + word]);
    }
}
