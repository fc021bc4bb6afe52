//! The reference against a closed form, and its standard error.

use super::scenes::{ON, cast_in, pool, room, room_camera, sphere};
use glam::{DVec3, Vec3};
use rayon::ThreadPool;
use rtbench::camera::Camera;
use rtbench::error::Error;
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::lit::{LitScene, PointLight};
use rtbench::workloads::splat::reference::path_traced::{Effort, PathTraced, View, trace};
use rtbench::workloads::splat::reference::pixels::fixed_pixels;
use rtbench::workloads::trace::backend::Prepared;
use std::f64::consts::PI;

const SIZE: Size = Size { width: 64, height: 48 };

fn in_sphere() -> Camera {
    let direction = Vec3::new(1.0, 0.3, 0.2).normalize();
    Camera { position: Vec3::new(-0.3, 0.1, 0.2), direction, up: Vec3::Y, field_of_view: 100.0 }
}

fn traced(caster: &mut dyn Prepared, view: &View, paths: u32, seed: u64) -> PathTraced {
    traced_by(pool(), caster, view, paths, seed)
}

fn traced_by(pool: &ThreadPool, caster: &mut dyn Prepared, view: &View, paths: u32, seed: u64) -> PathTraced {
    trace(pool, caster, view, Effort { least: paths, most: paths, error: 0.0, seed }, ON).unwrap()
}

/// Squares of the differences in standard errors, their mean over pixels and channels.
fn squares(found: &PathTraced, expected: DVec3) -> f64 {
    let square = |(e, error): (&DVec3, &DVec3)| ((*e - expected) / *error).powf(2.0).element_sum() / 3.0;
    found.irradiance.iter().zip(&found.error).map(square).sum::<f64>() / found.irradiance.len() as f64
}

/// Everywhere in a sphere of one albedo the irradiance after the first hit is the same.
#[test]
fn in_the_sphere_it_is_the_closed_form() {
    let lit = sphere(0.5, Vec3::new(1.0, 2.0, 4.0));
    let pixels = fixed_pixels(SIZE, 300);
    cast_in(&lit, |caster| {
        for hits in [2, 4, 6] {
            let sum: f64 = (1..hits).map(|k| 0.5_f64.powi(k)).sum();
            let expected = lit.lights[0].flux.as_dvec3() * sum / (4.0 * PI);
            let view = View { lit: &lit, camera: in_sphere(), size: SIZE, pixels: &pixels, hits: hits as u32 };
            let found = traced(caster, &view, 512, 0);
            let sigmas = (found.mean - expected) / found.mean_error;
            let by_seed = |seed: u64| squares(&traced(caster, &view, 512, seed), expected);
            let seeds = if hits == 2 { 8 } else { 1 };
            let by_seed: Vec<f64> = (0..seeds).map(by_seed).collect();
            let (squares_of, _) = super::statistics::mean(&by_seed);
            println!(
                "hits {hits}: {:.5} of the closed form, {:.2} sigma, error {:.3} %, mean square {squares_of:.3} {by_seed:.3?}",
                (found.mean / expected).x,
                sigmas.x,
                100.0 * found.relative_error()
            );
            assert!(sigmas.abs().max_element() < 4.0, "{sigmas}");
            assert!((found.mean / expected - 1.0).abs().max_element() < 0.01);
            // Of 300 pixels a seed; the channels are factors of each other
            assert!((0.85..1.2).contains(&squares_of), "{squares_of}");
            // An albedo more or a reflection less is another result
            assert!(((found.mean * 0.5 - expected) / found.mean_error).abs().min_element() > 50.0);
            let less = expected - lit.lights[0].flux.as_dvec3() * 0.5_f64.powi(hits - 1) / (4.0 * PI);
            assert!(((found.mean - less) / found.mean_error).abs().min_element() > 5.0, "hits {hits}");
        }
    });
}

/// Of many seeds the means differ as much as each says that it may.
#[test]
fn its_standard_error_is_honest() {
    let lit = room();
    let pixels = fixed_pixels(SIZE, 100);
    let view = View { lit: &lit, camera: room_camera(), size: SIZE, pixels: &pixels, hits: 4 };
    let all: Vec<PathTraced> = cast_in(&lit, |caster| (0..20).map(|seed| traced(caster, &view, 128, seed)).collect());
    let spread = |of: &dyn Fn(&PathTraced) -> f64| super::statistics::mean(&all.iter().map(of).collect::<Vec<_>>()).1;
    let printed = |of: &dyn Fn(&PathTraced) -> f64| all.iter().map(of).sum::<f64>() / 20.0 / 20.0_f64.sqrt();
    let ratios = [
        spread(&|t| t.mean.x) / printed(&|t| t.mean_error.x),
        spread(&|t| t.mean.z) / printed(&|t| t.mean_error.z),
        spread(&|t| t.mean.element_sum()) / printed(&|t| t.sum_error),
    ];
    println!("spread of 20 seeds / printed error: {ratios:.3?}");
    // 99.9 % of such ratios of 20 values lie within
    assert!(ratios.iter().all(|ratio| (0.5..1.55).contains(ratio)), "{ratios:?}");
    // Pixel by pixel
    let pixel = |pixel: usize| {
        let values: Vec<f64> = all.iter().map(|t| t.irradiance[pixel].y).collect();
        let printed = all.iter().map(|t| t.error[pixel].y.powi(2)).sum::<f64>() / 20.0;
        super::statistics::mean(&values).1.powi(2) * 20.0 / printed
    };
    let ratio = (0..pixels.len()).map(pixel).sum::<f64>() / pixels.len() as f64;
    println!("variance of a pixel over 20 seeds / printed: {ratio:.3}");
    assert!((0.85..1.15).contains(&ratio), "{ratio}");
    assert!(all.windows(2).all(|pair| pair[0].mean != pair[1].mean), "seeds are alike");
}

