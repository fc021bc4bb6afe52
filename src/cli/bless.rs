//! `rtbench bless`: a run becomes the baseline.

use super::{baselines, output};
use crate::compare::baseline::Baseline;
use crate::compare::bless;
use crate::error::{Error, Result};
use crate::record::stream::Names;
use clap::Args;
use std::path::PathBuf;

/// Write the baseline of a gate from a run
///
/// The file is sorted, with one line per row and part, so that an intended change is a short difference. Budgets and
/// min_compared_share that a person wrote into it are kept. A run with a wrong or failed row is refused, and the file
/// stays as it is.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Folder of a recorded run
    #[arg(value_name = "RUN")]
    run: PathBuf,
    /// The baseline; written anew, or for the first time
    #[arg(long, value_name = "FILE")]
    baseline: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// A run that cannot be read or has a wrong row, a baseline that cannot be read or written.
pub fn run(arguments: &Arguments) -> Result<()> {
    let path = &arguments.baseline;
    let before = if path.exists() { Some(Baseline::read(path)?) } else { None };
    let mut names = Names::default();
    let run = baselines::read(&arguments.run, &mut names)?;
    let workload = &run.run.provenance.workload;
    if let Some(other) = before.as_ref().filter(|before| before.workload != *workload) {
        let problem = format!("it is of `rtbench {}`, and the run is of `rtbench {workload}`", other.workload);
        return Err(Error::file(path, None, problem, "give another file"));
    }
    let costs = baselines::kernel_costs(&run)?;
    let baseline = bless::bless(&names, &run, &costs, &baselines::machine(&run), before.as_ref())?;
    baseline.save(path)?;
    let (rows, skipped) = (baseline.rows.len(), run.run.rows.len() - baseline.rows.len());
    let without = if skipped > 0 { format!("; {skipped} rows without a result are left out") } else { String::new() };
    output::note(&format!("{}: {rows} rows{without}", path.display()));
    Ok(())
}
