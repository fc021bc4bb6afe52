//! Point lights with a flux: what `--light` says, and which lights a scene has.

use crate::error::{Error, Result};
use crate::math::Aabb;
use crate::scene::placement::{MAX_COORDINATE, power_of_two};
use crate::scene::radiometry::Radiometry;
use crate::scene::{Placement, Scene};
use glam::{DVec3, Vec3};
use std::f32::consts::PI;

/// A point light that emits uniformly in all directions. Where lengths in memory are 2^exponent times those of the
/// file, its flux is 4^exponent times the file's: radiance, which is flux over squared lengths, is the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// In the scene's coordinates in memory.
    pub position: Vec3,
    /// Power per channel in memory, 0 or more; one channel at least is above 0.
    pub flux: Vec3,
}

/// A light as `--light` gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightChoice {
    /// In the coordinates of the scene's file.
    pub position: DVec3,
    /// Power per channel, for lengths as in the scene's file; without it, the default of the scene's extent.
    pub flux: Option<Vec3>,
}

/// Largest flux of a channel.
const MAX_FLUX: f32 = 1e18;

const HINT: &str = "write point:x=X,y=Y,z=Z, and flux=N or flux=R/G/B if it is not the default";

fn wrong<T>(problem: String) -> Result<T> {
    Err(Error::argument("--light", problem, HINT))
}

impl LightChoice {
    /// Parses `point:x=X,y=Y,z=Z[,flux=N|R/G/B]`, the keys in any order.
    ///
    /// # Errors
    /// [`Error::Input`] for anything else, for coordinates beyond 1e18, and for a flux that is zero or negative.
    pub fn parse(text: &str) -> Result<LightChoice> {
        let Some(settings) = text.trim().strip_prefix("point:") else {
            return wrong(format!("{text:?} is no point light"));
        };
        let (mut position, mut flux) = ([None; 3], None);
        for setting in settings.split(',') {
            let Some((key, value)) = setting.split_once('=').map(|(key, value)| (key.trim(), value.trim())) else {
                return wrong(format!("{setting:?} is not of the form key=value"));
            };
            let twice = match key {
                "x" | "y" | "z" => {
                    let axis = usize::from(key.as_bytes()[0] - b'x');
                    position[axis].replace(coordinate(key, value)?).is_some()
                }
                "flux" => flux.replace(power(value)?).is_some(),
                _ => return wrong(format!("a point light has no {key:?}")),
            };
            if twice {
                return wrong(format!("{key} is given twice"));
            }
        }
        match position {
            [Some(x), Some(y), Some(z)] => Ok(LightChoice { position: DVec3::new(x, y, z), flux }),
            _ => wrong(format!("{text:?} lacks a coordinate")),
        }
    }
}

fn coordinate(key: &str, text: &str) -> Result<f64> {
    match text.parse::<f64>() {
        Ok(value) if value.abs() <= MAX_COORDINATE => Ok(value),
        _ => wrong(format!("{key}: {text:?} is no coordinate up to {MAX_COORDINATE:e}")),
    }
}

fn power(text: &str) -> Result<Vec3> {
    let channel = |text: &str| text.parse::<f32>().ok().filter(|value| (0.0..=MAX_FLUX).contains(value));
    let channels: Option<Vec<f32>> = text.split('/').map(channel).collect();
    let flux = match channels.as_deref() {
        Some(&[grey]) => Vec3::splat(grey),
        Some(&[r, g, b]) => Vec3::new(r, g, b),
        _ => return wrong(format!("flux: {text:?} is not one or three numbers from 0 to {MAX_FLUX:e}")),
    };
    if flux == Vec3::ZERO {
        return wrong("the light has no flux".to_owned());
    }
    Ok(flux)
}

/// The flux with which a white surface that faces the light a quarter of the extent's diagonal away has the radiance 1:
/// 4 pi^2 (diagonal / 4)^2.
pub fn default_flux(diagonal: f32) -> f32 {
    let distance = diagonal / 4.0;
    4.0 * PI * PI * distance * distance
}

/// A flux of a file in memory; infinite or 0 where it leaves the range of floats.
fn placed_flux(placement: &Placement, flux: Vec3) -> Vec3 {
    (flux.as_dvec3() * power_of_two(2 * placement.exponent)).as_vec3()
}

/// A flux in memory for lengths as in the scene's file.
pub(super) fn file_flux(placement: &Placement, flux: Vec3) -> DVec3 {
    flux.as_dvec3() * power_of_two(-2 * placement.exponent)
}

/// The lights of a scene with this extent; at least one.
pub(super) fn choose(
    scene: &Scene,
    radiometry: Option<&Radiometry>,
    chosen: &[LightChoice],
    extent: Aabb,
    warnings: &mut Vec<String>,
) -> Result<Vec<PointLight>> {
    let default = default_flux(extent.diagonal());
    if !chosen.is_empty() {
        let light = |light: &LightChoice| {
            let position = scene.placement.place(light.position);
            // Squares of distances must be in the range of floats
            if !position.distance_squared(extent.center()).is_finite() {
                return wrong(format!("a light at {} is too far away from the scene", light.position));
            }
            let flux = light.flux.map_or(Vec3::splat(default), |flux| placed_flux(&scene.placement, flux));
            if !(flux.is_finite() && flux.max_element() >= f32::MIN_POSITIVE) {
                return wrong(format!("a light's flux at {} is out of range for the scene's extent", light.position));
            }
            Ok(PointLight { position, flux })
        };
        return chosen.iter().map(light).collect();
    }
    let listed = radiometry.map_or(&[][..], |radiometry| &radiometry.light);
    let mut lights: Vec<PointLight> = listed
        .iter()
        .map(|light| PointLight {
            position: scene.placement.place(light.position.into()),
            flux: light.flux.map_or(Vec3::splat(default), |flux| placed_flux(&scene.placement, flux.channels())),
        })
        .collect();
    if lights.is_empty() {
        let own = |light: &crate::scene::Light| {
            // Colours may be negative in some formats
            PointLight { position: light.position, flux: light.colour.max(Vec3::ZERO) * default }
        };
        lights.extend(scene.lights.iter().map(own));
    }
    let all = lights.len();
    lights.retain(|light| light.flux.is_finite() && light.flux != Vec3::ZERO);
    if lights.len() < all {
        warnings.push(format!("{} of {all} lights give no light: they are ignored", all - lights.len()));
    }
    if lights.is_empty() {
        let position = extent.center();
        let place = scene.placement.point(position);
        warnings.push(format!("the scene has no light: one in the middle of its extent, {place}, lights it"));
        lights.push(PointLight { position, flux: Vec3::splat(default) });
    }
    Ok(lights)
}
