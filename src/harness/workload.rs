//! What a workload is to the harness. A workload says what can vary, what its inputs are, and how one case is prepared,
//! verified, counted and run; the harness alone owns the order, the clock, and what is recorded.

use crate::device::{Device, FrameTime, KernelInfo, Source};
use crate::error::Result;
use crate::record::journal::Journal;
use crate::record::row::{Artifact, Check, Input as InputRecord, Key, Metric, Row, Settings};
use crate::record::statistics::FrameStatistics;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A workload: a folder below `workloads/`, and a line in `workloads::ALL`.
pub trait Workload: Sync {
    /// Its description, from which the command line and the columns of its tables follow.
    fn info(&self) -> &'static Info;

    /// The cases of one part of a plan, every combination of its values. It reads headers and camera files only, and
    /// needs no device.
    ///
    /// # Errors
    /// [`crate::Error::Input`] for the first value that cannot be.
    fn plan(&self, part: &Part, library: &Library) -> Result<Vec<Case>>;

    /// Why a value of the first axis is not on this machine and where to get it; `None` if it is, or cannot be known
    /// yet.
    fn absent(&self, _value: &str, _library: &Library) -> Option<String> {
        None
    }

    /// What cases demand of a machine, one line each, as far as it is known without a device and without reading
    /// inputs.
    fn needs(&self, _cases: &[Case], _library: &Library) -> Vec<String> {
        Vec::new()
    }

    /// The devices that [`Case::device`] refers to.
    fn devices(&self) -> Devices {
        Devices::Chosen
    }

    /// Opens what some cases share: their [`Case::input`] is the same.
    ///
    /// # Errors
    /// [`crate::Error::Input`] of a file.
    fn open<'a>(&'a self, cases: &[Case], context: &'a Context<'a>) -> Result<Box<dyn Input + 'a>>;

    /// The kernels that its registered algorithms run on a GPU when no option is given, each with a name that no other
    /// one of the workload has: their static cost is compared from version to version. Empty for a workload without
    /// kernels.
    ///
    /// # Errors
    /// [`crate::Error::Device`] with file and line for a kernel that cannot be assembled (a mistake in `kernels/`).
    fn kernels(&self) -> Result<Vec<(String, Source)>> {
        Ok(Vec::new())
    }

    /// Values that follow from a row's metrics and its frame times, for the columns of `summary.csv`.
    fn derived(&self, _row: &Row, _frames: Option<&FrameStatistics>) -> Vec<Metric> {
        Vec::new()
    }

    /// Further files that are derived from a run's journal: name and content.
    ///
    /// # Errors
    /// None in practice.
    fn files(&self, _journal: &Journal) -> Result<Vec<(String, Vec<u8>)>> {
        Ok(Vec::new())
    }

    /// Names of whole numbers among the metrics, of whole rows or of their parts, that depend on the machine: they are
    /// not compared as exact quantities.
    fn machine_metrics(&self) -> &'static [&'static str] {
        &[]
    }

    /// Text about a run's artifacts, above the table of its rows.
    fn artifacts_table(&self, _journal: &Journal) -> String {
        String::new()
    }
}

/// What cases share, opened: a scene, its reference answers, and what was built of it.
pub trait Input {
    /// For the journal.
    fn records(&self) -> Vec<InputRecord>;

    /// What is unusual about it, for the user.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }

    /// The key of a case's row.
    fn key(&self, case: &Case) -> Key;

    /// Takes note of a row of an earlier session, which the rows of this one are compared with.
    fn remember(&self, _case: &Case, _row: &Row) {}

    /// Builds what the cases of a [`Case::group`] need, unless it is there; `case` is one of them, and `device` is the
    /// one that it runs on, which may build. Returns how many bytes of main memory it takes.
    ///
    /// # Errors
    /// [`crate::Error::Refused`] where it cannot be built for this input, [`crate::Error::Interrupted`], and the
    /// device's.
    fn build(&mut self, case: &Case, device: &Device) -> Result<u64>;

