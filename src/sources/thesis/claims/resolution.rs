//! Cases of claim 10: the rule for the grid's resolution against other resolutions.

use super::cases::is_uniform;
use super::options::work;
use super::{Case, case as new_case, frame_time};
use crate::compare::judge::{Outcome, Uncertain, less_by, not};
use crate::sources::thesis::data::Data;
use crate::sources::thesis::scenes::{SceneKey, ThesisScene};
use crate::sources::thesis::sweeps::{Point, grid_sweep};
use crate::workloads::trace::backend::Config;

/// At most this many times the best is near it.
pub const NEAR: f64 = 1.15;
/// At least this many times the best is far from it.
pub const FAR: f64 = 1.5;

/// The rule's cost and the least cost of a sweep over grid resolutions, each with its number of cells. `None` without a
/// coarser or without a finer grid than the rule's.
fn rule_and_best(points: &[Point], value: impl Fn(&Point) -> Option<Uncertain>) -> Option<[(Uncertain, u32); 2]> {
    let known: Vec<(&Point, Uncertain)> = points.iter().filter_map(|p| Some((p, value(p)?))).collect();
    let (rule, cost) = known.iter().find(|(p, _)| p.is_rule)?;
    let has = |finer: bool| known.iter().any(|(p, _)| (p.cells > rule.cells) == finer && p.cells != rule.cells);
    if !has(true) || !has(false) {
        return None;
    }
    let (best, least) = known.iter().min_by(|a, b| a.1.value.total_cmp(&b.1.value))?;
    Some([(*cost, rule.cells), (*least, best.cells)])
}

/// Cases of claim 10 on the scenes that `of` accepts; `unit` is the unit of the numbers.
fn rule_cases(
    data: &Data,
    of: impl Fn(&SceneKey) -> bool,
    rows: impl Fn(&SceneKey) -> Option<[(Uncertain, u32); 2]>,
    judge: impl Fn(Uncertain, Uncertain) -> Outcome,
    unit: &str,
) -> Vec<Case> {
    let scenes = data.scenes.iter().map(|s| &s.key).filter(|key| of(key));
    let case = |key: &SceneKey| {
        let [(rule, cells), (best, best_cells)] = rows(key)?;
        let write = |value: f64| match data.modelled {
            true => data.write_time(value),
            false => format!("{value:.2} {unit}"),
        };
        let numbers = format!(
            "{cells} cells on the shortest side by the rule: {}; best: {best_cells} cells, {} ({:.2} times)",
            write(rule.value),
            write(best.value),
            rule.value / best.value
        );
        Some(new_case(key, "P", judge(rule, best), numbers))
    };
    scenes.filter_map(case).collect()
}

fn by_time(data: &Data, device: usize, key: &SceneKey) -> Option<[(Uncertain, u32); 2]> {
    let points = grid_sweep(data, device, key, Config::P);
    rule_and_best(&points, |p| Some(frame_time(data, p.frame)))
}

fn by_counts(data: &Data, device: usize, key: &SceneKey) -> Option<[(Uncertain, u32); 2]> {
    let points = grid_sweep(data, device, key, Config::P);
    rule_and_best(&points, |p| Some(Uncertain::exact(work(data.counts_of_frame(p.frame, 0)?))))
}

/// Is the rule's cost at most [`NEAR`] times the best?
fn near(rule: Uncertain, best: Uncertain) -> Outcome {
    not(less_by(best, rule, NEAR))
}

/// Is the rule's cost at least [`FAR`] times the best?
fn far(rule: Uncertain, best: Uncertain) -> Outcome {
    less_by(best, rule, FAR)
}

/// True for a teapot in a stadium: small dense geometry in a large scene.
pub fn is_stadium(_: &Data, key: &SceneKey) -> bool {
    let built_in = match key.built() {
        SceneKey::Other(name, _) => name.split(':').next() == Some("stadium"),
        _ => false,
    };
    built_in || key.base_scene() == Some(ThesisScene::Robots)
}

const WORK: &str = "steps + tests per ray";

/// Claim 10a: the rule is near the best resolution for uniform geometry.
pub fn rule_near(data: &Data, device: usize) -> Vec<Case> {
    rule_cases(data, |key| is_uniform(data, key) == Some(true), |key| by_time(data, device, key), near, "ms")
}

/// Claim 10a, by counts.
pub fn rule_near_counts(data: &Data, device: usize) -> Vec<Case> {
    rule_cases(data, |key| is_uniform(data, key) == Some(true), |key| by_counts(data, device, key), near, WORK)
}

/// Claim 10b: the rule is far from it for a teapot in a stadium.
pub fn rule_far(data: &Data, device: usize) -> Vec<Case> {
    rule_cases(data, |key| is_stadium(data, key), |key| by_time(data, device, key), far, "ms")
}

/// Claim 10b, by counts.
pub fn rule_far_counts(data: &Data, device: usize) -> Vec<Case> {
    rule_cases(data, |key| is_stadium(data, key), |key| by_counts(data, device, key), far, WORK)
}
