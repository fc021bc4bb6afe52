// Boxes of triangles, made of their corners: a software driver reads words faster than it writes them.
@group(0) @binding(1) var<storage, read> indices: array<u32>;   // three vertices a triangle
@group(0) @binding(2) var<storage, read> positions: array<u32>; // three floats a vertex

fn corner(vertex: u32) -> vec3<u32> {
    let i = 3u * vertex;
    return ordered(vec3<u32>(positions[i], positions[i + 1u], positions[i + 2u]));
}

fn read_box(triangle: u32) -> Box {
    let i = 3u * triangle;
    let a = corner(indices[i]);
    let b = corner(indices[i + 1u]);
    let c = corner(indices[i + 2u]);
    return Box(min(min(a, b), c), max(max(a, b), c));
}
