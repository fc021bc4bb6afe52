//! A baseline from a run.

use super::baseline::{Baseline, BaselineRow, Counts, FRAME_TIME};
use super::conditions::ComparedRun;
use crate::error::{Error, Result};
use crate::record::row::Status;
use crate::record::statistics::round;
use crate::record::stream::{LeanRow, Name, Names, is_metric};
use std::collections::{BTreeMap, BTreeSet};

/// The static cost of each kernel, by its name.
pub type KernelCosts = BTreeMap<String, Counts>;

/// Digits of a hash that a baseline keeps.
const DIGITS: usize = 16;

/// The baseline of a run. Budgets, and the share of rows that must be compared, are those of `before`.
///
/// # Errors
/// [`Error::Input`]: a row is wrong or failed, or there is no row with a result.
pub fn bless(
    names: &Names,
    run: &ComparedRun,
    kernels: &KernelCosts,
    machine: &[String],
    before: Option<&Baseline>,
) -> Result<Baseline> {
    let folder = &run.run.folder;
    let bad = |row: &&LeanRow| matches!(row.status, Status::Wrong | Status::Failed);
    if let Some(row) = run.run.rows.iter().find(bad) {
        let problem = format!("{} is {}: {}", key(names, row), row.status.word(), names.text(row.message));
        return Err(Error::file(folder, None, problem, "only a run whose rows are all verified is blessed"));
    }
    let mut baseline = Baseline::new(&run.run.provenance.workload);
    if let Some(before) = before {
        baseline.min_compared_share = before.min_compared_share;
        baseline.budgets = before.budgets.clone();
    }
    let with_times = baseline.budgets.contains_key(FRAME_TIME);
    baseline.kernels = kernels.clone();
    for artifact in &run.run.artifacts {
        baseline.artifacts.insert(axes_text(names, &artifact.axes), counts(names, &artifact.exact, machine));
    }
    let artifact_quantities: BTreeSet<String> =
        baseline.artifacts.values().flat_map(|counts| counts.keys().cloned()).collect();
    let mut quantities = BTreeSet::new();
    for row in run.run.rows.iter().filter(|row| row.status == Status::Ok) {
        let key = key(names, row);
        let mut held = BaselineRow { inputs: inputs(names, row), hashes: hashes(names, row), ..BaselineRow::default() };
        for (name, value) in counts(names, &row.exact, machine) {
            if artifact_quantities.contains(&name) {
                continue;
            }
            if value > 0 {
                let (part, short) = name.split_once('.').unwrap_or(("", &name));
                held.counts.entry(part.to_owned()).or_default().insert(short.to_owned(), value);
            }
            quantities.insert(name);
        }
        if let Some(times) = row.times.as_ref().filter(|_| with_times) {
            held.frame_ms = Some(round(times.mean_ms, 6));
            held.noise_pct = times.noise_pct.map(|noise| round(noise, 3));
        }
        if let Some(other) = baseline.rows.get(&key) {
            // A second device: what must agree across devices is held once
            if (&other.inputs, &other.counts) != (&held.inputs, &held.counts) {
                let problem = format!("{key}: two devices of the run have different counts");
                return Err(Error::file(folder, None, problem, "bless a run of one device"));
            }
            continue;
        }
        held.driver = Some(run.device(row).map_or(String::new(), |device| device.driver.clone()));
        baseline.driver = held.driver.clone().unwrap_or_default();
        baseline.rows.insert(key, held);
    }
    for row in baseline.rows.values_mut() {
        row.driver.take_if(|driver| *driver == baseline.driver);
    }
    if baseline.rows.is_empty() {
        let problem = "no row of it has a result";
        return Err(Error::file(folder, None, problem, "bless a run with verified rows"));
    }
    baseline.quantities = quantities.into_iter().collect();
    if let Some(name) = baseline.budget_without_quantity() {
        let problem = format!("the baseline has a budget for {name}, and no row of this run has such a quantity");
        return Err(Error::file(folder, None, problem, "remove the budget, or bless a run that has it"));
    }
    Ok(baseline)
}

/// A row's name in a baseline: its axes with a value, sorted.
pub(super) fn key(names: &Names, row: &LeanRow) -> String {
    axes_text(names, &row.axes)
}

/// Axes with a value, sorted by name.
pub(super) fn axes_text(names: &Names, axes: &[(Name, Name)]) -> String {
    let mut texts: Vec<String> = axes
        .iter()
        .filter(|(_, value)| !names.text(*value).is_empty())
        .map(|(axis, value)| format!("{}={}", names.text(*axis), names.text(*value)))
        .collect();
    texts.sort();
    texts.join("; ")
}

/// Whole numbers by name, without those of the machine.
pub(super) fn counts(names: &Names, exact: &[(Name, u64)], machine: &[String]) -> Counts {
    let named = exact.iter().map(|(name, value)| (names.text(*name).to_owned(), *value));
    named.filter(|(name, _)| !is_metric(name, machine)).collect()
}

fn short(hash: &str) -> String {
    hash.get(..DIGITS).unwrap_or(hash).to_owned()
}

/// The beginning of the content hash of each input.
pub(super) fn inputs(names: &Names, row: &LeanRow) -> BTreeMap<String, String> {
    row.inputs.iter().map(|(kind, hash)| (names.text(*kind).to_owned(), short(names.text(*hash)))).collect()
}

/// The beginning of each output's hash; of equal ones the first by name.
pub(super) fn hashes(names: &Names, row: &LeanRow) -> BTreeMap<String, String> {
    let mut all: Vec<(&str, &str)> =
        row.outputs.iter().map(|(name, hash)| (names.text(*name), names.text(*hash))).collect();
    all.sort_unstable();
    let mut hashes: BTreeMap<String, String> = BTreeMap::new();
    for (name, hash) in all {
        if !hashes.values().any(|known| *known == short(hash)) {
            hashes.insert(name.to_owned(), short(hash));
        }
    }
    hashes
}
