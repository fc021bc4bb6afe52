//! Runs of spheres with known content, row by row.

use crate::fakes;
use rtbench::device::DeviceType;
use rtbench::record::journal::{Journal, JournalWriter, Record};
use rtbench::record::row::{Input, Key, Metric, Row, Samples, Settings, Status, TimingSource};
use rtbench::record::run::End;
use rtbench::sources::runs::RecordedRun;
use rtbench::workloads::trace::record::TraceJournal;
use std::path::Path;

/// Renderers as [`Builder::row`] takes them.
pub const RENDERERS: [&str; 5] = ["sequential", "threads", "simd:4", "simd-threads:4", "gpu"];

/// The paper's versions in the same form.
pub const STAGES: [&str; 3] = ["two-pass", "one-pass exit", "one-pass exit nohit nodisc"];

/// A run on a processor of eight threads and a discrete GPU, to be filled.
pub struct Builder {
    pub general: Journal,
    /// Noise of frame times in percent.
    pub noise: f64,
}

impl Builder {
    pub fn new() -> Builder {
        let mut provenance = fakes::provenance();
        provenance.workload = "spheres".into();
        let mut cpu = provenance.devices[0].clone();
        cpu.info.name = "Test CPU".into();
        cpu.info.device_type = DeviceType::CpuTwin;
        cpu.info.backend = "cpu".into();
        cpu.info.driver = String::new();
        cpu.info.threads = Some(8);
        provenance.devices[0].info.name = "Fast GPU".into();
        provenance.devices[0].info.device_type = DeviceType::DiscreteGpu;
        provenance.devices.insert(0, cpu);
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

    /// A row whose mean frame takes `ms`. The setting is `RENDERER[:LANES] ALGORITHM` and words for switches: `exit`,
    /// `nohit`, `nodisc`, `index`, `f16`, `threads=N`, `level=L`.
    pub fn row(&mut self, scene: &str, setting: &str, ms: f64) -> &mut Row {
        let words: Vec<&str> = setting.split(' ').collect();
        let has = |word: &str| if words.contains(&word) { "on" } else { "off" };
        let value = |name: &str| words.iter().find_map(|w| w.strip_prefix(name)?.strip_prefix('=')).unwrap_or("");
        let (renderer, lanes) = words[0].split_once(':').unwrap_or((words[0], ""));
        let of_simd = |word| if lanes.is_empty() { "" } else { has(word) };
        let hit = match (renderer, has("index")) {
            ("gpu", _) => "",
            (_, "on") => "index",
            _ => "in-loop",
        };
        let precision = if has("f16") == "on" { "f16" } else { "f32" };
        let axes = [
            ("scene", scene),
            ("renderer", renderer),
            ("lanes", lanes),
            ("level", value("level")),
            ("threads", value("threads")),
            ("algorithm", words[1]),
            ("exit_on_miss", has("exit")),
            ("skip_no_hit", of_simd("nohit")),
            ("skip_no_discriminant", of_simd("nodisc")),
            ("hit", hit),
            ("precision", precision),
            ("trips", "5"),
            ("resolution", "64x32"),
            ("frames", "2"),
        ];
        let mut key = Key { workload: "spheres".into(), ..Key::default() };
        key.axes = axes.map(|(name, value)| (name.to_owned(), value.to_owned())).into();
        let spheres = self.scene(scene);
        key.inputs.insert("scene".into(), format!("hash of {scene}"));
        let settings = Settings { passes: 3, warmup_frames: 1, builds: 1, threads: 0 };
        let mut row = Row::new(key, settings, usize::from(renderer == "gpu"));
        row.status = Status::Ok;
        row.timing_source = Some(TimingSource::Wall);
        let noise = self.noise / 100.0;
        let ns = |factor: f64| [0.9, 1.1].map(|f| (1e6 * ms * f * factor).round() as u64).to_vec();
        let wall_ns = vec![ns(1.0 - noise), ns(1.0), ns(1.0 + noise)];
        row.samples = Some(Samples { pass_ns: vec![1; 3], wall_ns, ..Samples::default() });
        row.metrics = vec![
            Metric::new("rays", 3000u64),
            Metric::new("hits", 1000u64),
            Metric::new("tests", 3000 * spheres),
            Metric::new("wasted_tests", 1000 * spheres),
            Metric::new("exits_on_miss", 512u64),
            Metric::of("bounce-1", "rays", 2048u64),
            Metric::of("bounce-1", "hits", 952u64),
            Metric::of("bounce-2", "rays", 952u64),
            Metric::of("bounce-2", "hits", 48u64),
        ];
        if renderer != "gpu" {
            let threads = if renderer.contains("threads") { value("threads").parse().unwrap_or(8u64) } else { 1 };
            row.metrics.push(Metric::new("processor_threads", threads));
            row.metrics.push(Metric::new("instructions", if lanes.is_empty() { "x86_64 sse2" } else { "avx2" }));
        }
        if !lanes.is_empty() {
            row.metrics.push(Metric::new("vectors", 1000u64));
            row.metrics.push(Metric::new("occupancy", 0.75));
            row.metrics.push(Metric::new("skips_no_hit", 600 * spheres));
            row.metrics.push(Metric::new("skips_no_discriminant", 500 * spheres));
        }
        self.general.rows.push(row);
        self.general.rows.last_mut().unwrap()
    }

    /// The number of spheres of a scene, whose record is added with its first row.
    fn scene(&mut self, name: &str) -> u64 {
        let spheres = match name {
            "default" => 3,
            "random20" => 20,
            "random100" => 100,
            _ => name.split(['=', ',']).nth(1).and_then(|n| n.parse().ok()).unwrap_or(7),
        };
        if !self.general.inputs.iter().any(|input| input.name == name) {
            let metrics = vec![Metric::new("spheres", spheres)];
            let hash = format!("hash of {name}");
            self.general.inputs.push(Input { kind: "scene".into(), name: name.into(), hash, metrics });
        }
        spheres
    }

    /// A picture of half precision whose speed was not measured.
    pub fn half(&mut self, scene: &str, rmse: f64) -> &mut Row {
        let row = self.row(scene, "simd:4 one-pass exit nohit nodisc f16", 1.0);
        row.refuse(Status::Skipped, "speed not measured: half precision is emulated");
        row.metrics.extend([Metric::new("rmse", rmse), Metric::new("largest_difference", 8.0 * rmse)]);
        row
    }

    pub fn run(self) -> RecordedRun {
        RecordedRun { journal: TraceJournal::new(&self.general), general: self.general, folder: "nowhere".into() }
    }
}

/// All renderers in all versions on the paper's scenes, in its ratios; each switch on its own; threads, lanes, numbers
/// of spheres, and pictures of half precision.
pub fn everything() -> RecordedRun {
    let mut b = Builder::new();
    let printed: [(&str, [[f64; 3]; 5]); 3] = [
        (
            "default",
            [
                [1852.0, 550.0, 0.0],
                [350.0, 120.0, 0.0],
                [5918.0, 725.0, 375.0],
                [1192.0, 154.0, 80.0],
                [15.58, 10.77, 0.0],
            ],
        ),
        (
            "random20",
            [
                [8660.0, 2197.0, 0.0],
                [1530.0, 511.0, 0.0],
                [29896.0, 4130.0, 1604.0],
                [6303.0, 860.0, 330.0],
                [15.89, 10.69, 0.0],
            ],
        ),
        (
            "random100",
            [
                [38236.0, 17553.0, 0.0],
                [6987.0, 4162.0, 0.0],
                [116026.0, 26072.0, 12102.0],
                [23969.0, 7416.0, 2947.0],
                [51.48, 17.62, 0.0],
            ],
        ),
    ];
    for (scene, times) in printed {
        for (renderer, ms) in RENDERERS.iter().zip(times) {
            let stages = if renderer.contains(':') { 3 } else { 2 };
            for (stage, ms) in STAGES.iter().zip(ms).take(stages) {
                b.row(scene, &format!("{renderer} {stage}"), ms / 10.0);
            }
            // The exit on a miss is most of the gain; one pass alone gains a fifth of a vector's time
            if *renderer != "gpu" {
                let alone = if renderer.contains(':') { 1.25 } else { 1.0 };
                b.row(scene, &format!("{renderer} one-pass"), ms[0] / 10.0 / alone);
                b.row(scene, &format!("{renderer} two-pass exit"), ms[1] / 10.0 * alone);
                b.row(scene, &format!("{renderer} one-pass exit index"), ms[1] / 11.0);
            }
        }
        b.row(scene, "simd:4 one-pass exit nohit", times[2][1] / 15.0);
        b.row(scene, "simd:4 one-pass exit nodisc", times[2][1] / 12.0);
        b.row(scene, "simd:8 one-pass exit nohit nodisc index", times[0][1] / 50.0);
        b.row(scene, "simd:16 one-pass exit nohit nodisc index", times[0][1] / 60.0);
        b.half(scene, 0.05);
    }
    for threads in [1, 2, 4, 8] {
        let n = f64::from(threads);
        b.row("default", &format!("threads one-pass exit threads={threads}"), 58.0 / n.powf(0.8));
        b.row("default", &format!("simd-threads:4 one-pass exit nohit nodisc threads={threads}"), 40.0 / n.powf(0.9));
    }
    for spheres in [10, 1000] {
        let (scene, n) = (format!("random:spheres={spheres},seed=1"), f64::from(spheres));
        for renderer in RENDERERS {
            let stage = if renderer.contains(':') { STAGES[2] } else { STAGES[1] };
            b.row(&scene, &format!("{renderer} {stage}"), 2.0 * n);
        }
    }
    let mut failed = b.row("random20", "gpu two-pass exit", 1.0).clone();
    failed.refuse(Status::Failed, "device lost");
    *b.general.rows.last_mut().unwrap() = failed;
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
