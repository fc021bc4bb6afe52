//! Hit points, normals and albedos of the reference.

use crate::math::{Hit, MISS};
use crate::scene::Scene;
use crate::workloads::trace::backend::TraceRay;
use glam::DVec3;

/// A point of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Lifted off the surface, to the side that the ray came from.
    pub position: DVec3,
    /// Unit normal of the triangle, on that side.
    pub normal: DVec3,
    /// Per channel, 0 to 1.
    pub albedo: DVec3,
}

/// The point that a ray hits: where its line meets the triangle's plane. Of the hit only the triangle matters, unless
/// the line is parallel to the plane. Nothing for a miss and for a triangle without area.
pub fn point_of(scene: &Scene, epsilon: f64, ray: &TraceRay, hit: Hit) -> Option<Point> {
    if hit.triangle == MISS {
        return None;
    }
    let triangle = scene.triangles.get(hit.triangle as usize)?;
    let [a, b, c] = triangle.vertices.map(|v| scene.vertices[v as usize].position.as_dvec3());
    let normal = (b - a).cross(c - a).try_normalize()?;
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let approach = normal.dot(direction);
    let distance = if approach == 0.0 { f64::from(hit.t) } else { normal.dot(a - origin) / approach };
    let normal = if approach > 0.0 { -normal } else { normal };
    let position = origin + direction * distance + normal * epsilon;
    Some(Point { position, normal, albedo: scene.materials[triangle.material as usize].diffuse.as_dvec3() })
}
