//! Structs that kernels of clusters and host share. A test compares size and offsets of each with naga's layout.

use bytemuck::{Pod, Zeroable};

/// `KeyJob` of `kernels/splat/clusters/keys.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)] // the fields are described in the kernel
pub struct KeyJob {
    pub tile: u32,
    pub columns: u32,
    pub rows: u32,
    pub slices: u32,
}

/// `FillJob` of `kernels/splat/clusters/fill.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct FillJob {
    pub first: u32,
    pub count: u32,
    pub value: u32,
    pub row_groups: u32,
}

/// `UniqueJob` of `kernels/splat/clusters/unique_job.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct UniqueJob {
    pub count: u32,
    pub row_groups: u32,
    pub first_word: u32,
    pub clusters: u32,
}

/// `TileJob` of `kernels/splat/clusters/tile.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct TileJob {
    pub tile: u32,
    pub columns: u32,
    pub tiles: u32,
    pub row_groups: u32,
    pub width: u32,
    pub height: u32,
    pub within: u32,
    pub clusters: u32,
}

/// `CountJob` of `kernels/splat/clusters/count.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct CountJob {
    pub clusters: u32,
    pub row_groups: u32,
    pub pad0: u32,
    pub pad1: u32,
}

/// `NodeJob` of `kernels/splat/clusters/nodes.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct NodeJob {
    pub nodes: u32,
    pub row_groups: u32,
    pub first: u32,
    pub first_child: u32,
    pub first_parent: u32,
    pub clusters: u32,
    pub is_root: u32,
    pub pad: u32,
}
