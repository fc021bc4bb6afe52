// The tasks of each sample: blocks of its cluster's list. Sums of samples and the queue begin at 0. One invocation per
// pixel, and one more for the end of the last one's tasks.

//!include splat/list.wgsl

struct TasksJob {
    pixels: u32,
    row_groups: u32,
    capacity: u32, // entries that there is room for
    pad: u32,
}

@group(0) @binding(0) var<uniform> job: TasksJob;
@group(0) @binding(1) var<storage, read> identifiers: array<u32>;
@group(0) @binding(2) var<storage, read> offsets: array<u32>;
@group(0) @binding(3) var<storage, read_write> tasks: array<u32>;
@group(0) @binding(4) var<storage, read_write> next: array<u32>;
@group(0) @binding(5) var<storage, read_write> irradiance: array<vec4<f32>>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = list_index(group, local_index, job.row_groups);
    if (pixel > job.pixels) {
        return;
    }
    if (pixel == job.pixels) {
        tasks[pixel] = 0u;
        next[0] = 0u;
        return;
    }
    var blocks = 0u;
    let cluster = identifiers[pixel];
    if (cluster != NONE) {
        let first = min(offsets[cluster], job.capacity);
        let end = min(offsets[cluster + 1u], job.capacity);
        blocks = (max(end, first) - first + BLOCK - 1u) / BLOCK;
    }
    tasks[pixel] = blocks;
    irradiance[pixel] = vec4<f32>(0.0, 0.0, 0.0, 0.0);
}
