//! `rtbench sweep`: the main job.

use super::device::{self, DeviceArguments};
use super::interrupt;
use super::library::LibraryArguments;
use super::output;
use super::progress::Progress;
use crate::error::{Error, Result};
use crate::harness::environment;
use crate::harness::plan::{Plan, Request};
use crate::harness::resume::Earlier;
use crate::harness::sweep::{self, Job};
use crate::record::schema::Status;
use crate::record::table;
use crate::record::{files, journal};
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::Ordering;

/// Measure every structure x ray configuration x resolution on scenes
///
/// Each configuration is verified against a reference, then counted, then timed; its row is on the disk before the next
/// begins. What disagrees becomes an error row with a difference image and is not timed. Without further words it runs
/// the preset `quick`; every flag overrides what the preset says.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// What the flags below begin with: quick, thesis, thesis-lite, or a TOML file like presets/quick.toml
    #[arg(long, default_value = "quick", value_name = "NAME|FILE")]
    preset: String,
    /// Scene file, or name of a scene with options; may be repeated
    #[arg(long, value_name = "FILE|NAME[:KEY=VALUE,..]")]
    scene: Vec<String>,
    #[command(flatten)]
    library: LibraryArguments,
    /// Camera path for every scene and configuration, instead of each one's own
    #[arg(long, value_name = "FILE|NAME")]
    camera_path: Option<String>,
    /// Structures with options, as in `rtbench structures`; comma list, may be repeated
    #[arg(long, value_name = "NAME[:KEY=VALUE,..]")]
    structure: Vec<String>,
    /// Ray configurations: P primary rays, PS with shadow rays, PSR with reflected rays; comma list
    #[arg(long, value_name = "P|PS|PSR")]
    config: Vec<String>,
    /// Image sizes in pixels; comma list
    #[arg(long, value_name = "N|WxH")]
    resolution: Vec<String>,
    /// Thin each camera path evenly to this many frames
    #[arg(long, value_name = "N")]
    frames: Option<usize>,
    /// Timed passes over each path; a frame's time is the median over them
    #[arg(long, value_name = "N")]
    passes: Option<usize>,
    /// Untimed frames before each pass
    #[arg(long, value_name = "FRAMES")]
    warmup: Option<usize>,
    /// Folder for the results, new or empty [default: results/TIME-DEVICE]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Go on with the run in this folder, by the flags it began with: rows that it has are kept
    #[arg(long, value_name = "FOLDER", conflicts_with_all = BEGINNING)]
    resume: Option<PathBuf>,
    /// No progress, no table: only errors
    #[arg(long, short)]
    quiet: bool,
    #[command(flatten)]
    device: DeviceArguments,
}

/// Flags that belong to the beginning of a run: all but those that only say what is printed. (`exclusive` would refuse
/// those as well, without a word about which flag it means.)
const BEGINNING: [&str; 16] = [
    "preset",
    "scene",
    "scenes_dir",
    "scene_time",
    "camera_path",
    "structure",
    "config",
    "resolution",
    "frames",
    "passes",
    "warmup",
    "out",
    "backend",
    "adapter",
    "checked",
    "threads",
];

const EXAMPLES: &str = "\
Examples:
  rtbench sweep
      the preset quick: built-in scenes, all structures, a few minutes
  rtbench sweep --scene bunny.ply --structure grid,kdtree,bvh --config P,PS --resolution 512,1024
      a scene of your own
  rtbench sweep --scene hall --structure grid:x=64,grid:x=128 --config PSR --frames 20
      the same structure with different options
  rtbench sweep --preset thesis --scenes-dir ~/scenes --adapter nvidia
      the thesis's method, on a chosen GPU
  rtbench sweep --backend cpu --out results/twins
      without any GPU or driver

In the folder of results: journal.jsonl (everything, one record per line), summary.csv, structures.csv, run.json.
Ctrl-C ends a sweep in order, also while a structure is built: what was measured is kept, and `rtbench sweep --resume
FOLDER` measures the rest. It goes on only with the same build of the program on the same device, with scenes and camera
paths that have not changed.";

/// Runs the command.
///
/// # Errors
/// What could not run; wrong answers are the exit code 1.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let Some(run) = &arguments.resume else { return measure(arguments, Earlier::default()) };
    let folder = journal::folder_of(run);
    let earlier = Earlier::read(&folder)?;
    if earlier.is_complete() {
        if !arguments.quiet {
            output::note(&format!("nothing is left to measure in {}", folder.display()));
        }
        return Ok(ExitCode::SUCCESS);
    }
    let recorded = earlier.provenance().map(|provenance| &provenance.arguments[..]).unwrap_or_default();
    match super::parse(recorded) {
        Some(super::Command::Sweep(began)) => {
            let quiet = arguments.quiet || began.quiet;
            measure(&Arguments { out: Some(folder), quiet, ..began }, earlier).map_err(from_elsewhere)
        }
        _ => {
            let problem = format!("it began with a command that this program does not know: {}", recorded.join(" "));
            Err(Error::file(&folder.join(journal::FILE_NAME), Some(1), problem, "begin a new run"))
        }
    }
}

