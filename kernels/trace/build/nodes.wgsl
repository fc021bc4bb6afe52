// The range of every inner node that is kept, which children are leaves, and which node each inner child is. Twins:
// src/workloads/trace/build/{tree,lbvh}.rs.

//!include trace/build/job.wgsl
//!include trace/build/radix_tree.wgsl
//!include trace/build/lists.wgsl

@group(0) @binding(2) var<storage, read_write> leaves: array<u32>; // nodes that are leaves, in any order
@group(0) @binding(8) var<storage, read> kept: array<u32>;

fn child(slot: u32, node: u32, first: u32, last: u32) -> u32 {
    let count = last - first + 1u;
    if (count > job.max_leaf) {
        slots[node] = slot;
        return 1u;
    }
    nodes[slot * 2u].w = first;
    nodes[slot * 2u + 1u].w = count;
    leaves[atomicAdd(&lengths[LEAVES], 1u)] = slot;
    return 0u;
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var rank = id.x; rank < job.count; rank += job.stride) {
        let i = i32(kept[rank]);
        let key = keys[i];
        let side = side_of(key, i);
        // The other end is at least `inside` and less than `outside` away
        var inside = i32(job.max_leaf);
        var outside = 2 * inside;
        while (common_bits(key, i, i + outside * side.step) > side.least) {
            inside = outside;
            outside *= 2;
        }
        while (outside - inside > 1) {
            let middle = (inside + outside) / 2;
            if (common_bits(key, i, i + middle * side.step) > side.least) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        let end = i + inside * side.step;
        let own = common_bits(key, i, end);
        // So far away, a key has more bits in common than all of the range
        var same = 0;
        var other = inside;
        while (other - same > 1) {
            let middle = (same + other) / 2;
            if (common_bits(key, i, i + middle * side.step) > own) {
                same = middle;
            } else {
                other = middle;
            }
        }
        let split = u32(i + same * side.step + min(side.step, 0));
        let slot = 2u + 2u * rank;
        let inner = child(slot, split, u32(min(i, end)), split)
            + child(slot + 1u, split + 1u, split + 1u, u32(max(i, end)));
        atomicStore(&waiting[rank], inner);
        if (inner == 0u) {
            next[atomicAdd(&lengths[0], 1u)] = rank;
        }
    }
}
