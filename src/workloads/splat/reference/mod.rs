//! What photons and their estimates are checked against.
//!
//! [`path_traced`] computes indirect light from the eye and knows nothing of photons: it has its own generator,
//! directions, hit points, normals and albedos, in double precision. [`exact`] and [`cells`] repeat the estimate over
//! given photons in double precision. [`cache`] keeps results of [`path_traced`] on disk.

pub mod by_direction;
pub mod cache;
pub mod cells;
pub mod exact;
pub mod path_traced;
pub mod pixels;
mod random;
mod surface;

use crate::camera::Camera;
use crate::device::Interrupted;
use crate::error::Result;
use crate::workloads::size::Size;
use crate::workloads::splat::lit::LitScene;
use crate::workloads::trace::backend::Prepared;
use path_traced::{Effort, PathTraced, View};
use rayon::ThreadPool;
use std::path::Path;

/// Indirect light at pixels of an image with the usual effort: what photons of hits 2 to `hits` estimate. With a
/// folder it is read from there, or kept there. With it come warnings about that folder's file. The
/// threads are those of `pool` and the caster's.
///
/// # Errors
/// Those of [`path_traced::trace`].
#[allow(clippy::too_many_arguments)] // what decides a view, and how it is made
pub fn of(
    pool: &ThreadPool,
    caster: &mut dyn Prepared,
    lit: &LitScene,
    camera: &Camera,
    size: Size,
    pixels: &[u32],
    hits: u32,
    folder: Option<&Path>,
    interrupted: Interrupted,
) -> Result<(PathTraced, Vec<String>)> {
    let view = View { lit, camera: *camera, size, pixels, hits };
    match folder {
        Some(folder) => cache::path_traced(pool, folder, caster, &view, Effort::default(), interrupted),
        None => Ok((path_traced::trace(pool, caster, &view, Effort::default(), interrupted)?, Vec::new())),
    }
}
