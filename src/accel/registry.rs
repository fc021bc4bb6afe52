//! What `--structure` can name: every pair of builder and traversal, with its options. One row per variant.

use super::selection::Selection;
use super::{Structure, Traversal, brute, bvh_build, grid_build, kdtree_build, ploc};
use crate::error::Result;
use crate::scene::Scene;

/// A variant of `--structure`: a builder, a traversal, and the options of the builder.
#[derive(Debug)]
pub struct VariantInfo {
    /// Name on the command line and in every table.
    pub name: &'static str,
    /// One line for `--help`.
    pub summary: &'static str,
    /// Where it comes from; empty if from nowhere in particular.
    pub paper: &'static str,
    /// What can be set.
    pub options: &'static [OptionInfo],
    /// How it is walked.
    pub traversal: Traversal,
    /// Variants with the same builder and equal options share one built structure.
    pub(super) builder: &'static str,
    /// False for builders that use one thread whatever they are given.
    pub(super) parallel: bool,
    pub(super) build: fn(&Selection, &Scene) -> Result<Structure>,
}

/// An option of a variant.
#[derive(Debug)]
pub struct OptionInfo {
    /// Left of `=`.
    pub key: &'static str,
    /// Its value if it is not given.
    pub default: &'static str,
    /// One line for `--help`.
    pub meaning: &'static str,
    pub(super) kind: Kind,
}

/// What an option's value may be.
#[derive(Debug)]
pub(super) enum Kind {
    /// A whole number from .. to.
    Count(u32, u32),
    /// A whole number from .. to, or `auto`.
    CountOrAuto(u32, u32),
    /// A number from .. to.
    Number(f64, f64),
    /// One of these words.
    Word(&'static [&'static str]),
}

const BVH_OPTIONS: &[OptionInfo] = &[
    OptionInfo { key: "bins", default: "16", meaning: "bins per axis", kind: Kind::Count(2, 32) },
    OptionInfo {
        key: "max_leaf",
        default: "4",
        meaning: "split until at most so many triangles",
        kind: Kind::Count(1, 15),
    },
];

const CELLS: Kind = Kind::CountOrAuto(1, 1 << 20);

const GRID_OPTIONS: &[OptionInfo] = &[
    OptionInfo { key: "x", default: "auto", meaning: "cells on x; the other axes follow (cubes)", kind: CELLS },
    OptionInfo { key: "y", default: "auto", meaning: "cells on y", kind: CELLS },
    OptionInfo { key: "z", default: "auto", meaning: "cells on z", kind: CELLS },
    OptionInfo {
        key: "factor",
        default: "4",
        meaning: "cells on the shortest axis: factor * triangles^(1/4); coarser where that would take excessive memory",
        kind: Kind::Number(0.01, 1000.0),
    },
];

const KD_OPTIONS: &[OptionInfo] = &[
    OptionInfo { key: "bins", default: "32", meaning: "bins per axis in the upper levels", kind: Kind::Count(2, 64) },
    OptionInfo {
        key: "exact_below",
        default: "256",
        meaning: "nodes with fewer triangles are split by the exact sweep",
        kind: Kind::Count(0, 1 << 29),
    },
    OptionInfo { key: "kt", default: "1", meaning: "cost of a traversal step", kind: Kind::Number(0.0, 1e6) },
    OptionInfo { key: "ki", default: "1", meaning: "cost of a triangle test", kind: Kind::Number(1e-6, 1e6) },
    OptionInfo {
        key: "max_depth",
        default: "auto",
        meaning: "greatest depth; auto is 8 + 1.3 log2(triangles)",
        kind: Kind::CountOrAuto(0, kdtree_build::MAX_DEPTH),
    },
];