/// Of a run that is taken up again: what is not found may be so because names without a folder mean another one here. The
/// journal cannot tell which, for no path of the machine stands in it.
fn from_elsewhere(error: Error) -> Error {
    match error {
        Error::Input(mut input) if is_absent_here(Path::new(&input.place)) => {
            let separator = if input.hint.is_empty() { "" } else { "; " };
            input.hint += &format!("{separator}a run is resumed from the folder in which it was begun");
            Error::Input(input)
        }
        other => other,
    }
}

/// True for what may be a file's name, seen from this folder, without the file.
fn is_absent_here(place: &Path) -> bool {
    place.is_relative() && !place.exists() && !place.to_string_lossy().starts_with("--")
}

/// Measures what is planned and not there yet.
fn measure(arguments: &Arguments, earlier: Earlier) -> Result<ExitCode> {
    let mut plan = Plan::new(&Request {
        preset: arguments.preset.clone(),
        scenes: arguments.scene.clone(),
        camera_path: arguments.camera_path.clone(),
        structures: arguments.structure.clone(),
        configs: arguments.config.clone(),
        resolutions: arguments.resolution.clone(),
        frames: arguments.frames,
        passes: arguments.passes,
        warmup_frames: arguments.warmup,
        scenes_folder: arguments.library.folder(),
    })?;
    plan.parts.iter_mut().for_each(|part| part.scene = arguments.library.at_time(&part.scene));
    for absent in &plan.skipped {
        output::note(&format!("left out: {absent}"));
    }
    arguments.device.check()?;
    if let (Some(out), None) = (&arguments.out, earlier.provenance()) {
        files::create_run_folder(out)?;
    }
    let work: u64 = plan.survey()?.iter().sum();
    let device = arguments.device.open()?;
    plan.check_device(device.backend.info())?;
    if !arguments.quiet {
        device::announce(&device);
    }
    let out = match &arguments.out {
        Some(out) => out.clone(),
        None => default_folder(&device.backend.info().name),
    };

    let mut progress = Progress::new(plan.configurations(), work, arguments.quiet);
    let tell = progress.teller();
    let stop = interrupt::flag(move || tell("stopping after this frame; Ctrl-C again ends at once"))?;
    let interrupted = || stop.load(Ordering::Relaxed);
    if earlier.settled() > 0 && !arguments.quiet {
        output::note(&format!("{} of {} rows are there already", earlier.settled(), plan.configurations()));
    }
    let outcome = sweep::run(Job {
        plan: &plan,
        out: &out,
        earlier,
        threads: arguments.device.threads,
        arguments: std::env::args_os().map(|a| a.to_string_lossy().into_owned()).collect(),
        device,
        open: &|| arguments.device.open(),
        interrupted: &interrupted,
        watch: &mut |event| progress.event(event),
    });
    progress.end();
    let outcome = outcome.inspect_err(|error| tell_where(&out, error))?;

    if !arguments.quiet {
        output::print(&table::run(&outcome.run))?;
        output::print(&format!("results: {}\n", out.display()))?;
    }
    let rows = outcome.run.configurations.len();
    let bad = outcome.disagreeing + outcome.failed;
    let Some(first) = outcome.run.configurations.iter().find(|row| row.status == Status::Error) else {
        return Ok(ExitCode::SUCCESS);
    };
    let what = match (outcome.disagreeing, outcome.failed) {
        (_, 0) => "disagreed with the reference".to_owned(),
        (0, _) => "could not run".to_owned(),
        (wrong, failed) => format!("have no result: {wrong} disagreed with the reference, {failed} could not run"),
    };
    let first = format!("{}: {}", table::label(first), first.message);
    output::complain(&format!("{bad} of {rows} configurations {what}; the first: {first}"));
    Ok(ExitCode::from(if outcome.disagreeing > 0 { 1 } else { 2 }))
}

/// Tells where the rows are that were measured before a sweep broke off.
fn tell_where(out: &Path, error: &Error) {
    if out.join(journal::FILE_NAME).is_file() {
        let out = out.display();
        let rest = match error {
            // Nothing can be resumed until the input is mended, and then perhaps not either.
            Error::Input(_) => String::new(),
            _ => format!("; for the rest: rtbench sweep --resume {out}"),
        };
        output::note(&format!("what was measured is in {out}{rest}"));
    }
}

/// `results/TIME-DEVICE`.
fn default_folder(device: &str) -> PathBuf {
    Path::new("results").join(format!("{}-{}", environment::now_for_file_name(), files::slug(device)))
}
