//! The driver's own structure: its hits against those of a twin, on meshes and at their edges; what rows say of it.

use crate::meshes::{Aim, aimed, icosphere};
use crate::support::{gpu, soup};
use crate::traversal::{SIZE, counted, shiny, trace};
use glam::Vec3;
use rtbench::device::{Feature, VulkanDevice};
use rtbench::math::{Hit, MISS};
use rtbench::scene::Scene;
use rtbench::workloads::trace::CpuBackend;
use rtbench::workloads::trace::backend::{Config, CountedPixel, GivenRay};
use std::process::Command;

/// The device, if its driver has ray queries.
fn device() -> Option<&'static VulkanDevice> {
    let device = gpu()?;
    if !device.features().has(Feature::RayQuery) {
        eprintln!("not run: {} has no ray queries", device.info().name);
        return None;
    }
    Some(device)
}

/// Rays of which only one side hits, and rays whose distances differ by more than 1e-4 of them.
fn differing(expected: &[Hit], found: &[Hit]) -> (usize, usize) {
    let is_hit = |hit: &Hit| hit.triangle != MISS;
    let pairs = || expected.iter().zip(found);
    let far = |(a, b): &(&Hit, &Hit)| is_hit(a) && is_hit(b) && (a.t - b.t).abs() > 1e-4 * a.t;
    (pairs().filter(|(a, b)| is_hit(a) != is_hit(b)).count(), pairs().filter(far).count())
}

fn compare(device: &VulkanDevice, scene: &Scene, rays: &[GivenRay]) -> (usize, usize) {
    let cpu = CpuBackend::new(2).unwrap();
    let expected = trace(&cpu, scene, "bvh-stack", rays, false);
    let found = trace(device, scene, "query", rays, false);
    let any = trace(device, scene, "query", rays, true);
    let other = found.iter().zip(&any).filter(|(a, b)| (a.triangle == MISS) != (b.triangle == MISS)).count();
    assert_eq!(other, 0, "{}: any hit and nearest hit disagree", scene.name);
    differing(&expected, &found)
}

#[test]
fn hits_are_those_of_a_twin() {
    let Some(device) = device() else { return };
    let mesh = icosphere(4, Vec3::ZERO, 1.0);
    let rays = aimed(&mesh, Aim::Face, (Vec3::ZERO, 0.4), 4000, 3);
    assert_eq!(compare(device, &mesh, &rays), (0, 0));
    let scene = shiny(soup(700, 41, false));
    for config in Config::ALL {
        let (expected, _) = counted(&CpuBackend::new(2).unwrap(), &scene, "bvh-stack", config, SIZE);
        let (found, timed) = counted(device, &scene, "query", config, SIZE);
        let hit = |pixel: &CountedPixel| Hit { t: f32::from_bits(pixel.t), triangle: pixel.pixel.triangle };
        let hits = |pixels: &[CountedPixel]| pixels.iter().map(hit).collect::<Vec<_>>();
        let (lost, far) = differing(&hits(&expected), &hits(&found));
        let other = lost + far;
        assert!(other * 1000 <= expected.len(), "{config:?}: {other} of {} primary rays", expected.len());
        assert!(found.iter().zip(&timed).all(|(a, b)| a.pixel == *b), "{config:?}: timed and counting kernels differ");
        let rays = |pixels: &[CountedPixel], kind: usize| -> u32 { pixels.iter().map(|p| p.counters[kind].rays).sum() };
        for kind in 0..5 {
            let (a, b) = (rays(&expected, kind), rays(&found, kind));
            // Of triangles at one distance the driver may take another one, which may not reflect
            assert!(a.abs_diff(b) * 20 <= a, "{config:?}: {b} rays of type {kind} instead of {a}");
        }
    }
}

/// Rays at vertices and edges: the driver's test may lose some.
#[test]
fn few_rays_are_lost_at_edges() {
    let Some(device) = device() else { return };
    let mesh = icosphere(3, Vec3::ZERO, 1.0);
    for aim in [Aim::Vertex, Aim::Edge] {
        let rays = aimed(&mesh, aim, (Vec3::ZERO, 0.4), 1500, 11);
        let (lost, far) = compare(device, &mesh, &rays);
        eprintln!("{aim:?}: {lost} of {} lost", rays.len());
        assert_eq!(far, 0, "{aim:?}");
    }
}

#[test]
fn scenes_of_no_and_of_one_triangle() {
    let Some(device) = device() else { return };
    let ray = GivenRay { origin: Vec3::new(0.2, 0.2, 5.0), direction: -Vec3::Z };
    for count in [0, 1] {
        let scene = soup(count, 3, false);
        let (lost, far) = compare(device, &scene, &[ray]);
        assert_eq!((lost, far), (0, 0), "{count} triangles");
    }
}

/// Rows tell rays and times, and no counters; without ray queries they are skipped.
#[test]
fn rows_have_no_counters() {
    let run = |backend: &str| {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("run");
        let arguments = format!(
            "sweep --backend {backend} --scene box:triangles=500 --structure bvh-stack,query --config PS --resolution 64 \
             --frames 1 --passes 1 --quiet --out"
        );
        let output = Command::new(env!("CARGO_BIN_EXE_rtbench"))
            .args(arguments.split_whitespace())
            .arg(&out)
            .env_remove("RTBENCH_SCENES")
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let rows = crate::support::csv_rows(&out.join("summary.csv"));
        let structures = crate::support::csv_rows(&out.join("structures.csv"));
        let of = |rows: Vec<std::collections::BTreeMap<String, String>>| {
            rows.into_iter().find(|row| row["structure"] == "query")
        };
        (of(rows).unwrap(), of(structures))
    };
    let (row, _) = run("cpu");
    assert_eq!(row["status"], "skipped");
    assert!(row["message"].contains("has no CPU twin"), "{}", row["message"]);
    if device().is_none() {
        return;
    }
    let (row, structure) = run("vulkan");
    assert_eq!(row["status"], "ok", "{}", row["message"]);
    assert_eq!(row["primary_rays"], (64 * 64).to_string());
    assert!(!row["shadow_rays"].is_empty() && !row["mrays_per_s"].is_empty());
    for counter in ["steps", "tests", "restarts", "inner", "leaves", "pops", "ropes", "fallbacks", "skips", "boxes"] {
        for kind in ["primary", "shadow"] {
            assert_eq!(row[&format!("{kind}_{counter}_per_ray")], "", "{kind} {counter}");
        }
    }
    let structure = structure.unwrap();
    assert!(structure["driver_build_ms"].parse::<f64>().unwrap() > 0.0);
    assert_eq!(structure["nodes"], "");
}
