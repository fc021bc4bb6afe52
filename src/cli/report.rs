//! `rtbench report`: everything on one page.

use super::runs::{RunArguments, deliver};
use super::tables::card;
use crate::error::Result;
use crate::thesis::convention::Convention;
use crate::thesis::report;
use crate::thesis::tables::{Options, Rows, side};
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
    /// The thesis's card that measured times stand beside [default: each table's own, 8600GT for 5.7 and B.4 to B.6, GTX280
    /// for the others]
    #[arg(long, value_name = "GTX280|8600GT")]
    card: Option<String>,
    /// Side of the square image in tables 5.12 to 5.14 [default: the largest of the thesis's (1024, 768, 512, 256) at
    /// which nearly every scene was measured]
    #[arg(long, value_name = "PIXELS")]
    resolution: Option<u32>,
    /// What a step of a tree is, in tables 5.10 and 5.11
    #[arg(long, value_enum, default_value_t)]
    convention: Convention,
    /// Which rows tables have
    #[arg(long, value_enum, default_value_t)]
    rows: Rows,
}

/// Runs the command.
///
/// # Errors
/// A run or picture that cannot be read, a page that cannot be written.
pub fn run(arguments: &Arguments) -> Result<()> {
    let sources = arguments.runs.read()?;
    let card = arguments.card.as_deref().map(|name| card(&sources.published, name)).transpose()?;
    let options = Options {
        beside: true,
        convention: arguments.convention,
        resolution: arguments.resolution.unwrap_or_else(|| side::usual(&sources.data, card.unwrap_or(0))),
        card,
        rows: arguments.rows,
    };
    let of = report::Sources { runs: &sources.runs, data: &sources.data, published: &sources.published };
    deliver(&report::write(&of, &options)?, Some(&arguments.output))
}
