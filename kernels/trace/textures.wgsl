// Scene and structure in textures, whose texels are their words, 16 bytes in each (8 in one of nodes8), row by row.
// trace/buffers.wgsl reads the same from storage buffers.
//
// A software driver reads a texel of four words by one vector load per ray, but a storage buffer word by word, with a
// branch for each ray: on lavapipe this makes bvh-stack about 1.8 times as fast.

alias Texels16 = texture_storage_2d<rgba32uint, read>;

@group(0) @binding(1) var vertices: Texels16;
@group(0) @binding(2) var triangle_refs: Texels16;
@group(0) @binding(3) var materials: Texels16;
@group(0) @binding(4) var triangle_materials: Texels16;
@group(0) @binding(5) var lights: Texels16;
@group(0) @binding(6) var nodes16: Texels16;
@group(0) @binding(6) var nodes8: texture_storage_2d<rg32uint, read>;
@group(0) @binding(13) var corner_texels: Texels16;

fn texel(i: u32) -> vec2<u32> {
    return vec2<u32>(i % TEXTURE_WIDTH, i / TEXTURE_WIDTH);
}

fn read_position(i: u32) -> vec3<f32> {
    return bitcast<vec3<f32>>(textureLoad(vertices, texel(i * 2u)).xyz);
}

fn read_normal(i: u32) -> vec3<f32> {
    return bitcast<vec3<f32>>(textureLoad(vertices, texel(i * 2u + 1u)).xyz);
}

fn read_triangle_ref(i: u32) -> vec4<u32> {
    return textureLoad(triangle_refs, texel(i));
}

fn read_corner_texel(i: u32) -> vec4<u32> {
    return textureLoad(corner_texels, texel(i));
}

// Ambient colour and reflectivity.
fn read_ambient(i: u32) -> vec4<f32> {
    return bitcast<vec4<f32>>(textureLoad(materials, texel(i * 3u)));
}

fn read_material(i: u32) -> Material {
    let ambient = read_ambient(i);
    let diffuse = bitcast<vec4<f32>>(textureLoad(materials, texel(i * 3u + 1u)));
    let specular = bitcast<vec4<f32>>(textureLoad(materials, texel(i * 3u + 2u)));
    return Material(ambient.xyz, ambient.w, diffuse.xyz, diffuse.w, specular.xyz, 0.0);
}

fn read_triangle_material(i: u32) -> u32 {
    let four = textureLoad(triangle_materials, texel(i >> 2u));
    let two = select(four.xy, four.zw, (i & 2u) != 0u);
    return select(two.x, two.y, (i & 1u) != 0u);
}

fn read_light(i: u32) -> Light {
    let position = textureLoad(lights, texel(i * 2u));
    let colour = textureLoad(lights, texel(i * 2u + 1u));
    return Light(bitcast<vec4<f32>>(position), bitcast<vec4<f32>>(colour));
}

fn read_node16(i: u32) -> vec4<u32> {
    return textureLoad(nodes16, texel(i));
}

fn read_node8(i: u32) -> vec2<u32> {
    return textureLoad(nodes8, texel(i)).xy;
}
