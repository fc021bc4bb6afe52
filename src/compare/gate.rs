//! A run against a baseline. What is exact must be equal or within a budget; times are judged only where the baseline
//! has a budget for them, on the driver that they are of, and beyond the noise of both sides.

mod scope;
mod write;

pub use write::{json, markdown, text};

use super::baseline::{Baseline, BaselineRow, Counts, FRAME_TIME};
use super::bless::{KernelCosts, axes_text, counts, hashes, inputs, key};
use super::conditions::ComparedRun;
use crate::error::{Error, Result};
use crate::record::row::Status;
use crate::record::stream::{LeanRow, Names};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A time is slower only beyond so many times the noise of both sides together.
const NOISE_FACTOR: f64 = 2.0;

/// Something that differs from the baseline.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// The row, artifact or kernel.
    pub row: String,
    /// The quantity; `status` for a row without a result.
    pub quantity: String,
    /// The baseline's value.
    pub old: String,
    /// The run's value.
    pub new: String,
}

/// What a gate found.
#[derive(Clone, Debug, Default)]
pub struct Judgement {
    /// What makes it red.
    pub failures: Vec<Finding>,
    /// Times that are slower by more than the budget, but not by more than the noise allows.
    pub ambiguous: Vec<Finding>,
    /// What passes and should be known.
    pub announcements: Vec<String>,
    /// Rows of the run.
    pub rows: usize,
    /// Of these, rows that the baseline has.
    pub rows_compared: usize,
    /// Exact quantities that were compared.
    pub exact_compared: usize,
    /// Hashes of the baseline that were not compared, because they are another driver's.
    pub hashes_left_out: usize,
    /// Times with a budget that were not judged: the baseline or the run has none, or they are another driver's.
    pub times_left_out: usize,
    /// Rows of the baseline that the plan of the run does not name.
    pub rows_outside: usize,
    /// True if no row of the run is wrong or failed.
    pub can_be_blessed: bool,
}

impl Judgement {
    /// True if nothing is red.
    pub fn is_green(&self) -> bool {
        self.failures.is_empty()
    }
}

/// Judges a run.
///
/// # Errors
/// [`Error::Input`]: run and baseline are of different workloads or inputs, or too few rows can be compared.
pub fn judge(
    names: &Names,
    run: &ComparedRun,
    kernels: &KernelCosts,
    machine: &[String],
    baseline: &Baseline,
    path: &Path,
) -> Result<Judgement> {
    let folder = &run.run.folder;
    let workload = &run.run.provenance.workload;
    if *workload != baseline.workload {
        let problem =
            format!("it is of `rtbench {}`, and {} is of `rtbench {workload}`", baseline.workload, folder.display());
        return Err(Error::file(path, None, problem, "give the baseline of this workload"));
    }
    let mut gate = Gate { names, machine, baseline, run, judgement: Judgement::default(), unknown: BTreeSet::new() };
    let mut seen: BTreeSet<String> = BTreeSet::new();
    let mut new: Vec<String> = Vec::new();
    for row in &run.run.rows {
        let key = key(names, row);
        gate.judgement.rows += 1;
        match baseline.rows.get(&key) {
            Some(held) => {
                gate.check_inputs(path, &key, row, held)?;
                gate.judgement.rows_compared += 1;
                gate.row(&key, row, held);
            }
            None if matches!(row.status, Status::Wrong | Status::Failed) => gate.without_result(&key, row, "no row"),
            None => new.push(key.clone()),
        }
        seen.insert(key);
    }
    gate.artifacts(&seen);
    gate.kernels(kernels);
    let vanished = scope::vanished(names, run, baseline, &seen);
    let mut judgement = gate.finished();
    for row in vanished.expected {
        judgement.failures.push(finding(row, "status", "ok", "no row"));
    }
    enough(&judgement, baseline, path, folder)?;
    let several = |list: &[String]| format!("{} such as {}", list.len(), list[0]);
    if !new.is_empty() {
        judgement.announcements.push(format!("rows without a baseline, which pass: {}", several(&new)));
    }
    judgement.rows_outside = vanished.outside;
    let has_result = |row: &LeanRow| !matches!(row.status, Status::Wrong | Status::Failed);
    judgement.can_be_blessed = run.run.rows.iter().all(has_result);
    if vanished.outside > 0 {
        let text = format!("{} rows of the baseline are not in the plan of this run", vanished.outside);
        judgement.announcements.push(text);
    }
    Ok(judgement)
}

