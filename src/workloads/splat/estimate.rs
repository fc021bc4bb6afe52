//! The reference estimate of indirect light: every sample over all photons. Twin of `kernels/splat/estimate.wgsl`.

use super::photons::Photons;
use super::random::flushed;
use super::samples::Samples;
use super::setting::{Estimate, EstimateKernel, Form, Weight};
use crate::device::Interrupted;
use crate::error::{Error, Result};
use glam::Vec4;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::f32::consts::PI;

/// Samples that go over the photons together.
const LANES: usize = 8;

/// The number of consecutive photons whose sum is computed before it is added to the sums of the blocks before. A sum
/// of all photons in turn would be off by 6e-4 with 1e5 equal terms. The kernel has a constant of this name.
pub const BLOCK: usize = 256;

/// Groups of samples between two looks at `interrupted`.
const BAND: usize = 512;

impl Estimate {
    /// Square of the radius.
    pub fn radius2(&self) -> f32 {
        self.radius * self.radius
    }

    /// The kernel's value at distance 0.
    pub fn peak(&self) -> f32 {
        match (self.form, self.kernel) {
            (Form::Source, _) => 1.0,
            (_, EstimateKernel::Epanechnikov) => 2.0 / (PI * self.radius2()),
            (_, EstimateKernel::Constant) => 1.0 / (PI * self.radius2()),
        }
    }
}

/// Irradiance of each sample per channel, `w` is 0: the sum over photons nearer than the radius of flux x
/// weight x kernel. The photons of each block of [`BLOCK`] are added in their order, then the sums of blocks in theirs.
/// The threads are those of `pool`.
///
/// # Errors
/// [`Error::Interrupted`] between bands of samples.
pub fn irradiance(
    pool: &ThreadPool,
    samples: &Samples,
    photons: &Photons,
    estimate: &Estimate,
    interrupted: Interrupted,
) -> Result<Vec<Vec4>> {
    let mut all = vec![Vec4::ZERO; samples.positions.len()];
    let groups = samples.positions.chunks(LANES).zip(samples.normals.chunks(LANES)).collect::<Vec<_>>();
    for (groups, out) in groups.chunks(BAND).zip(all.chunks_mut(BAND * LANES)) {
        if interrupted() {
            return Err(Error::Interrupted);
        }
        pool.install(|| {
            groups.par_iter().zip(out.par_chunks_mut(LANES)).for_each(|(&(positions, normals), out)| {
                gather((positions, normals), photons, estimate, out);
            });
        });
    }
    Ok(all)
}

/// Up to [`LANES`] samples over all photons.
fn gather((positions, normals): (&[Vec4], &[Vec4]), photons: &Photons, estimate: &Estimate, out: &mut [Vec4]) {
    let (radius2, peak) = (estimate.radius2(), estimate.peak());
    let of = |axis: usize| -> [f32; LANES] { std::array::from_fn(|lane| positions[lane.min(out.len() - 1)][axis]) };
    let [x, y, z] = [0, 1, 2].map(of);
    for first in (0..photons.len()).step_by(BLOCK) {
        let mut sums = [Vec4::ZERO; LANES];
        for index in first..photons.len().min(first + BLOCK) {
            let photon = photons.positions[index];
            let squares: [f32; LANES] = std::array::from_fn(|lane| {
                let (x, y, z) = (photon.x - x[lane], photon.y - y[lane], photon.z - z[lane]);
                x * x + y * y + z * z
            });
            if !squares.iter().fold(false, |near, &square| near | (square < radius2)) {
                continue;
            }
            let (direction, flux) = (photons.directions[index].truncate(), photons.fluxes[index]);
            for (lane, sum) in sums.iter_mut().enumerate().take(out.len()) {
                // A pixel without a sample has no normal, and nothing faces it
                let facing = -normals[lane].truncate().dot(direction);
                if squares[lane] < radius2 && facing > 0.0 {
                    let weight = match estimate.weight {
                        Weight::Side => 1.0,
                        Weight::Cosine => facing,
                    };
                    let kernel = match estimate.kernel {
                        EstimateKernel::Epanechnikov => peak * (1.0 - squares[lane] / radius2),
                        EstimateKernel::Constant => peak,
                    };
                    *sum += flushed(flux * (weight * kernel));
                }
            }
        }
        for (out, sum) in out.iter_mut().zip(sums) {
            *out += sum;
        }
    }
}
