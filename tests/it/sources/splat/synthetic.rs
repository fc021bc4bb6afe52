//! Runs of photon splatting with known content, row by row.

use crate::fakes;
use rtbench::device::DeviceType;
use rtbench::record::journal::{Journal, JournalWriter, Record};
use rtbench::record::row::{Input, Key, Metric, Row, Samples, Settings, Status, TimingSource, Value};
use rtbench::record::run::End;
use rtbench::sources::runs::RecordedRun;
use rtbench::workloads::trace::record::TraceJournal;
use std::path::Path;

/// What the three frames of a row are of its mean.
pub const FRAMES: [f64; 3] = [0.9, 1.0, 1.1];

/// A run on a discrete GPU, to be filled.
pub struct Builder {
    pub general: Journal,
    /// Noise of times in percent.
    pub noise: f64,
}

/// Stages of a technique with the milliseconds that the thesis printed for their groups.
fn stages(technique: &str) -> Vec<(&'static str, f64)> {
    let mut stages = vec![("hit-1", 0.4), ("hit-2", 0.4), ("hit-3", 0.4), ("hit-4", 0.4), ("compaction", 0.1)];
    stages.extend([("samples", 0.3), ("direct", 0.3)]);
    if matches!(technique, "per-sample" | "buckets") {
        stages.extend([("keys", 0.2), ("unique", 0.2), ("bounds", 2.0), ("hierarchy", 1.0)]);
    }
    match technique {
        "per-sample" => {
            stages.extend([("count", 7.0), ("offsets", 0.5), ("fill", 7.4), ("estimate", 68.0), ("mix", 0.7)])
        }
        "buckets" => stages.extend([("scale", 0.1), ("buckets", 13.0), ("estimate", 0.3), ("mix", 0.1)]),
        _ => stages.extend([("estimate", 900.0), ("mix", 0.1)]),
    }
    stages
}

/// Axes with the values that nothing changes; those without effect are empty here and absent from rows.
fn axes(technique: &str) -> Vec<(&'static str, &'static str)> {
    let of = |is: bool, value: &'static str| if is { value } else { "" };
    let (lists, buckets) = (technique == "per-sample", technique == "buckets");
    let clusters = lists || buckets;
    vec![
        ("technique", ""),
        ("kernel", of(!buckets, "epanechnikov")),
        ("weight", of(!buckets, "side")),
        ("form", ""),
        ("order", of(lists, "any")),
        ("tasks", of(lists, "sample")),
        ("atomics", of(buckets, "fixed")),
        ("share", of(buckets, "all")),
        ("blur", of(buckets, "0")),
        ("level", of(buckets, "5")),
        ("light", ""),
        ("camera_path", "nave"),
        ("structure", "bvh-stack"),
        ("paths", "5667"),
        ("hits", "4"),
        ("seed", "1"),
        ("radius", "0.1"),
        ("falloff", "square"),
        ("energy", "flux"),
        ("tile", of(clusters || technique == "tiled", "8")),
        ("key", of(clusters, "morton")),
        ("normals", of(clusters, "off")),
        ("unique", of(clusters, "flags")),
        ("bounds", of(clusters, "direct")),
        ("hierarchy", of(clusters, "masks")),
        ("space", of(clusters, "view")),
        ("capacity", of(lists, "33554432")),
        ("sync", of(clusters, "device")),
        ("resolution", "480x270"),
        ("frames", "3"),
    ]
}

