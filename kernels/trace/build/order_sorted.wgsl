// A later digit: triangles are in the order of the digits before.
@group(0) @binding(5) var<storage, read> order: array<u32>;

fn triangle_at(i: u32) -> u32 {
    return order[i];
}
