//! What the catalogue says about a scene for simulations of light: lights with a flux, the extent that lengths follow,
//! albedos, a camera path. Positions are in the coordinates of the scene's file, after its options `up` and `scale`.

use super::Placement;
use super::placement::MAX_COORDINATE;
use crate::math::Aabb;
use glam::{DVec3, Vec3};
use serde::Deserialize;

/// An entry's table `[scene.radiometry]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Radiometry {
    /// Point lights, which replace those of the scene; empty if the scene's are used.
    #[serde(default)]
    pub light: Vec<FluxLight>,
    /// The box that lengths follow, if it is not that of all triangles.
    pub extent: Option<Extent>,
    /// Name of a camera path in `camera-paths/`, if it is not the scene's.
    pub camera_path: Option<String>,
    /// Diffuse colours by the names of materials.
    #[serde(default)]
    pub albedo: Vec<Albedo>,
}

/// A point light that emits uniformly in all directions.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FluxLight {
    /// Position.
    pub position: [f64; 3],
    /// Power; without it, the workload's default.
    pub flux: Option<Flux>,
}

/// The power of a light, 0 or more.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Flux {
    /// The same in all channels.
    Grey(f32),
    /// Red, green, blue.
    Channels([f32; 3]),
}

/// A box.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Extent {
    /// Lower corner.
    pub min: [f64; 3],
    /// Upper corner.
    pub max: [f64; 3],
}

/// The diffuse colour of a material, whatever the file says.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Albedo {
    /// The material's name in the file.
    pub material: String,
    /// Share of the light that is reflected per channel, 0 to 1.
    pub colour: [f32; 3],
}

impl Flux {
    /// Red, green, blue.
    pub fn channels(self) -> Vec3 {
        match self {
            Flux::Grey(power) => Vec3::splat(power),
            Flux::Channels(channels) => channels.into(),
        }
    }
}

impl Extent {
    /// The box in the coordinates of a scene with this placement.
    pub fn place(&self, placement: &Placement) -> Aabb {
        let [min, max] = [self.min, self.max].map(|corner| placement.place(DVec3::from(corner)));
        Aabb { min, max }
    }
}

impl Radiometry {
    /// What cannot be, if anything: a mistake of the catalogue.
    pub fn fault(&self) -> Option<String> {
        let is_coordinate = |x: &f64| x.abs() <= MAX_COORDINATE;
        let is_share = |x: &f32| (0.0..=1.0).contains(x);
        if let Some(albedo) = self.albedo.iter().find(|albedo| !albedo.colour.iter().all(is_share)) {
            return Some(format!("the albedo of {} is not 0 to 1 per channel", albedo.material));
        }
        for light in &self.light {
            let flux = light.flux.unwrap_or(Flux::Grey(1.0)).channels();
            if !(light.position.iter().all(is_coordinate) && flux.is_finite() && flux.min_element() >= 0.0) {
                return Some(format!("the light at {:?} is too far away, or its flux is negative", light.position));
            }
        }
        let extent = self.extent.as_ref().map_or(([0.0; 3], [1.0; 3]), |extent| (extent.min, extent.max));
        // Squares of lengths are in the range of floats
        let is_range =
            |(min, max): (&f64, &f64)| is_coordinate(min) && is_coordinate(max) && max - min >= 1.0 / MAX_COORDINATE;
        (!extent.0.iter().zip(&extent.1).all(is_range)).then(|| "the extent has no volume".to_owned())
    }
}
