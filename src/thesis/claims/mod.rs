//! The claims of the thesis (SPEC section 10), judged by measurements.
//!
//! A claim is about *cases*: a scene, often with a ray configuration or a structure. Each case agrees, contradicts, or is
//! undecided because the difference is smaller than the noise and a stated margin. The rule (METHODOLOGY.md, "How claims
//! are judged") is the same for runs and for the numbers that the thesis printed. Cases that contradict, as the thesis's own
//! numbers do, are its exceptions: they are named and do not count against the claim. It does not hold if any other case
//! contradicts; it holds if more cases agree than are exceptions; otherwise it is undecided. Without
//! any case it is not measured, which is a verdict of its own and never a "holds".

mod cases;
mod compare;
mod list;
mod occupancy;
mod options;
mod render;
mod resolution;

pub use cases::{MIRRORS, UNIFORM_CROWDING, crowding};
pub use compare::{BUILD_MARGIN_PCT, Outcome, TIME_MARGIN_PCT, UNKNOWN_NOISE_PCT};
pub use occupancy::ABOUT_20_PCT;
pub use render::{Form, details, sign, summary, totals, write};
pub use resolution::{FAR, NEAR};

use super::data::{Data, Failure};
use super::scenes::SceneKey;
use list::{CLAIMS, Claim};
use serde::Serialize;

/// How a claim was decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// No case contradicts but for the thesis's own exceptions, and more cases agree than are exceptions.
    Holds,
    /// A case contradicts that is none of the thesis's own exceptions.
    DoesNotHold,
    /// There are cases, and none of the above.
    Undecided,
    /// There is no case.
    NotMeasured,
}

impl Verdict {
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

/// What a verdict rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Basis {
    /// Build times, which are the processor's and not the device's.
    BuildTimes,
    /// Sizes by the thesis's accounting.
    Sizes,
    /// Frame times.
    FrameTimes,
    /// Steps and triangle tests per ray: where frame times of a device say nothing about a GPU.
    Counts,
}

impl Basis {
    /// In words.
    pub fn in_words(self) -> &'static str {
        match self {
            Basis::BuildTimes => "build times",
            Basis::Sizes => "sizes",
            Basis::FrameTimes => "frame times",
            Basis::Counts => "counts",
        }
    }
}

/// One case of a claim.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Case {
    /// Scene, as tables name it.
    pub scene: String,
    /// What else: ray configuration, structure; empty if nothing.
    pub what: String,
    /// What it says.
    pub outcome: Outcome,
    /// The numbers behind it.
    pub numbers: String,
}

impl Case {
    fn new(scene: &SceneKey, what: impl Into<String>, outcome: Outcome, numbers: String) -> Case {
        Case { scene: scene.to_string(), what: what.into(), outcome, numbers }
    }

    /// Scene and what else.
    pub fn name(&self) -> String {
        [self.scene.as_str(), self.what.as_str()].join(" ").trim().to_owned()
    }
}

/// A claim and how it fared.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Number in SPEC section 10; a letter where a claim has two halves.
    pub claim: &'static str,
    /// The claim.
    pub statement: &'static str,
    /// The device whose times it is about; empty where no device is involved.
    pub device: String,
    /// How it was decided.
    pub verdict: Verdict,
    /// What the verdict rests on.
    pub basis: Basis,
    /// True if it rests on frame times of a device that computes on the CPU: they are about that machine and no GPU.
    pub without_gpu: bool,
    /// Number of scenes with a decided case.
    pub scenes: usize,
    /// Cases that agree.
    pub agreeing: usize,
    /// Cases that contradict.
    pub contradicting: usize,
    /// Cases within the margin.
    pub undecided: usize,
    /// Contradicting cases in which the thesis's own numbers contradict as well.
    pub exceptions: Vec<String>,
    /// The thesis's own numbers judged in the same way: cases that agree, cases decided. Absent where it printed none.
    pub thesis: Option<(usize, usize)>,
    /// All cases.
    pub cases: Vec<Case>,
    /// Measurements that belong to it and gave no usable result, with the reason: what the verdict does not rest on.
    pub failed: Vec<String>,
    /// What was measured and is not judged, with the reason.
    pub left_out: Vec<String>,
    /// What would have to be measured; said where nothing was.
    pub needs: &'static str,
    /// What to beware of.
    pub warnings: Vec<String>,
}

