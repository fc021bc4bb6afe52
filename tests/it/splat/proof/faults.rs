//! Planted faults are found with 20,000 paths: the mean over pixels differs from the path-traced reference's by many
//! standard errors. The photons' standard error is that of 20 parts of the paths, since photons of a path are no
//! independent ones.

use super::scenes::{ON, ROOM_SIZE, cast_in, of_hits, pool, room, room_camera, setting, traced};
use super::statistics::{mean, mean_sum};
use glam::DVec3;
use rtbench::workloads::splat::lit::LitScene;
use rtbench::workloads::splat::photons::Photons;
use rtbench::workloads::splat::reference::cells::Cells;
use rtbench::workloads::splat::reference::path_traced::{Effort, PathTraced, View, trace};
use rtbench::workloads::splat::reference::pixels::fixed_pixels;
use rtbench::workloads::splat::samples::{self, Samples};
use rtbench::workloads::splat::setting::{Estimate, EstimateKernel, Weight};
use rtbench::workloads::splat::surface::surface_at;
use rtbench::workloads::splat::{emit, photons};
use rtbench::workloads::trace::backend::Prepared;

const PATHS: u32 = 20_000;

/// Parts of the paths.
const PARTS: usize = 20;

/// By how many standard errors the mean of an estimate differs from the reference's, and their ratio.
fn sigmas(photons: &Photons, samples: &Samples, radius: f32, reference: &PathTraced) -> (f64, f64) {
    let estimate =
        Estimate { kernel: EstimateKernel::Epanechnikov, weight: Weight::Side, form: Default::default(), radius };
    let part = |part: usize| {
        let mut own = photons.clone();
        let others = |index: &usize| photons.directions[*index].w as usize % PARTS != part;
        (0..photons.len()).filter(others).for_each(|index| own.positions[index].w = 0.0);
        let found = Cells::new(pool(), &own, estimate).irradiance(samples, &reference.pixels, ON).unwrap();
        mean_sum(&found.iter().map(|e| e.value * PARTS as f64).collect::<Vec<DVec3>>())
    };
    let (found, error) = mean(&(0..PARTS).map(part).collect::<Vec<_>>());
    let expected = reference.mean.element_sum();
    ((found - expected) / error.hypot(reference.sum_error), found / expected)
}

/// Photons of the first hit too.
fn with_first(caster: &mut dyn Prepared, lit: &LitScene, photons: &Photons) -> Photons {
    let setting = setting(PATHS, 4, 0);
    let (rays, fluxes) = emit::rays(lit, &lit.shares(PATHS).unwrap(), &setting);
    let hits = caster.cast(&rays, None).unwrap();
    let mut all = photons.clone();
    for (path, ((ray, hit), flux)) in rays.iter().zip(hits).zip(fluxes).enumerate() {
        let surface = surface_at(&lit.scene, ray, hit, lit.epsilon()).unwrap();
        all.positions.push(surface.point.extend(1.0));
        all.directions.push(ray.direction.extend(path as f32));
        all.fluxes.push(flux);
    }
    all
}

/// Every photon has the flux that leaves its surface instead of the one that arrives.
fn albedo_once_more(lit: &LitScene, longer: &photons::Photons) -> Photons {
    let mut faulty = longer.clone();
    // Slots of 5 hits: four a path, each with the flux of the next
    for slot in 0..faulty.len() {
        match slot % 4 {
            3 => faulty.positions[slot].w = 0.0,
            _ => faulty.fluxes[slot] = longer.fluxes[slot + 1],
        }
    }
    assert!(lit.lights.len() == 1 && longer.len() == PATHS as usize * 4);
    faulty.compacted()
}

#[test]
fn planted_faults_are_found() {
    let lit = room();
    let pixels = fixed_pixels(ROOM_SIZE, 2000);
    let view = View { lit: &lit, camera: room_camera(), size: ROOM_SIZE, pixels: &pixels, hits: 4 };
    cast_in(&lit, |caster| {
        let reference = trace(pool(), caster, &view, Effort::default(), ON).unwrap();
        let samples = samples::collect(caster, &lit, &room_camera(), ROOM_SIZE).unwrap();
        // The right one passes with any seed: the squares of its deviations have the mean 1
        let deviation = |seed: u32| {
            let photons = traced(caster, &lit, setting(PATHS, 4, seed)).slots.compacted();
            sigmas(&photons, &samples, lit.diagonal() * 0.03, &reference).0
        };
        let deviations: Vec<f64> = (0..8).map(deviation).collect();
        println!("as it is, by seed: {deviations:.1?} sigma");
        assert!(deviations.iter().all(|sigmas| sigmas.abs() < 4.0), "{deviations:?}");
        let right = traced(caster, &lit, setting(PATHS, 4, 0)).slots;
        let longer = traced(caster, &lit, setting(PATHS, 5, 0)).slots;
        assert_eq!(of_hits(&longer, |hit| hit <= 4), right.compacted());
        let cases = [
            ("as it is", right.compacted(), false),
            ("albedo once more", albedo_once_more(&lit, &longer), true),
            ("hits 3", of_hits(&right, |hit| hit <= 3), true),
            ("hits 5", longer.compacted(), true),
            ("the first hit too", with_first(caster, &lit, &right.compacted()), true),
        ];
        for (name, photons, is_wrong) in cases {
            let (sigmas, ratio) = sigmas(&photons, &samples, lit.diagonal() * 0.03, &reference);
            println!("{name}: {} photons, ratio {ratio:.4}, {sigmas:.1} sigma", photons.len());
            assert_eq!(sigmas.abs() > 4.0, is_wrong, "{name}: {sigmas}");
        }
    });
}
