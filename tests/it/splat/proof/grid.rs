//! The estimate by cells against the plain loop.

use super::scenes::{ON, cast_in, pool, room, room_camera, setting, traced};
use crate::support::random;
use glam::{DVec3, Vec3, Vec4};
use rtbench::error::Error;
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::photons::Photons;
use rtbench::workloads::splat::reference::cells::{Cells, neighbours};
use rtbench::workloads::splat::reference::exact::{self, Exact};
use rtbench::workloads::splat::samples::Samples;
use rtbench::workloads::splat::setting::{Estimate, EstimateKernel, Weight};
use rtbench::workloads::splat::{estimate, samples};

const KINDS: [(EstimateKernel, Weight); 4] = [
    (EstimateKernel::Epanechnikov, Weight::Side),
    (EstimateKernel::Constant, Weight::Side),
    (EstimateKernel::Epanechnikov, Weight::Cosine),
    (EstimateKernel::Constant, Weight::Cosine),
];

/// The largest difference of a pixel's channel beyond what is ambiguous, as a share of the mean.
fn off(found: &[Exact], plain: &[Vec4]) -> f64 {
    let mean = plain.iter().map(|e| e.truncate().as_dvec3()).sum::<DVec3>() / plain.len() as f64;
    let difference = |(found, plain): (&Exact, &Vec4)| {
        ((found.value - plain.truncate().as_dvec3()).abs() - found.ambiguous) / mean.max(DVec3::splat(1.0e-30))
    };
    found.iter().zip(plain).map(difference).fold(0.0, |most, off| most.max(off.max_element()))
}

fn photons_of_room(paths: u32) -> (Photons, Samples) {
    let lit = room();
    let size = Size { width: 64, height: 48 };
    cast_in(&lit, |caster| {
        let photons = traced(caster, &lit, setting(paths, 4, 5)).slots.compacted();
        (photons, samples::collect(caster, &lit, &room_camera(), size).unwrap())
    })
}

#[test]
fn cells_and_the_plain_loop_agree() {
    let (photons, samples) = photons_of_room(3_334);
    assert!(photons.len() >= 10_000);
    let pixels: Vec<u32> = (0..samples.positions.len() as u32).collect();
    for (kernel, weight) in KINDS {
        for radius in [0.02, 0.2, 1.0, 20.0] {
            let estimate = Estimate { kernel, weight, form: Default::default(), radius };
            let plain = estimate::irradiance(pool(), &samples, &photons, &estimate, ON).unwrap();
            let cells = Cells::new(pool(), &photons, estimate).irradiance(&samples, &pixels, ON).unwrap();
            let exact = exact::irradiance(pool(), &samples, &photons, &estimate, &pixels, ON).unwrap();
            let alike = |(a, b): (&Exact, &Exact)| (a.value - b.value).length() <= 1.0e-12 * b.value.length();
            assert!(cells.iter().zip(&exact).all(alike), "{kernel:?} {weight:?} {radius}");
            let off = off(&cells, &plain);
            println!("{kernel:?} {weight:?} {radius}: {off:.2e}");
            // 10,000 photons are no more than 256 + 40 roundings
            assert!(off < 1.0e-5, "{kernel:?} {weight:?} {radius}: {off}");
        }
    }
}

/// Photons and samples anywhere in a cube, facing each other.
fn cloud() -> (Photons, Samples) {
    let mut random = random(3);
    let mut points = |count: usize| -> Vec<Vec4> {
        (0..count).map(|_| Vec3::new(random(), random(), random()).extend(2.0)).collect()
    };
    let (positions, seen) = (points(10_000), points(500));
    let all = |count: usize, v: Vec4| vec![v; count];
    let photons =
        Photons { positions, directions: all(10_000, Vec4::NEG_Y), fluxes: all(10_000, Vec4::new(1.0, 2.0, 3.0, 0.0)) };
    let samples = Samples { positions: seen, normals: all(500, Vec4::Y), albedos: all(500, Vec4::ONE) };
    (photons, samples)
}

