//! Scenes of spheres: files, the three that are part of the program, and random ones of any size.

mod fields;
mod file;
mod load;
mod random;

pub use file::schema;
pub use load::MAX_BYTES;

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

/// Names of the scenes that are part of the program, the default first.
pub const NAMES: [&str; 3] = ["default", "random20", "random100"];

/// Most spheres of a scene.
pub const MAX_SPHERES: usize = 100_000;

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

impl Scene {
    /// The scene of this name: one of [`NAMES`], `random:spheres=N,seed=S`, or the path of a file.
    ///
    /// # Errors
    /// [`crate::Error::Input`] for an unknown name, a bad option, and whatever is wrong with a file.
    pub fn load(spec: &str) -> crate::Result<Scene> {
        load::load(spec)
    }

    /// Length of the diagonal of the box around all spheres.
    pub fn extent(&self) -> f64 {
        extent(&self.spheres)
    }

    /// Puts a scene together: computes the hash, and the least distance of a hit from the share of the extent.
    fn new(name: &str, camera: Camera, light: Light, (intensity, epsilon): (f32, f64), spheres: Vec<Sphere>) -> Scene {
        let rendering = Rendering { intensity, epsilon: (epsilon * extent(&spheres)) as f32 };
        let hash = hash(&camera, &light, &rendering, &spheres);
        Scene { name: name.to_owned(), hash, camera, light, rendering, spheres }
    }
}

fn extent(spheres: &[Sphere]) -> f64 {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for sphere in spheres {
        let (center, radius) = (sphere.position.as_dvec3(), f64::from(sphere.radius));
        (min, max) = (min.min(center - radius), max.max(center + radius));
    }
    (max - min).length()
}

/// BLAKE3 of all numbers, hexadecimal. Zero counts as the same with either sign.
fn hash(camera: &Camera, light: &Light, rendering: &Rendering, spheres: &[Sphere]) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut wide = |x: f64| {
        hasher.update(&(x + 0.0).to_le_bytes());
    };
    let vectors = [camera.position, camera.forward, camera.focus_point, light.direction];
    vectors.iter().flat_map(|v| v.to_array()).for_each(&mut wide);
    wide(camera.fov);
    wide(camera.orbit_velocity);
    let mut single = |x: f32| {
        hasher.update(&(x + 0.0).to_le_bytes());
    };
    [light.color, light.ambient].iter().flat_map(|v| v.to_array()).for_each(&mut single);
    single(rendering.intensity);
    single(rendering.epsilon);
    for Sphere { position, radius, color } in spheres {
        position.to_array().into_iter().chain([*radius]).chain(color.to_array()).for_each(&mut single);
    }
    hasher.finalize().to_hex().to_string()
}
