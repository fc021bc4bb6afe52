// The inner nodes of the binary radix tree, each with its range of sorted triangles, in parallel (Karras 2012,
// section 4). Inner node i has triangle i at one end of its range. Twin: src/workloads/trace/build/tree.rs.

//!include trace/build/job.wgsl

@group(0) @binding(1) var<storage, read> keys: array<u32>; // sorted
// The other end of the node's range, and the last triangle of its left child. Nodes of at most max_leaf triangles have
// none.
@group(0) @binding(2) var<storage, read_write> ranges: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read_write> flags: array<u32>; // 1 for nodes that are no part of a leaf

// Bits that two keys have in common, or of equal keys their places; -1 outside of all keys.
fn common_bits(key: u32, i: i32, j: i32) -> i32 {
    if (j < 0 || j >= i32(job.count)) {
        return -1;
    }
    let other = keys[j];
    if (key == other) {
        return 32 + i32(countLeadingZeros(u32(i ^ j)));
    }
    return i32(countLeadingZeros(key ^ other));
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var index = id.x; index < job.count - 1u; index += job.stride) {
        let i = i32(index);
        let key = keys[i];
        let after = common_bits(key, i, i + 1);
        let before = common_bits(key, i, i - 1);
        let step = select(-1, 1, after > before);
        let least = min(after, before);
        let is_kept = common_bits(key, i, i + i32(job.max_leaf) * step) > least;
        flags[index] = select(0u, 1u, is_kept);
        if (is_kept) {
            // The other end is at least `inside` and less than `outside` away
            var inside = i32(job.max_leaf);
            var outside = 2 * inside;
            while (common_bits(key, i, i + outside * step) > least) {
                inside = outside;
                outside *= 2;
            }
            while (outside - inside > 1) {
                let middle = (inside + outside) / 2;
                if (common_bits(key, i, i + middle * step) > least) {
                    inside = middle;
                } else {
                    outside = middle;
                }
            }
            let end = i + inside * step;
            let own = common_bits(key, i, end);
            var same = 0; // so far away, a key has more bits in common than all of the range
            var other = inside;
            while (other - same > 1) {
                let middle = (same + other) / 2;
                if (common_bits(key, i, i + middle * step) > own) {
                    same = middle;
                } else {
                    other = middle;
                }
            }
            ranges[index] = vec2<u32>(u32(end), u32(i + same * step + min(step, 0)));
        }
    }
}
