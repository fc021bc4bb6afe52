//! Compressed wide BVHs: eight children a node of 80 bytes.

mod build;
pub(crate) mod check;
mod encode;
mod layout;
pub mod stack;

pub use build::{by_obvhs, from_bvh};
pub use layout::{CwChild, CwNode, Cwbvh, CwbvhUniform};

use super::algorithm::{Builder, Made};
use super::bvh::{build as binned, ploc, spatial::SpatialConfig, sweep};
use super::options::{Axis, Kind, OptionInfo};
use super::selection::Selection;
use super::structure::StructureKind;
use crate::device::vulkan::Texel;
use crate::error::Result;
use crate::scene::Scene;
use std::sync::Arc;

static KIND: StructureKind = StructureKind { name: "CWBVH", node_texel: Texel::Bytes16, has_cells: false };

static BUILDER: Builder = Builder {
    name: "cwbvh",
    options: OPTIONS,
    parallel: true,
    purpose: |_| "",
    build: |s, scene| {
        let (tree, note) = build(s, scene)?;
        Ok(Made { structure: Arc::new(tree), note })
    },
    estimate: None,
    on_device: None,
};

const PLOC: &str = "ploc";

const OPTIONS: &[OptionInfo] = &[
    OptionInfo::new(
        Axis::Build,
        "build",
        PLOC,
        "obvhs's builder, or a collapse of the BVH of bvh-stack with the same option",
        Kind::Word(&[PLOC, "binned", "sweep", "spatial"]),
    ),
    OptionInfo::new(Axis::Build, "preset", "medium", "obvhs's preset", Kind::Word(&ploc::PRESETS)).idle_if(|s| {
        let build = s.value("build");
        (build != PLOC).then(|| format!("build={build} has no presets"))
    }),
    OptionInfo::new(Axis::Build, "max_leaf", "3", "split until at most so many triangles", Kind::Count(1, 3))
        .idle_if(|s| (s.value("build") == PLOC).then(|| "build=ploc is set by preset".to_owned())),
];

/// The tree that the options describe; with a note where it is another one.
fn build(s: &Selection, scene: &Scene) -> Result<(Cwbvh, String)> {
    let max_leaf = s.size("max_leaf");
    let sweep = |spatial| sweep::build(scene, &sweep::Config { max_leaf, spatial, ..sweep::Config::default() });
    let bvh = match s.value("build") {
        "sweep" => sweep(None)?,
        "spatial" => sweep(Some(SpatialConfig::default()))?,
        "binned" => binned::build(scene, &binned::Config { max_leaf, ..binned::Config::default() })?,
        _ => {
            let params = ploc::preset(s.value("preset")).expect("the table lists the presets");
            if let Some(tree) = by_obvhs(scene, params)? {
                return Ok((tree, String::new()));
            }
            let bvh = binned::build(scene, &binned::Config { max_leaf, ..binned::Config::default() })?;
            let note = "built as build=binned: PLOC would take excessive time, or its tree is too deep";
            return Ok((from_bvh(&bvh), note.to_owned()));
        }
    };
    Ok((from_bvh(&bvh), String::new()))
}
