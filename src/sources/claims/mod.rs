//! Claims of a source and how they fared: cases, findings, and their texts.
//!
//! A claim is about *cases*: a scene, often with a ray configuration or a structure. Each case agrees, contradicts, or
//! is undecided because the difference is smaller than the noise and a stated margin. Cases that contradict where the
//! source's own numbers do as well are exceptions: they are named and do not count against the claim. The rule
//! ([`Verdict::of`]; METHODOLOGY.md, "How claims are judged") is the same for runs and for published numbers.

mod html;
mod text;

pub use html::write as html;
pub use text::{Form, summary, write};

use crate::compare::judge::{Outcome, Verdict};
use crate::report::html::capital;
use crate::sources::rows::Device;
use serde::Serialize;

/// What a verdict rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Basis {
    /// Build times, which are the processor's and not the device's.
    BuildTimes,
    /// Sizes in memory.
    Sizes,
    /// What structures are like: leaves, references, expected costs.
    Properties,
    /// Frame times.
    FrameTimes,
    /// Steps and triangle tests per ray: where frame times of a device say nothing about a GPU.
    Counts,
    /// How far pictures differ.
    Pictures,
    /// What the warps of a GPU issue, by the SIMT model: counted, and measured on no GPU.
    SimtModel,
}

impl Basis {
    /// In words.
    fn in_words(self) -> &'static str {
        match self {
            Basis::BuildTimes => "build times",
            Basis::Sizes => "sizes",
            Basis::Properties => "properties of structures",
            Basis::FrameTimes => "frame times",
            Basis::Counts => "counts",
            Basis::Pictures => "pictures",
            Basis::SimtModel => "the SIMT model",
        }
    }
}

/// A case of a claim.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Case {
    /// The scene, as tables name it.
    pub scene: String,
    /// Ray configuration, structure; empty if the case is the scene's only one.
    pub what: String,
    /// What the case says.
    pub outcome: Outcome,
    /// The numbers behind the outcome.
    pub numbers: String,
}

impl Case {
    /// Scene, ray configuration and structure.
    pub fn name(&self) -> String {
        [self.scene.as_str(), self.what.as_str()].join(" ").trim().to_owned()
    }
}

/// What a source claims.
#[derive(Clone, Copy, Debug)]
pub struct Statement {
    /// The source's name.
    pub source: &'static str,
    /// The source in a sentence: `the thesis`.
    pub document: &'static str,
    /// The claim's number; a letter where it has two halves.
    pub claim: &'static str,
    /// The claim itself.
    pub statement: &'static str,
    /// What has to be measured to judge it.
    pub needs: &'static str,
}

/// A claim and its verdict.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// The source's name.
    pub source: &'static str,
    /// The source in a sentence: `the thesis`.
    #[serde(skip)]
    pub document: &'static str,
    /// The claim's number; a letter where it has two halves.
    pub claim: &'static str,
    /// The claim itself.
    pub statement: &'static str,
    /// The device whose times are judged, or the GPU of the model; empty where no device is involved.
    pub device: String,
    /// The verdict.
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
    /// Contradicting cases in which the published numbers contradict as well.
    pub exceptions: Vec<String>,
    /// The published numbers judged in the same way: cases that agree, cases decided. Absent if there are none.
    pub published: Option<(usize, usize)>,
    /// All cases.
    pub cases: Vec<Case>,
    /// Measurements for this claim without a usable result, with the reason: the verdict does not rest on them.
    pub failed: Vec<String>,
    /// Measurements that are not judged, with the reason.
    pub left_out: Vec<String>,
    /// What has to be measured to judge the claim.
    pub needs: &'static str,
    /// What to beware of.
    pub warnings: Vec<String>,
}

impl Finding {
    /// Judges a claim by its cases; `published` are the same cases of the published numbers.
    pub fn of(statement: Statement, basis: Basis, cases: Vec<Case>, published: &[Case]) -> Finding {
        let outcomes: Vec<Outcome> = cases.iter().map(|case| case.outcome).collect();
        let count = |cases: &[Case], outcome| cases.iter().filter(|c| c.outcome == outcome).count();
        let is_exception = |case: &&Case| {
            let same = (&case.scene, &case.what, Outcome::Contradicts);
            case.outcome == Outcome::Contradicts && published.iter().any(|p| (&p.scene, &p.what, p.outcome) == same)
        };
        let exceptions: Vec<String> = cases.iter().filter(is_exception).map(Case::name).collect();
        let decided_cases = cases.iter().filter(|c| c.outcome != Outcome::Undecided);
        let mut scenes: Vec<&str> = decided_cases.map(|c| c.scene.as_str()).collect();
        scenes.sort_unstable();
        scenes.dedup();
        let decided = published.iter().filter(|c| c.outcome != Outcome::Undecided).count();
        Finding {
            source: statement.source,
            document: statement.document,
            claim: statement.claim,
            statement: statement.statement,
            device: String::new(),
            verdict: Verdict::of(&outcomes, exceptions.len()),
            basis,
            without_gpu: false,
            scenes: scenes.len(),
            agreeing: count(&cases, Outcome::Agrees),
            contradicting: count(&cases, Outcome::Contradicts),
            undecided: count(&cases, Outcome::Undecided),
            exceptions,
            published: (decided > 0).then(|| (count(published, Outcome::Agrees), decided)),
            cases,
            failed: Vec::new(),
            left_out: Vec::new(),
            needs: statement.needs,
            warnings: Vec::new(),
        }
    }
}

