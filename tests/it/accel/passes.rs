//! Builders that work in passes: the device makes the bytes of the twins, and trees are as good as those of others.

use super::{assert_valid, build, build_as, bytes, scenes};
use crate::support::{gpu, gpu_of};
use glam::Vec3;
use obvhs::BvhBuildParams;
use obvhs::ploc::PlocSearchDistance;
use rtbench::Error;
use rtbench::device::vulkan::VulkanOptions;
use rtbench::device::{Interrupted, VulkanDevice};
use rtbench::scene::{Scene, load};
use rtbench::workloads::trace::bvh::{Bvh, ploc};
use rtbench::workloads::trace::common::sah::CostModel;
use rtbench::workloads::trace::{Built, Selection, Structure};

const SELECTIONS: [&str; 6] = [
    "bvh:build=lbvh",
    "bvh:build=lbvh,max_leaf=1",
    "bvh:build=lbvh,max_leaf=15",
    "bvh:build=ploc-passes",
    "bvh:build=ploc-passes,max_leaf=1,radius=3",
    "bvh:build=ploc-passes,max_leaf=15,radius=1",
];

fn on_device(selection: &str, scene: &Scene, device: &VulkanDevice, interrupted: Interrupted) -> Result<Built, Error> {
    let built = Selection::parse(selection).unwrap().build_on(scene, device, interrupted)?;
    Ok(built.unwrap_or_else(|| panic!("{selection} is not built on devices")))
}

fn built_in(name: &str, triangles: usize) -> Scene {
    load(&format!("{name}:triangles={triangles}")).unwrap()
}

#[test]
fn the_device_makes_the_bytes_of_the_twins() {
    let Some(gpu) = gpu() else { return };
    let built_in = [("scan", 3000), ("terrain", 3000), ("hall", 15_000)].map(|(name, count)| built_in(name, count));
    for scene in scenes::ordinary().iter().chain(&scenes::degenerate()).chain(&built_in) {
        for selection in SELECTIONS {
            let built = on_device(selection, scene, gpu, &|| false).unwrap_or_else(|e| panic!("{selection}: {e}"));
            if let Err(why) = built.structure.validate(scene) {
                panic!("{selection} over {}: {why}", scene.name);
            }
            // A GPU may contract what decides between partners, or divide less exactly
            if gpu.info().software_threads() > 0 {
                let twin = build(selection, scene, 1);
                assert!(bytes(&built.structure) == bytes(&twin), "{selection} over {}", scene.name);
                assert_eq!(built.structure.stack_depth(), twin.stack_depth(), "{selection} over {}", scene.name);
            }
        }
    }
}

#[test]
fn every_build_on_the_device_makes_the_same_bytes_and_times_its_stages() {
    let Some(gpu) = gpu() else { return };
    let scene = built_in("scan", 40_000);
    for (selection, stages) in [
        ("bvh:build=lbvh", &["codes", "sort", "tree", "nodes", "refit"] as &[&str]),
        ("bvh:build=ploc-passes", &["codes", "sort", "clusters", "search", "merge", "nodes"]),
    ] {
        let build = || on_device(selection, &scene, gpu, &|| false).unwrap();
        let (first, second) = (build(), build());
        assert!(bytes(&first.structure) == bytes(&second.structure), "{selection}");
        let times = first.device_times.unwrap();
        assert_eq!((first.build_ms, first.build_threads), (times.total_ms, 0));
        assert!(times.total_ms > 0.0 && times.upload_ms > 0.0, "{times:?}");
        if gpu.info().timestamp_period_ns.is_some() {
            assert_eq!(times.stages.iter().map(|(name, _)| *name).collect::<Vec<_>>(), stages);
            assert!(times.stages.iter().map(|(_, ms)| ms).sum::<f64>() <= times.total_ms * 1.001, "{times:?}");
        }
    }
}

#[test]
fn only_builders_in_passes_are_for_devices() {
    let Some(gpu) = gpu() else { return };
    let scene = scenes::random("small", 50, 1.0, 0.3, 1);
    for selection in ["bvh", "bvh:build=sweep", "bvh:build=spatial", "grid", "kdtree", "bih", "ploc-stack", "brute"] {
        let built = Selection::parse(selection).unwrap().build_on(&scene, gpu, &|| false).unwrap();
        assert!(built.is_none(), "{selection}");
    }
}

