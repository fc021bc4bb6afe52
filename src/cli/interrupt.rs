//! Ctrl-C. Its handler runs on a thread of its own, where printing is allowed.

use super::output;
use crate::error::{Error, Result};
use std::process::exit;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that Ctrl-C sets, after which `tell` is called. The second Ctrl-C ends the program at once.
///
/// # Errors
/// [`Error::Device`] if the system does not allow it.
pub fn flag(tell: impl Fn() + Send + 'static) -> Result<Arc<AtomicBool>> {
    let flag = Arc::new(AtomicBool::new(false));
    let set = Arc::clone(&flag);
    listen(move || {
        if set.swap(true, Ordering::Relaxed) {
            exit(Error::Interrupted.exit_code().into());
        }
        tell();
    })?;
    Ok(flag)
}

/// Ctrl-C ends the program at once, with a line and its exit code: for commands that write nothing before they are done.
///
/// # Errors
/// [`Error::Device`] if the system does not allow it.
pub fn at_once() -> Result<()> {
    listen(|| {
        output::complain(&Error::Interrupted.to_string());
        exit(Error::Interrupted.exit_code().into());
    })
}

fn listen(handler: impl FnMut() + Send + 'static) -> Result<()> {
    ctrlc::set_handler(handler).map_err(|e| Error::Device(format!("cannot listen for Ctrl-C: {e}")))
}
