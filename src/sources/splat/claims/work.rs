//! Claims about where a frame's time goes: by times of groups on a GPU, else by counts of operations.

use super::times::equal_times;
use super::{Judged, by_times, case, usual_but, whole};
use crate::compare::judge::{Outcome, Uncertain, all, less_by};
use crate::report::Form;
use crate::sources::claims::{Basis, Case};
use crate::sources::splat::data::{Measurement, View};
use crate::sources::splat::published::Published;
use crate::sources::splat::scenes::Role;
use crate::sources::splat::stages::Group;

/// Least gain by buckets that counts as the claimed one.
const GAIN: f64 = 4.0;
/// The quotient of two costs that are about the same, and the least that are not.
const SAME: (f64, f64) = (1.5, 2.0);
/// Most of a frame that the bucket estimate may take.
const SMALL: f64 = 0.05;
/// Correlation from which on times follow counts, and below which they do not.
const CORRELATION: (f64, f64) = (0.9, 0.5);

fn ms(value: f64) -> String {
    Form::Time.write(value)
}

/// A count of operations that is compared with those of another kind: less than twice as many decide nothing.
fn unlike(value: f64) -> Uncertain {
    Uncertain { value, noise: 0.0, margin: 1.0 }
}

/// Box tests, and entries or additions, of all walks of a frame.
fn walks(m: &Measurement) -> Option<f64> {
    let walks = if m.technique() == "per-sample" { 2.0 } else { 1.0 };
    Some(walks * (m.metric("box_tests_mean")? + m.metric("assignments_mean")?))
}

/// Evaluations of photons, or tests of directions, of a frame.
fn estimate(m: &Measurement) -> Option<f64> {
    m.metric(if m.technique() == "per-sample" { "photon_evaluations_mean" } else { "bucket_directions_mean" })
}

fn of_technique<'a>(view: &View<'a>, technique: &str) -> Vec<&'a Measurement> {
    usual_but(view, "").into_iter().filter(|m| m.technique() == technique).collect()
}

/// A time and the whole that it is part of: is it more than half?
fn most(m: &Measurement, part: f64, total: f64) -> Outcome {
    less_by(m.uncertain(total), m.uncertain(2.0 * part), 1.0)
}

/// Claim 5a.
pub fn estimate_dominates(view: &View) -> Judged {
    let rows = of_technique(view, "per-sample").into_iter();
    if view.is_software() {
        let of = |m: &Measurement| {
            let (evaluations, walks) = estimate(m).zip(walks(m))?;
            let outcome = less_by(unlike(walks), unlike(evaluations), 1.0);
            let numbers = format!(
                "{} photon evaluations, {} box tests and entries: {:.2} times",
                whole(evaluations),
                whole(walks),
                evaluations / walks
            );
            Some(case(view, m, "", outcome, numbers))
        };
        return Judged::by(Basis::Counts, rows.filter_map(of).collect());
    }
    let of = |m: &Measurement| {
        let (part, total) = m.group_ms(Group::E).zip(m.total_ms())?;
        let numbers = format!("{} of {} ms: {:.0} %", ms(part), ms(total), 100.0 * part / total);
        Some(case(view, m, "", most(m, part, total), numbers))
    };
    Judged::by(Basis::FrameTimes, rows.filter_map(of).collect())
}

/// Claim 5b.
pub fn splatting_dominates(view: &View) -> Judged {
    let rows = of_technique(view, "buckets").into_iter();
    if view.is_software() {
        let of = |m: &Measurement| {
            // Tests of directions and of boxes cost unlike times, and no count tells which
            let (directions, walks) = estimate(m).zip(walks(m))?;
            let numbers = format!("{} directions tested, {} box tests and additions", whole(directions), whole(walks));
            Some(case(view, m, "", Outcome::Undecided, numbers))
        };
        return Judged::by(Basis::FrameTimes, rows.filter_map(of).collect());
    }
    let of = |m: &Measurement| {
        let (estimate, splatting) = m.group_ms(Group::E).zip(m.group_ms(Group::D))?;
        let total = m.total_ms()?;
        let small = less_by(m.uncertain(estimate), m.uncertain(total), 1.0 / SMALL);
        let outcome = all([small, most(m, splatting, total)]);
        let share = |part: f64| 100.0 * part / total;
        let numbers = format!("estimate {:.1} %, splatting {:.0} %", share(estimate), share(splatting));
        Some(case(view, m, "", outcome, numbers))
    };
    Judged::by(Basis::FrameTimes, rows.filter_map(of).collect())
}

