// BVH nodes: siblings lie together, the root and a dummy first. Twin: src/workloads/trace/bvh/layout.rs.

//!include trace/bvh/reference.wgsl

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

// The root; and the children of an inner node, by its reference. trace/wide/pair.wgsl reads the same from quantised
// boxes.

fn read_root() -> Node {
    return read_node(0u);
}

fn read_left(node: u32) -> Node {
    return read_node(node);
}

fn read_right(node: u32) -> Node {
    return read_node(node + 1u);
}
