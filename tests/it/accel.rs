//! Builders: every one, with several options, over every degenerate scene, validated; validation itself; determinism;
//! the published numbers.

mod bih;
mod broken;
mod broken_wide;
mod degenerate;
mod kdtree_sort;
mod passes;
mod registry;
mod scenes;
mod selections;
mod spatial;
mod sweep;
mod thesis;
mod wide;

use glam::Vec3;
use proptest::prelude::*;
use rtbench::scene::Scene;
use rtbench::workloads::trace::bvh::Bvh;
use rtbench::workloads::trace::{Selection, Structure};
use std::sync::Arc;

/// Every builder, with options that lead through other code.
pub const SELECTIONS: [&str; 69] = [
    "grid",
    "grid:factor=1",
    "grid:x=5",
    "grid:x=3,y=4,z=2",
    "kdtree",
    "kdtree:exact_below=0",
    "kdtree:exact_below=16,bins=7",
    "kdtree:kt=0.2,max_depth=20",
    "kdtree:max_depth=0",
    "kdtree:spread=cell,exact_below=256,small_leaf=0,max_depth=auto",
    "kdtree:small_leaf=0,thin=0,kt=0.1,bins=64,exact_below=8",
    "kdtree:build=sort",
    "kdtree:build=sort,sorting=every-node",
    "kdtree:build=sort,kt=0.2,thin=0",
    "kdtree:build=min-max",
    "kdtree:build=min-max,bins=5,spread=cell",
    "kdtree:search=ropes",
    "kdtree:build=sort,search=ropes",
    "kdtree:build=sort,push=off,search=ropes",
    "bvh",
    "bvh:bins=2,max_leaf=1",
    "bvh:bins=32,max_leaf=15",
    "bvh:max_leaf=15,kt=1",
    "bvh:max_leaf=15,kt=0,ki=2",
    "bvh:build=sweep,max_leaf=3",
    "bvh:build=sweep,max_leaf=3,sorting=every-node",
    "bvh:build=sweep,max_leaf=15,kt=1",
    "bvh:build=sweep,max_leaf=1,axes=longest,max_depth=20",
    "bvh:build=sweep,max_leaf=1,max_depth=440",
    "bvh:build=spatial,max_leaf=3",
    "bvh:build=spatial,max_leaf=1,alpha=0",
    "bvh:build=spatial,overlap=below,alpha=0.01,spatial_bins=5",
    "bvh:build=spatial,max_leaf=2,axes=longest,alpha=0,spatial_bins=128,spatial_depth=440",
    "ploc-stack",
    "ploc-stack:preset=fastest",
    "ploc-stack:preset=very-fast",
    "ploc-stack:preset=slow",
    "ploc-stack:preset=very-slow",
    "bih",
    "bih:max_leaf=1",
    "bih:max_leaf=15",
    "brute",
    "bvh:build=ploc",
    "bvh-quantised",
    "bvh-quantised:build=spatial,max_leaf=1,alpha=0",
    "bvh4",
    "bvh4:order=octant",
    "bvh8",
    "bvh8:max_leaf=1",
    "bvh8:order=octant",
    "bvh8:build=spatial,max_leaf=3",
    "bvh8:build=ploc",
    "bvh8:build=ploc,preset=very-slow",
    "cwbvh",
    "cwbvh:preset=fastest",
    "cwbvh:preset=slow",
    "cwbvh:build=binned",
    "cwbvh:build=binned,max_leaf=1",
    "cwbvh:build=spatial",
    "bvh:build=lbvh",
    "bvh:build=lbvh,max_leaf=1",
    "bvh:build=ploc-passes",
    "bvh:build=ploc-passes,max_leaf=1,radius=2",
    "bvh-subgroup",
    "bvh-subgroup:width=2",
    "bvh-subgroup:width=4,max_leaf=1",
    "bvh-stackless",
    "bvh-stackless:build=spatial,max_leaf=1,alpha=0",
    "query",
];

pub fn build(selection: &str, scene: &Scene, threads: usize) -> Arc<dyn Structure> {
    Selection::parse(selection).unwrap().build(scene, threads).unwrap().structure
}

/// The same, of a known type.
pub fn build_as<S: Structure + Clone>(selection: &str, scene: &Scene) -> S {
    build(selection, scene, 1).downcast_ref::<S>().expect("a structure of this type").clone()
}

fn assert_valid(selection: &str, scene: &Scene) {
    if let Err(why) = build(selection, scene, 2).validate(scene) {
        panic!("{selection} over {}: {why}", scene.name);
    }
}

#[test]
fn every_builder_survives_every_degenerate_scene() {
    for scene in scenes::degenerate() {
        for selection in SELECTIONS {
            assert_valid(selection, &scene);
        }
    }
}

#[test]
fn every_builder_is_valid_on_ordinary_scenes() {
    for scene in scenes::ordinary() {
        for selection in SELECTIONS {
            assert_valid(selection, &scene);
        }
    }
}

