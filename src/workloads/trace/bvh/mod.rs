//! Bounding volume hierarchies.

mod bins;
pub mod build;
pub(crate) mod check;
mod layout;
pub mod packet;
mod partition;
pub mod ploc;
mod ploc_passes;
pub mod stack;

pub use layout::{Bvh, BvhNode, MAX_DEPTH, MAX_LEAF};

use super::algorithm::{Builder, Made};
use super::common::estimate::{CLOSE, Estimate, VERTEX};
use super::common::sah::CostModel;
use super::options::{Axis, Kind, OptionInfo};
use super::selection::Selection;
use super::structure::StructureKind;
use crate::device::vulkan::Texel;
use crate::error::Result;
use crate::scene::Scene;
use std::sync::Arc;

static KIND: StructureKind = StructureKind { name: "BVH", node_texel: Texel::Bytes16, has_cells: false };

/// Binned SAH, top down.
static BINNED: Builder = Builder {
    name: "bvh",
    options: OPTIONS,
    parallel: true,
    purpose: |_| "",
    build: build_binned,
    estimate: Some(estimate),
};

/// PLOC with reinsertion, by obvhs.
static PLOC: Builder =
    Builder { name: "ploc", options: PLOC_OPTIONS, parallel: true, purpose: |_| "", build: build_ploc, estimate: None };

const OPTIONS: &[OptionInfo] = &[
    OptionInfo::new(Axis::Build, "bins", "16", "bins per axis", Kind::Count(2, 32)),
    OptionInfo::new(Axis::Build, "max_leaf", "4", "split until at most so many triangles", Kind::Count(1, 15)),
    OptionInfo::new(
        Axis::Build,
        "kt",
        "inf",
        "cost of a traversal step: with it, nodes within max_leaf are split, too, where that is cheaper; inf: never",
        Kind::Number(0.0, f64::INFINITY),
    ),
    OptionInfo::new(Axis::Build, "ki", "1", "cost of a triangle test", Kind::Number(1e-6, 1e6)).idle_if(no_costs),
];

fn no_costs(s: &Selection) -> Option<String> {
    (s.value("kt") == "inf").then(|| "costs are compared only with kt".to_owned())
}

const PLOC_OPTIONS: &[OptionInfo] =
    &[OptionInfo::new(Axis::Build, "preset", "medium", "obvhs's preset", Kind::Word(&ploc::PRESETS))];

fn build_binned(s: &Selection, scene: &Scene) -> Result<Made> {
    let cost = CostModel { traversal: s.number("kt"), intersection: s.number("ki") };
    let config = build::Config { bins: s.size("bins"), max_leaf: s.size("max_leaf"), cost };
    Ok(Made::of(build::build(scene, &config)?))
}

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

/// Nodes per triangle: the median over the nine scenes of the thesis (table 5.6).
const NODES: f64 = 0.66;

fn estimate(_: &Selection, scene: &Scene) -> Result<Estimate> {
    let (triangles, vertices) = (scene.triangles.len() as f64, scene.vertices.len() as f64);
    let estimate = Estimate::new("bvh", CLOSE, (NODES * triangles, size_of::<BvhNode>()), triangles, scene);
    // The thesis counts 40 bytes a node and no triangle references
    Ok(Estimate { thesis_bytes: (NODES * triangles * 40.0 + VERTEX * vertices) as u64, ..estimate })
}
