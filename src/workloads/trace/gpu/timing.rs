//! Timing a path: whole frames, one submission in advance of the device, nothing read back in between.

use crate::camera::View;
use crate::error::{Error, Result};
use crate::workloads::trace::backend::*;
use crate::workloads::trace::gpu::device::GpuBackend;
use crate::workloads::trace::gpu::kernels::Entry;
use crate::workloads::trace::gpu::prepared::{GpuPrepared, Part};
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Submissions in flight while timing: the next one is there before the last one is done.
const IN_FLIGHT: usize = 2;

/// Most dispatches whose uniforms are uploaded at a time.
const MAX_DISPATCHES: usize = 16_384;

/// A frame elsewhere on the path may take this many times as long as its first one (the thesis's slowest took 4.1 times
/// the mean); the watchdog must not see it either.
const SLOWEST: u32 = 5;

/// What the last timed frame wrote.
pub(super) struct Written {
    output: wgpu::Buffer,
    pixels: usize,
    dispatches: u32,
}

impl GpuPrepared<'_> {
    /// See [`Prepared::time_path`].
    pub(super) fn time(
        &mut self,
        config: Config,
        views: &[View],
        size: Size,
        interrupted: Interrupted,
    ) -> Result<Vec<FrameTime>> {
        let Some(first_view) = views.first() else {
            return Ok(Vec::new());
        };
        let backend = self.backend;
        let parts = self.timing_parts(config, first_view, size)?;
        let compiled = backend.compiled(self.kernel_of(Entry::Render { config, counting: false }))?;
        let output = self.poisoned("the image", (size.pixels() * size_of::<Pixel>()) as u64)?;
        let timestamps = backend.info().timestamp_period_ns;
        // As many frames at a time as a query set and the uniforms have room for
        let room = (wgpu::QUERY_SET_MAX_QUERIES as usize / 2).min(MAX_DISPATCHES / parts.len());
        let mut times = Vec::with_capacity(views.len());
        for views in views.chunks(room.max(1)) {
            let frames = self.frames(views, size, &parts)?;
            let bindings = self.render_bindings(&compiled, &frames, &output);
            let count = (views.len() * 2) as u32;
            let queries = timestamps.map(|_| {
                backend.device.create_query_set(&wgpu::QuerySetDescriptor {
                    label: None,
                    ty: wgpu::QueryType::Timestamp,
                    count,
                })
            });
            backend.settle()?;
            let mut walls = Vec::with_capacity(views.len());
            let mut in_flight = VecDeque::with_capacity(IN_FLIGHT);
            let mut last = Instant::now();
            let mut done = |in_flight: &mut VecDeque<(wgpu::SubmissionIndex, bool)>, most: usize| -> Result<()> {
                while in_flight.len() > most {
                    if let Some((submission, ends_frame)) = in_flight.pop_front() {
                        backend.wait(submission)?;
                        if ends_frame {
                            let now = Instant::now();
                            walls.push((now - last).as_nanos() as u64);
                            last = now;
                        }
                    }
                }
                Ok(())
            };
            for index in 0..frames.groups.len() {
                if interrupted() {
                    done(&mut in_flight, 0)?;
                    return Err(Error::Interrupted);
                }
                let (frame, part) = (index / parts.len(), index % parts.len());
                let (begins, ends) = (part == 0, part + 1 == parts.len());
                // A frame lasts from the begin of its first part to the end of its last one
                let timer = queries.as_ref().filter(|_| begins || ends).map(|query_set| {
                    let first = frame as u32 * 2;
                    wgpu::ComputePassTimestampWrites {
                        query_set,
                        beginning_of_pass_write_index: begins.then_some(first),
                        end_of_pass_write_index: ends.then_some(first + 1),
                    }
                });
                in_flight.push_back((self.submit(&compiled, &bindings, &frames, index, timer), ends));
                done(&mut in_flight, IN_FLIGHT - 1)?;
            }
            done(&mut in_flight, 0)?;
            let ticks = match &queries {
                Some(set) => self.resolve(set, count)?,
                None => Vec::new(),
            };
            for (frame, wall_ns) in walls.into_iter().enumerate() {
                let device_ns = timestamps.map(|period| {
                    // A clock that runs backwards gives centuries, which `choose_source` tells from a frame
                    let span = ticks[frame * 2 + 1].wrapping_sub(ticks[frame * 2]);
                    (span as f64 * f64::from(period)) as u64
                });
                times.push(FrameTime { device_ns, wall_ns });
            }
        }
        self.written = Some(Written { output, pixels: size.pixels(), dispatches: parts.len() as u32 });
        Ok(times)
    }

    /// See [`Prepared::timed`].
    pub(super) fn last_timed(&self) -> Result<Timed> {
        match &self.written {
            Some(Written { output, pixels, dispatches }) => {
                Ok(Timed { pixels: self.read(output, *pixels)?, dispatches: *dispatches })
            }
            None => Ok(Timed::default()),
        }
    }

    /// Parts of a frame for timing: the method's tiles, more of them where a watchdog asks for it.
    fn timing_parts(&mut self, config: Config, view: &View, size: Size) -> Result<Vec<Part>> {
        let bands = self.timing_bands(config, view, size)?;
        let tiles = self.method.tiles;
        Ok(self.parts(size, tiles, tiles.max(bands.div_ceil(tiles))))
    }

    /// Bands per frame for timing: one, unless the frame would keep the device busy for longer than a watchdog likes.
    fn timing_bands(&mut self, config: Config, view: &View, size: Size) -> Result<u32> {
        // A driver that computes on the CPU has no watchdog
        if self.backend.software_threads() > 0 {
            return Ok(1);
        }
        if let Some(&bands) = self.bands.get(&(config, size)) {
            return Ok(bands);
        }
        let compiled = self.backend.compiled(self.kernel_of(Entry::Render { config, counting: false }))?;
        let output = self.poisoned("the image", (size.pixels() * size_of::<Pixel>()) as u64)?;
        let narrow = self.parts(size, 1, size.height.div_ceil(64));
        let frames = self.frames(std::slice::from_ref(view), size, &narrow)?;
        let bindings = self.render_bindings(&compiled, &frames, &output);
        self.backend.settle()?;
        // Narrow bands together take longer than the whole, never shorter: they leave more of the device idle
        let start = Instant::now();
        for index in 0..narrow.len() {
            let submission = self.submit(&compiled, &bindings, &frames, index, None);
            self.backend.wait(submission)?;
        }
        let bands = bands_for(start.elapsed(), self.backend.options.max_dispatch);
        self.bands.insert((config, size), bands);
        Ok(bands)
    }

    fn resolve(&self, set: &wgpu::QuerySet, count: u32) -> Result<Vec<u64>> {
        let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        let resolved = self.backend.buffer("the timestamps", u64::from(count) * 8, usage)?;
        let mut encoder = self.backend.device.create_command_encoder(&Default::default());
        encoder.resolve_query_set(set, 0..count, &resolved, 0);
        self.backend.queue.submit([encoder.finish()]);
        self.read(&resolved, count as usize)
    }
}

/// Bands for a path whose first frame takes `frame`, so that none of its dispatches is longer than `most`.
fn bands_for(frame: Duration, most: Duration) -> u32 {
    let bands = (frame * SLOWEST).as_nanos().div_ceil(most.as_nanos().max(1));
    u32::try_from(bands).unwrap_or(u32::MAX).max(1)
}

impl GpuBackend {
    /// Waits until everything that was uploaded is there: the first frame must not pay for it.
    fn settle(&self) -> Result<()> {
        let uploads = self.queue.submit([]);
        self.wait(uploads)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_long_frames_are_cut() {
        let ms = Duration::from_millis;
        assert_eq!(bands_for(ms(0), ms(500)), 1);
        assert_eq!(bands_for(ms(100), ms(500)), 1);
        assert_eq!(bands_for(ms(101), ms(500)), 2);
        assert_eq!(bands_for(ms(1000), ms(500)), 10);
    }
}
