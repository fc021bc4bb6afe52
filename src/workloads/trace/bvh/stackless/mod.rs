//! BVHs without a stack: links back to parents, or a trail of one bit a level.

mod layout;
pub mod parent;
pub mod trail;

pub use layout::LinkedBvh;

use crate::device::vulkan::Texel;
use crate::workloads::trace::algorithm::{Algorithm, Builder, Made};
use crate::workloads::trace::bvh::options as bvh_options;
use crate::workloads::trace::options::{Axis, GROUP, Kind, OptionInfo};
use crate::workloads::trace::structure::StructureKind;
use std::sync::Arc;

static KIND: StructureKind =
    StructureKind { name: "BVH with parent links", node_texel: Texel::Bytes16, has_cells: false };

static BUILDER: Builder = Builder {
    name: "bvh-linked",
    options: bvh_options::OPTIONS,
    parallel: true,
    purpose: |_| "",
    build: |s, scene| {
        let (bvh, note) = bvh_options::build(s, scene)?;
        Ok(Made { structure: Arc::new(LinkedBvh::new(bvh)), note })
    },
    estimate: Some(super::estimate),
    on_device: None,
};

/// The tree of `bvh`, walked without a stack.
pub static BVH_STACKLESS: Algorithm = Algorithm {
    name: "bvh-stackless",
    alias: "",
    summary: "the same BVH without a stack: by links to parents, or by a trail with restarts",
    paper: "Hapala et al. 2011; Laine 2010",
    builder: &BUILDER,
    traversal: |s| if s.value("search") == "trail" { &trail::TRAIL } else { &parent::PARENT },
    options: &[SEARCH, GROUP],
};

const SEARCH: OptionInfo = OptionInfo::new(
    Axis::Traversal,
    "search",
    "parent",
    "how the way back is found: links to parents (children in the order of the ray's direction), or restarts from the \
     root with one bit a level (trail)",
    Kind::Word(&["parent", "trail"]),
);
