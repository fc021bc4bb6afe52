//! `rtbench ab`: two configurations or two builds, measured interleaved.

mod builds;
mod configurations;

use super::library::file_name;
use super::{output, runs::write_or_print};
use crate::compare::rounds::{self, CellTimes, LEAST_ROUNDS, MARGIN_PCT};
use crate::error::{Error, Result};
use crate::guard;
use crate::harness::environment;
use crate::record::files;
use crate::report::format::{self, Format};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Measure two configurations, or two builds of rtbench, interleaved in rounds
///
/// A and B are values of axes, AXIS=VALUE or AXIS=VALUE;AXIS=VALUE; all other axes are flags of the workload after --,
/// and every combination of them is a case. With --exe, whole processes of two builds are measured instead. Each round
/// measures A, B and A again, in an order that reverses from round to round; its times are in OUT/rounds.jsonl as soon
/// as it has ended. What A differs from itself is the false-alarm band: nothing within it is called faster or slower.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// The first side: values of axes
    #[arg(value_name = "A", value_parser = file_name(), required_unless_present = "exe", conflicts_with = "exe", requires = "b")]
    a: Option<String>,
    /// The second side: values of axes
    #[arg(value_name = "B", value_parser = file_name())]
    b: Option<String>,
    /// Program of the first side, then of the second one
    #[arg(long, value_name = "FILE", num_args = 1)]
    exe: Vec<PathBuf>,
    /// What is measured: a subcommand of rtbench
    #[arg(long, value_name = "NAME", default_value = "sweep")]
    workload: String,
    /// Rounds, at least 10 [default: 10, or as many as intervals for all cases together need]
    #[arg(long, value_name = "N")]
    rounds: Option<usize>,
    /// Ratios within so many percent are the same
    #[arg(long, value_name = "PERCENT", default_value_t = MARGIN_PCT)]
    margin: f64,
    /// Folder for the times of all rounds, new or empty [default: results/TIME-ab]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Format of the output
    #[arg(long, value_enum, default_value_t)]
    format: FormatName,
    /// Write to a file instead of standard output
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Flags of the workload, such as -- --scene hall --config P,PS --resolution 256
    #[arg(last = true, value_name = "FLAGS", value_parser = file_name())]
    flags: Vec<String>,
}

const EXAMPLES: &str = "\
Examples:
  rtbench ab structure=bvh structure=bvh-stack -- --scene hall --config P,PSR --resolution 256
      two structures, case by case
  rtbench ab \"structure=kdtree:search=short-stack\" \"structure=kdtree:search=ropes\" --rounds 30 -- --scene scan
      two options of one structure
  rtbench ab --exe old/rtbench --exe target/release/rtbench -- --scene hall --structure bvh --passes 3
      two builds, whole processes per round

Exit codes: 0 measured, whatever the verdicts, 2 something could not run; what was measured until then is kept.";

/// A format of the result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum FormatName {
    /// A table for a terminal
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
/// Sides that cannot be, a side that breaks (its round is named), output that cannot be written.
pub fn run(arguments: &Arguments) -> Result<()> {
    if let Some(rounds) = arguments.rounds.filter(|rounds| !(LEAST_ROUNDS..=100_000).contains(rounds)) {
        let problem = format!("{rounds} is out of range");
        return Err(Error::argument("--rounds", problem, format!("give {LEAST_ROUNDS} to 100000")));
    }
    if !(arguments.margin >= 0.0 && arguments.margin < 100.0) {
        return Err(Error::argument("--margin", format!("{} is out of range", arguments.margin), "give 0 to 100"));
    }
    arguments.exe.iter().for_each(|program| guard::read(program));
    arguments.output.as_deref().map_or(Ok(()), guard::check_output)?;
    let (sides, cells) = match (&arguments.a, &arguments.b) {
        (Some(a), Some(b)) => ([a.clone(), b.clone()], configurations::measure(arguments, a, b)?),
        _ => {
            let [a, b] = builds::programs(&arguments.exe)?;
            ([a.display().to_string(), b.display().to_string()], builds::measure(arguments, [a, b])?)
        }
    };
    let (out, cells) = cells;
    let Some(judgement) = rounds::judge(&cells, arguments.margin) else {
        return Err(Error::argument("ab", "no case has times on both sides", "see the folder's journals"));
    };
    let sides = [sides[0].as_str(), sides[1].as_str()];
    let json = format!("{:#}\n", rounds::json(&judgement, sides));
    files::replace(&out.join("ab.json"), json.as_bytes())?;
    let table = rounds::table(&judgement, sides);
    let text = match arguments.format {
        FormatName::Text => format::write(&[table], Format::Text),
        FormatName::Markdown => format::write(&[table], Format::Markdown),
        FormatName::Json => json,
    };
    write_or_print(&text, arguments.output.as_deref())?;
    output::note(&format!("rounds: {}", out.display()));
    Ok(())
}

/// What was measured: the folder, and the times of each case.
type Measured = (PathBuf, Vec<CellTimes>);

/// `rounds.jsonl`: a line that says what is compared, and a line per case and round.
struct Recorder {
    path: PathBuf,
    file: File,
}

impl Recorder {
    /// Creates the folder and the file.
    fn create(arguments: &Arguments, sides: [&str; 2], device: Value) -> Result<(PathBuf, Recorder)> {
        let name = || Path::new("results").join(format!("{}-ab", environment::now_for_file_name()));
        let out = arguments.out.clone().unwrap_or_else(name);
        files::create_run_folder(&out)?;
        let path = out.join("rounds.jsonl");
        let file = File::create_new(&path).map_err(|source| Error::output(&path, source))?;
        guard::read(&path);
        let mut recorder = Recorder { path, file };
        recorder.write(&json!({
            "record": "ab", "schema": "rtbench-ab/1", "workload": arguments.workload, "a": sides[0], "b": sides[1],
            "flags": arguments.flags, "started": environment::now(), "device": device,
        }))?;
        Ok((out, recorder))
    }

    /// Adds a line and brings it to the disk.
    fn write(&mut self, line: &Value) -> Result<()> {
        let written = writeln!(self.file, "{line}").and_then(|()| self.file.sync_data());
        written.map_err(|source| Error::output(&self.path, source))
    }

    /// Adds the times of a case in a round, which counts from 1.
    fn round(&mut self, case: &str, round: usize, ms: [f64; 3]) -> Result<()> {
        self.write(
            &json!({"record": "round", "case": case, "round": round, "a_ms": ms[0], "b_ms": ms[1], "null_ms": ms[2]}),
        )
    }
}

/// Tells where the rounds are that were measured before something broke.
fn kept<T>(out: &Path, result: Result<T>) -> Result<T> {
    if result.is_err() {
        output::note(&format!("what was measured is in {}", out.display()));
    }
    result
}
