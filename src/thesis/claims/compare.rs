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
    /// The difference is smaller than the noise.
    Undecided,
}

/// Noise of a time, in percent, where none is recorded: a single pass, a single build.
pub const UNKNOWN_NOISE_PCT: f64 = 5.0;

/// A number and its relative uncertainty, 0 to 1.
#[derive(Clone, Copy, Debug)]
pub struct Uncertain {
    /// The number; positive.
    pub value: f64,
    /// Relative.
    pub noise: f64,
}

impl Uncertain {
    /// A count or a size.
    pub fn exact(value: f64) -> Uncertain {
        Uncertain { value, noise: 0.0 }
    }

    /// A single time.
    pub fn once(data: &Data, value: f64) -> Uncertain {
        // Of what the thesis printed no noise is known, and none is assumed: its claims rest on these numbers
        Uncertain { value, noise: if data.published { 0.0 } else { UNKNOWN_NOISE_PCT / 100.0 } }
    }

    /// A mean frame time.
    pub fn frame(data: &Data, frame: &Frame) -> Uncertain {
        match frame.noise_pct {
            Some(noise) => Uncertain { value: frame.mean_ms, noise: noise / 100.0 },
            None => Uncertain::once(data, frame.mean_ms),
        }
    }
}

/// Is `a` less than `b / factor`? Undecided where the quotient is nearer to the factor than both noises together.
pub fn less_by(a: Uncertain, b: Uncertain, factor: f64) -> Outcome {
    let margin = 1.0 + a.noise + b.noise;
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
