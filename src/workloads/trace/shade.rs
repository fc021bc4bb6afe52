//! Phong shading. Twin of `kernels/trace/shade.wgsl`.

use crate::math::Ray;
use crate::scene::{Light, Material, Scene};
use crate::workloads::trace::traverse::Triangles;
use glam::Vec3A;

/// A hit point, ready to be lit.
#[derive(Clone, Copy)]
pub struct Surface {
    /// Distance of the hit.
    pub t: f32,
    /// Triangle in the scene.
    pub triangle: u32,
    /// Its material.
    pub material: u32,
    /// Lifted off the triangle, to the side that the ray came from.
    pub point: Vec3A,
    /// Unit normal of the triangle, facing the ray.
    pub geometric_normal: Vec3A,
    /// Unit shading normal, on the same side.
    pub normal: Vec3A,
}

/// `v` with length 1.
#[inline]
pub fn normalize3(v: Vec3A) -> Vec3A {
    v / v.dot(v).sqrt()
}

fn sign(negative: bool) -> f32 {
    if negative { -1.0 } else { 1.0 }
}

/// The surface at a triangle reference that the traversal returned.
pub fn surface_at(triangles: Triangles, scene: &Scene, ray: &Ray, triangle_ref: u32, epsilon: f32) -> Surface {
    let triangle_ref = &triangles.triangle_refs[triangle_ref as usize];
    let [a, b, c] = triangle_ref.vertices.map(|v| triangles.vertices[v as usize]);
    let (pa, pb, pc) = (a.position_a(), b.position_a(), c.position_a());
    let hit = triangles.surface(ray, triangle_ref);
    let geometric_normal = normalize3((pb - pa).cross(pc - pa));
    let geometric_normal = geometric_normal * sign(geometric_normal.dot(ray.direction) > 0.0);
    let normal = a.normal_a() * hit.w + b.normal_a() * hit.u + c.normal_a() * hit.v;
    let normal = if normal.dot(normal) < 1.0e-12 {
        geometric_normal // opposite normals cancelled, or the file's were zero
    } else {
        let normal = normalize3(normal);
        normal * sign(normal.dot(geometric_normal) < 0.0)
    };
    let on_triangle = pa * hit.w + pb * hit.u + pc * hit.v;
    Surface {
        t: hit.t,
        triangle: triangle_ref.triangle,
        material: scene.triangles[triangle_ref.triangle as usize].material,
        point: on_triangle + geometric_normal * epsilon,
        geometric_normal,
        normal,
    }
}

/// Diffuse and specular light from one point light.
pub fn phong(surface: &Surface, material: &Material, light: &Light, view: Vec3A) -> Vec3A {
    let to_light = normalize3(Vec3A::from(light.position) - surface.point);
    let cosine = surface.normal.dot(to_light);
    if cosine <= 0.0 {
        return Vec3A::ZERO;
    }
    let mirrored = surface.normal * (2.0 * cosine) - to_light;
    let highlight = (-mirrored.dot(view)).max(1.0e-6).powf(material.exponent);
    (Vec3A::from(material.diffuse) * cosine + Vec3A::from(material.specular) * highlight) * Vec3A::from(light.colour)
}

/// The mirrored ray. A shading normal may mirror it into the surface: then the triangle's own normal does it.
pub fn reflected_ray(surface: &Surface, direction: Vec3A) -> Ray {
    let mut mirrored = direction - surface.normal * (2.0 * surface.normal.dot(direction));
    if mirrored.dot(surface.geometric_normal) <= 0.0 {
        mirrored = direction - surface.geometric_normal * (2.0 * surface.geometric_normal.dot(direction));
    }
    Ray::new(surface.point, normalize3(mirrored))
}

/// Eight bits per channel, red lowest, alpha 255.
pub fn rgba8(colour: Vec3A) -> u32 {
    let channel = |x: f32| (x.clamp(0.0, 1.0) * 255.0 + 0.5) as u32;
    channel(colour.x) | channel(colour.y) << 8 | channel(colour.z) << 16 | 255 << 24
}
