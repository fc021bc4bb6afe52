//! A scene as radiometry sees it: albedos, point lights with a flux, and the extent that lengths follow.

use super::lights::{self, LightChoice};
use crate::error::{Error, Result};
use crate::math::Aabb;
use crate::scene::Scene;
use crate::scene::radiometry::{Albedo, Radiometry};
use crate::workloads::trace::backend::{shadow_reach, surface_epsilon};
use glam::{DVec3, Vec3};
use std::sync::Arc;

pub use super::lights::PointLight;
pub use super::shares::LightShare;

/// A scene with its light.
#[derive(Clone, Debug)]
pub struct LitScene {
    /// The diffuse colours of its materials are albedos, 0 to 1 per channel.
    pub scene: Arc<Scene>,
    /// At least one.
    pub lights: Vec<PointLight>,
    /// The box that radius, near, far and epsilon follow; the scene's bounds unless its catalogue entry gives another
    /// one.
    pub extent: Aabb,
    /// What a reader should know: clamped albedos, a light that was made up.
    pub warnings: Vec<String>,
}

impl LitScene {
    /// Gives a scene its light. Albedos are the catalogue's, then the materials' diffuse colours, at most 1. Lights are
    /// those chosen, otherwise the catalogue's, otherwise the scene's, whose colour is multiplied by the default flux,
    /// otherwise one in the middle of the extent.
    ///
    /// # Errors
    /// [`Error::Input`] for an extent without size, and for a chosen light whose position or flux is out of the scene's
    /// range.
    pub fn new(mut scene: Scene, radiometry: Option<&Radiometry>, chosen: &[LightChoice]) -> Result<LitScene> {
        let mut warnings = apply_albedos(&mut scene, radiometry);
        let extent = radiometry.and_then(|radiometry| radiometry.extent);
        let extent = extent.map_or_else(|| scene.bounds(), |extent| extent.place(&scene.placement));
        let diagonal = extent.diagonal();
        if !(diagonal.is_finite() && diagonal > 0.0) {
            let problem = format!("the extent of {} has the diagonal {diagonal}", scene.name);
            return Err(Error::argument("--scene", problem, "photon splatting takes its lengths from the extent"));
        }
        let lights = lights::choose(&scene, radiometry, chosen, extent, &mut warnings)?;
        Ok(LitScene { scene: Arc::new(scene), lights, extent, warnings })
    }

    /// The same scene with other lights. Its warnings are about these lights.
    ///
    /// # Errors
    /// [`Error::Input`] for a light whose position or flux is out of the scene's range.
    pub fn relit(&self, chosen: &[LightChoice]) -> Result<LitScene> {
        let mut warnings = Vec::new();
        let lights = lights::choose(&self.scene, None, chosen, self.extent, &mut warnings)?;
        Ok(LitScene { scene: self.scene.clone(), lights, extent: self.extent, warnings })
    }

    /// The flux of one of the lights for lengths as in the scene's file, as users give it.
    pub fn file_flux(&self, light: &PointLight) -> DVec3 {
        lights::file_flux(&self.scene.placement, light.flux)
    }

    /// Diagonal of the extent, which lengths are shares of.
    pub fn diagonal(&self) -> f32 {
        self.extent.diagonal()
    }

    /// The distance from a surface at which rays start.
    pub fn epsilon(&self) -> f32 {
        surface_epsilon(self.extent)
    }

    /// The greatest distance from a point at which a shadow ray starts.
    pub fn reach(&self) -> f32 {
        shadow_reach(self.scene.bounds())
    }

    /// Distance of the nearest slice of clusters: a two-thousandth of the diagonal.
    pub fn near(&self) -> f32 {
        self.diagonal() / 2000.0
    }

    /// Distance of the farthest slice: five diagonals.
    pub fn far(&self) -> f32 {
        self.diagonal() * 5.0
    }

    /// Radius of influence of lights where the falloff is the source's: the diagonal.
    pub fn influence(&self) -> f32 {
        self.diagonal()
    }
}

/// Makes the diffuse colours of a scene albedos: the catalogue's where it has any, and at most 1. Returns warnings.
pub fn apply_albedos(scene: &mut Scene, radiometry: Option<&Radiometry>) -> Vec<String> {
    let named = radiometry.and_then(|radiometry| set_albedos(scene, &radiometry.albedo));
    named.into_iter().chain(clamp_albedos(scene)).collect()
}

/// Sets diffuse colours by the names of materials. Returns a warning about names that no material has.
fn set_albedos(scene: &mut Scene, albedos: &[Albedo]) -> Option<String> {
    let mut absent = Vec::new();
    for Albedo { material, colour } in albedos {
        let named = scene.materials.iter_mut().zip(&scene.material_names).filter(|(_, name)| *name == material);
        let mut found = false;
        for (named, _) in named {
            named.diffuse = (*colour).into();
            found = true;
        }
        if !found {
            absent.push(material.as_str());
        }
    }
    let names = absent.join(", ");
    (!absent.is_empty()).then(|| format!("the catalogue has albedos of materials that the scene has not: {names}"))
}

/// Limits diffuse colours to 1. Returns a warning about those that were above.
fn clamp_albedos(scene: &mut Scene) -> Option<String> {
    let bright = scene.materials.iter_mut().filter(|material| material.diffuse.max_element() > 1.0);
    let clamped = bright.map(|material| material.diffuse = material.diffuse.min(Vec3::ONE)).count();
    (clamped > 0).then(|| format!("{clamped} materials reflect more than they receive: their albedo is at most 1"))
}
