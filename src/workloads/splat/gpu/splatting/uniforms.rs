//! Structs that kernels and host share. A test compares size and offsets of each with naga's layout of its WGSL twin.

use bytemuck::{Pod, Zeroable};
use glam::Vec4;

/// `PhotonGroupsJob` of `kernels/splat/splatting/photon_groups.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)] // the fields are described in the kernel
pub struct PhotonGroupsJob {
    pub slots: u32,
    pub row_groups: u32,
    pub pad0: u32,
    pub pad1: u32,
}

/// `NeedsJob` of `kernels/splat/splatting/needs.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct NeedsJob {
    pub of_lists: u32,
    pub pad0: u32,
    pub pad1: u32,
    pub pad2: u32,
}

/// `SplatJob` of `kernels/splat/splatting/walk.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct SplatJob {
    pub level_offsets: [u32; 4],
    pub slots: u32,
    pub capacity: u32,
    pub level: u32,
    pub normal_mask: u32,
    pub radius: f32,
    pub radius2: f32,
    pub peak: f32,
    pub one: f32,
    pub facets: [Vec4; 54],
}

/// `ScaleJob` of `kernels/splat/splatting/scale.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct ScaleJob {
    pub slots: u32,
    pub peak: f32,
    pub full: f32,
    pub faintest: f32,
}

/// `GatherJob` of `kernels/splat/splatting/gathered.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct GatherJob {
    pub pixels: u32,
    pub row_groups: u32,
    pub slots: u32,
    pub capacity: u32,
    pub radius2: f32,
    pub peak: f32,
    pub one: f32,
    pub pad: u32,
}

/// `TasksJob` of `kernels/splat/splatting/tasks.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct TasksJob {
    pub pixels: u32,
    pub row_groups: u32,
    pub capacity: u32,
    pub pad: u32,
}

/// `ReadJob` of `kernels/splat/splatting/read_buckets.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct ReadJob {
    pub pixels: u32,
    pub row_groups: u32,
    pub capacity: u32,
    pub shift: u32,
    pub factor: f32,
    pub pad0: u32,
    pub pad1: u32,
    pub pad2: u32,
    pub directions: [Vec4; 54],
}

/// `BlurJob` of `kernels/splat/splatting/blur.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct BlurJob {
    pub width: u32,
    pub height: u32,
    pub row_groups: u32,
    pub reach: u32,
    pub is_vertical: u32,
    pub depths: f32,
    pub one: f32,
    pub pad: u32,
    pub weights: [Vec4; 9],
}

/// `TiledJob` of `kernels/splat/splatting/tiled.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct TiledJob {
    pub tile: u32,
    pub slots: u32,
    pub radius: f32,
    pub radius2: f32,
    pub peak: f32,
    pub one: f32,
    pub pad0: u32,
    pub pad1: u32,
}
