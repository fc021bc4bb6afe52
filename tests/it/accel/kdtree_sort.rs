//! The kd-tree's builders by sorting and by min-max bins: exactness, numbers of leaves, the same bytes whichever way.

use super::{build, build_as, bytes, scenes};
use crate::traversal::{assert_same, trace};
use glam::Vec3;
use rtbench::math::{Aabb, MISS};
use rtbench::scene::{self, Scene};
use rtbench::workloads::trace::backend::GivenRay;
use rtbench::workloads::trace::common::sah::half_area;
use rtbench::workloads::trace::kdtree::{KdNode, KdTree};
use rtbench::workloads::trace::{CpuBackend, Selection};

/// Boxes of a scene's triangles.
fn boxes(scene: &Scene) -> Vec<Aabb> {
    let corners = |triangle: &rtbench::scene::Triangle| triangle.vertices.map(|v| scene.vertices[v as usize].position);
    scene.triangles.iter().map(|triangle| Aabb::from_points(corners(triangle))).collect()
}

/// The cost of splitting a cell at a plane, by counting, in the default model. No triangle lies in a plane.
fn split_cost(cell: &Aabb, own: &[Aabb], axis: usize, plane: f32) -> f64 {
    let (mut left, mut right) = (*cell, *cell);
    (left.max[axis], right.min[axis]) = (plane, plane);
    let on_left = own.iter().filter(|b| b.min[axis] < plane).count() as f64;
    let on_right = own.iter().filter(|b| b.max[axis] > plane).count() as f64;
    half_area(cell) + half_area(&left) * on_left + half_area(&right) * on_right
}

/// Nodes of a tree that are not as an exact builder makes them: with a cheaper plane than the one they have, or leaves
/// that a plane would be cheaper for.
fn inexact(tree: &KdTree, scene: &Scene) -> usize {
    let boxes = boxes(scene);
    let mut inexact = 0;
    tree.for_each_cell(|node, cell, _| {
        let inside = |b: &&Aabb| (0..3).all(|a| b.min[a] < cell.max[a] && b.max[a] > cell.min[a]);
        let own: Vec<Aabb> = boxes.iter().filter(inside).copied().collect();
        let mut cheapest = own.len() as f64 * half_area(cell);
        for axis in 0..3 {
            let planes = own.iter().flat_map(|b| [b.min[axis], b.max[axis]]);
            for plane in planes.filter(|&plane| cell.min[axis] < plane && plane < cell.max[axis]) {
                cheapest = cheapest.min(split_cost(cell, &own, axis, plane));
            }
        }
        let cost = match node.is_leaf() {
            true => own.len() as f64 * half_area(cell),
            false => split_cost(cell, &own, node.axis(), node.split()),
        };
        // Costs are compared in single precision
        inexact += usize::from(cost > cheapest * (1.0 + 1e-5));
    });
    inexact
}

#[test]
fn every_split_is_the_cheapest_of_all() {
    for seed in 1..4 {
        let scene = scenes::random("random", 300, 1.0, 0.2, seed);
        let tree: KdTree = build_as("kdtree:build=sort,thin=0", &scene);
        assert!(tree.nodes.len() > 300);
        assert_eq!(inexact(&tree, &scene), 0);
        // Planes near the best one are seen, and so are leaves that should have been split
        let mut moved = tree.clone();
        let (root, extent) = (tree.nodes[0], tree.bounds.extent());
        moved.nodes[0] = KdNode::inner(root.axis() as u32, root.split() + 0.02 * extent[root.axis()], root.right());
        assert!(inexact(&moved, &scene) > 0);
        let early: KdTree = build_as("kdtree:exact_below=1000,small_leaf=8,thin=0", &scene);
        assert!(inexact(&early, &scene) > 0);
        let bins: KdTree = build_as("kdtree:build=min-max,thin=0", &scene);
        assert!(inexact(&bins, &scene) > 0);
    }
}

/// Larger than what one thread sweeps, and what small nodes are.
fn large() -> Vec<Scene> {
    let built_in = ["scan:triangles=60000", "room:triangles=40000"].map(|name| scene::load(name).unwrap());
    let planar = crate::meshes::lattice(40_000, 64, 5);
    built_in.into_iter().chain([planar]).collect()
}

