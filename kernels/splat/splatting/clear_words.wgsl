// The buckets of 64 clusters, or nodes, are cleared by a work-group: its invocations take consecutive words.

//!include splat/list.wgsl

@group(0) @binding(0) var<uniform> list: List; // count: clusters or nodes that there are buckets for
@group(0) @binding(1) var<storage, read> clusters: array<u32>; // the first word is their number
@group(0) @binding(2) var<storage, read_write> words: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local_index: u32,
) {
    var count = list.count;
    if (!NODES) {
        count = min(count, clusters[0]);
    }
    let first = list_index(group, 0u, groups.x);
    let end = min(first + GROUP_SIZE, count) * BUCKET_WORDS;
    for (var word = first * BUCKET_WORDS + local_index; word < end; word += GROUP_SIZE) {
        words[word] = 0u;
    }
}
