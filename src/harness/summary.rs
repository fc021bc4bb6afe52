//! `summary.csv`, `run.json` and the terminal's table: pure functions of a journal and of the workload's description.
//!
//! The CSV file, the JSON and the table take their values from the same wide rows. Numbers are rounded once, here and
//! in [`Workload::derived`], so that all of them say the same.

use super::workload::Workload;
use crate::device::DeviceType;
use crate::error::{Error, Result};
use crate::record::files;
use crate::record::journal::{Journal, RunDocument};
use crate::record::row::{Row, Samples, Status, TimingSource, Value};
use crate::record::statistics;
use crate::record::terminal;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// Columns of every workload, after its axes.
const TIMES: [&str; 11] = [
    "passes",
    "frame_ms_min",
    "frame_ms_max",
    "frame_ms_mean",
    "frame_ms_p95",
    "noise_pct",
    "timing_source",
    "wall_ms_mean",
    "device_ms_mean",
    "pass_overhead",
    "interleaved_with",
];

/// Columns of every workload, at the end.
const RESULT: [&str; 7] = ["fetch", "kernel_hash", "shader_checks", "verified", "status", "message", "warnings"];

/// A run's rows as a table: one column per axis and metric.
#[derive(Clone, Debug, PartialEq)]
pub struct Wide {
    /// Names.
    pub columns: Vec<String>,
    /// One value per column; `None` where a column has no meaning for a row.
    pub rows: Vec<Vec<Option<Value>>>,
}

impl Wide {
    /// The rows of a journal. Rows of the same artifact follow each other, although they were timed interleaved with
    /// others.
    pub fn new(workload: &dyn Workload, journal: &Journal) -> Wide {
        let info = workload.info();
        let axes = info.axes.iter().map(|axis| axis.name);
        let stages = stages(journal);
        let columns: Vec<String> = ["device", "device_type"]
            .into_iter()
            .chain(axes)
            .chain(TIMES)
            .chain(info.columns.iter().copied())
            .map(str::to_owned)
            .chain(stages.iter().map(|stage| format!("{}_ms_mean", stage.replace('-', "_"))))
            .chain((!stages.is_empty()).then(|| BETWEEN_STAGES.to_owned()))
            .chain(RESULT.map(str::to_owned))
            .collect();
        let rows = sorted(workload, journal).into_iter().map(|row| {
            let values = Values::new(workload, journal, row);
            columns.iter().map(|column| values.get(column)).collect()
        });
        Wide { rows: rows.collect(), columns }
    }

    /// Index of a column.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column == name)
    }

    /// As CSV, with a header.
    ///
    /// # Errors
    /// None in practice: the writer is memory.
    pub fn csv(&self) -> Result<Vec<u8>> {
        let failed = |e: csv::Error| Error::output(Path::new("CSV"), std::io::Error::other(e));
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(&self.columns).map_err(failed)?;
        for row in &self.rows {
            let cells = row.iter().map(|value| value.as_ref().map_or(String::new(), Value::write));
            writer.write_record(cells).map_err(failed)?;
        }
        writer.into_inner().map_err(|e| Error::output(Path::new("CSV"), e.into_error()))
    }

    /// The values of each row by column; `None` where there is no value.
    fn objects(&self) -> Vec<BTreeMap<String, Option<Value>>> {
        let object = |row: &Vec<Option<Value>>| self.columns.iter().cloned().zip(row.iter().cloned()).collect();
        self.rows.iter().map(object).collect()
    }
}

/// The stages that occur in a journal's samples, in their order.
fn stages(journal: &Journal) -> Vec<String> {
    let mut stages: Vec<String> = Vec::new();
    for stage in journal.rows.iter().filter_map(|row| row.samples.as_ref()).flat_map(|samples| &samples.stages) {
        if !stages.contains(stage) {
            stages.push(stage.clone());
        }
    }
    stages
}

