//! The schema of a journal, version 2: the same for all workloads. One [`Record`](super::journal::Record) per line, the
//! first one a [`Provenance`](super::run::Provenance).
//!
//! A row is axes and metrics. Its [`Key`] says what was asked for; resuming, comparing, sharding and merging need
//! nothing else. Settings are next to the key and must be equal where rows are joined.

use crate::device::KernelInfo;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Version of the schema; it changes when a reader of old journals would misread new ones.
pub const SCHEMA: &str = "rtbench/2";

/// What was asked for. Two rows with equal keys are measurements of the same.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
pub struct Key {
    /// Name of the workload.
    pub workload: String,
    /// Value of each axis, by its name.
    pub axes: BTreeMap<String, String>,
    /// Content hash of each input, by its kind. An input whose content changed under its name is another one.
    pub inputs: BTreeMap<String, String>,
}

impl Key {
    /// Value of an axis; empty where the key has no such axis.
    pub fn axis(&self, name: &str) -> &str {
        self.axes.get(name).map_or("", String::as_str)
    }

    /// Content hash of an input; empty where the key has none of this kind.
    pub fn input(&self, kind: &str) -> &str {
        self.inputs.get(kind).map_or("", String::as_str)
    }
}

/// How a run measures: equal for all of its rows, and for all rows that are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
pub struct Settings {
    /// Timed passes over all frames.
    pub passes: usize,
    /// Untimed frames before each pass.
    pub warmup_frames: usize,
    /// How often each artifact is built; its time is the median.
    pub builds: usize,
    /// Threads that build; 0 for as many as the process may use.
    pub threads: usize,
}

/// A number or a word that belongs to a row, an input or an artifact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Metric {
    /// Name, with the unit at its end where it has one.
    pub name: String,
    /// Which part of the work it is about, such as a type of rays; absent where it is about all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// The value.
    pub value: Value,
}

/// The value of a [`Metric`]. Integers stay integers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Value {
    /// Yes or no.
    Flag(bool),
    /// A count, a number of bytes.
    Integer(u64),
    /// A finite number.
    Number(f64),
    /// A word.
    Text(String),
}

impl From<u64> for Value {
    fn from(value: u64) -> Value {
        Value::Integer(value)
    }
}

impl From<usize> for Value {
    fn from(value: usize) -> Value {
        Value::Integer(value as u64)
    }
}

impl From<u32> for Value {
    fn from(value: u32) -> Value {
        Value::Integer(value.into())
    }
}

impl From<f64> for Value {
    /// What is not finite becomes text, since JSON has no such numbers.
    fn from(value: f64) -> Value {
        if value.is_finite() { Value::Number(value) } else { Value::Text(value.to_string()) }
    }
}

impl From<bool> for Value {
    fn from(value: bool) -> Value {
        Value::Flag(value)
    }
}

impl From<&str> for Value {
    fn from(value: &str) -> Value {
        Value::Text(value.to_owned())
    }
}

impl From<String> for Value {
    fn from(value: String) -> Value {
        Value::Text(value)
    }
}

impl Value {
    /// As text, in its shortest form that reads back to the same value.
    pub fn write(&self) -> String {
        match self {
            Value::Flag(value) => value.to_string(),
            Value::Integer(value) => value.to_string(),
            Value::Number(value) => value.to_string(),
            Value::Text(text) => text.clone(),
        }
    }

    /// The number; `None` for a word.
    pub fn number(&self) -> Option<f64> {
        match self {
            Value::Integer(value) => Some(*value as f64),
            Value::Number(value) => Some(*value),
            Value::Flag(_) | Value::Text(_) => None,
        }
    }

    /// The integer; `None` for anything else.
    pub fn integer(&self) -> Option<u64> {
        match self {
            Value::Integer(value) => Some(*value),
            _ => None,
        }
    }
}

impl Metric {
    /// A metric of the whole work.
    pub fn new(name: &str, value: impl Into<Value>) -> Metric {
        Metric { name: name.to_owned(), of: None, value: value.into() }
    }

    /// A metric of a part of the work.
    pub fn of(part: &str, name: &str, value: impl Into<Value>) -> Metric {
        Metric { name: name.to_owned(), of: Some(part.to_owned()), value: value.into() }
    }

    /// Name of its column in a wide table: `part_name`, or `name`.
    pub fn column(&self) -> String {
        match &self.of {
            Some(part) => format!("{part}_{}", self.name),
            None => self.name.clone(),
        }
    }
}

/// The value of a metric in a list, by name and part.
pub fn metric<'m>(metrics: &'m [Metric], of: Option<&str>, name: &str) -> Option<&'m Value> {
    metrics.iter().find(|metric| metric.name == name && metric.of.as_deref() == of).map(|metric| &metric.value)
}

/// Something that rows were measured on, such as a scene or a camera path.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Input {
    /// What it is: the name of an entry of [`Key::inputs`].
    pub kind: String,
    /// Name.
    pub name: String,
    /// Content hash.
    pub hash: String,
    /// Facts about it.
    pub metrics: Vec<Metric>,
}

