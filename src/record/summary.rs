//! `summary.csv`, `structures.csv` and `run.json`: pure functions of a journal.
//!
//! Both CSV files and the JSON are made of the same rows, whose fields are the columns in their order; units stand in
//! the names. Numbers are rounded once, here, so that all files say the same.

use crate::error::{Error, Result};
use crate::record::files;
use crate::record::journal::Journal;
use crate::record::schema::{
    ConfigurationRecord, CounterSums, End, Provenance, Resumed, Samples, SceneRecord, Status, StructureRecord,
    TimingSource,
};
use crate::record::statistics::{self, FrameStatistics};
use crate::workloads::trace::backend::{Config, DeviceInfo, DeviceType};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::path::Path;

/// One row of `summary.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)] // The names are the columns; the header of results/README.md explains each.
pub struct Row {
    pub device: String,
    pub device_type: DeviceType,
    pub scene: String,
    pub triangles: u64,
    pub structure: String,
    pub variant: String,
    pub config: Config,
    pub width: u32,
    pub height: u32,
    pub frames: usize,
    pub passes: usize,
    pub frame_ms_min: Option<f64>,
    pub frame_ms_max: Option<f64>,
    pub frame_ms_mean: Option<f64>,
    pub noise_pct: Option<f64>,
    pub timing_source: Option<TimingSource>,
    pub wall_ms_mean: Option<f64>,
    pub mrays_per_s: Option<f64>,
    pub primary_rays: Option<u64>,
    pub shadow_rays: Option<u64>,
    pub reflected_rays: Option<u64>,
    pub primary_steps_per_ray: Option<f64>,
    pub primary_tests_per_ray: Option<f64>,
    pub primary_restarts_per_ray: Option<f64>,
    pub shadow_steps_per_ray: Option<f64>,
    pub shadow_tests_per_ray: Option<f64>,
    pub shadow_restarts_per_ray: Option<f64>,
    pub reflected_steps_per_ray: Option<f64>,
    pub reflected_tests_per_ray: Option<f64>,
    pub reflected_restarts_per_ray: Option<f64>,
    pub build_ms: f64,
    pub structure_bytes: u64,
    pub geometry_bytes: u64,
    pub thesis_bytes: u64,
    pub image_hash: Option<String>,
    pub verified: bool,
    pub status: Status,
    pub message: String,
    pub frame_ms_p95: Option<f64>,
    pub device_ms_mean: Option<f64>,
    /// Wall time of all passes over the sum of their frame times: what the harness adds.
    pub pass_overhead: Option<f64>,
    pub camera_path: String,
    /// Where the kernel read scene and structure from, and its hash; empty for CPU twins.
    pub fetch: Option<String>,
    pub kernel_hash: Option<String>,
    pub shader_checks: bool,
    pub build_threads: usize,
    pub primary_inner_per_ray: Option<f64>,
    pub primary_leaves_per_ray: Option<f64>,
    pub primary_pops_per_ray: Option<f64>,
    pub shadow_inner_per_ray: Option<f64>,
    pub shadow_leaves_per_ray: Option<f64>,
    pub shadow_pops_per_ray: Option<f64>,
    pub reflected_inner_per_ray: Option<f64>,
    pub reflected_leaves_per_ray: Option<f64>,
    pub reflected_pops_per_ray: Option<f64>,
    pub warnings: String,
    pub dispatches: Option<u32>,
    /// Rows whose passes took turns with this one's; empty in runs of versions that did not.
    pub turns: Option<usize>,
}

