//! Scenes of spheres.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

/// A scene, valid: at least one sphere, positive radii, finite numbers, a `forward` that is not vertical.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// As tables name it: `default`, `random:spheres=500,seed=7`, or a file.
    pub name: String,
    /// BLAKE3 of everything that decides the pictures, hexadecimal: equal for equal scenes, however they are written.
    pub hash: String,
    /// The one camera, at time 0.
    pub camera: Camera,
    /// All light.
    pub light: Light,
    /// What is the same for all surfaces.
    pub rendering: Rendering,
    /// At least one.
    pub spheres: Vec<Sphere>,
}

/// A pinhole camera that circles a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The viewer's place at time 0.
    pub position: DVec3,
    /// Viewing direction at time 0, of any length but 0, not vertical.
    pub forward: DVec3,
    /// Vertical field of view in degrees, above 0 and below 180.
    pub fov: f64,
    /// The orbit's axis is the vertical through this point.
    pub focus_point: DVec3,
    /// Radians per second; its sign is the direction, and a run takes its views evenly over one period.
    pub orbit_velocity: f64,
}

/// One directional light and an ambient term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// The direction in which the light shines, of any length but 0.
    pub direction: DVec3,
    /// Linear RGB, not negative.
    pub color: Vec3,
    /// Linear RGB, not negative.
    pub ambient: Vec3,
}

/// What is the same for all surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rendering {
    /// Share of the light that a reflection keeps, before the surface's colour: 0 to 1.
    pub intensity: f32,
    /// Least distance of a hit, in units of a ray's direction (which has length 1): in scene units.
    pub epsilon: f32,
}

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre.
    pub position: Vec3,
    /// Above 0.
    pub radius: f32,
    /// Linear RGB, 0 to 1.
    pub color: Vec3,
}

/// A sphere as all renderers read it, `Sphere` of `kernels/spheres/scene.wgsl`: 32 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct PackedSphere {
    /// Centre.
    pub center: Vec3,
    /// Square of the radius, rounded once.
    pub radius2: f32,
    /// Linear RGB.
    pub color: Vec3,
    /// Unused: 0.
    pub pad: f32,
}

impl Scene {
    /// The spheres in the form that renderers read, in the scene's order.
    pub fn packed(&self) -> Vec<PackedSphere> {
        let pack =
            |s: &Sphere| PackedSphere { center: s.position, radius2: s.radius * s.radius, color: s.color, pad: 0.0 };
        self.spheres.iter().map(pack).collect()
    }
}