#[test]
fn effort_ends_where_the_error_is_small_enough() {
    let lit = room();
    let pixels = fixed_pixels(SIZE, 200);
    let view = View { lit: &lit, camera: room_camera(), size: SIZE, pixels: &pixels, hits: 4 };
    cast_in(&lit, |caster| {
        let effort = Effort { least: 16, most: 512, error: 0.008, seed: 0 };
        let found = trace(pool(), caster, &view, effort, ON).unwrap();
        println!("{} paths, {:.4}", found.paths, found.relative_error());
        assert!(found.paths > 16 && found.paths.is_power_of_two() && found.relative_error() < 0.008);
        // In two turns or in one: the same paths
        let at_once = traced(caster, &view, found.paths, 0);
        assert!((at_once.mean - found.mean).abs().max_element() < 1.0e-12);
        let ended = trace(pool(), caster, &view, Effort { error: 0.0, most: 64, ..effort }, ON).unwrap();
        assert_eq!(ended.paths, 64);
        // Threads change nothing
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let again = traced_by(&pool, caster, &view, found.paths, 0);
            assert_eq!(again, at_once, "{threads} threads");
        }
    });
}

#[test]
fn lights_add_up_and_flux_is_a_factor() {
    let one = room();
    let pixels = fixed_pixels(SIZE, 50);
    let mean = |lit: &LitScene| {
        let view = View { lit, camera: room_camera(), size: SIZE, pixels: &pixels, hits: 3 };
        cast_in(lit, |caster| traced(caster, &view, 32, 0)).mean
    };
    let other = PointLight { position: Vec3::new(3.4, 0.5, 4.0), flux: Vec3::new(5.0, 0.0, 9.0) };
    let with = |lights: Vec<PointLight>| LitScene { lights, ..one.clone() };
    let first = mean(&one);
    let second = mean(&with(vec![other]));
    let both = mean(&with(vec![one.lights[0], other]));
    assert!((both - first - second).abs().max_element() < 1.0e-9 * both.max_element());
    assert!(second.y == 0.0 && second.x > 0.0);
    let twice = mean(&with(vec![PointLight { flux: one.lights[0].flux * 2.0, ..one.lights[0] }]));
    assert!((twice - first * 2.0).abs().max_element() < 1.0e-12 * twice.max_element());
}

#[test]
fn edges_of_the_reference() {
    let lit = room();
    let dark = LitScene { lights: vec![PointLight { flux: Vec3::ZERO, ..lit.lights[0] }], ..lit.clone() };
    // From outside of the room, away from it
    let away = Camera { position: Vec3::new(-1.0, 1.0, 1.0), direction: Vec3::NEG_X, ..room_camera() };
    let pixels = [0, 5];
    let view = View { lit: &lit, camera: away, size: SIZE, pixels: &pixels, hits: 4 };
    cast_in(&lit, |caster| {
        let nothing = trace(pool(), caster, &view, Effort::default(), ON).unwrap();
        assert_eq!((nothing.paths, nothing.mean, nothing.relative_error()), (256, DVec3::ZERO, 0.0));
        let unlit =
            trace(pool(), caster, &View { lit: &dark, camera: room_camera(), ..view }, Effort::default(), ON).unwrap();
        assert_eq!(unlit.irradiance, [DVec3::ZERO; 2]);
        let none = trace(pool(), caster, &View { pixels: &[], ..view }, Effort::default(), ON).unwrap();
        assert_eq!((none.mean, none.sum_error), (DVec3::ZERO, 0.0));
        // A light on the wall: nothing divides by zero
        let on_wall = PointLight { position: Vec3::new(0.0, 1.0, 1.0), ..lit.lights[0] };
        let on_wall = LitScene { lights: vec![on_wall], ..lit.clone() };
        let wall = View { lit: &on_wall, camera: room_camera(), ..view };
        assert!(trace(pool(), caster, &wall, Effort { most: 256, ..Effort::default() }, ON).unwrap().mean.is_finite());
        let outside = View { pixels: &[64 * 48], ..view };
        let error = trace(pool(), caster, &outside, Effort::default(), ON).unwrap_err().to_string();
        assert!(error.contains("pixel 3072 is outside of 64x48"), "{error}");
        assert!(matches!(trace(pool(), caster, &view, Effort::default(), &|| true), Err(Error::Interrupted)));
    });
}
