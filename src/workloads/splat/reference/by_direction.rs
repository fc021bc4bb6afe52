//! The estimate by directions of clusters, by plain loops in double precision: no hierarchy, no lists, no sums that are
//! shared. A cluster is what has equal keys, or equal leading bits of keys.

use super::exact::{DOUBT, Exact};
use crate::device::Interrupted;
use crate::error::{Error, Result};
use crate::workloads::splat::clusters::{Clusters, NONE, Placement};
use crate::workloads::splat::directions::DIRECTIONS;
use crate::workloads::splat::photons::Photons;
use crate::workloads::splat::samples::Samples;
use crate::workloads::splat::setting::{Estimate, EstimateKernel, Form};
use crate::workloads::splat::splatting::setting::{BucketSetting, Share};
use glam::{DVec3, Vec3};
use rayon::ThreadPool;
use rayon::prelude::*;
use std::f64::consts::PI;

/// What photons are summed for.
#[derive(Clone, Copy)]
pub struct Receivers<'a> {
    /// Samples of the image.
    pub samples: &'a Samples,
    /// Their keys and positions.
    pub clusters: &'a Clusters,
    /// The axes of boxes.
    pub placement: &'a Placement,
    /// What arrives.
    pub photons: &'a Photons,
    /// How it is summed.
    pub setting: BucketSetting,
    /// By how much.
    pub estimate: Estimate,
    /// Flux that a whole number counts; 0 where sums are floats.
    pub quantum: f64,
}

/// The unit vector through the centre of a direction's cell, the vectors' largest component being 1 or -1.
fn direction(index: u32) -> DVec3 {
    let (face, cells) = (index / 9, [index / 3 % 3, index % 3]);
    let mut vector = [0.0; 3];
    vector[face as usize / 2] = if face.is_multiple_of(2) { 1.0 } else { -1.0 };
    let others = [[1, 2], [0, 2], [0, 1]][face as usize / 2];
    for (axis, cell) in others.into_iter().zip(cells) {
        vector[axis] = (f64::from(cell) - 1.0) * 2.0 / 3.0;
    }
    DVec3::from_array(vector).normalize()
}

/// The direction whose cell a vector points through, and whether single precision may find another one.
fn cell_of(vector: DVec3) -> (u32, bool) {
    let sizes = vector.abs().to_array();
    let axis = (0..3).fold(0, |best, axis| if sizes[axis] > sizes[best] { axis } else { best });
    let others = [[1, 2], [0, 2], [0, 1]][axis];
    let face = 2 * axis as u32 + u32::from(vector[axis] < 0.0);
    let mut doubtful = others.iter().any(|&other| sizes[axis] - sizes[other] < DOUBT);
    let mut index = 9 * face;
    for (other, factor) in others.into_iter().zip([3, 1]) {
        let place = (vector[other] / sizes[axis] + 1.0) * 1.5;
        doubtful |= [1.0, 2.0].iter().any(|border| (place - border).abs() < DOUBT);
        index += factor * (place as u32).min(2);
    }
    (index, doubtful)
}

impl Receivers<'_> {
    /// Irradiance at a pixel.
    fn at(&self, pixel: usize, directions: &[DVec3]) -> Exact {
        let Receivers { samples, clusters, placement, photons, setting, estimate, .. } = self;
        let mut exact = Exact::default();
        let own = clusters.keys[pixel];
        if own == NONE {
            return exact;
        }
        let shift = 25 - 5 * setting.level.min(5);
        let is_own = |pixel: &usize| clusters.keys[*pixel] != NONE && clusters.keys[*pixel] >> shift == own >> shift;
        let positions = (0..clusters.keys.len()).filter(is_own).map(|pixel| clusters.positions[pixel].truncate());
        let empty = (Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY));
        let (min, max) = positions.fold(empty, |(min, max), position| (min.min(position), max.max(position)));
        let (min, max) = (min.as_dvec3(), max.as_dvec3());
        let (radius, normal) = (f64::from(estimate.radius), samples.normals[pixel].truncate().as_dvec3());
        let reach = radius + f64::from(placement.margin);
        let area = PI * radius * radius;
        let of_kernel = |square: f64| match estimate.kernel {
            EstimateKernel::Epanechnikov => 2.0 * (1.0 - square),
            EstimateKernel::Constant => 1.0,
        };
        // What a unit of a sum adds to irradiance
        let unit = if (setting.share, estimate.form) == (Share::All, Form::Normalised) { 1.0 / area } else { 1.0 };
        for index in 0..photons.len() {
            let way = photons.positions[index].truncate().as_dvec3() - placement.origin.as_dvec3();
            let [x, y, z] = placement.axes.map(|axis| way.dot(axis.as_dvec3()));
            let point = DVec3::new(x, y, z);
            let distance = (point - point.clamp(min, max)).length() / reach;
            if distance >= 1.0 + DOUBT {
                continue;
            }
            let (cell, is_doubtful) = cell_of(-photons.directions[index].truncate().as_dvec3());
            let flux = photons.fluxes[index].truncate().as_dvec3();
            let mut factor = 1.0;
            let mut at_border = distance > 1.0 - DOUBT;
            if setting.share == Share::Centre {
                let square = (point - (min + max) / 2.0).length_squared() / (radius * radius);
                at_border |= (square - 1.0).abs() < 2.0 * DOUBT;
                factor = if square < 1.0 { of_kernel(square) } else { 0.0 };
                if estimate.kernel == EstimateKernel::Epanechnikov && square < 1.0 + DOUBT {
                    // What the roundings of two positions change of the square, twice for the kernel, twice for 2 cos
                    let rounding = point.length().max(min.length()).max(max.length()) / f64::from(1 << 22);
                    let divisor = if estimate.form == Form::Normalised { area } else { 2.0 };
                    exact.ambiguous += flux * (8.0 * square.sqrt() * rounding / radius / divisor);
                }
                if estimate.form == Form::Source && estimate.kernel == EstimateKernel::Epanechnikov {
                    factor /= 2.0;
                }
            }
            if estimate.form == Form::Normalised {
                factor /= area;
            }
            let of_cell = |cell: u32| 2.0 * normal.dot(directions[cell as usize]).max(0.0);
            let share = flux * factor * of_cell(cell);
            if is_doubtful || at_border {
                // Wherever it goes, it adds no more than this
                exact.ambiguous += flux * factor.abs().max(if at_border { 1.0 / area } else { 0.0 }) * 2.0;
            }
            // A rounding of half a unit, times at most 2
            exact.ambiguous += DVec3::splat(self.quantum * unit);
            if distance < 1.0 {
                exact.value += share;
                exact.photons += u32::from(share != DVec3::ZERO);
            }
        }
        exact.blocks = exact.photons;
        exact
    }
}

/// Irradiance at given pixels, in their order. The threads are those of `pool`.
///
/// # Errors
/// [`Error::Interrupted`] between pixels.
pub fn irradiance(
    pool: &ThreadPool,
    receivers: &Receivers,
    pixels: &[u32],
    interrupted: Interrupted,
) -> Result<Vec<Exact>> {
    let directions: Vec<DVec3> = (0..DIRECTIONS).map(direction).collect();
    let mut all = Vec::with_capacity(pixels.len());
    for band in pixels.chunks(64) {
        if interrupted() {
            return Err(Error::Interrupted);
        }
        let of = |&pixel: &u32| receivers.at(pixel as usize, &directions);
        pool.install(|| all.par_extend(band.par_iter().map(of)));
    }
    Ok(all)
}
