//! Building a structure so that Ctrl-C need not wait for it. A builder cannot be interrupted, so it runs on its own
//! thread, and after Ctrl-C that thread is abandoned. What is built on a device is interrupted between its passes.

use crate::device::VulkanDevice;
use crate::error::{Error, Result};
use crate::record::statistics;
use crate::scene::Scene;
use crate::workloads::trace::backend::Interrupted;
use crate::workloads::trace::{Built, Selection};
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// How often the waiting thread looks for Ctrl-C.
const POLL: Duration = Duration::from_millis(20);

/// Builds the structure `times` times, at least once, and returns the last one with the median build time. Never are
/// two of them in memory.
///
/// # Errors
/// Those of [`build`].
pub fn build_repeatedly(
    selection: &Selection,
    scene: &Arc<Scene>,
    threads: usize,
    times: usize,
    interrupted: Interrupted,
) -> Result<Built> {
    repeatedly(times, || build(selection, scene, threads, interrupted))
}

/// The same on a device, where the builder can; the stages are those of the build with the median time. A build before
/// those that count lets the driver compile its kernels. `None` where it builds on the CPU alone.
///
/// # Errors
/// The builder's, the device's, and [`Error::Interrupted`].
pub fn build_repeatedly_on(
    device: &VulkanDevice,
    selection: &Selection,
    scene: &Scene,
    times: usize,
    interrupted: Interrupted,
) -> Result<Option<Built>> {
    let build = || {
        if interrupted() {
            return Err(Error::Interrupted);
        }
        selection.build_on(scene, device, interrupted)
    };
    if build()?.is_none() {
        return Ok(None);
    }
    let name = selection.name();
    let next = || build()?.ok_or_else(|| Error::Device(format!("{name} was built on the device only once")));
    repeatedly(times, next).map(Some)
}

fn repeatedly(times: usize, mut build: impl FnMut() -> Result<Built>) -> Result<Built> {
    let mut built = build()?;
    let mut taken = vec![(built.build_ms, built.device_times.clone())];
    for _ in 1..times {
        drop(built);
        built = build()?;
        taken.push((built.build_ms, built.device_times.clone()));
    }
    let build_ms: Vec<f64> = taken.iter().map(|(ms, _)| *ms).collect();
    built.build_ms = statistics::median(&build_ms).unwrap_or(built.build_ms);
    if built.device_times.is_some() {
        taken.sort_by(|a, b| a.0.total_cmp(&b.0));
        (built.build_ms, built.device_times) = taken.swap_remove((taken.len() - 1) / 2);
    }
    Ok(built)
}

/// Builds the structure on `threads` threads (0: as many as there are). After [`Error::Interrupted`] the builder still
/// runs: the process is to end.
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
        // The receiver may be gone.
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
