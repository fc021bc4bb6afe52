//! Boxes contain their samples and touch one on each side; masks and boxes of nodes against loops.

use super::support::*;
use super::unique::WAYS;
use crate::support::gpu;
use rtbench::device::CpuDevice;
use rtbench::workloads::splat::clusters::setting::{BoundsBy, ClusterSetting, KeyOrder, Normals};
use rtbench::workloads::splat::clusters::{Bounds, Clusters, KeyLayout, NONE};
use std::collections::{BTreeMap, BTreeSet};

/// What is wrong with boxes of clusters, if anything.
fn problem_of_boxes(found: &Clusters) -> Option<String> {
    // Sides that a sample lies on: the smallest of x, y, z, then the largest
    let mut touched = vec![[false; 6]; found.boxes.len()];
    for (pixel, &identifier) in found.identifiers.iter().enumerate().filter(|(_, id)| **id != NONE) {
        let (position, bounds) = (found.positions[pixel], &found.boxes[identifier as usize]);
        for axis in 0..3 {
            let (place, min, max) = (position[axis], bounds.min[axis], bounds.max[axis]);
            if !(min <= place && place <= max) {
                return Some(format!("pixel {pixel} is outside of cluster {identifier}"));
            }
            touched[identifier as usize][axis] |= place == min;
            touched[identifier as usize][3 + axis] |= place == max;
        }
    }
    let loose = touched.iter().position(|sides| sides.contains(&false))?;
    Some(format!("cluster {loose} is too large"))
}

/// What is wrong with nodes, if anything: from the keys of pixels and the boxes of clusters.
fn problem_of_nodes(found: &Clusters, layout: &KeyLayout) -> Option<String> {
    let nodes = found.nodes.as_ref()?;
    let keys: BTreeSet<u32> = found.keys.iter().copied().filter(|&key| key != NONE).collect();
    let of_key: BTreeMap<u32, &Bounds> = found.cluster_keys.iter().copied().zip(&found.boxes).collect();
    let bits = layout.key_bits();
    for level in 0..5 {
        // The node's key is what all keys below it begin with; the root of 23 bits has 3 of them left
        let own = if level == 0 { 0 } else { bits - 25 + 5 * level };
        let children = if level == 0 { bits - 20 } else { 5 };
        let first = layout.level_offset(level) as usize;
        for node in 0..1_u32 << own {
            let (mask, bounds) = (nodes.masks[first + node as usize], &nodes.boxes[first + node as usize]);
            let below = |prefix: u32, length: u32| prefix << (bits - length)..(prefix + 1) << (bits - length);
            if keys.range(below(node, own)).next().is_none() {
                if mask != 0 || *bounds != Bounds::EMPTY {
                    return Some(format!("node {node} of level {level} has nothing below it, and {mask:b}"));
                }
                continue;
            }
            for child in 0..32 {
                let exists = child < 1 << children
                    && keys.range(below(node << children | child, own + children)).next().is_some();
                if exists != (mask >> child & 1 == 1) {
                    return Some(format!("child {child} of node {node} of level {level}: {exists}"));
                }
            }
            let all: Vec<&Bounds> = of_key.range(below(node, own)).map(|(_, bounds)| *bounds).collect();
            for axis in 0..3 {
                let min = all.iter().map(|bounds| bounds.min[axis]).fold(f32::INFINITY, f32::min);
                let max = all.iter().map(|bounds| bounds.max[axis]).fold(f32::NEG_INFINITY, f32::max);
                if (min, max) != (bounds.min[axis], bounds.max[axis]) {
                    return Some(format!("the box of node {node} of level {level} is no union"));
                }
            }
        }
    }
    None
}

#[test]
fn boxes_are_tight_and_nodes_are_complete() {
    let cpu = CpuDevice::new(2).unwrap();
    let mut settings = Vec::new();
    for (unique, bounds) in WAYS.into_iter().zip([BoundsBy::TwoStep, BoundsBy::Direct, BoundsBy::TwoStep]) {
        settings.push(ClusterSetting { tile: 8, unique, bounds, ..Default::default() });
    }
    settings.push(ClusterSetting { tile: 13, key: KeyOrder::Concat, normals: Normals::Faces, ..Default::default() });
    for setting in settings {
        let layout = layout(&setting, 133, 71, DEPTHS);
        for (scene, camera) in [(Scene::Random(2), CAMERA), (Scene::Waves, slanted()), (Scene::Empty, CAMERA)] {
            let samples = samples_of(scene, &camera, &layout);
            let twin = on_cpu(&cpu, &setting, &layout, &camera, &samples);
            let device = gpu().map(|gpu| Passes::new(gpu, &setting, &layout).frame(&camera, &samples));
            for found in std::iter::once(twin).chain(device) {
                assert_eq!(problem_of_boxes(&found), None, "{setting:?} {scene:?}");
                assert_eq!(problem_of_nodes(&found, &layout), None, "{setting:?} {scene:?}");
                assert!(found.nodes.is_some());
                assert_eq!(
                    found.samples().iter().sum::<u32>() as usize,
                    found.keys.iter().filter(|k| **k != NONE).count()
                );
                assert_eq!(found.is_empty(), scene == Scene::Empty);
                let nodes = found.nodes.as_ref().unwrap().of_levels(&layout);
                assert_eq!(nodes[0], u32::from(scene != Scene::Empty));
                assert!(nodes.windows(2).all(|pair| pair[0] <= pair[1]) && nodes[4] as usize <= found.len());
            }
        }
    }
}

#[test]
fn what_is_wrong_with_boxes_and_nodes_is_noticed() {
    let cpu = CpuDevice::new(2).unwrap();
    let setting = ClusterSetting { tile: 8, ..Default::default() };
    let layout = layout(&setting, 133, 71, DEPTHS);
    let found = on_cpu(&cpu, &setting, &layout, &CAMERA, &samples_of(Scene::Waves, &CAMERA, &layout));
    for (axis, up) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
        let moved = |value: f32| if up { value.next_up() } else { value.next_down() };
        for max in [false, true] {
            let mut broken = found.clone();
            let bounds = &mut broken.boxes[7];
            let side = if max { &mut bounds.max[axis] } else { &mut bounds.min[axis] };
            *side = moved(*side);
            assert!(problem_of_boxes(&broken).is_some(), "{axis} {up} {max}");
            let nodes = broken.nodes.as_mut().unwrap();
            let leaf = (layout.level_offset(4)..).find(|&node| nodes.masks[node as usize] != 0).unwrap();
            let bounds = &mut nodes.boxes[leaf as usize];
            let side = if max { &mut bounds.max[axis] } else { &mut bounds.min[axis] };
            *side = moved(*side);
            broken.boxes = found.boxes.clone();
            assert!(problem_of_nodes(&broken, &layout).is_some(), "{axis} {up} {max}");
        }
    }
    for level in 0..5 {
        for bit in 0..32 {
            let mut broken = found.clone();
            let node = layout.node_of(found.cluster_keys[11], level) as usize;
            broken.nodes.as_mut().unwrap().masks[node] ^= 1 << bit;
            assert!(problem_of_nodes(&broken, &layout).is_some(), "level {level}, bit {bit}");
        }
    }
}
