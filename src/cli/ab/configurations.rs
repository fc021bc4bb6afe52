//! Two configurations in one process.

use super::{Arguments, Measured, Recorder, kept};
use crate::cli::interrupt;
use crate::cli::output;
use crate::cli::workload::Given;
use crate::compare::rounds::{CellTimes, rounds_needed};
use crate::error::{Error, Result};
use crate::harness::ab::{self, AbJob, RoundTime};
use crate::harness::workload::{Case, Context, Event, Info};
use crate::record::terminal::spelt_out;
use serde_json::json;
use std::collections::BTreeMap;
use std::sync::atomic::Ordering;

/// Values by axis.
type Values = BTreeMap<String, Vec<String>>;

/// Measures both sides.
pub(super) fn measure(arguments: &Arguments, a: &str, b: &str) -> Result<Measured> {
    let given = Given::from_flags(&arguments.workload, &arguments.flags, &["--out", "--resume", "--passes"])?;
    let info = given.workload.info();
    let (values_a, values_b) = (values(info, "A", a)?, values(info, "B", b)?);
    if let Some(axis) = values_a.keys().chain(values_b.keys()).find(|axis| given.values.contains_key(*axis)) {
        let problem = format!("--{} is what A and B differ in", axis.replace('_', "-"));
        return Err(Error::argument("--", problem, "leave it out of the flags"));
    }
    let plan_a = given.with(&values_a).plan()?;
    let plan_b = given.with(&values_b).plan()?;
    let pairs = paired(info, &values_a, &values_b, &plan_a.cases, &plan_b.cases)?;
    let rounds = arguments.rounds.unwrap_or_else(|| rounds_needed(pairs.len()));
    let devices = given.common.device.open_all(given.workload.devices())?;
    devices.iter().for_each(crate::cli::device::announce);
    let info_of_last = devices.last().map(|opened| opened.device.info());
    let (out, mut recorder) = Recorder::create(arguments, [a, b], json!(info_of_last))?;
    let stop = interrupt::flag(|| output::note("stopping after this frame; Ctrl-C again ends at once"))?;
    let interrupted = || stop.load(Ordering::Relaxed);
    let context = Context {
        settings: plan_a.settings,
        out: &out,
        library: plan_a.library.clone(),
        interrupted: &interrupted,
        watch: &|event| {
            if let Event::Note(text) = event {
                output::note(&text);
            }
        },
    };
    let mut cells: Vec<CellTimes> = pairs
        .iter()
        .map(|(case, _)| CellTimes { label: label(info, case, &values_a, &values_b), ..CellTimes::default() })
        .collect();
    let mut times: Vec<Vec<[RoundTime; 3]>> = vec![Vec::new(); pairs.len()];
    let job = AbJob { workload: given.workload, context: &context, devices: &devices, pairs: &pairs, rounds };
    let measured = ab::run(&job, &mut |pair, round, of_round| {
        times[pair].push(of_round);
        recorder.round(&cells[pair].label, round + 1, of_round.map(|time| ms(time, has_device_times(&[of_round]))))
    });
    kept(&out, measured)?;
    for (cell, times) in cells.iter_mut().zip(&times) {
        let by_device = has_device_times(times);
        for of_round in times {
            let [a, b, null] = of_round.map(|time| ms(time, by_device));
            cell.a.push(a);
            cell.b.push(b);
            cell.null.push(null);
        }
    }
    Ok((out, cells))
}

/// True if the device gave every time.
fn has_device_times(times: &[[RoundTime; 3]]) -> bool {
    times.iter().flatten().all(|time| time.device_ns.is_some())
}

/// Milliseconds per frame.
fn ms(time: RoundTime, by_device: bool) -> f64 {
    let ns = time.device_ns.filter(|_| by_device).unwrap_or(time.wall_ns);
    ns as f64 / 1e6 / time.frames.max(1) as f64
}

/// Reads `AXIS=VALUE[;AXIS=VALUE]`.
fn values(info: &Info, place: &str, text: &str) -> Result<Values> {
    let known: Vec<&str> = info.axes.iter().filter(|axis| axis.is_flag).map(|axis| axis.name).collect();
    let hint = || format!("AXIS=VALUE[;AXIS=VALUE] with an axis of {}", known.join(", "));
    let mut values = Values::new();
    for part in text.split(';').map(str::trim).filter(|part| !part.is_empty()) {
        let Some((axis, value)) = part.split_once('=') else {
            return Err(Error::argument(place, format!("'{part}' is no value of an axis"), hint()));
        };
        let axis = axis.trim().replace('-', "_");
        if !known.contains(&axis.as_str()) {
            return Err(Error::argument(place, format!("there is no axis '{axis}'"), hint()));
        }
        if values.contains_key(&axis) {
            return Err(Error::argument(place, format!("{axis} is given twice"), "give it once"));
        }
        values.insert(axis, vec![value.trim().to_owned()]);
    }
    if values.is_empty() {
        return Err(Error::argument(place, "no axis is named", hint()));
    }
    Ok(values)
}

/// The cases of both sides in pairs: plans enumerate the axes that both sides share in the same order.
fn paired(info: &Info, values_a: &Values, values_b: &Values, a: &[Case], b: &[Case]) -> Result<Vec<(Case, Case)>> {
    let shared: Vec<&str> = info
        .axes
        .iter()
        .filter(|axis| axis.is_flag && !values_a.contains_key(axis.name) && !values_b.contains_key(axis.name))
        .map(|axis| axis.name)
        .collect();
    // An axis that one side does not have says nothing about the pair
    let agrees = |a: &str, b: &str| a == b || a.is_empty() || b.is_empty();
    let is_pair = |(a, b): (&Case, &Case)| shared.iter().all(|axis| agrees(a.axis(axis), b.axis(axis)));
    if a.len() != b.len() || !a.iter().zip(b).all(is_pair) {
        let problem = format!("A has {} cases and B has {}, which do not pair", a.len(), b.len());
        return Err(Error::argument("A and B", problem, "give each side one value of the same axes"));
    }
    Ok(a.iter().cloned().zip(b.iter().cloned()).collect())
}

/// A case's name: its values on the axes that the sides share.
fn label(info: &Info, case: &Case, values_a: &Values, values_b: &Values) -> String {
    let axes = info
        .axes
        .iter()
        .filter(|axis| axis.in_label && !values_a.contains_key(axis.name) && !values_b.contains_key(axis.name));
    let values = axes.map(|axis| (axis.name, case.axis(axis.name))).filter(|(_, value)| !value.is_empty());
    values.map(|(axis, value)| spelt_out(axis, value)).collect::<Vec<_>>().join(" ")
}
