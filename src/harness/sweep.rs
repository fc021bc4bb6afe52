//! The sweep: scene by scene, structures are built, and every configuration is verified, counted and timed, in this order,
//! in turn with the other structures ([`super::batch`]); its records are on the disk before the next one begins.

use crate::error::{Error, Result};
use crate::harness::batch::{Member, Place};
use crate::harness::building;
use crate::harness::configuration::{self, Candidate, Context, Subject};
use crate::harness::environment;
use crate::harness::pictures;
use crate::harness::plan::{self, Path, Plan, Task};
use crate::harness::resume::Earlier;
use crate::harness::verify::Verifier;
use crate::record::journal::{self, Journal, JournalWriter};
use crate::record::schema::{
    ConfigurationRecord, End, Failure, Memory, Provenance, Record, Resumed, SCHEMA, Status, StructureRecord,
};
use crate::record::summary::Run;
use crate::scene::Scene;
use crate::workloads::trace::backend::{Backend, Config, Interrupted};
use crate::workloads::trace::{Built, Selection};
use std::collections::{HashMap, VecDeque};
use std::sync::Arc;

/// Structures are built until so many bytes wait to be brought to the device together.
const BATCH_BYTES: u64 = 512 << 20;

/// An opened device, and why it was taken.
pub struct Opened {
    /// The device.
    pub backend: Box<dyn Backend>,
    /// For the user and the record.
    pub reason: String,
}

/// What a sweep tells whoever is watching.
pub enum Event<'a> {
    /// Something is being done that takes a moment.
    Doing(String),
    /// A structure is being built.
    Building(String),
    /// A structure is built.
    Built(&'a StructureRecord),
    /// This much of the planned work (see [`Plan::work`]) is behind us.
    Work(u64),
    /// A configuration has its record.
    Finished(&'a ConfigurationRecord),
    /// An earlier session settled a configuration of this much work.
    Kept(u64),
    /// Something that the user should read.
    Note(String),
}

/// Everything that a sweep needs.
pub struct Job<'a> {
    /// What to measure.
    pub plan: &'a Plan,
    /// Folder of the run; new or empty, but for a run that is taken up again.
    pub out: &'a std::path::Path,
    /// What is there of it already.
    pub earlier: Earlier,
    /// Threads for building, 0 for as many as the plan says.
    pub threads: usize,
    /// Command line.
    pub arguments: Vec<String>,
    /// The device, open already.
    pub device: Opened,
    /// Opens it again after it was lost.
    pub open: &'a dyn Fn() -> Result<Opened>,
    /// Ctrl-C.
    pub interrupted: Interrupted<'a>,
    /// Who is watching.
    pub watch: &'a mut dyn FnMut(Event),
}

/// How a sweep ended.
#[derive(Debug)]
pub struct Outcome {
    /// Everything that was derived from the journal.
    pub run: Run,
    /// Configurations whose answer was wrong.
    pub disagreeing: usize,
    /// Configurations that could not run.
    pub failed: usize,
}

/// Runs a sweep. Whatever happens, the journal holds every row measured until then, and the files derived from it are
/// written.
///
/// # Errors
/// [`Error::Interrupted`], [`Error::Output`], [`Error::Input`] of a scene, or a lost device that does not come back.
pub fn run(job: Job) -> Result<Outcome> {
    let provenance = Provenance {
        schema: SCHEMA.into(),
        program: environment::program(),
        started: environment::now(),
        arguments: job.arguments,
        device: job.device.backend.info().clone(),
        device_reason: job.device.reason.clone(),
        environment: environment::capture(),
        plan: job.plan.record(),
    };
    job.earlier.check(&provenance)?;
    let mut journal = if job.earlier.provenance().is_some() {
        let Provenance { started, arguments, environment, .. } = provenance;
        JournalWriter::resume(job.out, Resumed { started, arguments, environment }, job.earlier.length())?
    } else {
        JournalWriter::create(job.out, provenance)?
    };
    let exact = job.device.backend.info().is_exact();
    let (plan, out) = (job.plan, job.out);
    let mut sweep = Sweep {
        context: Context { plan, out, exact, interrupted: job.interrupted, watch: job.watch },
        threads: if job.threads > 0 { job.threads } else { plan.build_threads },
        device_name: job.device.backend.info().name.clone(),
        device: Some(job.device),
        open: job.open,
        earlier: job.earlier,
        journal: &mut journal,
    };
    let ended = plan.scenes().into_iter().try_for_each(|what| sweep.scene(what));
    let closed = journal.write(&Record::End(End {
        ended: environment::now(),
        interrupted: matches!(ended, Err(Error::Interrupted)),
        complete: ended.is_ok(),
        load_average: environment::load_average(),
        message: ended.as_ref().err().map(Error::to_string).unwrap_or_default(),
    }));
    // And with it its lock
    drop(journal);
    let derived = derive(out);
    // What went wrong first is what the user has to know.
    ended.and(closed).and(derived)
}

