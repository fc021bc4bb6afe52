//! Ambient and diffuse rays: directions against their distribution, frames in a sphere against formulas, rows.

use crate::support::{gpu, soup};
use crate::traversal::{SIZE, counted, shiny};
use glam::{Vec3, Vec3A};
use rtbench::camera::{Camera, View};
use rtbench::scene::{self, Scene};
use rtbench::workloads::trace::backend::{AMBIENT_RAYS, Backend, Config, CountedPixel, Pixel, RAY_TYPES, Size};
use rtbench::workloads::trace::secondary::direction_above;
use rtbench::workloads::trace::{CpuBackend, Selection};
use std::collections::HashSet;
use std::f64::consts::TAU;
use std::process::Command;

const IMAGE: Size = Size { width: 128, height: 128 };

/// The 99.9 % quantile of chi-square for 64 cells.
const LIMIT: f64 = 103.4;

/// Under the cosine, the squared cosine and the angle around the normal are uniform: cells of both are equally full.
#[test]
fn directions_of_pixels_are_distributed_as_the_cosine() {
    let normal = Vec3A::new(0.3, -0.5, 0.8).normalize();
    let (x, y) = normal.any_orthonormal_pair();
    for number in 0..AMBIENT_RAYS {
        let mut cells = [0u32; 64];
        let mut seen = HashSet::new();
        let mut mean = Vec3A::ZERO;
        for (column, row) in (0..IMAGE.height).flat_map(|row| (0..IMAGE.width).map(move |column| (column, row))) {
            let direction = direction_above(normal, IMAGE, (column, row), number);
            assert!((direction.length() - 1.0).abs() < 1e-6);
            seen.insert(direction.to_array().map(f32::to_bits));
            mean += direction / IMAGE.pixels() as f32;
            let cosine = f64::from(direction.dot(normal));
            let turn = f64::from(direction.dot(y)).atan2(f64::from(direction.dot(x))).rem_euclid(TAU) / TAU;
            cells[((cosine * cosine * 8.0) as usize).min(7) * 8 + ((turn * 8.0) as usize).min(7)] += 1;
        }
        assert!(seen.len() * 1000 > IMAGE.pixels() * 999, "ray {number}: {} different directions", seen.len());
        let expected = IMAGE.pixels() as f64 / 64.0;
        let chi_square: f64 = cells.iter().map(|&n| (f64::from(n) - expected).powi(2) / expected).sum();
        assert!(chi_square < LIMIT, "ray {number}: {chi_square}");
        assert!((mean - normal * (2.0 / 3.0)).length() < 0.01, "ray {number}: {mean}");
    }
    // Rays and pixels have their own
    let at = |pixel, number| direction_above(normal, IMAGE, pixel, number);
    assert!(at((5, 7), 0) != at((5, 7), 1) && at((5, 7), 0) != at((6, 7), 0) && at((5, 7), 0) != at((5, 8), 0));
}

/// From its centre.
fn sphere() -> (Scene, View) {
    let scene = scene::load("sphere:triangles=30000").unwrap();
    let camera = Camera { position: scene.bounds().center(), direction: Vec3::Z, up: Vec3::Y, field_of_view: 90.0 };
    (scene, View { camera, lights: Vec::new() })
}

fn frame(scene: &Scene, view: &View, config: Config) -> Vec<CountedPixel> {
    let selection = Selection::parse("bvh-stack").unwrap();
    let built = selection.build(scene, 2).unwrap();
    let cpu = CpuBackend::new(2).unwrap();
    let mut prepared = cpu.prepare(scene, &*built.structure, selection.method()).unwrap();
    let mut pixels = Vec::new();
    prepared.counted(config, view, IMAGE, &mut |_, band| pixels.extend_from_slice(band)).unwrap();
    pixels
}

/// The mean of the red channel, 0 to 1.
fn mean(pixels: &[CountedPixel]) -> f64 {
    pixels.iter().map(|p| f64::from(p.pixel.rgba & 255) / 255.0).sum::<f64>() / pixels.len() as f64
}

/// A chord of a sphere of radius 1 at the angle a to the normal has the length 2 cos a, and a tenth of the diagonal is
/// 0.2 sqrt(3): rays with a squared cosine below 0.03 are occluded, which are 3 % of them.
#[test]
fn a_sphere_occludes_three_percent() {
    let (scene, view) = sphere();
    let pixels = frame(&scene, &view, Config::AO);
    let rays: u32 = pixels.iter().map(|p| p.counters[3].rays).sum();
    assert_eq!(rays as usize, IMAGE.pixels() * AMBIENT_RAYS as usize);
    assert!(pixels.iter().all(|p| [0, 64, 128, 191, 255].contains(&(p.pixel.rgba & 255))));
    let deviation = (0.03 * 0.97 / f64::from(rays)).sqrt();
    // Colours are rounded to levels of 255
    let open = mean(&pixels);
    assert!((open - 0.97).abs() < 5.0 * deviation + 5e-4, "{open}");
}

