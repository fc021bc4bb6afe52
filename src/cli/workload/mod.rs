//! `rtbench WORKLOAD`: the main job. The subcommand and its flags are generated from the workload's description.

mod commands;

pub use commands::{commands, plan_command};

use super::device;
use super::interrupt;
use super::output;
use super::plan;
use super::progress::Progress;
use crate::error::{Error, Result};
use crate::harness::previous::PreviousRun;
use crate::harness::run::{self, Job};
use crate::harness::workload::{Library, Workload};
use crate::harness::{Plan, Request, environment, summary};
use crate::names;
use crate::record::row::{Row, Status};
use crate::record::terminal::counted;
use crate::record::{files, journal};
use crate::workloads;
use clap::{ArgMatches, FromArgMatches};
use commands::{CommonArguments, check_optional};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::Ordering;

/// What was given on a command line.
pub(super) struct Given {
    pub(super) workload: &'static dyn Workload,
    /// Values by axis.
    pub(super) values: BTreeMap<String, Vec<String>>,
    pub(super) common: CommonArguments,
    /// The command line, for the record.
    pub(super) arguments: Vec<String>,
}

/// Runs the subcommand if it is a workload's, or `plan`; `None` otherwise.
///
/// # Errors
/// What could not run; wrong answers are the exit code 1.
pub fn run(matches: &ArgMatches) -> Option<Result<ExitCode>> {
    let (name, matches) = matches.subcommand()?;
    if name == "plan" {
        let (name, matches) = matches.subcommand()?;
        return Some(
            Given::read(workloads::find(name)?, matches)
                .and_then(|given| given.list(matches.get_one::<PathBuf>("like").map(PathBuf::as_path))),
        );
    }
    Some(Given::read(workloads::find(name)?, matches).and_then(Given::run))
}

impl Given {
    pub(super) fn read(workload: &'static dyn Workload, matches: &ArgMatches) -> Result<Given> {
        let common = CommonArguments::from_arg_matches(matches)
            .map_err(|error| Error::argument(workload.info().name, error.to_string(), "see --help"))?;
        check_optional(matches, workload.info())?;
        let axes = workload.info().axes.iter().filter(|axis| axis.is_flag);
        let values = axes.filter_map(|axis| {
            let given = matches.get_many::<String>(axis.name)?;
            Some((axis.name.to_owned(), given.cloned().collect()))
        });
        let arguments = std::env::args_os().map(|argument| names::text(&argument)).collect();
        Ok(Given { values: values.collect(), workload, common, arguments })
    }

    /// The command line that a recorded run began with; `None` if this program does not know it.
    fn parse(recorded: &[String]) -> Option<Given> {
        let matches = super::cli().try_get_matches_from(recorded.iter().map(|text| names::file(text))).ok()?;
        let (name, matches) = matches.subcommand()?;
        Given::read(workloads::find(name)?, matches).ok()
    }

    pub(super) fn run(self) -> Result<ExitCode> {
        let Some(run) = &self.common.resume else { return self.measure(PreviousRun::default()) };
        let folder = journal::folder_of(run);
        let previous = PreviousRun::read(&folder)?;
        let name = self.workload.info().name;
        if let Some(began) = previous.provenance().filter(|began| began.workload != name) {
            let problem = format!("it is a run of `rtbench {}`, not of `rtbench {name}`", began.workload);
            let hint = format!("rtbench {} --resume {}", began.workload, folder.display());
            return Err(Error::file(&folder.join(journal::FILE_NAME), Some(1), problem, hint));
        }
        let recorded = previous.provenance().map(|provenance| &provenance.arguments[..]).unwrap_or_default();
        let began = Given::parse(recorded).filter(|began| began.workload.info().name == name);
        let (strict, quiet) = (self.common.strict, self.common.quiet);
        if previous.is_complete() {
            if !quiet {
                output::note(&format!("nothing is left to measure in {}", folder.display()));
            }
            let rows = previous.journal().map_or(&[][..], |journal| &journal.rows);
            if let Some(journal) = previous.journal() {
                // They may have been deleted
                summary::write(self.workload, journal, &folder)?;
            }
            let mut began = began.unwrap_or(self);
            began.common.strict |= strict;
            began.common.quiet |= quiet;
            return Ok(began.conclude(rows));
        }
        match began {
            Some(mut began) => {
                began.common.quiet |= quiet;
                began.common.strict |= strict;
                began.common.out = Some(folder);
                began.measure(previous).map_err(from_elsewhere)
            }
            None => {
                let problem =
                    format!("it began with a command that this workload does not know: {}", recorded.join(" "));
                Err(Error::file(&folder.join(journal::FILE_NAME), Some(1), problem, "begin a new run"))
            }
        }
    }

