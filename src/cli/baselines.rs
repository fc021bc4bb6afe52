//! What gate and bless share.

use crate::compare::bless::KernelCosts;
use crate::compare::conditions::ComparedRun;
use crate::error::Result;
use crate::record::stream::{LeanRun, Names};
use crate::workloads;
use std::path::Path;

/// A run that has ended.
pub fn read(path: &Path, names: &mut Names) -> Result<ComparedRun> {
    Ok(ComparedRun::new(LeanRun::read(path, names)?))
}

/// Whole numbers that depend on the machine, by the workload's word.
pub fn machine(run: &ComparedRun) -> Vec<String> {
    let workload = workloads::find(&run.run.provenance.workload);
    workload.map_or(&[][..], |workload| workload.machine_metrics()).iter().map(|name| name.to_string()).collect()
}

/// The static costs of the workload's kernels; none for a workload that this program does not know.
pub fn kernel_costs(run: &ComparedRun) -> Result<KernelCosts> {
    let own = format!("{} ", run.run.provenance.workload);
    Ok(workloads::kernel_costs()?.into_iter().filter(|(label, _)| label.starts_with(&own)).collect())
}
