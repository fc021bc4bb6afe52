// One value for a range of words, which a frame must not find as the frame before left them. FILLED words for each
// invocation.

//!include splat/list.wgsl

struct FillJob {
    first: u32,
    count: u32,
    value: u32,
    row_groups: u32,
}

@group(0) @binding(0) var<uniform> job: FillJob;
@group(0) @binding(1) var<storage, read_write> words: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let first = list_index(group, 0u, job.row_groups) * FILLED;
    for (var i = 0u; i < FILLED; i += 1u) {
        let index = first + i * GROUP_SIZE + local_index;
        if (index < job.count) {
            words[job.first + index] = job.value;
        }
    }
}
