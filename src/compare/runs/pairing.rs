//! Rows of several runs, paired by their axes.

use super::exact;
use super::verdict::{self, Verdict, apart};
use super::{Comparison, Mean, Options, PairedRow, Side};
use crate::compare::conditions::{ComparedRun, Difference, GENERAL, differences};
use crate::error::{Error, Result};
use crate::record::row::Status;
use crate::record::statistics::{geometric_mean, median};
use crate::record::stream::{LeanRow, Name, Names};
use crate::record::terminal::spelt_out;
use std::collections::{BTreeMap, HashMap};

/// What a row is paired by.
type PairKey<'r> = (&'r [(Name, Name)], usize);

/// Compares sides, the last one with the first one.
///
/// # Errors
/// [`Error::Input`]: the runs are of different workloads, no row of one side is on the other, or no pair of rows was
/// measured under like conditions.
pub fn compare(names: &mut Names, runs: Vec<ComparedRun>, sides: Vec<Side>, options: &Options) -> Result<Comparison> {
    check_workloads(&runs)?;
    let names: &Names = names;
    let machine = names.of_metrics(&options.machine);
    let role = |run: &ComparedRun, row: &LeanRow| run.run.provenance.role(row.device);
    let with_device = runs.iter().any(|run| run.run.rows.iter().any(|row| role(run, row) > 0));
    let mut places: HashMap<PairKey, usize, foldhash::fast::RandomState> = HashMap::default();
    // Of each row, its index in each run
    let mut found: Vec<Vec<Option<u32>>> = Vec::new();
    for (index, run) in runs.iter().enumerate() {
        for (place, row) in run.run.rows.iter().enumerate() {
            let at = *places.entry((&row.axes, role(run, row))).or_insert_with(|| {
                found.push(vec![None; runs.len()]);
                found.len() - 1
            });
            found[at][index] = Some(place as u32);
        }
    }
    drop(places);
    let labels = Labels::new(names, &runs, &options.axes, with_device);
    let mut comparison = Comparison {
        changes: Vec::new(),
        exact_compared: 0,
        rows: Vec::new(),
        means: Vec::new(),
        notes: Vec::new(),
        runs,
        sides,
    };
    let mut unlike: BTreeMap<Difference, usize> = BTreeMap::new();
    let (mut pairs, mut like, mut broken) = (0, 0, 0);
    for of_runs in &found {
        let rows: Vec<Option<(&ComparedRun, &LeanRow)>> = comparison
            .runs
            .iter()
            .zip(of_runs)
            .map(|(run, place)| place.map(|place| (run, &run.run.rows[place as usize])))
            .collect();
        let Some((_, any)) = rows.iter().flatten().next() else { continue };
        let mut row = PairedRow {
            label: labels.label(names, any),
            groups: labels.groups(any),
            times_ms: comparison.sides.iter().map(|side| side_time(side, &rows)).collect(),
            ratio: None,
            verdict: Verdict::Ambiguous,
        };
        let index = comparison.rows.len();
        let outcome = judge(names, &comparison.sides, &rows, options);
        if outcome.is_pair {
            pairs += 1;
            like += usize::from(outcome.unlike.iter().all(|unlike| options.across.contains(&unlike.condition)));
        }
        comparison.exact_compared += exact_of(names, &rows, index, &machine, options, &mut comparison.changes);
        // Sides in between: what must not be compared is not shown with the others
        let last = comparison.sides.len().saturating_sub(1);
        for (number, side) in comparison.sides.iter().enumerate().take(last).skip(1) {
            let first = comparison.sides[0].runs.iter().find_map(|&run| rows[run]);
            for other in side.runs.iter().filter_map(|&run| rows[run]) {
                let found = first.map_or(Vec::new(), |first| differences(names, first, other));
                if found.iter().any(|difference| !options.across.contains(&difference.condition)) {
                    row.times_ms[number] = None;
                }
                found.into_iter().for_each(|difference| *unlike.entry(difference).or_default() += 1);
                broken += usize::from(other.1.status != Status::Ok);
            }
        }
        for difference in outcome.unlike {
            *unlike.entry(difference).or_default() += 1;
        }
        (row.ratio, row.verdict) = (outcome.ratio, outcome.verdict);
        comparison.rows.push(row);
    }
    refuse(&comparison, &unlike, pairs, like, options)?;
    comparison.means = means(names, &comparison.rows, &labels);
    comparison.notes = notes(&comparison, &unlike, options);
    if broken > 0 {
        comparison.notes.push(format!("{broken} rows of sides in between have no result"));
    }
    Ok(comparison)
}

