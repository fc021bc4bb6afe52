//! Runs with known content, built record by record.

use crate::fakes;
use rtbench::device::DeviceType;
use rtbench::record::row::{Samples, Status, TimingSource};
use rtbench::record::run::End;
use rtbench::sources::runs::RecordedRun;
use rtbench::workloads::trace::rays::Config;
use rtbench::workloads::trace::record::{ConfigurationRecord, CounterSums, SceneRecord, StructureRecord, TraceJournal};

/// A run on a discrete GPU, to be filled.
pub struct Builder {
    pub run: RecordedRun,
    /// Noise of frame times in percent.
    pub noise: f64,
}

pub fn scene(name: &str) -> SceneRecord {
    let (name, triangles, vertices, mirror_share) = match name {
        "bunny" => ("bun_zipper", 69_451, 35_947, 0.0),
        "dragon" => ("dragon_vrip", 871_414, 437_645, 0.0),
        "robots" => ("robots", 71_708, 136_640, 0.1),
        "museum" => ("museum", 14_380, 17_889, 0.2),
        "conference" => ("conference", 207_512, 229_642, 0.05),
        other => (other, 5000, 2500, 0.0),
    };
    SceneRecord { name: name.into(), triangles, vertices, lights: 1, mirror_share, ..SceneRecord::default() }
}

impl Builder {
    pub fn new() -> Builder {
        let mut provenance = fakes::provenance();
        provenance.devices[0].info.name = "Fast GPU".into();
        provenance.devices[0].info.device_type = DeviceType::DiscreteGpu;
        let end = End {
            ended: "later".into(),
            interrupted: false,
            complete: true,
            load_average: [0.0; 3],
            message: "".into(),
        };
        let (structures, configurations) = (Vec::new(), Vec::new());
        let journal =
            TraceJournal { provenance, structures, configurations, resumed: vec![], end: Some(end), truncated: None };
        Builder { run: RecordedRun { journal, folder: "nowhere".into() }, noise: 0.0 }
    }

    pub fn device(mut self, name: &str, kind: DeviceType) -> Builder {
        self.run.journal.provenance.devices[0].info.name = name.into();
        self.run.journal.provenance.devices[0].info.device_type = kind;
        self
    }

    /// A measurement whose mean frame takes `ms`, the fastest 10 % less, the slowest 10 % more.
    pub fn frame(
        &mut self,
        name: &str,
        structure: &str,
        config: Config,
        side: u32,
        ms: f64,
    ) -> &mut ConfigurationRecord {
        let (structure, variant) = structure.split_once(':').unwrap_or((structure, "default"));
        let ns = |factor: f64| [0.9, 1.1].map(|f| (1e6 * ms * f * factor) as u64).to_vec();
        let noise = self.noise / 100.0;
        let passes = vec![ns(1.0 - noise), ns(1.0), ns(1.0 + noise)];
        self.run.journal.configurations.push(ConfigurationRecord {
            scene: scene(name),
            structure: structure.into(),
            variant: variant.into(),
            width: side,
            height: side,
            frames: 2,
            passes: 3,
            status: Status::Ok,
            verified: true,
            counters: Some([sums(10, 10), sums(20, 10), sums(30, 10)]),
            timing_source: Some(TimingSource::Wall),
            samples: Some(Samples { pass_ns: vec![1; 3], wall_ns: passes, ..Samples::default() }),
            ..ConfigurationRecord::new(config)
        });
        self.run.journal.configurations.last_mut().unwrap()
    }

    /// Grid, kd-tree and BVH at once.
    pub fn trio(&mut self, name: &str, config: Config, side: u32, [grid, kdtree, bvh]: [f64; 3]) {
        let grid_name = if name == "robots" { "grid:x=128" } else { "grid" };
        self.frame(name, grid_name, config, side, grid);
        self.frame(name, "kdtree", config, side, kdtree);
        self.frame(name, "bvh", config, side, bvh);
    }

    /// A built structure: build time, size in MiB, and for grids the cells on every side.
    pub fn built(&mut self, name: &str, structure: &str, ms: f64, mib: f64, cells: u32) -> &mut StructureRecord {
        let (structure, variant) = structure.split_once(':').unwrap_or((structure, "default"));
        let mut record = StructureRecord {
            scene: scene(name),
            structure: structure.into(),
            variant: variant.into(),
            build_ms: ms,
            build_threads: 1,
            ..StructureRecord::default()
        };
        record.memory.thesis_bytes = (mib * f64::from(1 << 20)) as u64;
        record.memory.structure_bytes = record.memory.thesis_bytes;
        let p = &mut record.properties;
        match structure {
            "grid" => (p.cells_x, p.cells_y, p.cells_z) = (Some(cells), Some(2 * cells), Some(3 * cells)),
            _ => (p.leaves, p.nodes) = (Some(7), Some(13)),
        }
        p.references_per_triangle = Some(9.0);
        p.max_cell_triangles = (structure == "grid").then_some(1000);
        self.run.journal.structures.push(record);
        self.run.journal.structures.last_mut().unwrap()
    }
}

/// A hundred rays with so many steps and tests each.
pub fn sums(steps: u64, tests: u64) -> CounterSums {
    let (inner, leaves) = (60 * steps, 40 * steps);
    CounterSums { rays: 100, inner, leaves, tests: 100 * tests, pops: 500, restarts: 25, ..CounterSums::default() }
}

/// A bit of everything that tables, figures and claims can show.
pub fn everything() -> Vec<RecordedRun> {
    let mut first = Builder::new();
    for (name, grid) in
        [("bunny", "grid"), ("robots", "grid:x=128"), ("museum", "grid"), ("conference", "grid"), ("hall", "grid")]
    {
        first.built(name, grid, 10.0, 30.0, 16);
        first.built(name, "kdtree", 90.0, 20.0, 0);
        first.built(name, "bvh", 30.0, 10.0, 0);
        for (config, factor) in [(Config::P, 1.0), (Config::PS, 2.0), (Config::PSR, 3.0)] {
            if name == "bunny" && config == Config::PSR {
                continue;
            }
            for side in [256, 512, 1024] {
                let ms = factor * f64::from(side) / 100.0;
                first.trio(name, config, side, [3.0 * ms, 2.0 * ms, ms]);
            }
        }
    }
    for (structure, ms) in [
        ("grid:factor=2", 40.0),
        ("grid:factor=8", 36.0),
        ("kdtree:search=restart", 60.0),
        ("bvh:shadows=to-light", 30.0),
    ] {
        first.frame("bunny", structure, Config::P, 1024, ms);
    }
    first.built("bunny", "grid:factor=2", 10.0, 30.0, 8);
    first.built("bunny", "grid:factor=8", 10.0, 30.0, 32);
    for side in [256, 300, 400] {
        first.frame("bunny", "bvh:pattern=four", Config::P, side, f64::from(side) / 50.0);
        first.frame("bunny", "bvh:tiles=2", Config::P, side, f64::from(side) / 40.0);
        first.frame("bunny", "bvh:tiles=4", Config::P, side, f64::from(side) / 30.0);
    }
    first.frame("museum", "kdtree:memory=private", Config::PSR, 1024, 45.0);
    first.frame("museum", "grid:group=16x4", Config::PSR, 1024, 99.0);
    let mut second = Builder::new().device("Slow GPU", DeviceType::IntegratedGpu);
    second.trio("bunny", Config::P, 512, [60.0, 50.0, 40.0]);
    second.trio("museum", Config::PSR, 512, [60.0, 50.0, 40.0]);
    second.frame("museum", "bvh:group=32x2", Config::PSR, 512, 44.0);
    vec![first.run, second.run]
}
