//! What a run's journal says about the run as a whole: where it comes from, what was to be measured, how it ended.

use super::row::Settings;
use crate::device::DeviceInfo;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Everything that one has to know to believe, repeat or refuse a run's numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Provenance {
    /// [`super::row::SCHEMA`].
    #[schemars(description = "Version of the schema.", extend("const" = super::row::SCHEMA))]
    pub schema: String,
    /// Tells this run apart from others: 16 hexadecimal digits.
    pub id: String,
    /// Name of the workload.
    pub workload: String,
    /// How the program was made.
    pub program: Program,
    /// Start, UTC, RFC 3339.
    pub started: String,
    /// Command line, the program's name included.
    pub arguments: Vec<String>,
    /// The devices; rows refer to them by index.
    pub devices: Vec<DeviceRecord>,
    /// The machine around them.
    pub environment: Environment,
    /// What was to be measured.
    pub plan: PlanRecord,
    /// The runs that this one was merged from, in the order of their rows; absent for a run that was measured as one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub merged: Vec<MergedRun>,
}

/// A run that was merged into another one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MergedRun {
    /// Its id.
    pub id: String,
    /// Its start, UTC, RFC 3339.
    pub started: String,
    /// Its part of the plan; absent where it is all of it.
    pub shard: Option<Shard>,
    /// For each of its devices, the index among the merged run's. Machines of equal devices and equal environments
    /// count as one.
    pub devices: Vec<usize>,
    /// The machine around its devices.
    pub environment: Environment,
    /// BLAKE3 of its program's file; the merged runs' programs are equal in everything else.
    pub executable_hash: Option<String>,
}

/// A part of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
pub struct Shard {
    /// Which one, from 1 to `count`.
    pub index: usize,
    /// Number of parts.
    pub count: usize,
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl Provenance {
    /// The same with an id that follows from everything else.
    pub fn identified(self) -> Provenance {
        let text = serde_json::to_string(&Provenance { id: String::new(), ..self.clone() }).unwrap_or_default();
        Provenance { id: blake3::hash(text.as_bytes()).to_hex()[..16].to_owned(), ..self }
    }

    /// The index of a row's device in the plan, before runs were merged.
    pub fn role(&self, device: usize) -> usize {
        let of = |run: &MergedRun| run.devices.iter().position(|&index| index == device);
        self.merged.iter().find_map(of).unwrap_or(device)
    }

    /// Names of the devices, separated by commas.
    pub fn device_names(&self) -> String {
        self.devices.iter().map(|device| device.info.name.as_str()).collect::<Vec<_>>().join(", ")
    }
}

/// A device of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DeviceRecord {
    /// The device, its driver, features and limits.
    #[serde(flatten)]
    pub info: DeviceInfo,
    /// Why this device was taken.
    pub reason: String,
}

/// How the program was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
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
    /// BLAKE3 of the program's file: it distinguishes two builds of one changed revision. Absent where it cannot be
    /// read.
    #[serde(default)]
    pub executable_hash: Option<String>,
}

/// The machine, at the start of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
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
    /// What spoils times, each with what to do; absent where nothing is known to.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
}

impl Environment {
    /// What tells one machine from another, as far as times depend on it.
    pub fn machine(&self) -> impl PartialEq {
        (self.architecture.clone(), self.cpu.clone(), self.logical_cpus, self.variables.clone())
    }
}

/// A run that is resumed, by the same program on the same devices.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Resumed {
    /// Start, UTC, RFC 3339.
    pub started: String,
    /// Command line, the program's name included.
    pub arguments: Vec<String>,
    /// The machine around the devices, at this time.
    pub environment: Environment,
}

/// What was to be measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PlanRecord {
    /// The preset that the plan began with.
    pub preset: String,
    /// Values of each axis that occur in the whole plan, as they were asked for.
    pub axes: BTreeMap<String, Vec<String>>,
    /// Number of rows of this run.
    pub rows: usize,
    /// How they are measured.
    pub settings: Settings,
    /// What the preset names and this machine does not have.
    pub absent: Vec<String>,
    /// Work of this run's cases, in the workload's unit; 0 where it was not recorded.
    #[serde(default)]
    pub work: u64,
    /// Number of rows of the whole plan; 0 where it was not recorded.
    #[serde(default)]
    pub total: usize,
    /// BLAKE3 of the whole plan: workload, cases and settings; empty where it was not recorded.
    #[serde(default)]
    pub hash: String,
    /// The part of the whole plan that was to be measured; absent where it is all of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<Shard>,
}

impl PlanRecord {
    /// True for plans of the same cases. The work of a run that was merged from parts does not matter.
    pub fn is_same(&self, other: &PlanRecord) -> bool {
        PlanRecord { work: other.work, ..self.clone() } == *other
    }
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
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
