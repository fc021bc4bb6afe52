//! `rtbench merge`: the shards of a plan as one run.

use super::output;
use crate::error::{Error, Result};
use crate::harness::{environment, summary};
use crate::record::files;
use crate::record::journal::{self, FILE_NAME, Journal, JournalWriter, Record};
use crate::record::merge::{self, Merged, Part};
use crate::record::row::Status;
use crate::record::run::End;
use crate::record::terminal::counted;
use crate::workloads;
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Join the runs of a plan's shards into one run
///
/// The runs must be of one plan, by one program, with the same inputs. Rows that no run has are reported, and the exit
/// code is 1 then; `rtbench WORKLOAD --resume` measures them on one of the machines. Times of different machines keep
/// their devices and are never compared.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Folders of the runs
    #[arg(value_name = "DIR", required = true)]
    runs: Vec<PathBuf>,
    /// Folder of the merged run, new or empty
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
}

const EXAMPLES: &str = "\
Examples:
  rtbench sweep --preset thesis-lite --shard 1/4 --out part1     (and 2/4, 3/4, 4/4, anywhere)
  rtbench merge part1 part2 part3 part4 --out whole
  rtbench report whole -o whole.html";

/// Runs the command.
///
/// # Errors
/// [`Error::Input`] for runs that do not belong together or are being written, [`Error::Output`].
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let read = |run: &PathBuf| -> Result<Part> {
        let path = journal::folder_of(run).join(FILE_NAME);
        journal::check_idle(&path)?;
        Ok((path.clone(), Journal::read(&path)?))
    };
    let parts = arguments.runs.iter().map(read).collect::<Result<Vec<Part>>>()?;
    let truncated: Vec<String> = parts.iter().filter_map(|(_, journal)| journal.truncated.clone()).collect();
    truncated.iter().for_each(|text| output::note(text));
    let ended = parts.iter().all(|(_, journal)| journal.end.as_ref().is_some_and(|end| end.complete));
    let folders: Vec<PathBuf> = parts.iter().filter_map(|(path, _)| path.parent().map(Path::to_owned)).collect();
    let merged = merge::merge(parts)?;
    let name = merged.provenance.workload.clone();
    let Some(workload) = workloads::find(&name) else {
        let problem = format!("this program knows no workload {name}");
        return Err(Error::argument("DIR", problem, "use the program that measured it"));
    };
    write(&merged, ended, &arguments.out)?;
    for folder in &folders {
        copy_pictures(folder, &arguments.out)?;
    }
    let journal = Journal::read(&arguments.out.join(FILE_NAME))?;
    summary::write(workload, &journal, &arguments.out)?;
    Ok(conclude(&merged, &arguments.out))
}

/// Writes the journal of a merged run.
fn write(merged: &Merged, ended: bool, out: &Path) -> Result<()> {
    let mut journal = JournalWriter::create(out, merged.provenance.clone())?;
    for input in &merged.inputs {
        journal.append(&Record::Input(Box::new(input.clone())))?;
    }
    for artifact in &merged.artifacts {
        journal.append(&Record::Artifact(Box::new(artifact.clone())))?;
    }
    for row in &merged.rows {
        journal.append(&Record::Row(Box::new(row.clone())))?;
    }
    let gaps = merged.gaps();
    journal.write(&Record::End(End {
        ended: environment::now(),
        interrupted: false,
        complete: ended && gaps == 0,
        load_average: environment::load_average(),
        message: if gaps > 0 { format!("{} missing", counted(gaps, "row is", "rows are")) } else { String::new() },
    }))
}

/// Copies the pictures of a run and of its differences; those that are there already are kept.
fn copy_pictures(from: &Path, to: &Path) -> Result<()> {
    for folder in ["pictures", "differences"] {
        let Ok(entries) = std::fs::read_dir(from.join(folder)) else { continue };
        for entry in entries.flatten() {
            let target = to.join(folder).join(entry.file_name());
            if target.exists() || !entry.path().is_file() {
                continue;
            }
            let failed = |source| Error::output(&target, source);
            std::fs::create_dir_all(to.join(folder)).map_err(failed)?;
            files::replace(&target, &std::fs::read(entry.path()).map_err(failed)?)?;
        }
    }
    Ok(())
}

/// Says what was merged and what is missing; the exit code is 1 if something is.
fn conclude(merged: &Merged, out: &Path) -> ExitCode {
    if merged.duplicates > 0 {
        let duplicates = counted(merged.duplicates, "row is", "rows are");
        output::note(&format!("{duplicates} in several runs, with equal results; the first one is kept"));
    }
    let (rows, runs) = (merged.rows.len(), merged.provenance.merged.len());
    let rows = counted(rows, "row", "rows");
    let devices = counted(merged.provenance.devices.len(), "device", "devices");
    output::note(&format!("{rows} of {} on {devices} in {}", counted(runs, "run", "runs"), out.display()));
    let count = |status: Status| merged.rows.iter().filter(|row| row.status == status).count();
    let (wrong, failed) = (count(Status::Wrong), count(Status::Failed));
    if wrong + failed > 0 {
        output::complain(&format!("{wrong} rows are wrong, {failed} failed: `rtbench report` lists them"));
        return ExitCode::from(if wrong > 0 { 1 } else { 2 });
    }
    match merged.gaps() {
        0 => ExitCode::SUCCESS,
        gaps => {
            let shards: Vec<String> = merged.missing.iter().map(ToString::to_string).collect();
            let shards =
                if shards.is_empty() { String::new() } else { format!("; no run is shard {}", shards.join(", ")) };
            let resume = format!("rtbench {} --resume {}", merged.provenance.workload, out.display());
            output::complain(&format!(
                "{} missing{shards}; for the rest: {resume}",
                counted(gaps, "row is", "rows are")
            ));
            ExitCode::from(1)
        }
    }
}
