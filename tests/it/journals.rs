//! Journals of any number of rows with known content, as a sweep would write them.

#![allow(dead_code)] // the bench uses a part

use rtbench::device::{DeviceInfo, DeviceType, KernelInfo};
use rtbench::harness::environment;
use rtbench::record::journal::{FILE_NAME, Record};
use rtbench::record::row::{Artifact, Check, Input, Key, Metric, Row, SCHEMA, Samples, Settings, Status, TimingSource};
use rtbench::record::run::{DeviceRecord, End, Environment, PlanRecord, Provenance};
use std::io::Write;
use std::path::Path;

/// What rows of a generated journal have.
#[derive(Clone, Debug)]
pub struct Generated {
    /// Number of rows.
    pub rows: usize,
    /// Nanoseconds of each pass over a frame, before a row's own factor.
    pub passes_ns: Vec<u64>,
    /// Nodes that every ray visits.
    pub inner: u64,
    /// Hash of every picture.
    pub image: String,
}

impl Generated {
    /// So many rows.
    pub fn new(rows: usize) -> Generated {
        Generated { rows, passes_ns: vec![2_000_000, 2_010_000, 2_020_000], inner: 600, image: "1".repeat(64) }
    }
}

const STRUCTURES: [&str; 5] = ["grid", "kdtree", "bvh", "bvh-stack", "ploc-stack"];
const CONFIGS: [&str; 3] = ["P", "PS", "PSR"];
const SETTINGS: Settings = Settings { passes: 3, warmup_frames: 1, builds: 1, threads: 0 };

fn provenance(rows: usize) -> Provenance {
    let info = DeviceInfo {
        name: "A device".into(),
        device_type: DeviceType::DiscreteGpu,
        backend: "vulkan".into(),
        driver: "driver 1".into(),
        timestamp_period_ns: Some(1.0),
        checked: false,
        features: Vec::new(),
        limits: Default::default(),
        threads: None,
    };
    Provenance {
        merged: Vec::new(),
        schema: SCHEMA.into(),
        id: "0123456789abcdef".into(),
        workload: "sweep".into(),
        program: environment::program(),
        started: "2026-01-02T03:04:05Z".into(),
        arguments: vec!["rtbench".into(), "sweep".into()],
        devices: vec![DeviceRecord { info, reason: "a test".into() }],
        environment: Environment::default(),
        plan: PlanRecord { preset: "quick".into(), rows, settings: SETTINGS, ..PlanRecord::default() },
    }
}

fn scene_name(scene: usize) -> String {
    format!("scan:triangles={}", 1000 + scene)
}

fn row(generated: &Generated, index: usize) -> Row {
    let scene = index / 30;
    let structure = STRUCTURES[index % 5];
    let config = CONFIGS[index / 5 % 3];
    let resolution = ["64x64", "128x128"][index / 15 % 2];
    let axes = [
        ("scene", scene_name(scene)),
        ("structure", structure.into()),
        ("config", config.into()),
        ("resolution", resolution.into()),
        ("camera_path", "orbit".into()),
        ("frames", "2".into()),
        ("build", String::new()),
        ("traversal", String::new()),
        ("ray_options", String::new()),
        ("device_options", String::new()),
    ];
    let inputs = [("scene", format!("{scene:064x}")), ("camera_path", "c".repeat(64))];
    let key = Key {
        workload: "sweep".into(),
        axes: axes.map(|(axis, value)| (axis.to_owned(), value)).into(),
        inputs: inputs.map(|(kind, hash)| (kind.to_owned(), hash)).into(),
    };
    let mut row = Row::new(key, SETTINGS, 0);
    row.status = Status::Ok;
    row.metrics =
        vec![Metric::new("nodes", 1000 + scene), Metric::new("build_ms", 1.25), Metric::new("dispatches", 1u64)];
    for ray in ["primary", "shadow", "reflected"] {
        let counts =
            [("rays", 100), ("inner", generated.inner), ("leaves", 150), ("tests", 10), ("pops", 1), ("restarts", 0)];
        row.metrics.extend(counts.map(|(name, value)| Metric::of(ray, name, value)));
    }
    let check = Check {
        ok: true,
        message: "4080 primary rays agree with the reference and the twin's counters".into(),
        metrics: (0..11).map(|i| Metric::new(&format!("fact_{i}"), i as u64)).collect(),
    };
    row.checks = vec![check.clone(), check.clone(), check];
    row.outputs = [("image".to_owned(), generated.image.clone())].into();
    row.kernels = vec![KernelInfo { hash: "0123456789abcdef".into(), fetch: "buffers".into(), checked: false }];
    row.timing_source = Some(TimingSource::Device);
    // A row's own size, so that rows can be told apart
    let factor = 1 + index as u64 % 7;
    let passes: Vec<Vec<u64>> = generated.passes_ns.iter().map(|ns| vec![ns * factor, ns * factor]).collect();
    row.samples = Some(Samples {
        device_ns: Some(passes.clone()),
        wall_ns: passes,
        pass_ns: generated.passes_ns.clone(),
        ..Samples::default()
    });
    row.interleaved_with = 5;
    row
}

/// Writes a run's folder with its journal; `edit` changes rows before they are written.
pub fn write_with(folder: &Path, generated: &Generated, mut edit: impl FnMut(&mut Row)) {
    std::fs::create_dir_all(folder).unwrap();
    let file = std::fs::File::create(folder.join(FILE_NAME)).unwrap();
    let mut file = std::io::BufWriter::new(file);
    let mut write = |record: &Record| {
        serde_json::to_writer(&mut file, record).unwrap();
        file.write_all(b"\n").unwrap();
    };
    write(&Record::Run(Box::new(provenance(generated.rows))));
    let input = |kind: &str, name: String, hash: String| {
        let metrics = vec![Metric::new("triangles", 1000u64), Metric::new("vertices", 500u64)];
        Record::Input(Box::new(Input { kind: kind.into(), name, hash, metrics }))
    };
    write(&input("camera_path", "orbit".into(), "c".repeat(64)));
    for index in 0..generated.rows {
        let row = row(generated, index);
        if index % 30 == 0 {
            write(&input("scene", row.key.axis("scene").into(), row.key.input("scene").into()));
            for structure in STRUCTURES {
                let mut key = row.key.clone();
                key.axes.retain(|axis, _| ["scene", "structure", "build", "traversal"].contains(&axis.as_str()));
                key.axes.insert("structure".into(), structure.into());
                key.inputs.remove("camera_path");
                let metrics = vec![Metric::new("nodes", 1000 + index / 30), Metric::new("build_ms", 1.25)];
                write(&Record::Artifact(Box::new(Artifact { key, metrics, note: String::new() })));
            }
        }
        let mut row = row;
        edit(&mut row);
        write(&Record::Row(Box::new(row)));
    }
    write(&Record::End(End {
        ended: "2026-01-02T04:04:05Z".into(),
        interrupted: false,
        complete: true,
        load_average: [0.0; 3],
        message: String::new(),
    }));
    file.flush().unwrap();
}

/// Writes a run's folder with its journal.
pub fn write(folder: &Path, generated: &Generated) {
    write_with(folder, generated, |_| {});
}