/// The printed group and the sum of a technique.
fn printed(published: &Published, technique: &str, group: Group) -> Option<(f64, f64)> {
    let part = published.group_ms(Role::Sponza, technique, group)?.value;
    Some((part, published.total_ms(Role::Sponza, technique)?.value))
}

fn printed_case(what: &str, agrees: bool, numbers: String) -> Case {
    let outcome = if agrees { Outcome::Agrees } else { Outcome::Contradicts };
    Case { scene: Role::Sponza.published().into(), what: what.into(), outcome, numbers }
}

/// Claim 5a by what was printed.
pub fn printed_estimate(published: &Published) -> Vec<Case> {
    let of = |(part, total): (f64, f64)| {
        let numbers = format!("{} of {} ms: {:.0} %", ms(part), ms(total), 100.0 * part / total);
        printed_case("per-sample", 2.0 * part > total, numbers)
    };
    printed(published, "per-sample", Group::E).map(of).into_iter().collect()
}

/// Claim 5b by what was printed.
pub fn printed_splatting(published: &Published) -> Vec<Case> {
    let of = |((estimate, total), (splatting, _)): ((f64, f64), (f64, f64))| {
        let share = |part: f64| 100.0 * part / total;
        let numbers = format!("estimate {:.1} %, splatting {:.0} %", share(estimate), share(splatting));
        printed_case("buckets", estimate < SMALL * total && 2.0 * splatting > total, numbers)
    };
    let both = printed(published, "buckets", Group::E).zip(printed(published, "buckets", Group::D));
    both.map(of).into_iter().collect()
}

/// The outcome for two costs that should be about the same.
fn about_the_same(quotient: f64) -> Outcome {
    match quotient.max(1.0 / quotient) {
        q if q <= SAME.0 => Outcome::Agrees,
        q if q > SAME.1 => Outcome::Contradicts,
        _ => Outcome::Undecided,
    }
}

/// Claim 6. Walks of per-sample are always two of one of buckets, so counts say nothing about splatting alone.
pub fn buckets_are_faster(view: &View) -> Judged {
    let mut cases = Vec::new();
    for (lists, buckets) in view.techniques() {
        let (frame, splatting, unit) = if view.is_software() {
            let together = |m: &Measurement| walks(m).zip(estimate(m)).map(|(walks, estimate)| walks + estimate);
            (together(lists).zip(together(buckets)), None, "operations")
        } else {
            let of_d = |m: &Measurement| m.group_ms(Group::D).filter(|ms| *ms > 0.0);
            (Some((lists.mean_ms, buckets.mean_ms)), of_d(lists).zip(of_d(buckets)), "ms")
        };
        let write = |value: f64| if view.is_software() { whole(value) } else { ms(value) };
        let numbers =
            |(a, b): (f64, f64)| format!("per-sample {}, buckets {} {unit}: {:.2} times", write(a), write(b), a / b);
        if let Some((a, b)) = frame {
            let outcome = less_by(buckets.uncertain(b), lists.uncertain(a), GAIN);
            cases.push(case(view, lists, "frame", outcome, numbers((a, b))));
        }
        if let Some((a, b)) = splatting {
            cases.push(case(view, lists, "splatting", about_the_same(a / b), numbers((a, b))));
        }
    }
    let basis = if view.is_software() { Basis::Counts } else { Basis::FrameTimes };
    Judged::by(basis, cases)
}

