//! The picture: direct and indirect light. Twin of `kernels/splat/mix.wgsl`.

use super::samples::Samples;
use glam::Vec4;
use rayon::prelude::*;
use std::f32::consts::FRAC_1_PI;

/// Radiance of each pixel: that of direct light plus albedo / pi x irradiance; `w` is 0.
pub fn picture(samples: &Samples, direct: &[Vec4], irradiance: &[Vec4]) -> Vec<Vec4> {
    let lights = direct.par_iter().zip(irradiance);
    samples.albedos.par_iter().zip(lights).map(|(&albedo, (&direct, &e))| direct + (albedo * FRAC_1_PI) * e).collect()
}
