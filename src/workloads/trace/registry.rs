//! What `--structure` can name: every pair of builder and traversal, with its options. One row per variant.

use crate::error::Result;
use crate::scene::Scene;
use crate::workloads::trace::bvh::ploc;
use crate::workloads::trace::common::sah::CostModel;
use crate::workloads::trace::kdtree::build::Spread;
use crate::workloads::trace::method::{KdSearch, MAX_SHORT_STACK, Vote};
use crate::workloads::trace::selection::Selection;
use crate::workloads::trace::{Structure, Traversal};
use crate::workloads::trace::{brute, bvh, grid, kdtree};

/// A variant of `--structure`: a builder, a traversal, and the options of the builder.
#[derive(Debug)]
pub struct VariantInfo {
    /// Name on the command line and in every table.
    pub name: &'static str,
    /// Another name that it is known by; empty if it has none.
    pub alias: &'static str,
    /// One line for `--help`.
    pub summary: &'static str,
    /// Where it comes from; empty if from nowhere in particular.
    pub paper: &'static str,
    /// What can be set about what is built.
    pub build_options: &'static [OptionInfo],
    /// What can be set about how it is walked, beside [`COMMON_OPTIONS`].
    pub walk_options: &'static [OptionInfo],
    /// How it is walked.
    pub(crate) traversal: fn(&Selection) -> Traversal,
    /// Variants with the same builder and equal options share one built structure.
    pub(crate) builder: &'static str,
    /// False for builders that use one thread whatever they are given.
    pub(crate) parallel: bool,
    pub(crate) build: fn(&Selection, &Scene) -> Result<Made>,
}

/// What a builder makes.
pub(crate) struct Made {
    pub structure: Structure,
    /// How it was built where not as selected; empty otherwise.
    pub note: String,
}

impl From<Structure> for Made {
    fn from(structure: Structure) -> Made {
        Made { structure, note: String::new() }
    }
}

impl VariantInfo {
    /// All options, in the order of tables: the builder's, the traversal's, and those that all have.
    pub fn options(&self) -> impl Iterator<Item = &'static OptionInfo> {
        self.build_options.iter().chain(self.walk_options).chain(COMMON_OPTIONS)
    }
}

/// An option of a variant.
#[derive(Clone, Copy, Debug)]
pub struct OptionInfo {
    /// Left of `=`.
    pub key: &'static str,
    /// Its value if it is not given.
    pub default: &'static str,
    /// One line for `--help`.
    pub meaning: &'static str,
    pub(crate) kind: Kind,
}

impl OptionInfo {
    /// What its value may be, in words: a list, or a range.
    pub fn values(&self) -> String {
        match self.kind {
            Kind::Count(from, to) => format!("{from} to {to}"),
            Kind::CountOrAuto(from, to) => format!("auto, or {from} to {to}"),
            Kind::Number(from, to) => format!("a number from {from} to {to}"),
            Kind::Word(words) => words.join(", "),
        }
    }
}

/// What an option's value may be.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
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
    OptionInfo {
        key: "kt",
        default: "inf",
        meaning: "cost of a traversal step: with it, nodes within max_leaf are split, too, where that is cheaper; inf: never",
        kind: Kind::Number(0.0, f64::INFINITY),
    },
    OptionInfo { key: "ki", default: "1", meaning: "cost of a triangle test", kind: Kind::Number(1e-6, 1e6) },
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
        key: "spread",
        default: "content",
        meaning: "what the bins divide: the node's cell, or the part of it that triangles occupy, whose borders are candidates as well",
        kind: Kind::Word(&["content", "cell"]),
    },
    OptionInfo {
        key: "exact_below",
        default: "129",
        meaning: "nodes with fewer triangles are split by the exact sweep",
        kind: Kind::Count(0, 1 << 29),
    },
    OptionInfo { key: "kt", default: "1", meaning: "cost of a traversal step", kind: Kind::Number(0.0, 1e6) },
    OptionInfo { key: "ki", default: "1", meaning: "cost of a triangle test", kind: Kind::Number(1e-6, 1e6) },
    OptionInfo {
        key: "small_leaf",
        default: "2",
        meaning: "largest number of triangles at which a node is always a leaf",
        kind: Kind::Count(0, 1 << 20),
    },
    OptionInfo {
        key: "max_depth",
        default: "60",
        meaning: "greatest depth, auto is 8 + 1.3 log2(triangles); less where that would take excessive memory",
        kind: Kind::CountOrAuto(0, kdtree::build::MAX_DEPTH),
    },
    OptionInfo {
        key: "thin",
        default: "0.000002",
        meaning: "thinnest slice that a split may cut off, as a share of the scene's diagonal",
        kind: Kind::Number(0.0, 1.0),
    },
];

