//! What the readers of recorded runs share: their arguments, and where their output goes.

use super::output;
use crate::error::Result;
use crate::results::files;
use crate::thesis::data::Data;
use crate::thesis::runs::RecordedRun;
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
