//! The measuring loop, the same for all workloads: input by input, what is needed is built and prepared, and every case
//! is verified, counted and timed, in this order. Cases of the same turn are timed in interleaved passes. A row is on
//! the disk before the next turn begins; what one case cannot do is a row and never the end of the run.

use super::environment;
use super::failure::failure;
use super::plan::Plan;
use super::previous::PreviousRun;
use super::summary;
use super::workload::{Case, Context, Event, Input, Run, Workload};
use crate::device::{Device, DeviceInfo};
use crate::error::{Error, Result};
use crate::record::journal::Record;
use crate::record::journal::{self, Journal, JournalWriter};
use crate::record::row::{Artifact, Key, Row, SCHEMA};
use crate::record::run::{DeviceRecord, End, Provenance, Resumed};
use std::cell::RefCell;
use std::collections::{HashSet, VecDeque};
use std::path::Path;

pub use super::outcome::Outcome;

/// Artifacts are built until this many bytes wait to be brought to the device together.
const BATCH_BYTES: u64 = 512 << 20;

/// An opened device, and why it was taken.
pub struct Opened {
    /// The device.
    pub device: Device,
    /// For the user and the record.
    pub reason: String,
}

/// Everything that a run needs.
pub struct Job<'a> {
    /// Whose cases they are.
    pub workload: &'a dyn Workload,
    /// What to measure.
    pub plan: &'a Plan,
    /// Folder of the run; new or empty, except for a run that is resumed.
    pub out: &'a Path,
    /// Rows of earlier sessions.
    pub previous: PreviousRun,
    /// Command line.
    pub arguments: Vec<String>,
    /// The devices, open; cases refer to them by index.
    pub devices: Vec<Opened>,
    /// Opens one of them again after it was lost.
    pub open: &'a dyn Fn(usize) -> Result<Opened>,
    /// Ctrl-C.
    pub interrupted: &'a dyn Fn() -> bool,
    /// Receives progress.
    pub watch: &'a mut dyn FnMut(Event),
}

/// Runs a plan. Also after an error, the journal holds every row measured until then, and the files derived from it are
/// written.
///
/// # Errors
/// [`Error::Interrupted`], [`Error::Output`], [`Error::Input`] where nothing else is to be measured, or a lost device
/// that does not come back.
pub fn run(mut job: Job) -> Result<Outcome> {
    let record = |opened: &Opened| DeviceRecord { info: opened.device.info().clone(), reason: opened.reason.clone() };
    let program = environment::program();
    let devices: Vec<DeviceRecord> = job.devices.iter().map(record).collect();
    let provenance = Provenance {
        schema: SCHEMA.into(),
        id: String::new(),
        workload: job.workload.info().name.into(),
        started: environment::now(),
        arguments: job.arguments,
        environment: environment::capture(&program, &devices),
        program,
        devices,
        plan: job.plan.record(),
        merged: Vec::new(),
    }
    .identified();
    job.previous.check(&provenance)?;
    let watch = RefCell::new(job.watch);
    let context = Context {
        settings: job.plan.settings,
        out: job.out,
        library: job.plan.library.clone(),
        interrupted: job.interrupted,
        watch: &|event| (watch.borrow_mut())(event),
    };
    let inputs = job.plan.inputs();
    let alone = inputs.len() == 1;
    // Where there is only one input, nothing is begun unless it can be opened
    let mut first = match inputs.first() {
        Some((_, cases)) if alone => Some(open(job.workload, &context, cases)?),
        _ => None,
    };
    let mut journal = if job.previous.provenance().is_some() {
        let Provenance { started, arguments, environment, .. } = provenance;
        JournalWriter::resume(job.out, Resumed { started, arguments, environment }, job.previous.length())?
    } else {
        JournalWriter::create(job.out, provenance)?
    };
    let mut runner = Runner {
        workload: job.workload,
        context: &context,
        infos: job.devices.iter().map(|opened| opened.device.info().clone()).collect(),
        devices: job.devices.into_iter().map(Some).collect(),
        open: job.open,
        artifacts: job.previous.artifacts(),
        previous: job.previous,
        budget: job.plan.budget,
        journal: &mut journal,
    };
    let ended = inputs.into_iter().try_for_each(|(_, cases)| runner.input(&cases, first.take()));
    let closed = journal.write(&Record::End(End {
        ended: environment::now(),
        interrupted: matches!(ended, Err(Error::Interrupted)),
        complete: ended.is_ok(),
        load_average: environment::load_average(),
        message: ended.as_ref().err().map(Error::to_string).unwrap_or_default(),
    }));
    // And with it its lock
    drop(journal);
    let journal = Journal::read(&job.out.join(journal::FILE_NAME));
    let derived = journal.and_then(|journal| {
        summary::write(job.workload, &journal, job.out)?;
        Ok(Outcome { journal })
    });
    // The first error is the one that the user has to know.
    ended.and(closed).and(derived)
}