/// Something that was built for rows, such as an acceleration structure.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Artifact {
    /// The axes and inputs that it depends on.
    pub key: Key,
    /// Sizes, build time, properties.
    pub metrics: Vec<Metric>,
    /// How it was built where not as asked for; absent otherwise.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
}

/// Whether a row has a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// Verified and timed.
    Ok,
    /// It was refused: the algorithm, the budget or the device cannot do it. It is not an error.
    Skipped,
    /// It ran and its answer is wrong; it was not timed.
    Wrong,
    /// The device broke over it, or its input cannot be read.
    Failed,
}

impl Status {
    /// True if measuring it again could not tell more, as long as the limits that a refusal names stay the same.
    pub fn is_final(self) -> bool {
        self != Status::Failed
    }

    /// In one word.
    pub fn word(self) -> &'static str {
        match self {
            Status::Ok => "ok",
            Status::Skipped => "skipped",
            Status::Wrong => "wrong",
            Status::Failed => "failed",
        }
    }
}

/// Which clock gave the frame times.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TimingSource {
    /// The device's timestamps.
    Device,
    /// The host's clock.
    Wall,
}

/// One comparison of an answer with a reference.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Check {
    /// True if everything agrees within the stated limits.
    pub ok: bool,
    /// What was compared, or what disagrees: one line.
    pub message: String,
    /// How much was compared, and how much differs.
    pub metrics: Vec<Metric>,
}

/// All timed frames: whole nanoseconds, `[pass][frame]`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Samples {
    /// Labels of the stages of a frame; absent where a frame is one stage.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stages: Vec<String>,
    /// From the begin of the first to the end of the last stage, by the device's timestamps; null where one is missing.
    pub device_ns: Option<Vec<Vec<u64>>>,
    /// Each stage by the device's timestamps, `[pass][frame][stage]`; absent where a frame is one stage.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stage_ns: Option<Vec<Vec<Vec<u64>>>>,
    /// From one frame's completion to the next one's, by the host's clock.
    pub wall_ns: Vec<Vec<u64>>,
    /// Each whole pass by the host's clock, with everything that the harness does around it.
    pub pass_ns: Vec<u64>,
}

/// A case that was measured, or the reason why it was not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Row {
    /// What was asked for.
    pub key: Key,
    /// How it was measured.
    pub settings: Settings,
    /// Index into the run's devices.
    pub device: usize,
    /// Whether there is a result.
    pub status: Status,
    /// Why there is none: one line; empty otherwise.
    pub message: String,
    /// What a reader should know about a result all the same.
    pub warnings: Vec<String>,
    /// Comparisons before the timing.
    pub checks: Vec<Check>,
    /// Content hashes of what was computed, by name; empty where sums depend on timing.
    pub outputs: BTreeMap<String, String>,
    /// Path of a picture of what differs, inside the run's folder.
    pub difference: Option<String>,
    /// What was counted, and the sizes of what was built.
    pub metrics: Vec<Metric>,
    /// Kernels that were timed; empty where nothing is compiled for a device.
    pub kernels: Vec<KernelInfo>,
    /// Which clock the frame time is taken from.
    pub timing_source: Option<TimingSource>,
    /// Every timed frame.
    pub samples: Option<Samples>,
    /// Cases that were timed in interleaved passes, this one among them; 0 where that is not known.
    pub interleaved_with: usize,
    /// Seconds that verification took.
    pub verification_s: f64,
    /// Seconds that counting took.
    pub counting_s: f64,
}

impl Row {
    /// A row with nothing in it yet: failed until something is measured.
    pub fn new(key: Key, settings: Settings, device: usize) -> Row {
        Row {
            key,
            settings,
            device,
            status: Status::Failed,
            message: String::new(),
            warnings: Vec::new(),
            checks: Vec::new(),
            outputs: BTreeMap::new(),
            difference: None,
            metrics: Vec::new(),
            kernels: Vec::new(),
            timing_source: None,
            samples: None,
            interleaved_with: 0,
            verification_s: 0.0,
            counting_s: 0.0,
        }
    }

    /// Turns it into a row without a result. The message becomes one line.
    pub fn refuse(&mut self, status: Status, message: &str) {
        self.status = status;
        self.message = message.split_whitespace().collect::<Vec<_>>().join(" ");
        self.samples = None;
        self.timing_source = None;
    }

    /// The value of a metric by name and part.
    pub fn metric(&self, of: Option<&str>, name: &str) -> Option<&Value> {
        metric(&self.metrics, of, name)
    }

    /// The samples that the frame time is taken from; `None` for a row without a result, even if it
    /// holds samples.
    pub fn timed(&self) -> Option<&[Vec<u64>]> {
        let samples = self.samples.as_ref().filter(|_| self.status == Status::Ok)?;
        match self.timing_source? {
            TimingSource::Device => samples.device_ns.as_deref(),
            TimingSource::Wall => Some(&samples.wall_ns),
        }
    }
}
