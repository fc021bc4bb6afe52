//! The claims of the thesis (SPEC section 10), judged by measurements.
//!
//! A claim is about *cases*: a scene, often with a ray configuration or a structure. Each case agrees, contradicts, or is
//! undecided because the difference is smaller than the noise. The claim holds if at least one case agrees and none
//! contradicts; cases in which the thesis's own numbers contradict its claim as well do not count against it, and are
//! named. Without any case it is not measured, which is a verdict of its own and never a "holds".

mod cases;
mod compare;
mod options;
mod render;

pub use cases::{MIRRORS, UNIFORM_REFERENCES};
pub use compare::{Outcome, UNKNOWN_NOISE_PCT};
pub use options::{FAR, NEAR, WORTH_PCT};
pub use render::{Form, details, sign, summary, totals, write};

use super::data::Data;
use super::scenes::SceneKey;
use serde::Serialize;

/// How a claim was decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// At least one case agrees, none contradicts (but for the thesis's own exceptions).
    Holds,
    /// A case contradicts.
    DoesNotHold,
    /// There are cases, and in all of them the difference is smaller than the noise.
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
    /// Number of scenes with a decided case.
    pub scenes: usize,
    /// Cases that agree.
    pub agreeing: usize,
    /// Cases that contradict.
    pub contradicting: usize,
    /// Cases within the noise.
    pub undecided: usize,
    /// Contradicting cases in which the thesis's own numbers contradict as well.
    pub exceptions: Vec<String>,
    /// The thesis's own numbers judged in the same way: cases that agree, cases decided. Absent where it printed none.
    pub thesis: Option<(usize, usize)>,
    /// All cases.
    pub cases: Vec<Case>,
    /// What would have to be measured; said where nothing was.
    pub needs: &'static str,
    /// What to beware of.
    pub warnings: Vec<String>,
}

/// A claim: its words, and how to find its cases.
struct Claim {
    id: &'static str,
    statement: &'static str,
    needs: &'static str,
    /// Frame times say something about a GPU only on a GPU; a claim of the other kinds is judged once, not per device.
    basis: Basis,
    /// Cases from frame times, sizes or build times.
    cases: fn(&Data, usize) -> Vec<Case>,
    /// Cases from counts, where there is a way.
    by_counts: Option<fn(&Data) -> Vec<Case>>,
    /// What to know about its cases.
    remark: &'static str,
}