/// The rows with those of the same artifact together, each where its first row was measured.
fn sorted<'j>(workload: &dyn Workload, journal: &'j Journal) -> Vec<&'j Row> {
    let axes = workload.info().axes;
    let first_two = axes.iter().take(2).map(|axis| axis.name);
    let key_axes: Vec<&str> = first_two.chain(axes.iter().filter(|axis| !axis.is_flag).map(|axis| axis.name)).collect();
    let key = |row: &Row| -> Vec<String> {
        let inputs = row.key.inputs.values().cloned();
        key_axes.iter().map(|axis| row.key.axis(axis).to_owned()).chain(inputs).collect()
    };
    let keys: Vec<Vec<String>> = journal.rows.iter().map(key).collect();
    let first = |index: usize| keys.iter().position(|known| *known == keys[index]).unwrap_or(index);
    let mut order: Vec<usize> = (0..journal.rows.len()).collect();
    order.sort_by_key(|&index| first(index));
    order.into_iter().map(|index| &journal.rows[index]).collect()
}

/// The values of a row by column.
struct Values<'j> {
    journal: &'j Journal,
    row: &'j Row,
    frames: Option<statistics::FrameStatistics>,
    derived: Vec<crate::record::row::Metric>,
}

impl<'j> Values<'j> {
    fn new(workload: &dyn Workload, journal: &'j Journal, row: &'j Row) -> Values<'j> {
        let frames = row.timed().and_then(statistics::frames);
        Values { journal, row, frames, derived: workload.derived(row, frames.as_ref()) }
    }

    fn get(&self, column: &str) -> Option<Value> {
        let row = self.row;
        let ms = |value: fn(&statistics::FrameStatistics) -> f64| {
            self.frames.as_ref().map(|frames| Value::Number(statistics::round(value(frames), 6)))
        };
        let samples = row.samples.as_ref().filter(|_| row.status == Status::Ok);
        let mean_of =
            |ns: &[Vec<u64>]| statistics::frames(ns).map(|frames| Value::Number(statistics::round(frames.mean_ms, 6)));
        let device = self.journal.provenance.devices.get(row.device).map(|device| &device.info);
        match column {
            "device" => device.map(|device| device.name.as_str().into()),
            "device_type" => device.map(|device| device.device_type.slug().into()),
            "passes" => Some(row.settings.passes.into()),
            "frame_ms_min" => ms(|f| f.min_ms),
            "frame_ms_max" => ms(|f| f.max_ms),
            "frame_ms_mean" => ms(|f| f.mean_ms),
            "frame_ms_p95" => ms(|f| f.p95_ms),
            "noise_pct" => self.frames.as_ref()?.noise_pct.map(|noise| statistics::round(noise, 3).into()),
            "timing_source" => {
                let source = row.timing_source.filter(|_| self.frames.is_some())?;
                Some(format!("{source:?}").to_lowercase().into())
            }
            "wall_ms_mean" => mean_of(&samples?.wall_ns),
            // Broken timestamps are not shown
            "device_ms_mean" if row.timing_source == Some(TimingSource::Device) => {
                mean_of(samples?.device_ns.as_deref()?)
            }
            "device_ms_mean" => None,
            "pass_overhead" => {
                let frames: u64 = row.timed()?.iter().flatten().sum();
                let passes: u64 = samples?.pass_ns.iter().sum();
                (frames > 0).then(|| statistics::round(passes as f64 / frames as f64, 4).into())
            }
            "interleaved_with" => (row.interleaved_with > 0).then(|| row.interleaved_with.into()),
            "fetch" => row.kernels.first().map(|kernel| kernel.fetch.as_str().into()),
            "kernel_hash" => {
                let hashes: Vec<&str> = row.kernels.iter().map(|kernel| kernel.hash.as_str()).collect();
                (!hashes.is_empty()).then(|| hashes.join(" ").into())
            }
            "shader_checks" => {
                let checked = device.is_some_and(|device| device.checked) || row.kernels.iter().any(|k| k.checked);
                Some(checked.into())
            }
            "verified" => Some((row.status == Status::Ok).into()),
            "status" => Some(row.status.word().into()),
            "message" => (!row.message.is_empty()).then(|| row.message.as_str().into()),
            "warnings" => (!row.warnings.is_empty()).then(|| row.warnings.join("; ").into()),
            _ => self.of_workload(column),
        }
    }

    /// An axis, a metric, a derived value, an output's hash, a fact about an input, or a stage's time.
    fn of_workload(&self, column: &str) -> Option<Value> {
        let row = self.row;
        if let Some(value) = row.key.axes.get(column) {
            return Some(value.as_str().into());
        }
        if let Some(metric) = self.derived.iter().chain(&row.metrics).find(|metric| metric.column() == column) {
            return Some(metric.value.clone());
        }
        if let Some(hash) = column.strip_suffix("_hash").and_then(|output| row.outputs.get(output)) {
            return Some(hash.as_str().into());
        }
        let kinds = row.key.inputs.keys().filter_map(|kind| self.journal.input(&row.key, kind));
        if let Some(metric) = kinds.flat_map(|input| &input.metrics).find(|metric| metric.column() == column) {
            return Some(metric.value.clone());
        }
        let by_device = row.status == Status::Ok && row.timing_source == Some(TimingSource::Device);
        let samples = row.samples.as_ref().filter(|_| by_device)?;
        if column == BETWEEN_STAGES {
            return between_stages(samples);
        }
        let stage = samples.stages.iter().position(|stage| format!("{}_ms_mean", stage.replace('-', "_")) == column)?;
        let stage_ns = samples.stage_ns.as_ref()?;
        let of_stage: Option<Vec<Vec<u64>>> = stage_ns
            .iter()
            .map(|pass| pass.iter().map(|frame| frame.get(stage).copied()).collect::<Option<Vec<u64>>>())
            .collect();
        statistics::frames(&of_stage?).map(|frames| statistics::round(frames.mean_ms, 6).into())
    }
}

