//! Kernel variants: the pass, where its words are, and how a work-group adds up.

use super::{GROUP_ELEMENTS, GROUP_SIZE, Options};
use crate::device::vulkan::{Binding, BindingKind};
use crate::device::{Constants, Source, assemble};
use crate::error::{Error, Result};
use crate::workloads::kernel_files::FILES;

/// Which pass of a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// The sums of its groups.
    Reduce,
    /// The scan of its groups.
    Exclusive {
        /// The level of one group, which writes the total.
        top: bool,
        /// Over the words themselves.
        in_place: bool,
    },
}

/// One kernel variant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kernel {
    pub step: Step,
    pub options: Options,
}

impl Kernel {
    /// A name for labels and messages, such as `scan exclusive top in-place subgroups`.
    pub fn label(&self) -> String {
        let step = match self.step {
            Step::Reduce => "reduce",
            Step::Exclusive { top: false, in_place: false } => "exclusive",
            Step::Exclusive { top: false, in_place: true } => "exclusive in-place",
            Step::Exclusive { top: true, in_place: false } => "exclusive top",
            Step::Exclusive { top: true, in_place: true } => "exclusive top in-place",
        };
        format!("scan {step}{}", if self.options.subgroups { " subgroups" } else { "" })
    }

    /// The WGSL of this variant.
    pub fn assemble(&self) -> Result<Source> {
        let mut constants = Constants::default();
        constants.unsigned("GROUP_SIZE", GROUP_SIZE);
        constants.unsigned("GROUP_ELEMENTS", GROUP_ELEMENTS);
        constants.unsigned("PER_INVOCATION", GROUP_ELEMENTS / GROUP_SIZE);
        let chosen = |is_second: bool, files: [&'static str; 2]| files[usize::from(is_second)];
        let mut slots = vec![("sweep", chosen(self.options.subgroups, ["scan/sweeps.wgsl", "scan/subgroups.wgsl"]))];
        let entry = match self.step {
            Step::Reduce => "scan/reduce.wgsl",
            Step::Exclusive { top, in_place } => {
                slots.push(("before", chosen(top, ["scan/below.wgsl", "scan/top.wgsl"])));
                slots.push(("values", chosen(in_place, ["scan/separate.wgsl", "scan/in_place.wgsl"])));
                "scan/exclusive.wgsl"
            }
        };
        assemble(FILES, entry, &slots, constants).map_err(Error::Device)
    }

    /// The bindings that its text declares.
    pub fn layout(&self) -> Vec<Binding> {
        use BindingKind::{Read, ReadWrite, Uniform};
        let mut layout = vec![(0, Uniform)];
        match self.step {
            Step::Reduce => layout.extend([(1, Read), (3, ReadWrite), (4, ReadWrite)]),
            Step::Exclusive { top, in_place } => {
                layout.extend((!in_place).then_some((1, Read)));
                layout.push((2, ReadWrite));
                layout.extend(if top { vec![(4, ReadWrite), (5, ReadWrite)] } else { vec![(3, Read)] });
            }
        }
        layout.into_iter().map(|(number, kind)| Binding::new(number, kind)).collect()
    }
}

/// Every variant: its name and its text.
///
/// # Errors
/// [`Error::Device`] for an include that does not exist (a mistake in `kernels/`).
pub fn kernels() -> Result<Vec<(String, Source)>> {
    let mut all = Vec::new();
    for subgroups in [false, true] {
        let both = [false, true];
        let scans = both.iter().flat_map(|&top| both.map(|in_place| Step::Exclusive { top, in_place }));
        for step in std::iter::once(Step::Reduce).chain(scans) {
            let kernel = Kernel { step, options: Options { subgroups } };
            all.push((kernel.label(), kernel.assemble()?));
        }
    }
    Ok(all)
}
