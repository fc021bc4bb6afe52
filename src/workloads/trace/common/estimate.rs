//! How much memory a structure will take, before it is built.

use crate::error::Result;
use crate::scene::Scene;
use crate::workloads::trace::{Selection, TriangleRef};

/// An estimate for one structure, in bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// As in `--structure`.
    pub structure: &'static str,
    /// Nodes or cells, and triangle references: what a device must hold in addition to the vertices.
    pub structure_bytes: u64,
    /// As the thesis counts, vertices included.
    pub thesis_bytes: u64,
    /// Both lie between the true values divided and multiplied by this.
    pub factor: f64,
}

/// How far off estimates may be that follow from what is known, and those that are means over scenes.
pub(crate) const CLOSE: f64 = 1.25;
pub(crate) const FAR: f64 = 2.0;

impl Estimate {
    /// An estimate from numbers of nodes and of triangle references. The thesis counts both, as large as they are.
    pub(crate) fn new(
        structure: &'static str,
        factor: f64,
        (nodes, node_bytes): (f64, usize),
        references: f64,
        scene: &Scene,
    ) -> Estimate {
        let structure_bytes = nodes * node_bytes as f64 + references * size_of::<TriangleRef>() as f64;
        let thesis_bytes = structure_bytes + VERTEX * scene.vertices.len() as f64;
        Estimate { structure, structure_bytes: structure_bytes as u64, thesis_bytes: thesis_bytes as u64, factor }
    }
}

/// Bytes of a vertex.
pub(crate) const VERTEX: f64 = 32.0;

/// The estimates for these selections, as far as their builders have one.
///
/// # Errors
/// [`crate::Error::Input`] if one cannot be built so.
pub fn estimates(scene: &Scene, selections: &[Selection]) -> Result<Vec<Estimate>> {
    selections.iter().filter_map(|s| s.info().builder.estimate.map(|estimate| estimate(s, scene))).collect()
}
