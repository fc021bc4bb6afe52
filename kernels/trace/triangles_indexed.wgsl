// Triangles by the indices of their vertices: one read for the reference, and one for each corner.

fn read_corners(triangle_ref: u32) -> Corners {
    let r = read_triangle_ref(triangle_ref);
    return Corners(read_position(r.x), read_position(r.y), read_position(r.z), r.w);
}

fn read_triangle_index(triangle_ref: u32) -> u32 {
    return read_triangle_ref(triangle_ref).w;
}

fn read_material_index(triangle_ref: u32) -> u32 {
    return read_triangle_material(read_triangle_ref(triangle_ref).w);
}
