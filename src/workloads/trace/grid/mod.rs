//! Uniform grid.

pub mod build;
pub(crate) mod check;
pub mod coop;
pub mod dda;
mod estimate;
mod layout;
pub mod octants;
pub mod packet;

pub use layout::{Cell, Grid, GridUniform, plane};

use super::algorithm::{Builder, Made};
use super::options::{Axis, Kind, OptionInfo};
use super::selection::Selection;
use super::structure::StructureKind;
use crate::device::vulkan::Texel;

static KIND: StructureKind = StructureKind { name: "grid", node_texel: Texel::Bytes8, has_cells: true };

static BUILDER: Builder = Builder {
    name: "grid",
    options: OPTIONS,
    parallel: false,
    purpose: |_| "",
    build: |selection, scene| Ok(Made::of(build::build(scene, &config(selection))?)),
    estimate: Some(|selection, scene| estimate::estimate(scene, &config(selection))),
    on_device: None,
};

const CELLS: Kind = Kind::CountOrAuto(1, 1 << 20);

const OPTIONS: &[OptionInfo] = &[
    OptionInfo::new(Axis::Build, "x", "auto", "cells on x; the other axes follow (cubes)", CELLS),
    OptionInfo::new(Axis::Build, "y", "auto", "cells on y", CELLS),
    OptionInfo::new(Axis::Build, "z", "auto", "cells on z", CELLS),
    OptionInfo::new(
        Axis::Build,
        "factor",
        "4",
        "cells on the shortest axis: factor * triangles^(1/4); coarser where that would take excessive memory",
        Kind::Number(0.01, 1000.0),
    )
    .idle_if(cells_are_given),
];

fn cells_are_given(s: &Selection) -> Option<String> {
    let given = ["x", "y", "z"].into_iter().find(|axis| s.count(axis).is_some());
    given.map(|axis| format!("{axis} gives the number of cells"))
}

fn config(selection: &Selection) -> build::Config {
    let resolution = ["x", "y", "z"].map(|axis| selection.count(axis));
    build::Config { resolution, factor: selection.number("factor") }
}

impl Selection {
    /// What the grid is built with, if this is one.
    pub fn grid_config(&self) -> Option<build::Config> {
        (self.info().builder == &BUILDER).then(|| config(self))
    }
}
