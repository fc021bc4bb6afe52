//! Runs frames: timestamps at the begin and the end of every stage, one submission in advance of the device, nothing
//! read back in between.

use super::binding::Pipeline;
use super::buffers::Buffer;
use super::device::VulkanDevice;
use super::pipeline::Bindings;
use crate::device::frame::PassTimer;
use crate::device::{Frame, FrameTime, Interrupted, Pass, Submissions};
use crate::error::{Error, Result};
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Submissions in flight: the next one is there before the last one is done.
const IN_FLIGHT: usize = 2;

/// Most timestamps of a query set, and so of a frame.
pub const MAX_TIMESTAMPS: usize = wgpu::QUERY_SET_MAX_QUERIES as usize;

/// Work-groups of a dispatch.
#[derive(Clone, Copy)]
pub enum Groups<'a> {
    /// As many in each dimension.
    Fixed(u32, u32, u32),
    /// As many as three words of a [`VulkanDevice::zeroed`] buffer say when the pass begins.
    Indirect {
        /// The buffer. The pass itself must not write it.
        buffer: &'a Buffer,
        /// Where the words begin, in bytes; a multiple of 4.
        offset: u64,
    },
}

/// The work of a pass.
#[derive(Clone, Copy)]
pub struct Dispatch<'a> {
    /// The kernel.
    pub pipeline: &'a Pipeline,
    /// Its bindings.
    pub bindings: &'a Bindings,
    /// Where its moving uniform begins, in bytes; `None` for a kernel without one.
    pub offset: Option<u32>,
    /// Work-groups.
    pub groups: Groups<'a>,
}

/// Submissions that the device works on, and the host's clock.
struct InFlight<'d> {
    device: &'d VulkanDevice,
    /// Submissions, and whether they end a frame.
    waiting: VecDeque<(wgpu::SubmissionIndex, bool)>,
    last: Instant,
    /// Of every frame that is done.
    wall_ns: Vec<u64>,
}

impl<'d> InFlight<'d> {
    fn new(device: &'d VulkanDevice, frames: usize) -> InFlight<'d> {
        let waiting = VecDeque::with_capacity(IN_FLIGHT);
        InFlight { device, waiting, last: Instant::now(), wall_ns: Vec::with_capacity(frames) }
    }

    /// Waits until at most `most` submissions are not done.
    fn drain(&mut self, most: usize) -> Result<()> {
        while self.waiting.len() > most {
            if let Some((submission, ends_frame)) = self.waiting.pop_front() {
                self.device.wait(submission)?;
                if ends_frame {
                    let now = Instant::now();
                    self.wall_ns.push((now - self.last).as_nanos() as u64);
                    self.last = now;
                }
            }
        }
        Ok(())
    }
}

/// Work-groups of indirect dispatches that a frame has read back.
#[derive(Default)]
struct ReadBack<'a>(Vec<(&'a Buffer, u64, [u32; 3])>);

