//! Speed-up, and the serial share of a program that the Karp-Flatt metric infers from it.

use crate::compare::judge::{Outcome, Uncertain};

/// The quotient of two times, with the noise of both.
pub fn quotient(a: Uncertain, b: Uncertain) -> Uncertain {
    Uncertain { value: a.value / b.value, noise: a.noise + b.noise, margin: a.margin.max(b.margin) }
}

/// Karp and Flatt: `e = (1/S - 1/p) / (1 - 1/p)` of a speed-up and a number of processors. `None` for a single
/// processor, of which there is none, and for a speed-up that is not positive.
pub fn karp_flatt(speed_up: f64, processors: f64) -> Option<f64> {
    let e = (1.0 / speed_up - 1.0 / processors) / (1.0 - 1.0 / processors);
    (speed_up > 0.0 && processors > 1.0 && e.is_finite()).then_some(e)
}

/// The same with `1/p` added instead of subtracted, which is what the paper printed.
pub fn karp_flatt_as_printed(speed_up: f64, processors: f64) -> Option<f64> {
    let e = (1.0 / speed_up + 1.0 / processors) / (1.0 - 1.0 / processors);
    (speed_up > 0.0 && processors > 1.0 && e.is_finite()).then_some(e)
}

/// Why there is no metric, or why it is outside of 0 to 1; empty otherwise. A note below the table explains the words.
pub fn remark(speed_up: f64, processors: Option<f64>) -> &'static str {
    match processors {
        None => "p unknown",
        Some(p) if p <= 1.0 => "p = 1",
        Some(p) if speed_up > p => "S > p",
        Some(_) if speed_up < 1.0 => "S < 1",
        Some(_) => "",
    }
}

/// A speed-up and a number of processors, as a share of the sequential time.
#[derive(Clone, Copy, Debug)]
pub struct Parallel {
    /// Parallel time by sequential time: 1/S.
    pub share: Uncertain,
    /// More than 1.
    pub processors: f64,
}

impl Parallel {
    /// The metric of a time that is so many times the measured one.
    fn e(&self, factor: f64) -> f64 {
        karp_flatt(1.0 / (self.share.value * factor), self.processors).unwrap_or(f64::NAN)
    }

    /// The metric.
    pub fn karp_flatt(&self) -> f64 {
        self.e(1.0)
    }
}

/// Is the Karp-Flatt metric of `a` below that of `b`? It may be negative, so that it is compared as an interval: what
/// it would be with the times changed by noise and margin.
pub fn less_serial(a: Parallel, b: Parallel) -> Outcome {
    let doubt = 1.0 + a.share.margin.max(b.share.margin) + a.share.noise + b.share.noise;
    // Half of the doubt on each side
    let doubt = doubt.sqrt();
    if a.e(doubt) < b.e(1.0 / doubt) {
        Outcome::Agrees
    } else if a.e(1.0 / doubt) > b.e(doubt) {
        Outcome::Contradicts
    } else {
        Outcome::Undecided
    }
}
