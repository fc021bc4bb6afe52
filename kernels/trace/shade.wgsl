// Phong shading. Twin: src/workloads/trace/shade.rs.

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
    let corners = read_corners(triangle_ref);
    let r = read_triangle_ref(triangle_ref);
    let hit = surface_hit(ray, corners.a, corners.b, corners.c);
    var geometric_normal = normalize3(cross3(corners.b - corners.a, corners.c - corners.a));
    geometric_normal = geometric_normal * select(1.0, -1.0, dot3(geometric_normal, ray.direction) > 0.0);
    var normal = read_normal(r.x) * hit.w + read_normal(r.y) * hit.u + read_normal(r.z) * hit.v;
    if (dot3(normal, normal) < 1.0e-12) {
        normal = geometric_normal; // opposite normals cancelled, or the file's were zero
    } else {
        normal = normalize3(normal);
        normal = normal * select(1.0, -1.0, dot3(normal, geometric_normal) < 0.0);
    }
    let on_triangle = corners.a * hit.w + corners.b * hit.u + corners.c * hit.v;
    let point = on_triangle + geometric_normal * epsilon;
    return Surface(hit.t, r.w, read_material_index(triangle_ref), point, geometric_normal, normal);
}

// Diffuse and specular light from one point light.
fn phong(surface: Surface, light: Light, view: vec3<f32>) -> vec3<f32> {
    let material = read_material(surface.material);
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
