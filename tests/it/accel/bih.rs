//! The bounding interval hierarchy: its size, and the rays that enter neither child. Its hits are held against brute
//! force with those of all others (`traversal.rs`, `watertight.rs`).

use super::scenes::{powers_of_ten, soup};
use super::thesis::model;
use super::{build, build_as};
use crate::support::view_along;
use glam::Vec3;
use rtbench::scene;
use rtbench::workloads::trace::backend::{Backend, Config, Counters, GivenRay, Size};
use rtbench::workloads::trace::bih::Bih;
use rtbench::workloads::trace::{CpuBackend, Selection, Structure};

/// 0.94 to 1.0 nodes a triangle with leaves of at most three, 15 to 16 bytes in the model.
#[test]
fn nodes_are_twelve_bytes_and_nearly_one_a_triangle() {
    let built_in = ["scan:triangles=32000", "room:triangles=80000", "sphereflake:triangles=107000"];
    let scenes = built_in.map(|name| scene::load(name).ok()).into_iter().chain(["bunny", "sponza"].map(model));
    for scene in scenes.flatten() {
        let tree: Bih = build_as("bih", &scene);
        let triangles = scene.triangles.len() as f64;
        let nodes = tree.nodes.len() - 1;
        assert!((0.94..=1.0).contains(&(nodes as f64 / triangles)), "{}: {}", scene.name, nodes as f64 / triangles);
        assert_eq!(tree.node_bytes(), 12 * (nodes + 1));
        assert_eq!(tree.rt2_bytes(), 12 * nodes as u64 + 4 * scene.triangles.len() as u64);
        assert!((15.0..=16.1).contains(&(tree.rt2_bytes() as f64 / triangles)));
        let p = tree.properties(&scene);
        assert_eq!((p.max_leaf_triangles, p.empty_leaves, p.leaves), (Some(3), Some(0), Some(nodes as u32 / 2 + 1)));
        assert_eq!(p.references_per_triangle, Some(1.0));
    }
}

fn counters(structure: &str, scene: &scene::Scene, ray: &GivenRay) -> Counters {
    let selection = Selection::parse(structure).unwrap();
    let built = selection.build(scene, 1).unwrap();
    let cpu = CpuBackend::new(1).unwrap();
    let mut prepared = cpu.prepare(scene, &*built.structure, selection.method()).unwrap();
    let mut counters = Counters::default();
    let mut keep = |_, band: &[rtbench::workloads::trace::backend::CountedPixel]| counters = band[0].counters[0];
    prepared.counted(Config::P, &view_along(ray), Size { width: 1, height: 1 }, &mut keep).unwrap();
    counters
}

/// Two heaps of triangles with a gap between them.
#[test]
fn a_ray_through_a_gap_enters_neither_child() {
    let corner = |x: f32, i: i32| Vec3::new(x, i as f32 * 0.1, 0.0);
    let triangle = |x: f32, i: i32| [corner(x, i), corner(x, i) + Vec3::X, corner(x, i) + Vec3::Y];
    let scene = soup("two heaps", (0..8).map(|i| triangle(if i < 4 { -5.0 } else { 4.0 }, i % 4)));
    let ray = |x: f32| GivenRay { origin: Vec3::new(x, 0.2, 3.0), direction: Vec3::NEG_Z };
    let through = counters("bih:max_leaf=4", &scene, &ray(0.3));
    assert_eq!((through.inner, through.skips, through.leaves, through.tests), (1, 1, 0, 0));
    for x in [-4.8, 4.2] {
        let hit = counters("bih:max_leaf=4", &scene, &ray(x));
        assert_eq!((hit.inner, hit.skips, hit.leaves, hit.tests, hit.pops), (1, 0, 1, 4, 0));
    }
    // Other trees have no such visits
    assert_eq!(counters("bvh-stack", &scene, &ray(0.3)).skips, 0);
}

#[test]
fn it_is_no_deeper_than_its_bound() {
    let scene = powers_of_ten();
    let tree = build("bih:max_leaf=1", &scene, 1);
    tree.validate(&scene).unwrap();
    let depth = tree.properties(&scene).depth.unwrap();
    assert!(depth > 20 && depth <= rtbench::workloads::trace::bih::MAX_DEPTH, "{depth}");
    assert_eq!(tree.stack_depth(), depth);
}