#[test]
fn no_bvh_is_deeper_than_the_bound() {
    let far = scenes::powers_of_ten();
    let bvh: Bvh = build_as("bvh:max_leaf=1,bins=2", &far);
    assert!(bvh.depth > 20, "the scene is no challenge: depth {}", bvh.depth);
    assert!(bvh.depth <= rtbench::workloads::trace::bvh::MAX_DEPTH);
}

/// By the heuristic's own measure: leaves where they pay, and more of them the more a step costs.
#[test]
fn a_bvh_s_cost_constants_decide_about_leaves() {
    let scene = scenes::ordinary().pop().unwrap();
    let nodes = |selection: &str| {
        let bvh: Bvh = build_as(selection, &scene);
        (bvh.nodes.len(), rtbench::workloads::trace::common::sah::CostModel::default().bvh(&bvh).unwrap())
    };
    let (small, large) = (nodes("bvh:max_leaf=1"), nodes("bvh:max_leaf=15"));
    let by_cost = ["0.25", "1", "4", "16"].map(|kt| nodes(&format!("bvh:max_leaf=15,kt={kt}")));
    assert!(by_cost.is_sorted_by(|a, b| a.0 > b.0), "{by_cost:?}");
    assert!(by_cost[0].0 < small.0 && by_cost[3].0 >= large.0, "{small:?} {by_cost:?} {large:?}");
    assert!(by_cost[1].1 < small.1 && by_cost[1].1 < large.1, "{small:?} {by_cost:?} {large:?}");
    // Only the ratio counts
    assert_eq!(nodes("bvh:max_leaf=15,kt=8,ki=2"), by_cost[2]);
}

#[test]
fn names_and_options_of_structures() {
    let parse = |text: &str| Selection::parse(text).map(|s| format!("{} {}", s.name(), s.variant()));
    assert_eq!(parse("bvh-packet:max_leaf=8").unwrap(), "bvh max_leaf=8");
    assert_eq!(parse("bvh:kt=inf").unwrap(), "bvh default");
    for (wrong, why) in
        [("bvh:kt=-1", "no value for kt"), ("grid:x=3,x=4", "x is given twice"), (":x=1", "no structure ''")]
    {
        let error = parse(wrong).unwrap_err().to_string();
        assert!(error.contains(why), "{error}");
    }
}

#[test]
fn builds_do_not_depend_on_the_number_of_threads() {
    let scene = scenes::random("random", 30_000, 1.0, 0.02, 7);
    for selection in SELECTIONS {
        let one = bytes(&build(selection, &scene, 1));
        for threads in [2, 4] {
            assert!(one == bytes(&build(selection, &scene, threads)), "{selection} differs with {threads} threads");
        }
    }
}

/// Everything that a device would be given.
fn bytes(structure: &Arc<dyn Structure>) -> Vec<u8> {
    let (nodes, uniform) = (structure.nodes(), structure.uniform());
    assert_eq!(nodes.len(), structure.node_bytes());
    [&*nodes, bytemuck::cast_slice(structure.triangle_refs()), &*uniform].concat()
}

#[test]
fn sah_cost_is_near_that_of_a_good_builder() {
    let scene = scenes::random("random", 20_000, 1.0, 0.02, 3);
    let cost = |selection| build(selection, &scene, 0).properties(&scene).sah_cost.unwrap();
    let (own, obvhs) = (cost("bvh"), cost("ploc-stack:preset=fast"));
    assert!(own < 1.25 * obvhs, "SAH cost {own}, obvhs has {obvhs}");
}

/// Corners on a coarse lattice, so that boxes touch, coincide and lie in planes all the time.
fn lattice_soup() -> impl Strategy<Value = Vec<[Vec3; 3]>> {
    let corner = (0..6_i32, 0..6_i32, 0..6_i32).prop_map(|(x, y, z)| Vec3::new(x as f32, y as f32, z as f32));
    prop::collection::vec([corner.clone(), corner.clone(), corner], 0..120)
}

/// Corners anywhere, infinities and NaN included.
fn wild_soup() -> impl Strategy<Value = Vec<[Vec3; 3]>> {
    let corner = [any::<f32>(), any::<f32>(), any::<f32>()].prop_map(Vec3::from);
    prop::collection::vec([corner.clone(), corner.clone(), corner], 0..40)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn any_lattice_soup_is_valid(triangles in lattice_soup()) {
        let scene = scenes::soup("lattice", triangles);
        SELECTIONS.iter().for_each(|selection| assert_valid(selection, &scene));
    }

    #[test]
    fn any_wild_soup_is_valid(triangles in wild_soup()) {
        let scene = scenes::soup("wild", triangles);
        // A resolution set by hand may well be refused here.
        let selections = SELECTIONS.iter().filter(|s| !s.starts_with("grid:x"));
        selections.for_each(|selection| assert_valid(selection, &scene));
    }
}
