//! Recorded runs, read back.

use crate::error::{Error, Result};
use crate::guard;
use crate::record::journal::FILE_NAME;
use crate::record::row::Status;
use crate::workloads::trace::record::{self, TraceJournal};
use std::path::{Path, PathBuf};

/// A run: its journal, and the folder with its other files.
#[derive(Clone, Debug)]
pub struct RecordedRun {
    /// The run's journal.
    pub journal: TraceJournal,
    /// The run's folder.
    pub folder: PathBuf,
}

impl RecordedRun {
    /// Reads a run from its folder or its journal.
    ///
    /// # Errors
    /// [`Error::Input`]: there is no run, it is damaged, or nothing was measured.
    pub fn read(path: &Path) -> Result<RecordedRun> {
        let hint = "give the folder that `rtbench sweep` wrote";
        let (folder, journal) = if path.is_dir() {
            (path.to_owned(), path.join(FILE_NAME))
        } else {
            (path.parent().unwrap_or(Path::new("")).to_owned(), path.to_owned())
        };
        if path.is_dir() && !journal.is_file() {
            return Err(Error::file(path, None, format!("no run: there is no {FILE_NAME} in it"), hint));
        }
        let run = record::read(&journal)?;
        guard::read_run(&folder);
        if run.structures.is_empty() && run.configurations.is_empty() {
            let problem = "no case of it has a result";
            return Err(Error::file(&journal, None, problem, "leave it out, or resume it: its rows say what failed"));
        }
        Ok(RecordedRun { journal: run, folder })
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

/// The number of rows whose passes were interleaved with those of other rows, and of all rows with times.
pub fn interleaved_rows(runs: &[RecordedRun]) -> (usize, usize) {
    let rows = runs.iter().flat_map(|run| &run.journal.configurations);
    let turns: Vec<usize> = rows.filter(|r| r.status == Status::Ok && r.verified).map(|r| r.interleaved_with).collect();
    (turns.iter().filter(|number| **number > 1).count(), turns.len())
}