    /// The plan of these flags.
    ///
    /// # Errors
    /// Those of [`Plan::new`].
    pub(super) fn plan(&self) -> Result<Plan> {
        let common = &self.common;
        let subject = self.workload.info().axes.first().map_or("", |axis| axis.name);
        for value in self.values.get(subject).into_iter().flatten() {
            common.library.note_where_time_means_nothing(value);
        }
        let plan = Plan::new(
            self.workload,
            &Request {
                preset: common.preset.clone(),
                values: self.values.clone(),
                frames: common.frames,
                passes: common.passes,
                warmup: common.warmup,
                threads: Some(common.device.threads),
                budget: common.budget,
                library: Library { scenes_folder: common.library.folder(), scene_time: common.library.time() },
                shard: common.shard,
            },
        )?;
        for absent in &plan.absent {
            output::note(&format!("left out: {absent}"));
        }
        plan.notes.iter().for_each(|text| output::note(text));
        Ok(plan)
    }

    /// Prints the plan.
    fn list(&self, like: Option<&Path>) -> Result<ExitCode> {
        if self.common.resume.is_some() {
            let hint = "leave it out; the journal's first line tells how the run began";
            return Err(Error::argument("--resume", "a plan is of a run that begins", hint));
        }
        self.common.device.check()?;
        let plan = self.plan()?;
        plan::print(self.workload, &plan, like)?;
        Ok(ExitCode::SUCCESS)
    }

    /// Measures what is planned and not there yet.
    fn measure(self, previous: PreviousRun) -> Result<ExitCode> {
        let common = &self.common;
        let plan = self.plan()?;
        common.device.check()?;
        if let (Some(out), None) = (&common.out, previous.provenance()) {
            files::create_run_folder(out)?;
        }
        // An empty folder would only be in the way of the next attempt
        let remove = || {
            if let (Some(out), None) = (&common.out, previous.provenance()) {
                let _ = std::fs::remove_dir(out);
            }
        };
        let of_workload = self.workload.devices();
        let devices = common.device.open_all(of_workload).inspect_err(|_| remove())?;
        let plan = plan.on_devices(devices.len());
        if !common.quiet {
            devices.iter().for_each(device::announce);
        }
        let is_new = previous.provenance().is_none();
        let out = match &common.out {
            Some(out) => out.clone(),
            None => {
                let name = devices.last().map_or("", |opened| &opened.device.info().name);
                files::create_numbered_folder(&default_folder(name))?
            }
        };
        let mut progress = Progress::new(self.workload, plan.cases.len(), plan.work(), common.quiet);
        let print_line = progress.line_printer();
        let stop = interrupt::flag(move || print_line("stopping after this frame; Ctrl-C again ends at once"))?;
        let interrupted = || stop.load(Ordering::Relaxed);
        if previous.done() > 0 && !common.quiet {
            output::note(&format!("{} of {} rows are there already", previous.done(), plan.cases.len()));
        }
        let outcome = run::run(Job {
            workload: self.workload,
            plan: &plan,
            out: &out,
            previous,
            arguments: self.arguments.clone(),
            devices,
            open: &|index| common.device.open_again(of_workload, index),
            interrupted: &interrupted,
            watch: &mut |event| progress.event(event),
        });
        progress.end();
        let outcome = outcome.inspect_err(|error| {
            if is_new {
                let _ = std::fs::remove_dir(&out);
            }
            if is_new || !matches!(error, Error::Input(_)) {
                tell_where(self.workload, &out, error);
            }
        })?;
        if !common.quiet {
            output::print(&summary::terminal(self.workload, &outcome.journal))?;
            output::print(&format!("results: {}\n", out.display()))?;
        }
        Ok(self.conclude(&outcome.journal.rows))
    }

