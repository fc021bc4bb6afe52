//! The same model in double precision and by other formulas: distances from the foot of the perpendicular, colours by
//! recursion. Its picture differs from the others by rounding, and at edges.

use super::super::scene::PackedSphere;
use super::super::view::View;
use glam::{DVec3, Vec3};

/// Linear RGB, rows from the top.
pub fn render(spheres: &[PackedSphere], view: &View) -> Vec<[f64; 3]> {
    let pixels = (0..view.height).flat_map(|y| (0..view.width).map(move |x| (x, y)));
    pixels.map(|(x, y)| pixel(spheres, view, f64::from(x), f64::from(y)).to_array()).collect()
}

fn pixel(spheres: &[PackedSphere], view: &View, x: f64, y: f64) -> DVec3 {
    let across = view.right.as_dvec3() * (x + 0.5);
    let direction = view.corner.as_dvec3() + across + view.down.as_dvec3() * (y + 0.5);
    seen(spheres, view, view.origin.as_dvec3(), direction.normalize(), view.trips)
}

/// What comes back along a ray of length 1 with at most so many rays.
fn seen(spheres: &[PackedSphere], view: &View, origin: DVec3, direction: DVec3, rays: u32) -> DVec3 {
    if rays == 0 {
        return DVec3::ZERO;
    }
    let distances = spheres.iter().map(|sphere| distance(sphere, origin, direction, f64::from(view.epsilon)));
    let nearest = distances.zip(spheres).filter_map(|(t, sphere)| t.map(|t| (t, sphere)));
    let Some((t, sphere)) = nearest.min_by(|a, b| a.0.total_cmp(&b.0)) else {
        return DVec3::ZERO;
    };
    let position = origin + direction * t;
    let normal = (position - sphere.center.as_dvec3()).normalize();
    let reflected = seen(spheres, view, position, direction.reflect(normal), rays - 1);
    let color = sphere.color.as_dvec3();
    lighting(view, direction, normal, color) + reflected * color * f64::from(view.intensity)
}

/// Along the ray to the foot of the perpendicular from the centre, then back, or on, by half the chord.
fn distance(sphere: &PackedSphere, origin: DVec3, direction: DVec3, epsilon: f64) -> Option<f64> {
    let to_center = sphere.center.as_dvec3() - origin;
    let foot = to_center.dot(direction);
    let half_chord2 = f64::from(sphere.radius2) - (to_center - direction * foot).length_squared();
    if half_chord2 <= 0.0 {
        return None;
    }
    let half_chord = half_chord2.sqrt();
    [foot - half_chord, foot + half_chord].into_iter().find(|&t| t > epsilon)
}

/// The light's mirror image is seen where the view's mirror image points to the light.
fn lighting(view: &View, direction: DVec3, normal: DVec3, color: DVec3) -> DVec3 {
    let wide = |v: Vec3| v.as_dvec3();
    let towards_light = wide(view.light);
    let cosine = normal.dot(towards_light);
    if cosine <= 0.0 {
        return color * wide(view.ambient);
    }
    let specular = direction.reflect(normal).dot(towards_light).max(0.0).powi(32);
    color * (wide(view.ambient) + wide(view.light_color) * cosine) + wide(view.light_color) * specular
}
