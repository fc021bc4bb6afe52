//! Kernel variants of builders.

use super::super::codes::CELLS;
use crate::device::vulkan::{Binding, BindingKind};
use crate::device::{Constants, Source, assemble};
use crate::error::{Error, Result};
use crate::math;
use crate::workloads::kernel_files::FILES;

/// Invocations of a work-group.
pub const GROUP_SIZE: u32 = 64;

/// Invocations of a work-group whose workers take chunks.
pub const WORKER_GROUP: u32 = 16;

/// One kernel variant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kernel {
    /// Morton codes.
    Codes,
    /// Counts digits of so many bits.
    Count { bits: u32 },
    /// Sorts by a digit of so many bits.
    Scatter { bits: u32, is_first: bool },
    /// Which inner nodes of a radix tree are kept.
    Flags,
    /// The list of these.
    List,
    /// Their ranges and children.
    Nodes,
    /// Boxes of leaves.
    Leaves,
    /// Boxes of a level of inner nodes.
    Refit,
    /// Boxes of the levels above.
    Top,
    /// Triangles as clusters.
    Clusters,
    /// Partners of clusters.
    Search,
    /// Which clusters remain and merge.
    Choose,
    /// Merges clusters.
    Merge,
    /// Which inner nodes are kept.
    Number,
    /// Places of triangles, and nodes.
    Descend,
}

use BindingKind::{Read, ReadWrite, Uniform};

impl Kernel {
    /// Every variant, with digits of `bits` bits.
    fn all(bits: u32) -> Vec<Kernel> {
        use Kernel::*;
        let mut all = vec![Codes, Count { bits }];
        all.extend([true, false].map(|is_first| Scatter { bits, is_first }));
        all.extend([Flags, List, Nodes, Leaves, Refit, Top, Clusters, Search, Choose, Merge, Number, Descend]);
        all
    }

    fn file(self) -> &'static str {
        match self {
            Kernel::Codes => "trace/build/codes.wgsl",
            Kernel::Count { .. } => "trace/build/count.wgsl",
            Kernel::Scatter { .. } => "trace/build/scatter.wgsl",
            Kernel::Flags => "trace/build/flags.wgsl",
            Kernel::List => "trace/build/list.wgsl",
            Kernel::Nodes => "trace/build/nodes.wgsl",
            Kernel::Leaves => "trace/build/leaves.wgsl",
            Kernel::Refit => "trace/build/refit.wgsl",
            Kernel::Top => "trace/build/top.wgsl",
            Kernel::Clusters => "trace/build/clusters.wgsl",
            Kernel::Search => "trace/build/search.wgsl",
            Kernel::Choose => "trace/build/choose.wgsl",
            Kernel::Merge => "trace/build/merge.wgsl",
            Kernel::Number => "trace/build/number.wgsl",
            Kernel::Descend => "trace/build/descend.wgsl",
        }
    }

    /// A name for labels and messages, such as `build scatter first`.
    pub fn label(self) -> String {
        let name = self.file().trim_start_matches("trace/build/").trim_end_matches(".wgsl");
        let variant = match self {
            Kernel::Scatter { is_first: true, .. } => " first",
            _ => "",
        };
        format!("build {name}{variant}")
    }

    /// The WGSL of this variant.
    pub fn assemble(self) -> Result<Source> {
        let mut constants = Constants::default();
        constants.unsigned("GROUP_SIZE", GROUP_SIZE);
        constants.unsigned("WORKER_GROUP", WORKER_GROUP);
        constants.float("CELLS", CELLS);
        constants.float("MIN_POSITIVE", f32::MIN_POSITIVE);
        constants.float("T_MAX", math::T_MAX);
        constants.unsigned("DEPTH", super::lbvh::DEPTH);
        constants.unsigned("LEAVES", super::lbvh::LEAVES);
        let mut slots = Vec::new();
        match self {
            Kernel::Count { bits } => constants.unsigned("DIGITS", 1 << bits),
            Kernel::Scatter { bits, is_first } => {
                constants.unsigned("DIGITS", 1 << bits);
                let order = if is_first { "trace/build/order_first.wgsl" } else { "trace/build/order_sorted.wgsl" };
                slots.push(("order", order));
            }
            _ => {}
        }
        assemble(FILES, self.file(), &slots, constants).map_err(Error::Device)
    }

    /// The bindings that its text declares.
    pub fn layout(self) -> Vec<Binding> {
        let kinds: &[BindingKind] = match self {
            Kernel::Count { .. } | Kernel::Search | Kernel::Number | Kernel::Flags => &[Uniform, Read, ReadWrite],
            Kernel::Codes | Kernel::List => &[Uniform, Read, Read, ReadWrite],
            Kernel::Clusters => &[Uniform, Read, Read, Read, ReadWrite],
            Kernel::Leaves => &[Uniform, Read, Read, Read, Read, ReadWrite],
            Kernel::Scatter { is_first: true, .. } => &[Uniform, Read, ReadWrite, ReadWrite, ReadWrite],
            Kernel::Scatter { .. } => &[Uniform, Read, ReadWrite, ReadWrite, ReadWrite, Read],
            Kernel::Choose => &[Uniform, Read, ReadWrite, ReadWrite],
            Kernel::Merge => &[Uniform, Read, Read, Read, Read, ReadWrite, ReadWrite, ReadWrite],
            Kernel::Descend => {
                &[Uniform, Read, Read, Read, Read, Read, Read, ReadWrite, ReadWrite, ReadWrite, ReadWrite]
            }
            Kernel::Nodes => &[Uniform, Read, ReadWrite, ReadWrite, ReadWrite, ReadWrite, ReadWrite, ReadWrite, Read],
            Kernel::Refit | Kernel::Top => {
                &[Uniform, Read, ReadWrite, ReadWrite, ReadWrite, ReadWrite, ReadWrite, ReadWrite, Read]
            }
        };
        (0..).zip(kinds).map(|(number, &kind)| Binding::new(number, kind)).collect()
    }
}

/// Every kernel of the builders: its name and its text.
///
/// # Errors
/// [`Error::Device`] for an include that does not exist (a mistake in `kernels/`).
pub fn kernels() -> Result<Vec<(String, Source)>> {
    Kernel::all(super::curve::GPU_BITS).into_iter().map(|kernel| Ok((kernel.label(), kernel.assemble()?))).collect()
}
