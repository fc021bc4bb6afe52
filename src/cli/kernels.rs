//! `rtbench kernels`: the static cost of every kernel.

use super::runs::write_or_print;
use crate::device::vulkan::EVENT_MARKS;
use crate::error::{Error, Result};
use crate::record::row::Value;
use crate::record::terminal;
use crate::workloads;
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

/// Count the instructions of every kernel, without a device
///
/// Lists the kernels of all workloads as a GPU runs them without options: instructions by class after naga, bytes of
/// work-group and private memory, and bindings. Each instruction counts once as it is in the text, so that the numbers
/// tell what changed in a kernel; they are no estimate of its time. METHODOLOGY.md has the rules.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Parts of names, in any case: only kernels whose name has one of them
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// Instructions by the events of a traversal that they are for, as warps issue them, instead of by class
    #[arg(long)]
    events: bool,
    /// Format of the table
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    /// Write to a file instead of standard output
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// A format of the table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Aligned, for a terminal; columns of zeros are left out
    #[default]
    Text,
    /// GitHub's pipes
    Markdown,
    /// One line per kernel, all quantities
    Csv,
    /// A list with an object per kernel, all quantities
    Json,
}

const EXAMPLES: &str = "\
Examples:
  rtbench kernels
      all kernels
  rtbench kernels bvh-stack kdtree
      those of two structures
  rtbench kernels --events bvh-stack
      what a step, a leaf, a test cost, for `rtbench simt`
  rtbench kernels --format csv -o kernels.csv
      for other programs";

/// A kernel of the table: its values by column.
type Line = Vec<(&'static str, Value)>;

/// Runs the command.
///
/// # Errors
/// [`Error::Input`] for a name that no kernel has, output that cannot be written.
pub fn run(arguments: &Arguments) -> Result<()> {
    let kernels = workloads::kernels()?;
    let has = |label: &str, name: &str| label.to_lowercase().contains(&name.to_lowercase());
    for name in &arguments.names {
        if !kernels.keys().any(|label| has(label, name)) {
            let problem = format!("no kernel has {name:?} in its name");
            return Err(Error::argument("NAME", problem, "`rtbench kernels` lists all names"));
        }
    }
    let mut lines: Vec<Line> = Vec::new();
    for (label, source) in &kernels {
        if !arguments.names.is_empty() && !arguments.names.iter().any(|name| has(label, name)) {
            continue;
        }
        let mut line: Line = vec![("kernel", label.as_str().into())];
        if arguments.events {
            let costs = source.event_costs()?;
            let of = |mark: &&'static str| (*mark, costs.get(mark).copied().unwrap_or(0.0).into());
            line.extend(EVENT_MARKS.iter().map(of));
        } else {
            line.extend(source.cost()?.quantities().map(|(name, value)| (name, value.into())));
        }
        line.push(("kernel_hash", source.hash().into()));
        lines.push(line);
    }
    let text = match arguments.format {
        Format::Text => text(&lines),
        Format::Markdown => markdown(&lines),
        Format::Csv => csv(&lines)?,
        Format::Json => json(&lines)?,
    };
    write_or_print(&text, arguments.output.as_deref())
}

/// The columns that are not zero in every line, without the hash: name and heading.
fn columns(lines: &[Line]) -> Vec<(usize, String)> {
    let Some(first) = lines.first() else { return Vec::new() };
    let is_shown = |&(index, (name, _)): &(usize, &(&str, Value))| {
        *name != "kernel_hash" && lines.iter().any(|line| line[index].1.number() != Some(0.0))
    };
    let columns = first.iter().enumerate().filter(is_shown);
    columns.map(|(index, (name, _))| (index, name.replace('_', " "))).collect()
}

fn text(lines: &[Line]) -> String {
    let columns = columns(lines);
    // Headings on two lines keep the table narrow
    let headings: Vec<String> = columns.iter().map(|(_, heading)| heading.replace(' ', "\n")).collect();
    let headings: Vec<&str> = headings.iter().map(String::as_str).collect();
    let cells = |line: &Line| columns.iter().map(|&(index, _)| line[index].1.write()).collect();
    format!("{}\n", terminal::table(&headings, 1, &lines.iter().map(cells).collect::<Vec<Vec<String>>>()))
}

fn markdown(lines: &[Line]) -> String {
    let columns = columns(lines);
    let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let mut text = row(columns.iter().map(|(_, heading)| heading.clone()).collect());
    text += &format!("|:---|{}\n", "---:|".repeat(columns.len().saturating_sub(1)));
    for line in lines {
        text += &row(columns.iter().map(|&(index, _)| line[index].1.write()).collect());
    }
    text
}

fn csv(lines: &[Line]) -> Result<String> {
    let failed = |error: csv::Error| Error::output(Path::new("CSV"), std::io::Error::other(error));
    let mut writer = csv::Writer::from_writer(Vec::new());
    if let Some(first) = lines.first() {
        writer.write_record(first.iter().map(|(name, _)| name)).map_err(failed)?;
    }
    for line in lines {
        writer.write_record(line.iter().map(|(_, value)| value.write())).map_err(failed)?;
    }
    let bytes = writer.into_inner().map_err(|error| Error::output(Path::new("CSV"), error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn json(lines: &[Line]) -> Result<String> {
    let object = |line: &Line| -> serde_json::Value {
        line.iter().map(|(name, value)| ((*name).to_owned(), serde_json::json!(value))).collect()
    };
    let list: Vec<serde_json::Value> = lines.iter().map(object).collect();
    let text = serde_json::to_string_pretty(&list).map_err(|error| Error::output(Path::new("JSON"), error.into()))?;
    Ok(text + "\n")
}