    /// Brings what was built to a device and makes ready to run every case of its group.
    ///
    /// # Errors
    /// [`crate::Error::Refused`], [`crate::Error::Device`], [`crate::Error::DeviceLost`].
    fn prepare<'a>(&'a self, device: &'a Device, case: &Case) -> Result<Box<dyn Run + 'a>>;

    /// What was built for a case, if anything was: without the sizes on a device where it is not on one.
    fn artifact(&self, _case: &Case) -> Option<Artifact> {
        None
    }

    /// Frees what was built.
    fn release(&mut self) {}

    /// Writes pictures of the input into the run's folder, after its cases were measured.
    ///
    /// # Errors
    /// [`crate::Error::Output`], or a lost device.
    fn pictures(&self, _device: &Device) -> Result<()> {
        Ok(())
    }

    /// True if the pictures are there, from an earlier session.
    fn has_pictures(&self) -> bool {
        true
    }
}

/// A group of cases on a device, ready to run. The harness decides what runs when.
pub trait Run {
    /// What was built, with its sizes on the device.
    fn artifact(&self) -> Option<Artifact> {
        None
    }

    /// Kernels that a case times.
    ///
    /// # Errors
    /// The device's.
    fn kernels(&self, _case: &Case) -> Result<Vec<KernelInfo>> {
        Ok(Vec::new())
    }

    /// Labels of the stages of a case's frames, in the order of [`FrameTime::stages`]; none or one where a frame is one
    /// stage.
    fn stages(&self, _case: &Case) -> Vec<String> {
        Vec::new()
    }

    /// Compares a case's answers with the reference.
    ///
    /// # Errors
    /// A refusal, the device's, [`crate::Error::Interrupted`]. A wrong answer is no error but a verdict.
    fn verify(&mut self, case: &Case) -> Result<Verdict>;

    /// Counts what a case's work consists of; apart from timing, since counting costs time.
    ///
    /// # Errors
    /// As [`Run::verify`].
    fn count(&mut self, _case: &Case) -> Result<Verdict> {
        Ok(Verdict::default())
    }

    /// Runs a case's frames once, or with `warm_up` so many of them, beginning anew after the last one. Nothing is read
    /// back in between.
    ///
    /// # Errors
    /// As [`Run::verify`].
    fn pass(&mut self, case: &Case, warm_up: Option<usize>) -> Result<Vec<FrameTime>>;

    /// Compares what the last pass wrote with what was verified: what is timed may be compiled or dispatched
    /// differently.
    ///
    /// # Errors
    /// As [`Run::verify`].
    fn recheck(&mut self, _case: &Case) -> Result<Verdict> {
        Ok(Verdict::default())
    }
}

/// The outcome of a comparison.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// What disagrees: one line; `None` where everything agrees within the stated limits.
    pub problem: Option<String>,
    /// The comparisons.
    pub checks: Vec<Check>,
    /// Content hashes of what was computed.
    pub outputs: BTreeMap<String, String>,
    /// Path of a picture of what differs, inside the run's folder.
    pub difference: Option<String>,
    /// What was counted.
    pub metrics: Vec<Metric>,
    /// What a reader should know all the same.
    pub warnings: Vec<String>,
}

/// The devices of a workload's runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Devices {
    /// One, which the user chooses: the CPU or a Vulkan device.
    Chosen,
    /// The CPU, which has index 0, and the Vulkan device that the user chooses, which has index 1. Where there is none,
    /// its cases get the CPU, for which [`Input::prepare`] refuses them.
    CpuAndVulkan,
}

