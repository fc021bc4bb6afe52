//! Every renderer on the CPU makes the reference's bits, whatever its width, level, switches and threads; the reference
//! is held to a picture in double precision by other formulas.

use super::support::{self, Scene, frame, switches, view};
use glam::DVec3;
use half::f16;
use rtbench::workloads::spheres::options::{Algorithm, HitRecord, Lanes, Options, Renderer};
use rtbench::workloads::spheres::render::compare::{self, compare};
use rtbench::workloads::spheres::render::reference::{self, Reference};
use rtbench::workloads::spheres::render::{exact, half as half_precision};
use rtbench::workloads::spheres::view::View;

const ALGORITHMS: [Algorithm; 2] = [Algorithm::TwoPass, Algorithm::OnePass];

/// Panics where pictures, hits or counts of a renderer are not the reference's.
fn same(renderer: Renderer, options: Options, scene: &Scene, view: &View, reference: &Reference) {
    let frame = frame(renderer, options, None, &scene.spheres, view);
    let width = view.width as usize;
    let what = format!("{renderer:?} {options:?} at {} x {}", view.width, view.height);
    assert_eq!(compare(&frame.timed, &reference.image, width), None, "{what}");
    assert_eq!(compare(&frame.counted, &reference.image, width), None, "counted, {what}");
    assert_eq!(frame.hits, reference.hits, "{what}");
    assert_eq!(frame.counts.rays, reference.counts.rays, "{what}");
    assert_eq!(frame.counts.hits, reference.counts.hits, "{what}");
}

#[test]
fn all_renderers_make_the_same_bits_with_all_switches() {
    let scene = support::random(20, 7);
    for (width, height) in [(1, 1), (7, 5), (509, 3), (64, 36)] {
        let view = view(&scene, width, height, 5);
        for algorithm in ALGORITHMS {
            let reference = reference::render(&scene.spheres, &view, algorithm);
            for options in switches(algorithm, false) {
                same(Renderer::Sequential, options, &scene, &view, &reference);
            }
            for renderer in support::simd() {
                for options in switches(algorithm, true) {
                    same(renderer, options, &scene, &view, &reference);
                }
            }
        }
    }
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let scene = support::random(20, 8);
    for (width, height) in [(1, 1), (7, 5), (509, 3), (64, 36)] {
        let view = view(&scene, width, height, 4);
        for algorithm in ALGORITHMS {
            let reference = reference::render(&scene.spheres, &view, algorithm);
            let options = *switches(algorithm, true).last().unwrap();
            let scalar = Options { skip_no_hit: false, skip_no_discriminant: false, ..options };
            for threads in 1..=5 {
                same(Renderer::Threads(threads), scalar, &scene, &view, &reference);
                for lanes in support::LANES {
                    same(Renderer::SimdThreads(lanes, None, threads), options, &scene, &view, &reference);
                }
            }
        }
    }
}

#[test]
fn numbers_of_trips_and_spheres_change_no_bit() {
    for (spheres, trips) in [(1, 1), (3, 1), (3, 2), (100, 64)] {
        let scene = support::random(spheres, 5);
        let view = view(&scene, 30, 17, trips);
        for algorithm in ALGORITHMS {
            let reference = reference::render(&scene.spheres, &view, algorithm);
            let options = *switches(algorithm, true).last().unwrap();
            for renderer in support::simd() {
                same(renderer, options, &scene, &view, &reference);
                same(renderer, Options { exit_on_miss: false, ..options }, &scene, &view, &reference);
            }
        }
    }
}

/// The largest difference of any channel.
fn largest(a: &[[f32; 4]], b: &[[f32; 4]]) -> f32 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// A path that missed stays dead although the next ray, made from the last hit, finds a sphere: most rays that leave
/// the scene do so from a sphere that the mirrored direction points into.
#[test]
fn two_passes_and_one_make_the_same_picture_also_where_a_dead_path_would_hit() {
    let scene = support::random(20, 7);
    let view = view(&scene, 96, 54, 5);
    let [two, one] = ALGORITHMS.map(|algorithm| reference::render(&scene.spheres, &view, algorithm));
    assert!(two.hits_again > 500, "{} pixels", two.hits_again);
    let difference = largest(&two.image, &one.image);
    assert!(difference <= 1e-6, "{difference}");
    assert!(difference > 0.0, "two orders of the same sum");
    // With the same switches, from the renderers
    for exit_on_miss in [false, true] {
        let made = ALGORITHMS.map(|algorithm| {
            let options = Options { algorithm, exit_on_miss, hit: HitRecord::Index, ..switches(algorithm, true)[0] };
            frame(Renderer::Simd(Lanes::Eight, None), options, None, &scene.spheres, &view).timed
        });
        assert!(largest(&made[0], &made[1]) <= 1e-6);
    }
}

