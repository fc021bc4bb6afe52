//! `rtbench tables`: the thesis's tables, published or measured.

use super::output;
use super::runs::{Into, RunArguments, deliver};
use crate::error::{Error, Result};
use crate::thesis::convention::Convention;
use crate::thesis::data::Data;
use crate::thesis::format::{self, Format};
use crate::thesis::splice::{Block, Need};
use crate::thesis::table::Table;
use crate::thesis::tables::{self, Options, Rows, side};
use clap::Args;
use std::path::PathBuf;

/// Print the thesis's tables, from recorded runs or as published
///
/// Without a run: the numbers that the thesis printed. With runs: the same tables of what was measured. The same runs
/// always give the same bytes.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    #[command(flatten)]
    runs: RunArguments,
    /// Tables by their numbers: 5.1 to 5.14, 5.3.4 (speed-ups between devices), B.1 to B.6, or all
    #[arg(long, default_value = "all", value_name = "LIST")]
    table: String,
    /// Form of the tables
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    /// Put the published number and the ratio to it beside each measured one
    #[arg(long, value_parser = ["thesis"])]
    beside: Option<String>,
    /// The thesis's card whose numbers are shown, alone or beside measured ones [default: each table's own, 8600GT for
    /// 5.7 and B.4 to B.6, GTX280 for the others]
    #[arg(long, value_name = "GTX280|8600GT")]
    card: Option<String>,
    /// Side of the square image in tables 5.12 to 5.14 [default: the largest of the thesis's (1024, 768, 512, 256) at
    /// which nearly every scene was measured]
    #[arg(long, value_name = "PIXELS")]
    resolution: Option<u32>,
    /// What a step of a tree is, in tables 5.10 and 5.11
    #[arg(long, value_enum, default_value_t)]
    convention: Convention,
    /// Which rows to print
    #[arg(long, value_enum, default_value_t)]
    rows: Rows,
    /// Write to a file instead of standard output
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    into: Into,
}

const EXAMPLES: &str = "\
Examples:
  rtbench tables
      everything that the thesis printed
  rtbench tables results/RUN --beside thesis --table 5.4,5.5,5.6
      the structures of a run beside the published ones
  rtbench tables results/A results/B --table 5.2,5.3.4,B.1 --format markdown
      two devices, and how much faster one is
  rtbench tables results/RUN --format csv -o tables.csv
      one line per number, for other programs
  rtbench tables results/RUN --table 5.12 --rows measured --into README.md
      a document's own table, between <!-- rtbench:5.12 --> and <!-- /rtbench:5.12 -->";

/// Runs the command.
///
/// # Errors
/// A run that cannot be read, an unknown table or card, output that cannot be written.
pub fn run(arguments: &Arguments) -> Result<()> {
    let ids = tables::select(&arguments.table)?;
    let sources = arguments.runs.read()?;
    if arguments.beside.is_some() && sources.runs.is_empty() {
        output::note("nothing stands beside the published numbers: give a run");
    }
    let card = arguments.card.as_deref().map(|name| card(&sources.published, name)).transpose()?;
    let options = Options {
        beside: arguments.beside.is_some(),
        convention: arguments.convention,
        resolution: arguments.resolution.unwrap_or_else(|| side::usual(&sources.data, card.unwrap_or(0))),
        card,
        rows: arguments.rows,
    };
    let mut tables = tables::build(&sources.data, &sources.published, &options, &ids);
    let (all, need) =
        if ids.len() == tables::IDS.len() { (&tables::IDS[..], Need::Any) } else { (&ids[..], Need::All) };
    if arguments.into.splice(|| blocks(&tables, all), need)? {
        return Ok(());
    }
    let empty = tables::without_numbers(&sources.data, &sources.published, &options, &ids);
    if !empty.is_empty() && !sources.runs.is_empty() {
        output::note(&format!("nothing was measured for: {}", empty.join(", ")));
    }
    if arguments.rows == Rows::Measured && need == Need::Any {
        // Named by the line above; a table that was asked for by its number stands in any case
        tables.retain(|table| !table.rows.is_empty());
    }
    deliver(&format::write(&tables, arguments.format), arguments.output.as_deref())
}

/// A block per number, with all its tables.
fn blocks(tables: &[Table], ids: &[&str]) -> Vec<Block> {
    let of = |id: &&str| {
        let own: Vec<Table> = tables.iter().filter(|table| table.id == **id).cloned().collect();
        ((*id).to_owned(), format::write(&own, Format::Markdown))
    };
    ids.iter().map(of).collect()
}

/// A published card by its name.
pub fn card(published: &Data, name: &str) -> Result<usize> {
    let found = published.devices.iter().position(|d| d.label.eq_ignore_ascii_case(name));
    found.ok_or_else(|| {
        let names: Vec<&str> = published.devices.iter().map(|d| d.label.as_str()).collect();
        Error::argument("--card", format!("the thesis has no card '{name}'"), format!("one of {}", names.join(", ")))
    })
}
