//! The driver's own acceleration structure, through ray queries. It is built by the driver when it is prepared, of
//! triangles in an order that helps drivers which keep it.

pub mod build;
pub mod driver;
mod layout;

pub use layout::SortedTriangles;

use super::algorithm::{Builder, Made};
use super::structure::StructureKind;
use crate::device::vulkan::Texel;

static KIND: StructureKind =
    StructureKind { name: "list of sorted triangles", node_texel: Texel::Bytes16, has_cells: false };

static BUILDER: Builder = Builder {
    name: "query",
    options: &[],
    parallel: true,
    purpose: |_| "",
    build: |_, scene| Ok(Made::of(build::build(scene)?)),
    estimate: None,
    on_device: None,
};
