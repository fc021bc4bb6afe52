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

// The structure's own uniform is at binding 7, declared by its folder.

// read_position, read_normal, read_triangle_ref (three vertices and the triangle's index), read_corner_texel, for a
// structure's nodes read_node16 or read_node8, and for shading read_ambient, read_material, read_triangle_material,
// read_light
//!slot memory

// The corners of a triangle.
struct Corners {
    a: vec3<f32>,
    b: vec3<f32>,
    c: vec3<f32>,
    triangle: u32, // index in the scene
}

// read_corners, read_triangle_index and read_material_index of a triangle reference
//!slot triangles

// The nearest hit so far. Of equal distances the lower triangle index wins, so that the order of tests does not matter.
struct Best {
    t: f32,
    triangle_ref: u32, // MISS as long as nothing is hit, while `t` is the limit of the search
}

// Replaces `best` by a hit that is nearer.
fn test_triangle(ray: Ray, triangle_ref: u32, best: ptr<function, Best>) {
    let corners = read_corners(triangle_ref);
    let hit = intersect(ray, corners.a, corners.b, corners.c);
    if (hit.t <= (*best).t) {
        if (hit.t < (*best).t || has_lower_index(corners.triangle, (*best).triangle_ref)) {
            *best = Best(hit.t, triangle_ref);
        }
    }
}

// True if triangle `index` comes before the one of the best hit; nothing exactly at the limit is a hit.
fn has_lower_index(index: u32, best: u32) -> bool {
    return best != MISS && index < read_triangle_index(best);
}

// Tests the triangles of a leaf or cell for the nearest hit; with `any`, only up to the first one that is hit. True if
// that ends the search.
fn test_triangles(ray: Ray, first: u32, count: u32, any: bool, best: ptr<function, Best>) -> bool {
    for (var i = first; i < first + count; i += 1u) {
        count_test();
        if (any) {
            if (triangle_occludes(ray, i, (*best).t)) {
                (*best).triangle_ref = i;
                return true;
            }
        } else {
            test_triangle(ray, i, best);
        }
    }
    return false;
}

// True if the triangle is hit at a distance below `limit`.
fn triangle_occludes(ray: Ray, triangle_ref: u32, limit: f32) -> bool {
    let corners = read_corners(triangle_ref);
    let hit = intersect(ray, corners.a, corners.b, corners.c);
    return hit.t < limit;
}

// Every traversal is one function `traverse(ray, limit, any, alive) -> u32`: the triangle reference of the nearest hit
// before `limit`, with `any` of some hit there, or MISS. It is called with constants for `any`, which drivers fold.

fn nearest_hit(ray: Ray, alive: bool) -> u32 {
    return traverse(ray, T_MAX, false, alive);
}

// True if anything is hit at a distance below `limit`.
fn any_hit(ray: Ray, limit: f32, alive: bool) -> bool {
    return traverse(ray, limit, true, alive) != MISS;
}
