//! The axes that boxes are aligned to. Twin of `placed` of `kernels/splat/clusters/placement.wgsl`.

use super::setting::Space;
use crate::camera::Camera;
use crate::math::Aabb;
use glam::{Vec3, Vec3A};

/// Rounding of a position along these axes, as a share of its distance from the camera: eight units of the last place.
const ROUNDING: f32 = 1.0 / (1 << 20) as f32;

/// A rigid frame of reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Its origin.
    pub origin: Vec3,
    /// Its axes, unit vectors.
    pub axes: [Vec3; 3],
    /// What a distance in it may be too large by: photons are splatted with so much more radius, so that rounding
    /// leaves none out.
    pub margin: f32,
}

impl Placement {
    /// The frame of a view into a scene of this extent.
    pub fn new(space: Space, camera: &Camera, extent: Aabb) -> Placement {
        match space {
            Space::World => Placement { origin: Vec3::ZERO, axes: [Vec3::X, Vec3::Y, Vec3::Z], margin: 0.0 },
            Space::View => {
                let right = camera.direction.cross(camera.up).normalize();
                let up = right.cross(camera.direction).normalize();
                let axes = [right, up, camera.direction];
                let reach = (camera.position - extent.center()).length() + extent.diagonal();
                Placement { origin: camera.position, axes, margin: reach * ROUNDING }
            }
        }
    }

    /// A point in this frame.
    pub fn placed(&self, point: Vec3A) -> Vec3A {
        let way = point - Vec3A::from(self.origin);
        let [x, y, z] = self.axes.map(|axis| way.dot(axis.into()));
        Vec3A::new(x, y, z)
    }

    /// Square of the distance from a photon up to which boxes are touched; 0 for the radius 0.
    pub fn reach2(&self, radius: f32) -> f32 {
        let reach = if radius > 0.0 { radius + self.margin } else { 0.0 };
        reach * reach
    }
}