/// What a claim is judged by on a device, and what to beware of.
#[derive(Clone, Debug, PartialEq)]
pub struct Grounds {
    /// Frame times, or counts in their place.
    pub basis: Basis,
    /// True for frame times of a device that computes on the CPU.
    pub without_gpu: bool,
    /// Warnings for the finding.
    pub warnings: Vec<String>,
}

impl Grounds {
    /// The grounds of a claim whose own basis is `basis`, on a device if one is involved. Where that device's times say
    /// nothing about a GPU, counts decide; `counts` names them, and is none where they cannot. `remark` is a warning of
    /// the claim itself; it may be empty.
    pub fn of(basis: Basis, device: Option<&Device>, counts: Option<&str>, remark: &str) -> Grounds {
        let software = basis == Basis::FrameTimes && device.is_some_and(Device::is_software);
        let (basis, warning) = match counts.filter(|_| software) {
            Some(counts) => {
                let warning = format!("Judged by {counts} per ray: this device's times say nothing about a GPU's.");
                (Basis::Counts, Some(warning))
            }
            None if software => {
                (basis, Some("About this machine only: the device computes on the CPU and is no GPU.".to_owned()))
            }
            None => (basis, None),
        };
        let remark = Some(remark.to_owned()).filter(|remark| !remark.is_empty());
        let warnings = warning.into_iter().chain(remark).collect();
        Grounds { basis, without_gpu: software && basis == Basis::FrameTimes, warnings }
    }
}

/// The finding of a claim by the SIMT model of a GPU, in place of frame times; `None` without a case.
/// `notes` are on frames that were left out.
pub fn by_model(
    statement: Statement,
    gpu: &str,
    cases: Vec<Case>,
    printed: &[Case],
    (remark, notes): (&str, &[String]),
) -> Option<Finding> {
    let warnings = Some(remark.to_owned()).filter(|remark| !remark.is_empty()).into_iter().collect();
    (!cases.is_empty()).then(|| Finding {
        device: gpu.to_owned(),
        left_out: notes.iter().map(|note| capital(note)).collect(),
        warnings,
        ..Finding::of(statement, Basis::SimtModel, cases, printed)
    })
}

/// Findings of measurements, and those of the SIMT model, which are never counted together.
fn apart(findings: &[Finding]) -> [Vec<&Finding>; 2] {
    let (modelled, measured) = findings.iter().partition(|finding| finding.basis == Basis::SimtModel);
    [measured, modelled]
}

/// What findings by the SIMT model are, with the number of those with each verdict.
fn model_heading(document: &str, modelled: &[&Finding]) -> String {
    format!(
        "Claims of {document} by the SIMT model ({}): what warps of a GPU issue, counted without one. In place of times \
         there are millions of instructions that warps issue for a frame, over the resident warps; differences below \
         15 % decide nothing. Nothing of this was measured on a GPU: docs/simt-model.md has the model's limits.",
        totals(modelled)
    )
}

/// The number of findings with each verdict, in words.
fn totals(findings: &[&Finding]) -> String {
    let count = |verdict| findings.iter().filter(|f| f.verdict == verdict).count();
    let words = Verdict::ALL.into_iter().filter(|v| count(*v) > 0).map(|v| format!("{}: {}", v.in_words(), count(v)));
    words.collect::<Vec<_>>().join(", ")
}

/// A case's outcome in one character.
fn sign(outcome: Outcome) -> char {
    match outcome {
        Outcome::Agrees => '+',
        Outcome::Contradicts => '-',
        Outcome::Undecided => '?',
    }
}

/// Outcome, name and numbers of a case on one line.
fn line(case: &Case) -> String {
    format!("{} {}: {}", sign(case.outcome), case.name(), case.numbers)
}
