//! Printing. A pipe that was closed is no error: whoever read from it has read enough.

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

/// Prints an error, on one line.
pub fn complain(message: &str) {
    note(&format!("error: {}", message.replace('\n', " ")));
}

/// Prints something that the user should know, on standard error. If that is closed, nobody wants to know.
pub fn note(message: &str) {
    let _ = writeln!(std::io::stderr().lock(), "rtbench: {message}");
}
