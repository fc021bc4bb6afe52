//! How much memory a structure will take, before it is built.

use super::Record;
use super::bvh::BvhNode;
use super::grid::Cell;
use super::grid_build::{self, Layout};
use super::kdtree::KdNode;
use crate::scene::Scene;

/// An estimate for one structure, in bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// As in `--structure`.
    pub structure: &'static str,
    /// Nodes or cells, and records: what a device must hold beside the vertices.
    pub structure_bytes: u64,
    /// By the thesis's accounting, vertices included (SPEC section 7).
    pub thesis_bytes: u64,
}

/// Medians over the nine scenes of the thesis (tables 5.5 and 5.6), per triangle. A scene may be off by a factor of two
/// either way.
const KD_LEAVES: f64 = 1.49;
const KD_REFERENCES: f64 = 5.45;
const BVH_NODES: f64 = 0.66;

/// Estimates for grid, kd-tree and BVH with their default options.
///
/// The grid's cells follow from the builder's own rule and limits. A box with edges e in cells of edge s overlaps on average
/// `(1 + ex / s) (1 + ey / s) (1 + ez / s)` of them, wherever it lies; the sum of that is the estimate of its records.
pub fn estimates(scene: &Scene) -> [Estimate; 3] {
    let triangles = scene.triangles.len() as f64;
    let vertices = 32.0 * scene.vertices.len() as f64;
    let record = size_of::<Record>() as f64;
    let estimate = |structure, nodes: f64, node: usize, thesis_node: f64, records: f64, thesis_records: f64| Estimate {
        structure,
        structure_bytes: (nodes * node as f64 + records * record) as u64,
        thesis_bytes: (nodes * thesis_node + thesis_records * record + vertices) as u64,
    };
    let (cells, references) = grid(scene);
    let (kd_nodes, kd_records) = (2.0 * KD_LEAVES * triangles, KD_REFERENCES * triangles);
    [
        estimate("grid", cells, size_of::<Cell>(), 8.0, references, references),
        estimate("kdtree", kd_nodes, size_of::<KdNode>(), 8.0, kd_records, kd_records),
        // The thesis counts 40 bytes a node and no records
        estimate("bvh", BVH_NODES * triangles, size_of::<BvhNode>(), 40.0, triangles, 0.0),
    ]
}

/// Cells and records of a grid as the builder lays it out, limits included.
fn grid(scene: &Scene) -> (f64, f64) {
    let count = scene.triangles.len() - scene.degenerate_triangles.min(scene.triangles.len());
    let bounds = scene.bounds();
    let mut layout = Layout::by_rule(&bounds, count, grid_build::Config::default().factor);
    loop {
        let edge = f64::from(layout.cell_size);
        let overlapped = |index| {
            let [a, b, c] = scene.corners(index);
            let size = (a.max(b).max(c) - a.min(b).min(c)).as_dvec3().to_array();
            // No more than there are on an axis; a flat scene has one.
            (0..3).map(|axis| (1.0 + size[axis] / edge).min(f64::from(layout.resolution[axis]))).product::<f64>()
        };
        let records: f64 = (0..scene.triangles.len() as u32).map(overlapped).sum();
        if records <= grid_build::record_limit(count).max(scene.triangles.len() as u64) as f64 {
            return (layout.cell_count() as f64, records);
        }
        layout = layout.coarser(&bounds);
    }
}
