//! How much memory a grid will take, before it is built.

use super::Cell;
use super::build::{self, Layout};
use crate::error::Result;
use crate::scene::Scene;
use crate::workloads::trace::common::estimate::{CLOSE, Estimate};

/// The estimate for a grid with these options.
///
/// The grid's cells follow from the builder's own rule and limits. A box with edges e in cells of edge s overlaps on
/// average `(1 + ex / s) (1 + ey / s) (1 + ez / s)` of them, wherever it lies; the sum of that is the estimate of its
/// triangle references.
///
/// # Errors
/// [`crate::Error::Input`] if the grid cannot be built so.
pub(super) fn estimate(scene: &Scene, config: &build::Config) -> Result<Estimate> {
    let (cells, references) = cells_and_references(scene, config)?;
    Ok(Estimate::new("grid", CLOSE, (cells, size_of::<Cell>()), references, scene))
}

/// Cells and triangle references of a grid as the builder lays it out, limits included.
fn cells_and_references(scene: &Scene, config: &build::Config) -> Result<(f64, f64)> {
    let count = scene.triangles.len() - scene.degenerate_triangles.min(scene.triangles.len());
    let bounds = scene.bounds();
    let (mut layout, by_hand) = Layout::first(scene, config, count, &bounds)?;
    loop {
        let edge = f64::from(layout.cell_size);
        let overlapped = |index| {
            let [a, b, c] = scene.corners(index);
            let size = (a.max(b).max(c) - a.min(b).min(c)).as_dvec3().to_array();
            // No more than there are on an axis; a flat scene has one.
            (0..3).map(|axis| (1.0 + size[axis] / edge).min(f64::from(layout.resolution[axis]))).product::<f64>()
        };
        let triangle_refs: f64 = (0..scene.triangles.len() as u32).map(overlapped).sum();
        if by_hand || triangle_refs <= build::triangle_ref_limit(count).max(scene.triangles.len() as u64) as f64 {
            return Ok((layout.cell_count() as f64, triangle_refs));
        }
        layout = layout.coarser(&bounds);
    }
}