#[test]
fn a_neighbour_left_out_is_found() {
    let (photons, samples) = cloud();
    let pixels: Vec<u32> = (0..500).collect();
    let estimate =
        Estimate { kernel: EstimateKernel::Epanechnikov, weight: Weight::Side, form: Default::default(), radius: 0.15 };
    let plain = estimate::irradiance(pool(), &samples, &photons, &estimate, ON).unwrap();
    let cells = Cells::new(pool(), &photons, estimate);
    assert!(off(&cells.irradiance(&samples, &pixels, ON).unwrap(), &plain) < 1.0e-5);
    assert_eq!(neighbours().len(), 27);
    for left_out in neighbours() {
        let kept: Vec<_> = neighbours().into_iter().filter(|&neighbour| neighbour != left_out).collect();
        let found = cells.irradiance_over(&samples, &pixels, &kept, ON).unwrap();
        assert!(off(&found, &plain) > 1.0e-2, "{left_out}");
    }
}

#[test]
fn what_is_ambiguous_is_given() {
    let at = |position: Vec3, direction: Vec3| Photons {
        positions: vec![position.extend(2.0)],
        directions: vec![direction.extend(0.0)],
        fluxes: vec![Vec4::ONE],
    };
    let samples = Samples { positions: vec![Vec4::W], normals: vec![Vec4::Y], albedos: vec![Vec4::ONE] };
    let estimate =
        Estimate { kernel: EstimateKernel::Constant, weight: Weight::Side, form: Default::default(), radius: 1.0 };
    let of = |photons: &Photons| {
        let cells = Cells::new(pool(), photons, estimate).irradiance(&samples, &[0], ON).unwrap();
        let plain = exact::irradiance(pool(), &samples, photons, &estimate, &[0], ON).unwrap();
        assert_eq!(cells, plain);
        (plain[0].value.x > 0.0, plain[0].ambiguous.x > 0.0)
    };
    let grazing = |y: f32| Vec3::new((1.0 - y * y).sqrt(), -y, 0.0);
    assert_eq!(of(&at(Vec3::X * 0.5, Vec3::NEG_Y)), (true, false));
    assert_eq!(of(&at(Vec3::X * 0.999_999, Vec3::NEG_Y)), (true, true));
    assert_eq!(of(&at(Vec3::X * 1.000_001, Vec3::NEG_Y)), (false, true));
    assert_eq!(of(&at(Vec3::X * 1.001, Vec3::NEG_Y)), (false, false));
    assert_eq!(of(&at(Vec3::X * 0.5, grazing(1.0e-6))), (true, true));
    assert_eq!(of(&at(Vec3::X * 0.5, grazing(-1.0e-6))), (false, true));
    assert_eq!(of(&at(Vec3::X * 0.5, Vec3::Y)), (false, false));
}

#[test]
fn nothing_gives_nothing() {
    let (photons, mut samples) = cloud();
    let estimate =
        Estimate { kernel: EstimateKernel::Constant, weight: Weight::Side, form: Default::default(), radius: 0.2 };
    // No photons, only empty slots, a pixel without a sample
    let mut empty = photons.clone();
    empty.positions.iter_mut().for_each(|position| position.w = 0.0);
    for photons in [&Photons::default(), &empty] {
        let found = Cells::new(pool(), photons, estimate).irradiance(&samples, &[0, 1], ON).unwrap();
        assert_eq!(found, vec![Exact::default(); 2]);
    }
    samples.positions[7] = Vec4::ZERO;
    let cells = Cells::new(pool(), &photons, estimate);
    assert_eq!(cells.irradiance(&samples, &[7], ON).unwrap(), [Exact::default()]);
    assert!(matches!(cells.irradiance(&samples, &[1], &|| true), Err(Error::Interrupted)));
    // A radius so small that cells are longer than it
    let tiny = Estimate { radius: 1.0e-9, ..estimate };
    assert_eq!(
        Cells::new(pool(), &photons, tiny).irradiance(&samples, &[3, 4], ON).unwrap(),
        vec![Exact::default(); 2]
    );
}
