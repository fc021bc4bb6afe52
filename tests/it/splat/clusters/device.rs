//! Kernels against twins to the bit, in any order of frames.

use super::support::*;
use super::unique::WAYS;
use crate::support::gpu;
use rtbench::device::CpuDevice;
use rtbench::workloads::splat::clusters::setting::*;
use rtbench::workloads::splat::clusters::verify;
use rtbench::workloads::splat::gpu::clusters::{BOUNDS, HIERARCHY, KEYS, UNIQUE};
use rtbench::workloads::splat::verify::Exactness;

fn settings() -> Vec<ClusterSetting> {
    let usual = ClusterSetting::default();
    let mut settings = Vec::new();
    for (index, tile) in [4, 8, 13, 32, 64].into_iter().enumerate() {
        for (way, unique) in WAYS.into_iter().enumerate() {
            let turn = index + way;
            settings.push(ClusterSetting {
                tile,
                unique,
                key: [KeyOrder::Morton, KeyOrder::Concat][turn % 2],
                normals: [Normals::Off, Normals::Faces, Normals::Cells][turn % 3],
                bounds: [BoundsBy::Direct, BoundsBy::TwoStep][(index + way / 2) % 2],
                space: [Space::View, Space::World][turn % 2],
                ..usual
            });
        }
    }
    for unique in WAYS {
        settings.push(ClusterSetting { tile: 16, unique, hierarchy: HierarchyBy::None, ..usual });
    }
    settings
}

#[test]
fn every_setting_makes_the_bits_of_the_twins() {
    let Some(gpu) = gpu() else { return };
    let cpu = CpuDevice::new(2).unwrap();
    let exactness = if gpu.info().agrees_with_twins() { Exactness::Bits } else { Exactness::Close };
    for setting in settings() {
        for (width, height) in [(133, 71), (64, 1), (1, 130)] {
            let layout = layout(&setting, width, height, DEPTHS);
            let passes = Passes::new(gpu, &setting, &layout);
            for (scene, camera) in [(Scene::Waves, slanted()), (Scene::Random(9), CAMERA)] {
                let samples = samples_of(scene, &camera, &layout);
                let found = passes.frame(&camera, &samples);
                let what = format!("{setting:?} {width} x {height} {scene:?}");
                let given = (&setting, &layout, &placement(&setting, &camera));
                let checks = verify::check(cpu.pool(), &found, &samples, given, camera.field_of_view, exactness);
                assert!(checks.len() >= 6);
                for check in checks {
                    assert!(check.ok, "{what}: {}", check.message);
                }
                if exactness == Exactness::Bits {
                    let expected = on_cpu(&cpu, &setting, &layout, &camera, &samples);
                    assert_eq!(difference(&found, &expected), None, "{what}");
                }
                assert!(!found.is_empty());
            }
        }
    }
}

/// Nothing is left from the frame before, whether it was another, the same, or none.
#[test]
fn the_order_of_frames_changes_no_bit() {
    let Some(gpu) = gpu() else { return };
    for (unique, bounds) in WAYS.into_iter().zip([BoundsBy::Direct, BoundsBy::TwoStep, BoundsBy::Direct]) {
        let setting = ClusterSetting { tile: 8, unique, bounds, ..ClusterSetting::default() };
        let layout = layout(&setting, 133, 71, DEPTHS);
        let views = [(Scene::Random(4), CAMERA), (Scene::Waves, slanted()), (Scene::Empty, CAMERA)];
        let views = views.map(|(scene, camera)| (samples_of(scene, &camera, &layout), camera));
        let passes = Passes::new(gpu, &setting, &layout);
        let frame = |view: usize| passes.frame(&views[view].1, &views[view].0);
        let alone = [0, 1, 2].map(|view| {
            passes.buffers.poison(gpu);
            frame(view)
        });
        assert!(difference(&alone[0], &alone[1]).is_some());
        for view in [0, 1, 0, 0, 2, 1, 1, 2, 0] {
            assert_eq!(difference(&frame(view), &alone[view]), None, "{unique:?}, view {view}");
        }
        for stage in [KEYS, UNIQUE, BOUNDS, HIERARCHY] {
            assert!(passes.steps.count(stage) > 0, "{stage:?}");
        }
    }
}

/// Both ways to boxes, and all ways to the set but for its order, are the same.
#[test]
fn ways_agree() {
    let Some(gpu) = gpu() else { return };
    let of = |setting: ClusterSetting| {
        let layout = layout(&setting, 133, 71, DEPTHS);
        Passes::new(gpu, &setting, &layout).frame(&CAMERA, &samples_of(Scene::Random(6), &CAMERA, &layout))
    };
    let usual = ClusterSetting { tile: 8, ..ClusterSetting::default() };
    let first = of(usual);
    assert_eq!(difference(&first, &of(ClusterSetting { bounds: BoundsBy::TwoStep, ..usual })), None);
    assert_eq!(difference(&first, &of(ClusterSetting { unique: Unique::Bits, ..usual })), None);
    let sorted = of(ClusterSetting { unique: Unique::Sort, ..usual });
    assert_eq!(first.nodes, sorted.nodes);
    let lookup = first.lookup();
    for (&key, bounds) in sorted.cluster_keys.iter().zip(&sorted.boxes) {
        assert_eq!(first.boxes[lookup.identifier_of(key).unwrap() as usize], *bounds);
    }
}
