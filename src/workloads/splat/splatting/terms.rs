//! What one photon adds to the irradiance of one sample. Twin of `kernels/splat/splatting/terms.wgsl`, and of the inner
//! part of `kernels/splat/estimate.wgsl`.

use crate::workloads::splat::photons::Photons;
use crate::workloads::splat::random::flushed;
use crate::workloads::splat::setting::{Estimate, EstimateKernel, Weight};
use glam::{Vec3, Vec4};

/// The terms of an estimate.
#[derive(Clone, Copy, Debug)]
pub struct Terms {
    kernel: EstimateKernel,
    weight: Weight,
    radius2: f32,
    peak: f32,
}

impl Terms {
    /// Those of an estimate.
    pub fn new(estimate: &Estimate) -> Terms {
        let Estimate { kernel, weight, .. } = *estimate;
        Terms { kernel, weight, radius2: estimate.radius2(), peak: estimate.peak() }
    }

    /// The kernel's value at the square of a distance below the radius; `None` beyond.
    pub fn share(&self, square: f32) -> Option<f32> {
        (square < self.radius2).then_some(match self.kernel {
            EstimateKernel::Epanechnikov => self.peak * (1.0 - square / self.radius2),
            EstimateKernel::Constant => self.peak,
        })
    }

    /// Irradiance by a photon at a sample, per channel; `w` is 0.
    pub fn of(&self, position: Vec3, normal: Vec3, photons: &Photons, photon: usize) -> Vec4 {
        let way = photons.positions[photon].truncate() - position;
        let Some(share) = self.share(way.dot(way)) else { return Vec4::ZERO };
        let facing = -normal.dot(photons.directions[photon].truncate());
        if facing <= 0.0 {
            return Vec4::ZERO;
        }
        let weight = match self.weight {
            Weight::Side => 1.0,
            Weight::Cosine => facing,
        };
        flushed(photons.fluxes[photon] * (weight * share))
    }

    /// The sum over photons: those of each block of [`BLOCK`](crate::workloads::splat::estimate::BLOCK) in their
    /// order, then the sums of blocks in theirs.
    pub fn sum(&self, position: Vec3, normal: Vec3, photons: &Photons, list: &[u32]) -> Vec4 {
        let block = |block: &[u32]| {
            let term = |&photon: &u32| self.of(position, normal, photons, photon as usize);
            block.iter().fold(Vec4::ZERO, |sum, photon| sum + term(photon))
        };
        list.chunks(crate::workloads::splat::estimate::BLOCK).fold(Vec4::ZERO, |sum, photons| sum + block(photons))
    }
}
