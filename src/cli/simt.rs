//! `rtbench simt`: recorded counts of warps on a GPU that need not be there.

use super::runs::write_or_print;
use crate::error::Result;
use crate::report::format::{self, Format};
use crate::sources::runs::RecordedRun;
use crate::workloads::trace::simt::model::{self, Gpu};
use clap::Args;
use std::path::PathBuf;

/// Order structures as a GPU would, by a run that counted what warps issue
///
/// For each scene, ray configuration and size: the least time in which the GPU can issue the instructions of a frame
/// (the issue bound, which is no time), and the order of structures by issued instructions over resident warps.
/// docs/simt-model.md has the derivation, by which published times it was validated, and its limits.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Folders of runs that were recorded with --warp-width
    #[arg(value_name = "RUN", required = true)]
    runs: Vec<PathBuf>,
    /// The GPU: 8600gt, gtx280 (validated), rtx4090, h200 (not validated), or a TOML file like those in gpus/
    #[arg(long, value_name = "NAME|FILE")]
    gpu: String,
    /// Format of the tables
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    /// Write to a file instead of standard output
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  rtbench sweep --scene bunny.ply --structure all --config P,PS --resolution 512 --warp-width 32 --out results/warps
      counts what warps of 32 lanes issue, next to everything else
  rtbench simt results/warps --gpu gtx280
      the order on the GPU of the thesis of 2009
  rtbench simt results/warps --gpu mine.toml --format csv -o order.csv
      a GPU of your own, for other programs";

/// Runs the command.
///
/// # Errors
/// A run that cannot be read or has no counts of warps, an unknown GPU, output that cannot be written.
pub fn run(arguments: &Arguments) -> Result<()> {
    let gpu = Gpu::load(&arguments.gpu)?;
    let runs = RecordedRun::read_all(&arguments.runs)?;
    let journals: Vec<_> = runs.iter().map(|run| &run.journal).collect();
    let tables = model::tables(&journals, &gpu)?;
    write_or_print(&format::write(&tables, arguments.format), arguments.output.as_deref())
}
