//! The schema of a journal: one [`Record`] per line, the first one a [`Provenance`].

use crate::workloads::trace::Properties;
use crate::workloads::trace::backend::{Config, Counters, DeviceInfo, KernelInfo};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Version of the schema; changes when a reader of old journals would misread new ones.
pub const SCHEMA: &str = "rtbench/1";

/// One line of a journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "record", rename_all = "kebab-case")]
pub enum Record {
    /// Where the run comes from: always the first line.
    Run(Box<Provenance>),
    /// A structure that was built.
    Structure(Box<StructureRecord>),
    /// A configuration that was measured, or the reason why it was not.
    Configuration(Box<ConfigurationRecord>),
    /// The run ended in order; absent where it was killed.
    End(End),
    /// It was taken up again: what follows was measured from here on.
    Resumed(Box<Resumed>),
}

/// Everything that one has to know to believe, repeat or refuse a run's numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// [`SCHEMA`].
    pub schema: String,
    /// How the program was made.
    pub program: Program,
    /// Start, UTC, RFC 3339.
    pub started: String,
    /// Command line, the program's name included.
    pub arguments: Vec<String>,
    /// The device, its driver, features and limits.
    pub device: DeviceInfo,
    /// Why this device was taken.
    pub device_reason: String,
    /// The machine around it.
    pub environment: Environment,
    /// What was to be measured.
    pub plan: PlanRecord,
}

/// How the program was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Program {
    /// Crate version.
    pub version: String,
    /// Git revision, `unknown` outside a repository.
    pub git_revision: String,
    /// True if what the program is made of differed from that revision; `None` if unknown.
    pub git_dirty: Option<bool>,
    /// Compiler.
    pub rustc: String,
    /// Cargo profile.
    pub profile: String,
    /// Target triple.
    pub target: String,
    /// BLAKE3 of `Cargo.lock`.
    pub lock_hash: String,
    /// Versions of the packages that decide what a kernel becomes.
    pub packages: BTreeMap<String, String>,
    /// BLAKE3 of the program's file: tells two builds of one changed revision apart. Absent where it cannot be read.
    #[serde(default)]
    pub executable_hash: Option<String>,
}

/// The machine, at the start of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Environment {
    /// Operating system and its version.
    pub os: String,
    /// Kernel version.
    pub kernel: String,
    /// Processor architecture.
    pub architecture: String,
    /// Processor name.
    pub cpu: String,
    /// Threads that the process may use.
    pub logical_cpus: usize,
    /// Cores, where known.
    pub physical_cpus: Option<usize>,
    /// Frequency governor, where there is one.
    pub governor: Option<String>,
    /// Main memory in bytes.
    pub memory_bytes: u64,
    /// Load average over 1, 5 and 15 minutes: above the number of threads, times are not to be trusted.
    pub load_average: [f64; 3],
    /// Variables that change what is measured (`LP_NUM_THREADS`, `VK_*`, ...).
    pub variables: BTreeMap<String, String>,
}

/// A run that is taken up again, by the same program on the same device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Resumed {
    /// Start, UTC, RFC 3339.
    pub started: String,
    /// Command line, the program's name included.
    pub arguments: Vec<String>,
    /// The machine around the device, at this time.
    pub environment: Environment,
}

/// What was to be measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanRecord {
    /// The preset that it began with.
    pub preset: String,
    /// Scenes as they were asked for.
    pub scenes: Vec<String>,
    /// Structures as they were asked for.
    pub structures: Vec<String>,
    /// Planned number of configurations.
    pub configurations: usize,
    /// Timed passes over each path.
    pub passes: usize,
    /// Untimed frames before each pass.
    pub warmup_frames: usize,
    /// How often each structure is built; its time is the median. 0 in records from before there was a choice: once.
    #[serde(default)]
    pub builds: usize,
    /// What the preset names and this machine does not have.
    pub skipped: Vec<String>,
}

/// A scene, as it stands in every record of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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
    /// Where it lies in memory; absent where that is as in its file, as in all records from before there was a choice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub placement: Option<PlacementRecord>,
}

/// What leads from a scene's file to memory: `(file - offset) * 2^exponent`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlacementRecord {
    /// The point of the file that is the origin.
    pub offset: [f64; 3],
    /// The power of two that lengths are scaled by.
    pub exponent: i32,
}

/// A structure that was built.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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
    /// How it was built where not as its options say; absent otherwise.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
}

