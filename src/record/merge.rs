//! Several runs of one plan as one run.

use super::journal::Journal;
use super::row::{Artifact, Input, Key, Row, Status, Value};
use super::run::{MergedRun, Provenance, Shard};
use crate::error::{Error, Result};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Flags of a command line that belong to one part or one folder, each with a value.
const OWN_FLAGS: [&str; 3] = ["--shard", "--out", "--resume"];

/// Endings of the names of metrics that depend on the moment or the machine, not on what was measured.
const VARYING: [&str; 3] = ["_ms", "_s", "_threads"];

/// Runs as one.
#[derive(Debug)]
pub struct Merged {
    /// Its first line.
    pub provenance: Provenance,
    /// Each once.
    pub inputs: Vec<Input>,
    /// Each once: that of the first run that has it.
    pub artifacts: Vec<Artifact>,
    /// Each once: in the order of shards, then of measuring.
    pub rows: Vec<Row>,
    /// Parts of the plan that none of the runs is.
    pub missing: Vec<Shard>,
    /// Rows that several runs have, with equal results; the first one is kept.
    pub duplicates: usize,
}

impl Merged {
    /// Number of planned rows that no run has.
    pub fn gaps(&self) -> usize {
        self.provenance.plan.total.saturating_sub(self.rows.len())
    }
}

/// A run with its journal's path, for messages.
pub type Part = (PathBuf, Journal);

/// Merges runs. The order in which they are given does not matter.
///
/// # Errors
/// [`Error::Input`] for runs that do not belong together: another workload, program, plan or settings, an input of
/// another content, one row with two results.
pub fn merge(mut parts: Vec<Part>) -> Result<Merged> {
    parts.sort_by_key(|(_, journal)| (journal.provenance.plan.shard, journal.provenance.started.clone()));
    let Some((first_path, first)) = parts.first() else {
        return Err(Error::argument("DIR", "there is no run to merge", "give the folders of the runs"));
    };
    for (path, journal) in &parts {
        check_program_and_plan(path, &journal.provenance, first_path, &first.provenance)?;
    }
    let mut provenance = first.provenance.clone();
    provenance.devices.clear();
    provenance.merged.clear();
    provenance.started = parts.iter().map(|(_, j)| j.provenance.started.clone()).min().unwrap_or_default();
    provenance.arguments = whole_command(&provenance.arguments);
    provenance.plan.shard = None;
    provenance.plan.rows = provenance.plan.total;
    provenance.plan.work = 0;
    let (mut inputs, mut artifacts): (Vec<Input>, Vec<Artifact>) = (Vec::new(), Vec::new());
    let mut rows: Vec<(Row, usize)> = Vec::new();
    let (mut index_of, mut built) = (HashMap::new(), HashMap::new());
    let (mut shards, mut duplicates) = (Vec::new(), 0);
    for (number, (path, journal)) in parts.iter().enumerate() {
        let devices = add_devices(&mut provenance, &journal.provenance);
        add_inputs(&mut inputs, path, &journal.inputs)?;
        for artifact in &journal.artifacts {
            built.entry(artifact.key.clone()).or_insert_with(|| artifacts.push(artifact.clone()));
        }
        provenance.plan.work += journal.provenance.plan.work;
        shards.extend(shards_of(&journal.provenance));
        for row in &journal.rows {
            let role = journal.provenance.role(row.device);
            let mut own = row.clone();
            own.device = devices.get(row.device).copied().unwrap_or(row.device);
            match index_of.get(&(row.key.clone(), role)) {
                None => {
                    index_of.insert((row.key.clone(), role), rows.len());
                    rows.push((own, number));
                }
                Some(&at) => {
                    let (known, of) = &mut rows[at];
                    duplicates += 1;
                    match (known.status, own.status) {
                        (Status::Failed, _) => (*known, *of) = (own, number),
                        (_, Status::Failed) => {}
                        _ => check_equal(&own, path, known, &parts[*of].0)?,
                    }
                }
            }
        }
    }
    let count = shards.iter().map(|shard| shard.count).max().unwrap_or(0);
    let missing = (1..=count).map(|index| Shard { index, count }).filter(|shard| !shards.contains(shard)).collect();
    let rows = rows.into_iter().map(|(row, _)| row).collect();
    Ok(Merged { provenance: provenance.identified(), inputs, artifacts, rows, missing, duplicates })
}

/// The parts of the plan that a run is; none where it is all of it.
fn shards_of(provenance: &Provenance) -> Vec<Shard> {
    match provenance.merged.as_slice() {
        [] => provenance.plan.shard.into_iter().collect(),
        merged => merged.iter().filter_map(|run| run.shard).collect(),
    }
}

