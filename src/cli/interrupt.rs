//! Handlers for Ctrl-C. They run on a separate thread, so that they may print.

use super::output;
use crate::error::{Error, Result};
use std::process::exit;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that the first Ctrl-C sets, after which `notify` is called. The second Ctrl-C ends the program at once.
///
/// # Errors
/// [`Error::Device`] if the system does not allow a handler.
pub fn flag(notify: impl Fn() + Send + 'static) -> Result<Arc<AtomicBool>> {
    let flag = Arc::new(AtomicBool::new(false));
    let set = Arc::clone(&flag);
    listen(move || {
        if set.swap(true, Ordering::Relaxed) {
            exit(Error::Interrupted.exit_code().into());
        }
        notify();
    })?;
    Ok(flag)
}

/// Makes Ctrl-C end the program at once, with a message and exit code 130, for commands that write nothing before they
/// are done.
///
/// # Errors
/// [`Error::Device`] if the system does not allow a handler.
pub fn at_once() -> Result<()> {
    listen(|| {
        output::complain(&Error::Interrupted.to_string());
        exit(Error::Interrupted.exit_code().into());
    })
}

fn listen(handler: impl FnMut() + Send + 'static) -> Result<()> {
    ctrlc::set_handler(handler).map_err(|e| Error::Device(format!("cannot listen for Ctrl-C: {e}")))
}

/// Makes a write beyond the limit of a file's size (`ulimit -f`) an error of this write, like that of a full disk, and
/// not the end of the process.
#[cfg(unix)]
pub fn survive_file_size_limit() {
    let seen = Arc::new(AtomicBool::new(false));
    // Without the handler the system's default remains
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, seen);
}

#[cfg(not(unix))]
pub fn survive_file_size_limit() {}
