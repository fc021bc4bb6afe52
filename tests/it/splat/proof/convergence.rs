//! Means and the order of convergence, in the box and in sponza.
//!
//! The error is the root of the mean squared difference from the path-traced reference over fixed pixels, less the
//! reference's own variance, as a share of the mean. With n paths it is made of noise, which falls as n^-1/2, and of
//! the bias by the radius, which does not.

use super::scenes::{ON, ROOM_SIZE, cast_in, pool, setting, traced};
use super::statistics::{mean_sum, slope};
use crate::support::file_below;
use glam::DVec3;
use rtbench::camera::{Camera, CameraPath};
use rtbench::scene::{self, catalogue};
use rtbench::workloads::splat::lit::LitScene;
use rtbench::workloads::splat::reference::cells::Cells;
use rtbench::workloads::splat::reference::path_traced::{Effort, PathTraced, View, trace};
use rtbench::workloads::splat::reference::pixels::fixed_pixels;
use rtbench::workloads::splat::samples;
use rtbench::workloads::splat::setting::{Estimate, EstimateKernel, Weight};

const PIXELS: u32 = 2000;

/// See above.
fn error(found: &[DVec3], reference: &PathTraced) -> f64 {
    let square = |(found, (e, error)): (&DVec3, (&DVec3, &DVec3))| {
        ((*found - *e).powf(2.0) - error.powf(2.0)).element_sum() / 3.0
    };
    let references = reference.irradiance.iter().zip(&reference.error);
    let squares: f64 = found.iter().zip(references).map(square).sum();
    (squares / found.len() as f64).max(0.0).sqrt() / (reference.mean.element_sum() / 3.0)
}

/// Ratio of means with the most paths and the small radius; slopes of the error by radius as a share of the diagonal,
/// over all numbers of paths and over the last two.
struct Figures {
    ratio: f64,
    slopes: [f64; 2],
    last: [f64; 2],
}

const RADII: [f32; 2] = [0.003, 0.03];

fn figures(lit: &LitScene, camera: Camera) -> Figures {
    let pixels = fixed_pixels(ROOM_SIZE, PIXELS);
    let view = View { lit, camera, size: ROOM_SIZE, pixels: &pixels, hits: 4 };
    cast_in(lit, |caster| {
        let reference = trace(pool(), caster, &view, Effort::default(), ON).unwrap();
        println!("reference: {} paths, standard error {:.3} %", reference.paths, 100.0 * reference.relative_error());
        assert!(reference.relative_error() < 0.005);
        let samples = samples::collect(caster, lit, &camera, ROOM_SIZE).unwrap();
        let (mut ratio, mut points) = (0.0, [Vec::new(), Vec::new()]);
        for paths in [10_000, 100_000, 1_000_000] {
            let photons = traced(caster, lit, setting(paths, 4, paths)).slots;
            for (radius, points) in RADII.iter().zip(&mut points) {
                let radius = lit.diagonal() * radius;
                let estimate = Estimate {
                    kernel: EstimateKernel::Epanechnikov,
                    weight: Weight::Side,
                    form: Default::default(),
                    radius,
                };
                let found = Cells::new(pool(), &photons, estimate).irradiance(&samples, &pixels, ON).unwrap();
                let found: Vec<DVec3> = found.iter().map(|e| e.value).collect();
                let (error, of_means) = (error(&found, &reference), mean_sum(&found) / reference.mean.element_sum());
                println!("{paths} paths, radius {radius:.3}: error {error:.4}, mean {of_means:.4}");
                points.push((f64::from(paths).log10(), error.log10()));
                if points.len() == 3 && ratio == 0.0 {
                    ratio = of_means;
                }
            }
        }
        let slopes = points.each_ref().map(|points| slope(points));
        let last = points.each_ref().map(|points| slope(&points[1..]));
        println!("slopes {slopes:.3?}, of the last two {last:.3?}");
        Figures { ratio, slopes, last }
    })
}

/// What must hold of a scene.
fn problem(figures: &Figures) -> Option<&'static str> {
    let Figures { ratio, slopes: [small, _], last } = figures;
    if !((ratio - 1.0).abs() < 0.02) {
        return Some("the means differ");
    }
    if !((small + 0.5).abs() < 0.1) {
        return Some("at the small radius noise does not fall as the root of paths");
    }
    if !(last[1] > last[0] + 0.15 && last[1] > -0.25) {
        return Some("at the large radius the error does not level off");
    }
    None
}

#[test]
fn in_the_box_photons_converge_to_the_reference() {
    let scene = scene::load("box").unwrap();
    let path = CameraPath::for_scene(&scene, false);
    let camera = path.views(&scene, Some(1)).unwrap()[0].camera;
    let lit = LitScene::new(scene, None, &[]).unwrap();
    assert_eq!(problem(&figures(&lit, camera)), None);
}

#[test]
fn in_sponza_photons_converge_to_the_reference() {
    let Some(file) = file_below("RTBENCH_SCENES", "sponza/sponza.obj") else { return };
    let scene = scene::load(file.to_str().unwrap()).unwrap();
    let radiometry = catalogue::radiometry("sponza").unwrap();
    let path = CameraPath::load(radiometry.camera_path.as_deref().unwrap()).unwrap();
    let camera = path.views(&scene, Some(1)).unwrap()[0].camera;
    let lit = LitScene::new(scene, Some(radiometry), &[]).unwrap();
    assert_eq!(problem(&figures(&lit, camera)), None);
}

#[test]
fn what_does_not_converge_is_found() {
    let fine = Figures { ratio: 1.01, slopes: [-0.48, -0.4], last: [-0.47, -0.2] };
    assert_eq!(problem(&fine), None);
    for wrong in [
        Figures { ratio: 1.03, ..fine },
        Figures { ratio: f64::NAN, ..fine },
        Figures { slopes: [-0.35, -0.1], ..fine },
        Figures { last: [-0.47, -0.45], ..fine },
        Figures { last: [-0.47, -0.3], ..fine },
        Figures { last: [-0.3, -0.2], ..fine },
    ] {
        assert!(problem(&wrong).is_some());
    }
}
