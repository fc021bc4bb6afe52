// BVH nodes and references to them.

struct Node {
    lo: vec3<f32>,
    first: u32, // left child (the right one follows), or first record
    hi: vec3<f32>,
    count: u32, // records of a leaf; 0 for an inner node
}

@group(0) @binding(6) var<storage, read> nodes: array<Node>;

// A node in one word, so that a stack entry needs no read when it is popped: the left child of an inner node, or with
// the top bit set four bits of count and 27 bits of first record.
const LEAF: u32 = 0x80000000u;
const EMPTY: u32 = LEAF; // a leaf without records: the bottom of every stack, and an empty tree's root

fn node_reference(first: u32, count: u32) -> u32 {
    return select(first, LEAF | (count << 27u) | first, count > 0u);
}

fn is_leaf(node: u32) -> bool {
    return (node & LEAF) != 0u;
}

fn leaf_first(node: u32) -> u32 {
    return node & 0x07ffffffu;
}

fn leaf_count(node: u32) -> u32 {
    return (node >> 27u) & 15u;
}

fn root_reference() -> u32 {
    let root = nodes[0];
    return select(node_reference(root.first, root.count), EMPTY, root.first == 0u && root.count == 0u);
}

fn wanted(interval: vec2<f32>, t: f32) -> bool {
    return interval.x <= interval.y && interval.x <= t && interval.y >= 0.0;
}
