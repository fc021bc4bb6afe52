// Rays from a surface in directions that are distributed as the cosine. Twin: src/workloads/trace/secondary.rs.

//!include lib/random.wgsl
//!include lib/cosine_direction.wgsl

// Of all directions; pixels and numbers of rays tell them apart.
const SEED: u32 = 1u;

// Around the triangle's own normal, so that no ray goes into its own triangle.
fn ray_above(surface: Surface, place: vec2<u32>, number: u32) -> Ray {
    let pixel = (frame.first_row + place.y) * frame.width + frame.first_column + place.x;
    return make_ray(surface.point, cosine_direction(surface.geometric_normal, unit_vector(SEED, pixel, number)));
}
