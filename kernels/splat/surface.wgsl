// Surfaces as light meets them: flat, whatever their vertex normals are. Point and normal have the bits of
// trace/shade.wgsl. Twin: src/workloads/splat/surface.rs.

//!include lib/geom.wgsl
//!include splat/rays.wgsl

// A triangle of the scene: corners, each with a channel of the material's albedo.
struct Facet {
    red: vec4<f32>,
    green: vec4<f32>,
    blue: vec4<f32>,
}

@group(0) @binding(1) var<storage, read> facets: array<Facet>;

struct Surface {
    point: vec3<f32>,  // lifted off the triangle, to the side that the ray came from
    normal: vec3<f32>, // unit normal of the triangle, facing the ray
    albedo: vec3<f32>,
}

fn surface_at(origin: vec3<f32>, direction: vec3<f32>, triangle: u32, epsilon: f32) -> Surface {
    let facet = facets[triangle];
    let a = facet.red.xyz;
    let b = facet.green.xyz;
    let c = facet.blue.xyz;
    let hit = surface_hit(make_ray(origin, direction), a, b, c);
    var normal = normalize3(cross3(b - a, c - a));
    normal = normal * select(1.0, -1.0, dot3(normal, direction) > 0.0);
    let on_triangle = a * hit.w + b * hit.u + c * hit.v;
    return Surface(on_triangle + normal * epsilon, normal, vec3<f32>(facet.red.w, facet.green.w, facet.blue.w));
}
