//! Photons on their way to clusters and samples: lists of photons, sums by direction, and the estimates from both.

pub mod blur;
pub mod buckets;
pub mod counts;
pub mod facets;
pub mod lists;
pub mod per_sample;
pub mod setting;
pub mod terms;
pub mod tiled;
pub mod verify;
pub mod walk;

use crate::device::Interrupted;
use crate::error::{Error, Result};
use glam::Vec4;
use rayon::ThreadPool;
use rayon::prelude::*;

/// The photons of each cluster.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lists {
    /// Where the list of each cluster begins; one more for the end of the last.
    pub offsets: Vec<u32>,
    /// Indices of photons, cluster by cluster.
    pub entries: Vec<u32>,
}

/// Directions of a bucket: six faces of a cube with 3 x 3 cells each.
pub const DIRECTIONS: usize = 54;

/// Radiant flux by direction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Buckets {
    /// What a word counts as flux: flux = word / scale. 0 where words are floats.
    pub scale: f32,
    /// Three words (red, green, blue) for each of the directions of each cluster: whole numbers, or the bits of floats.
    pub words: Vec<u32>,
}

/// Pixels between two looks at `interrupted`.
const BAND: usize = 4096;

/// Computes a value for each pixel.
fn each_pixel(
    pool: &ThreadPool,
    pixels: usize,
    interrupted: Interrupted,
    value: impl Fn(usize) -> Vec4 + Sync,
) -> Result<Vec<Vec4>> {
    let mut all = vec![Vec4::ZERO; pixels];
    for (band, out) in all.chunks_mut(BAND).enumerate() {
        if interrupted() {
            return Err(Error::Interrupted);
        }
        pool.install(|| {
            out.par_iter_mut().enumerate().for_each(|(pixel, out)| *out = value(band * BAND + pixel));
        });
    }
    Ok(all)
}
