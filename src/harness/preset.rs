//! Presets: plans as data files in `presets/WORKLOAD/`, part of the program. A user's file works as well.
//!
//! A key is the name of an axis, or one of `frames`, `passes`, `warmup`, `threads`, `builds` and `workload`. Each
//! `[[part]]` may set axes and `frames` anew.

use super::workload::{Info, Part};
use crate::error::{Error, Result};
use crate::guard;
use crate::names;
use std::collections::BTreeMap;
use std::path::Path;
use toml::{Table, Value};

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

impl Preset {
    /// Finds a preset of a workload by name, or reads one from a file.
    ///
    /// # Errors
    /// [`Error::Input`]: no such preset, a file that is none, with its line, or one of another workload.
    pub fn load(info: &Info, name: &str) -> Result<Preset> {
        if let Some((_, text)) = info.presets.iter().find(|(known, _)| *known == name) {
            return Preset::parse(info, name, text);
        }
        let path = &*names::file(name);
        if path.extension().is_none() {
            let known: Vec<&str> = info.presets.iter().map(|(name, _)| *name).collect();
            let hint = format!("there are {}; or give a TOML file", known.join(", "));
            return Err(Error::argument("--preset", format!("no preset {name:?} of {}", info.name), hint));
        }
        guard::read(path);
        let text = std::fs::read_to_string(path)
            .map_err(|e| Error::file(path, None, format!("cannot read: {e}"), "give a preset's TOML file"))?;
        Preset::parse(info, name, &text)
    }

    fn parse(info: &Info, name: &str, text: &str) -> Result<Preset> {
        let text = text.trim_start_matches('\u{feff}');
        let file = File {
            info,
            path: &names::file(name),
            text,
            example: format!("see presets/{}/{}.toml", info.name, info.presets.first().map_or("", |(name, _)| name)),
        };
        let mut table: Table = toml::from_str(text).map_err(|e| {
            let line = e.span().map(|span| 1 + text[..span.start].matches('\n').count());
            file.wrong(line, e.message().replace('\n', ", "))
        })?;
        let tables = match table.remove("part") {
            None => Vec::new(),
            Some(value) => value.try_into::<Vec<Table>>().map_err(|_| {
                file.wrong(file.line_of("part", 0), "part is no list of tables: write [[part]]".to_owned())
            })?,
        };
        let mut numbers = BTreeMap::new();
        for key in NUMBERS {
            numbers.insert(key, table.remove(key).map(|value| file.number(key, &value, 0)).transpose()?);
        }
        if let Some(value) = table.remove("workload") {
            match value.as_str() {
                Some(other) if other == info.name => {}
                other => {
                    let other = other.map_or(value.to_string(), str::to_owned);
                    let problem = format!("a preset of the workload {other}, not of {}", info.name);
                    return Err(file.wrong(file.line_of("workload", 0), problem));
                }
            }
        }
        let common = file.part(table, 0)?;
        let parts = tables.into_iter().enumerate().map(|(index, table)| file.part(table, index + 1));
        let mut parts = parts.collect::<Result<Vec<Part>>>()?;
        if parts.is_empty() {
            parts.push(Part::default());
        }
        let number = |key: &str| numbers.get(key).copied().flatten();
        let needed = |key: &str| number(key).ok_or_else(|| file.wrong(None, format!("{key} is not set")));
        Ok(Preset {
            name: name.to_owned(),
            common,
            parts,
            passes: needed("passes")?,
            warmup: needed("warmup")?,
            threads: number("threads").unwrap_or(0),
            builds: number("builds").unwrap_or(1),
        })
    }
}

/// Keys of a preset with a number, besides `frames`.
const NUMBERS: [&str; 4] = ["passes", "warmup", "threads", "builds"];

/// A preset's file while it is read.
struct File<'a> {
    info: &'a Info,
    path: &'a Path,
    text: &'a str,
    example: String,
}

impl File<'_> {
    fn wrong(&self, line: Option<usize>, problem: String) -> Error {
        Error::file(self.path, line, problem, &self.example)
    }

    /// The values of one table: 0 is the file's own, 1 its first part.
    fn part(&self, mut table: Table, index: usize) -> Result<Part> {
        let frames = table.remove("frames").map(|value| self.number("frames", &value, index)).transpose()?;
        let mut values = BTreeMap::new();
        for (key, value) in table {
            if !self.info.axes.iter().any(|axis| axis.is_flag && axis.name == key) {
                return Err(self.wrong(self.line_of(&key, index), unknown(self.info, &key)));
            }
            let is_table = |value: &Value| value.as_array().is_some_and(|items| items.iter().any(Value::is_table));
            if self.info.axes.first().is_some_and(|subject| subject.name == key) && is_table(&value) {
                // A part's name before there were several workloads
                return Err(self.wrong(self.line_of(&key, index), format!("[[{key}]] is called [[part]] now")));
            }
            let texts = match &value {
                Value::Array(items) if !items.is_empty() => items.iter().map(text_of).collect(),
                single => text_of(single).map(|text| vec![text]),
            };
            let problem = || format!("{key} = {value} is no text, whole number or list of them");
            let texts: Vec<String> = texts.ok_or_else(|| self.wrong(self.line_of(&key, index), problem()))?;
            values.insert(key, texts);
        }
        Ok(Part { values, frames, ..Part::default() })
    }

    fn number(&self, key: &str, value: &Value, index: usize) -> Result<usize> {
        let number = value.as_integer().and_then(|number| usize::try_from(number).ok());
        let problem = || format!("{key} = {value} is no whole number");
        number.ok_or_else(|| self.wrong(self.line_of(key, index), problem()))
    }

    /// The line, counted from 1, that sets a key of a table, or where its table begins.
    fn line_of(&self, key: &str, index: usize) -> Option<usize> {
        let is_part = |line: &str| line.trim_start().starts_with("[[part]]");
        let mut before = 0;
        let sets = |line: &str| {
            before += usize::from(is_part(line));
            let line = line.trim_start().trim_start_matches('[');
            before == index && line.strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with(['=', ']']))
        };
        self.text.lines().position(sets).map(|line| line + 1)
    }
}

/// Text or whole number, as a user would type it.
fn text_of(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.clone()),
        Value::Integer(number) => Some(number.to_string()),
        _ => None,
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