const KD_WALK: &[OptionInfo] = &[
    OptionInfo {
        key: "search",
        default: "short-stack",
        meaning: "after a leaf: restart at the root, at the deepest node without a branch above (pushdown), or pop from a \
                  short stack and push down",
        kind: Kind::Word(&["restart", "pushdown", "short-stack"]),
    },
    OptionInfo {
        key: "stack",
        default: "4",
        meaning: "entries of the short stack",
        kind: Kind::Count(1, MAX_SHORT_STACK),
    },
    OptionInfo {
        key: "memory",
        default: "workgroup",
        meaning: "where the short stack lies",
        kind: Kind::Word(&["workgroup", "private"]),
    },
];

const VOTE: OptionInfo = OptionInfo {
    key: "vote",
    default: "corrected",
    meaning: "who votes on the order of children: rays that want one (corrected), or all (original)",
    kind: Kind::Word(&["corrected", "original"]),
};

/// Shapes of a work-group that a packet can have, which shares bits of one word.
const PACKET: OptionInfo = OptionInfo {
    key: "packet",
    default: "8x8",
    meaning: "pixels of a packet, which is a work-group",
    kind: Kind::Word(&["8x8", "8x4", "4x8", "4x4", "16x4", "4x16"]),
};

const GROUP: OptionInfo = OptionInfo {
    key: "group",
    default: "8x8",
    meaning: "pixels of a work-group",
    kind: Kind::Word(&["8x8", "4x4", "8x4", "4x8", "16x4", "4x16", "32x1", "64x1", "16x8", "16x16", "32x8"]),
};

/// Options that every variant has, after its own.
pub const COMMON_OPTIONS: &[OptionInfo] = &[
    OptionInfo {
        key: "shadows",
        default: "from-light",
        meaning: "direction of shadow rays",
        kind: Kind::Word(&["from-light", "to-light"]),
    },
    OptionInfo {
        key: "tiles",
        default: "1",
        meaning: "render the image in N x N tiles one after another",
        kind: Kind::Count(1, 64),
    },
    OptionInfo {
        key: "pattern",
        default: "image",
        meaning: "primary rays: the camera's, or only four different ones, one per work-group",
        kind: Kind::Word(&["image", "four"]),
    },
    OptionInfo {
        key: "intersect",
        default: "watertight",
        meaning: "ray/triangle test: watertight, or the one of Möller and Trumbore, which loses rays at edges",
        kind: Kind::Word(&["watertight", "moller-trumbore"]),
    },
    OptionInfo {
        key: "checks",
        default: "off",
        meaning: "compile the kernel with bounds checks and loop bounds",
        kind: Kind::Word(&["off", "on"]),
    },
    OptionInfo {
        key: "fetch",
        default: "auto",
        meaning: "read scene and structure from storage buffers or textures (auto: buffers, on software drivers textures)",
        kind: Kind::Word(&["auto", "buffers", "textures"]),
    },
];

