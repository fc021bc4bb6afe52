// References to what lies below a node of a tree of boxes. Twin: src/workloads/trace/bvh/stack.rs.

// What a node leads to, in one word (packed by src/workloads/trace/bvh/layout.rs and wide/layout.rs): for an inner node
// its left child, which the right one follows, or the node that holds its children; for a leaf the top bit, four bits
// of count and 27 bits of first triangle reference.
const LEAF: u32 = 0x80000000u;
const EMPTY: u32 = LEAF; // a leaf without triangle references: the bottom of every stack, and an empty tree's root

fn is_leaf(node: u32) -> bool {
    return (node & LEAF) != 0u;
}

fn leaf_first(node: u32) -> u32 {
    return node & 0x07ffffffu;
}

fn leaf_count(node: u32) -> u32 {
    return (node >> 27u) & 15u;
}

// True if a box with this interval contains a point of the ray from its start to `t`.
fn overlaps(interval: vec2<f32>, t: f32) -> bool {
    return max(interval.x, 0.0) <= min(interval.y, t);
}
