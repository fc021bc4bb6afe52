// The irradiance of samples, task by task: an invocation takes the next sample's block of photons until there is none.
// Twin: src/workloads/splat/splatting/per_sample.rs, but for the order of blocks.

//!include splat/splatting/gathered.wgsl

@group(0) @binding(9) var<storage, read> tasks: array<u32>; // tasks of the samples before each, and of all
@group(0) @binding(10) var<storage, read_write> next: atomic<u32>;
@group(0) @binding(11) var<storage, read_write> irradiance: array<atomic<u32>>;

// The last sample whose tasks begin at this one or before.
fn sample_of(task: u32) -> u32 {
    var low = 0u;
    var high = job.pixels;
    while (high - low > 1u) {
        let middle = (low + high) / 2u;
        if (tasks[middle] <= task) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

fn add(at: u32, part: f32) {
    if (part > 0.0) {
        var before = atomicLoad(&irradiance[at]);
        loop {
            let sum = bitcast<u32>(bitcast<f32>(before) + part);
            let result = atomicCompareExchangeWeak(&irradiance[at], before, sum);
            if (result.exchanged) {
                break;
            }
            before = result.old_value;
        }
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn main() {
    let count = tasks[job.pixels];
    loop {
        let task = atomicAdd(&next, 1u);
        if (task >= count) {
            break;
        }
        let pixel = sample_of(task);
        let cluster = identifiers[pixel];
        if (cluster == NONE) {
            continue;
        }
        let begin = min(offsets[cluster], job.capacity);
        let end = min(offsets[cluster + 1u], job.capacity);
        let first = min(begin + (task - tasks[pixel]) * BLOCK, end);
        let sum = block_sum(samples[pixel].xyz, normals[pixel].xyz, first, min(first + BLOCK, end));
        add(4u * pixel, sum.x);
        add(4u * pixel + 1u, sum.y);
        add(4u * pixel + 2u, sum.z);
    }
}
