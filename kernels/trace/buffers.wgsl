// Scene and structure in storage buffers. trace/textures.wgsl reads the same from textures.

@group(0) @binding(1) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(2) var<storage, read> triangle_refs: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read> materials: array<Material>;
@group(0) @binding(4) var<storage, read> triangle_materials: array<u32>;
@group(0) @binding(5) var<storage, read> lights: array<Light>;
// Nodes or cells, of which a structure has one kind: 16 bytes at a time, or 8
@group(0) @binding(6) var<storage, read> nodes16: array<vec4<u32>>;
@group(0) @binding(6) var<storage, read> nodes8: array<vec2<u32>>;
@group(0) @binding(13) var<storage, read> corner_texels: array<vec4<u32>>;

fn read_position(i: u32) -> vec3<f32> {
    return vertices[i].position.xyz;
}

fn read_normal(i: u32) -> vec3<f32> {
    return vertices[i].normal.xyz;
}

fn read_triangle_ref(i: u32) -> vec4<u32> {
    return triangle_refs[i];
}

fn read_corner_texel(i: u32) -> vec4<u32> {
    return corner_texels[i];
}

// Ambient colour and reflectivity.
fn read_ambient(i: u32) -> vec4<f32> {
    return vec4<f32>(materials[i].ambient, materials[i].reflectivity);
}

fn read_material(i: u32) -> Material {
    return materials[i];
}

fn read_triangle_material(i: u32) -> u32 {
    return triangle_materials[i];
}

fn read_light(i: u32) -> Light {
    return lights[i];
}

fn read_node16(i: u32) -> vec4<u32> {
    return nodes16[i];
}

fn read_node8(i: u32) -> vec2<u32> {
    return nodes8[i];
}
