//! Structs that kernels and host share and that have no twin on the CPU. A test compares size and offsets of each with
//! naga's layout of its WGSL twin.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// `Frame` of `kernels/trace/path.wgsl`: one frame, or a part of it.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)] // the fields are described in the kernel
pub struct FrameUniform {
    pub origin: Vec3,
    pub width: u32,
    pub corner: Vec3,
    pub first_row: u32,
    pub right: Vec3,
    pub rows: u32,
    pub down: Vec3,
    pub epsilon: f32,
    pub background: Vec3,
    pub light_count: u32,
    pub first_light: u32,
    pub first_pixel: u32,
    pub first_column: u32,
    pub columns: u32,
    pub height: u32,
    pub shadow_reach: f32,
    pub part: u32,
    pub ambient_reach: f32,
}

/// `Waiting` of `kernels/trace/staged/list.wgsl`: a path that goes on in a mirror.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct WaitingPath {
    pub origin: Vec3,
    pub pixel: u32,
    pub direction: Vec3,
    pub weight: f32,
    pub colour: Vec3,
    pub pad: u32,
}

/// `Length` of `kernels/trace/staged/list.wgsl` for an empty list: no work-groups, one in the other dimensions, no
/// path.
pub const LENGTH: [u32; 4] = [0, 1, 1, 0];

/// Three texels of `kernels/trace/triangles_leaf_order.wgsl`: the corners of a triangle reference.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct LeafTriangle {
    pub a: Vec3,
    /// Index in the scene.
    pub triangle: u32,
    pub b: Vec3,
    pub material: u32,
    pub c: Vec3,
    pub pad: u32,
}

/// `Job` of `kernels/trace/given.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)] // the fields are described in the kernel
pub struct CastJob {
    pub rays: u32,
    pub row_groups: u32,
    pub limit: f32,
    pub pad: u32,
}
