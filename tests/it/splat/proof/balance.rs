//! A closed room keeps all flux, a hole loses its share.

use super::scenes::{ROOM, ROOM_LIGHT, bare_room, cast_in, open_room, setting, traced};
use glam::{DVec3, Vec3};
use rtbench::workloads::splat::photons::Photons;

fn stored(photons: &Photons) -> DVec3 {
    photons.fluxes.iter().map(|flux| flux.truncate().as_dvec3()).sum()
}

/// The largest relative difference of a channel.
fn off(found: DVec3, expected: DVec3) -> f64 {
    ((found - expected) / expected).abs().max_element()
}

#[test]
fn a_closed_room_keeps_all_flux() {
    let lit = bare_room(Vec3::new(0.5, 0.8, 0.25));
    let albedo = lit.scene.materials[0].diffuse.as_dvec3();
    let flux = lit.lights[0].flux.as_dvec3();
    cast_in(&lit, |caster| {
        for seed in [0, 1, 2, 3, u32::MAX] {
            for hits in [2, 4, 8] {
                let traced = traced(caster, &lit, setting(20_000, hits, seed));
                assert_eq!(traced.arrived, vec![20_000; hits as usize], "seed {seed}");
                let powers: DVec3 = (1..hits).map(|k| albedo.powf(f64::from(k))).sum();
                let found = stored(&traced.slots);
                assert!(off(found, flux * powers) < 1.0e-5, "seed {seed}, hits {hits}: {found} {}", flux * powers);
                // One photon less, or an albedo too often, is more than that
                let mut less = traced.slots.clone();
                less.fluxes[7] *= 0.0;
                assert!(off(stored(&less), flux * powers) > 1.0e-5);
                assert!(off(found * albedo, flux * powers) > 0.1);
            }
        }
    });
}

/// The solid angle of a rectangle that is `height` away from a point, its sides relative to the point's foot.
fn solid_angle([x0, y0]: [f64; 2], [x1, y1]: [f64; 2], height: f64) -> f64 {
    let corner = |x: f64, y: f64| (x * y / (height * (x * x + y * y + height * height).sqrt())).atan();
    corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)
}

/// By how many standard deviations the paths that are lost at the first hit differ from the share of a solid angle.
fn deviations(paths: u32, arrived: u32, solid_angle: f64) -> f64 {
    let share = solid_angle / (4.0 * std::f64::consts::PI);
    let (n, lost) = (f64::from(paths), f64::from(paths - arrived));
    (lost - n * share) / (n * share * (1.0 - share)).sqrt()
}

#[test]
fn a_hole_loses_its_share() {
    // Seen from a cube's centre a face is a sixth of everything
    assert!((solid_angle([-1.0; 2], [1.0; 2], 1.0) - 4.0 * std::f64::consts::PI / 6.0).abs() < 1.0e-12);
    let hole = [[0.7, 1.5], [2.3, 3.2]];
    let lit = open_room(hole);
    let from_light = |[x, z]: [f32; 2]| [f64::from(x - ROOM_LIGHT.x), f64::from(z - ROOM_LIGHT.z)];
    let [low, high] = hole.map(from_light);
    let height = f64::from(ROOM.y - ROOM_LIGHT.y);
    let angle = solid_angle(low, high, height);
    cast_in(&lit, |caster| {
        for seed in 0..3 {
            let paths = 200_000;
            let arrived = traced(caster, &lit, setting(paths, 4, seed)).arrived;
            let sigmas = deviations(paths, arrived[0], angle);
            println!("seed {seed}: {:.4} sr of the hole, arrived {arrived:?}, {sigmas:.2} sigma", angle);
            assert!(sigmas.abs() < 4.0, "{sigmas}");
            assert!(arrived.windows(2).all(|pair| pair[1] < pair[0]));
            // A hole that is a twentieth larger is another one
            assert!(deviations(paths, arrived[0], angle * 1.05).abs() > 4.0);
        }
    });
}
