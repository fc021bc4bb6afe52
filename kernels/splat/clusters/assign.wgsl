// The cluster of each sample, and the key of each cluster. One invocation per pixel. Twin: `assigned` of
// src/workloads/splat/clusters/unique.rs.

//!include splat/clusters/unique_job.wgsl
//!include splat/clusters/lookup.wgsl

@group(0) @binding(1) var<storage, read> keys: array<u32>;
@group(0) @binding(2) var<storage, read> places: array<u32>;
@group(0) @binding(3) var<storage, read> masks: array<u32>;
@group(0) @binding(4) var<storage, read_write> identifiers: array<u32>;
@group(0) @binding(5) var<storage, read_write> cluster_keys: array<u32>;

fn mask_at(word: u32) -> u32 {
    return masks[word];
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = list_index(group, local_index, job.row_groups);
    if (pixel >= job.count) {
        return;
    }
    let key = keys[pixel];
    var identifier = NONE;
    if (key != NONE) {
        identifier = identifier_of(key, job.first_word);
        if (identifier < job.clusters) {
            cluster_keys[identifier] = key; // all samples of the cluster store the same
        }
    }
    identifiers[pixel] = identifier;
}
