// Directions as indices: six faces of a cube with 3 x 3 cells each. Twin: src/workloads/splat/directions.rs.

const DIRECTIONS = 54u;

// Twice the axis of the largest component, and one more where that is negative. Of equal components the first counts.
fn direction_face(vector: vec3<f32>) -> u32 {
    let size = abs(vector);
    var axis = 0u;
    var largest = vector.x;
    if (!(size.x >= size.y && size.x >= size.z)) {
        axis = select(1u, 2u, size.z > size.y);
        largest = select(vector.y, vector.z, size.z > size.y);
    }
    return 2u * axis + select(0u, 1u, largest < 0.0);
}

fn direction_cell(place: f32) -> u32 {
    return min(u32((place + 1.0) * 1.5), 2u);
}

// 9 x the face + 3 x the cell along the first of the other two axes + the cell along the second.
fn direction_index(vector: vec3<f32>) -> u32 {
    let face = direction_face(vector);
    var largest = abs(vector.x);
    var first = vector.y;
    var second = vector.z;
    if (face >= 4u) {
        largest = abs(vector.z);
        first = vector.x;
        second = vector.y;
    } else if (face >= 2u) {
        largest = abs(vector.y);
        first = vector.x;
    }
    return 9u * face + 3u * direction_cell(first / largest) + direction_cell(second / largest);
}
