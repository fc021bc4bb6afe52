//! Rays traced by Embree 4, held against every structure on the CPU and on the GPU. Needs RTBENCH_SCENES (the scenes)
//! and RTBENCH_REFERENCE (the rays; by default `../reference` from the scenes); triangle indices are by fan
//! triangulation in file order.

use crate::support::{file_below, gpu};
use glam::Vec3;
use rtbench::math::{Hit, MISS};
use rtbench::scene::{self, Scene};
use rtbench::workloads::trace::CpuBackend;
use rtbench::workloads::trace::backend::{Backend, GivenRay};
use rtbench::workloads::trace::{Selection, algorithms};
use std::path::Path;

fn read_rays(path: &Path) -> (Vec<GivenRay>, Vec<Hit>) {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let rows = reader.records().map(|row| {
        let row = row.unwrap();
        let number = |column: usize| row[column].parse::<f32>().unwrap();
        let ray = GivenRay {
            origin: Vec3::new(number(0), number(1), number(2)),
            direction: Vec3::new(number(3), number(4), number(5)),
        };
        let hit = match row[6].is_empty() {
            true => Hit::NONE,
            false => Hit { t: number(6), triangle: row[7].parse().unwrap() },
        };
        (ray, hit)
    });
    rows.unzip()
}

/// Rays whose answer is another one: distances to 1e-4 of themselves or 1e-5 of the scene's size, the triangle unless
/// two lie at the same distance.
fn differing(scene: &Scene, expected: &[Hit], found: &[Hit]) -> Vec<usize> {
    assert_eq!(expected.len(), found.len());
    let slack = scene.bounds().diagonal() * 1.0e-5;
    (0..expected.len())
        .filter(|&index| {
            let (a, b) = (expected[index], found[index]);
            let missed = (a.triangle == MISS) != (b.triangle == MISS);
            // Another triangle at (nearly) the same distance is the same answer: the ray passes their common edge
            missed || (a.triangle != MISS && (a.t - b.t).abs() > slack.max(a.t * 1.0e-4))
        })
        .collect()
}

fn agree(scene_file: &str, rays_file: &str) {
    let Some(scene_file) = file_below("RTBENCH_SCENES", scene_file) else { return };
    let variable = if std::env::var_os("RTBENCH_REFERENCE").is_some() { "RTBENCH_REFERENCE" } else { "RTBENCH_SCENES" };
    let beside = if variable == "RTBENCH_SCENES" { "../reference/" } else { "" };
    let Some(rays_file) = file_below(variable, &format!("{beside}{rays_file}")) else { return };
    let scene = scene::load(scene_file.to_str().unwrap()).unwrap();
    let (rays, expected) = read_rays(&rays_file);
    assert_eq!(rays.len(), 6000);
    assert!(
        expected.iter().filter(|hit| hit.triangle != MISS).count() > rays.len() / 4,
        "too few hits to mean anything"
    );
    let cpu = CpuBackend::new(0).unwrap();
    let backends = [Some(&cpu as &dyn Backend), gpu().map(|gpu| gpu as &dyn Backend)];
    for variant in algorithms() {
        let selection = Selection::parse(variant.name).unwrap();
        let built = selection.build(&scene, 0).unwrap();
        let has_twin = selection.method().traversal.twin.is_some();
        for backend in backends.into_iter().flatten().filter(|backend| has_twin || backend.info().backend != "cpu") {
            let place = format!("{} on {}", variant.name, backend.info().name);
            // Brute force over all rays is minutes of work: a sixteenth of them, of every kind
            let step = if variant.name == "brute" { 16 } else { 1 };
            let rays: Vec<_> = rays.iter().copied().step_by(step).collect();
            let expected: Vec<_> = expected.iter().copied().step_by(step).collect();
            let mut prepared = backend.prepare(&scene, &*built.structure, selection.method()).unwrap();
            let found = prepared.trace(&rays, false).unwrap();
            let off = differing(&scene, &expected, &found);
            assert!(
                off.len() * 1000 <= rays.len(),
                "{place}: {} of {} rays are off, the first: {:?} {:?} {:?}",
                off.len(),
                rays.len(),
                rays[off[0]],
                expected[off[0]],
                found[off[0]]
            );
            let same = expected.iter().zip(&found).filter(|(a, b)| a.triangle == b.triangle).count();
            assert!((rays.len() - same) * 100 <= rays.len(), "{place}: only {same} of {} triangles agree", rays.len());
            let blocked = prepared.trace(&rays, true).unwrap();
            let other =
                blocked.iter().zip(&found).filter(|(a, b)| (a.triangle == MISS) != (b.triangle == MISS)).count();
            assert_eq!(other, 0, "{place}: any hit and nearest hit disagree");
            eprintln!("{place}: {} of {} off, {same} triangles the same", off.len(), rays.len());
        }
    }
}

#[test]
fn bunny_rays_hit_what_embree_hits() {
    agree("bunny/bun_zipper.ply", "bunny_rays.csv");
}

#[test]
fn sponza_rays_hit_what_embree_hits() {
    agree("sponza/sponza.obj", "sponza_rays.csv");
}

#[test]
fn the_comparison_notices_a_wrong_answer() {
    let scene = crate::support::soup(10, 1, false);
    let expected = [Hit { t: 1.0, triangle: 3 }, Hit::NONE, Hit { t: 2.0, triangle: 4 }];
    assert!(differing(&scene, &expected, &expected).is_empty());
    let wrong = [Hit { t: 1.001, triangle: 3 }, Hit { t: 1.0, triangle: 1 }, Hit::NONE];
    assert_eq!(differing(&scene, &expected, &wrong), [0, 1, 2]);
}
