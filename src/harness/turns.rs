//! One turn of the measuring loop: cases are verified and counted one after another, then timed in interleaved passes.

use super::failure::failure;
use super::measure;
use super::order::order;
use super::run::{Pending, Runner, Runs};
use super::workload::{Case, Event, Input, Run, Verdict};
use crate::error::{Error, Result};
use crate::record::journal::Record;
use crate::record::row::{Row, Samples, Status};
use std::time::Instant;

/// A case whose passes are being timed.
struct TimedCase<'r> {
    /// Index of its group in the batch.
    group: usize,
    case: Case,
    run: &'r mut dyn Run,
    row: Row,
    samples: Samples,
    /// Why no further pass is timed.
    broken: Option<Error>,
}

impl Runner<'_, '_> {
    /// Measures the pending cases of what is prepared, turn by turn; the index of a device that was lost on the way.
    pub(super) fn turns(
        &mut self,
        input: &dyn Input,
        groups: &mut [Pending],
        runs: &mut Runs,
    ) -> Result<Option<usize>> {
        loop {
            let prepared = groups.iter().zip(runs.iter()).filter(|(_, run)| run.is_some());
            let Some(turn) = prepared.filter_map(|(group, _)| group.front()).map(|case| case.turn.clone()).next()
            else {
                return Ok(None);
            };
            let timed = match self.verify(input, groups, runs, &turn)? {
                Ok(timed) => timed,
                Err(lost) => return Ok(Some(lost)),
            };
            let lost = self.time(groups, timed)?;
            if lost.is_some() {
                return Ok(lost);
            }
        }
    }

    /// Verifies and counts the cases of a turn. What is wrong gets its row here, the others are returned; or the index
    /// of a device that was lost.
    fn verify<'r>(
        &mut self,
        input: &dyn Input,
        groups: &mut [Pending],
        runs: &'r mut Runs<'_>,
        turn: &str,
    ) -> Result<std::result::Result<Vec<TimedCase<'r>>, usize>> {
        let mut timed = Vec::new();
        for (index, (group, run)) in groups.iter_mut().zip(runs).enumerate() {
            let Some(run) = run.as_deref_mut() else { continue };
            let Some(place) = group.iter().position(|case| case.turn == turn) else { continue };
            let Some(case) = group.remove(place) else { continue };
            self.context.check_interrupt()?;
            self.context.emit(Event::Doing(label(&case)));
            let mut row = self.begun(input, Some(&*run), &case);
            match verified(run, &case, &mut row) {
                Ok(true) => {
                    let samples = measure::no_samples(run.stages(&case));
                    timed.push(TimedCase { group: index, case, run, row, samples, broken: None });
                }
                Ok(false) => self.finish(row)?,
                Err(error) => {
                    let is_lost = matches!(error, Error::DeviceLost(_));
                    self.without_result(row, &failure(error)?)?;
                    if is_lost {
                        // Cases that were verified and not timed are measured again on the new device
                        timed.into_iter().for_each(|t: TimedCase| groups[t.group].push_front(t.case));
                        return Ok(Err(case.device));
                    }
                }
            }
        }
        Ok(Ok(timed))
    }

    /// Times the cases of a turn, pass by pass interleaved, and records each; the index of a device that was lost.
    fn time(&mut self, groups: &mut [Pending], mut timed: Vec<TimedCase>) -> Result<Option<usize>> {
        let (context, count) = (self.context, timed.len());
        if let Some(first) = timed.first() {
            context.emit(Event::Doing(format!("timing {count} cases such as {}", label(&first.case))));
        }
        let passes = context.settings.passes;
        // What ends the timing of all cases
        let mut ended = None;
        'passes: for pass in 0..passes {
            for index in order(count, pass) {
                let TimedCase { case, run, samples, broken, .. } = &mut timed[index];
                if broken.is_some() {
                    continue;
                }
                match measure::pass(*run, case, context.settings.warmup_frames, samples) {
                    Ok(()) => context.emit(Event::Work(case.work / (passes as u64 + 1))),
                    Err(Error::Interrupted) => {
                        ended = Some(Error::Interrupted);
                        break 'passes;
                    }
                    Err(error) => {
                        let is_lost = matches!(error, Error::DeviceLost(_));
                        *broken = Some(error);
                        if is_lost {
                            break 'passes;
                        }
                    }
                }
            }
        }
        let is_lost = |error: &Error| matches!(error, Error::DeviceLost(_));
        let lost_by = |case: &TimedCase| case.broken.as_ref().is_some_and(is_lost).then_some(case.case.device);
        let mut lost = timed.iter().find_map(lost_by);
        for TimedCase { group, case, run, mut row, samples, broken } in timed {
            row.interleaved_with = count;
            let is_whole = samples.wall_ns.len() == passes && lost != Some(case.device);
            let finished = match broken {
                Some(error) => Err(error),
                // It is measured again, on the device that is opened in place of the lost one or by a resumed run
                None if !is_whole => {
                    groups[group].push_front(case);
                    continue;
                }
                None => finished(run, &case, &mut row, samples),
            };
            match finished {
                Ok(()) => self.finish(row)?,
                Err(Error::Interrupted) => ended = Some(Error::Interrupted),
                Err(error) => {
                    if is_lost(&error) {
                        lost = Some(case.device);
                    }
                    match failure(error) {
                        Ok(failure) => self.without_result(row, &failure)?,
                        // Not about this case: the others are recorded before it ends the run
                        Err(error) => ended = Some(error),
                    }
                }
            }
        }
        ended.map_or(Ok(lost), Err)
    }

    /// A row with everything that is known before anything is measured.
    pub(super) fn begun(&self, input: &dyn Input, run: Option<&dyn Run>, case: &Case) -> Row {
        let mut row = Row::new(input.key(case), self.context.settings, case.device);
        let artifact = run.and_then(|run| run.artifact()).or_else(|| input.artifact(case));
        row.metrics = artifact.map(|artifact| artifact.metrics).unwrap_or_default();
        row
    }

    /// The row of a case that has no result.
    pub(super) fn without_result(&mut self, mut row: Row, (status, message): &(Status, String)) -> Result<()> {
        row.refuse(*status, message);
        self.finish(row)
    }

    /// Writes a row to the journal.
    fn finish(&mut self, mut row: Row) -> Result<()> {
        row.device = self.previous.device(row.device);
        let record = Record::Row(Box::new(row));
        self.journal.write(&record)?;
        if let Record::Row(row) = &record {
            self.context.emit(Event::Finished(row));
        }
        Ok(())
    }
}

