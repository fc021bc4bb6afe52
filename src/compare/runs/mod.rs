//! Whole runs against each other: rows are paired by their axes, exact quantities are compared exactly, times by
//! statistics, and a verdict says what a difference is worth.

mod csv;
mod exact;
mod html;
mod json;
mod pairing;
mod tables;
mod verdict;

pub use exact::{Change, Quantity};
pub use html::page;
pub use pairing::compare;
pub use tables::{Shown, tables};
pub use verdict::{MARGIN_PCT, UNPAIRED_ALPHA, Verdict};

use super::conditions::ComparedRun;
use crate::record::statistics::Estimate;
use crate::record::stream::Name;

pub use csv::write as csv;
pub use json::write as json;

/// What to compare, and how.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Conditions that may differ.
    pub across: Vec<String>,
    /// Ratios within this many percent are the same.
    pub margin_pct: f64,
    /// Axes that name a row, in their order; geometric means are taken by each.
    pub axes: Vec<String>,
    /// Names of whole numbers that depend on the machine and are not compared.
    pub machine: Vec<String>,
}

/// A side of a comparison: one run, or several of the same.
#[derive(Debug)]
pub struct Side {
    /// Its name in tables.
    pub name: String,
    /// Indices of its runs.
    pub runs: Vec<usize>,
}

/// A row of all sides.
#[derive(Clone, Debug)]
pub struct PairedRow {
    /// The row's name.
    pub label: String,
    /// Value of each axis that means are taken by.
    pub groups: Vec<Name>,
    /// Mean frame time in milliseconds on each side: the median over its runs.
    pub times_ms: Vec<Option<f64>>,
    /// Time on the last side by that on the first one, with an interval where there is one.
    pub ratio: Option<Ratio>,
    /// What the last side says about the first one.
    pub verdict: Verdict,
}

/// A ratio of two times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    /// The ratio with the ends of its interval.
    pub estimate: Estimate,
    /// True if the interval has the stated level; false for the range of the quotients.
    pub has_interval: bool,
    /// Two-sided probability of Mann and Whitney's test.
    pub p: f64,
}

/// A geometric mean of ratios.
#[derive(Clone, Debug, PartialEq)]
pub struct Mean {
    /// The axis; empty for the mean of all rows.
    pub axis: String,
    /// Its value.
    pub value: String,
    /// Number of ratios.
    pub rows: usize,
    /// Their geometric mean.
    pub ratio: f64,
}

/// What a comparison found.
#[derive(Debug)]
pub struct Comparison {
    /// All runs.
    pub runs: Vec<ComparedRun>,
    /// The sides, the oldest first.
    pub sides: Vec<Side>,
    /// Whole numbers and hashes that differ between the first and the last side.
    pub changes: Vec<Change>,
    /// Number of exact quantities that were compared.
    pub exact_compared: usize,
    /// Rows, in the order of the first side that has them.
    pub rows: Vec<PairedRow>,
    /// Geometric means: of all rows, and by axis.
    pub means: Vec<Mean>,
    /// What a reader should know.
    pub notes: Vec<String>,
}

impl Comparison {
    /// Number of rows of a verdict, by its word.
    pub fn count(&self, word: &str) -> usize {
        self.rows.iter().filter(|row| row.verdict.word() == word).count()
    }

    /// Numbers of rows by verdict, those that occur: `3 faster, 1 new`.
    pub fn counts(&self) -> String {
        let words = verdict::WORDS.iter().map(|word| (self.count(word), word)).filter(|(count, _)| *count > 0);
        words.map(|(count, word)| format!("{count} {word}")).collect::<Vec<_>>().join(", ")
    }
}
