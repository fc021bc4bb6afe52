//! Rays from a light to the samples. Twin of `kernels/splat/shadow.wgsl`.

use crate::workloads::splat::samples::Samples;
use crate::workloads::trace::given::TraceRay;
use crate::workloads::trace::path::shadow_start;
use glam::{Vec3, Vec3A, Vec4};
use rayon::prelude::*;

/// For each sample the ray from the light at `light`, or from the point towards it that is `reach` away where the light
/// is farther, to the sample, which is at distance 1. A pixel without a sample has a ray without direction.
pub fn rays(samples: &Samples, light: Vec3, reach: f32) -> Vec<TraceRay> {
    let ray = |sample: &Vec4| {
        if sample.w <= 0.0 {
            return TraceRay::default();
        }
        let point = Vec3A::from_vec4(*sample);
        let start = shadow_start(light.into(), point, reach);
        TraceRay::new(start.into(), (point - start).into())
    };
    samples.positions.par_iter().map(ray).collect()
}
