//! Comparing two numbers that have noise.

use crate::thesis::data::{Data, Frame};
use serde::Serialize;

/// What a case says about its claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// It is as claimed.
    Agrees,
    /// It is not.
    Contradicts,
    /// The difference is smaller than the margin.
    Undecided,
}

/// Noise of a time, in percent, where none is recorded: after a single pass.
pub const UNKNOWN_NOISE_PCT: f64 = 5.0;

/// Frame times of one process closer than this, and both noises besides, decide nothing: the noise is the spread over a few
/// passes of one process, and the same program started twice was seen to differ by more than that.
pub const TIME_MARGIN_PCT: f64 = 10.0;

/// The same for build times: each tree is built only a few times.
pub const BUILD_MARGIN_PCT: f64 = 20.0;

/// A number, its relative noise and the relative margin within which nothing is decided, both 0 to 1.
#[derive(Clone, Copy, Debug)]
pub struct Uncertain {
    /// The number; positive.
    pub value: f64,
    /// Relative.
    pub noise: f64,
    /// Relative; of two numbers the larger counts.
    pub margin: f64,
}

impl Uncertain {
    /// A count or a size.
    pub fn exact(value: f64) -> Uncertain {
        Uncertain { value, noise: 0.0, margin: 0.0 }
    }

    /// A build time.
    pub fn build(value: f64) -> Uncertain {
        Uncertain { value, noise: 0.0, margin: BUILD_MARGIN_PCT / 100.0 }
    }

    /// A mean frame time. Of what the thesis printed no noise is known, and none is assumed beside the margin.
    pub fn frame(data: &Data, frame: &Frame) -> Uncertain {
        let unknown = if data.published { 0.0 } else { UNKNOWN_NOISE_PCT };
        let noise = frame.noise_pct.unwrap_or(unknown) / 100.0;
        Uncertain { value: frame.mean_ms, noise, margin: TIME_MARGIN_PCT / 100.0 }
    }
}

/// Is `a` less than `b / factor`? Undecided where the quotient is nearer to the factor than the margin and both noises
/// together.
pub fn less_by(a: Uncertain, b: Uncertain, factor: f64) -> Outcome {
    let margin = 1.0 + a.margin.max(b.margin) + a.noise + b.noise;
    let quotient = b.value / a.value / factor;
    if quotient > margin {
        Outcome::Agrees
    } else if quotient * margin < 1.0 || (margin == 1.0 && quotient <= 1.0) {
        Outcome::Contradicts
    } else {
        Outcome::Undecided
    }
}

/// Is `a` less than `b`?
pub fn less(a: Uncertain, b: Uncertain) -> Outcome {
    less_by(a, b, 1.0)
}

/// All of several statements: one contradiction contradicts.
pub fn all(outcomes: impl IntoIterator<Item = Outcome>) -> Outcome {
    let mut result = Outcome::Agrees;
    for outcome in outcomes {
        match outcome {
            Outcome::Contradicts => return Outcome::Contradicts,
            Outcome::Undecided => result = Outcome::Undecided,
            Outcome::Agrees => {}
        }
    }
    result
}

/// The opposite.
pub fn not(outcome: Outcome) -> Outcome {
    match outcome {
        Outcome::Agrees => Outcome::Contradicts,
        Outcome::Contradicts => Outcome::Agrees,
        Outcome::Undecided => Outcome::Undecided,
    }
}
