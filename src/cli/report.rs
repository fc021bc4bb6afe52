//! `rtbench report`: everything on one page.

use super::runs::{RunArguments, deliver};
use super::tables::card;
use crate::error::Result;
use crate::thesis::convention::Convention;
use crate::thesis::data::Data;
use crate::thesis::report;
use crate::thesis::tables::{Options, Rows};
use clap::Args;
use std::path::PathBuf;

/// Write tables, figures, claims and pictures of recorded runs as one HTML page
///
/// The page needs no network and no other file. It has every table beside the published one, the figures, pictures and
/// step maps where the runs' folders have them, the claims, and where everything comes from.
#[derive(Args, Debug)]
pub struct Arguments {
    #[command(flatten)]
    runs: RunArguments,
    /// The page
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    /// The thesis's card that measured times stand beside
    #[arg(long, default_value = "GTX280", value_name = "GTX280|8600GT")]
    card: String,
    /// Side of the square image in tables 5.12 to 5.14 [default: 1024, or that of which most was measured]
    #[arg(long, value_name = "PIXELS")]
    resolution: Option<u32>,
    /// What a step of a tree is, in tables 5.10 and 5.11
    #[arg(long, value_enum, default_value_t)]
    convention: Convention,
    /// Which rows tables have
    #[arg(long, value_enum, default_value_t = Rows::Measured)]
    rows: Rows,
}

/// Runs the command.
///
/// # Errors
/// A run or picture that cannot be read, a page that cannot be written.
pub fn run(arguments: &Arguments) -> Result<()> {
    let sources = arguments.runs.read()?;
    let options = Options {
        beside: true,
        convention: arguments.convention,
        resolution: arguments.resolution.unwrap_or_else(|| resolution(&sources.data)),
        card: card(&sources.published, &arguments.card)?,
        rows: arguments.rows,
    };
    let of = report::Sources { runs: &sources.runs, data: &sources.data, published: &sources.published };
    deliver(&report::write(&of, &options)?, Some(&arguments.output))
}

/// The thesis's resolution if it was measured; else the one of which most was, of equals the largest.
fn resolution(data: &Data) -> u32 {
    let usual = Options::default().resolution;
    let number = |side: u32| data.frames.iter().filter(|f| (f.width, f.height) == (side, side)).count();
    let sides = (0..data.devices.len()).flat_map(|device| data.sides(device));
    if number(usual) > 0 { usual } else { sides.max_by_key(|side| (number(*side), *side)).unwrap_or(usual) }
}
