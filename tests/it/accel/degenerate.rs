//! Inputs that make a builder's work grow faster than its triangles. Nothing here looks at a clock: what bounds the
//! work is counted, or said in the note.

use super::scenes::{numbers, soup};
use super::{assert_valid, build, bytes};
use glam::Vec3;
use rtbench::scene::Scene;
use rtbench::workloads::trace::{Built, Selection};

/// Enough for all bounds to have an effect.
const COUNT: usize = 20_000;

fn many(name: &str, triangle: impl FnMut(usize) -> [Vec3; 3]) -> Scene {
    soup(name, (0..COUNT).map(triangle))
}

fn made(selection: &str, scene: &Scene) -> Built {
    Selection::parse(selection).unwrap().build(scene, 2).unwrap()
}

const TRIANGLE: [Vec3; 3] = [Vec3::ZERO, Vec3::new(1.0, 0.0, 0.1), Vec3::Y];

fn scaled(by: f32) -> [Vec3; 3] {
    [Vec3::new(-1.0, -1.0, -1.0), Vec3::new(1.0, 1.0, -1.0), Vec3::new(0.0, 1.0, 1.0)].map(|corner| corner * by)
}

/// Neighbours on the Morton curve cost the same, or ever more, all along it.
fn chains() -> Vec<Scene> {
    let mut next = numbers(3);
    let mut x = 0.0;
    vec![
        many("one place", |_| TRIANGLE),
        many("one point", |_| [Vec3::ONE; 3]),
        many("two places", |i| TRIANGLE.map(|corner| corner + Vec3::X * 5.0 * (i % 2) as f32)),
        many("half of them in one place", |i| {
            if i % 2 == 0 { TRIANGLE } else { TRIANGLE.map(|c| c * 0.01 + Vec3::new(next(), next(), next())) }
        }),
        many("cards", |i| [Vec3::ZERO, Vec3::X, Vec3::Y].map(|corner| corner + Vec3::Z * i as f32)),
        many("row", |i| [Vec3::ZERO, Vec3::X, Vec3::new(0.0, 1.0, 1.0)].map(|corner| corner + Vec3::X * i as f32)),
        many("growing row", |i| {
            let edge = 1.0005_f32.powi(i as i32);
            x += edge;
            [Vec3::ZERO, Vec3::X, Vec3::new(0.0, 1.0, 1.0)].map(|corner| corner * edge + Vec3::X * (x - edge))
        }),
        many("inside each other", |i| scaled(1.0 + i as f32)),
        many("inside each other, each larger by a factor", |i| scaled(1.001_f32.powi(i as i32))),
        many("telescope", |i| [Vec3::ZERO, Vec3::X * 1.0005_f32.powi(i as i32), Vec3::new(0.0, 1.0, 1.0)]),
    ]
}

/// No less overlap, but costs that differ.
fn overlapping() -> Vec<Scene> {
    let mut next = numbers(4);
    let mut point = || Vec3::new(next(), next(), next());
    let spoke = |i: f32| Vec3::new((i * 3.1e-4).cos(), (i * 3.1e-4).sin(), 0.0) * 100.0;
    vec![
        many("large triangles", |_| [point(), point(), point()]),
        many("large triangles in a plane", |_| [point(), point(), point()].map(|p| p * Vec3::new(1.0, 1.0, 0.0))),
        many("long ones side by side", |_| {
            let at = point() * Vec3::new(0.0, 1.0, 1.0);
            [at, at + Vec3::new(100.0, 0.01, 0.0), at + Vec3::new(50.0, 0.0, 0.01)]
        }),
        many("fan", |i| [Vec3::ZERO, spoke(i as f32) + point(), spoke(i as f32 + 3.0) + point()]),
        many("star", |_| {
            let tip = (point() - 0.5).normalize_or_zero();
            [Vec3::ZERO, tip, tip + 1.0e-3]
        }),
        many("small ones", |_| {
            let at = point();
            [at, at + point() * 0.01, at + point() * 0.01]
        }),
    ]
}

