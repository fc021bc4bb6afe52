//! The estimate over all photons by a grid of cells, in double precision: for many photons and few samples.
//!
//! A cell's edge is longer than the radius, so that every photon within the radius of a sample lies in the sample's
//! cell or in one of its 26 neighbours.

use super::exact::{self, Exact, Receiver};
use crate::device::Interrupted;
use crate::error::Result;
use crate::workloads::splat::photons::Photons;
use crate::workloads::splat::samples::Samples;
use crate::workloads::splat::setting::Estimate;
use glam::{DVec3, I64Vec3};
use rayon::ThreadPool;
use rayon::prelude::*;
use std::ops::Range;

/// Bits of a cell's number on each axis.
const BITS: u32 = 21;

/// Most cells on an axis that hold photons.
const SIDE: f64 = ((1_u32 << BITS) - 1) as f64;

/// The offsets of a cell's neighbours, the cell itself among them.
pub fn neighbours() -> Vec<I64Vec3> {
    let offset = |n: i64| I64Vec3::new(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    (0..27).map(offset).collect()
}

/// Photons by cells.
pub struct Cells<'a> {
    pool: &'a ThreadPool,
    photons: &'a Photons,
    estimate: Estimate,
    /// The corner of cell 0.
    corner: DVec3,
    /// Of a cell, more than the radius.
    edge: f64,
    /// Numbers of the cells that hold photons, ascending.
    keys: Vec<u64>,
    /// Of the photons of each of these cells in `order`, and their end.
    starts: Vec<u32>,
    /// Indices of photons by cell.
    order: Vec<u32>,
}

impl<'a> Cells<'a> {
    /// Sorts photons into cells; empty slots are left out. The threads, of estimates too, are those of `pool`.
    pub fn new(pool: &'a ThreadPool, photons: &'a Photons, estimate: Estimate) -> Cells<'a> {
        pool.install(|| Cells::sorted(pool, photons, estimate))
    }

    fn sorted(pool: &'a ThreadPool, photons: &'a Photons, estimate: Estimate) -> Cells<'a> {
        let kept = || photons.positions.par_iter().enumerate().filter(|(_, position)| position.w > 0.0);
        let place = |index: usize| photons.positions[index].truncate().as_dvec3();
        let (min, max) = kept()
            .map(|(index, _)| (place(index), place(index)))
            .reduce(|| (DVec3::INFINITY, DVec3::NEG_INFINITY), |a, b| (a.0.min(b.0), a.1.max(b.1)));
        let corner = if min.is_finite() { min } else { DVec3::ZERO };
        // More than the radius, so that what is ambiguous at its end is found too; without photons no side is positive
        let edge =
            (f64::from(estimate.radius) * (1.0 + 2.0 * exact::DOUBT)).max((max - min).max_element() / (SIDE - 1.0));
        let edge = edge.max(f64::MIN_POSITIVE);
        let mut cells =
            Cells { pool, photons, estimate, corner, edge, keys: Vec::new(), starts: Vec::new(), order: Vec::new() };
        let mut placed: Vec<(u64, u32)> =
            kept().filter_map(|(index, _)| Some((key(cells.cell(place(index)))?, index as u32))).collect();
        placed.par_sort_unstable();
        for (at, (key, _)) in placed.iter().enumerate() {
            if cells.keys.last() != Some(key) {
                cells.keys.push(*key);
                cells.starts.push(at as u32);
            }
        }
        cells.starts.push(placed.len() as u32);
        cells.order = placed.into_iter().map(|(_, index)| index).collect();
        cells
    }

    /// The cell of a point.
    fn cell(&self, point: DVec3) -> I64Vec3 {
        ((point - self.corner) / self.edge).floor().as_i64vec3()
    }

    /// The places in `order` of a cell's photons.
    fn photons_of(&self, cell: I64Vec3) -> Range<usize> {
        let found = key(cell).and_then(|key| self.keys.binary_search(&key).ok());
        found.map_or(0..0, |at| self.starts[at] as usize..self.starts[at + 1] as usize)
    }

    /// Irradiance at given pixels, in their order; zero where the camera's ray hits nothing.
    ///
    /// # Errors
    /// [`crate::Error::Interrupted`] between bands of pixels.
    pub fn irradiance(&self, samples: &Samples, pixels: &[u32], interrupted: Interrupted) -> Result<Vec<Exact>> {
        self.irradiance_over(samples, pixels, &neighbours(), interrupted)
    }

    /// The same over some of the neighbours only, so that tests can leave one out.
    ///
    /// # Errors
    /// Those of [`Cells::irradiance`].
    pub fn irradiance_over(
        &self,
        samples: &Samples,
        pixels: &[u32],
        neighbours: &[I64Vec3],
        interrupted: Interrupted,
    ) -> Result<Vec<Exact>> {
        let at = |receiver: &Receiver| {
            let own = self.cell(receiver.position);
            let places = neighbours.iter().flat_map(|&offset| self.photons_of(own.saturating_add(offset)));
            exact::sum(&self.estimate, receiver, self.photons, places.map(|at| self.order[at] as usize))
        };
        exact::at(self.pool, samples, pixels, interrupted, at)
    }
}

/// The number of a cell: nothing outside of the grid.
fn key(cell: I64Vec3) -> Option<u64> {
    let inside = cell.cmpge(I64Vec3::ZERO).all() && cell.cmplt(I64Vec3::splat(1 << BITS)).all();
    inside.then_some((cell.z as u64) << (2 * BITS) | (cell.y as u64) << BITS | cell.x as u64)
}
