// The leaves below the inner nodes that are kept, and which node each of those is. Twin:
// src/workloads/trace/build/lbvh.rs.

//!include trace/build/job.wgsl
//!include trace/build/ordered.wgsl
//!include trace/build/read_box.wgsl
//!include trace/build/lists.wgsl

@group(0) @binding(2) var<storage, read> order: array<u32>;
@group(0) @binding(7) var<storage, read> ranges: array<vec2<u32>>;
@group(0) @binding(8) var<storage, read> ranks: array<u32>; // nodes that are kept before each, and their number

fn child(slot: u32, node: u32, first: u32, last: u32) -> u32 {
    let count = last - first + 1u;
    if (count > job.max_leaf) {
        slots[ranks[node]] = slot;
        return 1u;
    }
    var box = NOTHING;
    for (var i = first; i <= last; i += 1u) {
        box = around(box, read_box(order[i]));
    }
    nodes[slot * 2u] = vec4<u32>(floats(box.lo), first);
    nodes[slot * 2u + 1u] = vec4<u32>(floats(box.hi), count);
    return 0u;
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < job.count - 1u; i += job.stride) {
        let rank = ranks[i];
        if (ranks[i + 1u] != rank) {
            let range = ranges[i];
            let split = range.y;
            let slot = 2u + 2u * rank;
            let inner = child(slot, split, min(i, range.x), split)
                + child(slot + 1u, split + 1u, split + 1u, max(i, range.x));
            atomicStore(&waiting[rank], inner);
            if (inner == 0u) {
                next[atomicAdd(&lengths[0], 1u)] = rank;
            }
        }
    }
}