#[test]
fn ploc_is_not_asked_where_its_passes_merge_hardly_anything() {
    for scene in chains() {
        let ploc = made("ploc-stack", &scene);
        assert!(ploc.note.starts_with("built as bvh"), "{}: '{}'", scene.name, ploc.note);
        assert!(bytes(&ploc.structure) == bytes(&build("bvh", &scene, 1)), "{}", scene.name);
        for preset in ["fastest", "very-slow"] {
            assert_eq!(made(&format!("ploc-stack:preset={preset}"), &scene).note, ploc.note, "{}", scene.name);
        }
    }
}

#[test]
fn ploc_builds_everything_else() {
    let built_in = ["scan", "terrain", "sphereflake", "stadium", "hall", "room"]
        .map(|name| rtbench::scene::load(&format!("{name}:triangles=20000")).unwrap());
    for scene in overlapping().iter().chain(&built_in) {
        let ploc = made("ploc-stack", scene);
        assert_eq!(ploc.note, "", "{}", scene.name);
        assert!(bytes(&ploc.structure) != bytes(&build("bvh", scene, 1)), "{}", scene.name);
    }
}

#[test]
fn no_structure_multiplies_its_records_without_bound() {
    for scene in chains().into_iter().chain(overlapping()) {
        for selection in [
            "grid",
            "kdtree",
            "kdtree:thin=0,small_leaf=0",
            "kdtree:build=sort",
            "kdtree:build=min-max",
            "bvh",
            "bih",
            "bvh-quantised",
            "bvh8",
            "cwbvh",
        ] {
            let built = made(selection, &scene);
            let triangle_refs = built.structure.triangle_refs().len();
            assert!(
                triangle_refs <= 256 * COUNT,
                "{selection} over {}: {triangle_refs} triangle references",
                scene.name
            );
        }
    }
}

/// Spatial splits everywhere: at most four references a triangle, and the same tree for any number of threads where
/// that bound has an effect.
#[test]
fn spatial_splits_end_at_four_references_a_triangle() {
    let mut bounded = 0;
    for scene in chains().into_iter().chain(overlapping()) {
        let selection = "bvh:build=spatial,max_leaf=1,alpha=0,spatial_depth=440,max_depth=440";
        let built = made(selection, &scene);
        let triangle_refs = built.structure.triangle_refs().len();
        assert!(triangle_refs <= 4 * COUNT, "{}: {triangle_refs} triangle references", scene.name);
        if triangle_refs > 3 * COUNT {
            bounded += 1;
            assert!(bytes(&build(selection, &scene, 1)) == bytes(&built.structure), "{}", scene.name);
            assert_valid(selection, &scene);
        }
    }
    assert!(bounded > 0, "the bound has no effect in any scene");
}

#[test]
fn a_kd_tree_that_would_be_too_large_is_less_deep_and_says_so() {
    for scene in overlapping() {
        let cut = ["large triangles in a plane", "star"].contains(&scene.name.as_str());
        let built = made("kdtree", &scene);
        assert_eq!(built.note.starts_with("max_depth="), cut, "{}: '{}'", scene.name, built.note);
        if !cut {
            continue;
        }
        let depth = built.note.trim_start_matches("max_depth=").split(':').next().unwrap();
        assert!(built.structure.properties(&scene).depth.unwrap() <= depth.parse().unwrap());
        // It is the tree that this depth gives, for any number of threads
        let asked = made(&format!("kdtree:max_depth={depth}"), &scene);
        assert_eq!(asked.note, "");
        assert!(bytes(&asked.structure) == bytes(&built.structure), "{}", scene.name);
        assert!(bytes(&build("kdtree", &scene, 1)) == bytes(&built.structure), "{}", scene.name);
        assert_valid("kdtree", &scene);
    }
}
