//! `rtbench plan`: what a workload would measure, printed without a device.

use super::output;
use crate::error::{Error, Result};
use crate::harness::workload::Workload;
use crate::harness::{Plan, shard};
use crate::record::journal::{self, FILE_NAME, Journal};
use crate::record::run::Shard;
use crate::record::terminal::counted;
use std::path::Path;

/// Prints the cases of a plan as CSV, with their work and, where the plan is divided, their shard; on standard error
/// what they sum up to and what they need. `like` is a recorded run whose speed gives an estimate of the time.
///
/// # Errors
/// A run that cannot be read; [`Error::Output`].
pub fn print(workload: &dyn Workload, plan: &Plan, like: Option<&Path>) -> Result<()> {
    let speed = like.map(|run| Speed::of(workload, run)).transpose()?;
    let info = workload.info();
    let shards = plan.shard.map(|shard| shard::assign(&plan.whole, shard.count));
    let mut columns: Vec<&str> = info.axes.iter().map(|axis| axis.name).collect();
    columns.push(info.work_unit);
    columns.extend(shards.is_some().then_some("shard"));
    let mut csv = csv::Writer::from_writer(Vec::new());
    let line = |case: &crate::harness::workload::Case| -> Vec<String> {
        let axes = info.axes.iter().map(|axis| case.axis(axis.name).to_owned());
        let shard = plan.shard.map(|shard| shard.to_string());
        axes.chain([case.work.to_string()]).chain(shard).collect()
    };
    let written =
        csv.write_record(&columns).and_then(|()| plan.cases.iter().try_for_each(|case| csv.write_record(line(case))));
    // Writing to memory does not fail
    let bytes = written.ok().and_then(|()| csv.into_inner().ok()).unwrap_or_default();
    output::print(&String::from_utf8_lossy(&bytes))?;
    let settings = plan.settings;
    output::note(&format!(
        "{} of preset {}, {} after {} of warm-up each; {}",
        counted(plan.cases.len(), "case", "cases"),
        plan.preset,
        counted(settings.passes, "pass", "passes"),
        counted(settings.warmup_frames, "frame", "frames"),
        amount(workload, plan, plan.work(), speed.as_ref()),
    ));
    if let (Some(own), Some(shards)) = (plan.shard, &shards) {
        for index in 1..=own.count {
            let of_shard = || plan.whole.iter().zip(shards).filter(|(_, shard)| **shard == index).map(|(case, _)| case);
            let (cases, work) = (of_shard().count(), of_shard().map(|case| case.work).sum());
            let shard = Shard { index, count: own.count };
            let cases = counted(cases, "case", "cases");
            output::note(&format!("shard {shard}: {cases}; {}", amount(workload, plan, work, speed.as_ref())));
        }
    }
    for need in workload.needs(&plan.cases, &plan.library) {
        output::note(&format!("needs {need}"));
    }
    if speed.is_none() {
        output::note("for an estimate of the time: --like RUN, a recorded run on such a machine");
    }
    Ok(())
}

/// Work in its unit, and the time that it takes. Each frame is run by every pass, and once more to count.
fn amount(workload: &dyn Workload, plan: &Plan, work: u64, speed: Option<&Speed>) -> String {
    let runs = plan.settings.passes as u64 + 1;
    let all = work.saturating_mul(runs);
    let unit = workload.info().work_unit;
    let time = speed.map_or(String::new(), |speed| {
        let seconds = all as f64 / speed.work_per_s;
        format!(", about {} like on {}", duration(seconds), speed.device)
    });
    format!("about {} {unit}{time}", rounded(all))
}

/// How fast a recorded run was.
struct Speed {
    /// Work of passes and counting by second, verification and building included.
    work_per_s: f64,
    device: String,
}

impl Speed {
    fn of(workload: &dyn Workload, run: &Path) -> Result<Speed> {
        let path = journal::folder_of(run).join(FILE_NAME);
        let journal = Journal::read(&path)?;
        let problem = |problem: &str| {
            let hint = format!("give a complete run of `rtbench {}`", workload.info().name);
            Error::file(&path, None, problem, hint)
        };
        if journal.provenance.workload != workload.info().name {
            return Err(problem("it is a run of another workload"));
        }
        let (plan, rows) = (&journal.provenance.plan, &journal.rows);
        let pass = |row: &crate::record::row::Row| {
            let passes: u64 = row.samples.iter().flat_map(|samples| &samples.pass_ns).sum();
            passes as f64 / 1e9 + row.verification_s + row.counting_s
        };
        let seconds: f64 = rows.iter().map(pass).sum();
        let is_whole = rows.len() == plan.rows && rows.iter().all(|row| row.samples.is_some());
        if !is_whole || plan.work == 0 || seconds <= 0.0 {
            return Err(problem("it does not tell how long its plan took"));
        }
        let work = plan.work as f64 * (plan.settings.passes + 1) as f64;
        Ok(Speed { work_per_s: work / seconds, device: journal.provenance.device_names() })
    }
}

/// A count with its order of magnitude.
fn rounded(count: u64) -> String {
    match count {
        0..10_000 => count.to_string(),
        10_000..10_000_000 => format!("{:.1} thousand", count as f64 / 1e3),
        10_000_000..10_000_000_000 => format!("{:.1} million", count as f64 / 1e6),
        _ => format!("{:.1} billion", count as f64 / 1e9),
    }
}

fn duration(seconds: f64) -> String {
    match seconds {
        _ if seconds < 100.0 => format!("{seconds:.0} s"),
        _ if seconds < 6000.0 => format!("{:.0} min", seconds / 60.0),
        _ => format!("{:.1} h", seconds / 3600.0),
    }
}
