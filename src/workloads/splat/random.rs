//! Random numbers, and floats without denormal ones. Twin of `kernels/splat/random.wgsl`.

pub use crate::workloads::random::{cosine_direction, pcg4d, unit_vector};

use glam::Vec4;

/// Zero in place of components below the smallest normal float, which some devices flush and others do not.
pub fn flushed(v: Vec4) -> Vec4 {
    Vec4::select(v.cmplt(Vec4::splat(f32::MIN_POSITIVE)), Vec4::ZERO, v)
}
