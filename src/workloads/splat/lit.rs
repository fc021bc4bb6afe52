//! A scene as radiometry sees it: albedos, point lights with a flux, and the extent that lengths follow.

use crate::error::{Error, Result};
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::backend::{shadow_reach, surface_epsilon};
use glam::Vec3;
use std::sync::Arc;

/// A point light that emits uniformly in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// In the scene's coordinates in memory.
    pub position: Vec3,
    /// Power per channel, 0 or more.
    pub flux: Vec3,
}

/// A scene with its light.
#[derive(Clone, Debug)]
pub struct LitScene {
    /// The diffuse colours of its materials are albedos, 0 to 1 per channel.
    pub scene: Arc<Scene>,
    /// At least one.
    pub lights: Vec<PointLight>,
    /// The box that radius, near, far and epsilon follow; the scene's bounds unless its catalogue entry gives another one.
    pub extent: Aabb,
    /// What a reader should know: clamped albedos, a light that was made up.
    pub warnings: Vec<String>,
}

/// The paths of one light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightShare {
    /// Index into [`LitScene::lights`].
    pub light: usize,
    /// Number of its first path; its paths follow each other.
    pub first_path: u32,
    /// Its paths, at least 1.
    pub paths: u32,
    /// Flux of one of them per channel.
    pub path_flux: Vec3,
}

impl LitScene {
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

    /// How the lights share paths: in proportion to their power (the sum of their channels), rounded to the largest
    /// remainders, each light with at least one.
    ///
    /// # Errors
    /// [`Error::Input`] for fewer paths than lights.
    pub fn shares(&self, paths: u32) -> Result<Vec<LightShare>> {
        let lights = self.lights.len() as u32;
        if paths < lights {
            let problem = format!("{paths} paths are fewer than the scene's {lights} lights");
            return Err(Error::argument("--paths", problem, format!("give at least {lights}")));
        }
        let power = |light: &PointLight| light.flux.as_dvec3().element_sum();
        let all: f64 = self.lights.iter().map(power).sum();
        // One path each, the others by power; lights without any power share alike
        let free = f64::from(paths - lights);
        let part = |light: &PointLight| if all > 0.0 { power(light) / all } else { 1.0 / f64::from(lights) };
        let wanted: Vec<f64> = self.lights.iter().map(|light| free * part(light)).collect();
        let mut counts: Vec<u32> = wanted.iter().map(|wanted| 1 + *wanted as u32).collect();
        let mut by_remainder: Vec<usize> = (0..counts.len()).collect();
        by_remainder.sort_by(|&a, &b| wanted[b].fract().total_cmp(&wanted[a].fract()).then(a.cmp(&b)));
        let mut left = paths.saturating_sub(counts.iter().sum());
        for &light in by_remainder.iter().cycle() {
            if left == 0 {
                break;
            }
            counts[light] += 1;
            left -= 1;
        }
        let mut first_path = 0;
        let share = |(light, (of, paths)): (usize, (&PointLight, u32))| {
            let share = LightShare { light, first_path, paths, path_flux: of.flux / paths as f32 };
            first_path += paths;
            share
        };
        Ok(self.lights.iter().zip(counts).enumerate().map(share).collect())
    }
}
