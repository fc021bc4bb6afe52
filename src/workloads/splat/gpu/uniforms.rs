//! Structs that kernels and host share and that have no twin on the CPU. A test compares size and offsets of each with
//! naga's layout of its WGSL twin.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

/// `List` of `kernels/splat/list.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)] // the fields are described in the kernel
pub struct List {
    pub count: u32,
    pub row_groups: u32,
    pub inverse_pi: f32,
    pub pad: u32,
}

/// `EmitJob` of `kernels/splat/emit.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct EmitJob {
    pub seed: u32,
    pub first_path: u32,
    pub paths: u32,
    pub row_groups: u32,
    pub lights: u32,
    pub is_first: u32,
    pub pad0: u32,
    pub pad1: u32,
}

/// `Source` of `kernels/splat/emit.wgsl`: a light and its paths.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct Source {
    pub position: Vec3,
    pub first_path: u32,
    pub path_flux: Vec3,
    pub paths: u32,
}

/// `BounceJob` of `kernels/splat/bounce.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct BounceJob {
    pub seed: u32,
    pub first_path: u32,
    pub paths: u32,
    pub row_groups: u32,
    pub number: u32,
    pub per_path: u32,
    pub epsilon: f32,
    pub divisor: f32,
}

/// `Facet` of `kernels/splat/surface.wgsl`: the corners of a triangle, each with a channel of its albedo as `w`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct Facet {
    pub red: Vec4,
    pub green: Vec4,
    pub blue: Vec4,
}

/// `View` of `kernels/splat/view.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct View {
    pub origin: Vec3,
    pub width: u32,
    pub corner: Vec3,
    pub pixels: u32,
    pub right: Vec3,
    pub row_groups: u32,
    pub down: Vec3,
    pub epsilon: f32,
    pub forward: Vec3,
    pub first_border: u32,
    pub axis_x: Vec3,
    pub height: u32,
    pub axis_y: Vec3,
    pub pad0: u32,
    pub axis_z: Vec3,
    pub pad1: u32,
    pub axes_origin: Vec3,
    pub margin: f32,
}

/// `ShadowJob` of `kernels/splat/shadow.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct ShadowJob {
    pub light: Vec3,
    pub reach: f32,
    pub pixels: u32,
    pub row_groups: u32,
    pub pad0: u32,
    pub pad1: u32,
}

/// `DirectJob` of `kernels/splat/direct.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct DirectJob {
    pub light: Vec3,
    pub pixels: u32,
    pub intensity: Vec3,
    pub row_groups: u32,
    pub influence2: f32,
    pub inverse_pi: f32,
    pub one: f32,
    pub is_first: u32,
}

/// `EstimateJob` of `kernels/splat/estimate.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct EstimateJob {
    pub first_pixel: u32,
    pub end_pixel: u32,
    pub row_groups: u32,
    pub slots: u32,
    pub radius2: f32,
    pub peak: f32,
    pub one: f32,
    pub pad: u32,
}
