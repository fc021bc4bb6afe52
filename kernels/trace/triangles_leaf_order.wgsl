// The corners of every triangle reference once more, in the order of the references: three texels each, of which the
// first also has the triangle's index in the scene and the second its material (src/workloads/trace/gpu/shared.rs).

fn read_corners(triangle_ref: u32) -> Corners {
    let a = read_corner_texel(triangle_ref * 3u);
    let b = read_corner_texel(triangle_ref * 3u + 1u);
    let c = read_corner_texel(triangle_ref * 3u + 2u);
    return Corners(bitcast<vec3<f32>>(a.xyz), bitcast<vec3<f32>>(b.xyz), bitcast<vec3<f32>>(c.xyz), a.w);
}

fn read_triangle_index(triangle_ref: u32) -> u32 {
    return read_corner_texel(triangle_ref * 3u).w;
}

fn read_material_index(triangle_ref: u32) -> u32 {
    return read_corner_texel(triangle_ref * 3u + 1u).w;
}
