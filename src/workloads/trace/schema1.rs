//! Journals of schema 1, from before there were several workloads: read as rows of the general schema, never resumed.

use super::record::{ConfigurationRecord, StructureRecord, WORKLOAD};
use crate::device::DeviceInfo;
use crate::error::{Error, Result};
use crate::record::journal::{self, Journal};
use crate::record::row::{Input, Row, Settings};
use crate::record::run::{DeviceRecord, End, Environment, PlanRecord, Program, Provenance, Resumed};
use crate::record::schema;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Deserialize;
use serde_json::Value;
use std::collections::HashMap;
use std::path::Path;

/// What the first line says.
pub const SCHEMA: &str = "rtbench/1";

/// Reads a journal of schema 1 or of the current one.
///
/// # Errors
/// [`Error::Input`] with file and line for anything that is neither.
pub fn read(path: &Path) -> Result<Journal> {
    parse(path, &journal::bytes_of(path)?)
}

/// The JSON Schema of a line of such a journal. Rows without a result have the status `error` there.
pub fn json_schema() -> Value {
    let title = "A line of an rtbench journal (journal.jsonl), schema rtbench/1";
    let mut schema = schema::of::<Line>(title, SchemaSettings::draft2020_12().for_deserialize());
    if let Some(statuses) = schema.pointer_mut("/$defs/Status/oneOf").and_then(Value::as_array_mut) {
        let error = "The row has no result; `failure` tells why.";
        statuses.push(serde_json::json!({ "type": "string", "const": "error", "description": error }));
    }
    schema
}

/// Parses the bytes of a journal of either schema; `path` is for messages.
///
/// # Errors
/// As [`read`].
pub fn parse(path: &Path, bytes: &[u8]) -> Result<Journal> {
    if journal::schema_of(bytes).as_deref() != Some(SCHEMA) {
        return Journal::parse(path, bytes);
    }
    let (lines, truncated) = journal::lines(path, bytes, line)?;
    let mut lines = lines.into_iter();
    let Some((_, Line::Run(run))) = lines.next() else {
        return Err(Error::file(path, Some(1), "the first line is no run's provenance", ""));
    };
    let provenance = run.current();
    let settings = provenance.plan.settings;
    let mut journal = Journal {
        provenance,
        inputs: Vec::new(),
        artifacts: Vec::new(),
        rows: Vec::new(),
        resumed: Vec::new(),
        end: None,
        truncated,
        length: bytes.len() as u64,
    };
    let mut known: HashMap<crate::record::row::Key, usize> = HashMap::new();
    for (number, line) in lines {
        match line {
            Line::Run(_) => {
                let hint = "journals of several runs must not be joined";
                return Err(Error::file(path, Some(number), "a second provenance", hint));
            }
            Line::Structure(structure) => {
                add(&mut journal.inputs, structure.scene.to_input());
                journal.artifacts.push(structure.to_artifact());
            }
            Line::Configuration(record) => {
                add(&mut journal.inputs, record.scene.to_input());
                add(&mut journal.inputs, record.camera_path.to_input());
                let row = record.to_row(settings);
                put(&mut journal, &mut known, row);
            }
            Line::End(end) => journal.end = Some(end),
            Line::Resumed(resumed) => {
                journal.resumed.push(*resumed);
                journal.end = None;
            }
        }
    }
    Ok(journal)
}

fn add(inputs: &mut Vec<Input>, input: Input) {
    if !inputs.contains(&input) {
        inputs.push(input);
    }
}

/// Adds a row; only a resumed run measures a case again.
fn put(journal: &mut Journal, known: &mut HashMap<crate::record::row::Key, usize>, row: Row) {
    match known.get(&row.key) {
        Some(&index) if !journal.resumed.is_empty() => journal.rows[index] = row,
        _ => {
            known.insert(row.key.clone(), journal.rows.len());
            journal.rows.push(row);
        }
    }
}

#[derive(Deserialize, JsonSchema)]
#[serde(tag = "record", rename_all = "kebab-case")]
enum Line {
    Run(Box<Run>),
    Structure(Box<StructureRecord>),
    Configuration(Box<ConfigurationRecord>),
    End(End),
    Resumed(Box<Resumed>),
}

/// A line, with the status of a row as the current schema has it: `error` was told apart by `failure`.
fn line(bytes: &[u8]) -> serde_json::Result<Line> {
    let mut value: Value = serde_json::from_slice(bytes)?;
    if let Some(record) = value.as_object_mut().filter(|record| record.get("status").is_some_and(|s| s == "error")) {
        let wrong = record.get("failure").is_some_and(|failure| failure == "verification");
        record.insert("status".into(), if wrong { "wrong" } else { "failed" }.into());
    }
    serde_json::from_value(value)
}

#[derive(Deserialize, JsonSchema)]
struct Run {
    #[allow(dead_code)] // decided before; the schema of files tells it
    #[schemars(extend("const" = SCHEMA))]
    schema: String,
    program: Program,
    started: String,
    arguments: Vec<String>,
    device: DeviceInfo,
    device_reason: String,
    environment: Environment,
    plan: Plan,
}

#[derive(Deserialize, JsonSchema)]
struct Plan {
    preset: String,
    scenes: Vec<String>,
    structures: Vec<String>,
    configurations: usize,
    passes: usize,
    warmup_frames: usize,
    #[serde(default)]
    builds: usize,
    skipped: Vec<String>,
}

impl Run {
    fn current(self) -> Provenance {
        let Plan { preset, scenes, structures, configurations, passes, warmup_frames, builds, skipped } = self.plan;
        let axes = [("scene".to_owned(), scenes), ("structure".to_owned(), structures)].into();
        let settings = Settings { passes, warmup_frames, builds: builds.max(1), threads: 0 };
        Provenance {
            schema: SCHEMA.into(),
            id: String::new(),
            workload: WORKLOAD.into(),
            program: self.program,
            started: self.started,
            arguments: self.arguments,
            devices: vec![DeviceRecord { info: self.device, reason: self.device_reason }],
            environment: self.environment,
            plan: PlanRecord { preset, axes, rows: configurations, settings, absent: skipped, ..PlanRecord::default() },
            merged: Vec::new(),
        }
        .identified()
    }
}