fn check_program_and_plan(path: &Path, run: &Provenance, first_path: &Path, first: &Provenance) -> Result<()> {
    let (a, b) = (&run.program, &first.program);
    let (p, q) = (&run.plan, &first.plan);
    let shards: Vec<Shard> = shards_of(run).into_iter().chain(shards_of(first)).collect();
    let what = if run.workload != first.workload {
        format!("it is a run of `{}`, not of `{}`", run.workload, first.workload)
    } else if a.version != b.version || a.git_revision != b.git_revision || a.git_dirty != b.git_dirty {
        let name = |p: &super::run::Program| {
            let changed = if p.git_dirty == Some(true) { ", changed" } else { "" };
            format!("{} ({}{changed})", p.version, p.git_revision)
        };
        format!("another program measured it: {}, not {}", name(a), name(b))
    } else if (&a.lock_hash, &a.packages, &a.profile, &a.rustc) != (&b.lock_hash, &b.packages, &b.profile, &b.rustc) {
        "its program was built with other packages, another profile or another compiler".into()
    } else if p.settings != q.settings {
        "passes, warm-up, builds or threads are not the same".into()
    } else if p.hash.is_empty() || p.hash != q.hash || p.total != q.total {
        "it is a part of another plan".into()
    } else if shards.iter().any(|shard| shard.count != shards[0].count) {
        "the plan is divided into another number of shards".into()
    } else {
        return Ok(());
    };
    let hint = format!("merge runs of one plan by one program: it does not belong to {}", first_path.display());
    Err(Error::file(path, Some(1), what, hint))
}

/// Adds the devices of a run; returns the index of each. The same devices in the same machine are one.
fn add_devices(merged: &mut Provenance, run: &Provenance) -> Vec<usize> {
    let own = MergedRun {
        id: run.id.clone(),
        started: run.started.clone(),
        shard: run.plan.shard,
        devices: (0..run.devices.len()).collect(),
        environment: run.environment.clone(),
        executable_hash: run.program.executable_hash.clone(),
    };
    let runs = if run.merged.is_empty() { vec![own] } else { run.merged.clone() };
    let mut indices = vec![0; run.devices.len()];
    for one in runs {
        let devices: Vec<_> = one.devices.iter().filter_map(|&device| run.devices.get(device)).cloned().collect();
        let same = merged.merged.iter().find(|known| {
            let known_devices = known.devices.iter().map(|&device| &merged.devices[device].info);
            known.environment.machine() == one.environment.machine()
                && known_devices.eq(devices.iter().map(|device| &device.info))
        });
        let now: Vec<usize> = match same {
            Some(known) => known.devices.clone(),
            None => (merged.devices.len()..merged.devices.len() + devices.len()).collect(),
        };
        if same.is_none() {
            merged.devices.extend(devices);
        }
        one.devices.iter().zip(&now).for_each(|(&before, &after)| indices[before] = after);
        merged.merged.push(MergedRun { devices: now, ..one });
    }
    indices
}

fn add_inputs(inputs: &mut Vec<Input>, path: &Path, more: &[Input]) -> Result<()> {
    for input in more {
        match inputs.iter().find(|known| known.kind == input.kind && known.name == input.name) {
            None => inputs.push(input.clone()),
            Some(known) if known.hash == input.hash => {}
            Some(_) => {
                let problem = format!("{} {} is another one than in the other runs", input.kind, input.name);
                return Err(Error::file(path, None, problem, "use the same files on all machines"));
            }
        }
    }
    Ok(())
}

/// Refuses two rows of one key with different results. Times may differ.
fn check_equal(row: &Row, path: &Path, known: &Row, known_path: &Path) -> Result<()> {
    let exact = |row: &Row| -> Vec<(String, Value)> {
        let fixed = row.metrics.iter().filter(|m| !VARYING.iter().any(|end| m.name.ends_with(end)));
        fixed.map(|m| (m.column(), m.value.clone())).collect()
    };
    let what = if row.status != known.status {
        Some(("status".to_owned(), row.status.word().to_owned(), known.status.word().to_owned()))
    } else if row.outputs != known.outputs {
        Some(("outputs".to_owned(), format!("{:?}", row.outputs), format!("{:?}", known.outputs)))
    } else {
        let (own, other) = (exact(row), exact(known));
        let differs = own.iter().zip(&other).find(|(a, b)| a.0 != b.0 || !agree(&a.1, &b.1));
        differs.map(|(a, b)| (a.0.clone(), a.1.write(), b.1.write()))
    };
    let Some((quantity, own, other)) = what else { return Ok(()) };
    let Key { axes, .. } = &row.key;
    let name: Vec<&str> = axes.values().map(String::as_str).filter(|value| !value.is_empty()).collect();
    let problem = format!("{}: {quantity} is {own}, but {other} in {}", name.join(" "), known_path.display());
    Err(Error::file(path, None, problem, "one of both runs is wrong: measure this case again"))
}

/// Whole numbers and texts agree if they are equal; fractions within a millionth, since the order of a device's sums
/// may depend on timing.
fn agree(a: &Value, b: &Value) -> bool {
    match (a.integer().or(b.integer()), a.number(), b.number()) {
        (None, Some(a), Some(b)) => a == b || (a - b).abs() <= 1e-6 * a.abs().max(b.abs()),
        _ => a == b,
    }
}

/// A command line without the flags that belong to one part.
fn whole_command(arguments: &[String]) -> Vec<String> {
    let mut kept = Vec::new();
    let mut arguments = arguments.iter();
    while let Some(argument) = arguments.next() {
        if OWN_FLAGS.contains(&argument.as_str()) {
            arguments.next();
        } else if !OWN_FLAGS.iter().any(|flag| argument.strip_prefix(flag).is_some_and(|rest| rest.starts_with('='))) {
            kept.push(argument.clone());
        }
    }
    kept
}
