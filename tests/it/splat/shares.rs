//! How lights share paths: every path is somebody's, in proportion to power.

use super::support::Random;
use glam::Vec3;
use rtbench::workloads::splat::lit::{LightShare, LitScene, PointLight};

fn lit(fluxes: &[Vec3]) -> LitScene {
    let scene = rtbench::scene::load("plane").unwrap();
    let mut lit = LitScene::new(scene, None, &[]).unwrap();
    lit.lights = fluxes.iter().map(|&flux| PointLight { position: Vec3::Y, flux }).collect();
    lit
}

fn shares(powers: &[f32], paths: u32) -> Vec<LightShare> {
    let fluxes: Vec<Vec3> = powers.iter().map(|&power| Vec3::new(power, 0.0, 0.0)).collect();
    lit(&fluxes).shares(paths).unwrap()
}

fn counts(powers: &[f32], paths: u32) -> Vec<u32> {
    shares(powers, paths).iter().map(|share| share.paths).collect()
}

#[test]
fn paths_are_shared_by_power_and_remainder() {
    assert_eq!(counts(&[3.0], 5667), [5667], "one light has them all");
    assert_eq!(counts(&[2.0, 2.0, 2.0], 9), [3, 3, 3], "equal lights");
    assert_eq!(counts(&[2.0, 2.0, 2.0], 10), [4, 3, 3], "the first of equal remainders");
    assert_eq!(counts(&[1.0, 1000.0, 5.0], 3), [1, 1, 1], "as many paths as lights");
    // Eight beyond one each: 8 x 0.1, 0.2, 0.7 = 0.8, 1.6, 5.6
    assert_eq!(counts(&[1.0, 2.0, 7.0], 11), [2, 3, 6]);
    assert_eq!(counts(&[0.0, 5.0], 10), [1, 9], "a light without power has one");
    assert_eq!(counts(&[0.0, 0.0], 5), [3, 2], "lights without power share alike");
    assert_eq!(counts(&[1.0], u32::MAX), [u32::MAX]);
    // The sum of the channels decides
    let lit = lit(&[Vec3::new(1.0, 1.0, 1.0), Vec3::new(3.0, 0.0, 0.0)]);
    assert!(lit.shares(100).unwrap().iter().all(|share| share.paths == 50));
}

#[test]
fn a_path_carries_its_part_of_the_flux() {
    let flux = [Vec3::new(3.0, 6.0, 9.0), Vec3::new(1.0, 0.0, 0.5)];
    for (share, flux) in lit(&flux).shares(1000).unwrap().iter().zip(flux) {
        assert_eq!(share.path_flux, flux / share.paths as f32);
    }
}

#[test]
fn fewer_paths_than_lights_are_refused() {
    let error = lit(&[Vec3::ONE; 3]).shares(2).unwrap_err().to_string();
    assert!(error.starts_with("--paths: ") && error.contains("3 lights") && !error.contains('\n'), "{error}");
}

#[test]
fn every_path_has_one_light_whatever_the_powers() {
    let mut random = Random(11);
    for _ in 0..3000 {
        let lights = 1 + random.below(40);
        let powers: Vec<f32> =
            (0..lights).map(|_| random.below(1000) as f32 * 10f32.powi(random.below(30) as i32 - 15)).collect();
        let paths = lights as u32 + [0, 1, random.below(50), random.below(1 << 31)][random.below(4)] as u32;
        let mut next = 0;
        for (light, share) in shares(&powers, paths).iter().enumerate() {
            assert_eq!((share.light, share.first_path), (light, next));
            assert!(share.paths >= 1);
            next += share.paths;
        }
        assert_eq!(next, paths, "{powers:?}");
    }
}
