//! The integrating sphere: a point of it sees all others alike, so every hit but the first is uniform.
//!
//! With the radius 1 as here, a chord of length d subtends an angle with 1 - cosine = d^2 / 2, and the caps within
//! chords of up to r have the area pi r^2 exactly, so that kernels of the squared distance integrate to one. Of the
//! light that arrives at distance d from a sample, a part comes from behind the sample's plane: from the cap between,
//! whose share of the sphere is d^2 / 4. `weight=side` loses it.

use super::scenes::{ON, SPHERE_LIGHT, cast_in, of_hits, pool, setting, sphere, traced};
use super::statistics::chi_square;
use glam::{DVec3, Vec3, Vec3A};
use rtbench::math::Hit;
use rtbench::workloads::splat::lit::LitScene;
use rtbench::workloads::splat::photons::{Photons, Traced};
use rtbench::workloads::splat::random::unit_vector;
use rtbench::workloads::splat::reference::cells::Cells;
use rtbench::workloads::splat::samples::Samples;
use rtbench::workloads::splat::setting::{Estimate, EstimateKernel, Weight};
use rtbench::workloads::splat::surface::surface_at;
use rtbench::workloads::splat::{emit, estimate};
use rtbench::workloads::trace::backend::{Prepared, TraceRay};
use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

const ALBEDO: f32 = 0.5;
const FLUX: Vec3 = Vec3::new(10.0, 20.0, 30.0);
const PATHS: u32 = 200_000;

/// Samples all over the sphere.
const SAMPLES: u32 = 1000;

/// Bands of equal height, and sectors of each.
const CELLS: (usize, usize) = (6, 8);

/// The 99.9 % quantile of chi-square for 48 cells.
const LIMIT: f64 = 83.0;

fn lit() -> LitScene {
    sphere(ALBEDO, FLUX)
}

/// The photons of all proofs.
static TRACED: LazyLock<Traced> = LazyLock::new(|| {
    let lit = lit();
    cast_in(&lit, |caster| traced(caster, &lit, setting(PATHS, 4, 1)))
});

fn cell(point: DVec3) -> usize {
    let point = point.normalize();
    let band = ((point.y + 1.0) / 2.0 * CELLS.0 as f64) as usize;
    let sector = (point.z.atan2(point.x).rem_euclid(TAU) / TAU * CELLS.1 as f64) as usize;
    band.min(CELLS.0 - 1) * CELLS.1 + sector.min(CELLS.1 - 1)
}

fn counts(points: impl Iterator<Item = DVec3>) -> Vec<u32> {
    let mut counts = vec![0; CELLS.0 * CELLS.1];
    points.for_each(|point| counts[cell(point)] += 1);
    counts
}

fn positions(photons: &Photons) -> impl Iterator<Item = DVec3> {
    photons.positions.iter().map(|position| position.truncate().as_dvec3())
}

/// The share of a light's rays that each cell gets, by midpoints: the integral of cosine / (4 pi d^2).
fn first_shares() -> Vec<f64> {
    const STEPS: usize = 64;
    let light = SPHERE_LIGHT.as_dvec3();
    let mut shares = vec![0.0; CELLS.0 * CELLS.1];
    let (bands, sectors) = (CELLS.0 * STEPS, CELLS.1 * STEPS);
    for band in 0..bands {
        let y = (band as f64 + 0.5) / bands as f64 * 2.0 - 1.0;
        for sector in 0..sectors {
            let (sine, cosine) = ((sector as f64 + 0.5) / sectors as f64 * TAU).sin_cos();
            let around = (1.0 - y * y).sqrt();
            let point = DVec3::new(around * cosine, y, around * sine);
            let way = point - light;
            let density = way.dot(point) / way.length().powi(3) / (4.0 * PI);
            shares[cell(point)] += density * 4.0 * PI / (bands * sectors) as f64;
        }
    }
    shares
}

#[test]
fn hits_two_to_four_are_uniform() {
    let uniform = vec![1.0 / 48.0; 48];
    assert_eq!(TRACED.arrived, [PATHS; 4]);
    for hit in 2..=4 {
        let photons = of_hits(&TRACED.slots, |of| of == hit);
        assert_eq!(photons.len(), PATHS as usize);
        let chi = chi_square(&counts(positions(&photons)), &uniform);
        println!("hit {hit}: chi-square {chi:.1}");
        assert!(chi < LIMIT, "hit {hit}: {chi}");
    }
}

fn first(caster: &mut dyn Prepared, lit: &LitScene) -> (Vec<TraceRay>, Vec<Hit>) {
    let setting = setting(PATHS, 4, 1);
    let (rays, _) = emit::rays(lit, &lit.shares(PATHS).unwrap(), &setting);
    let hits = caster.cast(&rays, None).unwrap();
    (rays, hits)
}

fn points((rays, hits): &(Vec<TraceRay>, Vec<Hit>)) -> impl Iterator<Item = DVec3> {
    rays.iter().zip(hits).map(|(ray, hit)| ray.origin.as_dvec3() + ray.direction.as_dvec3() * f64::from(hit.t))
}

