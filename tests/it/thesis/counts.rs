//! Tables 5.9 to 5.11: counts per ray along BART's own cameras, against the published ones.

use rtbench::accel::Selection;
use rtbench::backend::{Backend, Config, Size};
use rtbench::bench::measure;
use rtbench::camera::CameraPath;
use rtbench::cpu::CpuBackend;
use rtbench::results::record::CounterSums;
use rtbench::thesis::convention::Convention;
use rtbench::thesis::published;
use rtbench::thesis::scenes::{SceneKey, ThesisScene};
use std::path::Path;

/// Frames of the path, evenly spread, and the side of the image. Counts of single rays hardly depend on either: with all
/// frames and a side of 256 the museum's steps are 0.4 % away.
const FRAMES: usize = 50;
const SIZE: Size = Size { width: 96, height: 96 };

/// Primary rays' counters, or `None` (said on stderr) where there are no scenes.
fn primary(scene: &str, structure: &str) -> Option<CounterSums> {
    let Some(folder) = std::env::var_os("RTBENCH_SCENES") else {
        eprintln!("NOT RUN: set RTBENCH_SCENES to the folder that holds {scene}");
        return None;
    };
    let scene = rtbench::scene::load_in(scene, Some(Path::new(&folder))).unwrap();
    let views = CameraPath::for_scene(&scene, Config::P).views(&scene, Some(FRAMES)).unwrap();
    let selection = Selection::parse(structure).unwrap();
    let built = selection.build(&scene, 0).unwrap();
    let cpu = CpuBackend::new(0).unwrap();
    let mut prepared = cpu.prepare(&scene, &built.structure, selection.method()).unwrap();
    let counted = measure::count(prepared.as_mut(), Config::P, &views, SIZE, &|| false, &mut || ()).unwrap();
    Some(counted.sums[0])
}

/// Steps and tests per primary ray of a grid, by those that the thesis printed.
fn by_published(scene: &str, structure: &str, thesis_scene: &str) -> Option<(f64, f64)> {
    let sums = primary(scene, structure)?;
    let rays = sums.rays as f64;
    let key = SceneKey::Thesis(ThesisScene::named(thesis_scene).unwrap());
    let published = published::data().thesis_counts(&key, "grid", 0).unwrap().clone();
    let steps = sums.steps() as f64 / rays / published.steps.by(Convention::Nodes);
    let tests = sums.tests as f64 / rays / published.tests;
    println!("{scene} {structure}: {:.1} % of the published steps, {:.1} % of the tests", steps * 100.0, tests * 100.0);
    Some((steps, tests))
}

#[test]
fn museum_s_grid_counts_are_the_published_ones() {
    let Some((steps, tests)) = by_published("museum", "grid", "museum") else { return };
    assert!((steps - 1.0).abs() <= 0.08, "steps {steps}");
    assert!((tests - 1.0).abs() <= 0.10, "tests {tests}");
    // Another lens gives other counts: the comparison can tell
    let (steps, tests) = by_published("museum:fov=90", "grid", "museum").unwrap();
    assert!((steps - 1.0).abs() > 0.08 && (tests - 1.0).abs() > 0.10, "steps {steps}, tests {tests}");
}

/// Not reproduced (METHODOLOGY.md, "Counts per ray"): about 10 % of the steps and half of the tests are missing, at this time
/// as at any other. This holds what there is.
#[test]
fn robots_grid_counts_stay_where_they_are() {
    let Some((steps, tests)) = by_published("robots", "grid:x=128", "robots") else { return };
    assert!((0.88..0.92).contains(&steps), "steps {steps}");
    assert!((0.50..0.60).contains(&tests), "tests {tests}");
}
