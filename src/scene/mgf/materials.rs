//! Materials, and what they become.

use super::colour::Chromaticity;
use crate::scene::Material;
use glam::{DVec3, Vec3};

/// Roughness (RMS slope of the facets) up to which a surface is a mirror.
pub const SMOOTH: f64 = 0.05;

/// A share of light and its colour.
#[derive(Clone, Copy, Default)]
pub struct Share {
    /// 0 to 1; of what is emitted, lumens per square metre.
    pub amount: f64,
    /// Without brightness.
    pub colour: Chromaticity,
}

impl Share {
    fn rgb(self) -> DVec3 {
        self.colour.rgb() * self.amount
    }
}

/// A material context. By default a perfect absorber.
#[derive(Clone, Copy, Default)]
pub struct Surface {
    /// `rd`.
    pub diffuse: Share,
    /// `td`.
    pub through: Share,
    /// `ed`, lumens per square metre.
    pub emitted: Share,
    /// `rs`.
    pub specular: Share,
    /// Of `rs`: the RMS slope of its facets.
    pub roughness: f64,
    /// `ts`.
    pub transparent: Share,
}

impl Surface {
    /// The scene's material.
    pub fn material(&self) -> Material {
        let most = DVec3::ONE;
        let diffuse = (self.diffuse.rgb() + self.through.rgb() + self.transparent.rgb() * 0.5).min(most).as_vec3();
        let specular = self.specular.rgb().min(most).as_vec3();
        // A lobe of this width has the roughness's slope; a perfect mirror would have none to be seen
        let exponent = if self.roughness > 0.0 { (2.0 / self.roughness.powi(2) - 2.0).clamp(1.0, 1e4) } else { 1e4 };
        let mirror = if self.roughness <= SMOOTH { self.specular.amount.clamp(0.0, 1.0) } else { 0.0 };
        let own = if self.emitted.amount > 0.0 { self.emitted.colour.rgb().min(most).as_vec3() } else { Vec3::ZERO };
        let material = Material { ambient: diffuse * 0.1 + own, ..Material::matt(diffuse) };
        material.shiny(specular, exponent as f32, mirror as f32)
    }
}
