//! How a row was rendered, as its key says, and the versions of the paper.

use crate::record::row::Key;
use serde::Deserialize;
use std::fmt;

/// Who renders, in the order of columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs)] // The variants are renderers.
pub enum Renderer {
    Sequential,
    SimdThreads,
    Simd,
    Threads,
    Gpu,
}

/// Order of the work along a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)] // The variants are algorithms.
pub enum Algorithm {
    TwoPass,
    OnePass,
}

/// What the loop over the spheres keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Hit {
    /// The whole hit.
    InLoop,
    /// Distance and index.
    Index,
}

/// A version of the paper's program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
pub enum Stage {
    /// Tables 1 and 2.
    #[serde(rename = "two-pass")]
    TwoPass,
    /// Table 3.
    #[serde(rename = "one-pass")]
    OnePass,
    /// Table 4: SIMD alone differs from table 3.
    #[serde(rename = "one-pass+exits")]
    Exits,
}

/// The switches of a renderer. Those that it does not have are ignored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // The names of the fields say what they are
pub struct Version {
    pub algorithm: Algorithm,
    pub exit_on_miss: bool,
    pub skip_no_hit: bool,
    pub skip_no_discriminant: bool,
    pub hit: Hit,
    pub lanes: usize,
}

/// All of a row's axes but scene, size, trips and frames.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // The names of the fields say what they are
pub struct Setting {
    pub renderer: Renderer,
    /// 1 for renderers without vectors.
    pub lanes: usize,
    /// Instructions that were asked for; empty for the best ones.
    pub level: String,
    /// Threads that were asked for; `None` for the device's number.
    pub threads: Option<usize>,
    pub algorithm: Algorithm,
    pub exit_on_miss: bool,
    pub skip_no_hit: bool,
    pub skip_no_discriminant: bool,
    /// `None` for the GPU.
    pub hit: Option<Hit>,
    /// Half precision.
    pub half: bool,
}

/// What the words of [`Setting::switches`] mean, for a note below a table.
pub const WORDS: &str = "Switches: exit: a path ends at its first miss; skips: of spheres that no lane hits, and of \
                         root and quotient without a positive discriminant; in loop, index: what the loop over the \
                         spheres keeps of a hit.";

impl Renderer {
    /// All, in the order of columns.
    pub const ALL: [Renderer; 5] =
        [Renderer::Sequential, Renderer::SimdThreads, Renderer::Simd, Renderer::Threads, Renderer::Gpu];

    /// Those that run on the processor.
    pub const CPU: [Renderer; 4] = [Renderer::Sequential, Renderer::SimdThreads, Renderer::Simd, Renderer::Threads];

    /// Its name in headings.
    pub fn title(self) -> &'static str {
        match self {
            Renderer::Sequential => "sequential",
            Renderer::SimdThreads => "SIMD + threads",
            Renderer::Simd => "SIMD",
            Renderer::Threads => "threads",
            Renderer::Gpu => "GPU",
        }
    }

    /// The renderer of this name in keys.
    pub fn named(name: &str) -> Option<Renderer> {
        match name {
            "sequential" => Some(Renderer::Sequential),
            "threads" => Some(Renderer::Threads),
            "simd" => Some(Renderer::Simd),
            "simd-threads" => Some(Renderer::SimdThreads),
            "gpu" => Some(Renderer::Gpu),
            _ => None,
        }
    }

    /// True if it has vectors, and the switches that belong to them.
    pub fn has_lanes(self) -> bool {
        matches!(self, Renderer::Simd | Renderer::SimdThreads)
    }

    /// True if it has a pool of threads.
    pub fn has_threads(self) -> bool {
        matches!(self, Renderer::Threads | Renderer::SimdThreads)
    }
}

impl Stage {
    /// All, in the paper's order.
    pub const ALL: [Stage; 3] = [Stage::TwoPass, Stage::OnePass, Stage::Exits];

