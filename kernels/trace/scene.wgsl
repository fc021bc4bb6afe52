// The scene and its structure as they lie in memory, and the test of one stored triangle.

struct Vertex {
    position: vec4<f32>,
    normal: vec4<f32>,
}

struct Material {
    ambient: vec3<f32>,
    reflectivity: f32,
    diffuse: vec3<f32>,
    exponent: f32,
    specular: vec3<f32>,
    pad: f32,
}

struct Light {
    position: vec4<f32>,
    colour: vec4<f32>,
}

// A BVH's node.
struct Node {
    lo: vec3<f32>,
    reference: u32,
    hi: vec3<f32>,
    count: u32, // triangle references of a leaf; 0 for an inner node
}

// What the structure needs beside its nodes; filled by src/workloads/trace/gpu/upload.rs from the built structure.
struct Structure {
    bounds_min: vec3<f32>,
    cell_size: f32,
    bounds_max: vec3<f32>,
    triangle_refs: u32,
    resolution: vec3<u32>,
    pad: u32,
    octants: array<Octant, 8>,
}

// Grid traversal's constants by the signs of the ray's direction (bit 0: x is negative, 1: y, 2: z).
struct Octant {
    step: vec4<i32>, // +1 or -1 per axis
    end: vec4<i32>,  // first cell index outside the grid per axis
}

@group(0) @binding(7) var<uniform> structure: Structure;

// read_vertex, read_position, read_triangle_ref (three vertices and the triangle's index), read_node and read_pair
//!slot memory

// The nearest hit so far. Of equal distances the lower triangle index wins, so that the order of tests is no matter.
struct Best {
    t: f32,
    triangle_ref: u32,
}

fn no_best() -> Best {
    return Best(T_MAX, MISS);
}

fn test_triangle(ray: Ray, triangle_ref: u32, best: ptr<function, Best>) {
    let r = read_triangle_ref(triangle_ref);
    let hit = intersect(ray, read_position(r.x), read_position(r.y), read_position(r.z));
    if (hit.t <= (*best).t) {
        if (hit.t < (*best).t || r.w < read_triangle_ref((*best).triangle_ref).w) {
            *best = Best(hit.t, triangle_ref);
        }
    }
}

// True if the triangle is hit at a distance below `limit`.
fn triangle_occludes(ray: Ray, triangle_ref: u32, limit: f32) -> bool {
    let r = read_triangle_ref(triangle_ref);
    let hit = intersect(ray, read_position(r.x), read_position(r.y), read_position(r.z));
    return hit.t < limit;
}
