// Scene and structure in storage buffers. trace/textures.wgsl reads the same from textures.

@group(0) @binding(1) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(2) var<storage, read> triangle_refs: array<vec4<u32>>;
@group(0) @binding(6) var<storage, read> nodes: array<Node>; // a BVH's
@group(0) @binding(6) var<storage, read> pairs: array<vec2<u32>>; // or a kd-tree's nodes, or a grid's cells

fn read_vertex(i: u32) -> Vertex {
    return vertices[i];
}

fn read_position(i: u32) -> vec3<f32> {
    return vertices[i].position.xyz;
}

fn read_triangle_ref(i: u32) -> vec4<u32> {
    return triangle_refs[i];
}

fn read_node(i: u32) -> Node {
    return nodes[i];
}

fn read_pair(i: u32) -> vec2<u32> {
    return pairs[i];
}
