//! A gain in percent has two readings: `g` percent faster is a ratio of `1 + g`, `g` percent less time one of
//! `1 / (1 - g)`. The document does not say which it means, so every percentage is compared in both.

use crate::compare::judge::{Outcome, Uncertain};

/// Percentage points within which a measured gain agrees with a printed one.
pub const MARGIN_POINTS: f64 = 10.0;

/// A reading of a gain in percent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reading {
    /// So much more is done in the same time: a ratio of `1 + g`.
    More,
    /// The same is done in so much less time: a ratio of `1 / (1 - g)`.
    Less,
}

impl Reading {
    /// Both.
    pub const ALL: [Reading; 2] = [Reading::More, Reading::Less];

    /// The reading as a formula.
    pub fn formula(self) -> &'static str {
        match self {
            Reading::More => "1 + g",
            Reading::Less => "1 / (1 - g)",
        }
    }

    /// The ratio that a gain in percent says; the gain is below 100.
    pub fn ratio(self, percent: f64) -> f64 {
        match self {
            Reading::More => 1.0 + percent / 100.0,
            Reading::Less => 1.0 / (1.0 - percent / 100.0),
        }
    }

    /// The gain in percent of a ratio, which is positive.
    pub fn percent(self, ratio: f64) -> f64 {
        match self {
            Reading::More => 100.0 * (ratio - 1.0),
            Reading::Less => 100.0 * (1.0 - 1.0 / ratio),
        }
    }
}

/// Does a gain of one number over another agree with a printed percentage? The ratio is that of the slower to the
/// faster time. It agrees if it is within [`MARGIN_POINTS`] in one reading, and contradicts if no ratio within noise
/// and margin of the two times is so in any.
pub fn agrees(own: Uncertain, other: Uncertain, printed: f64) -> Outcome {
    let ratio = other.value / own.value;
    let near = |ratio: f64| Reading::ALL.iter().any(|r| (r.percent(ratio) - printed).abs() <= MARGIN_POINTS);
    if near(ratio) {
        return Outcome::Agrees;
    }
    let doubt = 1.0 + own.margin.max(other.margin) + own.noise + other.noise;
    // The ratios that would agree are an interval in each reading
    let possible = Reading::ALL.iter().any(|reading| {
        let (low, high) = (reading.ratio(printed - MARGIN_POINTS), reading.ratio(printed + MARGIN_POINTS));
        ratio * doubt >= low && ratio / doubt <= high
    });
    if possible { Outcome::Undecided } else { Outcome::Contradicts }
}
