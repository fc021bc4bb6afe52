//! How lights share the paths of photons.

use super::lights::PointLight;
use super::lit::LitScene;
use crate::error::{Error, Result};
use glam::Vec3;

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
        // Floors lack less than a path a light. Where a part was rounded up to a whole number they may have one too
        // many.
        let mut left = i64::from(paths) - counts.iter().map(|&count| i64::from(count)).sum::<i64>();
        for &light in by_remainder.iter().cycle().take(left.max(0) as usize) {
            counts[light] += 1;
        }
        while left < 0 {
            let most = (0..counts.len()).max_by_key(|&light| counts[light]).unwrap_or_default();
            counts[most] -= 1;
            left += 1;
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