/// Opens the input of some cases.
fn open<'a>(workload: &'a dyn Workload, context: &'a Context<'a>, cases: &[Case]) -> Result<Box<dyn Input + 'a>> {
    context.check_interrupt()?;
    context.emit(Event::Doing(format!("loading {}", cases.first().map_or("", |case| &case.input))));
    workload.open(cases, context)
}

/// A run in progress.
pub(super) struct Runner<'a, 'j> {
    workload: &'a dyn Workload,
    pub(super) context: &'a Context<'a>,
    /// `None` after it was lost, until something needs it again.
    devices: Vec<Option<Opened>>,
    infos: Vec<DeviceInfo>,
    open: &'a dyn Fn(usize) -> Result<Opened>,
    pub(super) previous: PreviousRun,
    /// Most work of a case.
    budget: Option<u64>,
    /// Keys of the artifacts that have been recorded.
    artifacts: Vec<Key>,
    pub(super) journal: &'j mut JournalWriter,
}

/// Cases that are prepared together and still have to be measured.
pub(super) type Pending = VecDeque<Case>;

/// What is prepared, group by group; `None` for one without pending cases, and for one that waits for room.
pub(super) type Runs<'d> = Vec<Option<Box<dyn Run + 'd>>>;

impl<'a> Runner<'a, '_> {
    /// Opens an input, unless it is open, and measures its cases.
    fn input(&mut self, cases: &[Case], opened: Option<Box<dyn Input + 'a>>) -> Result<()> {
        let Some(first) = cases.first() else { return Ok(()) };
        let mut input = match opened.map_or_else(|| open(self.workload, self.context, cases), Ok) {
            Ok(input) => input,
            // There are rows of it already: what is missing must be put back first
            Err(error @ Error::Input(_)) if self.previous.has_opened(self.workload.info(), first) => return Err(error),
            Err(error) => {
                let error = failure(error)?;
                let workload = self.workload.info().name.to_owned();
                for case in cases {
                    let key = Key { workload: workload.clone(), axes: case.axes.clone(), inputs: Default::default() };
                    self.without_result(Row::new(key, self.context.settings, case.device), &error)?;
                }
                return Ok(());
            }
        };
        for warning in input.warnings() {
            self.context.emit(Event::Note(format!("{}: {warning}", first.input)));
        }
        self.previous.check_inputs(&input.records())?;
        for record in input.records() {
            if !self.previous.has_input(&record) {
                self.journal.write(&Record::Input(Box::new(record)))?;
            }
        }
        let mut groups = self.pending(input.as_ref(), cases);
        let done = groups.is_empty();
        self.refuse_large(input.as_ref(), &mut groups)?;
        while !groups.is_empty() {
            let batch = self.build(input.as_mut(), &mut groups)?;
            self.batch(input.as_ref(), batch)?;
            input.release();
        }
        // Last: rows matter more where the disk is about to be full
        if done && input.has_pictures() { Ok(()) } else { self.pictures(input.as_ref(), first) }
    }

    /// The cases that no earlier session has measured, by group. The rows of the others are kept, and made known to the
    /// input for comparison.
    fn pending(&mut self, input: &dyn Input, cases: &[Case]) -> Vec<Pending> {
        let mut groups: Vec<Pending> = Vec::new();
        let mut keys = HashSet::new();
        for case in cases {
            if !keys.insert((input.key(case), case.device)) {
                // Two spellings of one case
                self.context.emit(Event::Note(format!("{} {} is in the plan twice", case.input, case.group)));
                self.context.emit(Event::Kept(case.work));
                continue;
            }
            if let Some(row) = self.previous.row(&input.key(case), case.device) {
                input.remember(case, row);
                self.context.emit(Event::Kept(case.work));
                continue;
            }
            let same = |group: &&mut Pending| {
                group.front().is_some_and(|known| known.group == case.group && known.device == case.device)
            };
            match groups.iter_mut().find(same) {
                Some(group) => group.push_back(case.clone()),
                None => groups.push(VecDeque::from([case.clone()])),
            }
        }
        groups
    }

    /// Makes rows of the cases that are above the budget.
    fn refuse_large(&mut self, input: &dyn Input, groups: &mut Vec<Pending>) -> Result<()> {
        let (Some(budget), unit) = (self.budget, self.workload.info().work_unit) else { return Ok(()) };
        for group in &mut *groups {
            let (large, others): (Pending, Pending) = group.drain(..).partition(|case| case.work > budget);
            *group = others;
            for case in large {
                let need = format!("{} {unit} per pass are needed, the budget is {budget}", case.work);
                let error = failure(Error::too_large("the case", need, "give a larger --budget, or a smaller case"))?;
                self.without_result(Row::new(input.key(&case), self.context.settings, case.device), &error)?;
                self.context.emit(Event::Kept(case.work));
            }
        }
        groups.retain(|group| !group.is_empty());
        Ok(())
    }

    /// Builds what the next groups need, as many as main memory should hold at a time. What is refused becomes rows. A
    /// device that is lost over it is opened again for the others.
    fn build(&mut self, input: &mut dyn Input, groups: &mut Vec<Pending>) -> Result<Vec<Pending>> {
        let devices = self.take_devices()?;
        let built = self.build_on(&devices, input, groups);
        self.devices = devices.into_iter().map(Some).collect();
        let (batch, lost) = built?;
        lost.into_iter().for_each(|lost| self.devices[lost] = None);
        Ok(batch)
    }

    /// The groups that are built, and the index of a device that was lost.
    fn build_on(
        &mut self,
        devices: &[Opened],
        input: &mut dyn Input,
        groups: &mut Vec<Pending>,
    ) -> Result<(Vec<Pending>, Option<usize>)> {
        let (mut batch, mut bytes, mut lost) = (Vec::new(), 0, None);
        while bytes < BATCH_BYTES && lost.is_none() && !groups.is_empty() {
            self.context.check_interrupt()?;
            let group = groups.remove(0);
            let Some(case) = group.front() else { continue };
            match input.build(case, &devices[case.device].device) {
                Ok(size) => {
                    bytes += size;
                    batch.push(group);
                }
                Err(error) => {
                    lost = matches!(error, Error::DeviceLost(_)).then_some(case.device);
                    let error = failure(error)?;
                    for case in &group {
                        self.without_result(Row::new(input.key(case), self.context.settings, case.device), &error)?;
                    }
                }
            }
        }
        Ok((batch, lost))
    }

    /// Measures all cases of some groups. A lost device costs the row that lost it, and is opened again for the others.
    fn batch(&mut self, input: &dyn Input, mut groups: Vec<Pending>) -> Result<()> {
        while groups.iter().any(|group| !group.is_empty()) {
            // Held here, so that what is prepared may borrow them while `self` writes rows.
            let mut devices = self.take_devices()?;
            let lost = match self.prepare(input, &devices, &mut groups)? {
                Ok(mut runs) => self.turns(input, &mut groups, &mut runs)?,
                Err(lost) => Some(lost),
            };
            if let Some(lost) = lost {
                devices.remove(lost);
                self.devices = devices.into_iter().map(Some).collect();
                self.devices.insert(lost, None);
            } else {
                self.devices = devices.into_iter().map(Some).collect();
            }
        }
        Ok(())
    }

    /// All devices; one that was lost is opened again. It must be the same: a table of two devices would be worthless.
    fn take_devices(&mut self) -> Result<Vec<Opened>> {
        let mut taken = Vec::new();
        for (index, device) in std::mem::take(&mut self.devices).into_iter().enumerate() {
            taken.push(match device {
                Some(device) => device,
                None => {
                    let name = &self.infos[index].name;
                    self.context.emit(Event::Note(format!("{name} was lost and is opened again")));
                    let device =
                        (self.open)(index).map_err(|e| Error::DeviceLost(format!("it cannot be opened again: {e}")))?;
                    let (before, now) = (&self.infos[index], device.device.info());
                    if now != before {
                        let (before, now) = (before.with_driver(), now.with_driver());
                        return Err(Error::DeviceLost(format!("{before} did not come back, there is only {now}")));
                    }
                    device
                }
            });
        }
        Ok(taken)
    }

    /// Prepares all groups that have pending cases, or returns the index of the device that was lost over it. A group
    /// for which there is no room next to others waits until those are done.
    fn prepare<'d>(
        &mut self,
        input: &'d dyn Input,
        devices: &'d [Opened],
        groups: &mut [Pending],
    ) -> Result<std::result::Result<Runs<'d>, usize>> {
        let mut runs: Runs = Vec::new();
        for group in groups {
            let Some(case) = group.front() else {
                runs.push(None);
                continue;
            };
            self.context.check_interrupt()?;
            let device = case.device;
            let run = input.prepare(&devices[device].device, case);
            if run.as_ref().is_err_and(Error::is_lack_of_room) && runs.iter().any(Option::is_some) {
                runs.push(None);
                continue;
            }
            let artifact = run.as_ref().ok().and_then(|run| run.artifact()).or_else(|| input.artifact(case));
            self.record_artifact(artifact)?;
            match run {
                Ok(run) => runs.push(Some(run)),
                Err(error @ Error::DeviceLost(_)) => {
                    let row = self.begun(input, None, case);
                    group.pop_front();
                    self.without_result(row, &failure(error)?)?;
                    return Ok(Err(device));
                }
                Err(error) => {
                    let error = failure(error)?;
                    while let Some(case) = group.pop_front() {
                        let row = self.begun(input, None, &case);
                        self.without_result(row, &error)?;
                    }
                    runs.push(None);
                }
            }
        }
        Ok(Ok(runs))
    }

    /// Records an artifact, once.
    fn record_artifact(&mut self, artifact: Option<Artifact>) -> Result<()> {
        match artifact {
            Some(artifact) if !self.artifacts.contains(&artifact.key) => {
                self.artifacts.push(artifact.key.clone());
                self.journal.write(&Record::Artifact(Box::new(artifact)))
            }
            _ => Ok(()),
        }
    }

    /// Pictures of an input. A device that is lost over them is opened again for the next input, not for them.
    fn pictures(&mut self, input: &dyn Input, case: &Case) -> Result<()> {
        let Some(device) = self.devices.get_mut(case.device).and_then(Option::take) else {
            self.context.emit(Event::Note(format!("no pictures of {}: the device was lost", case.input)));
            return Ok(());
        };
        match input.pictures(&device.device) {
            Err(Error::DeviceLost(message)) => {
                self.context.emit(Event::Note(format!("no pictures of {}: {message}", case.input)));
                Ok(())
            }
            other => {
                self.devices[case.device] = Some(device);
                other
            }
        }
    }
}
