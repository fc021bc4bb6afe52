//! Rows of this workload, typed: what tables and claims about ray tracing read. They are made from rows of the general
//! schema and from journals of schema 1, and hold nothing else.

mod rows;
mod variant;

pub use super::count::{ByRayType, CounterSums, RAY_TYPES};
pub use rows::{by_ray_type, counter_metrics, issued_of, structure_metrics};
pub use variant::{OPTION_AXES, split_variant, variant_of};

use super::Properties;
use super::rays::Config;
use super::simt::Sums;
use crate::device::KernelInfo;
use crate::error::Result;
use crate::record::journal::Journal;
use crate::record::journal::Record;
use crate::record::row::{Input, Key, Row, Samples, Settings, Status, TimingSource};
use crate::record::run::{End, Provenance, Resumed};
use crate::record::statistics::{self, FrameStatistics, round};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Name of the workload in keys.
pub const WORKLOAD: &str = "sweep";

/// A scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SceneRecord {
    /// Short name.
    pub name: String,
    /// Content hash.
    pub hash: String,
    /// Number of triangles.
    pub triangles: u64,
    /// Number of vertices.
    pub vertices: u64,
    /// Number of lights of the scene itself.
    pub lights: u64,
    /// Triangles without area.
    pub degenerate_triangles: u64,
    /// Share of the surface that mirrors, 0 to 1.
    pub mirror_share: f64,
    /// Its placement in memory; absent where it is as in its file, as in all records from before there was a choice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub placement: Option<PlacementRecord>,
}

/// What leads from a scene's file to memory: `(file - offset) * 2^exponent`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PlacementRecord {
    /// The point of the file that is the origin.
    pub offset: [f64; 3],
    /// The power of two that lengths are scaled by.
    pub exponent: i32,
}

/// A structure that was built.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StructureRecord {
    /// Of this scene.
    pub scene: SceneRecord,
    /// Name as in `--structure`.
    pub structure: String,
    /// Options that differ from the defaults, or `default`.
    pub variant: String,
    /// Its properties.
    pub properties: Properties,
    /// Build time in milliseconds; structures that share a tree also share its time.
    pub build_ms: f64,
    /// Threads that built it.
    pub build_threads: usize,
    /// Its sizes.
    pub memory: Memory,
    /// Milliseconds of its upload to the device; absent where it was not measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upload_ms: Option<f64>,
    /// Milliseconds that the driver took to build its own structure; absent for all others and in schema 1.
    #[serde(skip)]
    pub driver_build_ms: Option<f64>,
    /// Bytes of triangles in leaf order, which are not in `memory`; absent where there are none, and in
    /// schema 1.
    #[serde(skip)]
    pub leaf_order_bytes: Option<u64>,
    /// How it was built where not as its options say; absent otherwise.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
}

/// Sizes in bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Memory {
    /// Nodes or cells, and triangle references: as allocated on the device, or in main memory where it was not
    /// uploaded.
    pub structure_bytes: u64,
    /// Vertices, materials, every triangle's material and lights: likewise.
    pub geometry_bytes: u64,
    /// What the thesis of 2009 would have counted.
    pub thesis_bytes: u64,
    /// The structure by the memory model of the source `rt2`, without geometry; 0 where it has none.
    #[serde(default)]
    pub rt2_bytes: u64,
}

/// A camera path.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathRecord {
    /// Name.
    pub name: String,
    /// Content hash.
    pub hash: String,
}

/// One comparison with the reference.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Verification {
    /// Frame of the (thinned) path.
    pub frame: usize,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// True if everything agrees.
    pub ok: bool,
    /// True if hits and counters were compared with the CPU twin pixel by pixel.
    pub twin: bool,
    /// Primary rays compared.
    pub rays: u64,
    /// Of these, confirmed by brute force.
    pub brute_checked: u64,
    /// Primary rays whose hit differs.
    pub hits_differing: u64,
    /// Of these, away from silhouettes, how many hit nothing; 0 in runs from before this was counted.
    #[serde(default)]
    pub hits_lost: u64,
    /// Pixels whose counters differ.
    pub counters_differing: u64,
    /// Pixels whose colour differs by more than the stated amount.
    pub colours_differing: u64,
    /// Largest difference of a colour channel, of 255.
    pub max_colour_difference: u8,
    /// BLAKE3 of the image.
    pub image_hash: String,
    /// What was compared, or what disagrees.
    pub message: String,
}