/// Counts of a row: those of Dabrovic's Sponza at a radius of a tenth.
fn metrics(technique: &str) -> Vec<Metric> {
    let mut metrics = vec![
        Metric::new("photons", 14_673u64),
        Metric::new("samples", 129_600u64),
        Metric::new("irradiance_mean", 1.25),
        Metric::new("path_traced_mean", 1.5),
        Metric::new("path_traced_error_pct", 0.25),
        Metric::new("ratio_to_path_traced", 0.875),
        Metric::new("rmse", 0.5),
        Metric::new("best_scale", 1.125),
        Metric::new("rmse_scaled", 0.375),
        Metric::new("buffer_bytes", 64_000_000u64),
        Metric::of("positions of photons", "bytes", 240_000u64),
    ];
    for (hit, arrived) in [5600u64, 5400, 5100, 4800].iter().enumerate() {
        metrics.push(Metric::of(&format!("hit-{}", hit + 1), "arrived", *arrived));
    }
    if !matches!(technique, "per-sample" | "buckets") {
        metrics.push(Metric::new("distance_tests", 14_673u64 * 129_600));
        return metrics;
    }
    metrics.extend([
        Metric::new("clusters_mean", 6500.0),
        Metric::new("clusters_max", 6600u64),
        Metric::new("assignments_mean", 3_900_000.0),
        Metric::new("assignments_max", 4_290_000u64),
        Metric::new("fullest_cluster", 1400u64),
        Metric::new("fullest_cluster_mean", 1350.0),
        Metric::new("box_tests_mean", 7_100_000.0),
        Metric::new("inner_nodes_mean", 975.0),
        Metric::new("atomics_bounds_mean", 777_600.0),
        Metric::new("source_bytes", 60_000_000u64),
        Metric::of("source-flags", "bytes", 4u64 << 23),
        Metric::of("source-nodes", "bytes", 28u64 * 270_601),
        Metric::of("source-clusters", "bytes", 28u64 * 6600),
        Metric::of("identifiers by key", "bytes", 4u64 << 23),
        Metric::new("key_bits", 23u64),
    ]);
    if technique == "per-sample" {
        metrics.push(Metric::new("photon_evaluations_mean", 79_000_000.0));
        metrics.push(Metric::of("source-lists", "bytes", 4 * 33_554_432u64));
    } else {
        metrics.push(Metric::new("bucket_directions_mean", 54.0 * 129_600.0));
        metrics.push(Metric::of("source-buckets", "bytes", 648u64 * 6600));
    }
    for (frame, factor) in FRAMES.iter().enumerate() {
        let part = format!("frame-{}", frame + 1);
        let of = |mean: f64| (mean * factor).round() as u64;
        metrics.push(Metric::of(&part, "clusters", of(6500.0)));
        metrics.push(Metric::of(&part, "assignments", of(3_900_000.0)));
        metrics.push(Metric::of(&part, "evaluations", of(79_000_000.0)));
    }
    for (level, nodes) in [1.0, 6.0, 40.0, 210.0, 718.0].iter().enumerate() {
        metrics.push(Metric::of(&format!("level-{level}"), "nodes", *nodes));
    }
    for (bin, clusters) in ["0", "1-9", "10-31", "32-99", "100-315", "316-999", "1000-3161"].iter().zip(1u64..) {
        metrics.push(Metric::of(&format!("photons-{bin}"), "clusters", 100 * clusters));
    }
    metrics
}

impl Builder {
    pub fn new() -> Builder {
        let mut provenance = fakes::provenance();
        provenance.workload = "splat".into();
        provenance.devices[0].info.name = "Fast GPU".into();
        provenance.devices[0].info.device_type = DeviceType::DiscreteGpu;
        let end = End {
            ended: "later".into(),
            interrupted: false,
            complete: true,
            load_average: [0.0; 3],
            message: "".into(),
        };
        let (inputs, artifacts, rows, resumed) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let general =
            Journal { provenance, inputs, artifacts, rows, resumed, end: Some(end), truncated: None, length: 0 };
        Builder { general, noise: 0.0 }
    }

    /// The same on a device that computes on the CPU.
    pub fn software() -> Builder {
        let mut b = Builder::new();
        b.general.provenance.devices[0].info.device_type = DeviceType::SoftwareRasteriser;
        b
    }

