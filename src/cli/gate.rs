//! `rtbench gate`: a run against a committed baseline.

use super::library::file_name;
use super::{baselines, flags, output};
use crate::compare::baseline::Baseline;
use crate::compare::gate::{self, Judgement};
use crate::error::{Error, Result};
use crate::guard;
use crate::record::stream::Names;
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Compare a run with a baseline: exact quantities must be equal, or within a budget that the baseline has
///
/// Counts of rows, sizes of what was built and the static costs of kernels are compared across devices and drivers;
/// hashes of pictures only with the driver that the baseline's are of. Times are judged only where the baseline has a
/// budget for frame_ms, and not where the noise of both sides explains the difference.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Folder of a recorded run
    #[arg(value_name = "RUN", required_unless_present = "preset", conflicts_with = "preset")]
    run: Option<PathBuf>,
    /// Measure this preset first, with the workload of the baseline; flags of the workload follow after --
    #[arg(long = "run", value_name = "PRESET|FILE", value_parser = file_name())]
    preset: Option<String>,
    /// The baseline, as `rtbench bless` writes it
    #[arg(long, value_name = "FILE")]
    baseline: PathBuf,
    /// With --run: folder for the results, new or empty [default: a temporary folder, deleted when the gate is green]
    #[arg(long, value_name = "FOLDER", requires = "preset")]
    out: Option<PathBuf>,
    /// Format of the output
    #[arg(long, value_enum, default_value_t)]
    format: FormatName,
    /// Write to a file instead of standard output
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Ambiguous times are exit code 1; hashes and times that could not be compared, and rows of the baseline that are
    /// not in the plan, are exit code 2
    #[arg(long)]
    strict: bool,
    /// With --run: flags of the workload, such as -- --backend cpu
    #[arg(last = true, value_name = "FLAGS", requires = "preset", value_parser = file_name())]
    flags: Vec<String>,
}

const EXAMPLES: &str = "\
Examples:
  rtbench gate results/RUN --baseline results/baselines/sweep-quick.json
  rtbench gate --run quick --baseline results/baselines/sweep-quick.json -- --backend cpu
  rtbench gate results/RUN --baseline base.json --format markdown -o summary.md

Exit codes: 0 green, 1 something differs, a row vanished or failed, 2 the gate could not judge.";

/// A format of a judgement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum FormatName {
    /// One line per difference
    #[default]
    Text,
    /// A table in GitHub's Markdown
    Markdown,
    /// Everything, for programs
    Json,
}

/// Runs the command.
///
/// # Errors
/// A baseline or run that cannot be read, a run that must not be compared with it, too few rows to compare.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    if arguments.run.is_some() && !(arguments.flags.is_empty() && arguments.out.is_none()) {
        let problem = "a run that is there already is judged as it is";
        return Err(Error::argument("--", problem, "leave out --out and the flags, or measure with --run PRESET"));
    }
    guard::read(&arguments.baseline);
    arguments.output.as_deref().map_or(Ok(()), guard::check_output)?;
    let baseline = Baseline::read(&arguments.baseline)?;
    match (&arguments.run, &arguments.preset) {
        (Some(run), _) => judged(arguments, &baseline, run),
        (None, preset) => {
            let temporary;
            let out = match &arguments.out {
                Some(out) => out,
                None => {
                    temporary = std::env::temp_dir().join(format!("rtbench-gate-{}", std::process::id()));
                    &temporary
                }
            };
            let preset = preset.clone().unwrap_or_default();
            let given = ["--quiet", "--preset", &preset, "--out"].map(str::to_owned).into_iter();
            let flags: Vec<String> =
                given.chain([out.display().to_string()]).chain(arguments.flags.iter().cloned()).collect();
            // Wrong and failed rows are recorded, and make the gate red below
            flags::measure(&baseline.workload, &flags)?;
            let mut names = Names::default();
            let devices = baselines::read(out, &mut names)?.devices;
            let devices: Vec<&str> = devices.iter().map(|device| device.device.as_str()).collect();
            output::note(&format!("measured on {}", devices.join(", ")));
            let code = judged(arguments, &baseline, out)?;
            if arguments.out.is_none() && code == ExitCode::SUCCESS {
                let _ = std::fs::remove_dir_all(out);
            }
            Ok(code)
        }
    }
}

fn judged(arguments: &Arguments, baseline: &Baseline, run: &Path) -> Result<ExitCode> {
    let mut names = Names::default();
    let run = baselines::read(run, &mut names)?;
    let machine = baselines::machine(&run);
    let costs = baselines::kernel_costs(&run)?;
    let judgement = gate::judge(&names, &run, &costs, &machine, baseline, &arguments.baseline)?;
    let text = match arguments.format {
        FormatName::Text => gate::text(&judgement),
        FormatName::Markdown => gate::markdown(&judgement),
        FormatName::Json => format!("{:#}\n", gate::json(&judgement)),
    };
    super::runs::write_or_print(&text, arguments.output.as_deref())?;
    conclude(arguments, &judgement, &run.run.folder)
}

fn conclude(arguments: &Arguments, judgement: &Judgement, folder: &Path) -> Result<ExitCode> {
    let bless = format!("rtbench bless {} --baseline {}", folder.display(), arguments.baseline.display());
    if !judgement.is_green() {
        if judgement.can_be_blessed {
            output::note(&format!("if the differences are intended: {bless}"));
        }
        return Ok(ExitCode::from(1));
    }
    if arguments.strict && judgement.times_left_out > 0 {
        let problem = format!("{} times have a budget and were not judged", judgement.times_left_out);
        return Err(Error::file(&arguments.baseline, None, problem, bless));
    }
    if arguments.strict && judgement.rows_outside > 0 {
        let problem = format!("{} rows of the baseline are not in the plan of this run", judgement.rows_outside);
        return Err(Error::file(&arguments.baseline, None, problem, bless));
    }
    if arguments.strict && judgement.hashes_left_out > 0 {
        let problem = format!("{} hashes are of another driver and were not compared", judgement.hashes_left_out);
        return Err(Error::file(&arguments.baseline, None, problem, bless));
    }
    if arguments.strict && !judgement.ambiguous.is_empty() {
        output::complain(&format!("--strict: {} times are ambiguous", judgement.ambiguous.len()));
        return Ok(ExitCode::from(1));
    }
    Ok(ExitCode::SUCCESS)
}
