//! What rtbench can measure: one folder per workload, and one line in [`ALL`].

pub mod trace;

use crate::harness::workload::Workload;

/// All workloads, in the order of help.
pub static ALL: &[&dyn Workload] = &[&trace::TRACE];

/// A workload by its name.
pub fn find(name: &str) -> Option<&'static dyn Workload> {
    ALL.iter().copied().find(|workload| workload.info().name == name)
}
