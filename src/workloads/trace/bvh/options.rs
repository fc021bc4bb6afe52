//! Options of the builders that work top down.

use super::spatial::SpatialConfig;
use super::spatial_bins::MAX_SPATIAL_BINS;
use super::{Bvh, DEPTH_LIMIT, build, build_ploc, ploc, sweep};
use crate::device::{Interrupted, VulkanDevice};
use crate::error::Result;
use crate::scene::Scene;
use crate::workloads::trace::algorithm::Made;
use crate::workloads::trace::build::gpu::{self, BuildTimes};
use crate::workloads::trace::build::{lbvh, ploc as clusters};
use crate::workloads::trace::common::sah::CostModel;
use crate::workloads::trace::options::{Axis, Kind, OptionInfo};
use crate::workloads::trace::selection::Selection;

const BINNED: &str = "binned";
const SWEEP: &str = "sweep";
const SPATIAL: &str = "spatial";
const PLOC: &str = "ploc";
const LBVH: &str = "lbvh";
const PLOC_PASSES: &str = "ploc-passes";

pub(in crate::workloads::trace) const OPTIONS: &[OptionInfo] = &[
    OptionInfo::new(
        Axis::Build,
        "build",
        BINNED,
        "splits between bins of centroids, between any two triangles (sweep), or also through triangles (spatial); \
         obvhs's clustering (ploc); in passes on the device: by the bits of Morton codes (lbvh), or by merging neighbours \
         (ploc-passes)",
        Kind::Word(&[BINNED, SWEEP, SPATIAL, PLOC, LBVH, PLOC_PASSES]),
    ),
    OptionInfo::new(Axis::Build, "bins", "16", "bins per axis", Kind::Count(2, 32)).idle_if(is_not_binned),
    OptionInfo::new(Axis::Build, "max_leaf", "4", "split until at most so many triangles", Kind::Count(1, 15))
        .idle_if(has_preset),
    OptionInfo::new(
        Axis::Build,
        "kt",
        "inf",
        "cost of a traversal step: with it, nodes within max_leaf are split, too, where that is cheaper; inf: never",
        Kind::Number(0.0, f64::INFINITY),
    )
    .idle_if(has_no_splits),
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
    .idle_if(has_no_choice_of_axes),
    OptionInfo::new(
        Axis::Build,
        "max_depth",
        "60",
        "greatest depth, near which nodes are halved; stacks are sized by the depth of the tree that was built",
        Kind::Count(1, DEPTH_LIMIT),
    )
    .idle_if(has_no_splits),
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
    OptionInfo::new(
        Axis::Build,
        "radius",
        "16",
        "places on the Morton curve within which a cluster looks for its best partner",
        Kind::Count(1, 64),
    )
    .idle_if(is_no_clustering),
    PRESET.idle_if(has_no_preset),
];

pub(super) const PRESET: OptionInfo =
    OptionInfo::new(Axis::Build, "preset", "medium", "obvhs's preset", Kind::Word(&ploc::PRESETS));

fn has_preset(s: &Selection) -> Option<String> {
    (s.value("build") == PLOC).then(|| format!("build={PLOC} is set by preset"))
}

fn has_no_preset(s: &Selection) -> Option<String> {
    let build = s.value("build");
    (build != PLOC).then(|| format!("build={build} has no presets"))
}

fn no_costs(s: &Selection) -> Option<String> {
    (s.value("kt") == "inf").then(|| "costs are compared only with kt".to_owned())
}

/// True for builders that work in passes over all triangles, on a device or by their twins.
fn works_in_passes(s: &Selection) -> bool {
    [LBVH, PLOC_PASSES].contains(&s.value("build"))
}

fn has_no_splits(s: &Selection) -> Option<String> {
    let is_clustered = works_in_passes(s) || s.value("build") == PLOC;
    is_clustered.then(|| format!("build={} looks for no splits", s.value("build")))
}

fn is_no_clustering(s: &Selection) -> Option<String> {
    let build = s.value("build");
    (build != PLOC_PASSES).then(|| format!("only build={PLOC_PASSES} has it"))
}

fn clustering(s: &Selection) -> clusters::Config {
    clusters::Config { radius: s.size("radius") as u32, max_leaf: s.size("max_leaf") as u32 }
}

fn has_no_choice_of_axes(s: &Selection) -> Option<String> {
    let is_binned = s.value("build") == BINNED;
    is_binned.then(|| format!("build={BINNED} has bins on all axes")).or_else(|| has_no_splits(s))
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

/// The BVH that the options describe; with a note where it is another one.
pub(in crate::workloads::trace) fn build(s: &Selection, scene: &Scene) -> Result<(Bvh, String)> {
    if s.value("build") == PLOC {
        return build_ploc(s, scene);
    }
    let cost = CostModel { traversal: s.number("kt"), intersection: s.number("ki") };
    let (max_leaf, max_depth) = (s.size("max_leaf"), s.size("max_depth") as u32);
    match s.value("build") {
        LBVH => return Ok((lbvh::build(scene, max_leaf as u32)?, String::new())),
        PLOC_PASSES => return Ok((clusters::build(scene, &clustering(s))?, String::new())),
        _ => {}
    }
    if s.value("build") == BINNED {
        let config = build::Config { bins: s.size("bins"), max_leaf, cost, max_depth };
        return Ok((build::build(scene, &config)?, String::new()));
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
    Ok((sweep::build(scene, &config)?, String::new()))
}

/// Builds on a device what is built in passes.
pub(super) fn build_on_device(
    s: &Selection,
    scene: &Scene,
    device: &VulkanDevice,
    interrupted: Interrupted,
) -> Result<Option<(Made, BuildTimes)>> {
    let (bvh, times) = match s.value("build") {
        LBVH => gpu::lbvh::build(device, scene, s.size("max_leaf") as u32, interrupted)?,
        PLOC_PASSES => gpu::ploc::build(device, scene, &clustering(s), interrupted)?,
        _ => return Ok(None),
    };
    Ok(Some((Made::of(bvh), times)))
}
