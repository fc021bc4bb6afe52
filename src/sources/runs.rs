//! Recorded runs, read back.

use crate::error::{Error, Result};
use crate::guard;
use crate::record::journal::{FILE_NAME, Journal};
use crate::record::row::{Row, Status};
use crate::workloads::trace::record::{TraceJournal, WORKLOAD};
use crate::workloads::trace::schema1;
use std::path::{Path, PathBuf};

/// A run: its journal, and the folder with its other files. Several workloads may have rows in it.
#[derive(Clone, Debug)]
pub struct RecordedRun {
    /// The run's journal with its rows of ray tracing, typed; both lists are empty where it has none.
    pub journal: TraceJournal,
    /// The same journal with the rows of all workloads.
    pub general: Journal,
    /// The run's folder.
    pub folder: PathBuf,
}

impl RecordedRun {
    /// Reads a run from its folder or its journal.
    ///
    /// # Errors
    /// [`Error::Input`]: there is no run, it is damaged, or nothing was measured.
    pub fn read(path: &Path) -> Result<RecordedRun> {
        let hint = "give the folder that a measurement wrote";
        let (folder, journal) = if path.is_dir() {
            (path.to_owned(), path.join(FILE_NAME))
        } else {
            (path.parent().unwrap_or(Path::new("")).to_owned(), path.to_owned())
        };
        if path.is_dir() && !journal.is_file() {
            return Err(Error::file(path, None, format!("no run: there is no {FILE_NAME} in it"), hint));
        }
        let general = schema1::read(&journal)?;
        guard::read_run(&folder);
        let run = RecordedRun { journal: TraceJournal::new(&general), general, folder };
        if !run.has_traces() && !run.has_others() {
            let problem = "no case of it has a result";
            return Err(Error::file(&journal, None, problem, "leave it out, or resume it: its rows say what failed"));
        }
        Ok(run)
    }

    /// True if it has structures or rows of ray tracing.
    pub fn has_traces(&self) -> bool {
        !self.journal.structures.is_empty() || !self.journal.configurations.is_empty()
    }

    /// True if it has rows of another workload. Rows without a result whose input could not be read do not count.
    fn has_others(&self) -> bool {
        let is_there = |row: &Row| row.status == Status::Ok || !row.key.inputs.is_empty();
        self.general.rows.iter().any(|row| row.key.workload != WORKLOAD && is_there(row))
    }

    /// Reads several runs.
    ///
    /// # Errors
    /// That of the first run that cannot be read.
    pub fn read_all(paths: &[PathBuf]) -> Result<Vec<RecordedRun>> {
        paths.iter().map(|path| RecordedRun::read(path)).collect()
    }

    /// What a reader should know about how the run ended.
    pub fn notes(&self) -> Vec<String> {
        let journal = &self.journal;
        let mut notes = Vec::new();
        let name = format!("the run of {} on {}", journal.provenance.started, journal.provenance.device_names());
        match &journal.end {
            None => notes.push(format!("{name} was killed before its end: what it had measured is used")),
            Some(end) if !end.complete => notes.push(format!("{name} ended early: what it had measured is used")),
            Some(_) => {}
        }
        if let Some(truncated) = &journal.truncated {
            notes.push(format!(
                "{name}: {}",
                truncated.split(" of ").next().unwrap_or(truncated).to_owned() + " is cut off"
            ));
        }
        notes
    }
}

/// Those runs with structures or rows of ray tracing; all of them where none has any.
pub fn with_traces(runs: &[RecordedRun]) -> Vec<&RecordedRun> {
    let found: Vec<&RecordedRun> = runs.iter().filter(|run| run.has_traces()).collect();
    if found.is_empty() { runs.iter().collect() } else { found }
}

/// Of the rows of ray tracing with times: how many had their passes interleaved with those of other rows, and how many
/// there are.
pub fn interleaved_rows(runs: &[RecordedRun]) -> (usize, usize) {
    let rows = runs.iter().flat_map(|run| &run.journal.configurations);
    let turns: Vec<usize> = rows.filter(|r| r.status == Status::Ok && r.verified).map(|r| r.interleaved_with).collect();
    (turns.iter().filter(|number| **number > 1).count(), turns.len())
}
