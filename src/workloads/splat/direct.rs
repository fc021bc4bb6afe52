//! Direct light of the samples, with shadow rays in place of the source's shadow maps. Twin of
//! `kernels/splat/direct.wgsl`.

use super::lit::LitScene;
use super::samples::{Samples, Seen};
use super::setting::{Falloff, Setting};
use super::shadow;
use crate::device::Interrupted;
use crate::error::{Error, Result};
use crate::math::{Hit, MISS};
use crate::scene::Material;
use crate::workloads::trace::backend::{Prepared, TraceRay};
use glam::{Vec3, Vec3A, Vec4};
use rayon::ThreadPool;
use rayon::prelude::*;
use std::f32::consts::FRAC_1_PI;

/// A light of a pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// In the scene's coordinates in memory.
    pub position: Vec3,
    /// With the physical falloff flux / (4 pi), otherwise flux / the largest channel of all fluxes.
    pub intensity: Vec3,
}

/// The lights of a scene.
pub fn lamps(lit: &LitScene, falloff: Falloff) -> Vec<Lamp> {
    let largest = lit.lights.iter().map(|light| light.flux.max_element()).fold(f32::MIN_POSITIVE, f32::max);
    let divisor = match falloff {
        Falloff::Square => 4.0 * std::f32::consts::PI,
        Falloff::Source => largest,
    };
    lit.lights.iter().map(|light| Lamp { position: light.position, intensity: light.flux / divisor }).collect()
}

/// A material's highlight: specular colour, and the exponent in units of 1 / 256, below 2^24.
pub fn highlight_of(material: &Material) -> (Vec3, u32) {
    (material.specular, (material.exponent.clamp(0.0, 65_535.0) * 256.0 + 0.5) as u32)
}

/// The radiance that reaches the camera from each sample directly; `w` is 0. The threads are those of `pool`
/// and the caster's.
///
/// # Errors
/// [`Error::Interrupted`] between lights, and the device's.
pub fn light(
    pool: &ThreadPool,
    caster: &mut dyn Prepared,
    lit: &LitScene,
    setting: &Setting,
    (seen, samples): (&Seen, &Samples),
    interrupted: Interrupted,
) -> Result<Vec<Vec4>> {
    let mut direct = vec![Vec4::ZERO; samples.positions.len()];
    let reach = lit.reach(); // goes over the whole scene
    for lamp in lamps(lit, setting.falloff) {
        if interrupted() {
            return Err(Error::Interrupted);
        }
        let rays = pool.install(|| shadow::rays(samples, lamp.position, reach));
        let shadows = caster.cast(&rays, Some(1.0))?;
        pool.install(|| {
            direct.par_iter_mut().zip(&shadows).enumerate().for_each(|(pixel, (direct, shadow))| {
                if shadow.triangle == MISS && samples.positions[pixel].w > 0.0 {
                    *direct += of_lamp(lit, setting.falloff, &lamp, (seen, samples), pixel).extend(0.0);
                }
            });
        });
    }
    Ok(direct)
}

/// The light of a lamp that a sample sees.
fn of_lamp(lit: &LitScene, falloff: Falloff, lamp: &Lamp, (seen, samples): (&Seen, &Samples), pixel: usize) -> Vec3A {
    let [position, normal, albedo] =
        [&samples.positions, &samples.normals, &samples.albedos].map(|all| Vec3A::from_vec4(all[pixel]));
    let way = Vec3A::from(lamp.position) - position;
    let square = way.dot(way);
    match falloff {
        Falloff::Square => square_light(lamp, way, square, normal, albedo),
        Falloff::Source => {
            let (ray, hit) = (&seen.rays[pixel], &seen.hits[pixel]);
            source_light(lit, lamp, (ray, hit), (way, square), (normal, albedo))
        }
    }
}

/// Nearer than the square root of this a light is at the sample itself.
const SQUARE_MIN: f32 = 1.0e-30;

fn square_light(lamp: &Lamp, way: Vec3A, square: f32, normal: Vec3A, albedo: Vec3A) -> Vec3A {
    if square < SQUARE_MIN {
        return Vec3A::ZERO;
    }
    let cosine = normal.dot(way / square.sqrt());
    if cosine <= 0.0 {
        return Vec3A::ZERO;
    }
    (albedo * FRAC_1_PI) * Vec3A::from(lamp.intensity) * (cosine / square)
}

fn source_light(
    lit: &LitScene,
    lamp: &Lamp,
    (ray, hit): (&TraceRay, &Hit),
    (way, square): (Vec3A, f32),
    (normal, albedo): (Vec3A, Vec3A),
) -> Vec3A {
    let influence = lit.influence() * lit.influence();
    let falloff = 1.0 - square / influence;
    if square < SQUARE_MIN || falloff <= 0.0 {
        return Vec3A::ZERO;
    }
    let to_light = way / square.sqrt();
    let cosine = normal.dot(to_light);
    if cosine <= 0.0 {
        return Vec3A::ZERO;
    }
    let material = lit.scene.triangles[hit.triangle as usize].material;
    let (specular, exponent) = highlight_of(&lit.scene.materials[material as usize]);
    let mirrored = normal * (2.0 * cosine) - to_light;
    let highlight = raised((-mirrored.dot(ray.direction.into())).clamp(1.0e-6, 1.0), exponent);
    (albedo * cosine + Vec3A::from(specular) * highlight) * Vec3A::from(lamp.intensity) * falloff
}

/// Products below this are zero: no product of two numbers that are not leaves the range of normal floats.
const TINY: f32 = 1.0e-18;

fn product(a: f32, b: f32) -> f32 {
    if a < TINY || b < TINY { 0.0 } else { a * b }
}

/// `x` to the power of `exponent` / 256, for 0 < x <= 1, by multiplications and square roots only: unlike `pow` they
/// give the same bits everywhere.
pub fn raised(x: f32, exponent: u32) -> f32 {
    let mut result = 1.0;
    let mut root = x;
    for bit in 1..=8 {
        root = root.sqrt();
        if exponent >> (8 - bit) & 1 == 1 {
            result = product(result, root);
        }
    }
    let (mut square, mut rest) = (x, exponent >> 8);
    while rest > 0 {
        if rest & 1 == 1 {
            result = product(result, square);
        }
        square = product(square, square);
        rest >>= 1;
    }
    result
}
