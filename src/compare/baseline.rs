//! The file that a gate compares with: exact quantities of every row, artifact and kernel, and what may change. It is
//! written sorted, with one line per row and part, so that an intended change is a readable difference; budgets are a
//! person's.

use super::unique::UniqueKeys;
use crate::error::{Error, Result};
use crate::record::files;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// Version of the form; it changes when a reader of old files would misread new ones.
pub const SCHEMA: &str = "rtbench-baseline/1";

/// The quantity whose budget makes the gate judge times.
pub const FRAME_TIME: &str = "frame_ms";

/// Share of a run's rows that must be in the baseline where a person has not written another one.
const LEAST_SHARE: f64 = 0.5;

/// Whole numbers by name.
pub type Counts = BTreeMap<String, u64>;

/// A baseline.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    /// [`SCHEMA`].
    pub schema: String,
    /// The workload of its rows.
    pub workload: String,
    /// Driver that made the hashes, and the times where there are any, of all rows that do not name another one.
    pub driver: String,
    /// A gate that finds less than this share of a run's rows here cannot judge it, 0 to 1.
    pub min_compared_share: f64,
    /// What may change by how much, by quantity: a person's.
    pub budgets: BTreeMap<String, Budget>,
    /// Names of the quantities of rows that are held; one that a row does not list is 0.
    pub quantities: Vec<String>,
    /// Static costs of kernels.
    pub kernels: BTreeMap<String, Counts>,
    /// What was built.
    pub artifacts: BTreeMap<String, Counts>,
    /// Rows with a result.
    pub rows: BTreeMap<String, BaselineRow>,
}

/// By how much a quantity may differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// Share of the baseline's value, 0.01 for one percent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub share: Option<f64>,
    /// Absolute difference.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub absolute: Option<u64>,
}

impl Budget {
    /// True if the difference of two values is within the budget.
    pub fn allows(&self, old: u64, new: u64) -> bool {
        let difference = old.abs_diff(new);
        let by_share = self.share.is_some_and(|share| difference as f64 <= share * old as f64);
        difference == 0 || by_share || self.absolute.is_some_and(|absolute| difference <= absolute)
    }
}

/// A row of a baseline.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BaselineRow {
    /// Driver that made its hashes and time, where a run has several devices and it is not the baseline's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub driver: Option<String>,
    /// First 16 digits of the content hash of each input.
    pub inputs: BTreeMap<String, String>,
    /// Whole numbers by the part of the work that they are about; the empty part is all of it.
    #[serde(default)]
    pub counts: BTreeMap<String, Counts>,
    /// First 16 digits of the hash of each output.
    #[serde(default)]
    pub hashes: BTreeMap<String, String>,
    /// Mean frame time, only where there is a budget for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame_ms: Option<f64>,
    /// Its spread over passes in percent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise_pct: Option<f64>,
}

impl Baseline {
    /// A baseline without rows.
    pub fn new(workload: &str) -> Baseline {
        Baseline {
            schema: SCHEMA.into(),
            workload: workload.to_owned(),
            driver: String::new(),
            min_compared_share: LEAST_SHARE,
            budgets: BTreeMap::new(),
            quantities: Vec::new(),
            kernels: BTreeMap::new(),
            artifacts: BTreeMap::new(),
            rows: BTreeMap::new(),
        }
    }

    /// Reads a baseline.
    ///
    /// # Errors
    /// [`Error::Input`] with file and line: it cannot be read, is empty, is of another schema, or was edited wrongly.
    pub fn read(path: &Path) -> Result<Baseline> {
        let hint = "`rtbench bless RUN --baseline FILE` writes one";
        let text =
            std::fs::read_to_string(path).map_err(|e| Error::file(path, None, format!("cannot read: {e}"), hint))?;
        if text.trim().is_empty() {
            return Err(Error::file(path, None, "the baseline is empty", hint));
        }
        Baseline::parse(path, &text)
    }

