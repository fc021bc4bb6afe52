//! Surfaces as light meets them: flat, whatever their vertex normals are. Twin of `kernels/splat/surface.wgsl`.

use crate::math::{Hit, MISS, Ray};
use crate::scene::Scene;
use crate::workloads::trace::given::TraceRay;
use crate::workloads::trace::intersect::watertight;
use crate::workloads::trace::shade::normalize3;
use glam::{Vec3, Vec3A};

/// A point that a ray hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Lifted off the triangle, to the side that the ray came from.
    pub point: Vec3A,
    /// Unit normal of the triangle, facing the ray.
    pub normal: Vec3A,
    /// Of the triangle's material, per channel.
    pub albedo: Vec3,
}

/// The surface that a ray hit, if it hit any: point and normal have the bits of [`crate::workloads::trace::shade`].
pub fn surface_at(scene: &Scene, ray: &TraceRay, hit: Hit, epsilon: f32) -> Option<Surface> {
    if hit.triangle == MISS {
        return None;
    }
    let triangle = &scene.triangles[hit.triangle as usize];
    let corners = triangle.vertices.map(|vertex| scene.vertices[vertex as usize].position_a());
    let [a, b, c] = corners;
    let ray = Ray::new(ray.origin.into(), ray.direction.into());
    let weights = watertight::surface(&ray, corners);
    let normal = normalize3((b - a).cross(c - a));
    let normal = normal * if normal.dot(ray.direction) > 0.0 { -1.0 } else { 1.0 };
    let point = (a * weights.w + b * weights.u + c * weights.v) + normal * epsilon;
    Some(Surface { point, normal, albedo: scene.materials[triangle.material as usize].diffuse })
}
