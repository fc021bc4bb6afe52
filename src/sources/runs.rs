//! Recorded runs, read back.

use crate::error::{Error, Result};
use crate::guard;
use crate::record::journal::FILE_NAME;
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
}
