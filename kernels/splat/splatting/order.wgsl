// Each list in ascending order: heap sort, one invocation per cluster. Twin: src/workloads/splat/splatting/lists.rs.

//!include splat/list.wgsl

@group(0) @binding(0) var<uniform> list: List; // count: entries that there is room for
@group(0) @binding(1) var<storage, read> clusters: array<u32>; // the first word is their number
@group(0) @binding(2) var<storage, read> offsets: array<u32>;
@group(0) @binding(3) var<storage, read_write> entries: array<u32>;

// Lets an entry sink below the larger ones of the heap of `count` entries from `first` on.
fn sink(first: u32, start: u32, count: u32) {
    let entry = entries[first + start];
    var hole = start;
    loop {
        var child = 2u * hole + 1u;
        if (child >= count) {
            break;
        }
        var larger = entries[first + child];
        if (child + 1u < count) {
            let other = entries[first + child + 1u];
            if (other > larger) {
                larger = other;
                child += 1u;
            }
        }
        if (larger <= entry) {
            break;
        }
        entries[first + hole] = larger;
        hole = child;
    }
    entries[first + hole] = entry;
}

@compute @workgroup_size(GROUP_SIZE)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local_index: u32,
) {
    let cluster = list_index(group, local_index, groups.x);
    if (cluster >= clusters[0]) {
        return;
    }
    let first = min(offsets[cluster], list.count);
    let end = min(offsets[cluster + 1u], list.count);
    if (end <= first + 1u) {
        return;
    }
    let count = end - first;
    for (var start = count / 2u; start > 0u; start -= 1u) {
        sink(first, start - 1u, count);
    }
    for (var last = count - 1u; last > 0u; last -= 1u) {
        let largest = entries[first];
        entries[first] = entries[first + last];
        entries[first + last] = largest;
        sink(first, 0u, last);
    }
}
