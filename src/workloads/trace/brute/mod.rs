//! No structure: every ray is tested against every triangle.

pub mod build;
mod layout;
pub mod scan;

pub use layout::{Brute, BruteUniform};

use super::algorithm::{Builder, Made};
use super::structure::StructureKind;
use crate::device::vulkan::Texel;

static KIND: StructureKind = StructureKind { name: "list of triangles", node_texel: Texel::Bytes16, has_cells: false };

static BUILDER: Builder = Builder {
    name: "brute",
    options: &[],
    parallel: true,
    purpose: |_| "",
    build: |_, scene| Ok(Made::of(build::build(scene)?)),
    estimate: None,
    on_device: None,
};
