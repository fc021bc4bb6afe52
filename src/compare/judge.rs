//! What the difference of two numbers says, given their noise and a margin; and what the cases of a claim say together.

use serde::Serialize;

/// What a comparison says about a statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// The numbers agree with it.
    Agrees,
    /// The numbers contradict it.
    Contradicts,
    /// The difference is smaller than noise and margin.
    Undecided,
}

/// What the cases of a claim say together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// No case contradicts but for exceptions, and more cases agree than are exceptions.
    Holds,
    /// A case contradicts that is no exception.
    DoesNotHold,
    /// There are cases, and none of the above.
    Undecided,
    /// There is no case.
    NotMeasured,
}

impl Verdict {
    /// All verdicts.
    pub const ALL: [Verdict; 4] = [Verdict::Holds, Verdict::DoesNotHold, Verdict::Undecided, Verdict::NotMeasured];

    /// The verdict of these cases, `exceptions` of which contradict and are excused.
    pub fn of(outcomes: &[Outcome], exceptions: usize) -> Verdict {
        let count = |wanted| outcomes.iter().filter(|outcome| **outcome == wanted).count();
        match (count(Outcome::Agrees), count(Outcome::Contradicts) - exceptions) {
            _ if outcomes.is_empty() => Verdict::NotMeasured,
            (_, 1..) => Verdict::DoesNotHold,
            (agreeing, 0) if agreeing > exceptions => Verdict::Holds,
            _ => Verdict::Undecided,
        }
    }

    /// In words.
    pub fn in_words(self) -> &'static str {
        match self {
            Verdict::Holds => "holds",
            Verdict::DoesNotHold => "does not hold",
            Verdict::Undecided => "undecided",
            Verdict::NotMeasured => "not measured",
        }
    }
}

/// The noise of a time in percent that is assumed where none is recorded: after a single pass.
pub const UNKNOWN_NOISE_PCT: f64 = 5.0;

/// Frame times whose difference is within this margin and both noises decide nothing: the noise is the spread over a
/// few passes of one process, and the same program started twice was seen to differ by more than that.
pub const TIME_MARGIN_PCT: f64 = 10.0;

/// The same for build times, because each structure is built only a few times.
pub const BUILD_MARGIN_PCT: f64 = 20.0;

/// A number with its relative noise and the relative margin within which it decides nothing, both 0 to 1.
#[derive(Clone, Copy, Debug)]
pub struct Uncertain {
    /// The number; positive.
    pub value: f64,
    /// The relative noise.
    pub noise: f64,
    /// The relative margin; the larger of two numbers' margins counts.
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

    /// Work by a model, with the relative difference that it does not tell apart.
    pub fn modelled(value: f64, margin: f64) -> Uncertain {
        Uncertain { value, noise: 0.0, margin }
    }

    /// A frame time with its noise in percent.
    pub fn time(value: f64, noise_pct: f64) -> Uncertain {
        Uncertain { value, noise: noise_pct / 100.0, margin: TIME_MARGIN_PCT / 100.0 }
    }
}

/// Is `a` less than `b / factor`? Undecided where the quotient differs from the factor by no more than the margin and
/// both noises together.
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

/// Do all statements agree? One contradiction contradicts.
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

/// The outcome for the opposite statement.
pub fn not(outcome: Outcome) -> Outcome {
    match outcome {
        Outcome::Agrees => Outcome::Contradicts,
        Outcome::Contradicts => Outcome::Agrees,
        Outcome::Undecided => Outcome::Undecided,
    }
}
