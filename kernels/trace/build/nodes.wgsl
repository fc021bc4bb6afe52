// The range of every inner node that is kept, the leaves below it, and which node each inner child is. Twins:
// src/workloads/trace/build/{tree,lbvh}.rs.

//!include trace/build/job.wgsl
//!include trace/build/radix_tree.wgsl
//!include trace/build/ordered.wgsl
//!include trace/build/lists.wgsl

@group(0) @binding(2) var<storage, read> boxes: array<u32>; // six words a triangle
@group(0) @binding(8) var<storage, read> order: array<u32>;
@group(0) @binding(9) var<storage, read> ranks: array<u32>; // nodes that are kept before each
@group(0) @binding(10) var<storage, read> kept: array<u32>;

fn read_box(triangle: u32) -> Box {
    let i = triangle * 6u;
    let lo = vec3<u32>(boxes[i], boxes[i + 1u], boxes[i + 2u]);
    return Box(lo, vec3<u32>(boxes[i + 3u], boxes[i + 4u], boxes[i + 5u]));
}

// As many steps for every node: branches would cost a software driver more than what they leave out.
fn leaf_box(first: u32, last: u32) -> Box {
    var box = NOTHING;
    for (var k = 0u; k < job.max_leaf; k += 1u) {
        box = around(box, read_box(order[min(first + k, last)]));
    }
    return box;
}

fn child(slot: u32, node: u32, first: u32, last: u32) -> u32 {
    let count = last - first + 1u;
    let box = leaf_box(first, last);
    if (count > job.max_leaf) {
        slots[ranks[node]] = slot;
        return 1u;
    }
    nodes[slot * 2u] = vec4<u32>(floats(box.lo), first);
    nodes[slot * 2u + 1u] = vec4<u32>(floats(box.hi), count);
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