    /// Its name in keys of rows.
    pub fn title(self) -> &'static str {
        match self {
            Stage::TwoPass => "two-pass",
            Stage::OnePass => "one-pass",
            Stage::Exits => "one-pass + exits",
        }
    }

    /// Its switches in the paper's structure: four lanes, and the hit stored in the loop.
    pub const fn version(self) -> Version {
        let first = Version {
            algorithm: Algorithm::TwoPass,
            exit_on_miss: false,
            skip_no_hit: false,
            skip_no_discriminant: false,
            hit: Hit::InLoop,
            lanes: 4,
        };
        match self {
            Stage::TwoPass => first,
            Stage::OnePass => Version { algorithm: Algorithm::OnePass, exit_on_miss: true, ..first },
            Stage::Exits => Version {
                algorithm: Algorithm::OnePass,
                exit_on_miss: true,
                skip_no_hit: true,
                skip_no_discriminant: true,
                ..first
            },
        }
    }
}

impl Setting {
    /// Reads a row's key; `None` for values of a later version of the program.
    pub fn of(key: &Key) -> Option<Setting> {
        let renderer = Renderer::named(key.axis("renderer"))?;
        let is_on = |axis: &str| key.axis(axis) == "on";
        let number = |axis: &str| key.axis(axis).parse::<usize>().ok();
        Some(Setting {
            renderer,
            lanes: if renderer.has_lanes() { number("lanes")? } else { 1 },
            level: key.axis("level").to_owned(),
            threads: number("threads"),
            algorithm: match key.axis("algorithm") {
                "two-pass" => Algorithm::TwoPass,
                "one-pass" => Algorithm::OnePass,
                _ => return None,
            },
            exit_on_miss: is_on("exit_on_miss"),
            skip_no_hit: is_on("skip_no_hit"),
            skip_no_discriminant: is_on("skip_no_discriminant"),
            hit: match key.axis("hit") {
                "in-loop" => Some(Hit::InLoop),
                "index" => Some(Hit::Index),
                _ => None,
            },
            half: key.axis("precision") == "f16",
        })
    }

    /// A renderer's setting in a version, with the device's number of threads and the best instructions.
    pub fn in_version(renderer: Renderer, version: Version) -> Setting {
        let lanes = renderer.has_lanes();
        Setting {
            renderer,
            lanes: if lanes { version.lanes } else { 1 },
            level: String::new(),
            threads: None,
            algorithm: version.algorithm,
            exit_on_miss: version.exit_on_miss,
            skip_no_hit: lanes && version.skip_no_hit,
            skip_no_discriminant: lanes && version.skip_no_discriminant,
            hit: (renderer != Renderer::Gpu).then_some(version.hit),
            half: false,
        }
    }

    /// True if both have the same switches: everything but level and number of threads.
    pub fn is_like(&self, other: &Setting) -> bool {
        let switches = |s: &Setting| Setting { level: String::new(), threads: None, ..s.clone() };
        switches(self) == switches(other)
    }

    /// Everything but the renderer, in few words: `8 lanes, one-pass, exit, skips, index`. [`WORDS`] explains them.
    pub fn switches(&self) -> String {
        let mut words = Vec::new();
        if self.renderer.has_lanes() {
            words.push(format!("{} lanes", self.lanes));
        }
        words.extend((!self.level.is_empty()).then(|| self.level.clone()));
        words.extend(
            self.threads.map(|threads| if threads == 1 { "1 thread".into() } else { format!("{threads} threads") }),
        );
        words.push(if self.algorithm == Algorithm::TwoPass { "two-pass".into() } else { "one-pass".into() });
        let both = self.skip_no_hit && self.skip_no_discriminant;
        let switches = [
            (self.exit_on_miss, "exit"),
            (both, "skips"),
            (self.skip_no_hit && !both, "skip no hit"),
            (self.skip_no_discriminant && !both, "skip no discriminant"),
            (self.hit == Some(Hit::InLoop), "in loop"),
            (self.hit == Some(Hit::Index), "index"),
            (self.half, "f16"),
        ];
        words.extend(switches.iter().filter(|(is_on, _)| *is_on).map(|(_, name)| (*name).to_owned()));
        words.join(", ")
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.renderer.title(), self.switches())
    }
}