/// The time of a frame that is in none of its stages.
const BETWEEN_STAGES: &str = "between_stages_ms_mean";

fn between_stages(samples: &Samples) -> Option<Value> {
    let (whole, stages) = (samples.device_ns.as_ref()?, samples.stage_ns.as_ref()?);
    let rest = |(whole, stages): (&Vec<u64>, &Vec<Vec<u64>>)| -> Vec<u64> {
        whole.iter().zip(stages).map(|(&frame, stages)| frame.saturating_sub(stages.iter().sum())).collect()
    };
    let rest: Vec<Vec<u64>> = whole.iter().zip(stages).map(rest).collect();
    statistics::frames(&rest).map(|frames| statistics::round(frames.mean_ms, 6).into())
}

/// Writes `summary.csv`, `run.json` and the workload's own files into a run's folder, each whole or not at all.
///
/// # Errors
/// [`Error::Output`].
pub fn write(workload: &dyn Workload, journal: &Journal, folder: &Path) -> Result<()> {
    let wide = Wide::new(workload, journal);
    files::replace(&folder.join("summary.csv"), &wide.csv()?)?;
    for (name, content) in workload.files(journal)? {
        files::replace(&folder.join(name), &content)?;
    }
    let path = folder.join("run.json");
    let failed = |e: serde_json::Error| Error::output(&path, e.into());
    let json = serde_json::to_value(RunDocument::new(journal, wide.objects())).map_err(failed)?;
    let mut bytes = serde_json::to_vec_pretty(&json).map_err(failed)?;
    bytes.push(b'\n');
    files::replace(&path, &bytes)
}

/// A row's name in messages: the values of its axes that are set by flags.
pub fn label(workload: &dyn Workload, row: &Row) -> String {
    let axes = workload.info().axes.iter().filter(|axis| axis.in_label);
    let derived = workload.derived(row, None);
    let value = |name: &str| {
        let shown = derived.iter().find(|metric| metric.name == format!("{name}_label")).map(|m| m.value.write());
        shown.unwrap_or_else(|| row.key.axis(name).to_owned())
    };
    axes.map(|axis| value(axis.name)).filter(|value| !value.is_empty()).collect::<Vec<_>>().join(" ")
}

