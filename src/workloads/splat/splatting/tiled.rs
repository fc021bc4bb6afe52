//! The baseline: every tile of the image finds the photons near the box of its samples among all. Twin of
//! `kernels/splat/splatting/tiled.wgsl`. Terms and blocks are those of the reference estimate, and so are all bits.

use super::terms::Terms;
use super::walk::square_distance;
use crate::device::Interrupted;
use crate::error::{Error, Result};
use crate::workloads::size::Size;
use crate::workloads::splat::clusters::{Bounds, Placement};
use crate::workloads::splat::estimate::BLOCK;
use crate::workloads::splat::photons::Photons;
use crate::workloads::splat::samples::Samples;
use crate::workloads::splat::setting::Estimate;
use glam::{Vec3A, Vec4};
use rayon::ThreadPool;
use rayon::prelude::*;

/// Irradiance of each sample per channel; `w` is 0. `tile` is the side of a tile in pixels.
///
/// # Errors
/// [`Error::Interrupted`] between rows of tiles.
pub fn irradiance(
    pool: &ThreadPool,
    samples: &Samples,
    (size, tile): (Size, u32),
    placement: &Placement,
    photons: &Photons,
    estimate: &Estimate,
    interrupted: Interrupted,
) -> Result<Vec<Vec4>> {
    let (terms, reach2) = (Terms::new(estimate), placement.reach2(estimate.radius));
    let (width, side) = (size.width as usize, tile as usize);
    let place = |position: &Vec4| placement.placed(Vec3A::from_vec4(*position));
    let placed: Vec<Vec3A> = pool.install(|| photons.positions.par_iter().map(place).collect());
    let mut all = vec![Vec4::ZERO; samples.positions.len()];
    for (row, out) in all.chunks_mut(width * side).enumerate() {
        if interrupted() {
            return Err(Error::Interrupted);
        }
        let first = row * width * side;
        let of_column = |column: usize| {
            let pixels: Vec<usize> = (0..out.len())
                .filter(|pixel| pixel % width / side == column && samples.positions[first + pixel].w > 0.0)
                .collect();
            let mut bounds = Bounds::EMPTY;
            for pixel in &pixels {
                let point = place(&samples.positions[first + pixel]).into();
                bounds = Bounds { min: bounds.min.min(point), max: bounds.max.max(point) };
            }
            let is_near = |photon: &u32| square_distance(placed[*photon as usize], &bounds) < reach2;
            let blocks: Vec<Vec<u32>> = (0..placed.len() as u32)
                .step_by(BLOCK)
                .map(|first| (first..(first + BLOCK as u32).min(placed.len() as u32)).filter(is_near).collect())
                .collect();
            let sum = |pixel: usize| {
                let (position, normal) =
                    (samples.positions[first + pixel].truncate(), samples.normals[first + pixel].truncate());
                // A block has at most `BLOCK` photons, which are one block of the sum
                blocks.iter().fold(Vec4::ZERO, |sum, block| sum + terms.sum(position, normal, photons, block))
            };
            pixels.into_iter().map(|pixel| (pixel, sum(pixel))).collect::<Vec<_>>()
        };
        let columns: Vec<_> =
            pool.install(|| (0..width.div_ceil(side)).into_par_iter().flat_map_iter(of_column).collect());
        columns.into_iter().for_each(|(pixel, sum)| out[pixel] = sum);
    }
    Ok(all)
}
