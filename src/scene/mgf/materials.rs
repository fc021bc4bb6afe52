//! Material contexts, and their conversion to Phong materials.

use super::colour::Chromaticity;
use crate::scene::Material;
use glam::{DVec3, Vec3};

/// The largest roughness (RMS slope of the facets) of a mirror.
pub const SMOOTH: f64 = 0.05;

/// A reflectance, transmittance or emittance, and its colour.
#[derive(Clone, Copy, Default)]
pub struct ColouredAmount {
    /// 0 to 1; lumens per square metre for an emittance.
    pub amount: f64,
    pub colour: Chromaticity,
}

impl ColouredAmount {
    fn rgb(self) -> DVec3 {
        self.colour.rgb() * self.amount
    }
}

/// A material context. The default is a perfect absorber.
#[derive(Clone, Copy, Default)]
pub struct MaterialContext {
    /// Diffuse reflectance, the entity `rd`.
    pub diffuse: ColouredAmount,
    /// Diffuse transmittance, the entity `td`.
    pub translucent: ColouredAmount,
    /// Emittance in lumens per square metre, the entity `ed`.
    pub emitted: ColouredAmount,
    /// Specular reflectance, the entity `rs`.
    pub specular: ColouredAmount,
    /// Roughness of the specular reflection: the RMS slope of the facets.
    pub roughness: f64,
    /// Specular transmittance, the entity `ts`.
    pub transparent: ColouredAmount,
}

impl MaterialContext {
    /// The material of a name that is not defined.
    pub fn grey() -> MaterialContext {
        let diffuse = ColouredAmount { amount: 0.5, colour: Chromaticity::default() };
        MaterialContext { diffuse, ..MaterialContext::default() }
    }

    /// Converts the context to a Phong material.
    pub fn material(&self) -> Material {
        let most = DVec3::ONE;
        let diffuse = (self.diffuse.rgb() + self.translucent.rgb() + self.transparent.rgb() * 0.5).min(most).as_vec3();
        let specular = self.specular.rgb().min(most).as_vec3();
        // The exponent at which the lobe has the slope of the roughness. A perfect mirror has the largest exponent.
        let exponent = if self.roughness > 0.0 { (2.0 / self.roughness.powi(2) - 2.0).clamp(1.0, 1e4) } else { 1e4 };
        let mirror = if self.roughness <= SMOOTH { self.specular.amount.clamp(0.0, 1.0) } else { 0.0 };
        let own = if self.emitted.amount > 0.0 { self.emitted.colour.rgb().min(most).as_vec3() } else { Vec3::ZERO };
        let material = Material { ambient: diffuse * 0.1 + own, ..Material::matt(diffuse) };
        material.shiny(specular, exponent as f32, mirror as f32)
    }
}
