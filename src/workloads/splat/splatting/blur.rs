//! A blur of irradiance that stays on surfaces: a Gaussian along rows, then along columns, whose weights fall with the
//! difference of depths and normals. Twin of `kernels/splat/splatting/blur.wgsl`.

use super::each_pixel;
use super::setting::MAX_BLUR;
use crate::device::Interrupted;
use crate::error::Result;
use crate::workloads::size::Size;
use crate::workloads::splat::random::flushed;
use crate::workloads::splat::samples::Samples;
use glam::Vec4;
use rayon::ThreadPool;

/// The difference of depths, as a share of the depth, from which on a sample has no weight.
pub const DEPTHS: f32 = 0.05;

/// Weights by distance in pixels, of which the first `2 x deviation + 1` are used; 1 at distance 0.
pub fn weights(deviation: u32) -> [f32; WEIGHTS] {
    let weight = |distance: usize| {
        let part = distance as f64 / f64::from(deviation.max(1));
        if distance as u32 <= 2 * deviation { (-0.5 * part * part).exp() as f32 } else { 0.0 }
    };
    std::array::from_fn(weight)
}

/// Weights of the widest blur.
pub const WEIGHTS: usize = 2 * MAX_BLUR as usize + 1;

/// Blurred irradiance; pixels without a sample stay 0. `deviation` is in pixels.
///
/// # Errors
/// [`crate::Error::Interrupted`] between bands of samples.
pub fn blurred(
    pool: &ThreadPool,
    samples: &Samples,
    size: Size,
    irradiance: &[Vec4],
    deviation: u32,
    interrupted: Interrupted,
) -> Result<Vec<Vec4>> {
    let rows = pass(pool, samples, size, (irradiance, deviation), false, interrupted)?;
    pass(pool, samples, size, (&rows, deviation), true, interrupted)
}

fn pass(
    pool: &ThreadPool,
    samples: &Samples,
    Size { width, height }: Size,
    (irradiance, deviation): (&[Vec4], u32),
    is_vertical: bool,
    interrupted: Interrupted,
) -> Result<Vec<Vec4>> {
    let weights = weights(deviation);
    each_pixel(pool, irradiance.len(), interrupted, |pixel| {
        let depth = samples.positions[pixel].w;
        if depth <= 0.0 {
            return Vec4::ZERO;
        }
        let normal = samples.normals[pixel].truncate();
        let (column, row) = (pixel as u32 % width, pixel as u32 / width);
        let (place, end, step) = if is_vertical { (row, height, width) } else { (column, width, 1) };
        let first = place.saturating_sub(2 * deviation);
        let last = (place + 2 * deviation).min(end - 1);
        let (mut sum, mut total) = (Vec4::ZERO, 0.0);
        for other in first..=last {
            let at = (pixel as u32 + other * step - place * step) as usize;
            let far = samples.positions[at].w;
            let near = 1.0 - (depth - far).abs() / (DEPTHS * depth);
            let alike = normal.dot(samples.normals[at].truncate());
            if far > 0.0 && near > 0.0 && alike > 0.0 {
                let square = alike * alike;
                let fourth = square * square;
                let weight = weights[other.abs_diff(place) as usize] * near * (fourth * fourth);
                sum += flushed(irradiance[at] * weight);
                total += weight;
            }
        }
        if total > 0.0 { flushed(sum / total) } else { Vec4::ZERO }
    })
}
