//! The claims of the thesis and about its method, judged by the rows of one device: by times of stages on a GPU, by
//! counts of operations where times say nothing about one, and by counts, sizes and pictures where no times are needed.

mod clusters;
mod list;
mod quality;
mod times;
mod work;

use super::axes::unusual;
use super::data::{Data, Measurement, View};
use super::published::Published;
use super::{DOCUMENT, SOURCE};
use crate::compare::judge::{Outcome, Uncertain};
use crate::sources::claims::{Basis, Case, Finding, Statement};
use list::{CLAIMS, Claim};

/// Counts and errors of pictures that are closer than this decide nothing.
const COUNT_MARGIN: f64 = 0.01;

/// Cases of a claim and what they rest on.
pub struct Judged {
    /// What the cases rest on.
    pub basis: Basis,
    /// The cases.
    pub cases: Vec<Case>,
    /// What is not judged, with the reason.
    pub left_out: Vec<String>,
}

impl Judged {
    fn by(basis: Basis, cases: Vec<Case>) -> Judged {
        Judged { basis, cases, left_out: Vec::new() }
    }
}

/// All findings: by each device, or by what was printed.
pub fn judge(data: Option<&Data>, published: &Published) -> Vec<Finding> {
    let Some(data) = data else {
        let finding = |claim: &Claim| {
            let cases = (claim.printed)(published);
            let warnings = remark(claim).into_iter().collect();
            Finding { warnings, ..Finding::of(claim.statement(), claim.basis, cases, &[]) }
        };
        return CLAIMS.iter().map(finding).collect();
    };
    let views = data.views();
    CLAIMS.iter().flat_map(|claim| views.iter().map(|view| finding(claim, view, published))).collect()
}

fn remark(claim: &Claim) -> Option<String> {
    Some(claim.remark.to_owned()).filter(|remark| !remark.is_empty())
}

fn finding(claim: &Claim, view: &View, published: &Published) -> Finding {
    let Judged { basis, cases, left_out } = (claim.judge)(view);
    let is_timed = claim.basis == Basis::FrameTimes;
    let without_gpu = view.is_software() && basis == Basis::FrameTimes;
    let warning = match (view.is_software() && is_timed, basis) {
        (true, Basis::FrameTimes) if claim.is_about_any_device => {
            Some("About this machine only: the device computes on the CPU and is no GPU.")
        }
        (true, Basis::FrameTimes) => Some("Undecided: a software device, whose ratios of times are no GPU's."),
        (true, _) => Some("Judged by counts of operations: this device's times say nothing about a GPU's."),
        _ => None,
    };
    let failed = |f: &&super::data::Failure| {
        let technique = super::axes::value(&f.axes, "technique");
        format!("{} {technique} ({})", f.scene, f.message)
    };
    let failed: Vec<String> = view.failures.iter().filter(|_| is_timed).map(failed).collect();
    Finding {
        device: view.label().to_owned(),
        without_gpu,
        failed,
        left_out,
        warnings: warning.map(str::to_owned).into_iter().chain(remark(claim)).collect(),
        ..Finding::of(claim.statement(), basis, cases, &(claim.printed)(published))
    }
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

/// A count, or an error of a picture.
fn count(value: f64) -> Uncertain {
    Uncertain { value, noise: 0.0, margin: COUNT_MARGIN }
}

/// An outcome by times; a device that computes on the CPU decides none.
fn by_times(view: &View, outcome: Outcome) -> Outcome {
    if view.is_software() { Outcome::Undecided } else { outcome }
}

/// A case of a row.
fn case(view: &View, m: &Measurement, what: &str, outcome: Outcome, numbers: String) -> Case {
    let words = [view.words(m), view.conditions(m), what.to_owned()];
    let what = words.into_iter().filter(|words| !words.is_empty()).collect::<Vec<_>>().join(", ");
    Case { scene: m.scene.to_string(), what, outcome, numbers }
}

/// Rows whose options are the usual ones, but perhaps for one.
fn usual_but<'a>(view: &View<'a>, axis: &str) -> Vec<&'a Measurement> {
    let is = |m: &&Measurement| unusual(&m.axes, &view.usual).iter().all(|(name, _)| *name == axis);
    view.rows.iter().copied().filter(is).collect()
}

/// A whole number with a mark at thousands: `3,920,000`.
fn whole(value: f64) -> String {
    let digits = format!("{value:.0}");
    let from_end = |index: usize| (digits.len() - index).is_multiple_of(3) && index > 0;
    digits.chars().enumerate().flat_map(|(i, c)| from_end(i).then_some(',').into_iter().chain([c])).collect()
}
