//! What a pair of rows says.

use super::Ratio;
use crate::record::statistics::unpaired_ratio;

/// Ratios within this many percent of 1 count as the same unless the user says otherwise.
pub const MARGIN_PCT: f64 = 3.0;

/// Error probability of intervals of runs that were measured apart: the smallest that three runs on each side can have
/// (two orders of twenty).
pub const UNPAIRED_ALPHA: f64 = 0.1;

/// Runs that a side needs for a verdict about times that were measured apart.
pub const RUNS_NEEDED: usize = 3;

/// All words, in the order of summaries.
pub const WORDS: [&str; 8] = ["error", "slower", "faster", "same", "ambiguous", "incomparable", "gone", "new"];

/// What a pair of rows says about the newer one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The interval is within the margin.
    Same,
    /// The interval is below 1, and the ratio below the margin.
    Faster,
    /// The interval is above 1, and the ratio above the margin.
    Slower,
    /// The measurements decide nothing.
    Ambiguous,
    /// The older side has no such row.
    New,
    /// The newer side has no such row.
    Gone,
    /// A side has no result: why.
    Error(String),
    /// The rows were measured under unlike conditions: which.
    Incomparable(String),
}

impl Verdict {
    /// In one word.
    pub fn word(&self) -> &'static str {
        match self {
            Verdict::Same => "same",
            Verdict::Faster => "faster",
            Verdict::Slower => "slower",
            Verdict::Ambiguous => "ambiguous",
            Verdict::New => "new",
            Verdict::Gone => "gone",
            Verdict::Error(_) => "error",
            Verdict::Incomparable(_) => "incomparable",
        }
    }

    /// Why; empty where the word says everything.
    pub fn reason(&self) -> &str {
        match self {
            Verdict::Error(reason) | Verdict::Incomparable(reason) => reason,
            _ => "",
        }
    }

    /// The word with the reason in brackets.
    pub fn describe(&self) -> String {
        match self.reason() {
            "" => self.word().to_owned(),
            reason => format!("{}({reason})", self.word()),
        }
    }

    /// The verdict of an interval of the ratio of the newer time by the older one.
    pub fn of_interval(value: f64, low: f64, high: f64, margin: f64) -> Verdict {
        let (least, most) = (1.0 / (1.0 + margin), 1.0 + margin);
        if low >= least && high <= most {
            Verdict::Same
        } else if high < 1.0 && value < least {
            Verdict::Faster
        } else if low > 1.0 && value > most {
            Verdict::Slower
        } else {
            Verdict::Ambiguous
        }
    }
}

/// The ratio of two sides that were measured apart, and its verdict. Values are one per run; a side of a single run has
/// its passes instead, whose spread is less than that of runs: then nothing is decided.
pub fn apart(old: &[f64], new: &[f64], passes: Option<(&[f64], &[f64])>, margin: f64) -> Option<(Ratio, Verdict)> {
    let enough = old.len() >= RUNS_NEEDED && new.len() >= RUNS_NEEDED;
    let unpaired = match passes {
        Some((old, new)) => unpaired_ratio(new, old, UNPAIRED_ALPHA)?,
        None => unpaired_ratio(new, old, UNPAIRED_ALPHA)?,
    };
    let mut estimate = unpaired.ratio;
    if let ([old], [new]) = (old, new) {
        // The ratio that the tables' numbers have
        estimate.value = new / old;
        (estimate.low, estimate.high) = (estimate.low.min(estimate.value), estimate.high.max(estimate.value));
    }
    let verdict = if enough && unpaired.has_interval {
        Verdict::of_interval(estimate.value, estimate.low, estimate.high, margin)
    } else {
        Verdict::Ambiguous
    };
    Some((Ratio { estimate, has_interval: unpaired.has_interval, p: unpaired.p }, verdict))
}
