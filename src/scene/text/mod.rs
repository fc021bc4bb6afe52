//! What readers of text formats share: words with their lines, numbers, faults.

mod home;
mod includes;
pub mod number;
mod words;

use crate::error::Error;
pub use home::Home;
pub use includes::Includes;
use std::path::Path;
pub use words::{Syntax, Words};

/// What is wrong with a file, before the file's name is added.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Counted from 1.
    pub line: Option<usize>,
    /// What is wrong.
    pub problem: String,
    /// What to do about it; may be empty.
    pub hint: String,
}

impl Fault {
    /// A fault.
    pub fn new(line: Option<usize>, problem: impl Into<String>, hint: impl Into<String>) -> Fault {
        Fault { line, problem: problem.into(), hint: hint.into() }
    }

    /// With this line, if it has none of its own.
    pub fn at(self, line: usize) -> Fault {
        Fault { line: self.line.or(Some(line)), ..self }
    }

    /// The error for the user.
    pub fn of(self, path: &Path) -> Error {
        Error::file(path, self.line, self.problem, self.hint)
    }
}

/// Why reading a file that may include others ends.
#[derive(Debug)]
pub enum Trouble {
    /// Something in this file.
    Here(Fault),
    /// Something in a file that it includes.
    Included(Error),
}

impl Trouble {
    /// The error for the user, of something that was read from the file `path`.
    pub fn of(self, path: &Path) -> Error {
        match self {
            Trouble::Here(fault) => fault.of(path),
            Trouble::Included(error) => error,
        }
    }

    /// With this line, if it is here and has none of its own.
    pub fn at(self, line: usize) -> Trouble {
        match self {
            Trouble::Here(fault) => Trouble::Here(fault.at(line)),
            Trouble::Included(error) => Trouble::Included(error),
        }
    }
}

impl From<Fault> for Trouble {
    fn from(fault: Fault) -> Trouble {
        Trouble::Here(fault)
    }
}

impl From<Error> for Trouble {
    fn from(error: Error) -> Trouble {
        Trouble::Included(error)
    }
}

/// A piece of the file inside an error: in quotes, printable, short.
pub fn quote(text: &str) -> String {
    let mut shown: String = text.chars().take(40).collect();
    if shown.len() < text.len() {
        shown.push('…');
    }
    format!("`{}`", shown.escape_debug())
}

/// The same for bytes, which may be in any encoding.
pub fn quote_bytes(bytes: &[u8]) -> String {
    // A character has four bytes at most: what lies behind 41 of them is not shown anyway
    quote(&String::from_utf8_lossy(&bytes[..bytes.len().min(164)]))
}
