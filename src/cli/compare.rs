//! `rtbench compare`: what changed between runs.

use super::library::file_name;
use super::runs::write_or_print;
use crate::compare::conditions::{ComparedRun, check_across};
use crate::compare::runs::{self, MARGIN_PCT, Options, Shown, Side};
use crate::error::{Error, Result};
use crate::guard;
use crate::names;
use crate::record::files;
use crate::record::stream::{LeanRun, Names};
use crate::report::format::{self, Format};
use crate::workloads;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Compare recorded runs: what is exact first, then times
///
/// Rows are paired by their axes. Counters, sizes and hashes of pictures are compared exactly, the hashes only within
/// one driver. Rows that were measured on another device, driver, scene, camera path, kernel or with other settings are
/// not compared, unless --across says so. Times of runs that were measured apart say at most `ambiguous` with fewer
/// than three runs on each side: `rtbench ab` measures both sides interleaved.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Sides, the oldest first: each a folder of a run, or a comma list of folders of repeated runs
    #[arg(value_name = "RUN[,RUN..]", num_args = 2.., required = true, value_parser = file_name())]
    sides: Vec<String>,
    /// Conditions that may differ: device, driver, machine, kernel, settings, or a kind of input such as scene or
    /// camera-path
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    across: Vec<String>,
    /// Ratios of times within so many percent are the same
    #[arg(long, value_name = "PERCENT", default_value_t = MARGIN_PCT)]
    margin: f64,
    /// Format of the output
    #[arg(long, value_enum, default_value_t)]
    format: FormatName,
    /// Rows of each table in text, Markdown and HTML; those with the largest differences are shown
    #[arg(long, value_name = "N", default_value_t = 50)]
    rows: usize,
    /// Write to a file instead of standard output
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Also write a page with the tables and a plot of the ratios
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  rtbench compare results/BEFORE results/AFTER
      exact quantities, geometric means and rows of two runs
  rtbench compare results/A1,results/A2,results/A3 results/B1,results/B2,results/B3
      three runs on each side: times get a verdict
  rtbench compare results/BEFORE results/AFTER --across kernel --format markdown
      a change of the kernels, as a comment of a pull request
  rtbench compare results/MAY results/JUNE results/JULY --html times.html
      a table over time, and a page with a plot

Exit codes: 0 compared, whatever the verdicts, 2 nothing could be compared.";

/// A format of a comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum FormatName {
    /// Tables for a terminal
    #[default]
    Text,
    /// Tables in GitHub's Markdown
    Markdown,
    /// Everything, for programs
    Json,
    /// One line per exact quantity that differs and per row
    Csv,
}

/// Runs the command.
///
/// # Errors
/// A run that cannot be read or has not ended, runs that must not be compared, output that cannot be written.
pub fn run(arguments: &Arguments) -> Result<()> {
    if !(arguments.margin >= 0.0 && arguments.margin < 100.0) {
        return Err(Error::argument("--margin", format!("{} is out of range", arguments.margin), "give 0 to 100"));
    }
    let mut interned = Names::default();
    let mut compared: Vec<ComparedRun> = Vec::new();
    let mut sides: Vec<Side> = Vec::new();
    for text in &arguments.sides {
        let mut of_side = Vec::new();
        for path in text.split(',').filter(|path| !path.is_empty()) {
            of_side.push(compared.len());
            compared.push(ComparedRun::new(LeanRun::read(&names::file(path), &mut interned)?));
        }
        if of_side.is_empty() {
            return Err(Error::argument("RUN", format!("'{text}' names no run"), "give a folder, or a comma list"));
        }
        check_repeats(text, &of_side, &compared)?;
        sides.push(Side { name: side_name(text), runs: of_side });
    }
    distinguish(&mut sides);
    for out in arguments.output.iter().chain(&arguments.html) {
        guard::check_output(out)?;
    }
    if arguments.output.is_some() && arguments.output == arguments.html {
        return Err(Error::argument("--html", "it is the file of --output", "give two files"));
    }
    check_across(&arguments.across, &interned, &compared)?;
    let options = options(arguments, &compared);
    let comparison = runs::compare(&mut interned, compared, sides, &options)?;
    let shown = Shown { rows: arguments.rows.max(1) };
    let text = match arguments.format {
        FormatName::Text => format::write(&runs::tables(&comparison, &interned, shown), Format::Text),
        FormatName::Markdown => format::write(&runs::tables(&comparison, &interned, shown), Format::Markdown),
        FormatName::Csv => runs::csv(&comparison, &interned),
        FormatName::Json => format!("{:#}\n", runs::json(&comparison, &interned)),
    };
    if let Some(path) = &arguments.html {
        files::replace(path, runs::page(&comparison, &interned, shown)?.as_bytes())?;
    }
    write_or_print(&text, arguments.output.as_deref())
}

/// Refuses a run, or a copy of it, that is on one side twice: it is no repetition.
fn check_repeats(side: &str, of_side: &[usize], compared: &[ComparedRun]) -> Result<()> {
    let mut ids = std::collections::BTreeSet::new();
    match of_side.iter().find(|&&run| !ids.insert(&compared[run].run.provenance.id)) {
        None => Ok(()),
        Some(&run) => {
            let folder = compared[run].run.folder.display();
            let problem = format!("{folder} is one of the other runs of '{side}', or a copy of it");
            Err(Error::argument("RUN", problem, "give runs that were measured one after another"))
        }
    }
}

/// The name of a side in tables: the folder's, with the number of further runs.
fn side_name(text: &str) -> String {
    let mut paths = text.split(',').filter(|path| !path.is_empty());
    let first = names::file(paths.next().unwrap_or(text));
    let folder = crate::record::journal::folder_of(&first);
    let name = folder.file_name().map_or_else(|| folder.display().to_string(), |n| n.to_string_lossy().into_owned());
    match paths.count() {
        0 => name,
        others => format!("{name} and {others} more"),
    }
}

/// Sides of equal names get numbers.
fn distinguish(sides: &mut [Side]) {
    let names: Vec<String> = sides.iter().map(|side| side.name.clone()).collect();
    for (index, side) in sides.iter_mut().enumerate() {
        if names.iter().filter(|name| **name == side.name).count() > 1 {
            side.name += &format!(" ({})", index + 1);
        }
    }
}

/// What the workload of the runs says about comparing them; a workload that this program does not know says nothing.
fn options(arguments: &Arguments, compared: &[ComparedRun]) -> Options {
    let workload = compared.first().and_then(|run| workloads::find(&run.run.provenance.workload));
    let axes = workload.map_or(&[][..], |workload| workload.info().axes);
    Options {
        across: arguments.across.clone(),
        margin_pct: arguments.margin,
        axes: axes.iter().filter(|axis| axis.in_label).map(|axis| axis.name.to_owned()).collect(),
        machine: workload
            .map_or(&[][..], |workload| workload.machine_metrics())
            .iter()
            .map(|m| m.to_string())
            .collect(),
    }
}