/// Sizes in bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Memory {
    /// Nodes or cells, and triangle records: as allocated on the device, or in main memory where it was not uploaded.
    pub structure_bytes: u64,
    /// Vertices, materials, every triangle's material and lights: likewise.
    pub geometry_bytes: u64,
    /// What the thesis would have counted (SPEC section 7).
    pub thesis_bytes: u64,
}

/// A camera path, as it stands in a record.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PathRecord {
    /// Name.
    pub name: String,
    /// Content hash.
    pub hash: String,
}

/// Whether a configuration has a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// Verified and timed.
    Ok,
    /// Not timed; the message says why.
    Error,
}

/// Why a configuration has no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Failure {
    /// The kernel ran and its answer is wrong.
    Verification,
    /// The device refuses it, or broke while running it.
    Device,
}

/// Which clock gave the frame times.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TimingSource {
    /// The device's timestamps.
    Device,
    /// The host's clock.
    Wall,
}

/// Sums of [`Counters`] over pixels and frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CounterSums {
    /// Rays of this type.
    pub rays: u64,
    /// Inner nodes, or cells of a grid.
    pub inner: u64,
    /// Leaves.
    pub leaves: u64,
    /// Ray/triangle tests.
    pub tests: u64,
    /// Entries taken from a stack.
    pub pops: u64,
    /// Restarts.
    pub restarts: u64,
}

impl CounterSums {
    /// Adds one pixel's counters.
    pub fn add(&mut self, counters: &Counters) {
        self.rays += u64::from(counters.rays);
        self.inner += u64::from(counters.inner);
        self.leaves += u64::from(counters.leaves);
        self.tests += u64::from(counters.tests);
        self.pops += u64::from(counters.pops);
        self.restarts += u64::from(counters.restarts);
    }

    /// Traversal steps: nodes, or cells for a grid (SPEC section 6).
    pub fn steps(&self) -> u64 {
        self.inner + self.leaves
    }
}

/// One comparison with the reference.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
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

/// All timed frames: integers, nanoseconds, `[pass][frame]`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Samples {
    /// By the device's timestamps; absent where a single one is missing.
    pub device_ns: Option<Vec<Vec<u64>>>,
    /// By the host's clock.
    pub wall_ns: Vec<Vec<u64>>,
    /// Each whole pass by the host's clock, with everything that the harness does around it.
    pub pass_ns: Vec<u64>,
}

/// What tells one row of a run from another: everything that was asked for. A scene or path whose content changed is
/// another one.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Identity {
    scene_hash: String,
    path_hash: String,
    structure: String,
    variant: String,
    config: Config,
    width: u32,
    height: u32,
    frames: usize,
    passes: usize,
}

/// One row of the summary.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
    /// Why not.
    pub failure: Option<Failure>,
    /// What went wrong, one line; empty if nothing did.
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
    /// Dispatches per timed frame, on a device: more than one where the image was split into tiles or a watchdog was near.
    #[serde(default)]
    pub dispatches: Option<u32>,
    /// By ray type (primary, shadow, reflected), over all frames.
    pub counters: Option<[CounterSums; 3]>,
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
    /// Rows whose passes took turns, this one among them; 0 in records from before they did: each was timed on its own.
    #[serde(default)]
    pub turns: usize,
    /// Seconds spent on verification; that of the small image counts for the first size.
    pub verification_s: f64,
    /// Seconds spent on counting.
    pub counting_s: f64,
}

impl ConfigurationRecord {
    /// A record with nothing in it yet: an error row until something is measured.
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
            status: Status::Error,
            failure: None,
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
            memory: Memory::default(),
            build_ms: 0.0,
            build_threads: 0,
            timing_source: None,
            samples: None,
            turns: 0,
            verification_s: 0.0,
            counting_s: 0.0,
        }
    }

    /// Which row of a run this is.
    pub fn identity(&self) -> Identity {
        Identity {
            scene_hash: self.scene.hash.clone(),
            path_hash: self.camera_path.hash.clone(),
            structure: self.structure.clone(),
            variant: self.variant.clone(),
            config: self.config,
            width: self.width,
            height: self.height,
            frames: self.frames,
            passes: self.passes,
        }
    }

    /// True if measuring it again could not tell more: it has a result, or its answer was wrong. What the device refused
    /// or broke over is worth another attempt.
    pub fn is_settled(&self) -> bool {
        self.failure != Some(Failure::Device)
    }
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct End {
    /// UTC, RFC 3339.
    pub ended: String,
    /// True after Ctrl-C.
    pub interrupted: bool,
    /// True if everything planned has its row.
    pub complete: bool,
    /// Load average at the end.
    pub load_average: [f64; 3],
    /// Why it ended early, if it did.
    pub message: String,
}
