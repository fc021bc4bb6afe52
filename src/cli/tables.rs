//! `rtbench tables`: the tables of sources, published or measured.

use super::output;
use super::runs::{DeviceArguments, Into, OptionArguments, RunArguments, write_or_print};
use crate::error::Result;
use crate::report::Table;
use crate::report::format::{self, Format};
use crate::report::splice::{Block, Need};
use crate::sources::{self, Rows, without_numbers};
use clap::Args;
use std::path::PathBuf;

/// Print the tables of the thesis (or another source), from recorded runs or as published
///
/// Without a run: the published numbers. With runs: the same tables of measured numbers. The same runs always give the
/// same bytes.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    #[command(flatten)]
    runs: RunArguments,
    /// Tables by their numbers, or all; the thesis has 5.1 to 5.14, 5.3.4 (speed-ups between devices), B.1 to B.6 and
    /// simt (work by the SIMT model, where warps were counted), rt2 has 4.4 to 4.6, spheres has 1 to 4, best, metrics,
    /// switches, scaling, half and work, structures has rates, work and break-even
    #[arg(long, default_value = "all", value_name = "LIST")]
    table: String,
    /// Format of the tables
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    /// Print the published number and the ratio to it below each measured one
    #[arg(long)]
    published: bool,
    /// The former spelling of --published
    #[arg(long, value_parser = ["thesis"], hide = true)]
    beside: Option<String>,
    #[command(flatten)]
    device: DeviceArguments,
    #[command(flatten)]
    options: OptionArguments,
    /// Write to a file instead of standard output
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    into: Into,
}

const EXAMPLES: &str = "\
Examples:
  rtbench tables
      everything that the sources printed
  rtbench tables results/RUN --published --table 5.4,5.5,5.6
      the structures of a run, each number with the published one
  rtbench tables results/A results/B --table 5.2,5.3.4,B.1 --format markdown
      two devices, and how much faster one is
  rtbench tables results/RUN --source spheres --table 1,2,3,4,metrics --published
      speed-ups of threads, SIMD and the GPU, with the printed ones
  rtbench tables results/RUN --format csv -o tables.csv
      one line per number, for other programs
  rtbench tables results/RUN --table 5.12 --rows measured --into README.md
      a document's own table, between <!-- rtbench:5.12 --> and <!-- /rtbench:5.12 -->";

/// Runs the command.
///
/// # Errors
/// A run that cannot be read, an unknown source, table or device, output that cannot be written.
pub fn run(arguments: &Arguments) -> Result<()> {
    let opened = arguments.runs.read()?;
    let ids = sources::select_tables(&opened.sources, &arguments.table)?;
    let devices = arguments.device.select(&opened.sources)?;
    let published = arguments.published || arguments.beside.is_some();
    if published && opened.runs.is_empty() {
        output::note("there is nothing to compare the published numbers with: give a run");
    }
    let is_all = arguments.table.eq_ignore_ascii_case("all");
    let mut tables: Vec<Table> = Vec::new();
    let mut empty: Vec<&str> = Vec::new();
    for (((_, results), ids), device) in opened.each().zip(&ids).zip(&devices) {
        let options = arguments.options.options(published, *device);
        tables.extend(results.tables(ids, &options));
        empty.extend(without_numbers(results, ids, &options));
    }
    let need = if is_all { Need::Any } else { Need::All };
    if arguments.into.splice(&opened, || blocks(&tables, &ids.concat()), need)? {
        return Ok(());
    }
    if !empty.is_empty() && !opened.runs.is_empty() {
        output::note(&format!("nothing was measured for: {}", empty.join(", ")));
    }
    if arguments.options.rows == Rows::Measured && is_all {
        // The note names them; a table that was asked for by its number is printed without rows
        tables.retain(|table| !table.rows.is_empty());
    }
    write_or_print(&format::write(&tables, arguments.format), arguments.output.as_deref())
}

/// A block per number, with all its tables.
fn blocks(tables: &[Table], ids: &[&str]) -> Vec<Block> {
    let of = |id: &&str| {
        let own: Vec<Table> = tables.iter().filter(|table| table.id == **id).cloned().collect();
        ((*id).to_owned(), format::write(&own, Format::Markdown))
    };
    ids.iter().map(of).collect()
}
