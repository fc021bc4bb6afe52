//! The twins against formulas: the generator, one photon over a plane, one light over a plane, and what does not change
//! photons.

use super::frames::*;
use glam::{Vec3, Vec3A, Vec4};
use rtbench::camera::Camera;
use rtbench::device::CpuDevice;
use rtbench::scene;
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::lit::PointLight;
use rtbench::workloads::splat::photons::Photons;
use rtbench::workloads::splat::random::{cosine_direction, pcg4d, unit_vector};
use rtbench::workloads::splat::reference::exact;
use rtbench::workloads::splat::samples::Samples;
use rtbench::workloads::splat::setting::{Energy, Estimate, EstimateKernel, Falloff, Setting, Weight};
use rtbench::workloads::splat::{direct, estimate as reference};
use std::f64::consts::PI;

const KERNELS: [EstimateKernel; 2] = [EstimateKernel::Epanechnikov, EstimateKernel::Constant];

/// The hash of four zeros step by step, with other types and another notation.
#[test]
fn the_generator_is_pcg4d() {
    let modulus = 1_u64 << 32;
    let by_hand = |key: [u64; 4]| {
        let [mut x, mut y, mut z, mut w] = key.map(|word| (word * 1_664_525 + 1_013_904_223) % modulus);
        for round in 0..2 {
            if round == 1 {
                (x, y, z, w) = (x ^ (x >> 16), y ^ (y >> 16), z ^ (z >> 16), w ^ (w >> 16));
            }
            x = (x + y * w % modulus) % modulus;
            y = (y + z * x % modulus) % modulus;
            z = (z + x * y % modulus) % modulus;
            w = (w + y * z % modulus) % modulus;
        }
        [x, y, z, w].map(|word| word as u32)
    };
    for key in [[0; 4], [1, 2, 3, 4], [u32::MAX; 4], [7, 0, 16, u32::MAX]] {
        assert_eq!(pcg4d(key), by_hand(key.map(u64::from)), "{key:?}");
    }
    assert_ne!(pcg4d([0, 0, 0, 1]), pcg4d([0, 0, 1, 0]));
}

/// Moments of a uniform distribution over the sphere, and of a cosine over the hemisphere, within five deviations.
#[test]
fn directions_have_the_moments_of_their_distributions() {
    let count = 200_000;
    let deviation = |variance: f64| 5.0 * (variance / f64::from(count)).sqrt();
    let normal = Vec3A::new(2.0, -1.0, 0.5).normalize();
    let (mut mean, mut square, mut cosine, mut cosine2) = ([0.0; 3], [0.0; 3], 0.0, 0.0);
    for path in 0..count {
        let vector = unit_vector(9, path, 2);
        assert!((vector.length() - 1.0).abs() < 1e-6);
        for axis in 0..3 {
            mean[axis] += f64::from(vector[axis]) / f64::from(count);
            square[axis] += f64::from(vector[axis] * vector[axis]) / f64::from(count);
        }
        let direction = cosine_direction(normal, vector);
        assert!((direction.length() - 1.0).abs() < 1e-6);
        let facing = f64::from(direction.dot(normal));
        assert!(facing >= -1e-6);
        cosine += facing / f64::from(count);
        cosine2 += facing * facing / f64::from(count);
    }
    for axis in 0..3 {
        assert!(mean[axis].abs() < deviation(1.0 / 3.0), "{mean:?}");
        assert!((square[axis] - 1.0 / 3.0).abs() < deviation(4.0 / 45.0), "{square:?}");
    }
    // Of a density of 2 c over [0, 1]; uniform over the hemisphere they would be 1/2 and 1/3
    assert!((cosine - 2.0 / 3.0).abs() < deviation(1.0 / 18.0), "{cosine}");
    assert!((cosine2 - 0.5).abs() < deviation(1.0 / 12.0), "{cosine2}");
    assert_eq!(cosine_direction(normal, -normal), normal);
}

fn one_photon(position: Vec3, direction: Vec3, flux: Vec3) -> Photons {
    Photons {
        positions: vec![position.extend(2.0)],
        directions: vec![direction.extend(0.0)],
        fluxes: vec![flux.extend(0.0)],
    }
}

/// Samples of the plane y = 0 on a lattice around a point: columns and rows, and their distance.
fn lattice(center: Vec3, side: usize, step: f32) -> Samples {
    let half = (side as f32 - 1.0) / 2.0;
    let point = |index: usize| {
        let (x, z) = ((index % side) as f32 - half, (index / side) as f32 - half);
        (center + Vec3::new(x, 0.0, z) * step).extend(1.0)
    };
    let all = |v: Vec4| vec![v; side * side];
    Samples {
        positions: (0..side * side).map(point).collect(),
        normals: all(Vec4::Y),
        albedos: all(Vec4::new(0.5, 0.25, 1.0, 0.0)),
    }
}

