// Compressed wide BVH, one ray per invocation with a private stack of groups (Ylitie, Karras and Laine 2017). Twin:
// src/workloads/trace/cwbvh/stack.rs.
//
// A group is the children of a node that the ray meets: the first child's index, and a mask. Its bits 24 to 31 are the
// children to visit, highest first: places flipped by the signs of the ray's direction. Its low 8 bits are the node's
// inner children, from which a child's index follows. Triangles of leaves that the ray meets are tested at once, from
// the highest bit of a mask of 24 on.

//!include lib/independent.wgsl
//!include trace/cwbvh/node.wgsl
//!include trace/bvh/widened.wgsl

var<private> stack: array<vec2<u32>, STACK_SIZE>;

// Bits that flip a place's number, so that the first place to visit has the highest number.
fn flipped_bits(direction: vec3<f32>) -> u32 {
    return 7u - (u32(direction.z < 0.0) | (u32(direction.y < 0.0) << 1u) | (u32(direction.x < 0.0) << 2u));
}

// What the ray meets before `t`: inner children in bits 24 to 31, triangle references in the others.
fn visit(ray: Ray, node: Node, t: f32, flips: u32) -> u32 {
    count_inner();
    var hits = 0u;
    for (var i = 0u; i < 8u; i += 1u) {
        let word = byte_of(node.meta_bytes, i);
        if (word != 0u) {
            count_box_test();
            if (overlaps(ray_box(ray, child_lo(node, i), child_hi(node, i)), t)) {
                if (((node.inner >> i) & 1u) == 1u) {
                    hits |= 1u << (24u + (i ^ flips));
                } else {
                    count_leaf();
                    hits |= (word >> 5u) << (word & 31u);
                }
            }
        }
    }
    return hits;
}

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    if (!alive) {
        return MISS;
    }
    var best = Best(limit, MISS);
    let wide = widened(ray);
    let root = read_root();
    if (root.reference == EMPTY || !overlaps(ray_box(wide, root.lo, root.hi), limit)) {
        return MISS;
    }
    let flips = flipped_bits(ray.direction);
    var index = 0u;
    var depth = 0u;
    loop {
        let node = read_node(index);
        let hits = visit(wide, node, best.t, flips);
        var triangles = hits & 0xffffffu;
        var found = false;
        while (triangles != 0u && !found) {
            let offset = firstLeadingBit(triangles);
            triangles ^= 1u << offset;
            found = test_triangles(ray, node.first_ref + offset, 1u, any, &best);
        }
        if (found) {
            break;
        }
        var mask = (hits & 0xff000000u) | node.inner;
        var first = node.first_child;
        if ((hits >> 24u) == 0u) {
            if (depth == 0u) {
                break;
            }
            count_pop();
            depth -= 1u;
            first = stack[depth].x;
            mask = stack[depth].y;
        }
        let bit = firstLeadingBit(mask);
        mask ^= 1u << bit;
        if ((mask >> 24u) != 0u) {
            stack[depth] = vec2<u32>(first, mask);
            depth += 1u;
        }
        let place = (bit - 24u) ^ flips;
        index = first + countOneBits(mask & 0xffu & ((1u << place) - 1u));
    }
    return best.triangle_ref;
}
