//! SAH kd-tree.

mod bins;
pub mod build;
pub(crate) mod check;
mod cut;
mod events;
mod exact;
mod layout;
mod rope_build;
mod rope_check;
mod rope_layout;
pub mod ropes;
pub mod search;
mod sort;
pub mod stack;

pub use layout::{KdNode, KdTree, KdTreeUniform};
pub use rope_layout::{NO_ROPE, RopeLeaf, RopeTree};

use super::algorithm::{Builder, Made};
use super::common::estimate::{Estimate, FAR};
use super::common::sah::CostModel;
use super::options::{Axis, Kind, OptionInfo};
use super::selection::Selection;
use super::structure::{Structure, StructureKind};
use crate::device::vulkan::Texel;
use crate::error::Result;
use crate::scene::Scene;
use std::sync::Arc;

static KIND: StructureKind = StructureKind { name: "kd-tree", node_texel: Texel::Bytes8, has_cells: false };

static BUILDER: Builder = Builder {
    name: "kdtree",
    options: OPTIONS,
    parallel: true,
    purpose: |s| if has_ropes(s) { "ropes" } else { "" },
    build: build_selected,
    estimate: Some(estimate),
    on_device: None,
};

const OPTIONS: &[OptionInfo] = &[
    OptionInfo::new(
        Axis::Build,
        "build",
        "hybrid",
        "how planes are found: by bins above and the exact sweep below (hybrid), by the exact sweep of sorted boxes \
         (sort), or by bins as long as a node has more triangles than bins (min-max); the last two know no small leaves \
         and no depth",
        Kind::Word(&["hybrid", "sort", "min-max"]),
    ),
    OptionInfo::new(
        Axis::Build,
        "sorting",
        "once",
        "sort the boxes once and filter the lists into the children, or anew in every node: the same tree",
        Kind::Word(&["once", "every-node"]),
    )
    .idle_if(|s| (s.value("build") != "sort").then(|| format!("build={} sorts no large nodes", s.value("build")))),
    OptionInfo::new(Axis::Build, "bins", "32", "bins per axis in the upper levels", Kind::Count(2, 64)).idle_if(no_bins),
    OptionInfo::new(
        Axis::Build,
        "spread",
        "content",
        "what the bins divide: the node's cell, or the part of it that triangles occupy, whose borders are candidates as well",
        Kind::Word(&["content", "cell"]),
    )
    .idle_if(no_bins),
    OptionInfo::new(
        Axis::Build,
        "exact_below",
        "129",
        "nodes with fewer triangles are split by the exact sweep",
        Kind::Count(0, 1 << 29),
    )
    .idle_if(not_hybrid),
    OptionInfo::new(Axis::Build, "kt", "1", "cost of a traversal step", Kind::Number(0.0, 1e6)),
    OptionInfo::new(Axis::Build, "ki", "1", "cost of a triangle test", Kind::Number(1e-6, 1e6)),
    OptionInfo::new(
        Axis::Build,
        "small_leaf",
        "2",
        "largest number of triangles at which a node is always a leaf",
        Kind::Count(0, 1 << 20),
    )
    .idle_if(not_hybrid),
    OptionInfo::new(
        Axis::Build,
        "max_depth",
        "60",
        "greatest depth, auto is 8 + 1.3 log2(triangles); less where that would take excessive memory",
        Kind::CountOrAuto(0, build::MAX_DEPTH),
    )
    .idle_if(not_hybrid),
    OptionInfo::new(
        Axis::Build,
        "thin",
        "0.000002",
        "thinnest slice that a split may cut off, as a share of the scene's diagonal",
        Kind::Number(0.0, 1.0),
    ),
    OptionInfo::new(
        Axis::Build,
        "push",
        "on",
        "let every rope end at the smallest node that covers its face, not at the largest that touches it",
        Kind::Word(&["on", "off"]),
    )
    .idle_if(|s| (!has_ropes(s)).then(|| format!("search={} has no ropes", s.value("search")))),
];

fn has_ropes(s: &Selection) -> bool {
    s.value("search") == "ropes"
}

fn no_bins(s: &Selection) -> Option<String> {
    (s.value("build") == "sort").then(|| "build=sort has no bins".to_owned())
}

fn not_hybrid(s: &Selection) -> Option<String> {
    let build = s.value("build");
    (build != "hybrid").then(|| format!("build={build} has a rule of its own"))
}

/// What is selected. `sort` and `min-max` stop only where no split pays.
fn config(s: &Selection) -> build::Config {
    let hybrid = build::Config {
        method: build::Method::Bins,
        bins: s.size("bins"),
        spread: if s.value("spread") == "cell" { build::Spread::Cell } else { build::Spread::Content },
        exact_below: s.size("exact_below"),
        cost: CostModel { traversal: s.number("kt"), intersection: s.number("ki") },
        small_leaf: s.size("small_leaf"),
        max_depth: s.count("max_depth"),
        thin: s.number("thin") as f32,
    };
    let pure = build::Config { small_leaf: 0, max_depth: Some(build::MAX_DEPTH), ..hybrid };
    let sorting = if s.value("sorting") == "once" { build::Sorting::Once } else { build::Sorting::EveryNode };
    match s.value("build") {
        "sort" => build::Config { method: build::Method::Sweep(sorting), ..pure },
        "min-max" => build::Config { exact_below: hybrid.bins + 1, ..pure },
        _ => hybrid,
    }
}

fn build_selected(s: &Selection, scene: &Scene) -> Result<Made> {
    let built = build::build(scene, &config(s))?;
    let note = if built.cut {
        format!("max_depth={}: a deeper tree would take excessive memory", built.max_depth)
    } else if s.value("build") != "hybrid" && built.tree.depth == build::MAX_DEPTH {
        format!("max_depth={}: no traversal follows a deeper tree", build::MAX_DEPTH)
    } else {
        String::new()
    };
    let structure: Arc<dyn Structure> = match has_ropes(s) {
        true => Arc::new(RopeTree::new(built.tree, s.value("push") == "on")),
        false => Arc::new(built.tree),
    };
    Ok(Made { structure, note })
}

/// Per triangle, over the nine scenes of the thesis (tables 5.5 and 5.6): the median of leaves and of references. The
/// latter lie between 1.8 and 6.6; this number is equally far from both. Nothing that is cheap to find out tells
/// beforehand where in between a scene will be: bunny and dragon, both scanned, have 5.4 and 2.1.
const LEAVES: f64 = 1.49;
const REFERENCES: f64 = 3.45;

fn estimate(s: &Selection, scene: &Scene) -> Result<Estimate> {
    let triangles = scene.triangles.len() as f64;
    let nodes = (2.0 * LEAVES * triangles, size_of::<KdNode>());
    let standard = Estimate::new("kdtree", FAR, nodes, REFERENCES * triangles, scene);
    if !has_ropes(s) {
        return Ok(standard);
    }
    let ropes = LEAVES * triangles * size_of::<RopeLeaf>() as f64;
    // The thesis counts no ropes
    Ok(Estimate { structure_bytes: standard.structure_bytes + ropes as u64, thesis_bytes: 0, ..standard })
}
