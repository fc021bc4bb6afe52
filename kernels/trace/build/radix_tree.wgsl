// The binary radix tree over sorted keys (Karras 2012, section 4). Inner node i has triangle i at one end of its range.
// Twin: src/workloads/trace/build/tree.rs.

@group(0) @binding(1) var<storage, read> keys: array<u32>; // sorted

// Bits that two keys have in common, or of equal keys their places; -1 outside of all keys.
fn common_bits(key: u32, i: i32, j: i32) -> i32 {
    // Without branches, which cost a software driver more than what they leave out
    let is_there = u32(j) < job.leaves;
    let different = key ^ keys[select(0u, u32(j), is_there)];
    let bits = select(countLeadingZeros(different), 32u + countLeadingZeros(u32(i ^ j)), different == 0u);
    return select(-1, i32(bits), is_there);
}

struct Side {
    step: i32,  // towards the other end of the range
    least: i32, // a key has more bits than this in common with all others of the range, and with no other
}

fn side_of(key: u32, i: i32) -> Side {
    let after = common_bits(key, i, i + 1);
    let before = common_bits(key, i, i - 1);
    return Side(select(-1, 1, after > before), min(after, before));
}

// True for an inner node of more triangles than a leaf may have.
fn is_kept(i: i32) -> bool {
    let key = keys[i];
    let side = side_of(key, i);
    return common_bits(key, i, i + i32(job.max_leaf) * side.step) > side.least;
}
