//! Flux by direction: every photon adds to each cluster that it touches, and a sample sums over the directions of its
//! cluster. Twin of `kernels/splat/splatting/scale.wgsl`, `buckets.wgsl` and `read_buckets.wgsl`.

use super::setting::{Atomics, BucketSetting, Share};
use super::terms::Terms;
use super::walk::{Walk, centre, target_of};
use super::{Buckets, DIRECTIONS, Lists, each_pixel};
use crate::device::Interrupted;
use crate::error::Result;
use crate::workloads::splat::clusters::{Clusters, NONE};
use crate::workloads::splat::directions::{direction, direction_index};
use crate::workloads::splat::estimate::BLOCK;
use crate::workloads::splat::photons::Photons;
use crate::workloads::splat::random::flushed;
use crate::workloads::splat::samples::Samples;
use crate::workloads::splat::setting::{Estimate, Form};
use glam::{Vec3, Vec4};
use rayon::ThreadPool;
use rayon::prelude::*;
use std::f32::consts::PI;

/// Words of a cluster: three channels for each direction, 648 bytes.
pub const WORDS: usize = 3 * DIRECTIONS;

/// Invocations that add up the flux of all photons.
pub const LANES: usize = 256;

/// What the flux of all photons counts as in a word: 2^32 less 0.21 %. No word can overflow: each of up to 2^23 photons
/// rounds up by half a unit at most, 0.1 % together, and the sums of the flux (blocks of 256, at most 128 of them, and
/// eight steps of a tree) round by 392 / 2^24 at most, 0.003 %.
pub const FULL: f32 = 4.29e9 * (1.0 - 1.0 / 1024.0);

/// Smallest flux that words are scaled to; with less, quotients would exceed what a float holds.
pub const FAINTEST: f32 = 2.0e-29;

/// The factor from flux to words: [`FULL`] / the sum of all flux (of its largest channel) x `peak`; 0 without flux.
pub fn scale(photons: &Photons, peak: f32) -> f32 {
    let mut sums = [Vec4::ZERO; LANES];
    for (lane, sum) in sums.iter_mut().enumerate() {
        for first in (lane..photons.len()).step_by(LANES * BLOCK) {
            let block = photons.fluxes[first..].iter().step_by(LANES).take(BLOCK);
            *sum += block.fold(Vec4::ZERO, |sum, flux| sum + flux);
        }
    }
    let mut half = LANES / 2;
    while half > 0 {
        for lane in 0..half {
            sums[lane] += sums[lane + half];
        }
        half /= 2;
    }
    let largest = sums[0].truncate().max_element() * peak;
    if largest > 0.0 { FULL / largest.max(FAINTEST) } else { 0.0 }
}

/// The largest value of the kernel that a photon's flux is multiplied by.
pub fn peak(setting: &BucketSetting, estimate: &Estimate) -> f32 {
    if setting.share == Share::Centre { estimate.peak() } else { 1.0 }
}

/// Sums of the photons of each list, which are those of `walk`.
pub fn fill(
    pool: &ThreadPool,
    walk: &Walk,
    lists: &Lists,
    photons: &Photons,
    setting: &BucketSetting,
    estimate: &Estimate,
) -> Buckets {
    let is_fixed = setting.atomics == Atomics::Fixed;
    let scale = if is_fixed { scale(photons, peak(setting, estimate)) } else { 0.0 };
    let terms = Terms::new(estimate);
    let add = |(target, words): (usize, &mut [u32])| {
        for &photon in lists.of(target) {
            let photon = photon as usize;
            let mut flux = photons.fluxes[photon].truncate();
            if setting.share == Share::Centre {
                let way = walk.placed(photons.positions[photon].truncate()) - centre(&walk.bounds(target as u32));
                let Some(share) = terms.share(way.dot(way)) else { continue };
                flux = flushed((flux * share).extend(0.0)).truncate();
            }
            let from = direction_index(-photons.directions[photon].truncate().to_vec3a());
            for (channel, word) in words[3 * from as usize..][..3].iter_mut().enumerate() {
                *word = match is_fixed {
                    true => word.wrapping_add((flux[channel] * scale + 0.5) as u32),
                    false => (f32::from_bits(*word) + flux[channel]).to_bits(),
                };
            }
        }
    };
    let mut words = vec![0; walk.targets() * WORDS];
    pool.install(|| words.par_chunks_mut(WORDS).enumerate().for_each(add));
    Buckets { scale, words }
}

/// The factor on the sum over directions.
pub fn factor(setting: &BucketSetting, estimate: &Estimate) -> f32 {
    match (estimate.form, setting.share) {
        (Form::Normalised, Share::All) => 1.0 / (PI * estimate.radius2()),
        _ => 1.0,
    }
}

/// Irradiance of each sample per channel by the sums of its cluster; `w` is 0.
///
/// # Errors
/// [`crate::Error::Interrupted`] between bands of samples.
pub fn irradiance(
    pool: &ThreadPool,
    samples: &Samples,
    clusters: &Clusters,
    buckets: &Buckets,
    (setting, estimate): (&BucketSetting, &Estimate),
    interrupted: Interrupted,
) -> Result<Vec<Vec4>> {
    let directions: Vec<Vec3> = (0..DIRECTIONS as u32).map(|index| direction(index).into()).collect();
    let factor = factor(setting, estimate);
    each_pixel(pool, samples.positions.len(), interrupted, |pixel| {
        let identifier = clusters.identifiers[pixel];
        if identifier == NONE {
            return Vec4::ZERO;
        }
        let first = target_of(clusters, setting.level, identifier) * WORDS;
        let Some(words) = buckets.words.get(first..first + WORDS) else { return Vec4::ZERO };
        let normal = samples.normals[pixel].truncate();
        let mut sum = Vec4::ZERO;
        for (direction, words) in directions.iter().zip(words.chunks_exact(3)) {
            let facing = normal.dot(*direction);
            if facing > 0.0 {
                let value = |channel: usize| match setting.atomics {
                    Atomics::Fixed => words[channel] as f32,
                    _ => f32::from_bits(words[channel]),
                };
                sum += flushed(Vec4::new(value(0), value(1), value(2), 0.0) * (2.0 * facing));
            }
        }
        if setting.atomics == Atomics::Fixed {
            if buckets.scale == 0.0 {
                return Vec4::ZERO;
            }
            sum /= buckets.scale;
        }
        flushed(flushed(sum) * factor)
    })
}
