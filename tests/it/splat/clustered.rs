//! Rows of techniques with clusters: options, counts, planted faults, overflows.

use super::rows::*;
use super::support::{Random, mutated};
use glam::Vec4;
use rtbench::harness::Plan;
use rtbench::harness::workload::Part;
use rtbench::record::row::{Row, Status};
use rtbench::workloads::splat::cluster_axes::AXES;
use rtbench::workloads::splat::clusters::{Clusters, NONE};
use rtbench::workloads::splat::{Fault, SPLAT, SplatCase, Stages};

/// A run of both techniques of the source.
const BOTH: (&str, &str) = ("technique", "per-sample,buckets");
const TILE: (&str, &str) = ("tile", "8");

fn integer(row: &Row, of: Option<&str>, name: &str) -> u64 {
    row.metric(of, name).and_then(|value| value.integer()).unwrap_or_else(|| panic!("no {name}: {:?}", row.metrics))
}

#[test]
fn axes_without_effect_are_refused_and_left_out() {
    for (axis, technique) in [("key", "reference"), ("tile", "reference"), ("capacity", "buckets"), ("sync", "tiled")] {
        let mut request = request(&[("technique", technique), (axis, if axis == "tile" { "8" } else { "1" })]);
        if ["key", "sync"].contains(&axis) {
            let value = if axis == "key" { "concat" } else { "readback" };
            request.values.insert(axis.into(), vec![value.into()]);
        }
        let error = Plan::new(&SPLAT, &request).map(drop).unwrap_err().to_string();
        assert!(error.contains(&format!("--{axis}")) && error.contains("no effect"), "{axis}: {error}");
    }
    let plan = Plan::new(&SPLAT, &request(&[("technique", "reference,tiled,per-sample,buckets"), TILE])).unwrap();
    let tiles: Vec<&str> = plan.cases.iter().map(|case| case.axis("tile")).collect();
    let keys: Vec<&str> = plan.cases.iter().map(|case| case.axis("key")).collect();
    assert_eq!(tiles, ["", "8", "8", "8"]);
    assert_eq!(keys, ["", "", "morton", "morton"]);
}

#[test]
fn values_that_cannot_be_are_refused_with_their_flag() {
    for (axis, value, problem) in [
        ("tile", "3", "give 4 to 64"),
        ("tile", "65", "give 4 to 64"),
        ("tile", "8px", "give 4 to 64"),
        ("key", "hilbert", "one of morton, concat"),
        ("normals", "on", "one of off, faces, cells"),
        ("unique", "set", "one of flags, sort, bits"),
        ("bounds", "atomic", "one of direct, two-step"),
        ("hierarchy", "bvh", "one of masks, none"),
        ("space", "light", "one of view, world"),
        ("capacity", "0", "give 1 to 33554432"),
        ("capacity", "33554433", "give 1 to 33554432"),
        ("sync", "host", "one of device, readback"),
    ] {
        let request = request(&[("technique", "per-sample"), (axis, value)]);
        let error = Plan::new(&SPLAT, &request).map(drop).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        let error = error.to_string();
        assert!(error.contains(&format!("--{axis}")) && error.contains(problem), "{axis}={value}: {error}");
    }
}

#[test]
fn mutated_values_are_read_as_they_are_written_or_refused_with_one_line() {
    let mut random = Random(20);
    let (mut read, mut refused) = (0, 0);
    assert!(AXES.iter().all(|axis| ORIGINALS.iter().any(|(known, _)| known == axis)));
    for (axis, original) in ORIGINALS {
        for _ in 0..200 {
            let mut part = Part::default();
            for (axis, value) in [("technique", "per-sample"), ("resolution", "64x36")] {
                part.values.insert(axis.into(), vec![value.into()]);
            }
            part.values.insert(axis.into(), vec![mutated(original, &mut random)]);
            match SplatCase::all(&part) {
                Ok(cases) => {
                    read += 1;
                    for case in cases {
                        assert_eq!(SplatCase::parse(&case.to_case("box")).unwrap(), case);
                    }
                }
                Err(error) => {
                    refused += 1;
                    assert!(!error.to_string().contains('\n'), "{error}");
                }
            }
        }
    }
    assert!(read > 50 && refused > 500, "{read} {refused}");
}

const ORIGINALS: [(&str, &str); 10] = [
    ("tile", "8"),
    ("key", "morton"),
    ("normals", "cells"),
    ("unique", "bits"),
    ("bounds", "two-step"),
    ("hierarchy", "none"),
    ("space", "view"),
    ("capacity", "33554432"),
    ("sync", "readback"),
    ("technique", "buckets:form=source,atomics=fixed,share=centre,kernel=constant,blur=3,level=4"),
];