/// Claim 6 by what was printed.
pub fn printed_gain(published: &Published) -> Vec<Case> {
    let numbers = |a: f64, b: f64| format!("per-sample {}, buckets {} ms: {:.2} times", ms(a), ms(b), a / b);
    let both = printed(published, "per-sample", Group::D).zip(printed(published, "buckets", Group::D));
    let of = |((a_part, a), (b_part, b)): ((f64, f64), (f64, f64))| {
        let same = about_the_same(a_part / b_part) == Outcome::Agrees;
        [printed_case("frame", a / b >= GAIN, numbers(a, b)), printed_case("splatting", same, numbers(a_part, b_part))]
    };
    both.map(of).into_iter().flatten().collect()
}

/// Pearson's correlation of two lists, and milliseconds per million of the count through the means; `None` where
/// one of them does not change.
fn correlation(counts: &[f64], times: &[f64]) -> Option<(f64, f64)> {
    let n = counts.len() as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / n;
    let (x, y) = (mean(counts), mean(times));
    let sum = |of: &dyn Fn(f64, f64) -> f64| counts.iter().zip(times).map(|(a, b)| of(a - x, b - y)).sum::<f64>();
    let (xx, yy, xy) = (sum(&|a, _| a * a), sum(&|_, b| b * b), sum(&|a, b| a * b));
    (xx > 0.0 && yy > 0.0).then(|| (xy / (xx * yy).sqrt(), 1e6 * xy / xx))
}

/// Claim 7.
pub fn estimate_follows_evaluations(view: &View) -> Judged {
    let of = |m: &Measurement| {
        let counts = m.by_frame("evaluations");
        let stage = m.stages.iter().position(|stage| stage == "estimate")?;
        let times: Vec<f64> = m.stage_ms.iter().filter_map(|frame| frame.get(stage).copied()).collect();
        if counts.len() < 3 || counts.len() != times.len() {
            return None;
        }
        let (r, slope) = correlation(&counts, &times)?;
        let outcome = match r {
            r if r >= CORRELATION.0 => Outcome::Agrees,
            r if r < CORRELATION.1 => Outcome::Contradicts,
            _ => Outcome::Undecided,
        };
        let numbers =
            format!("correlation {r:.3} over {} frames, {} ms per million evaluations", counts.len(), ms(slope));
        Some(case(view, m, "", outcome, numbers))
    };
    Judged::by(Basis::FrameTimes, of_technique(view, "per-sample").into_iter().filter_map(of).collect())
}

/// Claim 8: along radii and numbers of paths. Counts of directions are equal by construction and decide nothing.
pub fn buckets_are_constant(view: &View) -> Judged {
    let mut cases = Vec::new();
    for axis in ["radius", "paths"] {
        let is = |group: &Vec<(f64, &Measurement)>| group.iter().all(|(_, m)| m.technique() == "buckets");
        for group in view.sweeps(axis).into_iter().filter(is) {
            let value = |m: &Measurement| m.stages_ms(|stage| stage == "estimate").filter(|ms| *ms > 0.0);
            let found: Vec<(&Measurement, f64)> =
                group.iter().filter_map(|(_, m)| value(m).map(|value| (*m, value))).collect();
            let Some((first, _)) = found.first().filter(|_| found.len() > 1) else { continue };
            let of = |of: fn(f64, f64) -> f64, start: f64| found.iter().map(|(_, value)| *value).fold(start, of);
            let (low, high) = (of(f64::min, f64::INFINITY), of(f64::max, 0.0));
            let numbers = format!("{} to {} ms: {:.2} times", ms(low), ms(high), high / low);
            let values: Vec<&str> = found.iter().map(|(m, _)| m.axis(axis)).collect();
            let what = format!("{axis} {}", values.join(", "));
            cases.push(case(view, first, &what, by_times(view, equal_times(&found)), numbers));
        }
    }
    Judged::by(Basis::FrameTimes, cases)
}
