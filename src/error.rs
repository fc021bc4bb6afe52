//! The one error type that reaches a user, and its exit codes.

use crate::names;
use std::fmt;
use std::path::{Path, PathBuf};

/// Shorthand for results of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// An error, as a message for the user. Every variant prints as one line.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file, an argument or another input of the user cannot be used.
    #[error("{0}")]
    Input(Input),
    /// A result cannot be written (disk full, folder not writable).
    #[error("cannot write {}: {source}", names::text(path.as_os_str()))]
    Output {
        /// The file or folder that was being written.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// An algorithm, a budget or a device cannot do what was asked for; other cases may be possible.
    #[error("{0}")]
    Refused(Refusal),
    /// The device reports an error: this case cannot run, others may.
    #[error("{0}")]
    Device(String),
    /// The device is gone or does not answer: it must be opened again before anything else runs on it.
    #[error("device lost: {0}")]
    DeviceLost(String),
    /// The user pressed Ctrl-C.
    #[error("interrupted")]
    Interrupted,
    /// The answer of a check (`--check`), not a failure: the document differs from what would be written now.
    #[error("{}: is not up to date (run the same without --check)", names::text(.0.as_os_str()))]
    NotUpToDate(PathBuf),
}

/// Why something cannot be done, although nothing is wrong with the input or the device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Refusal {
    /// The algorithm or the device has no such function.
    Unsupported(String),
    /// It would take more than a limit allows: what, how much, the limit, and what to do.
    TooLarge(String),
    /// The device has no memory left for it; it may have once others are done.
    OutOfMemory(String),
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Refusal::Unsupported(what) => write!(f, "unsupported: {what}"),
            Refusal::TooLarge(what) => write!(f, "too large: {what}"),
            Refusal::OutOfMemory(what) => write!(f, "out of device memory: {what}"),
        }
    }
}

/// A problem with something that the user gave: where it is, what is wrong, what to do.
#[derive(Debug, Clone)]
pub struct Input {
    /// Path of the file, or the name of the flag or argument if no file is involved.
    pub place: String,
    /// Line in the file, counted from 1.
    pub line: Option<usize>,
    /// Describes what is wrong, as one line.
    pub problem: String,
    /// Tells what to do about it; may be empty.
    pub hint: String,
}

impl fmt::Display for Input {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", visible(&self.place))?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        // What a user typed may have any character in it
        write!(f, ": {}", visible(&self.problem))?;
        if !self.hint.is_empty() {
            write!(f, " ({})", self.hint)?;
        }
        Ok(())
    }
}

/// A text in which characters that control a terminal, line breaks among them, are escaped as in Rust.
fn visible(text: &str) -> String {
    let mut visible = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_control() { visible.extend(c.escape_default()) } else { visible.push(c) }
    }
    visible
}

impl Error {
    /// An [`Error::Input`] about a file; `line` counts from 1.
    pub fn file(path: &Path, line: Option<usize>, problem: impl Into<String>, hint: impl Into<String>) -> Self {
        Error::Input(Input { place: names::text(path.as_os_str()), line, problem: problem.into(), hint: hint.into() })
    }

    /// An [`Error::Input`] about an argument; `place` is the flag or the argument's name.
    pub fn argument(place: impl Into<String>, problem: impl Into<String>, hint: impl Into<String>) -> Self {
        Error::Input(Input { place: place.into(), line: None, problem: problem.into(), hint: hint.into() })
    }

    /// A function that an algorithm or a device does not have.
    pub fn unsupported(what: impl Into<String>) -> Self {
        Error::Refused(Refusal::Unsupported(what.into()))
    }

    /// Something over a limit; `problem` names the need and the limit.
    pub fn too_large(what: impl fmt::Display, problem: impl fmt::Display, hint: &str) -> Self {
        Error::Refused(Refusal::TooLarge(format!("{what}: {problem} ({hint})")))
    }

    /// True for what may be possible once other things have left the device.
    pub fn is_lack_of_room(&self) -> bool {
        matches!(self, Error::Device(_) | Error::Refused(Refusal::OutOfMemory(_)))
    }

    /// A failed write to `path`.
    pub fn output(path: &Path, source: std::io::Error) -> Self {
        Error::Output { path: path.to_owned(), source }
    }

    /// The process's exit code: 130 after Ctrl-C (128 + SIGINT), 1 for [`Error::NotUpToDate`], 2 for every other error.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Interrupted => 130,
            Error::NotUpToDate(_) => 1,
            _ => 2,
        }
    }
}

/// A message of several lines as one.
pub(crate) fn one_line(message: &dyn fmt::Display) -> String {
    message.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
