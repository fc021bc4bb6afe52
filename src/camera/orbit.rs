//! Object orbit and light orbit, in units of the bounds' radius (half the diagonal), around the bounds' centre.

use super::Camera;
use crate::math::Aabb;
use crate::scene::{Light, Scene};
use glam::Vec3;

/// The camera turns once around the scene and looks at its centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Orbit {
    /// From the axis through the centre to the camera, in radii; `None`: as near as the whole scene stays in view from
    /// every side.
    pub distance: Option<f32>,
    /// Above the centre, in radii.
    pub height: f32,
    /// Where the turn starts, in degrees: 0 looks along -z (with y up), 90 along -x.
    pub start: f32,
}

/// A fixed camera; the light turns once around the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightOrbit {
    /// The camera: the first frame of this orbit.
    pub camera: Orbit,
    /// From the axis to the light, in radii.
    pub light_distance: f32,
    /// Above the centre, in radii.
    pub light_height: f32,
    /// Where its turn starts, in degrees.
    pub light_start: f32,
    pub light_colour: Vec3,
}

/// An orbit around given bounds.
pub(super) struct Fitted {
    center: Vec3,
    up: Vec3,
    /// In units of the scene.
    distance: f32,
    height: f32,
    start: f32,
    field_of_view: f32,
}

/// Points per ring at which a fit is tried, and rings from the bottom to the top.
const AROUND: usize = 48;
const RINGS: usize = 64;
/// What a fitted image leaves free at its border, as a factor of the half image.
const MARGIN: f32 = 0.96;

/// The horizontal unit vector at an angle (degrees) around `up`.
fn around(up: Vec3, degrees: f32) -> Vec3 {
    let up = up.normalize();
    // The axis that is farthest from up, z before x before y, gives angle 0; for y up that is z.
    let front = [Vec3::Z, Vec3::X, Vec3::Y].into_iter().min_by(|a, b| a.dot(up).abs().total_cmp(&b.dot(up).abs()));
    let front = front.unwrap_or(Vec3::Z);
    let front = (front - up * front.dot(up)).normalize();
    let side = up.cross(front);
    let angle = degrees.to_radians();
    front * angle.cos() + side * angle.sin()
}

impl Orbit {
    /// Fixes the orbit for this scene. The image is taken to be square.
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
                // Halving: from beyond where the bounding sphere fits, down to the scene's edge.
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
    /// The camera after a share of the turn.
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

    /// What is seen in the whole turn is the solid that the scene sweeps when it turns around the axis: for slices along
    /// the axis, the slice's two heights above the centre and the radius of its farthest vertex.
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

    /// True if all of the rings are in view.
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
    /// The light after a share of the turn.
    pub fn light(&self, bounds: Aabb, up: Vec3, share: f32) -> Light {
        let radius = bounds.diagonal() * 0.5;
        let outward = around(up, self.light_start + share * 360.0);
        let offset = outward * self.light_distance + up.normalize() * self.light_height;
        Light::new(bounds.center() + offset * radius, self.light_colour)
    }
}
