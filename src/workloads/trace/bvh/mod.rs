//! Bounding volume hierarchies.

mod bins;
pub mod build;
pub(crate) mod check;
mod clip;
pub(crate) mod cover;
mod layout;
mod lists;
pub mod loops;
pub(in crate::workloads::trace) mod options;
pub mod packet;
mod partition;
pub mod ploc;
mod ploc_passes;
pub mod spatial;
mod spatial_bins;
pub mod stack;
pub mod stackless;
pub mod sweep;
pub(in crate::workloads::trace) mod widened;

pub use layout::{Bvh, BvhNode, DEPTH_LIMIT, MAX_DEPTH, MAX_LEAF, MAX_REFERENCES, SpatialSplits};

use super::algorithm::{Builder, Made};
use super::common::estimate::{CLOSE, Estimate, FAR, VERTEX};
use super::selection::Selection;
use super::structure::StructureKind;
use crate::device::vulkan::Texel;
use crate::error::Result;
use crate::scene::Scene;
use std::sync::Arc;

static KIND: StructureKind = StructureKind { name: "BVH", node_texel: Texel::Bytes16, has_cells: false };

/// SAH, top down: binned, over all borders between triangles, or with spatial splits.
static TOP_DOWN: Builder = Builder {
    name: "bvh",
    options: options::OPTIONS,
    parallel: true,
    purpose: |_| "",
    build: |s, scene| options::build(s, scene).map(made),
    estimate: Some(estimate),
    on_device: Some(options::build_on_device),
};

/// PLOC with reinsertion, by obvhs.
static PLOC: Builder = Builder {
    name: "ploc",
    options: &[options::PRESET],
    parallel: true,
    purpose: |_| "",
    build: |s, scene| build_ploc(s, scene).map(made),
    estimate: None,
    on_device: None,
};

fn made((bvh, note): (Bvh, String)) -> Made {
    Made { structure: Arc::new(bvh), note }
}

/// PLOC with reinsertion, or another tree and a note that says so.
fn build_ploc(s: &Selection, scene: &Scene) -> Result<(Bvh, String)> {
    let params = ploc::preset(s.value("preset")).expect("the table lists the presets");
    if let Some(bvh) = ploc::build(scene, params)? {
        return Ok((bvh, String::new()));
    }
    let bvh = build::build(scene, &build::Config::default())?;
    let note =
        "built as bvh: PLOC would take excessive time over so many boxes that are equal, in a row or inside each other";
    Ok((bvh, note.to_owned()))
}

/// Nodes per triangle with leaves of at most four: the median over the nine scenes of the thesis (table 5.6).
const NODES: f64 = 0.66;

fn estimate(s: &Selection, scene: &Scene) -> Result<Estimate> {
    let (triangles, vertices) = (scene.triangles.len() as f64, scene.vertices.len() as f64);
    let nodes = triangles * (NODES * 4.0 / s.number("max_leaf")).min(2.0);
    // Nothing tells beforehand how many triangles spatial splits divide
    let factor = if s.value("build") == "spatial" { FAR } else { CLOSE };
    let estimate = Estimate::new("bvh", factor, (nodes, size_of::<BvhNode>()), triangles, scene);
    // The thesis counts 40 bytes a node and no triangle references
    Ok(Estimate { thesis_bytes: (nodes * 40.0 + VERTEX * vertices) as u64, ..estimate })
}
