//! The CPU as a device: a pool of threads that runs twins of kernels.

use super::frame::{FrameTime, Interrupted};
use super::info::{DeviceInfo, DeviceType};
use crate::error::{Error, Result};
use crate::threads;
use std::collections::BTreeMap;
use std::time::Instant;

/// The CPU with a pool of threads of its own.
pub struct CpuDevice {
    info: DeviceInfo,
    pool: rayon::ThreadPool,
}

impl CpuDevice {
    /// Starts `threads` threads; 0 starts one per processor.
    ///
    /// # Errors
    /// Those of [`threads::pool`].
    pub fn new(threads: usize) -> Result<CpuDevice> {
        let pool = threads::pool(threads)?;
        let info = DeviceInfo {
            name: processor_name(),
            device_type: DeviceType::CpuTwin,
            backend: "cpu".into(),
            driver: String::new(),
            timestamp_period_ns: None,
            checked: true,
            features: Vec::new(),
            limits: BTreeMap::new(),
            threads: Some(pool.current_num_threads()),
        };
        Ok(CpuDevice { info, pool })
    }

    /// The same under another name, as a test needs it.
    pub fn named(mut self, name: &str) -> CpuDevice {
        self.info.name = name.to_owned();
        self
    }

    /// The description for a run's provenance.
    pub fn info(&self) -> &DeviceInfo {
        &self.info
    }

    /// The threads.
    pub fn pool(&self) -> &rayon::ThreadPool {
        &self.pool
    }

    /// Calls `frame` with each number below `frames` and times every call by the host's clock.
    ///
    /// # Errors
    /// [`Error::Interrupted`] between frames.
    pub fn run_frames(
        &self,
        frames: usize,
        mut frame: impl FnMut(usize),
        interrupted: Interrupted,
    ) -> Result<Vec<FrameTime>> {
        let mut times = Vec::with_capacity(frames);
        let mut last = Instant::now();
        for index in 0..frames {
            if interrupted() {
                return Err(Error::Interrupted);
            }
            frame(index);
            let now = Instant::now();
            times.push(FrameTime { wall_ns: (now - last).as_nanos() as u64, ..FrameTime::default() });
            last = now;
        }
        Ok(times)
    }
}

/// The processor's name as the system gives it, or `CPU`.
fn processor_name() -> String {
    let Ok(mut system) = sysinfo::System::new() else {
        return "CPU".into();
    };
    system.refresh_cpu_all();
    match system.cpus().first().map(|cpu| cpu.brand().trim()) {
        Some(name) if !name.is_empty() => name.into(),
        _ => "CPU".into(),
    }
}