/// The cosine at the other end of a chord is the same, and its mean is 2/3.
#[test]
fn a_diffuse_ray_in_a_sphere_sees_two_thirds_of_the_colour() {
    let (scene, view) = sphere();
    let pixels = frame(&scene, &view, Config::DIFFUSE);
    let rays: u32 = pixels.iter().map(|p| p.counters[4].rays).sum();
    assert_eq!(rays as usize, IMAGE.pixels());
    let material = &scene.materials[0];
    let expected = f64::from(material.ambient[0]) + f64::from(material.diffuse[0]) * 2.0 / 3.0;
    let deviation = f64::from(material.diffuse[0]) * (1.0 / 18.0 / f64::from(rays)).sqrt();
    let found = mean(&pixels);
    assert!((found - expected).abs() < 5.0 * deviation + 1e-3, "{found}, not {expected}");
    // A ray that leaves the scene sees its background
    let mut open = soup(1, 3, false);
    open.background = Vec3::new(0.0, 1.0, 0.0);
    let corner = open.corners(0)[0];
    let middle = open.corners(0).into_iter().sum::<Vec3A>() / 3.0;
    let away = (open.corners(0)[1] - corner).cross(open.corners(0)[2] - corner).normalize();
    let camera = Camera {
        position: (middle + away).into(),
        direction: (-away).into(),
        up: away.any_orthonormal_vector().into(),
        field_of_view: 1.0,
    };
    let view = View { camera, lights: Vec::new() };
    let pixels = frame(&open, &view, Config::DIFFUSE);
    assert!(pixels.iter().all(|p| p.pixel == Pixel { triangle: 0, rgba: 0xff00_ff00 }));
    let pixels = frame(&open, &view, Config::AO);
    assert!(pixels.iter().all(|p| p.pixel == Pixel { triangle: 0, rgba: 0xffff_ffff }));
}

/// A pixel's directions depend on its place in the image alone.
#[test]
fn tiles_and_groups_change_no_bit() {
    let scene = shiny(soup(400, 21, false));
    let cpu = CpuBackend::new(2).unwrap();
    let backends = [Some(&cpu as &dyn Backend), gpu().map(|gpu| gpu as &dyn Backend)];
    for backend in backends.into_iter().flatten() {
        for config in [Config::AO, Config::DIFFUSE] {
            let reference = counted(backend, &scene, "bvh-stack", config, SIZE);
            for option in ["tiles=3", "group=32x1", "reflections=staged"] {
                let other = counted(backend, &scene, &format!("bvh-stack:{option}"), config, SIZE);
                assert_eq!(other, reference, "{config:?} {option} on {}", backend.info().backend);
            }
        }
    }
}

#[test]
fn rows_count_each_type_of_rays() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let arguments = "sweep --backend cpu --scene box:triangles=500 --structure bvh-stack,bvh --config P,ao,diffuse \
                     --resolution 64 --frames 1 --passes 1 --quiet --out";
    let output = Command::new(env!("CARGO_BIN_EXE_rtbench"))
        .args(arguments.split_whitespace())
        .arg(&out)
        .env_remove("RTBENCH_SCENES")
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let rows = crate::support::csv_rows(&out.join("summary.csv"));
    assert_eq!(rows.len(), 6);
    for row in rows {
        assert_eq!(row["status"], "ok", "{}", row["message"]);
        let rays = |kind: &str| row[&format!("{kind}_rays")].parse::<u64>().unwrap_or_default();
        let pixels = 64 * 64;
        let expected = match row["config"].as_str() {
            "AO" => [pixels, 0, 0, 4 * pixels, 0],
            "DIFFUSE" => [pixels, 0, 0, 0, pixels],
            _ => [pixels, 0, 0, 0, 0],
        };
        assert_eq!(RAY_TYPES.map(rays), expected, "{row:?}");
        for (kind, expected) in RAY_TYPES.iter().zip(expected) {
            assert_eq!(row[&format!("{kind}_tests_per_ray")].is_empty(), expected == 0, "{kind} {}", row["config"]);
        }
    }
}
