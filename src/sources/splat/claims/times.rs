//! Claims that need times of stages of a GPU.

use super::{Judged, by_times, case, usual_but, whole};
use crate::compare::judge::{Outcome, TIME_MARGIN_PCT, less, less_by};
use crate::report::Form;
use crate::sources::claims::{Basis, Case};
use crate::sources::splat::data::{Measurement, View};
use crate::sources::splat::published::Published;
use crate::sources::splat::scenes::Role;

/// Most of a frame that keys and unique clusters may take, by technique.
const SHARES: [(&str, f64); 2] = [("per-sample", 0.01), ("buckets", 0.05)];

/// Gain by the intermediate step that counts as the claimed one.
const TWO_STEP_GAIN: f64 = 8.0;

/// Gain by leaving out the read-back that is little, and the least that is not.
const LITTLE: (f64, f64) = (1.10, 1.25);

fn ms(value: f64) -> String {
    Form::Time.write(value)
}

/// Milliseconds of keys and unique clusters.
fn unique_ms(m: &Measurement) -> Option<f64> {
    m.stages_ms(|stage| matches!(stage, "keys" | "unique"))
}

/// Claim 1.
pub fn keys_are_cheap(view: &View) -> Judged {
    let mut cases = Vec::new();
    for m in usual_but(view, "unique").into_iter().filter(|m| m.axis("unique") == "flags") {
        let Some((_, share)) = SHARES.iter().find(|(technique, _)| *technique == m.technique()) else { continue };
        let Some((part, total)) = unique_ms(m).zip(m.total_ms()) else { continue };
        let outcome = less_by(m.uncertain(part), m.uncertain(total), 1.0 / share);
        let numbers = format!("{} of {} ms: {:.2} %", ms(part), ms(total), 100.0 * part / total);
        cases.push(case(view, m, "", by_times(view, outcome), numbers));
    }
    Judged::by(Basis::FrameTimes, cases)
}

/// Claim 1 by what was printed: the three kernels by each frame of figure 5.2.
pub fn printed_keys(published: &Published) -> Vec<Case> {
    let of = |(technique, share): (&'static str, f64)| {
        let part = published.statement("samples, keys and prefix sum")?.value;
        let total = published.total_ms(Role::Sponza, technique)?.value;
        let outcome = if part < share * total { Outcome::Agrees } else { Outcome::Contradicts };
        let numbers = format!("{} of {} ms: {:.2} %", ms(part), ms(total), 100.0 * part / total);
        Some(Case { scene: Role::Sponza.published().into(), what: technique.into(), outcome, numbers })
    };
    SHARES.into_iter().filter_map(of).collect()
}

/// The outcome for times that should be equal: a quotient of at most the margin agrees, beyond twice it contradicts.
pub fn equal_times(rows: &[(&Measurement, f64)]) -> Outcome {
    let low = rows.iter().map(|(_, ms)| *ms).fold(f64::INFINITY, f64::min);
    let high = rows.iter().map(|(_, ms)| *ms).fold(0.0, f64::max);
    let noise = rows.iter().map(|(m, ms)| m.uncertain(*ms).noise).fold(0.0, f64::max);
    let margin = TIME_MARGIN_PCT / 100.0 + 2.0 * noise;
    match high / low - 1.0 {
        spread if spread <= margin => Outcome::Agrees,
        spread if spread > 2.0 * margin => Outcome::Contradicts,
        _ => Outcome::Undecided,
    }
}

