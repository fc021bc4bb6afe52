//! Rays that leave the lights, uniform over all directions. Twin of `kernels/splat/emit.wgsl`.

use super::lit::{LightShare, LitScene};
use super::random::unit_vector;
use super::setting::Setting;
use crate::workloads::trace::given::TraceRay;
use glam::Vec4;
use rayon::prelude::*;

/// The first ray of each path, and the flux that it carries per channel; `w` is 0.
pub fn rays(lit: &LitScene, shares: &[LightShare], setting: &Setting) -> (Vec<TraceRay>, Vec<Vec4>) {
    let ray = |path: u32| {
        let next = shares.partition_point(|share| share.first_path <= path);
        let share = &shares[next - 1];
        let direction = unit_vector(setting.seed, path, 0);
        (TraceRay::new(lit.lights[share.light].position, direction.into()), share.path_flux.extend(0.0))
    };
    (0..setting.paths).into_par_iter().map(ray).unzip()
}
