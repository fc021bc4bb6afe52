// Compressed wide BVH: nodes of eight children in 80 bytes, five texels. Twin: src/workloads/trace/cwbvh/layout.rs.

//!include trace/bvh/reference.wgsl

struct Cwbvh {
    bounds_min: vec3<f32>,
    root: u32, // node 0, or EMPTY
    bounds_max: vec3<f32>,
    pad: u32,
}

@group(0) @binding(7) var<uniform> tree: Cwbvh;

// What read_root reads.
struct Root {
    lo: vec3<f32>,
    reference: u32,
    hi: vec3<f32>,
}

fn read_root() -> Root {
    return Root(tree.bounds_min, tree.root, tree.bounds_max);
}

struct Node {
    origin: vec3<f32>,
    step: vec3<f32>,  // powers of two
    inner: u32,       // a bit for each child that is a node
    first_child: u32,
    first_ref: u32,
    meta_bytes: vec2<u32>, // a byte a child
    x: vec4<u32>,     // lower planes and upper planes, a byte a child
    y: vec4<u32>,
    z: vec4<u32>,
}

fn read_node(i: u32) -> Node {
    let head = read_node16(5u * i);
    let links = read_node16(5u * i + 1u);
    let exponents = vec3<u32>(head.w & 0xffu, (head.w >> 8u) & 0xffu, (head.w >> 16u) & 0xffu);
    let step = bitcast<vec3<f32>>(exponents << vec3<u32>(23u));
    return Node(
        bitcast<vec3<f32>>(head.xyz), step, head.w >> 24u, links.x, links.y, links.zw,
        read_node16(5u * i + 2u), read_node16(5u * i + 3u), read_node16(5u * i + 4u)
    );
}

// The child's byte of two words.
fn byte_of(words: vec2<u32>, child: u32) -> u32 {
    return (select(words.x, words.y, child >= 4u) >> (8u * (child & 3u))) & 0xffu;
}

// The child's box. The products are exact, so that a fused operation rounds alike.
fn child_lo(node: Node, child: u32) -> vec3<f32> {
    let q = vec3<u32>(byte_of(node.x.xy, child), byte_of(node.y.xy, child), byte_of(node.z.xy, child));
    return node.origin + vec3<f32>(q) * node.step;
}

fn child_hi(node: Node, child: u32) -> vec3<f32> {
    let q = vec3<u32>(byte_of(node.x.zw, child), byte_of(node.y.zw, child), byte_of(node.z.zw, child));
    return node.origin + vec3<f32>(q) * node.step;
}