    /// Parses the text of a baseline; `path` is for messages.
    ///
    /// # Errors
    /// As [`Baseline::read`].
    pub fn parse(path: &Path, text: &str) -> Result<Baseline> {
        #[derive(Deserialize)]
        struct First {
            schema: Option<String>,
        }
        let wrong = |error: serde_json::Error| {
            let problem = error.to_string();
            let problem = problem.rsplit_once(" at line ").map_or(&*problem, |(problem, _)| problem).to_owned();
            let hint = "undo the edit, or bless a run anew";
            Error::file(path, Some(error.line().max(1)), format!("no baseline: {problem}"), hint)
        };
        let first: First = serde_json::from_str(text).map_err(wrong)?;
        serde_json::from_str::<UniqueKeys>(text).map_err(wrong)?;
        if first.schema.as_deref() != Some(SCHEMA) {
            let problem = match first.schema {
                Some(other) => format!("schema {other:?} instead of {SCHEMA:?}"),
                None => format!("no baseline: it names no schema, {SCHEMA:?} is needed"),
            };
            return Err(Error::file(path, Some(line_of(text, "schema")), problem, "bless a run anew"));
        }
        let baseline: Baseline = serde_json::from_str(text).map_err(wrong)?;
        baseline.check(path, text)?;
        Ok(baseline)
    }

    fn check(&self, path: &Path, text: &str) -> Result<()> {
        let refuse =
            |name: &str, problem: String, hint: &str| Err(Error::file(path, Some(line_of(text, name)), problem, hint));
        if !(0.0..=1.0).contains(&self.min_compared_share) {
            let problem = format!("min_compared_share {} is out of range", self.min_compared_share);
            return refuse("min_compared_share", problem, "give 0 to 1");
        }
        for (name, budget) in &self.budgets {
            if budget.share.is_some_and(|share| !(share >= 0.0 && share.is_finite())) {
                return refuse(name, format!("the share of {name} is out of range"), "give 0.01 for one percent");
            }
            if budget.share.is_none() && budget.absolute.is_none() {
                return refuse(name, format!("the budget of {name} allows nothing"), "give share or absolute");
            }
            if name == FRAME_TIME && (budget.share.is_none() || budget.absolute.is_some()) {
                return refuse(name, "times are judged by their share alone".into(), "give share, not absolute");
            }
            if !self.knows(name) {
                return refuse(name, format!("there is no quantity '{name}'"), "name one of the file's quantities");
            }
        }
        for (name, row) in &self.rows {
            let bad =
                |value: Option<f64>, least: f64| value.is_some_and(|value| !(value >= least && value.is_finite()));
            if bad(row.frame_ms, f64::MIN_POSITIVE) || bad(row.noise_pct, 0.0) {
                return refuse(name, format!("a time of {name} is out of range"), "undo the edit, or bless a run anew");
            }
        }
        Ok(())
    }

    /// The first budget of a quantity that the baseline does not have.
    pub fn budget_without_quantity(&self) -> Option<&str> {
        self.budgets.keys().map(String::as_str).find(|name| !self.knows(name))
    }

    /// True for the name of a quantity, with its part (`part.name`) or without.
    fn knows(&self, name: &str) -> bool {
        let is = |known: &str| known == name || known.rsplit('.').next() == Some(name);
        let counted = |maps: &BTreeMap<String, Counts>| maps.values().flat_map(Counts::keys).any(|known| known == name);
        name == FRAME_TIME
            || self.quantities.iter().any(|known| is(known))
            || counted(&self.artifacts)
            || counted(&self.kernels)
    }

    /// The budget of a quantity, by its full name or without its part.
    pub fn budget(&self, quantity: &str) -> Budget {
        let short = quantity.rsplit('.').next().unwrap_or(quantity);
        self.budgets.get(quantity).or_else(|| self.budgets.get(short)).copied().unwrap_or_default()
    }

