//! Orbits of the camera and of the light around the centre of the bounds. Lengths are in radii of the bounds (half the
//! diagonal).

use super::Camera;
use crate::math::Aabb;
use crate::scene::{Light, Scene};
use glam::Vec3;

/// The camera turns once around the scene and looks at its centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Orbit {
    /// Distance of the camera from the axis through the centre, in radii; `None` chooses the smallest distance at which
    /// the whole scene is in view in all frames.
    pub distance: Option<f32>,
    /// Height above the centre, in radii.
    pub height: f32,
    /// Angle of the first frame in degrees: at 0 the camera looks along -z (with y up), at 90 along -x.
    pub start: f32,
}

/// A fixed camera; the light turns once around the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightOrbit {
    /// The camera stays at the first frame of this orbit.
    pub camera: Orbit,
    /// Distance of the light from the axis, in radii.
    pub light_distance: f32,
    /// Height of the light above the centre, in radii.
    pub light_height: f32,
    /// Angle of the light in the first frame, in degrees.
    pub light_start: f32,
    pub light_colour: Vec3,
}

/// An orbit around the bounds of a scene. Lengths are in the scene's units in memory.
pub(super) struct Fitted {
    center: Vec3,
    up: Vec3,
    distance: f32,
    height: f32,
    start: f32,
    field_of_view: f32,
}

/// Number of points per ring at which a distance is checked.
const AROUND: usize = 48;
/// Number of slices of the scene along the axis.
const RINGS: usize = 64;
/// Share of the half image that a fitted scene may cover; the rest is a margin.
const MARGIN: f32 = 0.96;

/// The horizontal unit vector at an angle (degrees) around `up`.
fn around(up: Vec3, degrees: f32) -> Vec3 {
    let up = up.normalize();
    // The coordinate axis that is most nearly perpendicular to up (of equal ones, z before x before y) has angle 0; for
    // y up that is z.
    let front = [Vec3::Z, Vec3::X, Vec3::Y].into_iter().min_by(|a, b| a.dot(up).abs().total_cmp(&b.dot(up).abs()));
    let front = front.unwrap_or(Vec3::Z);
    let front = (front - up * front.dot(up)).normalize();
    let side = up.cross(front);
    let angle = degrees.to_radians();
    front * angle.cos() + side * angle.sin()
}

impl Orbit {
    /// The orbit around this scene, for a square image.
    pub fn fit(&self, scene: &Scene, bounds: Aabb, up: Vec3, field_of_view: f32) -> Fitted {
        let radius = bounds.diagonal() * 0.5;
        let mut fitted = Fitted {
            center: bounds.center(),
            up: up.normalize(),
            distance: 0.0,
            height: self.height * radius,
            start: self.start,
            field_of_view,
        };
        fitted.distance = match self.distance {
            Some(distance) => distance * radius,
            None => {
                let rings = fitted.rings(scene, radius);
                // Bisection between the radius of the scene and a distance at which the bounding sphere is in view.
                let (mut near, mut far) = (radius, radius * (1.0 + 2.0 / (field_of_view.to_radians() * 0.5).sin()));
                for _ in 0..24 {
                    fitted.distance = (near + far) * 0.5;
                    if fitted.shows(&rings) { far = fitted.distance } else { near = fitted.distance }
                }
                far
            }
        };
        fitted
    }
}

impl Fitted {
    /// The camera after a share of the turn, 0 to 1.
    pub fn camera(&self, share: f32) -> Camera {
        let outward = around(self.up, self.start + share * 360.0);
        let offset = outward * self.distance + self.up * self.height;
        Camera {
            position: self.center + offset,
            direction: (-offset).normalize_or_zero(),
            up: self.up,
            field_of_view: self.field_of_view,
        }
    }

    /// The solid of revolution that the scene sweeps when it turns around the axis, as rings of `(height, radius)`:
    /// both borders of each slice along the axis, with the radius of the farthest vertex in the slice.
    fn rings(&self, scene: &Scene, radius: f32) -> Vec<(f32, f32)> {
        let mut farthest = [-1.0f32; RINGS];
        let slice = 2.0 * radius / RINGS as f32;
        for vertex in scene.triangles.iter().flat_map(|t| t.vertices).map(|v| scene.vertices[v as usize].position) {
            let offset = vertex - self.center;
            let height = offset.dot(self.up);
            let index = (((height + radius) / slice).max(0.0) as usize).min(RINGS - 1);
            farthest[index] = farthest[index].max((offset - self.up * height).length_squared());
        }
        let used = farthest.iter().enumerate().filter(|(_, far)| **far >= 0.0);
        used.flat_map(|(i, far)| [i, i + 1].map(|border| (border as f32 * slice - radius, far.sqrt()))).collect()
    }

    /// True if all rings are in view.
    fn shows(&self, rings: &[(f32, f32)]) -> bool {
        let half = (self.field_of_view.to_radians() * 0.5).tan() * MARGIN;
        let camera = self.camera(0.0);
        let right = camera.direction.cross(camera.up).normalize();
        let up = right.cross(camera.direction);
        let turned = |point: usize| around(self.up, point as f32 * 360.0 / AROUND as f32);
        (0..AROUND).map(turned).all(|outward| {
            rings.iter().all(|&(height, radius)| {
                let to = self.center + outward * radius + self.up * height - camera.position;
                let depth = to.dot(camera.direction);
                depth > 0.0 && to.dot(right).abs() <= half * depth && to.dot(up).abs() <= half * depth
            })
        })
    }
}

impl LightOrbit {
    /// The light after a share of the turn, 0 to 1.
    pub fn light(&self, bounds: Aabb, up: Vec3, share: f32) -> Light {
        let radius = bounds.diagonal() * 0.5;
        let outward = around(up, self.light_start + share * 360.0);
        let offset = outward * self.light_distance + up.normalize() * self.light_height;
        Light::new(bounds.center() + offset * radius, self.light_colour)
    }
}
