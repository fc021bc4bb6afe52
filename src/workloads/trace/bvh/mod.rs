//! Bounding volume hierarchies.

mod bins;
pub mod build;
pub(crate) mod check;
mod clip;
mod cover;
mod layout;
mod lists;
mod options;
pub mod packet;
mod partition;
pub mod ploc;
mod ploc_passes;
pub mod spatial;
mod spatial_bins;
pub mod stack;
pub mod sweep;
mod widened;

pub use layout::{Bvh, BvhNode, DEPTH_LIMIT, MAX_DEPTH, MAX_LEAF, MAX_REFERENCES, SpatialSplits};

use super::algorithm::{Builder, Made};
use super::common::estimate::{CLOSE, Estimate, FAR, VERTEX};
use super::options::{Axis, Kind, OptionInfo};
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
    build: options::build,
    estimate: Some(estimate),
    on_device: Some(options::build_on_device),
};

/// PLOC with reinsertion, by obvhs.
static PLOC: Builder = Builder {
    name: "ploc",
    options: PLOC_OPTIONS,
    parallel: true,
    purpose: |_| "",
    build: build_ploc,
    estimate: None,
    on_device: None,
};

const PLOC_OPTIONS: &[OptionInfo] =
    &[OptionInfo::new(Axis::Build, "preset", "medium", "obvhs's preset", Kind::Word(&ploc::PRESETS))];

fn build_ploc(s: &Selection, scene: &Scene) -> Result<Made> {
    let params = ploc::preset(s.value("preset")).expect("the table lists the presets");
    if let Some(bvh) = ploc::build(scene, params)? {
        return Ok(Made::of(bvh));
    }
    let bvh = build::build(scene, &build::Config::default())?;
    let note =
        "built as bvh: PLOC would take excessive time over so many boxes that are equal, in a row or inside each other";
    Ok(Made { structure: Arc::new(bvh), note: note.to_owned() })
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