/// Writes the files that are derived from a run's journal.
fn derive(out: &std::path::Path) -> Result<Outcome> {
    let journal = Journal::read(&out.join(journal::FILE_NAME))?;
    let run = Run::new(&journal);
    run.write(out)?;
    let count = |kind| journal.configurations.iter().filter(|c| c.failure == Some(kind)).count();
    Ok(Outcome { run, disagreeing: count(Failure::Verification), failed: count(Failure::Device) })
}

/// A running sweep.
pub(super) struct Sweep<'a, 'j> {
    pub(super) context: Context<'a>,
    threads: usize,
    /// `None` after it was lost, until something needs it again.
    pub(super) device: Option<Opened>,
    device_name: String,
    open: &'a dyn Fn() -> Result<Opened>,
    pub(super) earlier: Earlier,
    pub(super) journal: &'j mut JournalWriter,
}

/// A structure and its rows that are still to be measured.
type Waiting<'p> = (&'p Selection, VecDeque<Place>);

impl Sweep<'_, '_> {
    pub(super) fn say(&mut self, event: Event) {
        (self.context.watch)(event);
    }

    /// Load a scene, build its structures one after another, and measure each.
    fn scene(&mut self, what: &str) -> Result<()> {
        self.context.check_interrupt()?;
        let plan = self.context.plan;
        self.say(Event::Doing(format!("loading {what}")));
        let scene = Arc::new(plan.load(what)?);
        for warning in &scene.warnings {
            self.say(Event::Note(format!("{}: {warning}", scene.name)));
        }
        let mut paths: Vec<(Config, Option<usize>, Path)> = Vec::new();
        for task in plan.selections(what).into_iter().flat_map(|selection| plan.tasks(what, selection)) {
            if !paths.iter().any(|(config, frames, _)| (*config, *frames) == (task.config, task.frames)) {
                paths.push((task.config, task.frames, plan.path(&scene, task.config, task.frames)?));
            }
        }
        let record = plan::scene_record(&scene);
        self.earlier.check_scene(&record, paths.iter().map(|(_, _, path)| path))?;
        // The reference is traced through this tree, and confirmed by brute force (see `verify`).
        let reference_selection = Selection::parse("bvh")?;
        let reference = self.build(&reference_selection, &scene)?;
        let mut subject = Subject {
            scene: &scene,
            record,
            what: what.to_owned(),
            paths,
            verifier: Verifier::new(&scene, &reference.structure)?,
            images: HashMap::new(),
        };
        let mut waiting: Vec<Waiting> =
            plan.selections(what).into_iter().map(|s| (s, self.waiting(&mut subject, s))).collect();
        waiting.retain(|(_, rows)| !rows.is_empty());
        if waiting.is_empty() && pictures::are_there(self.context.out, &subject.record.name) {
            return Ok(());
        }
        while !waiting.is_empty() {
            let trees = self.trees(&subject, &mut waiting, &reference, &reference_selection.build_key())?;
            let members = trees.iter().flat_map(|(own, waiting)| {
                let built = own.as_ref().unwrap_or(&reference);
                waiting.iter().map(move |(selection, rows)| Member::new(selection, built, rows.clone()))
            });
            self.batch(&mut subject, members.collect())?;
        }
        // Last: what is measured matters more where the disk is about to be full
        self.pictures(&subject, &reference)
    }