    /// The value of a quantity of a row; 0 where the row does not list it.
    pub fn count(&self, row: &BaselineRow, quantity: &str) -> u64 {
        let (part, name) = quantity.split_once('.').unwrap_or(("", quantity));
        row.counts.get(part).and_then(|counts| counts.get(name)).copied().unwrap_or_default()
    }

    /// As text: JSON, sorted, one line per row and part.
    pub fn write(&self) -> String {
        let mut text = String::from("{\n");
        for (name, value) in [("schema", &self.schema), ("workload", &self.workload), ("driver", &self.driver)] {
            text += &format!("  {}: {},\n", json(name), json(value));
        }
        text += &format!("  \"min_compared_share\": {},\n", json(&self.min_compared_share));
        block(&mut text, "budgets", self.budgets.iter().map(|(name, budget)| entry(name, budget)), ",");
        let quantities: Vec<String> = self.quantities.iter().map(|name| format!("    {}", json(name))).collect();
        text += &format!("  \"quantities\": [\n{}\n  ],\n", quantities.join(",\n"));
        block(&mut text, "kernels", self.kernels.iter().map(|(name, counts)| entry(name, counts)), ",");
        block(&mut text, "artifacts", self.artifacts.iter().map(|(name, counts)| entry(name, counts)), ",");
        block(&mut text, "rows", self.rows.iter().map(|(name, row)| row.write(name)), "");
        text + "}\n"
    }

    /// Writes it into a file, whole or not at all.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn save(&self, path: &Path) -> Result<()> {
        files::replace(path, self.write().as_bytes())
    }
}

impl BaselineRow {
    fn write(&self, name: &str) -> String {
        let mut lines = vec![format!("      \"inputs\": {}", spaced(&self.inputs))];
        let parts: Vec<String> =
            self.counts.iter().map(|(part, counts)| format!("        {}", entry(part, counts).trim_start())).collect();
        if !parts.is_empty() {
            lines.push(format!("      \"counts\": {{\n{}\n      }}", parts.join(",\n")));
        }
        if !self.hashes.is_empty() {
            lines.push(format!("      \"hashes\": {}", spaced(&self.hashes)));
        }
        lines.extend(self.driver.as_ref().map(|driver| format!("      \"driver\": {}", json(driver))));
        for (name, value) in [("frame_ms", self.frame_ms), ("noise_pct", self.noise_pct)] {
            lines.extend(value.map(|value| format!("      \"{name}\": {value}")));
        }
        format!("    {}: {{\n{}\n    }}", json(name), lines.join(",\n"))
    }
}

/// One line of a map: name and value.
fn entry(name: &str, value: &impl Serialize) -> String {
    format!("    {}: {}", json(name), spaced(value))
}

/// JSON on one line, with a space after commas and colons outside of texts.
fn spaced(value: &impl Serialize) -> String {
    let (mut text, mut quoted, mut escaped) = (String::new(), false, false);
    for c in json(value).chars() {
        text.push(c);
        quoted ^= c == '"' && !escaped;
        escaped = quoted && c == '\\' && !escaped;
        if !quoted && (c == ',' || c == ':') {
            text.push(' ');
        }
    }
    text
}

/// Adds a map of many lines.
fn block(text: &mut String, name: &str, lines: impl Iterator<Item = String>, comma: &str) {
    let lines: Vec<String> = lines.collect();
    *text += &match lines.is_empty() {
        true => format!("  \"{name}\": {{}}{comma}\n"),
        false => format!("  \"{name}\": {{\n{}\n  }}{comma}\n", lines.join(",\n")),
    };
}

/// JSON on one line. Maps with texts as keys, numbers and texts: writing them to memory does not fail.
fn json(value: &(impl Serialize + ?Sized)) -> String {
    serde_json::to_string(value).unwrap_or_default()
}

/// The line of the first mention of a key, from 1.
fn line_of(text: &str, key: &str) -> usize {
    let quoted = format!("\"{key}\"");
    text.lines().position(|line| line.contains(&quoted)).map_or(1, |line| line + 1)
}