fn check_workloads(runs: &[ComparedRun]) -> Result<()> {
    let Some(first) = runs.first() else { return Ok(()) };
    match runs.iter().find(|run| run.run.provenance.workload != first.run.provenance.workload) {
        Some(other) => {
            let (other, first) = (&other.run, &first.run);
            let problem = format!(
                "it is a run of `rtbench {}`, and {} is one of `rtbench {}`",
                other.provenance.workload,
                first.folder.display(),
                first.provenance.workload
            );
            Err(Error::file(&other.folder, None, problem, "compare runs of one workload"))
        }
        None => Ok(()),
    }
}

/// Refuses a comparison of nothing.
fn refuse(
    comparison: &Comparison,
    unlike: &BTreeMap<Difference, usize>,
    pairs: usize,
    like: usize,
    options: &Options,
) -> Result<()> {
    let place = |side: Option<&Side>| side.map_or(String::new(), |side| side.name.clone());
    let (old, new) = (place(comparison.sides.first()), place(comparison.sides.last()));
    if pairs == 0 {
        return Err(Error::argument(new, format!("it has no row that {old} has"), "compare runs of the same plan"));
    }
    if like == 0 {
        let mut conditions: Vec<&str> = unlike.keys().map(|difference| difference.condition.as_str()).collect();
        conditions.dedup();
        conditions.retain(|condition| !options.across.iter().any(|across| across == condition));
        let described: Vec<String> = unlike
            .keys()
            .filter(|difference| conditions.contains(&difference.condition.as_str()))
            .take(4)
            .map(Difference::describe)
            .collect();
        let more = if unlike.len() > 4 { ", and more" } else { "" };
        let problem = format!("no row of it may be compared with {old}: {}{more}", described.join("; "));
        let hint = format!("--across {} compares them all the same", conditions.join(","));
        return Err(Error::argument(new, problem, hint));
    }
    Ok(())
}

/// The median over a side's runs of a row's mean frame time.
fn side_time(side: &Side, rows: &[Option<(&ComparedRun, &LeanRow)>]) -> Option<f64> {
    median(&side_times(side, rows))
}

fn side_times(side: &Side, rows: &[Option<(&ComparedRun, &LeanRow)>]) -> Vec<f64> {
    let of = |&run: &usize| rows.get(run).copied().flatten()?.1.times.as_ref().map(|times| times.mean_ms);
    side.runs.iter().filter_map(of).collect()
}

/// Compares the exact quantities of all rows with a result with those of the first one that has any, those of the last
/// side before those of sides in between: of each quantity one difference is listed. Returns how many were compared.
fn exact_of(
    names: &Names,
    rows: &[Option<(&ComparedRun, &LeanRow)>],
    index: usize,
    machine: &[Name],
    options: &Options,
    changes: &mut Vec<exact::Change>,
) -> usize {
    let mut with_result = rows.iter().flatten().filter(|(_, row)| row.status == Status::Ok);
    let Some(first) = with_result.next() else { return 0 };
    let (mut compared, mut listed) = (0, Vec::new());
    for other in with_result.rev() {
        let unlike = differences(names, *first, *other);
        let is_same_content = unlike
            .iter()
            .all(|unlike| GENERAL.contains(&unlike.condition.as_str()) || options.across.contains(&unlike.condition));
        if is_same_content {
            let is_one_driver = !unlike.iter().any(|unlike| ["device", "driver"].contains(&&*unlike.condition));
            let mut found = Vec::new();
            compared += exact::compare(index, first.1, other.1, machine, is_one_driver, &mut found);
            found.retain(|change| !listed.contains(&change.quantity));
            listed.extend(found.iter().map(|change| change.quantity));
            changes.extend(found);
        }
    }
    compared
}

struct Outcome {
    /// True if both sides have a row.
    is_pair: bool,
    unlike: Vec<Difference>,
    ratio: Option<super::Ratio>,
    verdict: Verdict,
}

