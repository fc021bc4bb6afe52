//! What a frame's renderers read besides the spheres: computed once on the host, in double precision, and rounded once.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// `View` of `kernels/spheres/scene.wgsl`: 128 bytes. The constants are in it because the shader may have none in its
/// sums: Mesa reorders sums with literals.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct View {
    /// The camera's place.
    pub origin: Vec3,
    /// Least distance of a hit.
    pub epsilon: f32,
    /// From the camera to the image's upper left corner.
    pub corner: Vec3,
    /// Share of the light that a reflection keeps, before the surface's colour.
    pub intensity: f32,
    /// From one pixel to the next one in its row.
    pub right: Vec3,
    /// 0.5: the centre of a pixel.
    pub half: f32,
    /// From one row to the next one below.
    pub down: Vec3,
    /// 1.
    pub one: f32,
    /// Towards the light, of length 1.
    pub light: Vec3,
    /// 2.
    pub two: f32,
    /// The light's colour.
    pub light_color: Vec3,
    /// [`crate::math::T_MAX`]: beyond every hit.
    pub far: f32,
    /// The ambient light's colour.
    pub ambient: Vec3,
    /// Number of spheres.
    pub spheres: u32,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Most rays along a path.
    pub trips: u32,
    /// Unused: 0.
    pub pad: u32,
}
