//! SAH kd-tree.

mod bins;
pub mod build;
pub(crate) mod check;
mod events;
mod exact;
mod layout;
pub mod search;

pub use layout::{KdNode, KdTree, KdTreeUniform};

use super::algorithm::{Builder, Made};
use super::common::estimate::{Estimate, FAR};
use super::common::sah::CostModel;
use super::options::{Axis, Kind, OptionInfo};
use super::selection::Selection;
use super::structure::StructureKind;
use crate::device::vulkan::Texel;
use crate::error::Result;
use crate::scene::Scene;
use std::sync::Arc;

static KIND: StructureKind = StructureKind { name: "kd-tree", node_texel: Texel::Bytes8, has_cells: false };

static BUILDER: Builder = Builder {
    name: "kdtree",
    options: OPTIONS,
    parallel: true,
    purpose: |_| "",
    build: build_selected,
    estimate: Some(estimate),
};

const OPTIONS: &[OptionInfo] = &[
    OptionInfo::new(Axis::Build, "bins", "32", "bins per axis in the upper levels", Kind::Count(2, 64)),
    OptionInfo::new(
        Axis::Build,
        "spread",
        "content",
        "what the bins divide: the node's cell, or the part of it that triangles occupy, whose borders are candidates as well",
        Kind::Word(&["content", "cell"]),
    ),
    OptionInfo::new(
        Axis::Build,
        "exact_below",
        "129",
        "nodes with fewer triangles are split by the exact sweep",
        Kind::Count(0, 1 << 29),
    ),
    OptionInfo::new(Axis::Build, "kt", "1", "cost of a traversal step", Kind::Number(0.0, 1e6)),
    OptionInfo::new(Axis::Build, "ki", "1", "cost of a triangle test", Kind::Number(1e-6, 1e6)),
    OptionInfo::new(
        Axis::Build,
        "small_leaf",
        "2",
        "largest number of triangles at which a node is always a leaf",
        Kind::Count(0, 1 << 20),
    ),
    OptionInfo::new(
        Axis::Build,
        "max_depth",
        "60",
        "greatest depth, auto is 8 + 1.3 log2(triangles); less where that would take excessive memory",
        Kind::CountOrAuto(0, build::MAX_DEPTH),
    ),
    OptionInfo::new(
        Axis::Build,
        "thin",
        "0.000002",
        "thinnest slice that a split may cut off, as a share of the scene's diagonal",
        Kind::Number(0.0, 1.0),
    ),
];

fn build_selected(s: &Selection, scene: &Scene) -> Result<Made> {
    let config = build::Config {
        bins: s.size("bins"),
        spread: if s.value("spread") == "cell" { build::Spread::Cell } else { build::Spread::Content },
        exact_below: s.size("exact_below"),
        cost: CostModel { traversal: s.number("kt"), intersection: s.number("ki") },
        small_leaf: s.size("small_leaf"),
        max_depth: s.count("max_depth"),
        thin: s.number("thin") as f32,
    };
    let built = build::build(scene, &config)?;
    let note = format!("max_depth={}: a deeper tree would take excessive memory", built.max_depth);
    let note = if built.cut { note } else { String::new() };
    Ok(Made { structure: Arc::new(built.tree), note })
}

/// Per triangle, over the nine scenes of the thesis (tables 5.5 and 5.6): the median of leaves and of references. The
/// latter lie between 1.8 and 6.6; this number is equally far from both. Nothing that is cheap to find out tells
/// beforehand where in between a scene will be: bunny and dragon, both scanned, have 5.4 and 2.1.
const LEAVES: f64 = 1.49;
const REFERENCES: f64 = 3.45;

fn estimate(_: &Selection, scene: &Scene) -> Result<Estimate> {
    let triangles = scene.triangles.len() as f64;
    let nodes = (2.0 * LEAVES * triangles, size_of::<KdNode>());
    Ok(Estimate::new("kdtree", FAR, nodes, REFERENCES * triangles, scene))
}
