//! The claims of the document, judged by measurements or by what it printed ([`crate::sources::claims`]).

mod builds;
mod frames;
mod list;
mod printed;
mod sizes;

use super::data::{Cost, Data, Failure, Size};
use super::models::SceneKey;
use super::published::Published;
use super::{DOCUMENT, SOURCE};
use crate::compare::judge::Outcome;
use crate::sources::claims::{self, Basis, Case, Finding, Grounds, Statement};
use list::{CLAIMS, Cases, Claim};

/// A case of a scene.
fn case(scene: impl ToString, what: impl Into<String>, outcome: Outcome, numbers: String) -> Case {
    Case { scene: scene.to_string(), what: what.into(), outcome, numbers }
}

/// The frames that a claim is judged by.
struct Frames<'a> {
    data: &'a Data,
    device: usize,
    size: Size,
    cost: Cost,
}

/// Judges every claim; those about frame times, or steps in their place, once per device. Without runs, the claims are
/// judged by what was printed.
pub fn judge(data: Option<&Data>, published: &Published) -> Vec<Finding> {
    let Some(data) = data else {
        let printed = |claim: &Claim| (claim.printed)(published);
        return CLAIMS.iter().map(|claim| Finding::of(claim.statement(), claim.basis, printed(claim), &[])).collect();
    };
    let mut findings = Vec::new();
    for claim in &CLAIMS {
        let printed = (claim.printed)(published);
        match claim.cases {
            Cases::Frames(cases) => {
                let of = |device| of_device(claim, cases, (data, published, device), &printed);
                findings.extend((0..data.devices.len()).map(of));
            }
            Cases::Rows(cases) => findings.push(of_rows(claim, cases(data, published), data, &printed)),
        }
    }
    findings
}

/// Judges the claims about frame times by the SIMT model, once for each of its GPUs.
pub fn by_model(modelled: &[Data], published: &Published) -> Vec<Finding> {
    let of = |claim: &'static Claim, data: &Data| {
        let Cases::Frames(cases) = claim.cases else { return None };
        let frames = Frames { data, device: 0, size: data.size(0, published.size(), None), cost: Cost::Work };
        let printed = (claim.printed)(published);
        let gpu = &data.devices[0].label;
        claims::by_model(claim.statement(), gpu, cases(&frames, published), &printed, (claim.remark, &data.notes))
    };
    CLAIMS.iter().flat_map(|claim| modelled.iter().filter_map(move |data| of(claim, data))).collect()
}

fn of_device(
    claim: &Claim,
    cases: fn(&Frames, &Published) -> Vec<Case>,
    (data, published, device): (&Data, &Published, usize),
    printed: &[Case],
) -> Finding {
    let of = &data.devices[device];
    let Grounds { basis, without_gpu, warnings } = Grounds::of(claim.basis, Some(of), Some("steps"), claim.remark);
    let cost = if basis == Basis::Counts { Cost::Steps } else { Cost::Time };
    let frames = Frames { data, device, size: data.size(device, published.size(), None), cost };
    Finding {
        device: of.label.clone(),
        without_gpu,
        failed: failed(claim, &frames),
        warnings,
        ..Finding::of(claim.statement(), basis, cases(&frames, published), printed)
    }
}

fn of_rows(claim: &Claim, cases: Vec<Case>, data: &Data, printed: &[Case]) -> Finding {
    Finding {
        left_out: (claim.left_out)(data),
        warnings: Grounds::of(claim.basis, None, None, claim.remark).warnings,
        ..Finding::of(claim.statement(), claim.basis, cases, printed)
    }
}

/// The measurements of a device that were made for a claim and never gave a result.
fn failed(claim: &Claim, frames: &Frames) -> Vec<String> {
    let is_measured = |f: &Failure| {
        frames.data.measurements.iter().map(|m| &m.frame).any(|m| {
            (m.device, &m.scene, &m.structure, &m.variant, m.width, m.height)
                == (f.device, &f.scene, &f.structure, &f.variant, f.width, f.height)
        })
    };
    let of_claim = |f: &&Failure| {
        f.device == frames.device
            && (f.width, f.height) == frames.size
            && claim.structures.iter().any(|s| s.is(&f.structure, &f.variant))
            && (claim.scenes)(&f.scene)
            && !is_measured(f)
    };
    frames.data.failures.iter().filter(of_claim).map(|f| format!("{} ({})", f.what, f.message)).collect()
}

impl Claim {
    fn statement(&self) -> Statement {
        Statement {
            source: SOURCE.name,
            document: DOCUMENT,
            claim: self.id,
            statement: self.statement,
            needs: self.needs,
        }
    }
}

/// Every scene.
fn any(_: &SceneKey) -> bool {
    true
}