/// Verifies and counts a case; true if it may be timed.
fn verified(run: &mut dyn Run, case: &Case, row: &mut Row) -> Result<bool> {
    row.kernels = run.kernels(case)?;
    let start = Instant::now();
    let verdict = run.verify(case)?;
    row.verification_s = start.elapsed().as_secs_f64();
    if !agrees(verdict, row) {
        return Ok(false);
    }
    let start = Instant::now();
    let verdict = run.count(case)?;
    row.counting_s = start.elapsed().as_secs_f64();
    Ok(agrees(verdict, row))
}

/// Completes the row of a case that has been timed.
fn finished(run: &mut dyn Run, case: &Case, row: &mut Row, samples: Samples) -> Result<()> {
    let verdict = run.recheck(case)?;
    if agrees(verdict, row) {
        let (source, warnings) = measure::choose_source(&samples);
        row.timing_source = Some(source);
        row.warnings.extend(warnings);
        row.samples = Some(samples);
        row.status = Status::Ok;
    }
    Ok(())
}

/// Adds a verdict to a row; false if it makes the row wrong.
fn agrees(verdict: Verdict, row: &mut Row) -> bool {
    row.checks.extend(verdict.checks);
    row.outputs.extend(verdict.outputs);
    row.metrics.extend(verdict.metrics);
    row.warnings.extend(verdict.warnings);
    row.difference = verdict.difference.or(row.difference.take());
    match verdict.problem {
        Some(problem) => {
            row.refuse(Status::Wrong, &problem);
            false
        }
        None => true,
    }
}

/// A case for a line of progress.
fn label(case: &Case) -> String {
    format!("{} {} {}", case.input, case.group, case.turn)
}