    /// Build as many distinct trees as are held at a time; each serves all traversals over it. `None` stands for the
    /// reference tree, which is there already.
    fn trees<'p>(
        &mut self,
        subject: &Subject,
        waiting: &mut Vec<Waiting<'p>>,
        reference: &Built,
        reference_key: &str,
    ) -> Result<Vec<(Option<Built>, Vec<Waiting<'p>>)>> {
        let (mut trees, mut bytes) = (Vec::new(), 0);
        while bytes < BATCH_BYTES
            && let Some(&(first, _)) = waiting.first()
        {
            self.context.check_interrupt()?;
            let same: Vec<Waiting> = waiting.extract_if(.., |(s, _)| s.build_key() == first.build_key()).collect();
            let own = if reference_key == first.build_key() {
                None
            } else {
                match self.build(first, subject.scene) {
                    Ok(built) => Some(built),
                    // What cannot be built for this scene is no reason to leave the others unmeasured.
                    Err(Error::Device(message)) => {
                        for (selection, rows) in same {
                            for place in rows {
                                self.unable(subject, selection, None, place, &message)?;
                            }
                        }
                        continue;
                    }
                    Err(other) => return Err(other),
                }
            };
            // On the device once for each traversal, the geometry with it
            let sizes = memory(own.as_ref().unwrap_or(reference), subject.scene, None);
            bytes += (sizes.structure_bytes + sizes.geometry_bytes) * same.len() as u64;
            trees.push((own, same));
        }
        Ok(trees)
    }

    /// Build a structure as often as the plan says; the time is the median.
    fn build(&mut self, selection: &Selection, scene: &Arc<Scene>) -> Result<Built> {
        self.say(Event::Building(format!("building {} of {}", selection.name(), scene.name)));
        let builds = self.context.plan.builds;
        let built = building::build_repeatedly(selection, scene, self.threads, builds, self.context.interrupted)?;
        if !built.note.is_empty() {
            self.say(Event::Note(format!("{} {}: {}", scene.name, selection.name(), built.note)));
        }
        Ok(built)
    }

    /// The rows of a structure on a scene that no earlier session settled. The images of those that one did stay, to
    /// compare others with.
    fn waiting(&mut self, subject: &mut Subject, selection: &Selection) -> VecDeque<Place> {
        let plan = self.context.plan;
        let mut waiting = VecDeque::new();
        for Task { config, size, frames } in plan.tasks(&subject.what, selection) {
            let of_task = |(of, thinned, _): &(Config, Option<usize>, Path)| (*of, *thinned) == (config, frames);
            let Some(path) = subject.paths.iter().position(of_task) else { continue };
            match self.earlier.row(&configuration::blank(plan, subject, selection, path, size)) {
                Some(row) => {
                    if let (Status::Ok, Some(hash)) = (row.status, &row.image_hash) {
                        let key = (config, size, selection.method().rays());
                        subject.images.entry(key).or_insert((row.structure.clone(), hash.clone()));
                    }
                    (self.context.watch)(Event::Kept(plan.work(config, size, &subject.paths[path].2.views)));
                }
                None => waiting.push_back((path, size)),
            }
        }
        waiting
    }

    /// Take a scene's pictures. They are not worth opening a lost device again; one that is lost over them is opened
    /// again for the next scene.
    fn pictures(&mut self, subject: &Subject, tree: &Built) -> Result<()> {
        let Some(device) = self.device.take() else {
            self.say(Event::Note(format!("no pictures of {}: the device was lost", subject.record.name)));
            return Ok(());
        };
        match pictures::take(&mut self.context, subject, device.backend.as_ref(), tree) {
            Err(Error::DeviceLost(message)) => {
                self.say(Event::Note(format!("no pictures of {}: {message}", subject.record.name)));
                Ok(())
            }
            other => {
                self.device = Some(device);
                other
            }
        }
    }

    /// An error row for a configuration that cannot run.
    pub(super) fn unable(
        &mut self,
        subject: &Subject,
        selection: &Selection,
        candidate: Option<&Candidate>,
        (path, size): Place,
        message: &str,
    ) -> Result<()> {
        let mut record = configuration::blank(self.context.plan, subject, selection, path, size);
        if let Some(candidate) = candidate {
            configuration::describe(&mut record, candidate);
        }
        configuration::fail(&mut record, Failure::Device, message.to_owned());
        self.finish(record)
    }

    /// Bring a record to the disk.
    pub(super) fn finish(&mut self, record: ConfigurationRecord) -> Result<()> {
        self.journal.write(&Record::Configuration(Box::new(record.clone())))?;
        self.say(Event::Finished(&record));
        Ok(())
    }

    /// Open the device again after it was lost. It must be the same: a table of two devices would be worthless.
    pub(super) fn reopen(&mut self) -> Result<Opened> {
        self.say(Event::Note("the device was lost and is opened again".into()));
        let device = (self.open)().map_err(|e| Error::DeviceLost(format!("it cannot be opened again: {e}")))?;
        let now = &device.backend.info().name;
        if *now != self.device_name {
            let before = &self.device_name;
            return Err(Error::DeviceLost(format!("{before} did not come back, there is only {now}")));
        }
        Ok(device)
    }
}

/// Sizes: as allocated on the device (geometry, structure) where it was, otherwise as the CPU twins hold it.
pub fn memory(built: &Built, scene: &Scene, allocated: Option<(u64, u64)>) -> Memory {
    let held = || (scene.geometry_bytes(), built.structure.structure_bytes());
    let (geometry_bytes, structure_bytes) = allocated.unwrap_or_else(held);
    Memory { structure_bytes, geometry_bytes, thesis_bytes: built.structure.thesis_bytes(scene) }
}