#[test]
fn one_photon_over_a_plane_is_its_kernel() {
    let device = CpuDevice::new(2).unwrap();
    let irradiance = |samples: &Samples, photons: &Photons, estimate: &Estimate| {
        reference::irradiance(device.pool(), samples, photons, estimate, &|| false).unwrap()
    };
    let (center, radius, flux) = (Vec3::new(3.0, 0.0, -2.0), 0.7_f32, Vec3::new(2.0, 0.5, 0.0));
    let side = 401;
    let step = 2.2 * radius / side as f32;
    let samples = lattice(center, side, step);
    let slanted = Vec3::new(0.6, -0.8, 0.0);
    for kernel in KERNELS {
        for (weight, factor) in [(Weight::Side, 1.0), (Weight::Cosine, 0.8)] {
            let estimate = Estimate { kernel, weight, form: Default::default(), radius };
            let found = irradiance(&samples, &one_photon(center, slanted, flux), &estimate);
            let mut integral = Vec4::ZERO;
            for (position, found) in samples.positions.iter().zip(&found) {
                let r = f64::from(radius);
                let d = f64::from(position.truncate().distance(center));
                let expected = match kernel {
                    _ if d > r * 1.000_001 => 0.0,
                    EstimateKernel::Epanechnikov => 2.0 / (PI * r * r) * (1.0 - d * d / (r * r)),
                    EstimateKernel::Constant => 1.0 / (PI * r * r),
                };
                let on_border = (d - r).abs() < 1e-6;
                let expected = flux.as_dvec3() * expected * factor;
                let error = (found.truncate().as_dvec3() - expected).abs().max_element();
                assert!(on_border || error < 2e-6, "{kernel:?} {weight:?} at {d}: {found} instead of {expected}");
                integral += *found * (step * step);
            }
            for channel in 0..3 {
                let expected = flux[channel] * factor as f32;
                let error = (integral[channel] - expected).abs();
                assert!(error <= 0.01 * expected, "{kernel:?} {weight:?}: {integral} instead of {expected}");
            }
            // From behind, along the surface, exactly a radius away
            for direction in [Vec3::Y, -slanted, Vec3::X] {
                let found = irradiance(&samples, &one_photon(center, direction, flux), &estimate);
                assert!(found.iter().all(|found| *found == Vec4::ZERO), "{kernel:?} {weight:?} {direction}");
            }
            let at = lattice(Vec3::ZERO, 1, 1.0);
            let border = one_photon(Vec3::new(radius, 0.0, 0.0), Vec3::NEG_Y, flux);
            assert_eq!(irradiance(&at, &border, &estimate), [Vec4::ZERO]);
            let wider = Estimate { radius: radius * 1.0001, ..estimate };
            assert!(irradiance(&at, &border, &wider)[0].x > 0.0);
        }
    }
    // A pixel without a sample stays dark, even where a photon is
    let mut empty = lattice(Vec3::ZERO, 1, 1.0);
    (empty.positions[0], empty.normals[0]) = (Vec4::ZERO, Vec4::ZERO);
    let estimate =
        Estimate { kernel: EstimateKernel::Constant, weight: Weight::Side, form: Default::default(), radius };
    assert_eq!(irradiance(&empty, &one_photon(Vec3::ZERO, Vec3::NEG_Y, flux), &estimate), [Vec4::ZERO]);
    let stopped = reference::irradiance(device.pool(), &empty, &Photons::default(), &estimate, &|| true);
    assert!(matches!(stopped, Err(rtbench::Error::Interrupted)));
}

