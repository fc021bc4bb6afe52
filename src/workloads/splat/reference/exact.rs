//! The estimate over all photons by a plain loop in double precision.

use crate::device::Interrupted;
use crate::error::{Error, Result};
use crate::workloads::splat::estimate::BLOCK;
use crate::workloads::splat::photons::Photons;
use crate::workloads::splat::samples::Samples;
use crate::workloads::splat::setting::{Estimate, EstimateKernel, Form, Weight};
use glam::DVec3;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Pixels between two questions whether to stop.
const BAND: usize = 64;

/// Where an estimate is made.
#[derive(Clone, Copy, Debug)]
pub struct Receiver {
    /// The sample's position.
    pub position: DVec3,
    /// Its unit normal.
    pub normal: DVec3,
}

/// The receiver of a pixel; nothing where the camera's ray hits nothing.
pub fn receiver(samples: &Samples, pixel: u32) -> Option<Receiver> {
    let position = samples.positions[pixel as usize];
    let normal = samples.normals[pixel as usize].truncate().as_dvec3();
    (position.w > 0.0).then(|| Receiver { position: position.truncate().as_dvec3(), normal })
}

/// Irradiance by double precision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exact {
    /// Per channel.
    pub value: DVec3,
    /// What the photons of which single precision may decide otherwise would give or take, per channel: those at a
    /// distance of the radius, or at a right angle to the normal, up to a share of 1e-5.
    pub ambiguous: DVec3,
    /// Photons that add something.
    pub photons: u32,
    /// Blocks of [`BLOCK`] photons that add something, at most.
    pub blocks: u32,
}

impl Exact {
    /// What a sum in single precision, by blocks, may differ by: what is ambiguous, and a rounding of the whole for
    /// each addition that a photon goes through, those in its block and those of blocks.
    pub fn allowance(&self) -> DVec3 {
        let roundings = f64::from(self.photons.min(BLOCK as u32) + self.blocks);
        self.ambiguous + self.value * (roundings / f64::from(1 << 24))
    }
}

/// Of the radius, and of the cosine: where single precision may decide otherwise.
pub(super) const DOUBT: f64 = 1.0e-5;

/// The irradiance that one photon gives a receiver, per channel; `doubtful` gets what may be counted or not.
fn share(estimate: &Estimate, receiver: &Receiver, photons: &Photons, index: usize, doubtful: &mut DVec3) -> DVec3 {
    let radius = f64::from(estimate.radius);
    let way = photons.positions[index].truncate().as_dvec3() - receiver.position;
    let square = way.length_squared() / (radius * radius);
    // An empty slot has no hit number
    if !(square < (1.0 + DOUBT) * (1.0 + DOUBT) && photons.positions[index].w > 0.0) {
        return DVec3::ZERO;
    }
    let cosine = -receiver.normal.dot(photons.directions[index].truncate().as_dvec3());
    if cosine <= -DOUBT {
        return DVec3::ZERO;
    }
    let by_direction = match estimate.weight {
        Weight::Side => 1.0,
        Weight::Cosine => cosine.abs(),
    };
    let by_distance = match estimate.kernel {
        EstimateKernel::Epanechnikov => 2.0 * (1.0 - square).abs(),
        EstimateKernel::Constant => 1.0,
    };
    let divisor = match (estimate.form, estimate.kernel) {
        (Form::Normalised, _) => PI * radius * radius,
        (Form::Source, EstimateKernel::Epanechnikov) => 2.0,
        (Form::Source, EstimateKernel::Constant) => 1.0,
    };
    let share = photons.fluxes[index].truncate().as_dvec3() * (by_direction * by_distance / divisor);
    if square > (1.0 - DOUBT) * (1.0 - DOUBT) || cosine < DOUBT {
        *doubtful += share;
    }
    if square < 1.0 && cosine > 0.0 { share } else { DVec3::ZERO }
}

/// Irradiance at given pixels, in their order; zero where the camera's ray hits nothing. Empty slots are skipped.
/// The threads are those of `pool`.
///
/// # Errors
/// [`Error::Interrupted`] between bands of pixels.
pub fn irradiance(
    pool: &ThreadPool,
    samples: &Samples,
    photons: &Photons,
    estimate: &Estimate,
    pixels: &[u32],
    interrupted: Interrupted,
) -> Result<Vec<Exact>> {
    at(pool, samples, pixels, interrupted, |receiver| sum(estimate, receiver, photons, 0..photons.len()))
}

/// The sum over some photons.
pub(super) fn sum(
    estimate: &Estimate,
    receiver: &Receiver,
    photons: &Photons,
    indices: impl Iterator<Item = usize>,
) -> Exact {
    let mut sum = Exact::default();
    for index in indices {
        let share = share(estimate, receiver, photons, index, &mut sum.ambiguous);
        sum.value += share;
        sum.photons += u32::from(share != DVec3::ZERO);
    }
    sum.blocks = sum.photons.min(photons.len().div_ceil(BLOCK) as u32);
    sum
}

/// What `estimate` gives at each pixel with a sample.
pub(super) fn at(
    pool: &ThreadPool,
    samples: &Samples,
    pixels: &[u32],
    interrupted: Interrupted,
    estimate: impl Fn(&Receiver) -> Exact + Sync,
) -> Result<Vec<Exact>> {
    let mut irradiance = Vec::with_capacity(pixels.len());
    for band in pixels.chunks(BAND) {
        if interrupted() {
            return Err(Error::Interrupted);
        }
        let of = |&pixel: &u32| receiver(samples, pixel).map_or(Exact::default(), |receiver| estimate(&receiver));
        pool.install(|| irradiance.par_extend(band.par_iter().map(of)));
    }
    Ok(irradiance)
}