/// What the last side's rows say about the first side's.
fn judge<'r>(
    names: &Names,
    sides: &[Side],
    rows: &[Option<(&'r ComparedRun, &'r LeanRow)>],
    options: &Options,
) -> Outcome {
    let none = |verdict| Outcome { is_pair: false, unlike: Vec::new(), ratio: None, verdict };
    let of = |side: Option<&Side>| -> Vec<(&'r ComparedRun, &'r LeanRow)> {
        side.into_iter().flat_map(|side| &side.runs).filter_map(|&run| rows[run]).collect()
    };
    let (old, new) = (of(sides.first()), of(sides.last()));
    let (first, last) = match (old.first(), new.first()) {
        (Some(first), Some(last)) => (*first, *last),
        (None, None) => return none(Verdict::Incomparable("only sides in between have it".into())),
        (None, Some((_, row))) if row.status == Status::Ok => return none(Verdict::New),
        (None, Some((_, row))) => {
            let problem = format!("new, {}: {}", row.status.word(), names.text(row.message));
            return none(Verdict::Error(problem));
        }
        (Some(_), None) => return none(Verdict::Gone),
    };
    let mut unlike = Vec::new();
    for other in old.iter().skip(1).chain(&new) {
        for difference in differences(names, first, *other) {
            if !unlike.contains(&difference) {
                unlike.push(difference);
            }
        }
    }
    let mut outcome = Outcome { is_pair: true, unlike, ratio: None, verdict: Verdict::Ambiguous };
    let without =
        |rows: &[(&ComparedRun, &'r LeanRow)]| rows.iter().map(|(_, row)| *row).find(|row| row.status != Status::Ok);
    let problem = |row: &LeanRow| format!("{}: {}", row.status.word(), names.text(row.message));
    match (without(&old), without(&new)) {
        (None, None) => {}
        (Some(old), Some(new)) if (old.status, new.status) == (Status::Skipped, Status::Skipped) => {
            outcome.verdict = Verdict::Incomparable("skipped on both sides".into());
            return outcome;
        }
        (_, Some(new)) => {
            outcome.verdict = Verdict::Error(problem(new));
            return outcome;
        }
        (Some(old), None) => {
            outcome.verdict = Verdict::Error(format!("before {}", problem(old)));
            return outcome;
        }
    }
    let refused: Vec<String> = outcome
        .unlike
        .iter()
        .filter(|difference| !options.across.contains(&difference.condition))
        .map(Difference::describe)
        .collect();
    if !refused.is_empty() {
        outcome.verdict = Verdict::Incomparable(refused.join("; "));
        return outcome;
    }
    let passes = |row: &LeanRow| -> Vec<f64> {
        row.times.iter().flat_map(|times| times.passes_ms.iter().copied().map(f64::from)).collect()
    };
    let values = |rows: &[(&ComparedRun, &LeanRow)]| -> Vec<f64> {
        rows.iter().filter_map(|(_, row)| row.times.as_ref().map(|times| times.mean_ms)).collect()
    };
    let is_single = old.len() == 1 && new.len() == 1;
    let (old_passes, new_passes) = (passes(first.1), passes(last.1));
    let passes = is_single.then_some((&old_passes[..], &new_passes[..]));
    match apart(&values(&old), &values(&new), passes, options.margin_pct / 100.0) {
        Some((ratio, verdict)) => (outcome.ratio, outcome.verdict) = (Some(ratio), verdict),
        None => outcome.verdict = Verdict::Incomparable("no times".into()),
    }
    outcome
}

/// How rows are called.
struct Labels {
    /// Axes that name a row by their value.
    named: Vec<Name>,
    /// Other axes with several values, which name a row as `axis=value`.
    others: Vec<Name>,
    /// Of [`Labels::named`], those with several values.
    groups: Vec<Name>,
    with_device: bool,
}

impl Labels {
    fn new(names: &Names, runs: &[ComparedRun], axes: &[String], with_device: bool) -> Labels {
        let mut values: BTreeMap<Name, (Name, bool)> = BTreeMap::new();
        for row in runs.iter().flat_map(|run| &run.run.rows) {
            for (axis, value) in &row.axes {
                let known = values.entry(*axis).or_insert((*value, false));
                known.1 |= known.0 != *value;
            }
        }
        let varies = |axis: &Name| values.get(axis).is_some_and(|(_, varies)| *varies);
        let named: Vec<Name> = axes.iter().filter_map(|axis| names.find(axis)).collect();
        let others = values.keys().copied().filter(|axis| varies(axis) && !named.contains(axis)).collect();
        let groups = named.iter().copied().filter(varies).collect();
        Labels { named, others, groups, with_device }
    }

    fn label(&self, names: &Names, row: &LeanRow) -> String {
        let value = |axis: &Name| row.axes.iter().find(|(name, _)| name == axis).map_or("", |(_, v)| names.text(*v));
        let mut label = String::new();
        let mut add = |text: &str| {
            if !text.is_empty() {
                if !label.is_empty() {
                    label.push(' ');
                }
                label.push_str(text);
            }
        };
        self.named.iter().for_each(|axis| add(&spelt_out(names.text(*axis), value(axis))));
        for axis in self.others.iter().filter(|axis| !value(axis).is_empty()) {
            add(&format!("{}={}", names.text(*axis), value(axis)));
        }
        if self.with_device {
            add(&format!("device {}", row.device));
        }
        label
    }

    fn groups(&self, row: &LeanRow) -> Vec<Name> {
        let value = |axis: &Name| row.axes.iter().find(|(name, _)| name == axis).map_or(Name::MAX, |(_, v)| *v);
        self.groups.iter().map(value).collect()
    }
}

/// Geometric means of the ratios: of all rows, and by each axis that names a row and has several values.
fn means(names: &Names, rows: &[PairedRow], labels: &Labels) -> Vec<Mean> {
    let ratios = || rows.iter().filter_map(|row| Some((row, row.ratio?.estimate.value)));
    let all: Vec<f64> = ratios().map(|(_, ratio)| ratio).collect();
    let mean = |axis: &str, value: &str, ratios: &[f64]| {
        let ratio = geometric_mean(ratios)?;
        Some(Mean { axis: axis.to_owned(), value: value.to_owned(), rows: ratios.len(), ratio })
    };
    let mut means: Vec<Mean> = mean("", "all", &all).into_iter().collect();
    for (index, axis) in labels.groups.iter().enumerate() {
        let mut order: Vec<Name> = Vec::new();
        let mut by_value: HashMap<Name, Vec<f64>> = HashMap::new();
        for (row, ratio) in ratios() {
            by_value
                .entry(row.groups[index])
                .or_insert_with(|| {
                    order.push(row.groups[index]);
                    Vec::new()
                })
                .push(ratio);
        }
        let of_axis = order.iter().filter_map(|value| mean(names.text(*axis), names.text(*value), &by_value[value]));
        means.extend(of_axis);
    }
    means
}

/// What a reader should know.
fn notes(comparison: &Comparison, unlike: &BTreeMap<Difference, usize>, options: &Options) -> Vec<String> {
    let mut notes = Vec::new();
    // By condition: the first difference, and how many rows and other values there are
    let mut conditions: BTreeMap<&str, (String, usize, usize)> = BTreeMap::new();
    for (difference, rows) in unlike {
        let known = conditions.entry(&difference.condition).or_insert_with(|| (difference.describe(), 0, 0));
        (known.1, known.2) = (known.1 + rows, known.2 + 1);
    }
    for (condition, (first, rows, values)) in conditions {
        let how =
            if options.across.iter().any(|across| across == condition) { "compared across" } else { "not compared" };
        let more = if values > 1 { format!(" and {} more", values - 1) } else { String::new() };
        notes.push(format!("{first}{more} ({rows} rows): {how}"));
    }
    let builds: Vec<&str> =
        comparison.runs.iter().filter_map(|run| run.run.provenance.program.executable_hash.as_deref()).collect();
    if builds.windows(2).any(|pair| pair[0] != pair[1]) {
        notes.push("the runs are of different builds of the program".into());
    }
    let sizes = [comparison.sides.first(), comparison.sides.last()].map(|side| side.map_or(0, |side| side.runs.len()));
    if sizes.iter().any(|&runs| runs < verdict::RUNS_NEEDED) {
        notes.push(format!(
            "the sides were measured apart, with {} and {} runs: times say at most ambiguous with fewer than {} runs on \
             each side; `rtbench ab` measures both sides interleaved",
            sizes[0],
            sizes[1],
            verdict::RUNS_NEEDED
        ));
    } else {
        notes.push(format!(
            "the sides were measured apart: intervals of {:.0} % and p values of Mann and Whitney's test over {} and {} \
             runs, row by row, so that about one unchanged row in {:.0} is outside its interval",
            100.0 * (1.0 - verdict::UNPAIRED_ALPHA),
            sizes[0],
            sizes[1],
            1.0 / verdict::UNPAIRED_ALPHA
        ));
    }
    notes
}