/// Equal terms, whose sum in turn rounds to the same side each time.
#[test]
fn many_photons_are_added_by_blocks() {
    let device = CpuDevice::new(2).unwrap();
    let (count, flux) = (100_000, Vec3::new(0.1, 0.7, 1.0));
    let photons = Photons {
        positions: vec![Vec4::new(0.0, 0.0, 0.0, 2.0); count],
        directions: vec![Vec4::NEG_Y; count],
        fluxes: vec![flux.extend(0.0); count],
    };
    let samples = lattice(Vec3::ZERO, 1, 1.0);
    let estimate =
        Estimate { kernel: EstimateKernel::Constant, weight: Weight::Side, form: Default::default(), radius: 0.7 };
    let found = reference::irradiance(device.pool(), &samples, &photons, &estimate, &|| false).unwrap()[0];
    let exact = exact::irradiance(device.pool(), &samples, &photons, &estimate, &[0], &|| false).unwrap()[0];
    assert_eq!((exact.photons, exact.blocks), (100_000, 391));
    let off = |sum: Vec4| ((sum.truncate().as_dvec3() - exact.value).abs() / exact.value).max_element();
    assert!(off(found) < (exact.allowance() / exact.value).min_element(), "{found} instead of {}", exact.value);
    assert!(off(found) < 1e-5, "{found} instead of {}", exact.value);
    let in_turn = (0..count).fold(Vec4::ZERO, |sum, _| sum + flux.extend(0.0) * estimate.peak());
    assert!(off(in_turn) > (exact.allowance() / exact.value).max_element(), "{in_turn}");
}

/// A square in the plane y = 0, seen from above.
fn plane() -> (rtbench::scene::Scene, Camera) {
    let corners = [(-5.0, -5.0), (-5.0, 5.0), (5.0, 5.0), (5.0, -5.0)].map(|(x, z)| Vec3::new(x, 0.0, z));
    let camera = Camera {
        position: Vec3::new(0.3, 6.0, 0.2),
        direction: Vec3::NEG_Y,
        up: Vec3::new(0.0, 0.0, 1.0),
        field_of_view: 60.0,
    };
    (quads(&[(corners, Vec3::new(0.7, 0.2, 0.9))]), camera)
}

#[test]
fn direct_light_over_a_plane_is_the_formula() {
    let (scene, camera) = plane();
    let lights = [
        PointLight { position: Vec3::new(1.0, 2.0, -0.5), flux: Vec3::new(100.0, 30.0, 7.0) },
        PointLight { position: Vec3::new(-3.0, 0.5, 2.5), flux: Vec3::new(1.0, 20.0, 300.0) },
        PointLight { position: Vec3::new(0.0, -1.0, 0.0), flux: Vec3::splat(1000.0) }, // below the plane
    ];
    let device = CpuDevice::new(2).unwrap();
    let size = Size { width: 61, height: 47 };
    for lights in [&lights[..1], &lights[..]] {
        let lit = lit(scene.clone(), lights);
        let stages = on_cpu(&device, &lit, "bvh", (SETTING, estimate(&lit, 0.1), size), &camera);
        assert!(stages.samples.positions.iter().all(|sample| sample.w > 0.0));
        for (pixel, sample) in stages.samples.positions.iter().enumerate() {
            assert!((sample.w - 6.0).abs() < 1e-5, "depth {}", sample.w);
            let (point, albedo) = (sample.truncate().as_dvec3(), stages.samples.albedos[pixel].truncate().as_dvec3());
            let mut expected = glam::DVec3::ZERO;
            for light in lights.iter().filter(|light| light.position.y > 0.0) {
                let way = light.position.as_dvec3() - point;
                let cosine = way.y / way.length();
                expected += albedo / PI * light.flux.as_dvec3() / (4.0 * PI) * cosine / way.length_squared();
            }
            let error = (stages.direct[pixel].truncate().as_dvec3() - expected).abs() / expected;
            assert!(error.max_element() < 1e-5, "pixel {pixel}: {} instead of {expected}", stages.direct[pixel]);
        }
    }
}

#[test]
fn the_sources_falloff_is_its_formula() {
    let (mut scene, camera) = plane();
    scene.materials[0].specular = Vec3::new(0.5, 0.4, 0.1);
    scene.materials[0].exponent = 12.0;
    let light = PointLight { position: Vec3::new(1.0, 2.0, -0.5), flux: Vec3::new(100.0, 50.0, 25.0) };
    let lit = lit(scene, &[light]);
    let size = Size { width: 61, height: 47 };
    let setting = Setting { falloff: Falloff::Source, ..SETTING };
    let stages = on_cpu(&CpuDevice::new(2).unwrap(), &lit, "bvh", (setting, estimate(&lit, 0.1), size), &camera);
    for (pixel, sample) in stages.samples.positions.iter().enumerate() {
        let point = sample.truncate().as_dvec3();
        let (way, view) = (light.position.as_dvec3() - point, (point - camera.position.as_dvec3()).normalize());
        let to_light = way.normalize();
        let normal = glam::DVec3::Y;
        let mirrored = normal * (2.0 * normal.dot(to_light)) - to_light;
        let highlight = (-mirrored.dot(view)).max(1e-6).powf(12.0);
        let colour = glam::DVec3::new(1.0, 0.5, 0.25);
        let surface =
            glam::DVec3::new(0.7, 0.2, 0.9) * normal.dot(to_light) + glam::DVec3::new(0.5, 0.4, 0.1) * highlight;
        let falloff = 1.0 - way.length_squared() / f64::from(lit.influence()).powi(2);
        let expected = surface * colour * falloff;
        let error = (stages.direct[pixel].truncate().as_dvec3() - expected).abs().max_element();
        assert!(error < 2e-5, "pixel {pixel}: {} instead of {expected}", stages.direct[pixel]);
    }
}

