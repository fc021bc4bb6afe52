//! The subcommands of workloads and their flags, generated from the workloads' descriptions.

use crate::cli::device::DeviceArguments;
use crate::cli::library::{LibraryArguments, file_name};
use crate::error::{Error, Result};
use crate::harness::workload::Info;
use crate::record::run::Shard;
use crate::workloads;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command};
use std::path::PathBuf;

/// Flags that all workloads have.
#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct CommonArguments {
    /// What the other flags begin with: the name of a preset, or a TOML file like those in presets/
    #[arg(long, value_name = "NAME|FILE", value_parser = file_name())]
    pub(in crate::cli) preset: Option<String>,
    #[command(flatten)]
    pub(in crate::cli) library: LibraryArguments,
    /// Thin each case evenly to this many frames
    #[arg(long, value_name = "N")]
    pub(in crate::cli) frames: Option<usize>,
    /// Timed passes over all frames; a frame's time is the median over them
    #[arg(long, value_name = "N")]
    pub(in crate::cli) passes: Option<usize>,
    /// Untimed frames before each pass
    #[arg(long, value_name = "FRAMES")]
    pub(in crate::cli) warmup: Option<usize>,
    /// Skip cases of more work than this
    #[arg(long, value_name = "N", hide = true)]
    pub(in crate::cli) budget: Option<u64>,
    /// Folder for the results, new or empty [default: results/TIME-DEVICE]
    #[arg(long, value_name = "FOLDER")]
    pub(in crate::cli) out: Option<PathBuf>,
    /// Resume the run in this folder, by the flags it began with: rows that it has are kept
    #[arg(long, value_name = "FOLDER")]
    pub(in crate::cli) resume: Option<PathBuf>,
    /// Measure only part I of N of the plan; `rtbench merge` joins the parts
    #[arg(long, value_name = "I/N")]
    pub(in crate::cli) shard: Option<Shard>,
    /// Exit with code 2 if a case was skipped
    #[arg(long)]
    pub(in crate::cli) strict: bool,
    /// No progress, no table: only errors
    #[arg(long, short)]
    pub(in crate::cli) quiet: bool,
    #[command(flatten)]
    pub(in crate::cli) device: DeviceArguments,
}

/// Flags that a resumed run may have besides `--resume`; all others belong to the beginning of a run.
const ALSO_RESUMED: [&str; 3] = ["resume", "strict", "quiet"];

/// Flags of `rtbench plan WORKLOAD` besides the axes.
const PLANNED: [&str; 7] = ["shard", "preset", "scenes_dir", "scene_time", "frames", "passes", "warmup"];

/// The subcommands of all workloads.
pub fn commands() -> Vec<Command> {
    workloads::ALL.iter().map(|workload| command(workload.info())).collect()
}

/// The subcommand of a workload.
fn command(info: &'static Info) -> Command {
    let mut command = CommonArguments::augment_args(with_axes(Command::new(info.name), info))
        .about(info.summary)
        .long_about(format!("{}\n\n{}", info.summary, info.description))
        .after_help(info.examples);
    // A resumed run has the flags that it began with
    let others: Vec<_> = command.get_arguments().map(|argument| argument.get_id().clone()).collect();
    for id in others.iter().filter(|id| !ALSO_RESUMED.contains(&id.as_str())) {
        let id = id.clone();
        command = command.mut_arg("resume", |resume| resume.conflicts_with(id));
    }
    let presets: Vec<&str> = info.presets.iter().map(|(name, _)| *name).collect();
    let help = format!(
        "What the other flags begin with: {}, or a TOML file like presets/{}/{}.toml [default: {}]",
        presets.join(", "),
        info.name,
        presets.first().unwrap_or(&""),
        presets.first().unwrap_or(&"")
    );
    let command = with_optional(command, info);
    command.mut_arg("preset", |preset| preset.help(help))
}

/// Flags of the library of scenes.
const OF_LIBRARY: [&str; 2] = ["scenes_dir", "scene_time"];

/// Shows the flags that not every workload has where this one has them; the others refuse them.
fn with_optional(mut command: Command, info: &'static Info) -> Command {
    if let Some(budget) = info.budget {
        let help = format!("Skip cases of more {} per pass than this [default: {budget}]", info.work_unit);
        command = command.mut_arg("budget", |argument| argument.help(help).hide(false));
    }
    for id in OF_LIBRARY.into_iter().filter(|_| !info.has_library) {
        command = command.mut_arg(id, |argument| argument.hide(true));
    }
    command
}

/// Refuses flags that this workload does not have.
pub(super) fn check_optional(matches: &ArgMatches, info: &'static Info) -> Result<()> {
    let of_library = OF_LIBRARY.into_iter().filter(|_| !info.has_library);
    for id in of_library.chain(info.budget.is_none().then_some("budget")) {
        if matches.value_source(id) == Some(ValueSource::CommandLine) {
            let flag = format!("--{}", id.replace('_', "-"));
            return Err(Error::argument(flag, format!("it has no meaning for {}", info.name), "leave it out"));
        }
    }
    Ok(())
}

/// Adds one flag per axis.
fn with_axes(mut command: Command, info: &'static Info) -> Command {
    for axis in info.axes.iter().filter(|axis| axis.is_flag) {
        let flag = axis.name.replace('_', "-");
        command = command.arg(
            Arg::new(axis.name)
                .long(flag)
                .value_name(axis.value_name)
                .help(axis.help)
                .value_parser(file_name())
                .action(ArgAction::Append),
        );
    }
    command
}

/// `rtbench plan`, with a subcommand per workload.
pub fn plan_command() -> Command {
    let mut plan = Command::new("plan")
        .about("List the cases that a workload would measure")
        .long_about(
            "List the cases that a workload would measure\n\nNeeds no device. Of scenes only names and camera files are \
             read, so that a broken scene file shows when it is measured.",
        )
        .subcommand_required(true)
        .arg_required_else_help(true);
    for workload in workloads::ALL {
        let info = workload.info();
        let mut command = CommonArguments::augment_args(with_axes(Command::new(info.name), info)).about(info.summary);
        let ids: Vec<_> = command.get_arguments().map(|argument| argument.get_id().clone()).collect();
        let hidden = |id: &str| !PLANNED.contains(&id) && !info.axes.iter().any(|axis| axis.name == id);
        for id in ids.into_iter().filter(|id| hidden(id.as_str())) {
            command = command.mut_arg(id, |argument| argument.hide(true));
        }
        command = with_optional(command, info);
        let like = Arg::new("like").long("like").value_name("RUN").value_parser(clap::value_parser!(PathBuf));
        plan = plan.subcommand(command.arg(like.help("A recorded run, whose speed gives an estimate of the time")));
    }
    plan
}
