//! Spheres in half precision.

use crate::workloads::spheres::scene::PackedSphere;
use bytemuck::{Pod, Zeroable};
use half::f16;

/// `Sphere` of `kernels/spheres/half.wgsl`: 16 bytes, the bits of numbers in half precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct HalfSphere {
    /// Centre.
    pub center: [u16; 3],
    /// Square of the radius, which was rounded to single precision before.
    pub radius2: u16,
    /// Linear RGB.
    pub color: [u16; 3],
    /// Unused: 0.
    pub pad: u16,
}

impl From<&PackedSphere> for HalfSphere {
    fn from(sphere: &PackedSphere) -> HalfSphere {
        let bits = |x: f32| f16::from_f32(x).to_bits();
        HalfSphere {
            center: sphere.center.to_array().map(bits),
            radius2: bits(sphere.radius2),
            color: sphere.color.to_array().map(bits),
            pad: 0,
        }
    }
}