#[test]
fn rows_of_both_techniques_have_counts_that_agree_on_every_device() {
    let mut counts = Vec::new();
    for device in devices() {
        let out = tempfile::tempdir().unwrap();
        let journal = measured(device, Faults::default(), &request(&[BOTH, TILE]), out.path());
        assert_eq!(journal.rows.len(), 2);
        let of_row = |row: &Row| {
            assert_eq!(row.status, Status::Ok, "{}", row.message);
            let frames = ["frame-1", "frame-2"].map(|frame| {
                ["clusters", "assignments", "fullest", "box_tests", "evaluations"]
                    .map(|name| integer(row, Some(frame), name))
            });
            assert!(frames.iter().flatten().all(|count| *count > 0));
            assert_eq!(integer(row, None, "assignments_max"), frames[0][1].max(frames[1][1]));
            let bins = row.metrics.iter().filter(|m| m.of.as_deref().is_some_and(|of| of.starts_with("photons-")));
            assert_eq!(bins.map(|m| m.value.integer().unwrap()).sum::<u64>(), frames[0][0]);
            frames
        };
        counts.push(journal.rows.iter().map(of_row).collect::<Vec<_>>());
        for end in ["-clusters", "-levels", "-photons-per-cluster", "-side-by-side"] {
            assert!(out.path().join(format!("pictures/box{end}.png")).is_file(), "{end}");
        }
        // Sums in any order have no bits of their own
        let hashes: Vec<bool> = journal.rows.iter().map(|row| row.outputs.contains_key("image")).collect();
        assert_eq!(hashes, [false, true]);
    }
    assert!(counts.windows(2).all(|pair| pair[0] == pair[1]), "{counts:?}");
}

fn clusters(stages: &mut Stages) -> &mut Clusters {
    stages.gathered.clusters.as_mut().unwrap()
}

/// Its name, the technique, and the change.
type Planted = (&'static str, &'static str, fn(&mut Stages));

const FAULTS: [Planted; 14] = [
    ("a flipped bit of a mask", "per-sample", |stages| {
        let masks = &mut clusters(stages).nodes.as_mut().unwrap().masks;
        *masks.iter_mut().rev().find(|mask| **mask != 0).unwrap() ^= 1 << 7;
    }),
    ("a box too small by a unit of the last place", "per-sample", |stages| {
        let bounds = &mut clusters(stages).boxes[0];
        bounds.max.x = bounds.max.x.next_down();
    }),
    ("a box of a node too small", "buckets", |stages| {
        let nodes = clusters(stages).nodes.as_mut().unwrap();
        let at = nodes.masks.iter().rposition(|mask| *mask != 0).unwrap();
        nodes.boxes[at].min.y = nodes.boxes[at].min.y.next_up();
    }),
    ("another key", "buckets", |stages| {
        *clusters(stages).keys.iter_mut().find(|key| **key != NONE).unwrap() ^= 1;
    }),
    ("identifiers of another frame", "per-sample", |stages| clusters(stages).identifiers.rotate_left(1)),
    ("a cluster too few", "per-sample", |stages| _ = clusters(stages).cluster_keys.pop()),
    ("a poisoned buffer", "buckets", |stages| {
        clusters(stages).positions.fill(Vec4::splat(f32::from_bits(rtbench::device::POISON)));
    }),
    ("a lost entry", "per-sample", |stages| _ = stages.gathered.lists.as_mut().unwrap().entries.pop()),
    ("a doubled entry", "per-sample:order=sorted", |stages| {
        let entries = &mut stages.gathered.lists.as_mut().unwrap().entries;
        entries[1] = entries[0];
    }),
    ("a wrong offset", "per-sample", |stages| stages.gathered.lists.as_mut().unwrap().offsets[1] += 1),
    ("a bucket too far", "buckets", |stages| {
        stages.gathered.buckets.as_mut().unwrap().words.rotate_right(3);
    }),
    ("swapped channels", "buckets", |stages| {
        stages.gathered.buckets.as_mut().unwrap().words.chunks_exact_mut(3).for_each(|words| words.rotate_left(1));
    }),
    ("an estimate once too often", "tiled", |stages| stages.irradiance.iter_mut().for_each(|v| *v *= 2.0)),
    ("a blur of other pixels", "buckets:blur=2", |stages| {
        stages.irradiance.rotate_left(1);
    }),
];

#[test]
fn what_is_wrong_with_clusters_is_a_row_before_anything_is_timed() {
    for (what, technique, stages) in FAULTS {
        let out = tempfile::tempdir().unwrap();
        let faults = Faults(Some(Fault { stages, timed: |_| () }));
        let request = request(&[("technique", technique), TILE]);
        let journal = measured(on_cpu(), faults, &request, out.path());
        let row = the_row(&journal);
        assert_eq!(row.status, Status::Wrong, "{what}: {}", row.message);
        assert!(row.samples.is_none(), "{what}");
    }
}

#[test]
fn what_does_not_fit_is_a_row_and_the_next_case_runs() {
    for device in devices() {
        let out = tempfile::tempdir().unwrap();
        let mut request = request(&[("technique", "per-sample"), TILE]);
        request.values.insert("capacity".into(), vec!["100".into(), "1000000".into()]);
        let journal = measured(device, Faults::default(), &request, out.path());
        let [first, second] = &journal.rows[..] else { panic!("{:?}", journal.rows) };
        assert_eq!(first.status, Status::Failed, "{}", first.message);
        assert!(first.message.contains("overflow") && first.message.contains("is 100"), "{}", first.message);
        assert_eq!(second.status, Status::Ok, "{}", second.message);
    }
}

#[test]
fn a_key_of_too_many_bits_is_skipped_with_both_numbers() {
    let out = tempfile::tempdir().unwrap();
    let request =
        request(&[("technique", "per-sample"), ("tile", "4"), ("normals", "cells"), ("resolution", "480x270")]);
    let journal = measured(on_cpu(), Faults::default(), &request, out.path());
    let row = the_row(&journal);
    assert_eq!(row.status, Status::Skipped, "{}", row.message);
    assert!(row.message.contains("at most 25") && row.message.contains("MiB"), "{}", row.message);
}
