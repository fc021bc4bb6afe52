//! Trees of boxes with two, four or eight children a node, collapsed from a BVH, with quantised boxes.

pub(crate) mod check;
pub mod collapse;
mod layout;
pub mod octants;
mod octants_stack;
pub mod pair_stack;
mod quantise;
pub(in crate::workloads::trace) mod reached;
mod short_stack;
pub mod stack;

pub use layout::{Slot, Wide, WideUniform};
pub use quantise::{Numbers, Planes};

use super::algorithm::{Builder, Made};
use super::bvh;
use super::selection::Selection;
use super::structure::StructureKind;
use crate::device::vulkan::Texel;
use crate::error::Result;
use crate::scene::Scene;
use std::sync::Arc;

pub(in crate::workloads::trace) static PAIRS: StructureKind = wide("quantised BVH");
pub(in crate::workloads::trace) static FOUR: StructureKind = wide("BVH4");
pub(in crate::workloads::trace) static EIGHT: StructureKind = wide("BVH8");

const fn wide(name: &'static str) -> StructureKind {
    StructureKind { name, node_texel: Texel::Bytes16, has_cells: false }
}

/// The layout of trees with at most so many children a node.
fn kind(width: usize) -> &'static StructureKind {
    match width {
        2 => &PAIRS,
        4 => &FOUR,
        _ => &EIGHT,
    }
}

/// A BVH whose boxes are quantised.
static QUANTISED: Builder = builder("bvh-quantised", |s, scene| build(s, scene, 2));
static BVH4_BUILDER: Builder = Builder { purpose, ..builder("bvh4", |s, scene| build(s, scene, 4)) };
static BVH8_BUILDER: Builder = Builder { purpose, ..builder("bvh8", |s, scene| build(s, scene, 8)) };

pub(in crate::workloads::trace) const fn builder(
    name: &'static str,
    build: fn(&Selection, &Scene) -> Result<Made>,
) -> Builder {
    Builder {
        name,
        options: bvh::options::OPTIONS,
        parallel: true,
        purpose: |_| "",
        build,
        estimate: None,
        on_device: None,
    }
}

/// Where the children of a node lie.
fn purpose(s: &Selection) -> &'static str {
    if has_octants(s) { "octants" } else { "" }
}

fn has_octants(s: &Selection) -> bool {
    s.find("order") == Some("octant")
}

/// Builds the BVH that the options describe, and collapses it.
pub(in crate::workloads::trace) fn build(s: &Selection, scene: &Scene, width: usize) -> Result<Made> {
    let (bvh, note) = bvh::options::build(s, scene)?;
    Ok(Made { structure: Arc::new(collapse::collapse(bvh, width, has_octants(s))), note })
}
