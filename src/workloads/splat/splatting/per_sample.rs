//! The irradiance of each sample over the photons of its cluster. Twin of `kernels/splat/splatting/per_sample.wgsl`; of
//! `queue.wgsl` too, which adds the same blocks in any order.

use super::Lists;
use super::each_pixel;
use super::terms::Terms;
use crate::device::Interrupted;
use crate::error::Result;
use crate::workloads::splat::clusters::NONE;
use crate::workloads::splat::photons::Photons;
use crate::workloads::splat::samples::Samples;
use crate::workloads::splat::setting::Estimate;
use glam::Vec4;
use rayon::ThreadPool;

/// Irradiance of each sample per channel; `w` is 0. `identifiers` has the cluster of each pixel's sample.
///
/// # Errors
/// [`crate::Error::Interrupted`] between bands of samples.
pub fn irradiance(
    pool: &ThreadPool,
    (samples, identifiers): (&Samples, &[u32]),
    lists: &Lists,
    photons: &Photons,
    estimate: &Estimate,
    interrupted: Interrupted,
) -> Result<Vec<Vec4>> {
    let terms = Terms::new(estimate);
    each_pixel(pool, samples.positions.len(), interrupted, |pixel| match identifiers[pixel] {
        NONE => Vec4::ZERO,
        cluster => {
            let (position, normal) = (samples.positions[pixel].truncate(), samples.normals[pixel].truncate());
            terms.sum(position, normal, photons, lists.of(cluster as usize))
        }
    })
}