    /// The exit code: 1 if an answer was wrong, 2 if a case broke or nothing could be measured, with `--strict` also if
    /// one was skipped. What has no result is said.
    fn conclude(&self, rows: &[Row]) -> ExitCode {
        let count = |status: Status| rows.iter().filter(|row| row.status == status).count();
        let [wrong, failed, skipped] = [Status::Wrong, Status::Failed, Status::Skipped].map(count);
        let first = |status: Status| {
            let row = rows.iter().find(|row| row.status == status);
            row.map_or(String::new(), |row| format!("{}: {}", summary::label(self.workload, row), row.message))
        };
        if skipped > 0 && !self.common.quiet {
            let all = counted(rows.len(), "case", "cases");
            let text = format!("{skipped} of {all} skipped; the first: {}", first(Status::Skipped));
            output::note(&text);
        }
        if wrong + failed > 0 {
            let what = match (wrong, failed) {
                (_, 0) => "disagreed with the reference".to_owned(),
                (0, _) => "could not run".to_owned(),
                _ => format!("have no result: {wrong} disagreed with the reference, {failed} could not run"),
            };
            let first = first(if wrong > 0 { Status::Wrong } else { Status::Failed });
            let all = counted(rows.len(), "case", "cases");
            output::complain(&format!("{} of {all} {what}; the first: {first}", wrong + failed));
            return ExitCode::from(if wrong > 0 { 1 } else { 2 });
        }
        if count(Status::Ok) == 0 {
            output::complain("nothing could be measured: all cases were skipped");
            return ExitCode::from(2);
        }
        if skipped > 0 && self.common.strict {
            output::complain(&format!("--strict: {skipped} of {} skipped", counted(rows.len(), "case", "cases")));
            return ExitCode::from(2);
        }
        ExitCode::SUCCESS
    }
}

/// Of a run that is resumed: what is not found may be so because relative names mean another file here. The journal
/// does not tell in which folder the run was begun.
fn from_elsewhere(error: Error) -> Error {
    match error {
        Error::Input(mut input) if is_absent_here(&names::file(&input.place)) => {
            let separator = if input.hint.is_empty() { "" } else { "; " };
            input.hint += &format!("{separator}a run is resumed from the folder in which it was begun");
            Error::Input(input)
        }
        other => other,
    }
}

/// True for what may be a file's name, seen from this folder, without the file.
fn is_absent_here(place: &Path) -> bool {
    place.is_relative() && !place.exists() && !place.to_string_lossy().starts_with("--")
}

/// Tells where the rows are that were measured before a run broke off.
fn tell_where(workload: &dyn Workload, out: &Path, error: &Error) {
    if out.join(journal::FILE_NAME).is_file() {
        let out = out.display();
        let rest = match error {
            // An input error must be fixed first; resuming may still be refused.
            Error::Input(_) => String::new(),
            _ => format!("; for the rest: rtbench {} --resume {out}", workload.info().name),
        };
        output::note(&format!("what was measured is in {out}{rest}"));
    }
}

/// `results/TIME-DEVICE`.
fn default_folder(device: &str) -> PathBuf {
    Path::new("results").join(format!("{}-{}", environment::now_for_file_name(), names::slug(device)))
}
