//! Claims about errors of pictures and lost paths.

use super::{Judged, case, count, usual_but};
use crate::compare::judge::{Outcome, all, less};
use crate::report::Form;
use crate::sources::claims::{Basis, Case};
use crate::sources::splat::data::{Measurement, View};
use crate::sources::splat::scenes::Role;

/// Percent of paths that a scene under open sky loses, and below which nothing is lost.
const LOST_PCT: (f64, f64) = (5.0, 1.0);

fn number(value: f64) -> String {
    Form::Time.write(value)
}

/// Claim 13.
pub fn buckets_err(view: &View) -> Judged {
    let mut cases = Vec::new();
    for (lists, buckets) in view.techniques() {
        for (metric, what) in [("rmse", "RMSE"), ("rmse_scaled", "RMSE after the best scale")] {
            let Some((a, b)) = lists.metric(metric).zip(buckets.metric(metric)) else { continue };
            let numbers = format!("per-sample {}, buckets {}: {:.2} times", number(a), number(b), b / a);
            cases.push(case(view, lists, what, less(count(a), count(b)), numbers));
        }
    }
    for group in view.sweeps("blur") {
        let Some((_, sharp)) = group.iter().find(|(blur, _)| *blur == 0.0) else { continue };
        for (blur, blurred) in group.iter().filter(|(blur, _)| *blur > 0.0) {
            let Some((a, b)) = sharp.metric("rmse").zip(blurred.metric("rmse")) else { continue };
            let numbers = format!("RMSE {}, {} with the blur: {:.3} times", number(a), number(b), b / a);
            cases.push(case(view, sharp, &format!("blur={blur}"), less(count(b), count(a)), numbers));
        }
    }
    Judged::by(Basis::Pictures, cases)
}

/// Variance for one path, and squared bias: of two mean squared errors with unlike numbers of paths.
fn split((few, rmse_few): (f64, f64), (many, rmse_many): (f64, f64)) -> (f64, f64) {
    let variance = (rmse_few.powi(2) - rmse_many.powi(2)) / (1.0 / few - 1.0 / many);
    let variance = variance.max(0.0);
    (variance, (rmse_many.powi(2) - variance / many).max(0.0))
}

/// Claim 14.
pub fn radius_trades(view: &View) -> Judged {
    let mut cases = Vec::new();
    let mut judged: Vec<&Measurement> = Vec::new();
    for group in view.sweeps("radius") {
        let (Some((_, small)), Some((_, large))) = (group.first(), group.last()) else { continue };
        if judged.iter().any(|m| m.is_like(small, &["radius", "paths"])) {
            continue;
        }
        // The same two radii with the fewest and with the most paths that both have
        let at = |of: &Measurement, like: &Measurement| {
            view.rows.iter().copied().find(|m| {
                m.is_like(of, &["paths"]) && m.axis("paths") == like.axis("paths") && m.metric("rmse").is_some()
            })
        };
        let mut both: Vec<(f64, f64, f64)> = Vec::new();
        for row in view.rows.iter().filter(|m| m.is_like(small, &["paths"])) {
            let paths = row.axis("paths").parse::<f64>().ok();
            let errors =
                at(small, row).and_then(|m| m.metric("rmse")).zip(at(large, row).and_then(|m| m.metric("rmse")));
            both.extend(paths.zip(errors).map(|(paths, (small, large))| (paths, small, large)));
        }
        both.sort_by(|a, b| a.0.total_cmp(&b.0));
        let what = format!("radius {} and {}", small.axis("radius"), large.axis("radius"));
        match (both.first(), both.last()) {
            (Some(few), Some(many)) if many.0 > few.0 => {
                judged.push(small);
                let of_small = split((few.0, few.1), (many.0, many.1));
                let of_large = split((few.0, few.2), (many.0, many.2));
                // The noise of as many paths as the fewest
                let noise = |of: (f64, f64)| (of.0 / few.0).sqrt();
                let bias = |of: (f64, f64)| of.1.sqrt();
                let numbers = |a: f64, b: f64| format!("{} and {}", number(a), number(b));
                let (a, b) = (noise(of_small), noise(of_large));
                cases.push(case(view, small, &format!("{what}, noise"), less(count(b), count(a)), numbers(a, b)));
                let (a, b) = (bias(of_small), bias(of_large));
                cases.push(case(view, small, &format!("{what}, bias"), less(count(a), count(b)), numbers(a, b)));
            }
            _ => cases.extend(by_radii_alone(view, small, large)),
        }
    }
    Judged::by(Basis::Pictures, cases)
}

/// Claim 14 with one number of paths: errors do not tell noise from bias, so that it may be contradicted by the means,
/// but not agreed with.
fn by_radii_alone(view: &View, small: &Measurement, large: &Measurement) -> Option<Case> {
    let both = |name: &str| small.metric(name).zip(large.metric(name));
    let (errors, ratios) = (both("rmse"), both("ratio_to_path_traced"));
    let bias = ratios.map(|(a, b)| less(count((a - 1.0).abs()), count((b - 1.0).abs())));
    let errors = errors.map(|(a, b)| format!("RMSE {} and {}", number(a), number(b)));
    let means = ratios.map(|(a, b)| format!("mean by the path-traced one {a:.3} and {b:.3}"));
    let numbers: Vec<String> = errors.into_iter().chain(means).collect();
    let what = format!("radius {} and {}, one number of paths", small.axis("radius"), large.axis("radius"));
    let outcome = all([Outcome::Undecided].into_iter().chain(bias));
    (!numbers.is_empty()).then(|| case(view, small, &what, outcome, numbers.join(", ")))
}

/// Claim 15.
pub fn open_sky_wastes(view: &View) -> Judged {
    let mut judged = Judged::by(Basis::Counts, Vec::new());
    let mut seen: Vec<&Measurement> = Vec::new();
    for m in usual_but(view, "hits") {
        let like = |other: &&Measurement| {
            other.scene == m.scene && ["light", "hits", "paths"].iter().all(|axis| other.axis(axis) == m.axis(axis))
        };
        let hits: Vec<f64> = (1..).map_while(|hit: usize| m.part(&format!("hit-{hit}"), "arrived")).collect();
        let (Some(arrived), Ok(paths)) = (hits.last(), m.axis("paths").parse::<f64>()) else { continue };
        if seen.iter().any(like) {
            continue;
        }
        seen.push(m);
        let lost = 100.0 * (1.0 - arrived / paths);
        let outcome = match lost {
            lost if lost >= LOST_PCT.0 => Outcome::Agrees,
            _ if m.scene.role != Role::Sponza => {
                let words = format!("{} loses {lost:.1} % of its paths: taken for closed, not judged", m.scene);
                if !judged.left_out.contains(&words) {
                    judged.left_out.push(words);
                }
                continue;
            }
            lost if lost < LOST_PCT.1 => Outcome::Contradicts,
            _ => Outcome::Undecided,
        };
        let before = std::iter::once(&paths).chain(&hits);
        let each: Vec<String> =
            before.zip(&hits).map(|(before, after)| format!("{:.1}", 100.0 * (1.0 - after / before))).collect();
        let numbers = format!("{lost:.1} % lost; by hit {} %", each.join(", "));
        let light = if m.axis("light").is_empty() { String::new() } else { format!(", light {}", m.axis("light")) };
        let what = format!("{} hits, {} paths{light}", m.axis("hits"), m.axis("paths"));
        judged.cases.push(Case { scene: m.scene.to_string(), what, outcome, numbers });
    }
    judged
}
