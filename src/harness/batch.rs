//! The structures of a scene that are on the device at the same time. A configuration is verified and counted on each of
//! them; then their passes take turns, so that a machine that becomes slower, or faster, by the minute does so for all.

use crate::camera::View;
use crate::error::{Error, Result};
use crate::harness::configuration::{self, Candidate, Subject};
use crate::harness::measure;
use crate::harness::sweep::{Event, Opened, Sweep, memory};
use crate::record::schema::{ConfigurationRecord, Memory, Record, Samples};
use crate::workloads::trace::backend::{Config, Interrupted, Prepared, Size};
use crate::workloads::trace::{Built, Selection};
use std::collections::{HashMap, VecDeque};

/// A row of a scene: which of its paths, which size.
pub type Place = (usize, Size);

/// A structure with a traversal, and its rows that are still to be measured.
pub struct Member<'b> {
    candidate: Candidate<'b>,
    waiting: VecDeque<Place>,
    /// True once its structure has been recorded.
    recorded: bool,
}

impl<'b> Member<'b> {
    /// One of which nothing has been measured yet.
    pub fn new(selection: &'b Selection, built: &'b Built, waiting: VecDeque<Place>) -> Member<'b> {
        let candidate = Candidate { selection, built, memory: Memory::default(), small: HashMap::new() };
        Member { candidate, waiting, recorded: false }
    }

    fn settled(&mut self, place: Place) {
        self.waiting.retain(|&waiting| waiting != place);
    }
}

/// What is on the device, member by member; `None` for one that has nothing to measure or has to wait.
type OnDevice<'d> = Vec<Option<Box<dyn Prepared + 'd>>>;

/// A row that is being timed.
struct Turn<'p> {
    /// Whose row it is.
    member: usize,
    prepared: &'p mut dyn Prepared,
    record: ConfigurationRecord,
    samples: Samples,
    /// Why it takes no more turns.
    broken: Option<String>,
}

impl Turn<'_> {
    fn pass(&mut self, size: Size, warm_up: &[View], views: &[View], interrupted: Interrupted) -> Result<()> {
        let what = (self.record.config, size);
        measure::pass(self.prepared, what, warm_up, views, interrupted, &mut self.samples)
    }
}

/// Who comes when in a pass: every second pass goes backwards through the one before it (ABBA), so that what drifts
/// steadily is the same for all, and each pair of passes begins with another.
pub fn order(count: usize, pass: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    order.rotate_left((pass / 2) % count.max(1));
    if pass % 2 == 1 {
        order.reverse();
    }
    order
}

impl Sweep<'_, '_> {
    /// Measure all rows of some structures. A lost device costs the row that lost it, and is opened again for the others.
    pub(super) fn batch(&mut self, subject: &mut Subject, mut members: Vec<Member>) -> Result<()> {
        while members.iter().any(|member| !member.waiting.is_empty()) {
            // Held here, so that what is prepared on the device may borrow it while `self` writes records.
            let device = match self.device.take() {
                Some(device) => device,
                None => self.reopen()?,
            };
            let lost = match self.bring(subject, &device, &mut members)? {
                Some(mut prepared) => self.rows(subject, &mut members, &mut prepared)?,
                None => true,
            };
            if !lost {
                self.device = Some(device);
            }
        }
        Ok(())
    }