/// Judges every claim; those about frame times, or counts in their place, once per device. `card` is the published card for comparison.
pub fn judge(data: &Data, published: &Data, card: usize) -> Vec<Finding> {
    let mut findings = Vec::new();
    for claim in &CLAIMS {
        let thesis = (claim.cases)(published, card);
        let devices = if claim.basis == Basis::FrameTimes { data.devices.len() } else { 1 };
        findings.extend((0..devices).map(|device| finding(claim, data, device, &thesis)));
    }
    findings
}

fn finding(claim: &Claim, data: &Data, device: usize, thesis: &[Case]) -> Finding {
    let mut warnings = Vec::new();
    let software = claim.basis == Basis::FrameTimes && data.devices[device].is_software();
    let (basis, cases) = match claim.by_counts.filter(|_| software) {
        Some(by_counts) => {
            warnings.push(
                "Judged by steps and triangle tests per ray: this device's times say nothing about a GPU's.".to_owned(),
            );
            (Basis::Counts, by_counts(data, device))
        }
        None => (claim.basis, (claim.cases)(data, device)),
    };
    let without_gpu = software && basis == Basis::FrameTimes;
    if without_gpu {
        warnings.push("About this machine only: the device computes on the CPU and is no GPU.".to_owned());
    }
    if !claim.remark.is_empty() {
        warnings.push(claim.remark.to_owned());
    }
    let count = |outcome| cases.iter().filter(|c| c.outcome == outcome).count();
    let (agreeing, contradicting, undecided) =
        (count(Outcome::Agrees), count(Outcome::Contradicts), count(Outcome::Undecided));
    let excused = |case: &&Case| {
        thesis.iter().any(|t| (&t.scene, &t.what, t.outcome) == (&case.scene, &case.what, Outcome::Contradicts))
    };
    let against = cases.iter().filter(|c| c.outcome == Outcome::Contradicts);
    let exceptions: Vec<String> = against.filter(excused).map(Case::name).collect();
    let verdict = match (agreeing, contradicting - exceptions.len()) {
        _ if cases.is_empty() => Verdict::NotMeasured,
        (_, 1..) => Verdict::DoesNotHold,
        (1.., 0) if agreeing > exceptions.len() => Verdict::Holds,
        _ => Verdict::Undecided,
    };
    let mut scenes: Vec<&str> =
        cases.iter().filter(|c| c.outcome != Outcome::Undecided).map(|c| c.scene.as_str()).collect();
    scenes.sort_unstable();
    scenes.dedup();
    let decided = thesis.iter().filter(|c| c.outcome != Outcome::Undecided).count();
    let thesis_agrees = thesis.iter().filter(|c| c.outcome == Outcome::Agrees).count();
    Finding {
        claim: claim.id,
        statement: claim.statement,
        device: if claim.basis == Basis::FrameTimes { data.devices[device].label.clone() } else { String::new() },
        verdict,
        basis,
        without_gpu,
        scenes: scenes.len(),
        agreeing,
        contradicting,
        undecided,
        exceptions,
        thesis: (decided > 0 && !data.published).then_some((thesis_agrees, decided)),
        cases,
        failed: if claim.basis == Basis::FrameTimes { failed(claim, data, device) } else { Vec::new() },
        left_out: (claim.left_out)(data),
        needs: claim.needs,
        warnings,
    }
}

/// What was tried on a device for a claim, and never gave a result.
fn failed(claim: &Claim, data: &Data, device: usize) -> Vec<String> {
    let later = |failure: &Failure| {
        data.frames.iter().any(|f| {
            (f.device, f.config, f.width, f.height) == (device, failure.config, failure.width, failure.height)
                && f.scene == failure.scene
                && f.structure == failure.structure
                && f.variant == failure.variant
        })
    };
    let of_claim = |f: &&Failure| f.device == device && claim.subject.has(data, f) && !later(f);
    data.failures.iter().filter(of_claim).map(|f| format!("{} ({})", f.what, f.message)).collect()
}
