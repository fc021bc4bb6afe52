//! Options of the builders that work top down.

use super::spatial::SpatialConfig;
use super::spatial_bins::MAX_SPATIAL_BINS;
use super::{DEPTH_LIMIT, build, sweep};
use crate::error::Result;
use crate::scene::Scene;
use crate::workloads::trace::algorithm::Made;
use crate::workloads::trace::common::sah::CostModel;
use crate::workloads::trace::options::{Axis, Kind, OptionInfo};
use crate::workloads::trace::selection::Selection;

const BINNED: &str = "binned";
const SWEEP: &str = "sweep";
const SPATIAL: &str = "spatial";

pub(super) const OPTIONS: &[OptionInfo] = &[
    OptionInfo::new(
        Axis::Build,
        "build",
        BINNED,
        "splits between bins of centroids, between any two triangles (sweep), or also through triangles (spatial)",
        Kind::Word(&[BINNED, SWEEP, SPATIAL]),
    ),
    OptionInfo::new(Axis::Build, "bins", "16", "bins per axis", Kind::Count(2, 32)).idle_if(is_not_binned),
    OptionInfo::new(Axis::Build, "max_leaf", "4", "split until at most so many triangles", Kind::Count(1, 15)),
    OptionInfo::new(
        Axis::Build,
        "kt",
        "inf",
        "cost of a traversal step: with it, nodes within max_leaf are split, too, where that is cheaper; inf: never",
        Kind::Number(0.0, f64::INFINITY),
    ),
    OptionInfo::new(Axis::Build, "ki", "1", "cost of a triangle test", Kind::Number(1e-6, 1e6)).idle_if(no_costs),
    OptionInfo::new(
        Axis::Build,
        "sorting",
        "once",
        "sort triangles once on each axis, or in every node anew: the same tree",
        Kind::Word(&["once", "every-node"]),
    )
    .idle_if(is_no_sweep),
    OptionInfo::new(
        Axis::Build,
        "axes",
        "all",
        "axes on which splits are looked for: all, or the longest of the node's box",
        Kind::Word(&["all", "longest"]),
    )
    .idle_if(is_binned),
    OptionInfo::new(
        Axis::Build,
        "max_depth",
        "60",
        "greatest depth, near which nodes are halved; stacks are sized by the depth of the tree that was built",
        Kind::Count(1, DEPTH_LIMIT),
    ),
    OptionInfo::new(
        Axis::Build,
        "alpha",
        "0.00001",
        "overlap of a split's sides at which a spatial split is tried, as a share of the root's surface",
        Kind::Number(0.0, 10.0),
    )
    .idle_if(is_not_spatial),
    OptionInfo::new(
        Axis::Build,
        "spatial_bins",
        "32",
        "bins per axis of spatial splits",
        Kind::Count(2, MAX_SPATIAL_BINS as u32),
    )
    .idle_if(is_not_spatial),
    OptionInfo::new(
        Axis::Build,
        "spatial_depth",
        "48",
        "levels from the root on in which spatial splits are tried",
        Kind::Count(0, DEPTH_LIMIT),
    )
    .idle_if(is_not_spatial),
    OptionInfo::new(
        Axis::Build,
        "overlap",
        "above",
        "try spatial splits where the overlap is at least alpha (above), or less (below)",
        Kind::Word(&["above", "below"]),
    )
    .idle_if(is_not_spatial),
];

fn no_costs(s: &Selection) -> Option<String> {
    (s.value("kt") == "inf").then(|| "costs are compared only with kt".to_owned())
}

fn is_binned(s: &Selection) -> Option<String> {
    (s.value("build") == BINNED).then(|| format!("build={BINNED} has bins on all axes"))
}

fn is_not_binned(s: &Selection) -> Option<String> {
    let build = s.value("build");
    let hint = if build == SPATIAL { "; those of spatial splits are spatial_bins" } else { "" };
    (build != BINNED).then(|| format!("build={build} has no bins of centroids{hint}"))
}

fn is_no_sweep(s: &Selection) -> Option<String> {
    let build = s.value("build");
    (build != SWEEP).then(|| format!("build={build} has one way to sort"))
}

fn is_not_spatial(s: &Selection) -> Option<String> {
    let build = s.value("build");
    (build != SPATIAL).then(|| format!("build={build} has no spatial splits"))
}

pub(super) fn build(s: &Selection, scene: &Scene) -> Result<Made> {
    let cost = CostModel { traversal: s.number("kt"), intersection: s.number("ki") };
    let (max_leaf, max_depth) = (s.size("max_leaf"), s.size("max_depth") as u32);
    if s.value("build") == BINNED {
        let config = build::Config { bins: s.size("bins"), max_leaf, cost, max_depth };
        return Ok(Made::of(build::build(scene, &config)?));
    }
    let spatial = (s.value("build") == SPATIAL).then(|| SpatialConfig {
        alpha: s.number("alpha") as f32,
        bins: s.size("spatial_bins"),
        depth: s.size("spatial_depth") as u32,
        below: s.value("overlap") == "below",
    });
    let sorting = if s.value("sorting") == "once" { sweep::Sorting::Once } else { sweep::Sorting::EveryNode };
    let longest_axis = s.value("axes") == "longest";
    let config = sweep::Config { max_leaf, cost, max_depth, sorting, longest_axis, spatial };
    Ok(Made::of(sweep::build(scene, &config)?))
}