    /// A row of `TECHNIQUE` and words `AXIS=VALUE`. The named stages take other times than the usual ones.
    pub fn row(&mut self, scene: &str, setting: &str, times: &[(&str, f64)]) -> &mut Row {
        let mut words = setting.split(' ');
        let technique = words.next().unwrap();
        let mut key = Key { workload: "splat".into(), ..Key::default() };
        let known = axes(technique);
        let with_effect = known.iter().filter(|(_, value)| !value.is_empty());
        key.axes = with_effect.map(|(name, value)| ((*name).into(), (*value).into())).collect();
        key.axes.insert("technique".into(), technique.into());
        key.axes.insert("scene".into(), scene.into());
        for (axis, value) in words.filter_map(|word| word.split_once('=')) {
            assert!(known.iter().any(|(name, _)| *name == axis), "no axis {axis}");
            key.axes.insert(axis.into(), value.into());
        }
        key.inputs.insert("scene".into(), format!("hash of {scene}"));
        if !self.general.inputs.iter().any(|input| input.name == scene) {
            let (kind, name, hash) = ("scene".into(), scene.into(), format!("hash of {scene}"));
            self.general.inputs.push(Input { kind, name, hash, metrics: Vec::new() });
        }
        let settings = Settings { passes: 3, warmup_frames: 1, builds: 1, threads: 0 };
        let mut row = Row::new(key, settings, 0);
        row.status = Status::Ok;
        row.timing_source = Some(TimingSource::Device);
        let mut stages = stages(technique);
        for (name, ms) in times {
            stages.iter_mut().find(|(stage, _)| stage == name).unwrap_or_else(|| panic!("no stage {name}")).1 = *ms;
        }
        let ns = |factor: f64| stages.iter().map(|(_, ms)| (1e6 * ms * factor).round() as u64).collect::<Vec<_>>();
        let noise = self.noise / 100.0;
        let pass = |factor: f64| FRAMES.map(|frame| ns(frame * factor)).to_vec();
        let stage_ns: Vec<Vec<Vec<u64>>> = [1.0 - noise, 1.0, 1.0 + noise].map(pass).into();
        let sums: Vec<Vec<u64>> = stage_ns.iter().map(|p| p.iter().map(|frame| frame.iter().sum()).collect()).collect();
        row.samples = Some(Samples {
            stages: stages.iter().map(|(name, _)| (*name).to_owned()).collect(),
            device_ns: Some(sums.clone()),
            stage_ns: Some(stage_ns),
            wall_ns: sums,
            pass_ns: vec![1; 3],
        });
        row.metrics = metrics(technique);
        self.general.rows.push(row);
        self.general.rows.last_mut().unwrap()
    }

    pub fn run(self) -> RecordedRun {
        RecordedRun { journal: TraceJournal::new(&self.general), general: self.general, folder: "nowhere".into() }
    }
}

/// Gives a metric of a row another value, or adds it.
pub fn set(row: &mut Row, name: &str, value: impl Into<Value>) {
    row.metrics.retain(|metric| metric.name != name || metric.of.is_some());
    row.metrics.push(Metric::new(name, value));
}

/// The same for a metric of a part.
pub fn set_part(row: &mut Row, part: &str, name: &str, value: impl Into<Value>) {
    row.metrics.retain(|metric| metric.name != name || metric.of.as_deref() != Some(part));
    row.metrics.push(Metric::of(part, name, value));
}

/// Both techniques in both scenes at two radii, every option that claims ask for, and a row that failed.
pub fn everything() -> RecordedRun {
    let mut b = Builder::new();
    for scene in ["sponza", "sibenik", "box"] {
        for radius in ["0.1", "0.03"] {
            for technique in ["per-sample", "buckets", "reference"] {
                b.row(scene, &format!("{technique} radius={radius}"), &[]);
            }
        }
    }
    for option in ["unique=sort", "unique=bits", "bounds=two-step", "key=concat", "normals=faces", "sync=readback"] {
        b.row("sponza", &format!("per-sample {option}"), &[]);
    }
    b.row("sponza", "per-sample tile=16", &[]);
    b.row("sponza", "per-sample paths=20000", &[]);
    b.row("sponza", "buckets paths=20000", &[]);
    b.row("sponza", "buckets blur=4", &[]);
    let row = b.row("sibenik", "per-sample capacity=1000", &[]);
    row.refuse(Status::Failed, "overflow: 3,900,000 entries, the capacity is 1,000");
    b.run()
}

/// A run's folder as the workload leaves it.
pub fn write_run(run: &RecordedRun, folder: &Path) {
    let journal = &run.general;
    let mut writer = JournalWriter::create(folder, journal.provenance.clone()).unwrap();
    journal.inputs.iter().for_each(|input| writer.append(&Record::Input(Box::new(input.clone()))).unwrap());
    journal.rows.iter().for_each(|row| writer.append(&Record::Row(Box::new(row.clone()))).unwrap());
    writer.write(&Record::End(journal.end.clone().unwrap())).unwrap();
}