/// Share of the pixels of which no channel is further than 1e-3 from the picture in double precision, of those that are
/// not black in both.
fn near_exact(picture: &[[f32; 4]], exact: &[[f64; 3]]) -> f64 {
    let black = |(a, b): &(&[f32; 4], &[f64; 3])| (0..3).all(|c| a[c] == 0.0 && b[c] == 0.0);
    let near = |(a, b): &(&[f32; 4], &[f64; 3])| (0..3).all(|c| (f64::from(a[c]) - b[c]).abs() <= 1e-3);
    let seen: Vec<_> = picture.iter().zip(exact).filter(|pair| !black(pair)).collect();
    seen.iter().filter(|pair| near(pair)).count() as f64 / seen.len() as f64
}

/// At edges another sphere is hit, and rounding grows with each reflection at a small sphere: one pixel in a thousand
/// may be further away, and one in fifty after five trips among a hundred spheres.
#[test]
fn the_picture_is_near_that_in_double_precision() {
    for (spheres, seed, trips, bar) in [(3, 1, 5, 0.999), (20, 7, 5, 0.999), (100, 2, 1, 0.999), (100, 2, 5, 0.98)] {
        let scene = support::random(spheres, seed);
        let view = view(&scene, 160, 90, trips);
        let exact = exact::render(&scene.spheres, &view);
        let picture = reference::render(&scene.spheres, &view, Algorithm::OnePass);
        let share = near_exact(&picture.image, &exact);
        assert!(share >= bar, "{spheres} spheres, {trips} trips: {share}");

        // A picture with another number of trips, one with another light and one that is moved by a pixel are not near
        let depth = View { trips: if trips == 1 { 2 } else { 1 }, ..view };
        let light = View { light: DVec3::new(0.6, 0.7, 0.4).normalize().as_vec3(), ..view };
        let moved = View { corner: view.corner + view.right, ..view };
        for wrong in [depth, light, moved] {
            let wrong = reference::render(&scene.spheres, &wrong, Algorithm::OnePass);
            let share = near_exact(&wrong.image, &exact);
            assert!(share < bar, "{spheres} spheres, {trips} trips: {share}");
        }
    }
}

#[test]
fn pictures_are_rated_on_what_a_screen_shows() {
    let black = [[0.0, 0.0, 0.0, 1.0]; 4];
    let mut other = black;
    other[2] = [0.5, -3.0, 7.0, 0.0];
    // 12 channels, of which one differs by 1/2 and one by 1; alpha and what lies below black do not count
    assert_eq!(compare::rmse(&black, &other), (1.25f64 / 12.0).sqrt());
    assert_eq!(compare::largest_difference(&black, &other), 1.0);
    assert_eq!(compare::rmse(&other, &other), 0.0);
    assert_eq!(compare::rgba8(&other)[2], [128, 0, 255, 0]);
    assert_eq!(compare::rgba8(&[[0.1, f32::NAN, f32::INFINITY, 1.0]]), [[26, 0, 255, 255]]);
    assert_eq!(compare::difference(&black, &other, 2.0)[2], [1.0, 0.0, 2.0, 1.0]);
    let nan = [[f32::NAN, 0.0, 0.0, 1.0]; 4];
    assert_eq!(compare::rmse(&black, &nan), 0.0, "not a number is shown as black");
}

/// Each operation of half precision is the exact one, rounded once.
#[test]
fn half_precision_rounds_every_operation() {
    let mut number = support::numbers(11);
    for _ in 0..20_000 {
        let [a, b] = [(); 2].map(|()| f16::from_f32((number() - 0.5) * 200.0));
        let [wide_a, wide_b] = [a.to_f64(), b.to_f64()];
        let pairs = [
            (a + b, wide_a + wide_b),
            (a - b, wide_a - wide_b),
            (a * b, wide_a * wide_b),
            (a / b, wide_a / wide_b),
            (f16::from_f32(a.to_f32().abs().sqrt()), wide_a.abs().sqrt()),
        ];
        for (half, wide) in pairs {
            assert_eq!(half.to_bits(), f16::from_f64(wide).to_bits(), "{a} {b}");
        }
    }
}

#[test]
fn half_precision_spoils_the_picture_and_leaves_it_recognisable() {
    let scene = support::random(20, 7);
    let view = view(&scene, 96, 54, 5);
    for algorithm in ALGORITHMS {
        let single = reference::render(&scene.spheres, &view, algorithm).image;
        let half = half_precision::render(&scene.spheres, &view, algorithm);
        assert_eq!(half.len(), single.len());
        let rmse = compare::rmse(&single, &half);
        assert!(rmse > 0.01, "{algorithm:?}: {rmse}");
        // Numbers of 16 bits remain 16 bits wide
        assert!(half.iter().flatten().all(|&c| f16::from_f32(c).to_f32().to_bits() == c.to_bits()));
        let black = vec![[0.0, 0.0, 0.0, 1.0]; single.len()];
        assert!(rmse < compare::rmse(&single, &black), "{algorithm:?}: {rmse}");
    }
}
