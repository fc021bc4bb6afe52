//! What wide trees cost rays, counted over frames of the built-in scenes.

use rtbench::camera::CameraPath;
use rtbench::scene::{Scene, load};
use rtbench::workloads::trace::backend::{Backend, Config, Size};
use rtbench::workloads::trace::count::CounterSums;
use rtbench::workloads::trace::{CpuBackend, Selection};

const SIZE: Size = Size { width: 64, height: 64 };
const FRAMES: usize = 3;

/// Everything that is counted over some frames, rays of all types together.
fn counted(backend: &CpuBackend, scene: &Scene, selection: &str) -> CounterSums {
    let selection = Selection::parse(selection).unwrap();
    let built = selection.build(scene, 0).unwrap();
    let mut prepared = backend.prepare(scene, &*built.structure, selection.method()).unwrap();
    let path = CameraPath::for_scene(scene, true);
    let mut sums = CounterSums::default();
    for view in &path.views(scene, Some(FRAMES)).unwrap() {
        prepared
            .counted(Config::PSR, view, SIZE, &mut |_, pixels| {
                pixels.iter().flat_map(|pixel| &pixel.counters).for_each(|counters| sums.add(counters));
            })
            .unwrap();
    }
    sums
}

/// A wide tree visits fewer nodes than the BVH that it was collapsed from, and one of eight children a node tests at
/// least as many boxes.
#[test]
fn wide_trees_visit_fewer_nodes_and_test_more_boxes() {
    let cpu = CpuBackend::new(2).unwrap();
    for name in ["scan", "terrain", "sphereflake", "stadium", "hall", "room"] {
        let scene = load(&format!("{name}:triangles=20000")).unwrap();
        let trees = ["bvh-stack", "bvh-quantised", "bvh4", "bvh8"];
        let counts = trees.map(|selection| counted(&cpu, &scene, selection));
        for (selection, sums) in trees.iter().zip(&counts) {
            println!(
                "{name} {selection}: {:.2} nodes, {:.2} boxes, {:.2} tests, {:.2} pops a ray",
                sums.steps() as f64 / sums.rays as f64,
                sums.boxes as f64 / sums.rays as f64,
                sums.tests as f64 / sums.rays as f64,
                sums.pops as f64 / sums.rays as f64
            );
        }
        let [stack, quantised, four, eight] = &counts;
        assert!(counts.iter().all(|sums| sums.rays == stack.rays), "{name}");
        for two in [stack, quantised] {
            assert!(four.inner < two.inner && four.steps() < two.steps(), "{name}: {two:?} {four:?}");
            // One node of four boxes replaces up to three of two, so that here boxes may be fewer (hall: 10 %)
            assert!(four.boxes * 100 >= two.boxes * 80, "{name}: {two:?} {four:?}");
            assert!(eight.boxes >= two.boxes, "{name}: {two:?} {eight:?}");
        }
        assert!(eight.inner < four.inner && eight.steps() < four.steps(), "{name}: {four:?} {eight:?}");
        // Boxes of 16 bits a plane cost few visits (stadium: 2.4 %)
        assert!(quantised.steps() >= stack.steps() / 1000 * 999, "{name}: {stack:?} {quantised:?}");
        assert!(quantised.steps() * 100 <= stack.steps() * 105, "{name}: {stack:?} {quantised:?}");
    }
}

/// With few entries a ray comes back to nodes, but visits the same leaves in the same order.
#[test]
fn a_short_stack_costs_visits_of_inner_nodes_only() {
    let cpu = CpuBackend::new(2).unwrap();
    let scene = load("hall:triangles=20000").unwrap();
    for tree in ["bvh4", "bvh8"] {
        let full = counted(&cpu, &scene, tree);
        let short =
            ["1", "4", "16"].map(|entries| counted(&cpu, &scene, &format!("{tree}:stack=short,entries={entries}")));
        assert_eq!(full.restarts, 0);
        assert!(short[0].restarts > short[1].restarts && short[1].restarts >= short[2].restarts, "{tree}: {short:?}");
        for sums in &short {
            assert_eq!((sums.leaves, sums.tests), (full.leaves, full.tests), "{tree}");
        }
        assert!(short[0].inner > full.inner && short[0].inner > short[1].inner, "{tree}: {full:?} {short:?}");
    }
}

/// A figure on a plain: one grid of planes for both is noted. In usual scenes it is not.
#[test]
fn coarse_planes_are_noted() {
    let mut figure = load("sphere:triangles=2000").unwrap();
    let note = |scene: &Scene, selection: &str| Selection::parse(selection).unwrap().build(scene, 0).unwrap().note;
    for selection in ["bvh-quantised", "bvh4", "bvh8:build=sweep", "bvh-subgroup"] {
        assert_eq!(note(&figure, selection), "", "{selection}");
    }
    for (vertex, position) in
        figure.vertices.iter_mut().take(3).zip([[-1e5, 0.0, -1e5], [1e5, 0.0, 0.0], [0.0, 0.0, 1e5]])
    {
        vertex.position = position.into();
    }
    for selection in ["bvh-quantised", "bvh4", "bvh8:build=sweep", "bvh-subgroup"] {
        let note = note(&figure, selection);
        assert!(note.contains("times the surface of what they hold"), "{selection}: {note}");
    }
    assert_eq!(note(&figure, "cwbvh"), "");
}
