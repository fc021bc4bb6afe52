//! What rtbench can measure: one folder per workload, and one line in [`ALL`].

pub mod kernel_files;
pub mod random;
pub mod scan;
pub mod size;
pub mod spheres;
pub mod splat;
pub mod trace;
pub mod words;

use crate::device::Source;
use crate::error::{Error, Result};
use crate::harness::workload::Workload;
use std::collections::BTreeMap;

/// All workloads, in the order of help.
pub static ALL: &[&dyn Workload] = &[&trace::TRACE, &spheres::SPHERES, &splat::SPLAT];

/// A workload by its name.
pub fn find(name: &str) -> Option<&'static dyn Workload> {
    ALL.iter().copied().find(|workload| workload.info().name == name)
}

/// The kernels of all workloads ([`Workload::kernels`]) by their labels, `WORKLOAD KERNEL`.
///
/// # Errors
/// [`Error::Device`] for a kernel that cannot be assembled, or two kernels of one label (mistakes of a workload).
pub fn kernels() -> Result<BTreeMap<String, Source>> {
    let mut kernels = BTreeMap::new();
    for workload in ALL {
        for (name, source) in workload.kernels()? {
            let label = format!("{} {name}", workload.info().name);
            if kernels.contains_key(&label) {
                return Err(Error::Device(format!("two kernels are called {label}")));
            }
            kernels.insert(label, source);
        }
    }
    Ok(kernels)
}

/// The static cost of each of [`kernels`]: label, name of the quantity ([`crate::device::vulkan::KernelCost`]), value.
/// It needs no device, and is the same on every machine.
///
/// # Errors
/// As [`kernels`], and for a kernel that is not valid.
pub fn kernel_costs() -> Result<BTreeMap<String, BTreeMap<String, u64>>> {
    let cost = |(label, source): (String, Source)| {
        let quantities = source.cost()?.quantities().map(|(name, value)| (name.to_owned(), value));
        Ok((label, quantities.into()))
    };
    kernels()?.into_iter().map(cost).collect()
}