/// One row of `structures.csv`; empty where a column has no meaning.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)] // The names are the columns.
pub struct StructureRow {
    pub scene: String,
    pub structure: String,
    pub variant: String,
    pub cells_x: Option<u32>,
    pub cells_y: Option<u32>,
    pub cells_z: Option<u32>,
    pub max_cell_triangles: Option<u32>,
    pub references_per_triangle: Option<f64>,
    pub leaves: Option<u32>,
    pub empty_leaves: Option<u32>,
    pub max_leaf_triangles: Option<u32>,
    pub nodes: Option<u32>,
    pub depth: Option<u32>,
    pub sah_cost: Option<f64>,
    pub build_ms: f64,
    pub build_threads: usize,
    pub structure_bytes: u64,
    pub geometry_bytes: u64,
    pub thesis_bytes: u64,
    pub triangles: u64,
    pub vertices: u64,
    /// How the structure was built where not as its options say.
    #[serde(default)]
    pub note: String,
}

/// `run.json`: the provenance and all rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// First line of the journal.
    pub run: Provenance,
    /// Each scene once.
    pub scenes: Vec<SceneRecord>,
    /// The rows of `structures.csv`.
    pub structures: Vec<StructureRow>,
    /// The rows of `summary.csv`.
    pub configurations: Vec<Row>,
    /// Each time that the run was taken up again; absent where it ran in one go.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub resumed: Vec<Resumed>,
    /// How the run ended; null where it was killed.
    pub end: Option<End>,
}

/// Rounds to `places` decimals: as many as a number is worth, and the same in every file.
fn round(value: f64, places: i32) -> f64 {
    let scale = 10f64.powi(places);
    (value * scale).round() / scale
}

/// The samples that the frame time is taken from.
fn timed(source: Option<TimingSource>, samples: &Samples) -> Option<&[Vec<u64>]> {
    match source? {
        TimingSource::Device => samples.device_ns.as_deref(),
        TimingSource::Wall => Some(&samples.wall_ns),
    }
}

/// A configuration's statistics by the clock that was chosen for it.
pub fn frame_statistics(record: &ConfigurationRecord) -> Option<FrameStatistics> {
    statistics::frames(timed(record.timing_source, record.samples.as_ref()?)?)
}

