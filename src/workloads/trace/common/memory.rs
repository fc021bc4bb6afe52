//! The memory model of the thesis of 2009: what it would have counted for a structure, geometry included.
//!
//! It is kept apart from what is really allocated: its BVH has 40 bytes a node where a node has 32, and leaves the
//! triangle references out. Held against all 27 published sizes by `tests/it/thesis/published.rs`.

/// Bytes of a vertex: position and normal, four floats each.
const VERTEX: u64 = 32;
/// Bytes of a triangle reference: three vertices and a material.
const RECORD: u64 = 16;

/// Bytes of a uniform grid: a cell is the first triangle reference and their number.
pub fn grid_bytes(cells: u64, triangle_refs: u64, vertices: u64) -> u64 {
    8 * cells + RECORD * triangle_refs + VERTEX * vertices
}

/// Bytes of a kd-tree; a full binary tree has `2 * leaves - 1` nodes.
pub fn kdtree_bytes(nodes: u64, triangle_refs: u64, vertices: u64) -> u64 {
    8 * nodes + RECORD * triangle_refs + VERTEX * vertices
}

/// Bytes of a BVH.
pub fn bvh_bytes(nodes: u64, vertices: u64) -> u64 {
    40 * nodes + VERTEX * vertices
}
