//! Indirect light by paths from the eye, with next-event estimation: knows nothing of photons.
//!
//! A photon of hit k has been reflected k - 1 times. So what photons of hits 2 to `hits` bring to a point is the light
//! that reaches it after 1 to `hits` - 1 reflections: a path leaves the point in a direction distributed as the cosine,
//! and at each of its `hits` - 1 vertices the light that arrives there straight from the lights is added, times the
//! albedos from that vertex back to the first. Lights are points, and their light falls off with the square of the
//! distance. Rays are cast by any of the workload's structures; all else is this module's own, in double precision.

use super::random::Random;
use super::surface::{Point, point_of};
use crate::camera::Camera;
use crate::device::Interrupted;
use crate::error::{Error, Result};
use crate::math::MISS;
use crate::workloads::size::Size;
use crate::workloads::splat::lit::{LitScene, PointLight};
use crate::workloads::trace::backend::{Prepared, TraceRay};
use glam::{DVec3, Vec3};
use rayon::ThreadPool;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Paths that are traced together.
const BATCH: usize = 1 << 16;

/// What is to be computed.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// Scene, lights and lengths.
    pub lit: &'a LitScene,
    /// Looks at it.
    pub camera: Camera,
    /// Of the image.
    pub size: Size,
    /// Of the image, rows from the top.
    pub pixels: &'a [u32],
    /// Most hits along a path of light, 2 or more: those of the photons that it is compared with.
    pub hits: u32,
}

/// How many paths are traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Paths of a pixel at least, 2 or more.
    pub least: u32,
    /// Paths of a pixel at most.
    pub most: u32,
    /// The paths are doubled until the standard error of the mean over pixels, as a share of that mean, is below this.
    pub error: f64,
    /// Of the generator.
    pub seed: u64,
}

impl Default for Effort {
    fn default() -> Effort {
        Effort { least: 256, most: 4096, error: 0.005, seed: 0 }
    }
}

/// Indirect light at pixels of a view.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathTraced {
    /// Of the image, rows from the top.
    pub pixels: Vec<u32>,
    /// Irradiance of each pixel per channel: the surface's own albedo is not in it. Zero where the camera sees nothing.
    pub irradiance: Vec<DVec3>,
    /// Its standard error.
    pub error: Vec<DVec3>,
    /// Paths of each pixel.
    pub paths: u32,
    /// Mean irradiance over the pixels.
    pub mean: DVec3,
    /// Standard error of the mean over just these pixels.
    pub mean_error: DVec3,
    /// Standard error of the sum of the mean's channels, which all follow the same paths.
    pub sum_error: f64,
}

impl PathTraced {
    /// Standard error of the mean, of the sum of its channels, as a share of it; 0 where there is no light.
    pub fn relative_error(&self) -> f64 {
        let sum = self.mean.element_sum();
        if sum > 0.0 { self.sum_error / sum } else { 0.0 }
    }
}

/// Sums over the paths of a pixel.
#[derive(Clone, Copy, Default)]
struct Sums {
    irradiance: DVec3,
    squares: DVec3,
    /// Of the sum of channels.
    sum_squares: f64,
}

/// A path on its way.
struct Walk {
    /// Index into the view's pixels.
    of: usize,
    random: Random,
    /// The next segment, without direction if there is none.
    ray: TraceRay,
    /// Product of the albedos so far.
    weight: DVec3,
    /// Irradiance that it has found for its pixel.
    found: DVec3,
}

/// Traces indirect light at the view's pixels. The threads are those of `pool` and the caster's.
///
/// # Errors
/// [`Error::Input`] for a pixel outside of the image, [`Error::Interrupted`] between batches, those of the caster.
pub fn trace(
    pool: &ThreadPool,
    caster: &mut dyn Prepared,
    view: &View,
    effort: Effort,
    interrupted: Interrupted,
) -> Result<PathTraced> {
    if let Some(pixel) = view.pixels.iter().find(|&&pixel| pixel as usize >= view.size.pixels()) {
        let problem = format!("pixel {pixel} is outside of {}x{}", view.size.width, view.size.height);
        return Err(Error::argument("pixels", problem, "rows are counted from the top, pixels from 0"));
    }
    let epsilon = f64::from(view.lit.epsilon());
    let primary: Vec<TraceRay> = view.pixels.iter().map(|&pixel| primary_ray(view, pixel)).collect();
    let hits = caster.cast(&primary, None)?;
    let eye = primary.iter().zip(hits).map(|(ray, hit)| point_of(&view.lit.scene, epsilon, ray, hit));
    let eye: Vec<Option<Point>> = eye.collect();

    let mut sums = vec![Sums::default(); eye.len()];
    let mut paths = 0;
    let mut more = effort.least.max(2);
    loop {
        let all = eye.len() * more as usize;
        for first in (0..all).step_by(BATCH) {
            if interrupted() {
                return Err(Error::Interrupted);
            }
            let start = |number: usize| {
                let of = number / more as usize;
                let path = paths + (number % more as usize) as u32;
                let mut random = Random::of(effort.seed, view.pixels[of], path);
                let ray = eye[of].map_or(TraceRay::default(), |point| next_ray(&point, &mut random));
                Walk { of, random, ray, weight: DVec3::ONE, found: DVec3::ZERO }
            };
            let batch = first..all.min(first + BATCH);
            let mut walks: Vec<Walk> = pool.install(|| batch.into_par_iter().map(start).collect());
            follow(pool, caster, view, &mut walks)?;
            for Walk { of, found, .. } in walks {
                let sum = found.element_sum();
                sums[of].irradiance += found;
                sums[of].squares += found * found;
                sums[of].sum_squares += sum * sum;
            }
        }
        paths += more;
        let result = summary(view.pixels, &sums, paths);
        if result.relative_error() < effort.error || paths.saturating_mul(2) > effort.most {
            return Ok(result);
        }
        more = paths;
    }
}

