//! Acceleration structures: what they look like in memory, who builds them, how they are checked.
//!
//! A structure is independent of the traversal that walks it: the same [`bvh::Bvh`] serves the packet and the stack
//! traversal. [`VariantInfo`] names a pair of builder and traversal, which is what a table's row measures.

pub mod brute;
pub mod bvh;
mod bvh_bins;
pub mod bvh_build;
mod bvh_partition;
mod check;
pub mod estimate;
pub mod grid;
pub mod grid_build;
pub mod kdtree;
mod kdtree_bins;
pub mod kdtree_build;
mod kdtree_events;
mod kdtree_exact;
pub mod memory;
pub mod method;
pub mod octants;
pub mod ploc;
mod ploc_passes;
pub mod prims;
mod properties;
mod registry;
pub mod sah;
mod selection;

pub use method::{Method, Traversal};
pub use properties::Properties;
pub use registry::{COMMON_OPTIONS, OptionInfo, VariantInfo, variants};
pub use selection::{Built, Selection};

use crate::math::Aabb;
use bytemuck::{Pod, Zeroable};

/// A triangle as a leaf or cell stores it (SPEC section 1): 16 bytes, contiguous per leaf, repeated where a triangle
/// lies in several leaves. The fourth word is the triangle's index in the scene, so that equal distances are decided
/// by the lower index everywhere; the material is looked up by it, once per shaded hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Record {
    /// Vertex indices.
    pub vertices: [u32; 3],
    /// Index of the triangle in the scene.
    pub triangle: u32,
}

/// All triangles in one run, without any structure: the ground truth for small scenes.
#[derive(Clone, Debug)]
pub struct Brute {
    /// Box around all records.
    pub bounds: Aabb,
    /// One per triangle, in scene order.
    pub records: Vec<Record>,
}

/// Any built structure.
#[derive(Clone, Debug)]
pub enum Structure {
    /// No structure.
    Brute(Brute),
    /// Uniform grid.
    Grid(grid::Grid),
    /// kd-tree.
    KdTree(kdtree::KdTree),
    /// Bounding volume hierarchy.
    Bvh(bvh::Bvh),
}
