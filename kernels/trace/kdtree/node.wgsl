// kd-tree: its uniform, and its nodes of two words, packed by src/workloads/trace/kdtree/layout.rs. The left child
// follows its parent.

struct KdTree {
    bounds_min: vec3<f32>,
    pad0: u32,
    bounds_max: vec3<f32>,
    pad1: u32,
}

@group(0) @binding(7) var<uniform> tree: KdTree;

// read_kd_node(i), and leaf_first(node): the first triangle reference of a leaf
//!slot nodes

fn is_leaf(node: vec2<u32>) -> bool {
    return (node.y & 3u) == 3u;
}

fn leaf_count(node: vec2<u32>) -> u32 {
    return node.y >> 2u;
}

fn split_axis(node: vec2<u32>) -> u32 {
    return node.y & 3u;
}

fn split_plane(node: vec2<u32>) -> f32 {
    return bitcast<f32>(node.x);
}

fn right_child(node: vec2<u32>) -> u32 {
    return node.y >> 2u;
}

// The distances at which a ray is in a node's plane, the smallest and the greatest: different only where the direction
// is zero, an interval around the ray for a plane that it lies in.
fn plane_distances(ray: Ray, node: vec2<u32>) -> vec2<f32> {
    let axis = split_axis(node);
    let split = split_plane(node);
    let inv = on_axis(ray.inv_direction, axis);
    return vec2<f32>((split - on_axis(ray.origin_min, axis)) * inv, (split - on_axis(ray.origin_max, axis)) * inv);
}