/// Follows paths to their last vertices.
fn follow(pool: &ThreadPool, caster: &mut dyn Prepared, view: &View, walks: &mut [Walk]) -> Result<()> {
    let scene = &view.lit.scene;
    // The reach goes over all triangles
    let (epsilon, reach) = (f64::from(view.lit.epsilon()), f64::from(view.lit.reach()));
    for _ in 1..view.hits {
        let rays: Vec<TraceRay> = walks.iter().map(|walk| walk.ray).collect();
        let hits = caster.cast(&rays, None)?;
        let points: Vec<Option<Point>> = pool.install(|| {
            let points = rays.par_iter().zip(hits).map(|(ray, hit)| point_of(scene, epsilon, ray, hit));
            points.collect()
        });
        for (walk, point) in walks.iter_mut().zip(&points) {
            match point {
                Some(point) => walk.weight *= point.albedo,
                None => walk.ray = TraceRay::default(),
            }
        }
        for light in &view.lit.lights {
            let straight = |point: &Option<Point>| point.map_or(DVec3::ZERO, |point| irradiance(light, &point));
            let lit: Vec<DVec3> = pool.install(|| points.par_iter().map(straight).collect());
            let shadow = |(point, lit): (&Option<Point>, &DVec3)| match point {
                Some(point) if *lit != DVec3::ZERO => shadow_ray(light, point, reach),
                _ => TraceRay::default(),
            };
            let shadows: Vec<TraceRay> = pool.install(|| points.par_iter().zip(&lit).map(shadow).collect());
            let blocked = caster.cast(&shadows, Some(1.0))?;
            for ((walk, lit), hit) in walks.iter_mut().zip(&lit).zip(&blocked) {
                if hit.triangle == MISS {
                    walk.found += walk.weight * *lit;
                }
            }
        }
        pool.install(|| {
            walks.par_iter_mut().zip(&points).for_each(|(walk, point)| {
                if let Some(point) = point {
                    walk.ray = next_ray(point, &mut walk.random);
                }
            });
        });
    }
    Ok(())
}

/// The ray through the middle of a pixel.
fn primary_ray(view: &View, pixel: u32) -> TraceRay {
    let Camera { position, direction, up, field_of_view } = view.camera;
    let Size { width, height } = view.size;
    let forward = direction.as_dvec3().normalize();
    let right = forward.cross(up.as_dvec3()).normalize();
    let above = right.cross(forward);
    let half = (f64::from(field_of_view).to_radians() / 2.0).tan();
    let (column, row) = (f64::from(pixel % width) + 0.5, f64::from(pixel / width) + 0.5);
    // Square pixels: both are measured in half the image's height
    let across = (2.0 * column - f64::from(width)) / f64::from(height);
    let along = 1.0 - 2.0 * row / f64::from(height);
    let way = forward + (right * across + above * along) * half;
    TraceRay::new(position, way.normalize().as_vec3())
}

/// A ray from a point, distributed as the cosine.
fn next_ray(point: &Point, random: &mut Random) -> TraceRay {
    TraceRay::new(point.position.as_vec3(), random.around(point.normal).as_vec3())
}

/// Irradiance of a light at a point if nothing is between them.
fn irradiance(light: &PointLight, point: &Point) -> DVec3 {
    let way = light.position.as_dvec3() - point.position;
    let square = way.length_squared();
    let cosine = point.normal.dot(way) / square.sqrt();
    // Not so for a point at the light either
    if cosine > 0.0 { light.flux.as_dvec3() * (cosine / (4.0 * PI * square)) } else { DVec3::ZERO }
}

/// The ray that must meet nothing before distance 1: from the light, or from the farthest place towards it at which
/// shadow rays start, to the point.
fn shadow_ray(light: &PointLight, point: &Point, reach: f64) -> TraceRay {
    let way = light.position.as_dvec3() - point.position;
    let start = if way.length() > reach { point.position + way.normalize() * reach } else { point.position + way };
    let start = start.as_vec3();
    let end: Vec3 = point.position.as_vec3();
    TraceRay::new(start, end - start)
}

/// Means and standard errors. Pixels are independent of each other, and so are the paths of a pixel.
fn summary(pixels: &[u32], sums: &[Sums], paths: u32) -> PathTraced {
    let n = f64::from(paths);
    let variance = |square: f64, mean: f64| ((square / n - mean * mean) / (n - 1.0)).max(0.0);
    let (mut irradiance, mut error) = (Vec::with_capacity(sums.len()), Vec::with_capacity(sums.len()));
    let (mut mean, mut variances, mut sum_variance) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for sums in sums {
        let own = sums.irradiance / n;
        let of = DVec3::from_array(std::array::from_fn(|channel| variance(sums.squares[channel], own[channel])));
        mean += own;
        variances += of;
        sum_variance += variance(sums.sum_squares, own.element_sum());
        irradiance.push(own);
        error.push(of.map(f64::sqrt));
    }
    let count = sums.len().max(1) as f64;
    PathTraced {
        pixels: pixels.to_vec(),
        irradiance,
        error,
        paths,
        mean: mean / count,
        mean_error: variances.map(f64::sqrt) / count,
        sum_error: sum_variance.sqrt() / count,
    }
}
