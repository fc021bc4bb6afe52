//! Building a structure so that Ctrl-C need not wait for it. Nothing interrupts a builder, least of all one of another crate:
//! it has a thread of its own, and after Ctrl-C nobody waits for that any more.

use crate::accel::{Built, Selection};
use crate::backend::Interrupted;
use crate::error::{Error, Result};
use crate::scene::Scene;
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// How often the waiting thread looks for Ctrl-C.
const POLL: Duration = Duration::from_millis(20);

/// Builds the structure on `threads` threads (0: as many as there are). After [`Error::Interrupted`] the builder still runs:
/// the process is to end.
///
/// # Errors
/// The builder's, or [`Error::Interrupted`].
pub fn build(selection: &Selection, scene: &Arc<Scene>, threads: usize, interrupted: Interrupted) -> Result<Built> {
    if interrupted() {
        return Err(Error::Interrupted);
    }
    let (done, result) = channel();
    let (own, shared) = (selection.clone(), Arc::clone(scene));
    let builder = std::thread::spawn(move || {
        // Nobody may be waiting any more.
        let _ = done.send(own.build(&shared, threads));
    });
    loop {
        match result.recv_timeout(POLL) {
            Ok(built) => return built,
            Err(RecvTimeoutError::Timeout) if interrupted() => return Err(Error::Interrupted),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => match builder.join() {
                Err(panic) => std::panic::resume_unwind(panic),
                Ok(()) => return Err(Error::Device(format!("{} ended without a structure", selection.name()))),
            },
        }
    }
}