impl<'a> ReadBack<'a> {
    /// The passes with what was read instead of what is to be read by the device.
    fn resolve(&mut self, device: &VulkanDevice, passes: &[Pass<Dispatch<'a>>]) -> Result<Vec<Pass<Dispatch<'a>>>> {
        let mut resolved = passes.to_vec();
        for Pass { work, .. } in &mut resolved {
            let Groups::Indirect { buffer, offset } = work.groups else { continue };
            let found = self.0.iter().find(|(known, at, _)| known.is(buffer) && *at == offset).map(|known| known.2);
            let [x, y, z] = match found {
                Some(groups) => groups,
                None => {
                    let first = offset as usize / 4;
                    let words: Vec<u32> = device.read(buffer, first + 3)?;
                    let groups = [words[first], words[first + 1], words[first + 2]];
                    self.0.push((buffer, offset, groups));
                    groups
                }
            };
            work.groups = Groups::Fixed(x, y, z);
        }
        Ok(resolved)
    }
}

/// The numbers of passes of a frame's submissions. One that reads back ends before each pass whose work-groups no pass
/// before it had.
fn submission_lengths(frame: &Frame<Dispatch>, reads_back: bool) -> Vec<usize> {
    let mut lengths = Vec::new();
    let mut seen: Vec<(&Buffer, u64)> = Vec::new();
    for pass in &frame.passes {
        let is_new = match pass.work.groups {
            Groups::Indirect { buffer, offset } if reads_back => {
                let is_new = !seen.iter().any(|(known, at)| known.is(buffer) && *at == offset);
                seen.push((buffer, offset));
                is_new
            }
            _ => false,
        };
        match lengths.last_mut() {
            Some(length) if !is_new && frame.submissions == Submissions::PerFrame => *length += 1,
            _ => lengths.push(1),
        }
    }
    lengths
}

impl VulkanDevice {
    /// Runs frames one after another and times each. Uploads are waited for before the first.
    ///
    /// # Errors
    /// [`Error::Interrupted`] between submissions, or the device's.
    pub fn run_frames(&self, frames: &[Frame<Dispatch>], interrupted: Interrupted) -> Result<Vec<FrameTime>> {
        self.run_all(frames, false, interrupted)
    }

    /// Runs frames as [`VulkanDevice::run_frames`] does, but reads the work-groups of indirect dispatches back in the
    /// middle of a frame, each number once, and dispatches by what it read.
    ///
    /// # Errors
    /// As [`VulkanDevice::run_frames`].
    pub fn run_frames_by_read_back(
        &self,
        frames: &[Frame<Dispatch>],
        interrupted: Interrupted,
    ) -> Result<Vec<FrameTime>> {
        self.run_all(frames, true, interrupted)
    }

    fn run_all(
        &self,
        frames: &[Frame<Dispatch>],
        reads_back: bool,
        interrupted: Interrupted,
    ) -> Result<Vec<FrameTime>> {
        let mut times = Vec::with_capacity(frames.len());
        let mut rest = frames;
        while !rest.is_empty() {
            let (chunk, after) = rest.split_at(self.frames_per_query_set(rest)?);
            self.run_chunk(chunk, reads_back, interrupted, &mut times)?;
            rest = after;
        }
        Ok(times)
    }

    /// Runs a frame without timestamps, one pass at a time, and waits for it. Uploads are waited for before the first.
    ///
    /// # Errors
    /// The device's.
    pub fn run(&self, frame: &Frame<Dispatch>) -> Result<Duration> {
        self.run_until(frame, &|| false)
    }

    /// Runs a frame as [`VulkanDevice::run`] does, unless it is interrupted.
    ///
    /// # Errors
    /// [`Error::Interrupted`] between passes, or the device's.
    pub fn run_until(&self, frame: &Frame<Dispatch>, interrupted: Interrupted) -> Result<Duration> {
        self.flush_uploads()?;
        let start = Instant::now();
        for pass in &frame.passes {
            if interrupted() {
                return Err(Error::Interrupted);
            }
            let submission = self.submit(std::slice::from_ref(pass), |_| None);
            self.wait(submission)?;
        }
        Ok(start.elapsed())
    }

    /// How many frames one query set has timestamps for.
    fn frames_per_query_set(&self, frames: &[Frame<Dispatch>]) -> Result<usize> {
        let mut room = MAX_TIMESTAMPS;
        let mut count = 0;
        for frame in frames {
            let needed = frame.timestamps();
            if needed == 0 {
                return Err(Error::Device("a frame has no pass".into()));
            }
            if needed > MAX_TIMESTAMPS {
                return Err(Error::Device(format!(
                    "a frame changes its stage {} times, too often to time",
                    needed / 2
                )));
            }
            if needed > room {
                break;
            }
            room -= needed;
            count += 1;
        }
        Ok(count)
    }

    fn run_chunk(
        &self,
        frames: &[Frame<Dispatch>],
        reads_back: bool,
        interrupted: Interrupted,
        times: &mut Vec<FrameTime>,
    ) -> Result<()> {
        let period = self.info().timestamp_period_ns;
        let count: usize = frames.iter().map(Frame::timestamps).sum();
        let queries = period.map(|_| {
            self.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: None,
                ty: wgpu::QueryType::Timestamp,
                count: count as u32,
            })
        });
        self.flush_uploads()?;
        let mut in_flight = InFlight::new(self, frames.len());
        let mut first_timestamp = 0;
        for frame in frames {
            let timers = frame.timers();
            let mut known = ReadBack::default();
            let mut first_pass = 0;
            for length in submission_lengths(frame, reads_back) {
                if interrupted() {
                    in_flight.drain(0)?;
                    return Err(Error::Interrupted);
                }
                let passes = &frame.passes[first_pass..first_pass + length];
                let read = match reads_back {
                    true => known.resolve(self, passes).inspect_err(|_| _ = in_flight.drain(0))?,
                    false => passes.to_vec(),
                };
                let submission = self.submit(&read, |pass| {
                    let PassTimer { begin, end } = timers[first_pass + pass];
                    let query_set = queries.as_ref().filter(|_| begin.is_some() || end.is_some())?;
                    Some(wgpu::ComputePassTimestampWrites {
                        query_set,
                        beginning_of_pass_write_index: begin.map(|index| first_timestamp + index),
                        end_of_pass_write_index: end.map(|index| first_timestamp + index),
                    })
                });
                first_pass += length;
                in_flight.waiting.push_back((submission, first_pass == frame.passes.len()));
                in_flight.drain(IN_FLIGHT - 1)?;
            }
            first_timestamp += frame.timestamps() as u32;
        }
        in_flight.drain(0)?;
        let ticks = match &queries {
            Some(set) => self.resolve(set, count)?,
            None => Vec::new(),
        };
        let mut ticks = ticks.as_slice();
        for (frame, wall_ns) in frames.iter().zip(in_flight.wall_ns) {
            let (own, after) = ticks.split_at(frame.timestamps().min(ticks.len()));
            times.push(frame.time(wall_ns, own, period.unwrap_or_default()));
            ticks = after;
        }
        Ok(())
    }

