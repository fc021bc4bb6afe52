//! Shared parts of the readers of text formats: tokens with line numbers, numbers, includes, errors.

mod encoding;
mod folders;
mod includes;
pub mod number;
mod numbers;
pub mod odd;
mod tokenizer;

use crate::error::Error;
pub use encoding::{refuse_zeros, to_utf8};
pub use folders::SceneFolders;
pub use includes::Includes;
use std::path::Path;
pub use tokenizer::{Syntax, Tokenizer};

/// An error in a file, without the file's name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Line number, counted from 1.
    pub line: Option<usize>,
    pub problem: String,
    /// Tells what to do about the problem; may be empty.
    pub hint: String,
}

impl Fault {
    pub fn new(line: Option<usize>, problem: impl Into<String>, hint: impl Into<String>) -> Fault {
        Fault { line, problem: problem.into(), hint: hint.into() }
    }

    /// Sets the line number, unless it is already set.
    pub fn at(self, line: usize) -> Fault {
        Fault { line: self.line.or(Some(line)), ..self }
    }

    /// Adds the file's name.
    pub fn of(self, path: &Path) -> Error {
        Error::file(path, self.line, self.problem, self.hint)
    }
}

/// The place of a line for a warning: the file's name without its folder, and the line.
pub fn place(path: &Path, line: usize) -> String {
    format!("{}:{line}", path.file_name().unwrap_or_default().to_string_lossy())
}

/// An error while reading a file that may include others.
#[derive(Debug)]
pub enum ReadError {
    /// An error in this file.
    Here(Fault),
    /// An error in an included file.
    Included(Error),
}

impl ReadError {
    /// Adds the file's name to an error in this file.
    pub fn of(self, path: &Path) -> Error {
        match self {
            ReadError::Here(fault) => fault.of(path),
            ReadError::Included(error) => error,
        }
    }

    /// Sets the line number of an error in this file, unless it is already set.
    pub fn at(self, line: usize) -> ReadError {
        match self {
            ReadError::Here(fault) => ReadError::Here(fault.at(line)),
            ReadError::Included(error) => ReadError::Included(error),
        }
    }
}

impl From<Fault> for ReadError {
    fn from(fault: Fault) -> ReadError {
        ReadError::Here(fault)
    }
}

impl From<Error> for ReadError {
    fn from(error: Error) -> ReadError {
        ReadError::Included(error)
    }
}

/// Formats a piece of the file for a message: quoted, escaped, and truncated to 40 characters.
pub fn quote(text: &str) -> String {
    let mut shown: String = text.chars().take(40).collect();
    if shown.len() < text.len() {
        shown.push('…');
    }
    format!("`{}`", shown.escape_debug())
}

/// Like [`quote`], for bytes in any encoding.
pub fn quote_bytes(bytes: &[u8]) -> String {
    // A character has at most four bytes, and at most 41 characters are examined.
    quote(&String::from_utf8_lossy(&bytes[..bytes.len().min(164)]))
}