    /// Bring all structures that have rows to the device; `None` if it was lost over them. One that does not fit beside
    /// others waits until those are done.
    fn bring<'d, 's: 'd, 'b: 'd>(
        &mut self,
        subject: &Subject<'s>,
        device: &'d Opened,
        members: &mut [Member<'b>],
    ) -> Result<Option<OnDevice<'d>>> {
        let mut there: OnDevice = Vec::new();
        for member in members {
            if member.waiting.is_empty() {
                there.push(None);
                continue;
            }
            self.context.check_interrupt()?;
            let Candidate { selection, built, .. } = member.candidate;
            let prepared = device.backend.prepare(subject.scene, &built.structure, selection.method());
            if matches!(prepared, Err(Error::Device(_))) && there.iter().any(Option::is_some) {
                there.push(None);
                continue;
            }
            self.record_structure(subject, member, prepared.as_ref().ok().map(|p| p.allocated()))?;
            match prepared {
                Ok(prepared) => there.push(Some(prepared)),
                // It does not fit, whatever the size of the image.
                Err(Error::Device(message)) => {
                    while let Some(place) = member.waiting.pop_front() {
                        self.unable(subject, selection, Some(&member.candidate), place, &message)?;
                    }
                    there.push(None);
                }
                Err(error) => {
                    // There is one, or it would not have been brought
                    let Some(&place) = member.waiting.front() else { return Err(error) };
                    self.failed(subject, member, place, error)?;
                    return Ok(None);
                }
            }
        }
        Ok(Some(there))
    }

    /// Record a structure with its sizes, once.
    fn record_structure(
        &mut self,
        subject: &Subject,
        member: &mut Member,
        allocated: Option<(u64, u64)>,
    ) -> Result<()> {
        if std::mem::replace(&mut member.recorded, true) {
            return Ok(());
        }
        let Candidate { selection, built, .. } = member.candidate;
        member.candidate.memory = memory(built, subject.scene, allocated);
        let mut record = configuration::structure_record(subject, selection, built);
        record.memory = member.candidate.memory;
        if !self.earlier.has_structure(&record) {
            self.journal.write(&Record::Structure(Box::new(record.clone())))?;
        }
        self.say(Event::Built(&record));
        Ok(())
    }

    /// Measure what is waiting on the structures that are there, a configuration and size after another; true if the device
    /// was lost on the way.
    fn rows(&mut self, subject: &mut Subject, members: &mut [Member], prepared: &mut OnDevice) -> Result<bool> {
        loop {
            let there = members.iter().zip(prepared.iter()).filter(|(_, prepared)| prepared.is_some());
            let Some(place) = there.filter_map(|(member, _)| member.waiting.front()).next().copied() else {
                return Ok(false);
            };
            let Some(turns) = self.examined(subject, members, prepared, place)? else { return Ok(true) };
            if self.timed(subject, members, turns, place)? {
                return Ok(true);
            }
        }
    }

    /// Verify and count one configuration on every structure that is there and has it waiting. What is wrong gets its record
    /// here, the others are returned; `None` if the device was lost.
    fn examined<'p>(
        &mut self,
        subject: &mut Subject,
        members: &mut [Member],
        prepared: &'p mut OnDevice<'_>,
        place: Place,
    ) -> Result<Option<Vec<Turn<'p>>>> {
        let mut turns = Vec::new();
        for (index, (member, prepared)) in members.iter_mut().zip(prepared).enumerate() {
            let Some(prepared) = prepared.as_deref_mut().filter(|_| member.waiting.contains(&place)) else { continue };
            self.context.check_interrupt()?;
            self.say(Event::Doing(what(subject, member.candidate.selection.name(), place)));
            match configuration::examine(&mut self.context, subject, &mut member.candidate, prepared, place.0, place.1)
            {
                Ok(record) if record.verified => {
                    let samples = measure::no_samples();
                    turns.push(Turn { member: index, prepared, record, samples, broken: None });
                }
                Ok(record) => {
                    member.settled(place);
                    self.finish(record)?;
                }
                Err(error) => {
                    if self.failed(subject, member, place, error)? {
                        return Ok(None);
                    }
                }
            }
        }
        Ok(Some(turns))
    }

    /// Time one configuration on several structures, pass by pass in turn, and record each; true if the device was lost.
    fn timed(&mut self, subject: &Subject, members: &mut [Member], mut turns: Vec<Turn>, place: Place) -> Result<bool> {
        let (config, _, path) = &subject.paths[place.0];
        let (plan, interrupted, count) = (self.context.plan, self.context.interrupted, turns.len());
        let work = plan.work(*config, place.1, &path.views) / (plan.passes as u64 + 1);
        let warm_up: Vec<View> = path.views.iter().cycle().take(plan.warmup_frames).cloned().collect();
        if count > 0 {
            self.say(Event::Doing(what(subject, &format!("timing {count} structures,"), place)));
        }
        for pass in 0..plan.passes {
            for index in order(count, pass) {
                let turn = &mut turns[index];
                if turn.broken.is_some() {
                    continue;
                }
                match turn.pass(place.1, &warm_up, &path.views, interrupted) {
                    Ok(()) => self.say(Event::Work(work)),
                    Err(Error::Device(message)) => turn.broken = Some(message),
                    Err(error) => return self.failed(subject, &mut members[turn.member], place, error),
                }
            }
        }
        for Turn { member, prepared, mut record, samples, broken } in turns {
            let member = &mut members[member];
            record.turns = count;
            let concluded = match broken {
                Some(message) => Err(Error::Device(message)),
                None => configuration::conclude(&mut record, prepared, &path.views, samples),
            };
            match concluded {
                Ok(()) => {
                    member.settled(place);
                    self.finish(record)?;
                }
                Err(error) => {
                    if self.failed(subject, member, place, error)? {
                        return Ok(true);
                    }
                }
            }
        }
        Ok(false)
    }

    /// An error row for what the device refused or broke over; true if it is lost. Other errors end the sweep.
    fn failed(&mut self, subject: &Subject, member: &mut Member, place: Place, error: Error) -> Result<bool> {
        let lost = match &error {
            Error::Device(_) => false,
            Error::DeviceLost(_) => true,
            _ => return Err(error),
        };
        member.settled(place);
        let Candidate { selection, .. } = member.candidate;
        self.unable(subject, selection, Some(&member.candidate), place, &error.to_string())?;
        Ok(lost)
    }
}

/// What is being done, for whoever is watching.
fn what(subject: &Subject, who: &str, (path, Size { width, height }): Place) -> String {
    let config: Config = subject.paths[path].0;
    format!("{} {who} {config:?} {width}x{height}", subject.record.name)
}