impl Row {
    /// The row of one configuration.
    pub fn new(device: &DeviceInfo, record: &ConfigurationRecord) -> Row {
        type Count = fn(&CounterSums) -> u64;
        // An error row has no time, whatever the journal may hold.
        let samples = record.samples.as_ref().filter(|_| record.status == Status::Ok);
        let frame = samples.and_then(|_| frame_statistics(record));
        let mean_of = |ns: &[Vec<u64>]| statistics::frames(ns).map(|s| round(s.mean_ms, 6));
        let ms = |value: fn(&FrameStatistics) -> f64| frame.as_ref().map(|f| round(value(f), 6));
        let rays = |kind: usize| record.counters.as_ref().map(|c| c[kind].rays);
        let total_rays = record.counters.as_ref().map(|c| c.iter().map(|sums| sums.rays).sum::<u64>());
        let per_ray = |kind: usize, value: Count| {
            let sums = &record.counters.as_ref()?[kind];
            (sums.rays > 0).then(|| round(value(sums) as f64 / sums.rays as f64, 4))
        };
        let (steps, tests, restarts): (Count, Count, Count) = (CounterSums::steps, |s| s.tests, |s| s.restarts);
        let (inner, leaves, pops): (Count, Count, Count) = (|s| s.inner, |s| s.leaves, |s| s.pops);
        Row {
            device: device.name.clone(),
            device_type: device.device_type,
            scene: record.scene.name.clone(),
            triangles: record.scene.triangles,
            structure: record.structure.clone(),
            variant: record.variant.clone(),
            config: record.config,
            width: record.width,
            height: record.height,
            frames: record.frames,
            passes: record.passes,
            frame_ms_min: ms(|f| f.min_ms),
            frame_ms_max: ms(|f| f.max_ms),
            frame_ms_mean: ms(|f| f.mean_ms),
            noise_pct: frame.as_ref().and_then(|f| f.noise_pct).map(|n| round(n, 3)),
            timing_source: record.timing_source.filter(|_| frame.is_some()),
            wall_ms_mean: samples.and_then(|s| mean_of(&s.wall_ns)),
            mrays_per_s: frame
                .as_ref()
                .zip(total_rays)
                .filter(|(f, _)| f.total_ms > 0.0)
                .map(|(f, rays)| round(rays as f64 / f.total_ms / 1e3, 4)),
            primary_rays: rays(0),
            shadow_rays: rays(1),
            reflected_rays: rays(2),
            primary_steps_per_ray: per_ray(0, steps),
            primary_tests_per_ray: per_ray(0, tests),
            primary_restarts_per_ray: per_ray(0, restarts),
            shadow_steps_per_ray: per_ray(1, steps),
            shadow_tests_per_ray: per_ray(1, tests),
            shadow_restarts_per_ray: per_ray(1, restarts),
            reflected_steps_per_ray: per_ray(2, steps),
            reflected_tests_per_ray: per_ray(2, tests),
            reflected_restarts_per_ray: per_ray(2, restarts),
            build_ms: round(record.build_ms, 3),
            structure_bytes: record.memory.structure_bytes,
            geometry_bytes: record.memory.geometry_bytes,
            thesis_bytes: record.memory.thesis_bytes,
            image_hash: record.image_hash.clone(),
            verified: record.verified,
            status: record.status,
            message: record.message.clone(),
            frame_ms_p95: ms(|f| f.p95_ms),
            device_ms_mean: samples.and_then(|s| mean_of(s.device_ns.as_deref()?)),
            pass_overhead: samples.and_then(|s| pass_overhead(s, timed(record.timing_source, s)?)),
            camera_path: record.camera_path.name.clone(),
            fetch: record.kernel.as_ref().map(|kernel| kernel.fetch.clone()),
            kernel_hash: record.kernel.as_ref().map(|kernel| kernel.hash.clone()),
            shader_checks: device.checked || record.kernel.as_ref().is_some_and(|kernel| kernel.checked),
            build_threads: record.build_threads,
            primary_inner_per_ray: per_ray(0, inner),
            primary_leaves_per_ray: per_ray(0, leaves),
            primary_pops_per_ray: per_ray(0, pops),
            shadow_inner_per_ray: per_ray(1, inner),
            shadow_leaves_per_ray: per_ray(1, leaves),
            shadow_pops_per_ray: per_ray(1, pops),
            reflected_inner_per_ray: per_ray(2, inner),
            reflected_leaves_per_ray: per_ray(2, leaves),
            reflected_pops_per_ray: per_ray(2, pops),
            warnings: record.warnings.join("; "),
            dispatches: record.dispatches,
            turns: (record.turns > 0).then_some(record.turns),
        }
    }
}

/// Wall time of all passes over the sum of their frame times.
fn pass_overhead(samples: &Samples, timed: &[Vec<u64>]) -> Option<f64> {
    let frames: u64 = timed.iter().flatten().sum();
    let passes: u64 = samples.pass_ns.iter().sum();
    (frames > 0).then(|| round(passes as f64 / frames as f64, 4))
}

impl StructureRow {
    /// The row of one structure.
    pub fn new(record: &StructureRecord) -> StructureRow {
        let properties = &record.properties;
        StructureRow {
            scene: record.scene.name.clone(),
            structure: record.structure.clone(),
            variant: record.variant.clone(),
            cells_x: properties.cells_x,
            cells_y: properties.cells_y,
            cells_z: properties.cells_z,
            max_cell_triangles: properties.max_cell_triangles,
            references_per_triangle: properties.references_per_triangle.map(|r| round(r, 4)),
            leaves: properties.leaves,
            empty_leaves: properties.empty_leaves,
            max_leaf_triangles: properties.max_leaf_triangles,
            nodes: properties.nodes,
            depth: properties.depth,
            sah_cost: properties.sah_cost.map(|c| round(c, 4)),
            build_ms: round(record.build_ms, 3),
            build_threads: record.build_threads,
            structure_bytes: record.memory.structure_bytes,
            geometry_bytes: record.memory.geometry_bytes,
            thesis_bytes: record.memory.thesis_bytes,
            triangles: record.scene.triangles,
            vertices: record.scene.vertices,
            note: record.note.clone(),
        }
    }
}

