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
}

impl Provenance {
    /// The same with an id that follows from everything else.
    pub fn identified(self) -> Provenance {
        let text = serde_json::to_string(&Provenance { id: String::new(), ..self.clone() }).unwrap_or_default();
        Provenance { id: blake3::hash(text.as_bytes()).to_hex()[..16].to_owned(), ..self }
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
    /// Values of each axis that occur, as they were asked for.
    pub axes: BTreeMap<String, Vec<String>>,
    /// Number of rows.
    pub rows: usize,
    /// How they are measured.
    pub settings: Settings,
    /// What the preset names and this machine does not have.
    pub absent: Vec<String>,
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
