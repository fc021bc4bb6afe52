// BVH nodes, and references to them. Twin: src/workloads/trace/bvh/layout.rs.

struct Node {
    lo: vec3<f32>,
    reference: u32,
    hi: vec3<f32>,
    count: u32, // triangle references of a leaf; 0 for an inner node
}

fn read_node(i: u32) -> Node {
    let low = read_node16(2u * i);
    let high = read_node16(2u * i + 1u);
    return Node(bitcast<vec3<f32>>(low.xyz), low.w, bitcast<vec3<f32>>(high.xyz), high.w);
}

// What a node leads to, in one word (packed by src/workloads/trace/bvh/layout.rs): the left child of an inner node,
// which the right one follows; or with the top bit set four bits of count and 27 bits of first triangle reference.
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