/// All variants, in the order of tables.
pub fn variants() -> &'static [VariantInfo] {
    const VARIANTS: &[VariantInfo] = &[
        VariantInfo {
            name: "grid",
            summary: "uniform grid, walked by a 3D-DDA",
            paper: "Fujimoto et al. 1986; Amanatides and Woo 1987",
            options: GRID_OPTIONS,
            traversal: Traversal::Grid,
            builder: "grid",
            parallel: false,
            build: build_grid,
        },
        VariantInfo {
            name: "kdtree",
            summary: "SAH kd-tree, short stack of four with pushdown and restart",
            paper: "Shevtsov et al. 2007; Wald and Havran 2006; Horn et al. 2007",
            options: KD_OPTIONS,
            traversal: Traversal::KdTree,
            builder: "kdtree",
            parallel: true,
            build: build_kdtree,
        },
        VariantInfo {
            name: "bvh",
            summary: "binned SAH BVH, packets of 8x8 rays with one shared stack",
            paper: "Günther et al. 2007",
            options: BVH_OPTIONS,
            traversal: Traversal::Bvh,
            builder: "bvh",
            parallel: true,
            build: build_bvh,
        },
        VariantInfo {
            name: "bvh-stack",
            summary: "the same BVH, one ray per thread with a stack of its own",
            paper: "Aila and Laine 2009",
            options: BVH_OPTIONS,
            traversal: Traversal::BvhStack,
            builder: "bvh",
            parallel: true,
            build: build_bvh,
        },
        VariantInfo {
            name: "ploc-stack",
            summary: "BVH built by obvhs (PLOC with reinsertion), one ray per thread with a stack of its own",
            paper: "Meister and Bittner 2018",
            options: &[OptionInfo {
                key: "preset",
                default: "medium",
                meaning: "obvhs's preset",
                kind: Kind::Word(&ploc::PRESETS),
            }],
            traversal: Traversal::BvhStack,
            builder: "ploc",
            parallel: true,
            build: build_ploc,
        },
        VariantInfo {
            name: "brute",
            summary: "no structure: every ray against every triangle (ground truth for small scenes)",
            paper: "",
            options: &[],
            traversal: Traversal::Brute,
            builder: "brute",
            parallel: true,
            build: |_, scene| brute::build(scene).map(Structure::Brute),
        },
    ];
    VARIANTS
}

fn build_grid(s: &Selection, scene: &Scene) -> Result<Structure> {
    let resolution = [s.count("x"), s.count("y"), s.count("z")];
    let config = grid_build::Config { resolution, factor: s.number("factor") };
    grid_build::build(scene, &config).map(Structure::Grid)
}

fn build_kdtree(s: &Selection, scene: &Scene) -> Result<Structure> {
    let config = kdtree_build::Config {
        bins: s.size("bins"),
        exact_below: s.size("exact_below"),
        cost: super::sah::CostModel { traversal: s.number("kt"), intersection: s.number("ki") },
        max_depth: s.count("max_depth"),
    };
    kdtree_build::build(scene, &config).map(Structure::KdTree)
}

fn build_bvh(s: &Selection, scene: &Scene) -> Result<Structure> {
    let config = bvh_build::Config { bins: s.size("bins"), max_leaf: s.size("max_leaf") };
    bvh_build::build(scene, &config).map(Structure::Bvh)
}

fn build_ploc(s: &Selection, scene: &Scene) -> Result<Structure> {
    let params = ploc::preset(s.value("preset")).expect("the table lists the presets");
    ploc::build(scene, params).map(Structure::Bvh)
}

impl Kind {
    /// The value in its one spelling, or what would be one.
    pub(super) fn parse(&self, value: &str) -> Result<String, String> {
        let count = |from: u32, to: u32| {
            let n = value.parse::<u32>().ok().filter(|n| (from..=to).contains(n));
            n.map(|n| n.to_string())
        };
        match *self {
            Kind::Count(from, to) => count(from, to).ok_or(format!("a whole number from {from} to {to}")),
            Kind::CountOrAuto(..) if value == "auto" => Ok(value.to_owned()),
            Kind::CountOrAuto(from, to) => {
                count(from, to).ok_or(format!("'auto' or a whole number from {from} to {to}"))
            }
            Kind::Number(from, to) => {
                let n = value.parse::<f64>().ok().filter(|n| (from..=to).contains(n));
                n.map(|n| n.to_string()).ok_or(format!("a number from {from} to {to}"))
            }
            Kind::Word(words) if words.contains(&value) => Ok(value.to_owned()),
            Kind::Word(words) => Err(format!("one of {}", words.join(", "))),
        }
    }
}