/// A workload's description.
#[derive(Debug)]
pub struct Info {
    /// Name, which is also the subcommand.
    pub name: &'static str,
    /// One line.
    pub summary: &'static str,
    /// More about it, for `--help`.
    pub description: &'static str,
    /// Examples and what the results are, for `--help`.
    pub examples: &'static str,
    /// Unit of [`Case::work`], in the plural.
    pub work_unit: &'static str,
    /// What can vary. The first axis is what a preset's parts are about.
    pub axes: &'static [Axis],
    /// Most [`Case::work`] of a case unless the user gives another limit; a case of more becomes a row `skipped`.
    /// Absent where there is no such limit, nor a flag for it.
    pub budget: Option<u64>,
    /// True if its inputs may be found by a [`Library`]; otherwise there are no flags for it.
    pub has_library: bool,
    /// Columns of `summary.csv` between the axes and the times: names of metrics, derived ones included.
    pub columns: &'static [&'static str],
    /// Columns of the terminal's table: name of the column of `summary.csv`, and its heading.
    pub table: &'static [(&'static str, &'static str)],
    /// Columns of the terminal's table that a blank line separates where they change.
    pub table_groups: &'static [&'static str],
    /// Lines below the terminal's table.
    pub table_note: &'static str,
    /// Presets that the program brings: name and content. The first one is the default.
    pub presets: &'static [(&'static str, &'static str)],
}

/// Something that can vary from case to case.
#[derive(Debug)]
pub struct Axis {
    /// Name: of the flag (with `-` for `_`), of the preset's key and of the column.
    pub name: &'static str,
    /// Placeholder of a value in help.
    pub value_name: &'static str,
    /// One line for help.
    pub help: &'static str,
    /// True if it can be set by a flag or a preset; false for axes that follow from another one's options.
    pub is_flag: bool,
    /// True if it is a part of a row's name in messages.
    pub in_label: bool,
}

/// One part of a plan: lists of values by axis, as typed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// Values by axis; an axis without any takes its default.
    pub values: BTreeMap<String, Vec<String>>,
    /// Frames that each case is thinned to; all where absent.
    pub frames: Option<usize>,
    /// Axes whose values the user gave, and not the preset: a value without effect is a mistake there.
    pub given: BTreeSet<String>,
}

impl Part {
    /// The values of an axis; empty for its default.
    pub fn of(&self, axis: &str) -> &[String] {
        self.values.get(axis).map_or(&[], Vec::as_slice)
    }
}

/// Where inputs are found.
#[derive(Clone, Debug, Default)]
pub struct Library {
    /// Folder with the files of the catalogue's scenes.
    pub scenes_folder: Option<PathBuf>,
    /// Moment at which moving geometry is frozen, where a file has any.
    pub scene_time: Option<f64>,
}

/// One row of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Value of each axis, by its name.
    pub axes: BTreeMap<String, String>,
    /// Cases with equal inputs are measured one after another.
    pub input: String,
    /// Cases of equal groups are prepared together: they share what is built and uploaded.
    pub group: String,
    /// Cases with equal turns are timed in interleaved passes.
    pub turn: String,
    /// Index of the device that it runs on.
    pub device: usize,
    /// About how much work its passes and its counting are, in units that are the same for all cases of a workload.
    pub work: u64,
}

impl Case {
    /// Value of an axis; empty where it has no such axis.
    pub fn axis(&self, name: &str) -> &str {
        self.axes.get(name).map_or("", String::as_str)
    }
}

/// What a run reports while it is in progress.
pub enum Event<'a> {
    /// Something is being done that takes a moment.
    Doing(String),
    /// Something is being built.
    Building(String),
    /// This much of the planned work is done.
    Work(u64),
    /// A case has its row.
    Finished(&'a Row),
    /// A row of an earlier session is kept; so much work need not be done.
    Kept(u64),
    /// Something that the user should read.
    Note(String),
}

/// What is the same for all of a run.
pub struct Context<'a> {
    /// How cases are measured.
    pub settings: Settings,
    /// The run's folder.
    pub out: &'a Path,
    /// Where inputs are found.
    pub library: Library,
    /// Asked between frames; true ends the work with [`crate::Error::Interrupted`].
    pub interrupted: &'a dyn Fn() -> bool,
    /// Receives events.
    pub watch: &'a dyn Fn(Event),
}

impl Context<'_> {
    /// Sends an event.
    pub fn emit(&self, event: Event) {
        (self.watch)(event);
    }

    /// Ends the run after Ctrl-C.
    ///
    /// # Errors
    /// [`crate::Error::Interrupted`].
    pub fn check_interrupt(&self) -> Result<()> {
        if (self.interrupted)() { Err(crate::Error::Interrupted) } else { Ok(()) }
    }
}