    /// Submits passes; `timer` says what the pass of an index writes.
    fn submit<'q>(
        &self,
        passes: &[Pass<Dispatch>],
        timer: impl Fn(usize) -> Option<wgpu::ComputePassTimestampWrites<'q>>,
    ) -> wgpu::SubmissionIndex {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        for (index, Pass { work, .. }) in passes.iter().enumerate() {
            let timestamp_writes = timer(index);
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes });
            pass.set_pipeline(&work.pipeline.pipeline);
            pass.set_bind_group(0, &work.bindings.0, work.offset.as_slice());
            match work.groups {
                Groups::Fixed(x, y, z) => pass.dispatch_workgroups(x, y, z),
                Groups::Indirect { buffer, offset } => pass.dispatch_workgroups_indirect(&buffer.buffer, offset),
            }
        }
        self.queue.submit([encoder.finish()])
    }

    fn resolve(&self, set: &wgpu::QuerySet, count: usize) -> Result<Vec<u64>> {
        let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        let resolved = self.buffer("the timestamps", count as u64 * 8, usage)?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.resolve_query_set(set, 0..count as u32, &resolved.buffer, 0);
        self.queue.submit([encoder.finish()]);
        self.read(&resolved, count)
    }

    /// Uploads something and waits until it is there; returns it with the time by the host's clock.
    ///
    /// # Errors
    /// Those of the upload, and the device's.
    pub fn time_upload<T>(&self, upload: impl FnOnce() -> Result<T>) -> Result<(T, Duration)> {
        self.flush_uploads()?;
        let start = Instant::now();
        let uploaded = upload()?;
        self.flush_uploads()?;
        Ok((uploaded, start.elapsed()))
    }

    /// Waits until everything that was uploaded is there: the first frame must not pay for it.
    fn flush_uploads(&self) -> Result<()> {
        let uploads = self.queue.submit([]);
        self.wait(uploads)
    }
}
