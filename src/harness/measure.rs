//! Timing one case that has been verified, and what the samples say about themselves.

use super::workload::{Case, Run};
use crate::device::FrameTime;
use crate::error::{Error, Result};
use crate::record::row::{Samples, TimingSource};
use crate::record::statistics;
use std::time::Instant;

/// Device and wall time may differ by this share before a warning says so.
const DISAGREEMENT: f64 = 0.10;

/// A first pass slower than the others by this factor is worth a warning: something was not warm yet.
const SLOW_START: f64 = 1.2;

/// No samples yet.
pub fn no_samples(stages: Vec<String>) -> Samples {
    let stage_ns = (stages.len() > 1).then(Vec::new);
    let stages = if stages.len() > 1 { stages } else { Vec::new() };
    Samples { stages, stage_ns, device_ns: Some(Vec::new()), ..Samples::default() }
}

/// Runs so many frames to warm up, which are not timed, then times one pass over a case's frames and adds it to the
/// samples.
///
/// # Errors
/// Those of [`Run::pass`]; [`Error::Device`] for a pass of another length than the ones before it.
pub fn pass(run: &mut dyn Run, case: &Case, warm_up: usize, samples: &mut Samples) -> Result<()> {
    if warm_up > 0 {
        run.pass(case, Some(warm_up))?;
    }
    let start = Instant::now();
    let frames = run.pass(case, None)?;
    samples.pass_ns.push(start.elapsed().as_nanos() as u64);
    if let Some(before) = samples.wall_ns.first()
        && before.len() != frames.len()
    {
        return Err(Error::Device(format!("{} of {} frames came back", frames.len(), before.len())));
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
    if frames.iter().any(|f| f.stages.len() != samples.stages.len()) {
        samples.stage_ns = None;
    }
    if let Some(stages) = &mut samples.stage_ns {
        stages.push(frames.iter().map(|f| f.stages.clone()).collect());
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
    warnings.extend(standstill(samples, source));
    warnings.extend(slow_start(samples, source));
    (source, warnings)
}

/// A warning where the clock did not advance during a frame, so that its time is zero.
fn standstill(samples: &Samples, source: TimingSource) -> Option<String> {
    let passes = match source {
        TimingSource::Device => samples.device_ns.as_ref()?,
        TimingSource::Wall => &samples.wall_ns,
    };
    let frames = passes.iter().map(Vec::len).sum::<usize>();
    let still = passes.iter().flatten().filter(|&&ns| ns == 0).count();
    (still > 0).then(|| {
        format!(
            "the clock did not advance in {still} of {frames} frames, whose times are 0: give a larger --resolution"
        )
    })
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

/// A warning where the first pass is much slower than the others.
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
