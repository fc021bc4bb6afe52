//! Pairs of cases in interleaved rounds: both sides are prepared and verified, then every round times the
//! first side, the second side and the first side again, in an order that reverses from round to round.

use super::measure::{self, no_samples};
use super::run::Opened;
use super::workload::{Case, Context, Event, Input, Run, Workload};
use crate::device::Device;
use crate::error::{Error, Result};
use crate::record::row::Samples;
use crate::record::statistics::interleaved_order;

/// Names of the sides: the first, the second, and the first again.
pub const SIDES: [&str; 3] = ["a", "b", "null"];

/// What to measure.
pub struct AbJob<'a> {
    /// Whose cases they are.
    pub workload: &'a dyn Workload,
    /// How they are measured.
    pub context: &'a Context<'a>,
    /// Where; cases refer to them by index.
    pub devices: &'a [Opened],
    /// The first and the second side of each pair.
    pub pairs: &'a [(Case, Case)],
    /// Rounds of each pair.
    pub rounds: usize,
}

/// The times of one round: nanoseconds of a pass over all frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RoundTime {
    /// By the device's timestamps, where it has them.
    pub device_ns: Option<u64>,
    /// By the host's clock.
    pub wall_ns: u64,
    /// Frames of the pass.
    pub frames: usize,
}

/// Measures all pairs, and hands every round to `record` as soon as it is measured: index of the pair, round, times by
/// side.
///
/// # Errors
/// An input that cannot be opened, a side that cannot be prepared or is wrong, a round that breaks (it is named), and
/// those of `record`.
pub fn run(job: &AbJob, record: &mut dyn FnMut(usize, usize, [RoundTime; 3]) -> Result<()>) -> Result<()> {
    // Pairs of the same inputs follow each other; each input is opened once for them
    let mut index = 0;
    while index < job.pairs.len() {
        let inputs = |pair: &(Case, Case)| (pair.0.input.clone(), pair.1.input.clone());
        let first = inputs(&job.pairs[index]);
        let count = job.pairs[index..].iter().take_while(|pair| inputs(pair) == first).count();
        let pairs = &job.pairs[index..index + count];
        let is_one = first.0 == first.1;
        let cases: Vec<Case> =
            pairs.iter().flat_map(|(a, b)| if is_one { vec![a.clone(), b.clone()] } else { vec![a.clone()] }).collect();
        let mut input_a = open(job, &cases)?;
        let others: Vec<Case> = pairs.iter().map(|(_, b)| b.clone()).collect();
        let mut input_b = if is_one { None } else { Some(open(job, &others)?) };
        for (offset, (a, b)) in pairs.iter().enumerate() {
            job.context.check_interrupt()?;
            let side = |name: &str, error: Error| at(&format!("side {name}"), error);
            input_a.build(a, device(job, a)).map_err(|error| side("a", error))?;
            let input_of_b = input_b.as_deref_mut().unwrap_or(&mut *input_a);
            input_of_b.build(b, device(job, b)).map_err(|error| side("b", error))?;
            pair(job, [&*input_a, input_b.as_deref().unwrap_or(&*input_a)], [a, b], &mut |round, times| {
                record(index + offset, round, times)
            })?;
            input_a.release();
            if let Some(input) = &mut input_b {
                input.release();
            }
        }
        index += count;
    }
    Ok(())
}

/// The device that a case runs on.
fn device<'a>(job: &AbJob<'a>, case: &Case) -> &'a Device {
    &job.devices[case.device.min(job.devices.len() - 1)].device
}

fn open<'a>(job: &AbJob<'a>, cases: &[Case]) -> Result<Box<dyn Input + 'a>> {
    job.context.check_interrupt()?;
    job.context.emit(Event::Doing(format!("loading {}", cases.first().map_or("", |case| &case.input))));
    job.workload.open(cases, job.context)
}

/// Names the place where something broke; an interruption stays one.
fn at(place: &str, error: Error) -> Error {
    match error {
        Error::Interrupted | Error::Output { .. } => error,
        Error::Input(mut input) => {
            input.problem = format!("{place}: {}", input.problem);
            Error::Input(input)
        }
        other => Error::Device(format!("{place}: {other}")),
    }
}

fn pair(
    job: &AbJob,
    inputs: [&dyn Input; 2],
    [a, b]: [&Case; 2],
    record: &mut dyn FnMut(usize, [RoundTime; 3]) -> Result<()>,
) -> Result<()> {
    let cases = [a, b, a];
    let mut runs: Vec<Box<dyn Run + '_>> = Vec::new();
    for (name, (input, case)) in SIDES.iter().zip([(inputs[0], a), (inputs[1], b), (inputs[0], a)]) {
        let mut run = input.prepare(device(job, case), case).map_err(|error| at(&format!("side {name}"), error))?;
        let verdict = run.verify(case).map_err(|error| at(&format!("side {name}"), error))?;
        if let Some(problem) = verdict.problem {
            return Err(Error::Device(format!("side {name} is wrong: {problem}")));
        }
        runs.push(run);
    }
    for round in 0..job.rounds {
        job.context.check_interrupt()?;
        job.context.emit(Event::Doing(format!("round {} of {}", round + 1, job.rounds)));
        let mut times = [RoundTime::default(); 3];
        for side in interleaved_order(SIDES.len(), round) {
            let mut samples: Samples = no_samples(Vec::new());
            let warm_up = job.context.settings.warmup_frames;
            measure::pass(&mut *runs[side], cases[side], warm_up, &mut samples)
                .map_err(|error| at(&format!("round {}, side {}", round + 1, SIDES[side]), error))?;
            times[side] = time(&samples);
        }
        record(round, times)?;
    }
    Ok(())
}

fn time(samples: &Samples) -> RoundTime {
    let frames = samples.wall_ns.first().map_or(0, Vec::len);
    let sum = |passes: &[Vec<u64>]| passes.iter().flatten().sum();
    let (source, _) = measure::choose_source(samples);
    let device = samples.device_ns.as_deref().filter(|_| source == crate::record::row::TimingSource::Device);
    RoundTime { device_ns: device.map(sum), wall_ns: sum(&samples.wall_ns), frames }
}
