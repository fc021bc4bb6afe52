//! `rtbench claims`: the claims of sources, judged by measurements.

use super::runs::{DeviceArguments, Into, ProcessorArguments, RunArguments, write_or_print};
use crate::error::Result;
use crate::report::splice::Need;
use crate::sources::Options;
use crate::sources::claims::{self, Finding, Form};
use clap::Args;
use std::path::PathBuf;

/// Judge the claims of the thesis (or another source) by recorded runs
///
/// For each claim: holds, does not hold, undecided (no difference is beyond noise and margin, or only the source's own
/// exceptions are) or not measured, with the numbers. Without a run, the claims are judged by the source's own
/// published numbers. The exit code is 0 for all verdicts.
#[derive(Args, Debug)]
pub struct Arguments {
    #[command(flatten)]
    runs: RunArguments,
    /// Format of the verdicts
    #[arg(long, value_enum, default_value_t)]
    format: Form,
    #[command(flatten)]
    device: DeviceArguments,
    #[command(flatten)]
    processors: ProcessorArguments,
    /// Write to a file instead of standard output
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    into: Into,
}

/// Runs the command.
///
/// # Errors
/// A run that cannot be read, an unknown source or device, output that cannot be written.
pub fn run(arguments: &Arguments) -> Result<()> {
    let opened = arguments.runs.read()?;
    let devices = arguments.device.select(&opened.sources)?;
    let options = |device| Options { device, processors: arguments.processors.processors, ..Options::default() };
    let findings: Vec<Vec<Finding>> =
        opened.each().zip(devices).map(|((_, results), device)| results.claims(&options(device))).collect();
    let by = match opened.runs.len() {
        0 => "the numbers that it printed".into(),
        1 => "1 run".into(),
        n => format!("{n} runs"),
    };
    let block = || findings.iter().map(|of_source| ("claims".to_owned(), claims::summary(of_source, &by))).collect();
    if arguments.into.splice(&opened, block, Need::All)? {
        return Ok(());
    }
    write_or_print(&claims::write(&findings, &by, arguments.format), arguments.output.as_deref())
}
