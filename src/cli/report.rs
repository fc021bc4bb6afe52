//! `rtbench report`: everything on one page.

use super::runs::{DeviceArguments, OptionArguments, RunArguments, write_or_print};
use crate::error::Result;
use crate::guard;
use crate::sources::report::{self, Part};
use clap::Args;
use std::path::PathBuf;

/// Write tables, figures, claims and pictures of recorded runs as one HTML page
///
/// The page needs no network and no other file. It has every table with the published numbers, the figures, pictures
/// and step maps of the runs' folders, the claims, and the provenance of all numbers.
#[derive(Args, Debug)]
pub struct Arguments {
    #[command(flatten)]
    runs: RunArguments,
    /// The page
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    device: DeviceArguments,
    #[command(flatten)]
    options: OptionArguments,
}

/// Runs the command.
///
/// # Errors
/// A run or picture that cannot be read, an unknown source or device, a page that cannot be written.
pub fn run(arguments: &Arguments) -> Result<()> {
    let opened = arguments.runs.read()?;
    guard::check_output(&arguments.output)?;
    let devices = arguments.device.select(&opened.sources)?;
    let part = |((source, results), device)| Part { source, results, options: arguments.options.options(true, device) };
    let parts: Vec<Part> = opened.each().zip(devices).map(part).collect();
    write_or_print(&report::write(&parts, &opened.runs)?, Some(&arguments.output))
}
