// The most that any frame needed since this was cleared. One invocation.

struct NeedsJob {
    of_lists: u32, // 1 for entries of lists, 0 for clusters with buckets
    pad0: u32,
    pad1: u32,
    pad2: u32,
}

@group(0) @binding(0) var<uniform> job: NeedsJob;
@group(0) @binding(1) var<storage, read> found: array<u32>; // entries and whether their sum wrapped, or clusters
@group(0) @binding(2) var<storage, read_write> needs: array<u32>; // most entries, if any sum wrapped, most clusters

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(local_invocation_index) local_index: u32) {
    if (local_index > 0u) {
        return;
    }
    if (job.of_lists == 1u) {
        needs[0] = max(needs[0], found[0]);
        needs[1] = max(needs[1], found[1]);
    } else {
        needs[2] = max(needs[2], found[0]);
    }
}
