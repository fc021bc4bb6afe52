//! Tables 5.9 to 5.11: counts per ray along BART's own cameras, against the published ones.

use rtbench::camera::{CameraPath, View};
use rtbench::scene::Scene;
use rtbench::sources::convention::Convention;
use rtbench::sources::thesis::data::Counts;
use rtbench::sources::thesis::published;
use rtbench::sources::thesis::scenes::{SceneKey, ThesisScene};
use rtbench::workloads::trace::CpuBackend;
use rtbench::workloads::trace::Selection;
use rtbench::workloads::trace::backend::{Backend, Config, Size};
use rtbench::workloads::trace::counting;
use rtbench::workloads::trace::record::{ByRayType, CounterSums};
use std::path::Path;

/// Frames of the path, evenly spread, and the side of the image. Counts of single rays hardly depend on either: with
/// all frames and a side of 256 the museum's steps are 0.4 % away.
const FRAMES: usize = 50;
const SIZE: Size = Size { width: 96, height: 96 };

/// Counters by ray type over the views that `choose` takes of the scene's own path, or `None` (said on stderr) where
/// there are no scenes.
fn counted(
    scene: &str,
    structure: &str,
    config: Config,
    choose: impl FnOnce(&CameraPath, &Scene) -> Vec<View>,
) -> Option<ByRayType<CounterSums>> {
    let Some(folder) = std::env::var_os("RTBENCH_SCENES").filter(|folder| !folder.is_empty()) else {
        eprintln!("NOT RUN: set RTBENCH_SCENES to the folder that holds {scene}");
        return None;
    };
    let scene = rtbench::scene::load_in(scene, Some(Path::new(&folder))).unwrap();
    let views = choose(&CameraPath::for_scene(&scene, config.shadows()), &scene);
    let selection = Selection::parse(structure).unwrap();
    let built = selection.build(&scene, 0).unwrap();
    let cpu = CpuBackend::new(0).unwrap();
    let mut prepared = cpu.prepare(&scene, &*built.structure, selection.method()).unwrap();
    let sums = counting::count(prepared.as_mut(), config, &views, (SIZE, 0.0), &mut || Ok(())).unwrap().sums;
    Some(sums)
}

/// What the thesis printed for a ray type: 0 primary, 1 shadow, 2 reflected.
fn printed(scene: &str, structure: &str, ray_type: usize) -> Counts {
    let key = SceneKey::Thesis(ThesisScene::named(scene).unwrap());
    published::data().thesis_counts(&key, structure, ray_type).unwrap().clone()
}

/// Steps and tests per primary ray of a grid over the path, by those that the thesis printed.
fn by_published(scene: &str, structure: &str, thesis_scene: &str) -> Option<(f64, f64)> {
    let views = |path: &CameraPath, scene: &Scene| path.views(scene, Some(FRAMES)).unwrap();
    let [sums, ..] = counted(scene, structure, Config::P, views)?;
    let rays = sums.rays as f64;
    let published = printed(thesis_scene, "grid", 0);
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

/// Not reproduced (docs/thesis-2009.md, "Counts per ray"): about 10 % of the steps and half of the tests are missing,
/// at this time as at any other. This holds what there is.
#[test]
fn robots_grid_counts_stay_where_they_are() {
    let Some((steps, tests)) = by_published("robots", "grid:x=128", "robots") else { return };
    assert!((0.88..0.92).contains(&steps), "steps {steps}");
    assert!((0.50..0.60).contains(&tests), "tests {tests}");
}

/// How far a frame of the museum is from all its published rows but the BVH's: the root mean square of the logarithms
/// of 14 ratios. The kd-tree's shadow rays are taken times the two lights (docs/thesis-2009.md, "Counts per ray").
fn deviation(choose: impl Fn(&CameraPath, &Scene) -> Vec<View>) -> Option<f64> {
    let rows = [
        ("grid", Config::PS, 0, 1.0),
        ("grid", Config::PS, 1, 1.0),
        ("grid", Config::PSR, 2, 1.0),
        ("kdtree", Config::PS, 0, 1.0),
        ("kdtree", Config::PS, 1, 2.0),
        ("kdtree", Config::PSR, 2, 1.0),
    ];
    let mut ratios = Vec::new();
    for (structure, config, ray_type, lights) in rows {
        let sums = counted("museum", structure, config, &choose)?[ray_type];
        let (rays, published) = (sums.rays as f64, printed("museum", structure, ray_type));
        ratios.push(sums.steps() as f64 / rays / (lights * published.steps.by(Convention::Nodes)));
        ratios.push(sums.tests as f64 / rays / (lights * published.tests));
        // Nothing says by what the shadow rays' restarts were divided
        ratios.extend(
            published.restarts.filter(|_| ray_type != 1).map(|restarts| sums.restarts as f64 / rays / restarts),
        );
    }
    assert_eq!(ratios.len(), 14);
    let square: f64 = ratios.iter().map(|ratio| ratio.ln().powi(2)).sum();
    Some((square / ratios.len() as f64).sqrt())
}

/// The published counts look like those of a single view.
#[test]
fn one_frame_of_the_museum_has_all_its_counts() {
    let frame =
        |number: usize| move |path: &CameraPath, scene: &Scene| vec![path.views(scene, None).unwrap()[number].clone()];
    let Some(best) = deviation(frame(22)) else { return };
    let path = deviation(|path, scene| path.views(scene, Some(FRAMES)).unwrap()).unwrap();
    println!("museum: frame 22 is {:.1} % from the published counts, the path {:.1} %", best * 100.0, path * 100.0);
    assert!(best < 0.08, "{best}");
    // The path's mean is not as near, nor is any frame: the comparison can tell
    assert!(path > 0.12, "{path}");
    assert!(deviation(frame(210)).unwrap() > 0.12);
}
