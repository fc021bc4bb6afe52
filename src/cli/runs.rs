//! What the readers of recorded runs share: their arguments, and where their output goes.

use super::output;
use crate::error::{Error, Result};
use crate::record::files;
use crate::thesis::data::Data;
use crate::thesis::runs::RecordedRun;
use crate::thesis::splice::{self, Block, Need};
use crate::thesis::{measured, published};
use clap::Args;
use std::path::{Path, PathBuf};

/// Recorded runs.
#[derive(Args, Debug)]
pub struct RunArguments {
    /// Folders of recorded runs, as `rtbench sweep` writes them; none: the thesis's published numbers
    #[arg(value_name = "RUN")]
    runs: Vec<PathBuf>,
}

/// What there is to read.
pub struct Sources {
    /// The runs; empty for the published numbers.
    pub runs: Vec<RecordedRun>,
    /// Their numbers, or the published ones.
    pub data: Data,
    /// The published ones.
    pub published: Data,
}

impl RunArguments {
    /// Reads them, and says what has to be said about them.
    pub fn read(&self) -> Result<Sources> {
        let runs = RecordedRun::read_all(&self.runs)?;
        let published = published::data();
        let data = if runs.is_empty() { published.clone() } else { measured::data(&runs) };
        for note in &data.notes {
            output::note(note);
        }
        Ok(Sources { runs, data, published })
    }
}

/// Prints, or writes a file whole.
pub fn deliver(text: &str, file: Option<&Path>) -> Result<()> {
    match file {
        Some(path) => files::replace(path, text.as_bytes()),
        None => output::print(text),
    }
}

/// A document that has a place for what a command writes.
#[derive(Args, Debug)]
pub struct Into {
    /// Replace what stands between <!-- rtbench:NAME --> and <!-- /rtbench:NAME --> in this document, as Markdown; NAME is
    /// a table's number, or `claims`
    #[arg(long, value_name = "FILE", conflicts_with_all = ["output", "format"])]
    into: Option<PathBuf>,
    /// With --into: change nothing; exit code 1 if the document is not up to date
    #[arg(long, requires = "into")]
    check: bool,
}

impl Into {
    /// Puts the blocks in their places; false if no document was named.
    ///
    /// # Errors
    /// A document that cannot be read or written, or has no place for them; with --check
    /// [`Error::NotUpToDate`] for one that would change.
    pub fn splice(&self, blocks: impl FnOnce() -> Vec<Block>, need: Need) -> Result<bool> {
        let Some(path) = &self.into else { return Ok(false) };
        let text = std::fs::read_to_string(path)
            .map_err(|e| Error::file(path, None, format!("cannot read: {e}"), "give a text file with markers"))?;
        let new = splice::splice(path, &text, &blocks(), need)?;
        match (new == text, self.check) {
            (true, _) => Ok(true),
            (false, true) => Err(Error::NotUpToDate(path.clone())),
            (false, false) => files::replace(path, new.as_bytes()).map(|()| true),
        }
    }
}