impl Run {
    /// Everything that is derived from a journal.
    pub fn new(journal: &Journal) -> Run {
        let device = &journal.provenance.device;
        let of_structures = journal.structures.iter().map(|s| &s.scene);
        let mut scenes: Vec<SceneRecord> = Vec::new();
        for scene in of_structures.chain(journal.configurations.iter().map(|c| &c.scene)) {
            if !scenes.contains(scene) {
                scenes.push(scene.clone());
            }
        }
        // Rows of a structure stand together, though it took turns with others
        fn key(c: &ConfigurationRecord) -> [&str; 4] {
            [&c.scene.name, &c.scene.hash, &c.structure, &c.variant]
        }
        let mut first: HashMap<_, usize> = HashMap::new();
        for (place, record) in journal.configurations.iter().enumerate() {
            first.entry(key(record)).or_insert(place);
        }
        let mut records: Vec<&ConfigurationRecord> = journal.configurations.iter().collect();
        // Scenes are measured one after another, so this keeps theirs together as well
        records.sort_by_key(|record| first[&key(record)]);
        Run {
            run: journal.provenance.clone(),
            scenes,
            structures: journal.structures.iter().map(StructureRow::new).collect(),
            configurations: records.into_iter().map(|record| Row::new(device, record)).collect(),
            resumed: journal.resumed.clone(),
            end: journal.end.clone(),
        }
    }

    /// Writes `summary.csv`, `structures.csv` and `run.json` into `folder`, each whole or not at all.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn write(&self, folder: &Path) -> Result<()> {
        files::replace(&folder.join("summary.csv"), &summary_csv(&self.configurations)?)?;
        files::replace(&folder.join("structures.csv"), &structures_csv(&self.structures)?)?;
        let path = folder.join("run.json");
        let mut json = serde_json::to_vec_pretty(self).map_err(|e| Error::output(&path, e.into()))?;
        json.push(b'\n');
        files::replace(&path, &json)
    }
}

/// Rows as CSV under a header of their fields' names.
///
/// # Errors
/// None in practice: the writer is memory.
fn csv_of<T: Serialize>(rows: &[T], example: &T) -> Result<Vec<u8>> {
    let failed = |e: csv::Error| Error::output(Path::new("CSV"), std::io::Error::other(e));
    let mut writer = csv::Writer::from_writer(Vec::new());
    // The header is written with the first row: a table without rows gets its from the example.
    for row in if rows.is_empty() { std::slice::from_ref(example) } else { rows } {
        writer.serialize(row).map_err(failed)?;
    }
    let mut bytes = writer.into_inner().map_err(|e| Error::output(Path::new("CSV"), e.into_error()))?;
    if rows.is_empty() {
        let header = bytes.iter().position(|&b| b == b'\n').map_or(bytes.len(), |end| end + 1);
        bytes.truncate(header);
    }
    Ok(bytes)
}

/// `summary.csv`.
///
/// # Errors
/// None in practice.
pub fn summary_csv(rows: &[Row]) -> Result<Vec<u8>> {
    let device = DeviceInfo {
        name: String::new(),
        device_type: DeviceType::Other,
        backend: String::new(),
        driver: String::new(),
        timestamp_period_ns: None,
        checked: false,
        features: Vec::new(),
        limits: Default::default(),
        threads: None,
    };
    csv_of(rows, &Row::new(&device, &ConfigurationRecord::new(Config::P)))
}

/// `structures.csv`.
///
/// # Errors
/// None in practice.
pub fn structures_csv(rows: &[StructureRow]) -> Result<Vec<u8>> {
    csv_of(rows, &StructureRow::new(&StructureRecord::default()))
}