#[test]
fn powers_are_those_of_the_standard_library() {
    for exponent in [0.0_f32, 0.5, 1.0, 2.5, 8.0, 33.25, 128.0, 1000.0, 65_535.0] {
        for x in [1e-6_f32, 0.01, 0.3, 0.7, 0.99, 0.999_9, 1.0] {
            let found = f64::from(direct::raised(x, (exponent * 256.0) as u32));
            let expected = f64::from(x).powf(f64::from(exponent));
            // Each squaring doubles the relative error of the one before
            let error = 1e-6 + f64::from(exponent) * f64::from(f32::EPSILON);
            let close = (found - expected).abs() <= error * expected || (expected < 1e-17 && found < 1e-17);
            assert!(close, "{x} to the power of {exponent}: {found} instead of {expected}");
        }
    }
}

#[test]
fn threads_do_not_change_photons_and_the_seed_does() {
    let scene = closed_box();
    let lights = [light_at(&scene, [0.3, 0.6, 0.4], Vec3::ONE), light_at(&scene, [0.9, 0.2, 0.5], Vec3::splat(0.1))];
    let camera = Camera { position: Vec3::ZERO, direction: Vec3::X, up: Vec3::Y, field_of_view: 90.0 };
    let lit = lit(scene, &lights);
    let frame = |threads: usize, structure: &str, setting: Setting| {
        let device = CpuDevice::new(threads).unwrap();
        let size = Size { width: 19, height: 11 };
        on_cpu(&device, &lit, structure, (setting, estimate(&lit, 0.1), size), &camera)
    };
    let first = frame(1, "bvh", SETTING);
    assert!(first.irradiance.iter().any(|irradiance| irradiance.x > 0.0));
    for threads in 2..=5 {
        assert_eq!(difference(&first, &frame(threads, "bvh", SETTING)), None, "{threads} threads");
    }
    for structure in ["bvh:packet=4x4", "bvh-stack", "grid-packet", "kdtree", "brute"] {
        assert_eq!(difference(&first, &frame(2, structure, SETTING)), None, "{structure}");
    }
    let other = frame(2, "bvh", Setting { seed: 2, ..SETTING });
    assert!(difference_of_photons("photons", &first.photons, &other.photons).is_some());
    assert_eq!((&first.samples, &first.direct), (&other.samples, &other.direct), "the seed is of photons only");
    // In a closed box no path is lost
    assert_eq!(first.traced.arrived, [SETTING.paths; 4]);
    assert_eq!(first.photons, first.traced.slots);
    let shared = frame(2, "bvh", Setting { energy: Energy::Shared, ..SETTING });
    for (all, part) in first.photons.fluxes.iter().zip(&shared.photons.fluxes) {
        assert_eq!(*all / 3.0, *part);
    }
}

/// Twice the flux is twice the indirect light, to the bit.
#[test]
fn twice_the_light_is_twice_the_irradiance() {
    let scene = scene::load("room:triangles=20000").unwrap();
    let camera = camera_of(&scene);
    let light = light_at(&scene, [0.4, 0.7, 0.5], Vec3::new(3.0, 2.0, 1.0));
    let device = CpuDevice::new(2).unwrap();
    let frame = |factor: f32| {
        let lit = lit(scene.clone(), &[PointLight { flux: light.flux * factor, ..light }]);
        let size = Size { width: 40, height: 30 };
        on_cpu(&device, &lit, "bvh", (SETTING, estimate(&lit, 0.2), size), &camera)
    };
    let (once, twice) = (frame(1.0), frame(2.0));
    assert!(once.irradiance.iter().filter(|irradiance| irradiance.x > 0.0).count() > 100);
    for (once, twice) in once.irradiance.iter().zip(&twice.irradiance) {
        assert_eq!((*once * 2.0).to_array().map(f32::to_bits), twice.to_array().map(f32::to_bits));
    }
    assert_ne!(once.irradiance, twice.irradiance);
}