/// Claim 2: rows of one size of image with equally many flags.
pub fn flags_are_constant(view: &View) -> Judged {
    let mut groups: Vec<Vec<(&Measurement, f64)>> = Vec::new();
    for m in view.rows.iter().copied().filter(|m| m.axis("unique") == "flags") {
        let Some(time) = m.stages_ms(|stage| stage == "unique").filter(|ms| *ms > 0.0) else { continue };
        let like = |other: &Measurement| {
            let same = |axis: &str| other.axis(axis) == m.axis(axis);
            other.part("source-flags", "bytes") == m.part("source-flags", "bytes")
                && other.metric("key_bits") == m.metric("key_bits")
                && ["resolution", "sync"].iter().all(|axis| same(axis))
                && other.settings == m.settings
        };
        match groups.iter_mut().find(|group| group.first().is_some_and(|(first, _)| like(first))) {
            Some(group) => group.push((m, time)),
            None => groups.push(vec![(m, time)]),
        }
    }
    let of = |group: &Vec<(&Measurement, f64)>| {
        let (first, _) = group.first()?;
        let differs = |(m, _): &(&Measurement, f64)| m.scene != first.scene || m.axis("tile") != first.axis("tile");
        if !group.iter().any(differs) {
            return None;
        }
        let of = |of: fn(f64, f64) -> f64, start: f64| group.iter().map(|(_, ms)| *ms).fold(start, of);
        let (low, high) = (of(f64::min, f64::INFINITY), of(f64::max, 0.0));
        let clusters = group.iter().filter_map(|(m, _)| m.metric("clusters_mean"));
        let (few, many) = clusters.fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
        let clusters =
            if few.is_finite() { format!(", {} to {} clusters", whole(few), whole(many)) } else { String::new() };
        let numbers =
            format!("{} to {} ms: {:.2} times, {} rows{clusters}", ms(low), ms(high), high / low, group.len());
        let what = format!("{}, unique=flags", first.axis("resolution"));
        Some(Case { scene: "all scenes".into(), what, outcome: by_times(view, equal_times(group)), numbers })
    };
    Judged::by(Basis::FrameTimes, groups.iter().filter_map(of).collect())
}

/// Claim 3.
pub fn flags_beat_sort(view: &View) -> Judged {
    let of = |(flags, sort): (&Measurement, &Measurement)| {
        let (a, b) = unique_ms(flags).zip(unique_ms(sort))?;
        let outcome = by_times(view, less(flags.uncertain(a), sort.uncertain(b)));
        let numbers = format!("flags {}, sort {} ms: {:.2} times", ms(a), ms(b), b / a);
        Some(case(view, flags, "", outcome, numbers))
    };
    Judged::by(Basis::FrameTimes, view.pairs("unique", "flags", "sort").into_iter().filter_map(of).collect())
}

/// Claim 4: by the stage's time on a GPU, else by atomic operations on global memory.
pub fn two_steps_beat_one(view: &View) -> Judged {
    let pairs = view.pairs("bounds", "direct", "two-step");
    if view.is_software() {
        let of = |(direct, steps): (&Measurement, &Measurement)| {
            let (a, b) = direct.metric("atomics_bounds_mean").zip(steps.metric("atomics_bounds_mean"))?;
            let outcome = match a {
                a if TWO_STEP_GAIN * b <= a && a > 0.0 => Outcome::Agrees,
                a if b < a => Outcome::Undecided,
                _ => Outcome::Contradicts,
            };
            let local = steps.metric("local_atomics_bounds_mean");
            let local = local.map_or(String::new(), |n| format!(", {} in work-group memory", whole(n)));
            let numbers = format!("{} atomic operations, {} with the step{local}", whole(a), whole(b));
            Some(case(view, direct, "", outcome, numbers))
        };
        return Judged::by(Basis::Counts, pairs.into_iter().filter_map(of).collect());
    }
    let of = |(direct, steps): (&Measurement, &Measurement)| {
        let time = |m: &Measurement| m.stages_ms(|stage| stage == "bounds").filter(|ms| *ms > 0.0);
        let (a, b) = time(direct).zip(time(steps))?;
        let outcome = less_by(steps.uncertain(b), direct.uncertain(a), TWO_STEP_GAIN);
        let numbers = format!("direct {}, two steps {} ms: {:.2} times", ms(a), ms(b), a / b);
        Some(case(view, direct, "", outcome, numbers))
    };
    Judged::by(Basis::FrameTimes, pairs.into_iter().filter_map(of).collect())
}

/// Claim 12.
pub fn read_back_costs_little(view: &View) -> Judged {
    let of = |(device, readback): (&Measurement, &Measurement)| {
        let gain = readback.mean_ms / device.mean_ms;
        let noise = device.uncertain(device.mean_ms).noise + readback.uncertain(readback.mean_ms).noise;
        let outcome = match gain {
            gain if gain <= LITTLE.0 + noise => Outcome::Agrees,
            gain if gain > LITTLE.1 + noise => Outcome::Contradicts,
            _ => Outcome::Undecided,
        };
        let numbers = format!("read back {}, not {} ms: {gain:.3} times", ms(readback.mean_ms), ms(device.mean_ms));
        case(view, device, "", by_times(view, outcome), numbers)
    };
    Judged::by(Basis::FrameTimes, view.pairs("sync", "device", "readback").into_iter().map(of).collect())
}
