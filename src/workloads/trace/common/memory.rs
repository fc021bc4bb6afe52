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

/// The memory model of the source `rt2` (a thesis of 2010 that prints no sizes), geometry left out. What is known of
/// it: a BVH node takes three rows of 16 bytes and carries its triangles, a leaf with ropes has a box and six links.
/// A kd-tree node of 8 bytes and triangle numbers of 4 are the field's.
pub mod rt2 {
    /// Bytes of a kd-tree without ropes.
    pub fn kdtree_bytes(leaves: u64, triangle_refs: u64) -> u64 {
        8 * (2 * leaves).saturating_sub(1) + 4 * triangle_refs
    }

    /// Bytes that ropes add: a box and six links for each leaf.
    pub fn ropes_bytes(leaves: u64) -> u64 {
        48 * leaves
    }

    /// Bytes of a BVH, whose nodes carry the triangle numbers of leaves.
    pub fn bvh_bytes(nodes: u64) -> u64 {
        48 * nodes
    }

    /// Bytes of a bounding interval hierarchy: two planes and a word for a node.
    pub fn bih_bytes(nodes: u64, triangle_refs: u64) -> u64 {
        12 * nodes + 4 * triangle_refs
    }
}