/// All variants, in the order of tables.
pub fn variants() -> &'static [VariantInfo] {
    const VARIANTS: &[VariantInfo] = &[
        VariantInfo {
            name: "grid",
            alias: "",
            summary: "uniform grid, walked by a 3D-DDA",
            paper: "Fujimoto et al. 1986; Amanatides and Woo 1987",
            build_options: GRID_OPTIONS,
            walk_options: &[GROUP],
            traversal: |_| Traversal::Grid,
            builder: "grid",
            parallel: false,
            build: build_grid,
        },
        VariantInfo {
            name: "kdtree",
            alias: "",
            summary: "SAH kd-tree, short stack of four with pushdown and restart",
            paper: "Shevtsov et al. 2007; Wald and Havran 2006; Horn et al. 2007",
            build_options: KD_OPTIONS,
            walk_options: &[KD_WALK[0], KD_WALK[1], KD_WALK[2], GROUP],
            traversal: kd_search,
            builder: "kdtree",
            parallel: true,
            build: build_kdtree,
        },
        VariantInfo {
            name: "bvh",
            alias: "bvh-packet",
            summary: "binned SAH BVH, packets of 8x8 rays with one shared stack (also: bvh-packet)",
            paper: "Günther et al. 2007",
            build_options: BVH_OPTIONS,
            walk_options: &[VOTE, PACKET],
            traversal: vote,
            builder: "bvh",
            parallel: true,
            build: build_bvh,
        },
        VariantInfo {
            name: "bvh-stack",
            alias: "",
            summary: "the same BVH, one ray per thread with a stack of its own",
            paper: "Aila and Laine 2009",
            build_options: BVH_OPTIONS,
            walk_options: &[GROUP],
            traversal: |_| Traversal::BvhStack,
            builder: "bvh",
            parallel: true,
            build: build_bvh,
        },
        VariantInfo {
            name: "ploc-stack",
            alias: "",
            summary: "BVH built by obvhs (PLOC with reinsertion; as bvh where that takes too long), a stack per ray",
            paper: "Meister and Bittner 2018",
            build_options: &[OptionInfo {
                key: "preset",
                default: "medium",
                meaning: "obvhs's preset",
                kind: Kind::Word(&ploc::PRESETS),
            }],
            walk_options: &[GROUP],
            traversal: |_| Traversal::BvhStack,
            builder: "ploc",
            parallel: true,
            build: build_ploc,
        },
        VariantInfo {
            name: "grid-coop",
            alias: "",
            summary: "the same grid; the 64 threads of a group share out all triangle tests of the group",
            paper: "",
            build_options: GRID_OPTIONS,
            walk_options: &[PACKET],
            traversal: |_| Traversal::GridCoop,
            builder: "grid",
            parallel: false,
            build: build_grid,
        },
        VariantInfo {
            name: "grid-packet",
            alias: "",
            summary: "the same grid; packets march through it slice by slice along their main axis",
            paper: "Wald et al. 2006",
            build_options: GRID_OPTIONS,
            walk_options: &[PACKET],
            traversal: |_| Traversal::GridPacket,
            builder: "grid",
            parallel: false,
            build: build_grid,
        },
        VariantInfo {
            name: "brute",
            alias: "",
            summary: "no structure: every ray against every triangle (ground truth for small scenes)",
            paper: "",
            build_options: &[],
            walk_options: &[GROUP],
            traversal: |_| Traversal::Brute,
            builder: "brute",
            parallel: true,
            build: |_, scene| Ok(Structure::Brute(brute::build::build(scene)?).into()),
        },
    ];
    VARIANTS
}

fn build_grid(s: &Selection, scene: &Scene) -> Result<Made> {
    Ok(Structure::Grid(grid::build::build(scene, &grid(s))?).into())
}

fn grid(s: &Selection) -> grid::build::Config {
    let resolution = [s.count("x"), s.count("y"), s.count("z")];
    grid::build::Config { resolution, factor: s.number("factor") }
}

impl Selection {
    /// What the grid is built with, if this is one.
    pub fn grid_config(&self) -> Option<grid::build::Config> {
        (self.info().builder == "grid").then(|| grid(self))
    }
}

fn cost(s: &Selection) -> CostModel {
    CostModel { traversal: s.number("kt"), intersection: s.number("ki") }
}

fn build_kdtree(s: &Selection, scene: &Scene) -> Result<Made> {
    let config = kdtree::build::Config {
        bins: s.size("bins"),
        spread: if s.value("spread") == "cell" { Spread::Cell } else { Spread::Content },
        exact_below: s.size("exact_below"),
        cost: cost(s),
        small_leaf: s.size("small_leaf"),
        max_depth: s.count("max_depth"),
        thin: s.number("thin") as f32,
    };
    let built = kdtree::build::build(scene, &config)?;
    let note = format!("max_depth={}: a deeper tree would take excessive memory", built.max_depth);
    let note = if built.cut { note } else { String::new() };
    Ok(Made { structure: Structure::KdTree(built.tree), note })
}

fn build_bvh(s: &Selection, scene: &Scene) -> Result<Made> {
    let config = bvh::build::Config { bins: s.size("bins"), max_leaf: s.size("max_leaf"), cost: cost(s) };
    Ok(Structure::Bvh(bvh::build::build(scene, &config)?).into())
}

fn kd_search(s: &Selection) -> Traversal {
    let search = s.value("search");
    Traversal::KdTree(KdSearch {
        stack: if search == "short-stack" { s.count("stack").unwrap_or_default() } else { 0 },
        pushdown: search != "restart",
        private: s.value("memory") == "private",
    })
}

fn vote(s: &Selection) -> Traversal {
    Traversal::Bvh(if s.value("vote") == "original" { Vote::Original } else { Vote::Corrected })
}

fn build_ploc(s: &Selection, scene: &Scene) -> Result<Made> {
    let params = ploc::preset(s.value("preset")).expect("the table lists the presets");
    if let Some(bvh) = ploc::build(scene, params)? {
        return Ok(Structure::Bvh(bvh).into());
    }
    let bvh = bvh::build::build(scene, &bvh::build::Config::default())?;
    let note =
        "built as bvh: PLOC would take excessive time over so many boxes that are equal, in a row or inside each other";
    Ok(Made { structure: Structure::Bvh(bvh), note: note.to_owned() })
}

impl Kind {
    /// The value in its one spelling, or what would be one.
    pub(crate) fn parse(&self, value: &str) -> Result<String, String> {
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
