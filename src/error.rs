//! The one error type that reaches a user, and its exit codes.

use std::fmt;
use std::path::{Path, PathBuf};

/// Shorthand for results of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// What went wrong, in a user's words. Every variant prints as one line.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Something given by the user cannot be used.
    #[error("{0}")]
    Input(Input),
    /// A result cannot be written (disk full, folder not writable).
    #[error("cannot write {}: {source}", path.display())]
    Output {
        /// The file or folder that was being written.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The device refuses (limits, memory, validation): this configuration cannot run, others may.
    #[error("{0}")]
    Device(String),
    /// The device is gone or does not answer: it must be opened again before anything else runs on it.
    #[error("device lost: {0}")]
    DeviceLost(String),
    /// Ctrl-C.
    #[error("interrupted")]
    Interrupted,
    /// Not a failure but an answer, where a document was only to be checked: it is not what would be written now.
    #[error("{}: is not up to date (run the same without --check)", .0.display())]
    NotUpToDate(PathBuf),
}

/// A problem with something that the user gave: where it stands, what is wrong, how to mend it.
#[derive(Debug, Clone)]
pub struct Input {
    /// File, or the flag's name where no file is involved.
    pub place: String,
    /// Line in the file, counted from 1.
    pub line: Option<usize>,
    /// What is wrong.
    pub problem: String,
    /// What to do about it; may be empty.
    pub hint: String,
}

impl fmt::Display for Input {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.place)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}", self.problem)?;
        if !self.hint.is_empty() {
            write!(f, " ({})", self.hint)?;
        }
        Ok(())
    }
}

impl Error {
    /// A problem with a file: `line` counts from 1.
    pub fn file(path: &Path, line: Option<usize>, problem: impl Into<String>, hint: impl Into<String>) -> Self {
        Error::Input(Input { place: path.display().to_string(), line, problem: problem.into(), hint: hint.into() })
    }

    /// A problem with an argument; `place` is the flag or the argument's name.
    pub fn argument(place: impl Into<String>, problem: impl Into<String>, hint: impl Into<String>) -> Self {
        Error::Input(Input { place: place.into(), line: None, problem: problem.into(), hint: hint.into() })
    }

    /// A failed write to `path`.
    pub fn output(path: &Path, source: std::io::Error) -> Self {
        Error::Output { path: path.to_owned(), source }
    }

    /// The process's exit code: 130 after Ctrl-C (128 + SIGINT), 1 for the answer "no", 2 for everything that could not
    /// run.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Interrupted => 130,
            Error::NotUpToDate(_) => 1,
            _ => 2,
        }
    }
}
