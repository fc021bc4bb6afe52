//! Sets of keys against a sorted set, on the CPU and on a device.

use super::support::*;
use crate::support::gpu;
use rtbench::device::CpuDevice;
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::clusters::setting::{ClusterSetting, HierarchyBy, Unique};
use rtbench::workloads::splat::clusters::{Clusters, KeyLayout, NONE};

pub const WAYS: [Unique; 3] = [Unique::Flags, Unique::Sort, Unique::Bits];

/// What is wrong with identifiers and keys of clusters, if anything.
pub fn problem(found: &Clusters, unique: Unique, layout: &KeyLayout) -> Option<String> {
    let mut expected: Vec<u32> = found.keys.iter().copied().filter(|&key| key != NONE).collect();
    expected.sort_unstable();
    expected.dedup();
    if unique == Unique::Sort {
        let tile = |key: u32| {
            let [column, row, ..] = layout.decode(key);
            row * layout.columns + column
        };
        expected.sort_by_cached_key(|&key| (tile(key), key));
    }
    if found.cluster_keys != expected {
        return Some(format!("{} keys of clusters instead of {}, or others", found.len(), expected.len()));
    }
    for (pixel, (&key, &identifier)) in found.keys.iter().zip(&found.identifiers).enumerate() {
        let is_right = match key {
            NONE => identifier == NONE,
            _ => expected.get(identifier as usize) == Some(&key),
        };
        if !is_right {
            return Some(format!("pixel {pixel} with key {key} has cluster {identifier}"));
        }
    }
    None
}

#[test]
fn every_way_finds_the_sorted_set() {
    let cpu = CpuDevice::new(2).unwrap();
    for (width, height) in [(1, 1), (33, 31), (1920, 1080)] {
        for (scene, tile, depths) in [
            (Scene::Random(1), 32, DEPTHS),
            (Scene::Equal, 64, DEPTHS),
            (Scene::Different, 8, FEW_DEPTHS),
            (Scene::Empty, 32, DEPTHS),
        ] {
            // All pairs of the keys of a large tile, on many tiles, take long
            let tile = if width > 1000 { tile.min(16) } else { tile };
            let camera = if scene == Scene::Different { narrow(height) } else { CAMERA };
            for unique in WAYS {
                let setting = ClusterSetting { tile, unique, hierarchy: HierarchyBy::None, ..Default::default() };
                let layout = KeyLayout::new(&setting, Size { width, height }, camera.field_of_view, depths).unwrap();
                let samples = samples_of(scene, &camera, &layout);
                let found = on_cpu(&cpu, &setting, &layout, &camera, &samples);
                assert_eq!(problem(&found, unique, &layout), None, "{scene:?} {width} x {height} {unique:?}");
                let count = found.len();
                match scene {
                    Scene::Equal if width < 64 => assert_eq!(count, 1),
                    Scene::Different => assert_eq!(count, layout.size.pixels()),
                    Scene::Empty => assert!(found.is_empty()),
                    _ => assert!(count as u32 >= layout.columns * layout.rows),
                }
                let Some(gpu) = gpu() else { continue };
                let found = Passes::new(gpu, &setting, &layout).frame(&camera, &samples);
                assert_eq!(problem(&found, unique, &layout), None, "{scene:?} {width} x {height} {unique:?}");
                assert_eq!(found.len(), count);
            }
        }
    }
}

#[test]
fn what_is_wrong_with_a_set_is_noticed() {
    let cpu = CpuDevice::new(2).unwrap();
    for unique in WAYS {
        let setting = ClusterSetting { tile: 8, unique, ..Default::default() };
        let layout = layout(&setting, 33, 31, DEPTHS);
        let found = on_cpu(&cpu, &setting, &layout, &CAMERA, &samples_of(Scene::Random(1), &CAMERA, &layout));
        assert_eq!(problem(&found, unique, &layout), None);
        let last = found.len() - 1;
        let faults: [fn(&mut Clusters, usize); 5] = [
            |found, last| found.cluster_keys.truncate(last),
            |found, last| found.cluster_keys.swap(0, last),
            |found, last| found.cluster_keys.push(found.cluster_keys[last]),
            |found, _| found.identifiers[5] ^= 1,
            |found, _| {
                let none = found.keys.iter().position(|&key| key == NONE).unwrap();
                found.identifiers[none] = 0;
            },
        ];
        for (index, fault) in faults.iter().enumerate() {
            let mut broken = found.clone();
            fault(&mut broken, last);
            assert!(problem(&broken, unique, &layout).is_some(), "fault {index} of {unique:?}");
        }
    }
}
