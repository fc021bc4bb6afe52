// Nodes of a BVH with links to their parents. Twin: src/workloads/trace/bvh/stackless/layout.rs.
//
// Where other BVHs have the number of triangle references, a node has its link: 28 bits of the parent's index, and the
// order of itself and its sibling, an axis and whether the right one lies lower on it. The reference of an inner node
// has the order of its children in the same bits.

//!include trace/bvh/node.wgsl
//!include trace/bvh/widened.wgsl

const INDEX: u32 = 0x0fffffffu;

fn order_of(word: u32) -> u32 {
    return (word >> 28u) & 7u;
}

// Which of two siblings in this order the ray meets first: 0 for the left one, 1 for the right one.
fn nearer(ray: Ray, order: u32) -> u32 {
    let descends = on_axis(ray.direction, order & 3u) < 0.0;
    return select(0u, 1u, descends != (order >= 4u));
}

fn read_link(i: u32) -> u32 {
    return read_node16(2u * i + 1u).w;
}
