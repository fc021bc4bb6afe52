//! Recorded rows, in groups that share everything but the structure.

use super::break_even::Cost;
use crate::sources::rows::{Device, Devices, Failure, Frame, Variant, choose_frames};
use crate::sources::runs::{RecordedRun, with_traces};
use crate::workloads::trace::backend::Config;
use crate::workloads::trace::record::{ConfigurationRecord, CounterSums, StructureRecord};

/// Structures that no other source has.
const OWN: [&str; 7] = ["bvh-quantised", "bvh4", "bvh8", "cwbvh", "bvh-stackless", "bvh-subgroup", "query"];

/// What is known of a structure in a group.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Name with its options.
    pub name: String,
    /// Mean frame time in milliseconds.
    pub frame_ms: f64,
    /// Spread of frame times over passes in percent; `None` after a single pass.
    pub noise_pct: Option<f64>,
    /// 10^6 rays of all types per second.
    pub mrays_per_s: f64,
    /// Build time in milliseconds, without the upload; that of the driver's own structure is in it.
    pub build_ms: f64,
    /// Threads that built it; 0 where the device did.
    pub build_threads: usize,
    /// Milliseconds of the upload; `None` where it was not measured.
    pub upload_ms: Option<f64>,
    /// Bytes of the structure on the device, for each triangle of the scene; triangles in leaf order are in it. `None`
    /// for the driver's own structure, whose size is not told.
    pub bytes_per_triangle: Option<f64>,
    /// Expected cost of a ray by the surface-area heuristic; `None` for a structure without it.
    pub sah_cost: Option<f64>,
    /// Counts of all rays; `None` where only rays were counted.
    pub counts: Option<CounterSums>,
}

/// Rows of one scene, path, ray configuration and size on one device.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Index of the device.
    pub device: usize,
    /// Scene.
    pub scene: String,
    /// Ray configuration.
    pub config: Config,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Most rays per second first.
    pub entries: Vec<Entry>,
    /// What has no result, and why.
    pub failures: Vec<String>,
}

/// All numbers of runs.
#[derive(Clone, Debug, Default)]
pub struct Data {
    /// Devices, in the order of the runs.
    pub devices: Vec<Device>,
    /// In the order of the runs.
    pub groups: Vec<Group>,
    /// What a reader should know about the runs as a whole.
    pub notes: Vec<String>,
}

/// True if a run has rows of structures or rays that belong to no other source.
pub fn has_rows(run: &RecordedRun) -> bool {
    let is_own = |row: &ConfigurationRecord| OWN.contains(&row.structure.as_str());
    run.journal.configurations.iter().any(is_own)
}

impl Entry {
    /// What it costs to build, upload and trace it.
    pub fn cost(&self) -> Cost {
        Cost { build_ms: self.ready_ms(), mrays_per_s: self.mrays_per_s }
    }

    /// Milliseconds until the first ray can be traced.
    pub fn ready_ms(&self) -> f64 {
        self.build_ms + self.upload_ms.unwrap_or(0.0)
    }
}

impl Group {
    /// Rows in words, without the device.
    pub fn title(&self) -> String {
        format!("{}, {:?}, {}x{}", self.scene, self.config, self.size.0, self.size.1)
    }
}

impl Data {
    /// Everything that runs have measured. Of several measurements of the same, the last one counts.
    pub fn of(runs: &[RecordedRun]) -> Data {
        let (mut data, mut devices) = (Data::default(), Devices::default());
        let mut rows = Vec::new();
        for run in with_traces(runs) {
            let known = devices.add(&run.journal.provenance);
            for record in &run.journal.configurations {
                let Some(&(device, info)) = known.get(record.device) else { continue };
                let scene = record.scene.name.clone();
                match Frame::of(device, scene.clone(), info, record) {
                    Some(frame) => rows.push((frame, (record, structure_of(run, record)))),
                    None => data.fail(Failure::of(device, scene, record)),
                }
            }
            data.notes.extend(run.notes());
        }
        data.devices = devices.named();
        let (rows, notes) = choose_frames(rows, &data.devices);
        data.notes.extend(notes);
        for (frame, (record, structure)) in rows {
            if let Some(entry) = entry(&frame, record, structure) {
                let group = data.group((frame.device, frame.scene, frame.config, (frame.width, frame.height)));
                group.entries.retain(|known| known.name != entry.name);
                group.entries.push(entry);
            }
        }
        for group in &mut data.groups {
            group.entries.sort_by(|a, b| b.mrays_per_s.total_cmp(&a.mrays_per_s).then_with(|| a.name.cmp(&b.name)));
        }
        data
    }

    fn fail(&mut self, failure: Failure<String>) {
        let size = (failure.width, failure.height);
        let name = name_of(&failure.structure, &failure.variant);
        let group = self.group((failure.device, failure.scene, failure.config, size));
        group.failures.push(format!("{name}: {}", failure.message));
    }

    fn group(&mut self, place: (usize, String, Config, (u32, u32))) -> &mut Group {
        let is = |group: &Group| {
            (group.device, &group.scene, group.config, group.size) == (place.0, &place.1, place.2, place.3)
        };
        let index = self.groups.iter().position(is).unwrap_or_else(|| {
            let (device, scene, config, size) = place.clone();
            self.groups.push(Group { device, scene, config, size, entries: Vec::new(), failures: Vec::new() });
            self.groups.len() - 1
        });
        &mut self.groups[index]
    }
}

fn name_of(structure: &str, variant: &Variant) -> String {
    if variant.is_default() { structure.to_owned() } else { format!("{structure}:{variant}") }
}

/// What was built for a row.
fn structure_of<'a>(run: &'a RecordedRun, row: &ConfigurationRecord) -> Option<&'a StructureRecord> {
    let is_of = |built: &&StructureRecord| {
        built.scene.hash == row.scene.hash && built.structure == row.structure && built.variant == row.variant
    };
    run.journal.structures.iter().rfind(is_of)
}

fn entry(frame: &Frame<String>, record: &ConfigurationRecord, structure: Option<&StructureRecord>) -> Option<Entry> {
    let counters = record.counters.as_ref()?;
    let counts = counters.iter().fold(CounterSums::default(), |sum, of_type| sum.with(of_type));
    let total_ms = record.frame_statistics()?.total_ms;
    if counts.rays == 0 || total_ms <= 0.0 {
        return None;
    }
    let triangles = record.scene.triangles.max(1) as f64;
    let of_driver = structure.and_then(|built| built.driver_build_ms);
    let leaf_order = structure.and_then(|built| built.leaf_order_bytes).unwrap_or_default();
    Some(Entry {
        name: name_of(&frame.structure, &frame.variant),
        frame_ms: frame.mean_ms,
        noise_pct: frame.noise_pct,
        mrays_per_s: counts.rays as f64 / total_ms / 1e3,
        build_ms: structure.map_or(record.build_ms, |built| built.build_ms) + of_driver.unwrap_or_default(),
        build_threads: structure.map_or(record.build_threads, |built| built.build_threads),
        upload_ms: structure.and_then(|built| built.upload_ms),
        bytes_per_triangle: of_driver
            .is_none()
            .then_some((record.memory.structure_bytes + leaf_order) as f64 / triangles),
        sah_cost: structure.and_then(|built| built.properties.sah_cost),
        counts: (counts.tests > 0).then_some(counts),
    })
}
