// A bit for each key that exists, in the last level of the masks. One invocation per pixel. Twin: `bits` of
// src/workloads/splat/clusters/unique.rs.

//!include splat/clusters/unique_job.wgsl

@group(0) @binding(1) var<storage, read> keys: array<u32>;
@group(0) @binding(2) var<storage, read_write> masks: array<atomic<u32>>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = list_index(group, local_index, job.row_groups);
    if (pixel >= job.count || keys[pixel] == 0xffffffffu) {
        return;
    }
    let key = keys[pixel];
    let word = job.first_word + (key >> 5u);
    let bit = 1u << (key & 31u);
    // Most samples find their bit set
    if ((atomicLoad(&masks[word]) & bit) == 0u) {
        atomicOr(&masks[word], bit);
    }
}
