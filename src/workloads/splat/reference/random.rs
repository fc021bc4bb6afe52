//! Random numbers of the reference: splitmix64 (Steele, Lea and Flood 2014), a stream for each path.

use glam::DVec3;
use std::f64::consts::TAU;

/// The finalizer of splitmix64, a bijection of 64-bit words.
pub fn mix(word: u64) -> u64 {
    let word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

/// The golden ratio's part of 2^64, by which the state advances.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// A stream of random numbers.
#[derive(Clone, Copy, Debug)]
pub struct Random(u64);

impl Random {
    /// The stream of a path; equal arguments give equal streams.
    pub fn of(seed: u64, pixel: u32, path: u32) -> Random {
        let place = u64::from(pixel) << 32 | u64::from(path);
        Random(mix(mix(seed.wrapping_add(STEP)) ^ mix(place.wrapping_mul(STEP).wrapping_add(1))))
    }

    /// Uniform, at least 0 and below 1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(STEP);
        (mix(self.0) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A unit vector whose density is proportional to its cosine with `normal`, a unit vector, on that side of it: a
    /// uniform point of the unit disc, by angle and radius, lifted to the hemisphere.
    pub fn around(&mut self, normal: DVec3) -> DVec3 {
        let (square, angle) = (self.unit(), self.unit() * TAU);
        let (tangent, bitangent) = normal.any_orthonormal_pair();
        let (sine, cosine) = angle.sin_cos();
        (tangent * cosine + bitangent * sine) * square.sqrt() + normal * (1.0 - square).sqrt()
    }
}
