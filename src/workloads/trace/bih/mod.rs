//! Bounding interval hierarchies: binary trees of two planes a node.

pub mod build;
pub(crate) mod check;
mod layout;
pub mod stack;

pub use layout::{Bih, BihNode, BihUniform};

use super::algorithm::{Builder, Made};
use super::options::{Axis, Kind, OptionInfo};
use super::structure::StructureKind;
use crate::device::vulkan::Texel;

static KIND: StructureKind = StructureKind { name: "BIH", node_texel: Texel::Bytes8, has_cells: false };

static BUILDER: Builder = Builder {
    name: "bih",
    options: OPTIONS,
    parallel: true,
    purpose: |_| "",
    build: |selection, scene| {
        Ok(Made::of(build::build(scene, &build::Config { max_leaf: selection.size("max_leaf") })?))
    },
    estimate: None,
    on_device: None,
};

/// Greatest depth of a tree. Traversals size their stacks by [`Bih::depth`].
pub const MAX_DEPTH: u32 = 60;

const OPTIONS: &[OptionInfo] =
    &[OptionInfo::new(Axis::Build, "max_leaf", "3", "split until at most so many triangles", Kind::Count(1, 15))];
