// The boxes of triangles, six words each, as ordered integers.
@group(0) @binding(1) var<storage, read> boxes: array<u32>;

fn read_box(triangle: u32) -> Box {
    let i = triangle * 6u;
    let lo = vec3<u32>(boxes[i], boxes[i + 1u], boxes[i + 2u]);
    return Box(lo, vec3<u32>(boxes[i + 3u], boxes[i + 4u], boxes[i + 5u]));
}
