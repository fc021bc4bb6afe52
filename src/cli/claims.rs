//! `rtbench claims`: what the thesis says, judged by measurements.

use super::runs::{Into, RunArguments, Sources, deliver};
use super::tables;
use crate::error::Result;
use crate::thesis::claims::{self, Form};
use crate::thesis::splice::Need;
use clap::Args;
use std::path::PathBuf;

/// Judge the thesis's claims by recorded runs
///
/// For each claim: holds, does not hold, undecided (no difference is beyond noise and margin, or only the thesis's own
/// exceptions are) or not measured, with the numbers. Without a run, the claims are judged by the thesis's own printed numbers. The exit code is 0 whatever the
/// verdicts are.
#[derive(Args, Debug)]
pub struct Arguments {
    #[command(flatten)]
    runs: RunArguments,
    /// Form of the verdicts
    #[arg(long, value_enum, default_value_t)]
    format: Form,
    /// The thesis's card whose numbers stand beside the verdicts
    #[arg(long, default_value = "GTX280", value_name = "GTX280|8600GT")]
    card: String,
    /// Write to a file instead of standard output
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    into: Into,
}

/// Runs the command.
///
/// # Errors
/// A run that cannot be read, output that cannot be written.
pub fn run(arguments: &Arguments) -> Result<()> {
    let sources = arguments.runs.read()?;
    let card = tables::card(&sources.published, &arguments.card)?;
    let findings = claims::judge(&sources.data, &sources.published, card);
    let block = || vec![("claims".to_owned(), claims::summary(&findings, &whose(&sources)))];
    if arguments.into.splice(block, Need::All)? {
        return Ok(());
    }
    deliver(&claims::write(&findings, &whose(&sources), arguments.format), arguments.output.as_deref())
}

/// Whose numbers are judged.
fn whose(sources: &Sources) -> String {
    match sources.runs.len() {
        0 => "the numbers that it printed".into(),
        1 => "1 run".into(),
        n => format!("{n} runs"),
    }
}
