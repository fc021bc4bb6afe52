//! `--renderer NAME[:KEY=VALUE,..]`: who renders, as it is typed and as rows hold it.

use super::options::{Lanes, Level, Renderer};
use crate::error::{Error, Result};
use crate::threads::MAX_THREADS;

/// Names of the renderers, in the order of `all`.
pub const NAMES: [&str; 5] = ["sequential", "threads", "simd", "simd-threads", "gpu"];

/// Pixels at once where none are given.
const DEFAULT_LANES: Lanes = Lanes::Eight;

const FLAG: &str = "--renderer";

impl Lanes {
    const ALL: [(&'static str, Lanes); 3] = [("4", Lanes::Four), ("8", Lanes::Eight), ("16", Lanes::Sixteen)];

    /// As it is typed.
    pub fn name(self) -> &'static str {
        name_of(&Lanes::ALL, self)
    }
}

impl Level {
    /// Every level with its name, the least of each architecture first.
    pub const ALL: [(&'static str, Level); 4] =
        [("sse2", Level::Sse2), ("avx2", Level::Avx2), ("avx512", Level::Avx512), ("neon", Level::Neon)];

    /// As it is typed.
    pub fn name(self) -> &'static str {
        name_of(&Level::ALL, self)
    }
}

fn name_of<T: PartialEq>(all: &[(&'static str, T)], value: T) -> &'static str {
    all.iter().find(|(_, known)| *known == value).map_or("", |(name, _)| name)
}

impl Renderer {
    /// Reads `NAME[:KEY=VALUE,..]`; `all` is every renderer with its defaults.
    ///
    /// # Errors
    /// [`Error::Input`]: no such renderer, or an option that it does not have.
    pub fn parse_all(text: &str) -> Result<Vec<Renderer>> {
        match text {
            "all" => NAMES.iter().map(|name| Renderer::parse(name)).collect(),
            one => Ok(vec![Renderer::parse(one)?]),
        }
    }

    /// Reads `NAME[:KEY=VALUE,..]`.
    ///
    /// # Errors
    /// As [`Renderer::parse_all`].
    pub fn parse(text: &str) -> Result<Renderer> {
        let (name, options) = text.split_once(':').map_or((text, None), |(name, options)| (name, Some(options)));
        let keys: &[&str] = match name {
            "sequential" | "gpu" => &[],
            "threads" => &["threads"],
            "simd" => &["lanes", "level"],
            "simd-threads" => &["lanes", "level", "threads"],
            _ => {
                let problem = format!("there is no renderer '{name}'");
                return Err(Error::argument(FLAG, problem, format!("all, or one of {}", NAMES.join(", "))));
            }
        };
        let mut given = Given::default();
        for option in options.iter().flat_map(|options| options.split(',')) {
            given.add(name, keys, option)?;
        }
        let Given { lanes, level, threads } = given;
        let (lanes, threads) = (lanes.unwrap_or(DEFAULT_LANES), threads.unwrap_or(0));
        Ok(match name {
            "sequential" => Renderer::Sequential,
            "threads" => Renderer::Threads(threads),
            "simd" => Renderer::Simd(lanes, level),
            "simd-threads" => Renderer::SimdThreads(lanes, level, threads),
            _ => Renderer::Gpu,
        })
    }

    /// Its name without options.
    pub fn name(self) -> &'static str {
        match self {
            Renderer::Sequential => "sequential",
            Renderer::Threads(_) => "threads",
            Renderer::Simd(..) => "simd",
            Renderer::SimdThreads(..) => "simd-threads",
            Renderer::Gpu => "gpu",
        }
    }

    /// Its options as axes of a row; empty where it has none, and where the machine decides.
    pub fn axes(self) -> [(&'static str, String); 3] {
        let of = |lanes: Option<Lanes>, level: Option<Level>, threads: usize| {
            let number = if threads == 0 { String::new() } else { threads.to_string() };
            let name = |level: Level| level.name().to_owned();
            [
                ("lanes", lanes.map(|lanes| lanes.name().to_owned()).unwrap_or_default()),
                ("level", level.map(name).unwrap_or_default()),
                ("threads", number),
            ]
        };
        match self {
            Renderer::Sequential | Renderer::Gpu => of(None, None, 0),
            Renderer::Threads(threads) => of(None, None, threads),
            Renderer::Simd(lanes, level) => of(Some(lanes), level, 0),
            Renderer::SimdThreads(lanes, level, threads) => of(Some(lanes), level, threads),
        }
    }

    /// True if it works on several pixels at once.
    pub fn is_simd(self) -> bool {
        matches!(self, Renderer::Simd(..) | Renderer::SimdThreads(..))
    }
}

/// Options in the order in which they are read.
#[derive(Default)]
struct Given {
    lanes: Option<Lanes>,
    level: Option<Level>,
    threads: Option<usize>,
}

impl Given {
    /// Reads `KEY=VALUE`.
    fn add(&mut self, name: &str, keys: &[&str], option: &str) -> Result<()> {
        let wrong = |problem: String, hint: String| Error::argument(FLAG, problem, hint);
        let (key, value) = option.split_once('=').unwrap_or((option, ""));
        if !keys.contains(&key) {
            let hint = match keys {
                [] => format!("{name} has no options"),
                keys => format!("{name} has {}", keys.join(", ")),
            };
            return Err(wrong(format!("{name} has no option '{key}'"), hint));
        }
        let not = |values: String| wrong(format!("'{value}' is no value of {name}'s option {key}"), values);
        let words = |names: Vec<&str>| format!("one of {}", names.join(", "));
        let twice = match key {
            "lanes" => {
                let found = Lanes::ALL.iter().find(|(name, _)| *name == value);
                let found = found.ok_or_else(|| not(words(Lanes::ALL.map(|(name, _)| name).to_vec())))?;
                self.lanes.replace(found.1).is_some()
            }
            "level" => {
                let found = Level::ALL.iter().find(|(name, _)| *name == value);
                let found = found.ok_or_else(|| not(words(Level::ALL.map(|(name, _)| name).to_vec())))?;
                self.level.replace(found.1).is_some()
            }
            _ => {
                let number = value.parse().ok().filter(|number| (1..=MAX_THREADS).contains(number));
                self.threads.replace(number.ok_or_else(|| not(format!("1 to {MAX_THREADS}")))?).is_some()
            }
        };
        match twice {
            true => Err(wrong(format!("{name}'s option {key} is given twice"), "give it once".to_owned())),
            false => Ok(()),
        }
    }
}

/// Names of the options, which are axes of a row as well.
pub const OPTIONS: [&str; 3] = ["lanes", "level", "threads"];

/// A renderer as it is typed, with those options that have a value.
pub fn typed(name: &str, options: &[(&str, &str)]) -> String {
    let given = options.iter().filter(|(_, value)| !value.is_empty());
    let given: Vec<String> = given.map(|(key, value)| format!("{key}={value}")).collect();
    let separator = if given.is_empty() { "" } else { ":" };
    format!("{name}{separator}{}", given.join(","))
}

impl std::fmt::Display for Renderer {
    /// As it is typed, with the options that were given.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let axes = self.axes();
        let options: Vec<(&str, &str)> = axes.iter().map(|(key, value)| (*key, value.as_str())).collect();
        f.write_str(&typed(self.name(), &options))
    }
}