/// Refuses to call a run green of which hardly anything was compared.
fn enough(judgement: &Judgement, baseline: &Baseline, path: &Path, folder: &Path) -> Result<()> {
    let share = judgement.rows_compared as f64 / judgement.rows.max(1) as f64;
    if judgement.rows_compared > 0 && share >= baseline.min_compared_share {
        return Ok(());
    }
    let problem = format!(
        "only {} of {} rows of {} are in the baseline, whose least share is {}",
        judgement.rows_compared,
        judgement.rows,
        folder.display(),
        baseline.min_compared_share
    );
    let hint = format!("`rtbench bless {} --baseline {}` takes them up", folder.display(), path.display());
    Err(Error::file(path, None, problem, hint))
}

fn finding(row: impl Into<String>, quantity: &str, old: impl ToString, new: impl ToString) -> Finding {
    Finding { row: row.into(), quantity: quantity.to_owned(), old: old.to_string(), new: new.to_string() }
}

/// A gate at work.
struct Gate<'a> {
    names: &'a Names,
    machine: &'a [String],
    baseline: &'a Baseline,
    run: &'a ComparedRun,
    judgement: Judgement,
    /// Quantities of the run that the baseline does not hold.
    unknown: BTreeSet<String>,
}

impl Gate<'_> {
    fn check_inputs(&self, path: &Path, key: &str, row: &LeanRow, held: &BaselineRow) -> Result<()> {
        let now = inputs(self.names, row);
        if now.is_empty() || now == held.inputs {
            return Ok(());
        }
        let differs = |(kind, hash): &(&String, &String)| held.inputs.get(*kind) != Some(*hash);
        let kinds: Vec<String> = now.iter().filter(differs).map(|(kind, _)| kind.replace('_', " ")).collect();
        let problem = format!("{} of {key} is not the one of the baseline", kinds.join(" and "));
        let hint = format!("measure the same inputs, or bless {}", self.run.run.folder.display());
        Err(Error::file(path, None, problem, hint))
    }

    fn without_result(&mut self, key: &str, row: &LeanRow, old: &str) {
        let message = format!("{}: {}", row.status.word(), self.names.text(row.message));
        self.judgement.failures.push(finding(key, "status", old, message));
    }

    fn compare(&mut self, row: &str, quantity: &str, old: u64, new: u64) {
        self.judgement.exact_compared += 1;
        if !self.baseline.budget(quantity).allows(old, new) {
            self.judgement.failures.push(finding(row, quantity, old, new));
        } else if old != new {
            let text = format!("within its budget: {row}: {quantity}: {old} -> {new}");
            self.judgement.announcements.push(text);
        }
    }

    fn row(&mut self, key: &str, row: &LeanRow, held: &BaselineRow) {
        if row.status != Status::Ok {
            return self.without_result(key, row, "ok");
        }
        let now = counts(self.names, &row.exact, self.machine);
        let baseline = self.baseline;
        for quantity in &baseline.quantities {
            let old = baseline.count(held, quantity);
            match now.get(quantity) {
                Some(&new) => self.compare(key, quantity, old, new),
                None if old > 0 => self.judgement.failures.push(finding(key, quantity, old, "none")),
                None => {}
            }
        }
        self.hashes(key, row, held);
        self.time(key, row, held);
    }

    /// True if the row was measured by the driver that the baseline's hash and time of it are of.
    fn is_same_driver(&self, row: &LeanRow, held: &BaselineRow) -> bool {
        let driver = held.driver.as_ref().unwrap_or(&self.baseline.driver);
        self.run.device(row).is_some_and(|device| device.driver == *driver)
    }

    fn hashes(&mut self, key: &str, row: &LeanRow, held: &BaselineRow) {
        if !self.is_same_driver(row, held) {
            self.judgement.hashes_left_out += held.hashes.len();
            return;
        }
        let now = hashes(self.names, row);
        for (output, old) in &held.hashes {
            self.judgement.exact_compared += 1;
            let new = now.get(output).map_or("none", String::as_str);
            if new != old {
                self.judgement.failures.push(finding(key, &format!("{output} hash"), old, new));
            }
        }
    }

    fn time(&mut self, key: &str, row: &LeanRow, held: &BaselineRow) {
        let Some(share) = self.baseline.budgets.get(FRAME_TIME).and_then(|budget| budget.share) else { return };
        let (Some(old), Some(times), true) = (held.frame_ms, row.times.as_ref(), self.is_same_driver(row, held)) else {
            self.judgement.times_left_out += 1;
            return;
        };
        if times.mean_ms <= old * (1.0 + share) {
            return;
        }
        let new = times.mean_ms;
        let noise = held.noise_pct.zip(times.noise_pct).map(|(old, new)| (old + new) / 100.0);
        let found = finding(key, FRAME_TIME, format!("{old:.4}"), format!("{new:.4}"));
        match noise {
            Some(noise) if new / old - 1.0 > NOISE_FACTOR * noise => self.judgement.failures.push(found),
            _ => self.judgement.ambiguous.push(found),
        }
    }

    /// What was built: artifacts that both have. One that is missing is expected where the run has a row of it.
    fn artifacts(&mut self, rows: &BTreeSet<String>) {
        let (run, baseline) = (self.run, self.baseline);
        let built: BTreeSet<String> = run.run.artifacts.iter().map(|a| axes_text(self.names, &a.axes)).collect();
        for (name, held) in baseline.artifacts.iter().filter(|(name, _)| !built.contains(*name)) {
            let is_of = |row: &String| {
                let axes: Vec<&str> = row.split("; ").collect();
                name.split("; ").all(|axis| axes.contains(&axis))
            };
            if !held.is_empty() && rows.iter().any(is_of) {
                self.judgement.failures.push(finding(name, "status", "built", "gone"));
            }
        }
        for artifact in &run.run.artifacts {
            let name = axes_text(self.names, &artifact.axes);
            let now = counts(self.names, &artifact.exact, self.machine);
            if let Some(held) = self.baseline.artifacts.get(&name) {
                self.counts(&name, held, &now);
            }
        }
    }

    fn counts(&mut self, row: &str, held: &Counts, now: &Counts) {
        for (quantity, old) in held {
            match now.get(quantity) {
                Some(new) => self.compare(row, quantity, *old, *new),
                None => self.judgement.failures.push(finding(row, quantity, old, "none")),
            }
        }
        let new = now.keys().filter(|quantity| !held.contains_key(*quantity));
        self.unknown.extend(new.cloned());
    }

    fn kernels(&mut self, costs: &KernelCosts) {
        let baseline = self.baseline;
        for (kernel, held) in &baseline.kernels {
            let name = format!("kernel {kernel}");
            match costs.get(kernel) {
                Some(now) => self.counts(&name, held, now),
                None => self.judgement.failures.push(finding(name, "status", "there", "gone")),
            }
        }
        let new: Vec<&String> = costs.keys().filter(|kernel| !baseline.kernels.contains_key(*kernel)).collect();
        if let Some(first) = new.first() {
            let text = format!("kernels without a baseline, which pass: {} such as {first}", new.len());
            self.judgement.announcements.push(text);
        }
    }

    fn finished(mut self) -> Judgement {
        let held: BTreeSet<&String> = self.baseline.quantities.iter().collect();
        let of_artifacts: BTreeSet<&String> = self.baseline.artifacts.values().flat_map(BTreeMap::keys).collect();
        for row in &self.run.run.rows {
            for name in counts(self.names, &row.exact, self.machine).into_keys() {
                if !held.contains(&name) && !of_artifacts.contains(&name) {
                    self.unknown.insert(name);
                }
            }
        }
        if !self.unknown.is_empty() {
            let list = self.unknown.iter().cloned().collect::<Vec<_>>().join(", ");
            self.judgement.announcements.push(format!("quantities that the baseline does not hold: {list}"));
        }
        if self.judgement.times_left_out > 0 {
            let text = format!(
                "{} times have a budget and were not judged: the baseline or the run has none, or they are not of {}; \
                 bless again after a budget for {FRAME_TIME} was added",
                self.judgement.times_left_out, self.baseline.driver
            );
            self.judgement.announcements.push(text);
        }
        if self.judgement.hashes_left_out > 0 {
            let text = format!(
                "{} hashes were not compared: they are of {}",
                self.judgement.hashes_left_out, self.baseline.driver
            );
            self.judgement.announcements.push(text);
        }
        self.judgement
    }
}
