//! The claims of the thesis, judged by measurements or by its own numbers ([`crate::sources::claims`]).

mod cases;
mod list;
mod occupancy;
mod options;
mod resolution;

pub use cases::{MIRRORS, UNIFORM_CROWDING, crowding};
pub use occupancy::ABOUT_20_PCT;
pub use resolution::{FAR, NEAR};

use super::data::{Data, Failure, Frame};
use super::published;
use super::scenes::SceneKey;
use super::{DOCUMENT, SOURCE};
use crate::compare::judge::{Outcome, UNKNOWN_NOISE_PCT, Uncertain};
use crate::sources::claims::{self, Basis, Case, Finding, Grounds, Statement};
use crate::workloads::trace::simt::model::CLOSE;
use list::{CLAIMS, Claim, NOT_MODELLED};

/// A case of a scene.
fn case(scene: &SceneKey, what: impl Into<String>, outcome: Outcome, numbers: String) -> Case {
    Case { scene: scene.to_string(), what: what.into(), outcome, numbers }
}

/// A mean frame time with its noise, or work in its place. The noise of a printed time is unknown, and none is assumed
/// in addition to the margin.
fn frame_time(data: &Data, frame: &Frame) -> Uncertain {
    if data.modelled {
        return Uncertain::modelled(frame.mean_ms, CLOSE - 1.0);
    }
    let unknown = if data.published { 0.0 } else { UNKNOWN_NOISE_PCT };
    Uncertain::time(frame.mean_ms, frame.noise_pct.unwrap_or(unknown))
}

/// Judges every claim; those about frame times, or counts in their place, once per device. Exceptions are those of a
/// published device.
pub fn judge(data: &Data, published: &Data, published_device: usize) -> Vec<Finding> {
    let mut findings = Vec::new();
    for claim in &CLAIMS {
        let printed = (claim.cases)(published, published_device);
        let devices = if claim.basis == Basis::FrameTimes { data.devices.len() } else { 1 };
        findings.extend((0..devices).map(|device| finding(claim, data, device, &printed)));
    }
    findings
}

/// Judges the claims about a GPU by the SIMT model, once for each of its GPUs. Exceptions are those of the same card,
/// if the thesis printed its times, otherwise of a published device.
pub fn by_model(modelled: &[Data], published: &Data, published_device: usize) -> Vec<Finding> {
    let of = |(claim, data): (&'static Claim, &Data)| {
        let gpu = &data.devices[0].label;
        let printed = (claim.cases)(published, published::device_of(gpu).unwrap_or(published_device));
        claims::by_model(statement(claim), gpu, (claim.cases)(data, 0), &printed, (claim.remark, &data.notes))
    };
    let claims = CLAIMS.iter().filter(|claim| claim.basis == Basis::FrameTimes && !NOT_MODELLED.contains(&claim.id));
    claims.flat_map(|claim| modelled.iter().map(move |data| (claim, data))).filter_map(of).collect()
}

fn statement(claim: &Claim) -> Statement {
    Statement {
        source: SOURCE.name,
        document: DOCUMENT,
        claim: claim.id,
        statement: claim.statement,
        needs: claim.needs,
    }
}

fn finding(claim: &Claim, data: &Data, device: usize, printed: &[Case]) -> Finding {
    let by_time = claim.basis == Basis::FrameTimes;
    let of = by_time.then(|| &data.devices[device]);
    let counts = claim.by_counts.map(|_| "steps and triangle tests");
    let Grounds { basis, without_gpu, warnings } = Grounds::of(claim.basis, of, counts, claim.remark);
    let cases = match claim.by_counts.filter(|_| basis == Basis::Counts) {
        Some(by_counts) => by_counts(data, device),
        None => (claim.cases)(data, device),
    };
    let found = Finding::of(statement(claim), basis, cases, printed);
    Finding {
        device: of.map_or_else(String::new, |device| device.label.clone()),
        without_gpu,
        published: found.published.filter(|_| !data.published),
        failed: if by_time { failed(claim, data, device) } else { Vec::new() },
        left_out: (claim.left_out)(data),
        warnings,
        ..found
    }
}

/// The measurements of a device that were made for a claim and never gave a result.
fn failed(claim: &Claim, data: &Data, device: usize) -> Vec<String> {
    let later = |failure: &Failure| {
        data.frames.iter().any(|f| {
            (f.device, f.config, f.width, f.height) == (device, failure.config, failure.width, failure.height)
                && f.scene == failure.scene
                && f.structure == failure.structure
                && f.variant == failure.variant
        })
    };
    let of_claim = |f: &&Failure| f.device == device && claim.scope.has(data, f) && !later(f);
    data.failures.iter().filter(of_claim).map(|f| format!("{} ({})", f.what, f.message)).collect()
}
