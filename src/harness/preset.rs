//! Presets: plans as data files in `presets/WORKLOAD/`, part of the program. A user's file works as well.
//!
//! A key is the name of an axis, or one of `frames`, `passes`, `warmup`, `threads`, `builds` and `workload`. Each
//! `[[part]]` may set axes and `frames` anew.

use super::workload::{Info, Part};
use crate::error::{Error, Result};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// A plan as a file describes it; every value as a user would type it.
#[derive(Clone, Debug)]
pub struct Preset {
    /// Name, or the file's path.
    pub name: String,
    /// What holds for every part that does not set it.
    pub common: Part,
    /// What is measured, part by part. A value of the first axis may occur several times, for measurements that are not
    /// every combination of values: what is measured once is not repeated.
    pub parts: Vec<Part>,
    /// Timed passes over all frames.
    pub passes: usize,
    /// Untimed frames before each pass.
    pub warmup: usize,
    /// Threads that build, where the command line does not say; 0 for all.
    pub threads: usize,
    /// How often each artifact is built; the median counts.
    pub builds: usize,
}

#[derive(Deserialize)]
struct File {
    workload: Option<String>,
    frames: Option<usize>,
    passes: usize,
    warmup: usize,
    #[serde(default)]
    threads: usize,
    #[serde(default = "once")]
    builds: usize,
    #[serde(default)]
    part: Vec<FilePart>,
    #[serde(flatten)]
    axes: BTreeMap<String, Values>,
}

#[derive(Deserialize)]
struct FilePart {
    frames: Option<usize>,
    #[serde(flatten)]
    axes: BTreeMap<String, Values>,
}

/// One value or a list; numbers count as text.
#[derive(Deserialize)]
#[serde(untagged)]
enum Values {
    One(Scalar),
    Many(Vec<Scalar>),
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Scalar {
    Integer(i64),
    Text(String),
}

fn once() -> usize {
    1
}

impl Values {
    fn texts(self) -> Vec<String> {
        let text = |scalar| match scalar {
            Scalar::Integer(number) => number.to_string(),
            Scalar::Text(text) => text,
        };
        match self {
            Values::One(value) => vec![text(value)],
            Values::Many(values) => values.into_iter().map(text).collect(),
        }
    }
}

impl Preset {
    /// Finds a preset of a workload by name, or reads one from a file.
    ///
    /// # Errors
    /// [`Error::Input`]: no such preset, a file that is none, with its line, or one of another workload.
    pub fn load(info: &Info, name: &str) -> Result<Preset> {
        if let Some((_, text)) = info.presets.iter().find(|(known, _)| *known == name) {
            return Preset::parse(info, name, text);
        }
        let path = Path::new(name);
        if path.extension().is_none() {
            let known: Vec<&str> = info.presets.iter().map(|(name, _)| *name).collect();
            let hint = format!("there are {}; or give a TOML file", known.join(", "));
            return Err(Error::argument("--preset", format!("no preset {name:?} of {}", info.name), hint));
        }
        let text = std::fs::read_to_string(path)
            .map_err(|e| Error::file(path, None, format!("cannot read: {e}"), "give a preset's TOML file"))?;
        Preset::parse(info, name, &text)
    }

    fn parse(info: &Info, name: &str, text: &str) -> Result<Preset> {
        let example = format!("see presets/{}/{}.toml", info.name, info.presets.first().map_or("", |(name, _)| name));
        let wrong = |line: Option<usize>, problem: String| Error::file(Path::new(name), line, problem, &example);
        let file: File = toml::from_str(text).map_err(|e| {
            let line = e.span().map(|span| 1 + text[..span.start].matches('\n').count());
            wrong(line, e.message().replace('\n', ", "))
        })?;
        if let Some(other) = file.workload.filter(|workload| workload != info.name) {
            let problem = format!("a preset of the workload {other}, not of {}", info.name);
            return Err(wrong(line_of(text, "workload"), problem));
        }
        let part = |axes: BTreeMap<String, Values>, frames| {
            for key in axes.keys() {
                if !info.axes.iter().any(|axis| axis.is_flag && axis.name == key) {
                    return Err(wrong(line_of(text, key), unknown(info, key)));
                }
            }
            let values = axes.into_iter().map(|(axis, values)| (axis, values.texts())).collect();
            Ok(Part { values, frames })
        };
        let common = part(file.axes, file.frames)?;
        let mut parts = file.part.into_iter().map(|p| part(p.axes, p.frames)).collect::<Result<Vec<Part>>>()?;
        if parts.is_empty() {
            parts.push(Part::default());
        }
        let (passes, warmup, threads, builds) = (file.passes, file.warmup, file.threads, file.builds);
        Ok(Preset { name: name.to_owned(), common, parts, passes, warmup, threads, builds })
    }
}

/// A message about a key that no axis has; it names the axis that was meant, if that can be guessed.
fn unknown(info: &Info, key: &str) -> String {
    let axes: Vec<&str> = info.axes.iter().filter(|axis| axis.is_flag).map(|axis| axis.name).collect();
    match key {
        // The keys of presets before there were several workloads
        "structures" | "configs" | "resolutions" => format!("the key {key} is called {} now", &key[..key.len() - 1]),
        "warmup_frames" => "the key warmup_frames is called warmup now".to_owned(),
        "build_threads" => "the key build_threads is called threads now".to_owned(),
        _ => format!(
            "unknown key {key}; there are {}, frames, passes, warmup, threads, builds, workload and [[part]]",
            axes.join(", ")
        ),
    }
}

/// The first line that sets a key or begins its table.
fn line_of(text: &str, key: &str) -> Option<usize> {
    let sets = |line: &str| {
        let line = line.trim_start().trim_start_matches('[');
        line.strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with(['=', ']']))
    };
    text.lines().position(sets).map(|index| index + 1)
}
