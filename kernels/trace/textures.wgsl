// Scene and structure in textures, whose texels are their words, 16 bytes in each (8 in one of nodes8), row by row.
// trace/buffers.wgsl reads the same from storage buffers.
//
// A software driver reads a texel of four words by one vector load per ray, but a storage buffer word by word, with a
// branch for each ray: on lavapipe this makes bvh-stack about 1.8 times as fast.

alias Texels16 = texture_storage_2d<rgba32uint, read>;

@group(0) @binding(1) var vertices: Texels16;
@group(0) @binding(2) var triangle_refs: Texels16;
@group(0) @binding(6) var nodes16: Texels16;
@group(0) @binding(6) var nodes8: texture_storage_2d<rg32uint, read>;

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

fn read_node16(i: u32) -> vec4<u32> {
    return textureLoad(nodes16, texel(i));
}

fn read_node8(i: u32) -> vec2<u32> {
    return textureLoad(nodes8, texel(i)).xy;
}