/// Everything that a run has to say at its end.
pub fn terminal(workload: &dyn Workload, journal: &Journal) -> String {
    let info = workload.info();
    let mut text = workload.artifacts_table(journal);
    for device in &journal.provenance.devices {
        text += &format!("{}\n", device.info.description());
        if device.info.checked && device.info.device_type != DeviceType::CpuTwin {
            text += "shader checks were on\n";
        }
    }
    let subject = info.axes.first().map_or("", |axis| axis.name);
    let mut subjects: Vec<&str> = Vec::new();
    for row in &journal.rows {
        if !subjects.contains(&row.key.axis(subject)) {
            subjects.push(row.key.axis(subject));
        }
    }
    for name in subjects {
        let rows: Vec<&Row> = journal.rows.iter().filter(|row| row.key.axis(subject) == name).collect();
        text += &format!("\n{name}\n{}\n", table(workload, journal, &rows));
    }
    for rows in without_result(journal) {
        let (row, others) = (rows[0], rows.len() - 1);
        let others = if others > 0 { format!(" and {others} more") } else { String::new() };
        text += &format!("{}: {}{others}: {}\n", row.status.word(), label(workload, row), row.message);
    }
    for (warning, rows) in warnings(journal) {
        let (first, others) = (label(workload, rows[0]), rows.len() - 1);
        let others = if others > 0 { format!(" and {others} more") } else { String::new() };
        text += &format!("warning: {first}{others}: {warning}\n");
    }
    if !info.table_note.is_empty() {
        text += &format!("{}\n", info.table_note);
    }
    text
}

/// Each warning with the rows that have it, in the order of the first of them.
fn warnings(journal: &Journal) -> Vec<(&str, Vec<&Row>)> {
    let mut groups: Vec<(&str, Vec<&Row>)> = Vec::new();
    let mut index = HashMap::new();
    for row in &journal.rows {
        for warning in &row.warnings {
            let at = *index.entry(warning.as_str()).or_insert_with(|| {
                groups.push((warning, Vec::new()));
                groups.len() - 1
            });
            groups[at].1.push(row);
        }
    }
    groups
}

/// The rows without a result, those of equal status and message together.
fn without_result(journal: &Journal) -> Vec<Vec<&Row>> {
    let mut groups: Vec<Vec<&Row>> = Vec::new();
    for row in journal.rows.iter().filter(|row| row.status != Status::Ok) {
        let same = |group: &&mut Vec<&Row>| (group[0].status, &group[0].message) == (row.status, &row.message);
        match groups.iter_mut().find(same) {
            Some(group) => group.push(row),
            None => groups.push(vec![row]),
        }
    }
    groups
}

/// The table of one subject's rows: group by group in the order of measuring, the fastest first.
fn table(workload: &dyn Workload, journal: &Journal, rows: &[&Row]) -> String {
    let info = workload.info();
    let group =
        |row: &Row| -> Vec<String> { info.table_groups.iter().map(|axis| row.key.axis(axis).to_owned()).collect() };
    let mut groups: Vec<Vec<String>> = Vec::new();
    for row in rows {
        if !groups.contains(&group(row)) {
            groups.push(group(row));
        }
    }
    let mut lines = Vec::new();
    for (index, of_group) in groups.iter().enumerate() {
        if index > 0 {
            lines.push(Vec::new());
        }
        let mut rows: Vec<(f64, &&Row)> = rows
            .iter()
            .filter(|row| group(row) == *of_group)
            .map(|row| (row.timed().and_then(statistics::frames).map_or(f64::INFINITY, |f| f.mean_ms), row))
            .collect();
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, row) in rows {
            let values = Values::new(workload, journal, row);
            let cell = |column: &str| match column {
                "result" => match row.status {
                    Status::Ok => "verified".to_owned(),
                    Status::Skipped => "skipped".to_owned(),
                    Status::Wrong => "WRONG".to_owned(),
                    Status::Failed => "FAILED".to_owned(),
                },
                _ => match values.get(column) {
                    Some(Value::Text(text)) => text,
                    Some(Value::Flag(flag)) => flag.to_string(),
                    number => terminal::number(number.and_then(|value| value.number())),
                },
            };
            lines.push(info.table.iter().map(|(column, _)| cell(column)).collect());
        }
    }
    let headings: Vec<&str> = info.table.iter().map(|(_, heading)| *heading).collect();
    terminal::table(&headings, info.table_groups.len() + 1, &lines)
}