#[test]
fn the_first_hit_falls_off_with_the_square() {
    let shares = first_shares();
    assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1.0e-4, "{}", shares.iter().sum::<f64>());
    let lit = lit();
    cast_in(&lit, |caster| {
        let first = first(caster, &lit);
        let found = counts(points(&first));
        let chi = chi_square(&found, &shares);
        println!("hit 1: chi-square {chi:.1}, {:.0} if it were uniform", chi_square(&found, &[1.0 / 48.0; 48]));
        assert!(chi < LIMIT, "{chi}");
        assert!(chi_square(&found, &[1.0 / 48.0; 48]) > 1000.0);

        // The second hit of directions that are uniform over the hemisphere instead
        let bounce = |(path, (ray, &hit)): (usize, (&TraceRay, &Hit))| {
            let surface = surface_at(&lit.scene, ray, hit, lit.epsilon()).unwrap();
            let vector = unit_vector(1, path as u32, 1);
            let vector = if vector.dot(surface.normal) < 0.0 { -vector } else { vector };
            TraceRay::new(surface.point.into(), vector.into())
        };
        let rays: Vec<TraceRay> = first.0.iter().zip(&first.1).enumerate().map(bounce).collect();
        let hits = caster.cast(&rays, None).unwrap();
        let chi = chi_square(&counts(points(&(rays, hits))), &[1.0 / 48.0; 48]);
        println!("hit 2 of uniform directions: chi-square {chi:.0}");
        assert!(chi > 1000.0, "{chi}");
    });
}

/// Samples all over the sphere, along a spiral with points of equal area.
fn samples(lit: &LitScene, count: u32) -> Samples {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let ray = |n: u32| {
        let y = 1.0 - (f64::from(n) + 0.5) / f64::from(count) * 2.0;
        let (sine, cosine) = (golden * f64::from(n)).sin_cos();
        let around = (1.0 - y * y).sqrt();
        TraceRay::new(Vec3::ZERO, DVec3::new(around * cosine, y, around * sine).as_vec3())
    };
    let rays: Vec<TraceRay> = (0..count).map(ray).collect();
    let hits = cast_in(lit, |caster| caster.cast(&rays, None).unwrap());
    let mut samples = Samples::default();
    for (ray, hit) in rays.iter().zip(hits) {
        let surface = surface_at(&lit.scene, ray, hit, lit.epsilon()).unwrap();
        samples.positions.push(Vec3A::extend(surface.point, 1.0));
        samples.normals.push(Vec3A::extend(surface.normal, 0.0));
        samples.albedos.push(surface.albedo.extend(0.0));
    }
    samples
}

/// The factor on the estimate that the geometry gives, by midpoints over the squared distance.
fn factor(estimate: &Estimate) -> f64 {
    const STEPS: u32 = 10_000;
    let at = |step: u32| {
        let part = (f64::from(step) + 0.5) / f64::from(STEPS);
        let square = part * f64::from(estimate.radius).powi(2);
        let by_distance = if estimate.kernel == EstimateKernel::Constant { 1.0 } else { 2.0 * (1.0 - part) };
        let by_direction = match estimate.weight {
            Weight::Side => 1.0 - square / 4.0,
            // The integral of the product of two cosines whose axes are an angle apart
            Weight::Cosine => {
                let angle = (1.0 - square / 2.0).acos();
                2.0 / 3.0 * (angle.sin() + (PI - angle) * angle.cos()) / PI
            }
        };
        by_distance * by_direction / f64::from(STEPS)
    };
    (0..STEPS).map(at).sum()
}

/// Flux (a + a^2 + a^3) / (4 pi R^2), sum of channels.
fn expected() -> f64 {
    let a = f64::from(ALBEDO);
    FLUX.as_dvec3().element_sum() * (a + a * a + a * a * a) / (4.0 * PI)
}

#[test]
fn irradiance_in_the_sphere() {
    let estimate = |kernel, weight, radius| Estimate { kernel, weight, form: Default::default(), radius };
    let samples = samples(&lit(), SAMPLES);
    let pixels: Vec<u32> = (0..SAMPLES).collect();
    let photons = TRACED.slots.compacted();
    for kernel in [EstimateKernel::Epanechnikov, EstimateKernel::Constant] {
        for weight in [Weight::Side, Weight::Cosine] {
            for radius in [0.1, 0.2, 0.4] {
                let estimate = estimate(kernel, weight, radius);
                let irradiance = Cells::new(pool(), &photons, estimate).irradiance(&samples, &pixels, ON).unwrap();
                let mean = irradiance.iter().map(|e| e.value.element_sum()).sum::<f64>() / f64::from(SAMPLES);
                let (ratio, factor) = (mean / expected(), factor(&estimate));
                println!("{kernel:?} {weight:?} {radius}: {ratio:.4}, by geometry {factor:.4}");
                assert!((ratio - factor).abs() < 0.01, "{kernel:?} {weight:?} {radius}: {ratio} {factor}");
                // At the largest radius the sphere is no plane any more
                if radius < 0.3 {
                    let (plane, band) = if weight == Weight::Side { (1.0, 0.01) } else { (2.0 / 3.0, 0.02) };
                    assert!((ratio - plane).abs() < band, "{kernel:?} {weight:?} {radius}: {ratio}");
                }
            }
        }
    }
    // The estimate itself, over fewer photons
    let few = Photons {
        positions: photons.positions[..60_000].to_vec(),
        directions: photons.directions[..60_000].to_vec(),
        fluxes: photons.fluxes[..60_000].iter().map(|&flux| flux * 10.0).collect(),
    };
    for kernel in [EstimateKernel::Epanechnikov, EstimateKernel::Constant] {
        let estimate = estimate(kernel, Weight::Side, 0.2);
        let irradiance = estimate::irradiance(pool(), &samples, &few, &estimate, ON).unwrap();
        let mean = irradiance.iter().map(|e| f64::from(e.element_sum())).sum::<f64>() / f64::from(SAMPLES);
        let ratio = mean / expected();
        println!("{kernel:?}: 20,000 paths by the estimate of frames: {ratio:.4}");
        assert!((ratio - 1.0).abs() < 0.01, "{kernel:?}: {ratio}");
    }
}
