//! Kernel variants of clusters.

use crate::device::vulkan::{Binding, BindingKind};
use crate::device::{Constants, Source, assemble};
use crate::error::{Error, Result};
use crate::math;
use crate::workloads::kernel_files::FILES;
use crate::workloads::splat::clusters::setting::{MAX_TILE, MIN_TILE, Normals};
use crate::workloads::splat::gpu::kernels::GROUP_SIZE;
use crate::workloads::splat::gpu::steps::Variant;

/// Words that an invocation of [`ClusterKernel::Fill`] writes.
pub(super) const FILLED: u32 = 4;

/// A kernel of clusters. Tiles are given by the power of two that is their side or the next above.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // each is described by its file
pub enum ClusterKernel {
    Keys(Normals),
    Fill,
    Flag,
    Bit,
    Popcount,
    /// Whether places are of words of bits.
    Assign(bool),
    Sort(u32),
    Number,
    Count,
    Clear,
    Direct,
    TwoStep(u32),
    Leaves,
    /// Whether children are clusters, and whether their places are of words of bits.
    Nodes(bool, bool),
}

use BindingKind::{MovingUniform, Read, ReadWrite, Uniform};
use ClusterKernel::*;

impl ClusterKernel {
    /// Every variant.
    pub fn all() -> Vec<ClusterKernel> {
        let mut all = vec![Fill, Flag, Bit, Popcount, Number, Count, Clear, Direct, Leaves, Nodes(false, false)];
        all.extend([Normals::Off, Normals::Faces, Normals::Cells].map(Keys));
        for bits in [false, true] {
            all.extend([Assign(bits), Nodes(true, bits)]);
        }
        for side in sides() {
            all.extend([Sort(side), TwoStep(side)]);
        }
        all
    }

    fn file(self) -> &'static str {
        match self {
            Keys(_) => "splat/clusters/keys.wgsl",
            Fill => "splat/clusters/fill.wgsl",
            Flag => "splat/clusters/flag.wgsl",
            Bit => "splat/clusters/bit.wgsl",
            Popcount => "splat/clusters/popcount.wgsl",
            Assign(_) => "splat/clusters/assign.wgsl",
            Sort(_) => "splat/clusters/sort.wgsl",
            Number => "splat/clusters/number.wgsl",
            Count => "splat/clusters/count.wgsl",
            Clear => "splat/clusters/clear.wgsl",
            Direct => "splat/clusters/direct.wgsl",
            TwoStep(_) => "splat/clusters/two_step.wgsl",
            Leaves => "splat/clusters/leaves.wgsl",
            Nodes(..) => "splat/clusters/nodes.wgsl",
        }
    }
}

/// Sides of tiles that kernels have room for.
fn sides() -> impl Iterator<Item = u32> {
    (MIN_TILE.trailing_zeros()..=MAX_TILE.trailing_zeros()).map(|bits| 1 << bits)
}

impl Variant for ClusterKernel {
    /// Such as `clusters sort 32`.
    fn label(&self) -> String {
        let name = self.file().trim_start_matches("splat/").trim_end_matches(".wgsl").replace('/', " ");
        match *self {
            Keys(Normals::Faces) => format!("{name} faces"),
            Keys(Normals::Cells) => format!("{name} cells"),
            Assign(true) => format!("{name} bits"),
            Sort(side) | TwoStep(side) => format!("{name} {side}"),
            Nodes(true, bits) => format!("{name} clusters{}", if bits { " bits" } else { "" }),
            _ => name,
        }
    }

    fn assemble(&self) -> Result<Source> {
        let mut constants = Constants::default();
        constants.unsigned("GROUP_SIZE", GROUP_SIZE);
        match *self {
            Keys(normals) => {
                constants.unsigned("NORMAL_BITS", normals.bits());
                constants.float("INVERSE_OF_ZERO", math::INVERSE_OF_ZERO);
                constants.float("PLANE_SHIFT", math::PLANE_SHIFT);
                constants.float("PLANE_SHIFT_MIN", math::PLANE_SHIFT_MIN);
                constants.float("SLACK", math::SLACK);
                constants.flag("SOFTWARE", false);
            }
            Fill => constants.unsigned("FILLED", FILLED),
            Assign(bits) => constants.flag("BITS", bits),
            Sort(side) | TwoStep(side) => {
                constants.unsigned("SIDE", side);
                constants.unsigned("SIDE_BITS", side.trailing_zeros());
                constants.unsigned("SORT_WORDS", (side * side).max(GROUP_SIZE));
            }
            Number => constants.unsigned("SIDE", MAX_TILE),
            Nodes(above_clusters, bits) => {
                constants.flag("ABOVE_CLUSTERS", above_clusters);
                constants.flag("BITS", bits);
            }
            _ => {}
        }
        // Rays come with products of vectors
        let slots = [("intersect", "trace/intersect/watertight.wgsl")];
        assemble(FILES, self.file(), &slots, constants).map_err(Error::Device)
    }

    fn layout(&self) -> Vec<Binding> {
        let kinds: &[BindingKind] = match *self {
            Keys(_) => &[MovingUniform, Uniform, Read, Read, Read, ReadWrite, ReadWrite, ReadWrite, Read],
            Fill => &[Uniform, ReadWrite],
            Flag | Bit | Popcount => &[Uniform, Read, ReadWrite],
            Assign(_) => &[Uniform, Read, Read, Read, ReadWrite, ReadWrite],
            Sort(_) => &[Uniform, Read, ReadWrite, ReadWrite],
            Number => &[Uniform, Read, Read, ReadWrite, ReadWrite, ReadWrite],
            Count | Clear => &[Uniform, Read, ReadWrite],
            Direct | TwoStep(_) | Leaves => &[Uniform, Read, Read, ReadWrite],
            Nodes(..) => &[Uniform, Read, Read, ReadWrite, ReadWrite],
        };
        (0..).zip(kinds).map(|(number, &kind)| Binding::new(number, kind)).collect()
    }
}

/// Every kernel of clusters: its name and its text.
///
/// # Errors
/// [`Error::Device`] for an include that does not exist (a mistake in `kernels/`).
pub fn kernels() -> Result<Vec<(String, Source)>> {
    ClusterKernel::all().into_iter().map(|kernel| Ok((kernel.label(), kernel.assemble()?))).collect()
}
