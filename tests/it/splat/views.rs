//! Frames with clusters one after another: no frame depends on those before it, and read-backs change nothing.

use super::frames::*;
use crate::support::gpu;
use glam::Vec3;
use rtbench::camera::Camera;
use rtbench::device::VulkanDevice;
use rtbench::scene;
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::Stages;
use rtbench::workloads::splat::cluster_axes::Sync;
use rtbench::workloads::splat::clusters::KeyLayout;
use rtbench::workloads::splat::clusters::setting::{BoundsBy, ClusterSetting, HierarchyBy, Unique};
use rtbench::workloads::splat::gathering::Gathering;
use rtbench::workloads::splat::gpu::{GpuFrame, stages};
use rtbench::workloads::splat::lit::LitScene;
use rtbench::workloads::splat::technique::Technique;
use rtbench::workloads::trace::{Built, Selection};

const SIZE: Size = Size { width: 67, height: 45 };
const ON: &dyn Fn() -> bool = &|| false;

/// Techniques whose sums do not depend on timing.
const TECHNIQUES: [&str; 6] = [
    "per-sample:order=sorted",
    "buckets",
    "buckets:blur=2",
    "buckets:level=3",
    "buckets:share=centre,kernel=constant",
    "tiled:kernel=constant",
];

fn gathering(lit: &LitScene, technique: &str, setting: ClusterSetting, narrowest: f32) -> Gathering {
    let technique = Technique::parse(technique).unwrap();
    let estimate = technique.estimate(lit.diagonal() * 0.1);
    let layout = technique
        .gather
        .has_clusters()
        .then(|| KeyLayout::new(&setting, SIZE, narrowest, (lit.near(), lit.far())).unwrap());
    Gathering { gather: technique.gather, clusters: setting, layout, ..Gathering::from(estimate) }
}

/// A structure with its traversal.
fn built(lit: &LitScene) -> (Selection, Built) {
    let selection = Selection::parse("bvh-stack").unwrap();
    let built = selection.build(&lit.scene, 1).unwrap();
    (selection, built)
}

fn frame<'a>(
    gpu: &'a VulkanDevice,
    lit: &'a LitScene,
    (selection, built): &'a (Selection, Built),
    gathering: &Gathering,
) -> GpuFrame<'a> {
    GpuFrame::new(gpu, lit, &*built.structure, selection.method(), SETTING, gathering.clone(), SIZE).unwrap()
}

/// Everything that lies between samples and picture has the same bits.
fn same(a: &Stages, b: &Stages) -> bool {
    difference(a, b).is_none() && a.gathered == b.gathered
}

fn settings() -> Vec<ClusterSetting> {
    let of = |tile, unique, bounds, hierarchy| ClusterSetting { tile, unique, bounds, hierarchy, ..Default::default() };
    vec![
        of(8, Unique::Flags, BoundsBy::Direct, HierarchyBy::Masks),
        of(8, Unique::Sort, BoundsBy::TwoStep, HierarchyBy::Masks),
        of(13, Unique::Bits, BoundsBy::TwoStep, HierarchyBy::Masks),
        of(8, Unique::Bits, BoundsBy::Direct, HierarchyBy::None),
    ]
}

#[test]
fn no_frame_depends_on_those_before_it() {
    let Some(gpu) = gpu() else { return };
    let scene = scene::load("room:triangles=20000").unwrap();
    let camera = camera_of(&scene);
    // Another view and another field of view: other slices, other clusters
    let direction = (camera.direction + Vec3::new(0.1, 0.05, 0.2)).normalize();
    let turned = Camera { direction, field_of_view: camera.field_of_view * 0.7, ..camera };
    let light = light_at(&scene, [0.45, 0.6, 0.55], Vec3::new(5.0, 4.0, 3.0));
    let lit = lit(scene, &[light]);
    let built = built(&lit);
    for (technique, setting) in TECHNIQUES.iter().flat_map(|t| settings().into_iter().map(move |s| (*t, s))) {
        if setting.hierarchy == HierarchyBy::None && technique.contains("level") {
            continue;
        }
        let what = format!("{technique} {setting:?}");
        let gathering = gathering(&lit, technique, setting, turned.field_of_view);
        let (mut one, mut other) = (frame(gpu, &lit, &built, &gathering), frame(gpu, &lit, &built, &gathering));
        let (a, b) = (one.render(&camera, ON).unwrap(), one.render(&turned, ON).unwrap());
        let (b_first, a_second) = (other.render(&turned, ON).unwrap(), other.render(&camera, ON).unwrap());
        assert!(same(&a, &a_second) && same(&b, &b_first), "{what}");
        assert!(!same(&a, &b), "{what}");
        assert!(a.irradiance.iter().any(|irradiance| irradiance.y > 0.0), "{what}");
        // In one submission, without poison between frames
        for (cameras, last) in [(vec![camera, turned], &b), (vec![turned, camera], &a), (vec![turned; 3], &b)] {
            let times = one.time(&cameras, ON).unwrap();
            let labels = stages(SETTING, gathering.gather, &gathering.clusters);
            assert!(times.iter().all(|time| time.stages.is_empty() || time.stages.len() == labels.len()), "{what}");
            assert_eq!(one.last().unwrap(), last.picture, "{what}");
        }
        // By numbers that the host reads back
        let mut read_back = frame(gpu, &lit, &built, &Gathering { sync: Sync::Readback, ..gathering });
        read_back.time(&[turned, camera], ON).unwrap();
        assert_eq!(read_back.last().unwrap(), a.picture, "{what}");
        if a.gathered.clusters.is_some() {
            assert_eq!(one.clusters(&turned, ON).unwrap(), b.gathered.clusters.unwrap(), "{what}");
        }
    }
}

#[test]
fn an_overflow_of_any_frame_is_noticed() {
    let Some(gpu) = gpu() else { return };
    let scene = scene::load("room:triangles=20000").unwrap();
    let camera = camera_of(&scene);
    // Out of the room, at nothing
    let away = Camera { position: camera.position + Vec3::splat(1e4), direction: Vec3::X, up: Vec3::Y, ..camera };
    let light = light_at(&scene, [0.45, 0.6, 0.55], Vec3::ONE);
    let lit = lit(scene, &[light]);
    let setting = ClusterSetting { tile: 8, ..Default::default() };
    let built = built(&lit);
    let gathering = gathering(&lit, "per-sample", setting, camera.field_of_view);
    let mut frame = frame(gpu, &lit, &built, &Gathering { capacity: 50, ..gathering });
    for cameras in [[camera, away], [away, camera]] {
        let error = frame.time(&cameras, ON).unwrap_err().to_string();
        assert!(error.contains("overflow") && error.contains("is 50"), "{error}");
    }
    frame.time(&[away, away], ON).unwrap();
    assert!(frame.render(&camera, ON).unwrap_err().to_string().contains("overflow"));
}
