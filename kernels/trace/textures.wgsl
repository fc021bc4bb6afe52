// Scene and structure in textures, whose texels are their words, 16 bytes in each (8 in one of pairs), row by row.
// trace/buffers.wgsl reads the same from storage buffers.
//
// A software driver reads a texel of four words by one vector load per ray, but a storage buffer word by word, with a
// branch for each ray: on lavapipe this makes bvh-stack about 1.8 times as fast.

alias Words = texture_storage_2d<rgba32uint, read>;

@group(0) @binding(1) var vertices: Words;
@group(0) @binding(2) var triangle_refs: Words;
@group(0) @binding(6) var nodes: Words; // a BVH's
@group(0) @binding(6) var pairs: texture_storage_2d<rg32uint, read>; // or a kd-tree's nodes, or a grid's cells

fn texel(i: u32) -> vec2<u32> {
    return vec2<u32>(i % TEXTURE_WIDTH, i / TEXTURE_WIDTH);
}

fn read_vertex(i: u32) -> Vertex {
    let position = textureLoad(vertices, texel(i * 2u));
    let normal = textureLoad(vertices, texel(i * 2u + 1u));
    return Vertex(bitcast<vec4<f32>>(position), bitcast<vec4<f32>>(normal));
}

fn read_position(i: u32) -> vec3<f32> {
    return bitcast<vec3<f32>>(textureLoad(vertices, texel(i * 2u)).xyz);
}

fn read_triangle_ref(i: u32) -> vec4<u32> {
    return textureLoad(triangle_refs, texel(i));
}

fn read_node(i: u32) -> Node {
    let low = textureLoad(nodes, texel(i * 2u));
    let high = textureLoad(nodes, texel(i * 2u + 1u));
    return Node(bitcast<vec3<f32>>(low.xyz), low.w, bitcast<vec3<f32>>(high.xyz), high.w);
}

fn read_pair(i: u32) -> vec2<u32> {
    return textureLoad(pairs, texel(i)).xy;
}
