//! What `--structure` can name: every pair of builder and traversal, with its options. One row per variant.

use super::{Structure, Traversal, brute, bvh_build, grid_build, kdtree_build, ploc};
use crate::error::{Error, Result};
use crate::scene::Scene;
use std::time::Instant;

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
    builder: &'static str,
    /// False for builders that use one thread whatever they are given.
    parallel: bool,
    build: fn(&Selection, &Scene) -> Result<Structure>,
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
    kind: Kind,
}

/// What an option's value may be.
#[derive(Debug)]
enum Kind {
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
        default: "512",
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

/// A variant with its options, as `--structure` gives it: `name[:key=value,...]`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Selection {
    /// Row in [`variants`].
    variant: usize,
    /// One value per option, in the table's order and spelled as the table would.
    values: Vec<String>,
}

/// A structure, and what it took to build it.
#[derive(Clone, Debug)]
pub struct Built {
    /// The structure.
    pub structure: Structure,
    /// Wall-clock time, in milliseconds, from the scene's triangles to the finished structure.
    pub build_ms: f64,
    /// Threads that the builder could use.
    pub build_threads: usize,
}

/// Most threads of a build.
pub const MAX_THREADS: usize = 1024;

impl Selection {
    /// Reads `name[:key=value,...]`.
    pub fn parse(text: &str) -> Result<Selection> {
        let place = || format!("--structure {text}");
        let (name, options) = text.split_once(':').unwrap_or((text, ""));
        let Some(variant) = variants().iter().position(|v| v.name == name) else {
            let names: Vec<&str> = variants().iter().map(|v| v.name).collect();
            let problem = format!("there is no structure '{name}'");
            return Err(Error::argument(place(), problem, format!("one of {}", names.join(", "))));
        };
        let table = variants()[variant].options;
        let mut values: Vec<String> = table.iter().map(|o| o.default.to_owned()).collect();
        for option in options.split(',').filter(|o| !o.is_empty()) {
            let (key, value) = option.split_once('=').unwrap_or((option, ""));
            let Some(index) = table.iter().position(|o| o.key == key) else {
                let keys: Vec<&str> = table.iter().map(|o| o.key).collect();
                let mend = if keys.is_empty() { "it has none".into() } else { format!("one of {}", keys.join(", ")) };
                return Err(Error::argument(place(), format!("{name} has no option '{key}'"), mend));
            };
            values[index] = table[index]
                .kind
                .parse(value)
                .map_err(|mend| Error::argument(place(), format!("'{value}' is no value for {key}"), mend))?;
        }
        Ok(Selection { variant, values })
    }

    /// The variant's row in the table.
    pub fn info(&self) -> &'static VariantInfo {
        &variants()[self.variant]
    }

    /// The variant's name.
    pub fn name(&self) -> &'static str {
        self.info().name
    }

    /// The options that differ from their defaults, `key=value,...`, or `default`.
    pub fn variant(&self) -> String {
        let options = self.info().options.iter().zip(&self.values);
        let set: Vec<String> =
            options.filter(|(o, v)| o.default != *v).map(|(o, v)| format!("{}={v}", o.key)).collect();
        if set.is_empty() { "default".to_owned() } else { set.join(",") }
    }

    /// How it is walked.
    pub fn traversal(&self) -> Traversal {
        self.info().traversal
    }

    /// Equal for selections whose built structures are the same.
    pub fn build_key(&self) -> String {
        format!("{}:{}", self.info().builder, self.values.join(","))
    }

    /// Builds the structure on `threads` threads (0: as many as there are).
    pub fn build(&self, scene: &Scene, threads: usize) -> Result<Built> {
        let pool_error = |problem: String| Error::argument("--threads", problem, format!("0 (all) to {MAX_THREADS}"));
        if threads > MAX_THREADS {
            return Err(pool_error(format!("{threads} threads are too many")));
        }
        let threads = if self.info().parallel { threads } else { 1 };
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|e| pool_error(format!("cannot start {threads} threads: {e}")))?;
        pool.install(|| {
            let start = Instant::now();
            let structure = (self.info().build)(self, scene)?;
            let build_ms = start.elapsed().as_secs_f64() * 1e3;
            Ok(Built { structure, build_ms, build_threads: rayon::current_num_threads() })
        })
    }

    fn value(&self, key: &str) -> &str {
        let index = self.info().options.iter().position(|o| o.key == key).expect("an option of the table");
        &self.values[index]
    }

    /// `None` for `auto`.
    fn count(&self, key: &str) -> Option<u32> {
        self.value(key).parse().ok()
    }

    fn size(&self, key: &str) -> usize {
        self.value(key).parse().expect("checked when it was read")
    }

    fn number(&self, key: &str) -> f64 {
        self.value(key).parse().expect("checked when it was read")
    }
}

impl Kind {
    /// The value in its one spelling, or what would be one.
    fn parse(&self, value: &str) -> Result<String, String> {
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
