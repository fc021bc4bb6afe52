//! Printing. A closed pipe is not an error: its reader has ended, as `head` does.

use crate::error::{Error, Result};
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Prints to standard output.
///
/// # Errors
/// [`Error::Output`], except for a closed pipe.
pub fn print(text: &str) -> Result<()> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(source) if source.kind() != ErrorKind::BrokenPipe => {
            Err(Error::output(Path::new("standard output"), source))
        }
        _ => Ok(()),
    }
}

/// Prints an error on standard error, as one line.
pub fn complain(message: &str) {
    note(&format!("error: {}", message.replace('\n', " ")));
}

/// Prints a note on standard error. Failures are ignored.
pub fn note(message: &str) {
    let _ = writeln!(std::io::stderr().lock(), "rtbench: {message}");
}
