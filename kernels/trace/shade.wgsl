// Phong shading. Twin: src/workloads/trace/shade.rs.

@group(0) @binding(3) var<storage, read> materials: array<Material>;
@group(0) @binding(4) var<storage, read> triangle_materials: array<u32>;
@group(0) @binding(5) var<storage, read> lights: array<Light>;

// A hit point, ready to be lit.
struct Surface {
    t: f32,
    triangle: u32,
    material: u32,
    point: vec3<f32>,            // lifted off the triangle, to the side that the ray came from
    geometric_normal: vec3<f32>, // unit normal of the triangle, facing the ray
    normal: vec3<f32>,           // unit shading normal, on the same side
}

// The traversal returned only which triangle reference was hit; distance and barycentric coordinates are computed anew,
// which costs less than carrying them through the traversal in registers.
fn surface_at(ray: Ray, triangle_ref: u32, epsilon: f32) -> Surface {
    let r = read_triangle_ref(triangle_ref);
    let a = read_vertex(r.x);
    let b = read_vertex(r.y);
    let c = read_vertex(r.z);
    let hit = surface_hit(ray, a.position.xyz, b.position.xyz, c.position.xyz);
    var geometric_normal = normalize3(cross3(b.position.xyz - a.position.xyz, c.position.xyz - a.position.xyz));
    geometric_normal = geometric_normal * select(1.0, -1.0, dot3(geometric_normal, ray.direction) > 0.0);
    var normal = a.normal.xyz * hit.w + b.normal.xyz * hit.u + c.normal.xyz * hit.v;
    if (dot3(normal, normal) < 1.0e-12) {
        normal = geometric_normal; // opposite normals cancelled, or the file's were zero
    } else {
        normal = normalize3(normal);
        normal = normal * select(1.0, -1.0, dot3(normal, geometric_normal) < 0.0);
    }
    let on_triangle = a.position.xyz * hit.w + b.position.xyz * hit.u + c.position.xyz * hit.v;
    let point = on_triangle + geometric_normal * epsilon;
    return Surface(hit.t, r.w, triangle_materials[r.w], point, geometric_normal, normal);
}

// Diffuse and specular light from one point light.
fn phong(surface: Surface, light: Light, view: vec3<f32>) -> vec3<f32> {
    let material = materials[surface.material];
    let to_light = normalize3(light.position.xyz - surface.point);
    let cosine = dot3(surface.normal, to_light);
    if (cosine <= 0.0) {
        return vec3<f32>(0.0, 0.0, 0.0);
    }
    let mirrored = surface.normal * (2.0 * cosine) - to_light;
    let highlight = pow(max(-dot3(mirrored, view), 1.0e-6), material.exponent);
    return (material.diffuse * cosine + material.specular * highlight) * light.colour.xyz;
}

// The mirrored ray. A shading normal may mirror it into the surface: then the triangle's own normal does it.
fn reflected_ray(surface: Surface, direction: vec3<f32>) -> Ray {
    var mirrored = direction - surface.normal * (2.0 * dot3(surface.normal, direction));
    if (dot3(mirrored, surface.geometric_normal) <= 0.0) {
        mirrored = direction - surface.geometric_normal * (2.0 * dot3(surface.geometric_normal, direction));
    }
    return make_ray(surface.point, normalize3(mirrored));
}

fn channel(x: f32) -> u32 {
    return u32(min(max(x, 0.0), 1.0) * 255.0 + 0.5);
}

fn rgba8(colour: vec3<f32>) -> u32 {
    return channel(colour.x) | (channel(colour.y) << 8u) | (channel(colour.z) << 16u) | (255u << 24u);
}