#[test]
fn an_interruption_ends_a_build_on_the_device() {
    let Some(gpu) = gpu() else { return };
    let scene = scenes::random("small", 500, 1.0, 0.3, 1);
    for selection in SELECTIONS {
        let error = on_device(selection, &scene, gpu, &|| true).unwrap_err();
        assert!(matches!(error, Error::Interrupted), "{selection}: {error}");
    }
}

#[test]
fn what_no_buffer_holds_is_refused_with_limit_and_need() {
    let options = VulkanOptions { max_binding: 8 << 20, ..VulkanOptions::default() };
    let Some(gpu) = gpu_of(options) else { return };
    let many = scenes::soup("many", (0..400_000).map(|i| [Vec3::X * i as f32, Vec3::Y, Vec3::Z]));
    for selection in SELECTIONS {
        let error = on_device(selection, &many, &gpu, &|| false).unwrap_err();
        assert!(matches!(error, Error::Refused(_)), "{selection}: {error}");
        let message = error.to_string();
        assert!(message.contains("MiB are needed") && message.contains("at most 8 MiB"), "{selection}: {message}");
        let few = scenes::random("small", 500, 1.0, 0.3, 1);
        on_device(selection, &few, &gpu, &|| false).unwrap();
    }
}

fn cost(bvh: &Bvh) -> f64 {
    CostModel::default().bvh(bvh).unwrap()
}

/// Trees without reinsertion, one triangle a leaf: at most 10 % above obvhs's at the same search distance, in scenes
/// whose triangles are of about one size.
#[test]
fn clustering_is_as_good_as_that_of_obvhs() {
    for name in ["scan", "terrain", "hall", "stadium"] {
        let scene = built_in(name, 30_000);
        for (distance, radius) in [(PlocSearchDistance::Low, 6), (PlocSearchDistance::Medium, 14)] {
            let params = BvhBuildParams {
                ploc_search_distance: distance,
                reinsertion_batch_ratio: 0.0,
                max_prims_per_leaf: 1,
                ..BvhBuildParams::fastest_build()
            };
            let theirs = ploc::build(&scene, params).unwrap().expect("PLOC builds this scene");
            let own: Bvh = build_as(&format!("bvh:build=ploc-passes,max_leaf=1,radius={radius}"), &scene);
            let (own, theirs) = (cost(&own), cost(&theirs));
            println!("{name}, {radius} places: SAH cost {own:.2}, obvhs {theirs:.2}");
            assert!(own <= 1.1 * theirs, "{name}, {radius} places: SAH cost {own}, obvhs has {theirs}");
        }
    }
}

#[test]
fn a_better_search_makes_a_better_tree() {
    let scene = built_in("scan", 30_000);
    let cost = |selection: &str| cost(&build_as(selection, &scene));
    let [lbvh, near, far] = ["lbvh", "ploc-passes,radius=1", "ploc-passes"].map(|b| cost(&format!("bvh:build={b}")));
    assert!(far < near && near < lbvh, "{far} {near} {lbvh}");
}

/// Boxes inside each other or in a row: few clusters have a partner, so that the passes would be as many as triangles.
#[test]
fn clustering_ends_after_few_passes() {
    let nested = (0..20_000).map(|i| [Vec3::NEG_ONE, Vec3::ONE, Vec3::Y].map(|corner| corner * (1.0 + i as f32)));
    let row = (0..20_000).map(|i| [Vec3::ZERO, Vec3::X, Vec3::Y].map(|corner| corner + Vec3::X * i as f32));
    for scene in [scenes::soup("inside each other", nested), scenes::soup("row", row)] {
        let selection = "bvh:build=ploc-passes,max_leaf=1";
        let tree: Bvh = build_as(selection, &scene);
        // No tree is deeper than the passes that made it
        assert!((15..=60).contains(&tree.depth), "{}: depth {}", scene.name, tree.depth);
        assert_valid(selection, &scene);
    }
}

#[test]
fn damage_is_noticed() {
    let scene = scenes::random("medium", 2000, 1.0, 0.05, 2);
    for selection in SELECTIONS {
        let good: Bvh = build_as(selection, &scene);
        good.validate(&scene).unwrap();
        let damages: [&dyn Fn(&mut Bvh); 5] = [
            &|b| b.nodes[2].max[0] -= 1e-3,
            &|b| b.nodes.swap(2, 3),
            &|b| b.triangle_refs.swap(0, 1999),
            &|b| b.depth += 1,
            &|b| b.nodes[0].first += 2,
        ];
        for (i, damage) in damages.iter().enumerate() {
            let mut broken = good.clone();
            damage(&mut broken);
            assert!(broken.validate(&scene).is_err(), "{selection}: damage {i}");
        }
    }
}
