//! Counting and timing one configuration that has been verified.

use crate::camera::View;
use crate::error::{Error, Result};
use crate::record::schema::{CounterSums, Samples, TimingSource};
use crate::record::statistics;
use crate::workloads::trace::backend::{Config, FrameTime, Interrupted, Prepared, Size};
use std::time::Instant;

/// Device and wall time may differ by this share before a warning says so.
const DISAGREEMENT: f64 = 0.10;

/// A first pass slower than the others by this factor is worth a warning: something was not warm yet.
const SLOW_START: f64 = 1.2;

/// What the counting kernel found on a path.
pub struct Counted {
    /// Over all frames, by ray type.
    pub sums: [CounterSums; 3],
    /// First frame, RGBA8: must be the timed kernel's to the bit.
    pub first_image: Vec<u8>,
}

/// Renders every frame once with the counting kernel and adds up.
///
/// # Errors
/// The device's, or [`Error::Interrupted`] between frames.
pub fn count(
    prepared: &mut dyn Prepared,
    config: Config,
    views: &[View],
    size: Size,
    interrupted: Interrupted,
    counted_frame: &mut dyn FnMut(),
) -> Result<Counted> {
    let mut sums = [CounterSums::default(); 3];
    let mut first_image = Vec::with_capacity(size.pixels() * 4);
    for (frame, view) in views.iter().enumerate() {
        if interrupted() {
            return Err(Error::Interrupted);
        }
        prepared.counted(config, view, size, &mut |_, pixels| {
            for pixel in pixels {
                for (sum, counters) in sums.iter_mut().zip(&pixel.counters) {
                    sum.add(counters);
                }
                if frame == 0 {
                    first_image.extend_from_slice(&pixel.pixel.rgba.to_le_bytes());
                }
            }
        })?;
        counted_frame();
    }
    Ok(Counted { sums, first_image })
}

/// No samples yet.
pub fn no_samples() -> Samples {
    Samples { device_ns: Some(Vec::new()), ..Samples::default() }
}

/// Runs `warm_up`, which is not timed, then times one pass over a path and adds it to the samples.
///
/// # Errors
/// The device's, or [`Error::Interrupted`].
pub fn pass(
    prepared: &mut dyn Prepared,
    (config, size): (Config, Size),
    warm_up: &[View],
    views: &[View],
    interrupted: Interrupted,
    samples: &mut Samples,
) -> Result<()> {
    if !warm_up.is_empty() {
        prepared.time_path(config, warm_up, size, interrupted)?;
    }
    let start = Instant::now();
    let frames = prepared.time_path(config, views, size, interrupted)?;
    samples.pass_ns.push(start.elapsed().as_nanos() as u64);
    if frames.len() != views.len() {
        return Err(Error::Device(format!("{} of {} frames came back", frames.len(), views.len())));
    }
    push(samples, &frames);
    Ok(())
}

/// Adds a pass.
fn push(samples: &mut Samples, frames: &[FrameTime]) {
    samples.wall_ns.push(frames.iter().map(|f| f.wall_ns).collect());
    let device: Option<Vec<u64>> = frames.iter().map(|f| f.device_ns).collect();
    match (device, &mut samples.device_ns) {
        (Some(device), Some(passes)) => passes.push(device),
        _ => samples.device_ns = None,
    }
}

/// Decides which clock gives the frame time: the device's timestamps if each frame has a sane one, the host's
/// otherwise; and says what is odd about the samples.
///
/// Sane means greater than zero, and no pass whose frames add up to more than twice what the host saw pass by: broken
/// timestamps are known to come as zeros or running backwards, which wraps around to centuries.
pub fn choose_source(samples: &Samples) -> (TimingSource, Vec<String>) {
    let mut warnings = Vec::new();
    let mut source = TimingSource::Wall;
    if let Some(device) = &samples.device_ns {
        let sane = device.iter().zip(&samples.pass_ns).all(|(pass, &wall)| {
            let sum = pass.iter().fold(0u64, |sum, &ns| sum.saturating_add(ns));
            pass.iter().all(|&ns| ns > 0) && sum <= wall.saturating_mul(2)
        });
        if sane {
            source = TimingSource::Device;
            warnings.extend(disagreement(device, &samples.wall_ns));
        } else {
            warnings.push("device timestamps are zero or run backwards: wall time is used".into());
        }
    }
    warnings.extend(slow_start(samples, source));
    (source, warnings)
}

/// A warning where both clocks tell different stories.
fn disagreement(device: &[Vec<u64>], wall: &[Vec<u64>]) -> Option<String> {
    let (device, wall) = (statistics::frames(device)?.mean_ms, statistics::frames(wall)?.mean_ms);
    let share = (wall - device) / device;
    (share.abs() > DISAGREEMENT).then(|| {
        format!(
            "wall time per frame is {:+.0} % of the device's: frames wait for the CPU, or the timestamps are wrong",
            100.0 * share
        )
    })
}

/// A warning where the first pass stands out.
fn slow_start(samples: &Samples, source: TimingSource) -> Option<String> {
    let passes = match source {
        TimingSource::Device => samples.device_ns.as_ref()?,
        TimingSource::Wall => &samples.wall_ns,
    };
    let totals: Vec<f64> = passes.iter().map(|pass| pass.iter().sum::<u64>() as f64).collect();
    let (first, others) = totals.split_first()?;
    // With fewer than two others there is nothing to tell an outlier from.
    let usual = statistics::median(others).filter(|_| others.len() >= 2)?;
    (*first > SLOW_START * usual)
        .then(|| format!("the first pass took {:.1} times as long as the others: give more --warmup", first / usual))
}