/// Sorted once or in every node, on any number of threads, and as one subtree without lists of its own.
#[test]
fn a_sorted_tree_is_the_same_whichever_way_it_is_sorted() {
    for scene in large() {
        let once = bytes(&build("kdtree:build=sort", &scene, 1));
        for (selection, threads) in [
            ("kdtree:build=sort", 2),
            ("kdtree:build=sort", 3),
            ("kdtree:build=sort,sorting=every-node", 1),
            ("kdtree:build=sort,sorting=every-node", 2),
            ("kdtree:exact_below=536870912,small_leaf=0", 2),
        ] {
            assert!(bytes(&build(selection, &scene, threads)) == once, "{}: {selection}, {threads}", scene.name);
        }
        assert!(bytes(&build("kdtree", &scene, 1)) != once, "{}: no difference would be seen", scene.name);
        build("kdtree:build=sort,search=ropes", &scene, 2).validate(&scene).unwrap();
    }
}

/// Clusters of triangles, each half as far again from the origin as the one before and as large.
fn clusters() -> Scene {
    let mut next = scenes::numbers(1);
    let scales = std::iter::successors(Some(1e-8_f32), |scale| Some(scale * 1.5)).take_while(|&scale| scale < 1e11);
    let triangles = scales.flat_map(|scale| [scale; 30]).map(|scale| {
        let mut point = |size: f32| Vec3::new(next(), next(), next()) * size * scale;
        let at = point(0.1) + scale;
        [at, at + point(0.01), at + point(0.01)]
    });
    scenes::soup("clusters", triangles.collect::<Vec<_>>())
}

/// Traversals have room for 60 levels. Where a tree would be deeper, its note says so.
#[test]
fn a_tree_as_deep_as_traversals_go_says_so() {
    let scene = clusters();
    for build in ["build=sort", "build=sort,sorting=every-node", "build=min-max"] {
        let deep = Selection::parse(&format!("kdtree:{build},thin=0")).unwrap().build(&scene, 2).unwrap();
        assert_eq!(deep.structure.properties(&scene).depth, Some(60));
        assert!(deep.note.starts_with("max_depth=60: "), "{build}: '{}'", deep.note);
        deep.structure.validate(&scene).unwrap();
        let thicker = Selection::parse(&format!("kdtree:{build}")).unwrap().build(&scene, 2).unwrap();
        assert!(thicker.structure.properties(&scene).depth.unwrap() < 60 && thicker.note.is_empty());
    }
    // All of them find their way down
    let rays: Vec<GivenRay> = (0..2_000)
        .map(|i| {
            let triangle = &scene.triangles[i * 7 % scene.triangles.len()];
            let target = scene.vertices[triangle.vertices[i % 3] as usize].position;
            GivenRay { origin: Vec3::ZERO, direction: target.normalize() }
        })
        .collect();
    let cpu = CpuBackend::new(2).unwrap();
    let truth = trace(&cpu, &scene, "brute", &rays, false);
    assert!(truth.iter().filter(|hit| hit.triangle != MISS).count() > 100);
    for search in ["stack", "ropes", "restart", "short-stack"] {
        let selection = format!("kdtree:build=sort,thin=0,search={search}");
        assert_same(cpu.info(), &selection, &rays, &truth, &trace(&cpu, &scene, &selection, &rays, false));
    }
}

fn leaves(selection: &str, scene: &Scene) -> f64 {
    f64::from(build(selection, scene, 2).properties(scene).leaves.unwrap())
}

/// Min-max bins make somewhat more leaves than the exact sweep, much more without it below.
fn assert_min_max(scene: &Scene) {
    let exact = leaves("kdtree:build=sort", scene);
    let ratio = leaves("kdtree:build=min-max", scene) / exact;
    assert!((1.1..=1.6).contains(&ratio), "{}: {ratio} times the leaves", scene.name);
    let bins_only = leaves("kdtree:exact_below=0,small_leaf=0,spread=cell", scene) / exact;
    assert!(bins_only > ratio, "{}: {bins_only} and {ratio} times the leaves", scene.name);
}

#[test]
fn min_max_bins_make_more_leaves() {
    assert_min_max(&scene::load("scan:triangles=20000").unwrap());
    assert_min_max(&scene::load("room:triangles=20000").unwrap());
}

/// Measured elsewhere, with two builders that agreed to 0.1 %.
#[test]
fn leaves_of_real_models() {
    let Some(folder) = std::env::var_os("RTBENCH_SCENES").filter(|folder| !folder.is_empty()) else {
        eprintln!("NOT RUN: set RTBENCH_SCENES to the folder that holds bunny and dragon");
        return;
    };
    for (name, expected) in [("bunny", 154_832.0), ("dragon", 802_679.0)] {
        let scene = scene::load_in(name, Some(std::path::Path::new(&folder))).unwrap();
        let found = leaves("kdtree:build=sort", &scene);
        assert!((found / expected - 1.0).abs() <= 1e-3, "{name}: {found} leaves instead of {expected}");
        build("kdtree:build=sort,search=ropes", &scene, 2).validate(&scene).unwrap();
        if name == "bunny" {
            assert_min_max(&scene);
        }
    }
}