const CLAIMS: [Claim; 15] = [
    Claim {
        id: "1",
        statement: "Build time: grid < BVH < kd-tree",
        needs: "grid, bvh and kdtree of a scene",
        basis: Basis::BuildTimes,
        cases: |data, _| cases::build_times(data),
        by_counts: None,
        remark: "Single builds, taken as uncertain by 5 %.",
    },
    Claim {
        id: "2",
        statement: "Memory: BVH < kd-tree < grid",
        needs: "grid, bvh and kdtree of a scene",
        basis: Basis::Sizes,
        cases: |data, _| cases::memory(data),
        by_counts: None,
        remark: "By the thesis's accounting, geometry included.",
    },
    Claim {
        id: "3",
        statement: "P and PS: BVH packets are fastest on ordinary scenes",
        needs: "grid, kdtree and bvh on a scene that is not uniform, P or PS",
        basis: Basis::FrameTimes,
        cases: cases::bvh_fastest,
        by_counts: None,
        remark: "Ordinary: a rule-sized grid has five references per triangle or more (all walk-through scenes of the thesis).",
    },
    Claim {
        id: "4",
        statement: "PSR with more than a few percent of mirrors: kd-tree < BVH < grid in time",
        needs: "grid, kdtree and bvh, PSR, on a scene of which more than 3 % mirrors",
        basis: Basis::FrameTimes,
        cases: cases::mirrors,
        by_counts: None,
        remark: "A few percent: 3 % of the surface. Of the printed numbers: scenes where reflections cost 10 % or more.",
    },
    Claim {
        id: "5",
        statement: "The grid is slowest on every non-uniform scene",
        needs: "grid, kdtree and bvh on a scene that is not uniform",
        basis: Basis::FrameTimes,
        cases: cases::grid_slowest,
        by_counts: None,
        remark: "The thesis itself grants one exception, the scene with the fewest triangles.",
    },
    Claim {
        id: "6a",
        statement: "Time per ray falls as resolution rises",
        needs: "grid, kdtree and bvh at two resolutions",
        basis: Basis::FrameTimes,
        cases: cases::time_per_ray_falls,
        by_counts: None,
        remark: "From the smallest to the largest resolution that all three structures have.",
    },
    Claim {
        id: "6b",
        statement: "Time per ray falls most for BVH packets",
        needs: "grid, kdtree and bvh at two resolutions",
        basis: Basis::FrameTimes,
        cases: cases::bvh_gains_most,
        by_counts: None,
        remark: "From the smallest to the largest resolution that all three structures have.",
    },
    Claim {
        id: "7",
        statement: "A short stack of four more than doubles the speed of restart",
        needs: "kdtree and kdtree:search=restart",
        basis: Basis::FrameTimes,
        cases: options::short_stack,
        by_counts: Some(options::short_stack_counts),
        remark: "",
    },
    Claim {
        id: "8",
        statement: "Not letting rays vote that want neither child speeds reflected rays up (up to 20 %)",
        needs: "bvh and bvh:vote=original, PSR, on a scene of which more than 3 % mirrors",
        basis: Basis::FrameTimes,
        cases: options::vote,
        by_counts: Some(options::vote_counts),
        remark: "",
    },
    Claim {
        id: "9",
        statement: "Shadow rays from the light beat shadow rays to the light",
        needs: "a structure by default and with shadows=to-light, PS",
        basis: Basis::FrameTimes,
        cases: options::shadow_direction,
        by_counts: Some(options::shadow_direction_counts),
        remark: "",
    },
    Claim {
        id: "10a",
        statement: "The resolution rule 4 n^(1/4) is near the best for uniform geometry",
        needs: "grid with at least one coarser and one finer factor, P, on a uniform scene",
        basis: Basis::FrameTimes,
        cases: options::rule_near,
        by_counts: Some(options::rule_near_counts),
        remark: "Near: at most 15 % above the best that was measured.",
    },
    Claim {
        id: "10b",
        statement: "The resolution rule is far from the best for a teapot in a stadium",
        needs: "grid with at least one coarser and one finer factor, P, on robots or the built-in stadium",
        basis: Basis::FrameTimes,
        cases: options::rule_far,
        by_counts: Some(options::rule_far_counts),
        remark: "Far: at least 50 % above the best that was measured.",
    },
    Claim {
        id: "11a",
        statement: "grid-coop is slower than the plain grid",
        needs: "grid and grid-coop with the same resolution",
        basis: Basis::FrameTimes,
        cases: |data, device| options::other_grid(data, device, "grid-coop"),
        by_counts: None,
        remark: "",
    },
    Claim {
        id: "11b",
        statement: "grid-packet is slower than the plain grid",
        needs: "grid and grid-packet with the same resolution",
        basis: Basis::FrameTimes,
        cases: |data, device| options::other_grid(data, device, "grid-packet"),
        by_counts: None,
        remark: "",
    },
    Claim {
        id: "12",
        statement: "How many threads fit on a processor is worth about 20 %",
        needs: "a structure by default and with group=WxH (kdtree also memory=private), PSR",
        basis: Basis::FrameTimes,
        cases: options::occupancy,
        by_counts: None,
        remark: "A stand-in: wgpu has no register limit, so work-group shape and the memory of the stack are varied. \
                 It agrees where the best or worst choice differs by 10 % or more from the default.",
    },
];

/// Judges every claim; those about frame times once per device. `card` is the published card for comparison.
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
            (Basis::Counts, by_counts(data))
        }
        None => (claim.basis, (claim.cases)(data, device)),
    };
    if software && basis == Basis::FrameTimes {
        warnings.push("About this machine only: the device computes on the CPU and is no GPU.".to_owned());
    }
    if !claim.remark.is_empty() {
        warnings.push(claim.remark.to_owned());
    }
    let count = |outcome| cases.iter().filter(|c| c.outcome == outcome).count();
    let (agreeing, contradicting, undecided) =
        (count(Outcome::Agrees), count(Outcome::Contradicts), count(Outcome::Undecided));
    // Printed numbers are judged as they stand: there is nobody to excuse them
    let excused = |case: &&Case| {
        !data.published
            && thesis.iter().any(|t| (&t.scene, &t.what, t.outcome) == (&case.scene, &case.what, Outcome::Contradicts))
    };
    let against = cases.iter().filter(|c| c.outcome == Outcome::Contradicts);
    let exceptions: Vec<String> = against.filter(excused).map(Case::name).collect();
    let verdict = match (agreeing, contradicting - exceptions.len(), undecided) {
        _ if cases.is_empty() => Verdict::NotMeasured,
        (_, 1.., _) => Verdict::DoesNotHold,
        (1.., 0, _) => Verdict::Holds,
        (0, 0, _) if contradicting > 0 => Verdict::DoesNotHold,
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
        scenes: scenes.len(),
        agreeing,
        contradicting,
        undecided,
        exceptions,
        thesis: (decided > 0 && !data.published).then_some((thesis_agrees, decided)),
        cases,
        needs: claim.needs,
        warnings,
    }
}