/// A row of ray tracing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ConfigurationRecord {
    /// Scene.
    pub scene: SceneRecord,
    /// Camera path.
    pub camera_path: PathRecord,
    /// Structure's name.
    pub structure: String,
    /// Options that differ from the defaults, or `default`.
    pub variant: String,
    /// Ray configuration.
    pub config: Config,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Frames of the path.
    pub frames: usize,
    /// Timed passes over it.
    pub passes: usize,
    /// Whether there is a result.
    pub status: Status,
    /// Why there is none, one line; empty if there is one.
    pub message: String,
    /// What the user should know about a result all the same.
    pub warnings: Vec<String>,
    /// True if every comparison agreed.
    pub verified: bool,
    /// The comparisons.
    pub verification: Vec<Verification>,
    /// Path of the difference image inside the run's folder, where something disagreed.
    pub difference: Option<String>,
    /// BLAKE3 of the first frame at full size.
    pub image_hash: Option<String>,
    /// The same of the first structure measured with this scene, path, configuration and size: to compare with.
    pub reference_image_hash: Option<String>,
    /// The timed kernel, on a device.
    #[serde(default)]
    pub kernel: Option<KernelInfo>,
    /// Dispatches per timed frame, on a device: more than one where the image was split into tiles or a watchdog was
    /// near.
    #[serde(default)]
    pub dispatches: Option<u32>,
    /// By ray type (primary, shadow, reflected), over all frames.
    #[serde(default, deserialize_with = "rows::first_ray_types")]
    #[schemars(with = "Option<[CounterSums; 3]>")]
    pub counters: Option<ByRayType<CounterSums>>,
    /// Lanes of the warps whose work was to be counted; absent where none was, and in schema 1.
    #[serde(skip)]
    pub warp_width: Option<u32>,
    /// What warps issue, by ray type, over all frames; absent where that was not counted, and in schema 1.
    #[serde(skip)]
    pub issued: Option<ByRayType<Sums>>,
    /// Sizes.
    pub memory: Memory,
    /// Build time in milliseconds.
    pub build_ms: f64,
    /// Threads that built it.
    pub build_threads: usize,
    /// Which clock the frame time is taken from.
    pub timing_source: Option<TimingSource>,
    /// Every timed frame.
    pub samples: Option<Samples>,
    /// Cases that were timed in interleaved passes, this one among them; 0 where that is not known.
    #[serde(default, rename = "turns")]
    pub interleaved_with: usize,
    /// Seconds spent on verification; that of the small image counts for the first size.
    pub verification_s: f64,
    /// Seconds spent on counting.
    pub counting_s: f64,
    /// Index into the run's devices.
    #[serde(default)]
    pub device: usize,
}

/// A journal of this workload, typed.
#[derive(Clone, Debug, PartialEq)]
pub struct TraceJournal {
    /// First line.
    pub provenance: Provenance,
    /// In the order of building.
    pub structures: Vec<StructureRecord>,
    /// In the order of measuring.
    pub configurations: Vec<ConfigurationRecord>,
    /// Each time that the run was resumed.
    pub resumed: Vec<Resumed>,
    /// Last line, if the run ended in order.
    pub end: Option<End>,
    /// What had to be left out: a last line that was cut off.
    pub truncated: Option<String>,
}

impl TraceJournal {
    /// Reads the rows of a journal; rows of other workloads are left out.
    pub fn new(journal: &Journal) -> TraceJournal {
        TraceJournal {
            provenance: journal.provenance.clone(),
            structures: journal.artifacts.iter().filter_map(|a| StructureRecord::from_artifact(journal, a)).collect(),
            configurations: journal.rows.iter().filter_map(|row| ConfigurationRecord::from_row(journal, row)).collect(),
            resumed: journal.resumed.clone(),
            end: journal.end.clone(),
            truncated: journal.truncated.clone(),
        }
    }
}

impl TraceJournal {
    /// The rows in the general schema, after what they were measured on and what was built for them.
    pub fn records(&self) -> Vec<Record> {
        let mut inputs: Vec<Input> = Vec::new();
        let scenes = self.structures.iter().map(|s| &s.scene).chain(self.configurations.iter().map(|c| &c.scene));
        let paths = self.configurations.iter().map(|record| record.camera_path.to_input());
        for input in scenes.map(SceneRecord::to_input).chain(paths) {
            if !inputs.contains(&input) {
                inputs.push(input);
            }
        }
        let settings = self.provenance.plan.settings;
        let artifacts = self.structures.iter().map(|s| Record::Artifact(Box::new(s.to_artifact())));
        let rows = self.configurations.iter().map(|c| Record::Row(Box::new(c.to_row(settings))));
        inputs.into_iter().map(|input| Record::Input(Box::new(input))).chain(artifacts).chain(rows).collect()
    }
}

impl ConfigurationRecord {
    /// A record with nothing in it yet: failed until something is measured.
    pub fn new(config: Config) -> ConfigurationRecord {
        ConfigurationRecord {
            scene: SceneRecord::default(),
            camera_path: PathRecord::default(),
            structure: String::new(),
            variant: String::new(),
            config,
            width: 0,
            height: 0,
            frames: 0,
            passes: 0,
            status: Status::Failed,
            message: String::new(),
            warnings: Vec::new(),
            verified: false,
            verification: Vec::new(),
            difference: None,
            image_hash: None,
            reference_image_hash: None,
            kernel: None,
            dispatches: None,
            counters: None,
            warp_width: None,
            issued: None,
            memory: Memory::default(),
            build_ms: 0.0,
            build_threads: 0,
            timing_source: None,
            samples: None,
            interleaved_with: 0,
            verification_s: 0.0,
            counting_s: 0.0,
            device: 0,
        }
    }

    /// Statistics of its frame times by the clock that was chosen for it, rounded as in `summary.csv`; `None` for a row
    /// without a result, even if the journal holds samples.
    pub fn frame_statistics(&self) -> Option<FrameStatistics> {
        let samples = self.samples.as_ref().filter(|_| self.status == Status::Ok)?;
        let timed = match self.timing_source? {
            TimingSource::Device => samples.device_ns.as_deref()?,
            TimingSource::Wall => &samples.wall_ns,
        };
        let ms = |value: f64| round(value, 6);
        let frames = statistics::frames(timed)?;
        Some(FrameStatistics {
            min_ms: ms(frames.min_ms),
            max_ms: ms(frames.max_ms),
            mean_ms: ms(frames.mean_ms),
            p95_ms: ms(frames.p95_ms),
            total_ms: frames.total_ms,
            noise_pct: frames.noise_pct.map(|noise| round(noise, 3)),
        })
    }
}

/// The typed rows of a journal in a file, of either schema.
///
/// # Errors
/// [`crate::Error::Input`] with file and line.
pub fn read(path: &std::path::Path) -> Result<TraceJournal> {
    Ok(TraceJournal::new(&super::schema1::read(path)?))
}
