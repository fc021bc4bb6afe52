//! Runs with known content, built record by record; each source has its own scenes and rows.

use crate::fakes;
use rtbench::device::DeviceType;
use rtbench::record::journal::{Journal, JournalWriter, Record};
use rtbench::record::row::{Samples, Status, TimingSource};
use rtbench::record::run::End;
use rtbench::sources::runs::RecordedRun;
use rtbench::workloads::trace::rays::Config;
use rtbench::workloads::trace::record::{
    ConfigurationRecord, CounterSums, SceneRecord, StructureRecord, TraceJournal, by_ray_type,
};
use std::path::Path;

/// A run on a discrete GPU, to be filled.
pub struct Builder {
    pub run: RecordedRun,
    /// Noise of frame times in percent.
    pub noise: f64,
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
        let general = Journal {
            provenance,
            inputs: Vec::new(),
            artifacts: Vec::new(),
            rows: Vec::new(),
            resumed: Vec::new(),
            end: Some(end),
            truncated: None,
            length: 0,
        };
        // Sources of ray tracing read typed rows: tests fill these
        let journal = TraceJournal::new(&general);
        Builder { run: RecordedRun { journal, general, folder: "nowhere".into() }, noise: 0.0 }
    }

    pub fn device(mut self, name: &str, kind: DeviceType) -> Builder {
        self.run.journal.provenance.devices[0].info.name = name.into();
        self.run.journal.provenance.devices[0].info.device_type = kind;
        self
    }

    /// A measurement whose mean frame takes `ms`, the fastest 10 % less, the slowest 10 % more.
    pub fn row(
        &mut self,
        scene: SceneRecord,
        structure: &str,
        config: Config,
        (width, height): (u32, u32),
        ms: f64,
    ) -> &mut ConfigurationRecord {
        let (structure, variant) = structure.split_once(':').unwrap_or((structure, "default"));
        let ns = |factor: f64| [0.9, 1.1].map(|f| (1e6 * ms * f * factor) as u64).to_vec();
        let noise = self.noise / 100.0;
        let passes = vec![ns(1.0 - noise), ns(1.0), ns(1.0 + noise)];
        self.run.journal.configurations.push(ConfigurationRecord {
            scene,
            structure: structure.into(),
            variant: variant.into(),
            width,
            height,
            frames: 2,
            passes: 3,
            status: Status::Ok,
            verified: true,
            counters: Some(by_ray_type([sums(10, 10), sums(20, 10), sums(30, 10)])),
            timing_source: Some(TimingSource::Wall),
            samples: Some(Samples { pass_ns: vec![1; 3], wall_ns: passes, ..Samples::default() }),
            ..ConfigurationRecord::new(config)
        });
        self.run.journal.configurations.last_mut().unwrap()
    }

    /// A structure that one thread built.
    pub fn structure(&mut self, scene: SceneRecord, structure: &str, ms: f64) -> &mut StructureRecord {
        let (structure, variant) = structure.split_once(':').unwrap_or((structure, "default"));
        self.run.journal.structures.push(StructureRecord {
            scene,
            structure: structure.into(),
            variant: variant.into(),
            build_ms: ms,
            build_threads: 1,
            ..StructureRecord::default()
        });
        self.run.journal.structures.last_mut().unwrap()
    }
}

/// A hundred rays with so many steps and tests each.
pub fn sums(steps: u64, tests: u64) -> CounterSums {
    let (inner, leaves) = (60 * steps, 40 * steps);
    CounterSums { rays: 100, inner, leaves, tests: 100 * tests, pops: 500, restarts: 25, ..CounterSums::default() }
}

/// A run's folder as a sweep leaves it.
pub fn write_run(run: &RecordedRun, folder: &Path) {
    let journal = &run.journal;
    let mut writer = JournalWriter::create(folder, journal.provenance.clone()).unwrap();
    journal.records().iter().for_each(|record| writer.write(record).unwrap());
    writer.write(&Record::End(journal.end.clone().unwrap())).unwrap();
}
