//! What the comparison of clusters with the twins must notice.

use super::support::*;
use super::unique::WAYS;
use rtbench::device::{CpuDevice, POISON};
use rtbench::workloads::splat::clusters::setting::{ClusterSetting, HierarchyBy};
use rtbench::workloads::splat::clusters::{Clusters, KeyLayout, verify};
use rtbench::workloads::splat::verify::Exactness;

/// Changes clusters; the second ones are those of another frame.
type Fault = fn(&mut Clusters, &Clusters, &KeyLayout);

const POISONED: f32 = f32::from_bits(POISON);

/// A fault, and what the message about it begins with.
const FAULTS: [(&str, &str, Fault); 15] = [
    ("a flipped bit of the last level", "masks of nodes", |found, _, layout| {
        let node = layout.node_of(found.cluster_keys[3], 4) as usize;
        found.nodes.as_mut().unwrap().masks[node] ^= 1 << 31;
    }),
    ("a flipped bit of the root", "masks of nodes", |found, _, _| found.nodes.as_mut().unwrap().masks[0] ^= 1),
    ("a box too small by one unit", "boxes of clusters", |found, _, _| {
        let side = &mut found.boxes[2].max.y;
        *side = side.next_down();
    }),
    ("a box too large by one unit", "boxes of clusters", |found, _, _| {
        let side = &mut found.boxes[2].min.z;
        *side = side.next_down();
    }),
    ("a box of a node too small by one unit", "boxes of nodes", |found, _, _| {
        let side = &mut found.nodes.as_mut().unwrap().boxes[0].min.x;
        *side = side.next_up();
    }),
    ("the previous frame's identifiers", "identifiers", |found, other, _| {
        found.identifiers.clone_from(&other.identifiers);
    }),
    ("the previous frame's boxes", "boxes of clusters", |found, other, _| found.boxes.clone_from(&other.boxes)),
    ("the previous frame's masks", "masks of nodes", |found, other, _| {
        found.nodes.as_mut().unwrap().masks.clone_from(&other.nodes.as_ref().unwrap().masks);
    }),
    ("poisoned keys", "keys", |found, _, _| found.keys.fill(POISON)),
    ("poisoned identifiers", "identifiers", |found, _, _| found.identifiers.fill(POISON)),
    ("poisoned keys of clusters", "keys of clusters", |found, _, _| found.cluster_keys.fill(POISON)),
    ("a poisoned box", "boxes of clusters", |found, _, _| found.boxes[0].min.x = POISONED),
    ("poisoned boxes of nodes", "boxes of nodes", |found, _, _| {
        found.nodes.as_mut().unwrap().boxes[0].max.x = POISONED;
    }),
    ("a lost cluster", "keys of clusters", |found, _, _| {
        found.cluster_keys.pop();
        found.boxes.pop();
    }),
    ("a key in the neighbouring slice", "keys", |found, _, layout| {
        let [column, row, slice, normal] = layout.decode(found.keys[40]);
        found.keys[40] = layout.encode(column, row, slice + 1, normal);
    }),
];

#[test]
fn the_comparison_notices() {
    let cpu = CpuDevice::new(2).unwrap();
    for unique in WAYS {
        let setting = ClusterSetting { tile: 8, unique, ..ClusterSetting::default() };
        let layout = layout(&setting, 67, 45, DEPTHS);
        let views = [(Scene::Random(2), CAMERA), (Scene::Random(7), slanted())];
        let [(samples, found), (_, other)] = views.map(|(scene, camera)| {
            let mut samples = samples_of(scene, &camera, &layout);
            samples.positions[40].w = samples.positions[41].w.max(1.0);
            let found = on_cpu(&cpu, &setting, &layout, &camera, &samples);
            (samples, found)
        });
        let problems = |found: &Clusters, exactness| -> Vec<String> {
            let given = (&setting, &layout, &placement(&setting, &CAMERA));
            let checks = verify::check(cpu.pool(), found, &samples, given, CAMERA.field_of_view, exactness);
            checks.into_iter().filter(|check| !check.ok).map(|check| check.message).collect()
        };
        for exactness in [Exactness::Bits, Exactness::Close] {
            assert_eq!(problems(&found, exactness), [""; 0]);
            for (name, about, fault) in FAULTS {
                // A device that rounds differently may have a few keys of its own
                if about == "keys" && name.starts_with("a key") && exactness == Exactness::Close {
                    continue;
                }
                let mut broken = found.clone();
                fault(&mut broken, &other, &layout);
                let problems = problems(&broken, exactness);
                let begin = format!("{about}:");
                assert!(problems.iter().any(|problem| problem.starts_with(&begin)), "{name}: {problems:?}");
            }
            let mut broken = found.clone();
            broken.positions[40].x += 1.0;
            assert!(problems(&broken, exactness).iter().any(|problem| problem.starts_with("positions")));
            broken.positions[40].x = POISONED;
            assert!(problems(&broken, exactness).iter().any(|problem| problem.starts_with("positions")));
            broken.nodes = None;
            assert!(problems(&broken, exactness).iter().any(|problem| problem.starts_with("nodes exist: false")));
        }
        let mut broken = found.clone();
        broken.positions[41].y = broken.positions[41].y.next_up();
        assert!(!problems(&broken, Exactness::Bits).is_empty());
        let none = ClusterSetting { hierarchy: HierarchyBy::None, ..setting };
        assert_eq!(on_cpu(&cpu, &none, &layout, &CAMERA, &samples).nodes, None);
    }
}
