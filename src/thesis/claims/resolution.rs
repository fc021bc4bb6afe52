//! Cases of claim 10: the rule for the grid's resolution against other resolutions.

use super::Case;
use super::cases::is_uniform;
use super::compare::{Outcome, Uncertain, less_by, not};
use super::options::work;
use crate::thesis::data::Data;
use crate::thesis::scenes::{SceneKey, ThesisScene};
use crate::thesis::sweeps::{Point, grid_sweep};
use crate::workloads::trace::backend::Config;

/// At most this many times the best: near it.
pub const NEAR: f64 = 1.15;
/// At least this many times the best: far from it.
pub const FAR: f64 = 1.5;

/// What a sweep over grid resolutions says of the rule: its cost and the best one's, each with its resolution.
fn rule_and_best(points: &[Point], value: impl Fn(&Point) -> Option<Uncertain>) -> Option<[(Uncertain, u32); 2]> {
    let known: Vec<(&Point, Uncertain)> = points.iter().filter_map(|p| Some((p, value(p)?))).collect();
    let (rule, cost) = known.iter().find(|(p, _)| p.is_rule)?;
    let beside = |finer: bool| known.iter().any(|(p, _)| (p.cells > rule.cells) == finer && p.cells != rule.cells);
    if !beside(true) || !beside(false) {
        return None;
    }
    let (best, least) = known.iter().min_by(|a, b| a.1.value.total_cmp(&b.1.value))?;
    Some([(*cost, rule.cells), (*least, best.cells)])
}

/// Cases of claim 10 on the scenes that it is about; `unit` is what the numbers are.
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
        let numbers = format!(
            "{cells} cells on the shortest side by the rule: {:.2} {unit}; best: {best_cells} cells, {:.2} {unit} ({:.2} times)",
            rule.value,
            best.value,
            rule.value / best.value
        );
        Some(Case::new(key, "P", judge(rule, best), numbers))
    };
    scenes.filter_map(case).collect()
}

fn by_time(data: &Data, device: usize, key: &SceneKey) -> Option<[(Uncertain, u32); 2]> {
    let points = grid_sweep(data, device, key, Config::P);
    rule_and_best(&points, |p| Some(Uncertain::frame(data, p.frame)))
}

fn by_counts(data: &Data, device: usize, key: &SceneKey) -> Option<[(Uncertain, u32); 2]> {
    let points = grid_sweep(data, device, key, Config::P);
    rule_and_best(&points, |p| Some(Uncertain::exact(work(data.counts_behind(p.frame, 0)?))))
}

/// Not slower than the best by more than [`NEAR`].
fn near(rule: Uncertain, best: Uncertain) -> Outcome {
    not(less_by(best, rule, NEAR))
}

/// Slower than the best by at least [`FAR`].
fn far(rule: Uncertain, best: Uncertain) -> Outcome {
    less_by(best, rule, FAR)
}

/// A teapot in a stadium: small dense geometry in a large scene.
pub fn is_stadium(_: &Data, key: &SceneKey) -> bool {
    let built_in = match key.built() {
        SceneKey::Other(name, _) => name.split(':').next() == Some("stadium"),
        _ => false,
    };
    built_in || key.akin_to() == Some(ThesisScene::Robots)
}

const WORK: &str = "steps + tests per ray";

/// Claim 10, first half.
pub fn rule_near(data: &Data, device: usize) -> Vec<Case> {
    rule_cases(data, |key| is_uniform(data, key) == Some(true), |key| by_time(data, device, key), near, "ms")
}

/// Claim 10, first half, by counts.
pub fn rule_near_counts(data: &Data, device: usize) -> Vec<Case> {
    rule_cases(data, |key| is_uniform(data, key) == Some(true), |key| by_counts(data, device, key), near, WORK)
}

/// Claim 10, second half.
pub fn rule_far(data: &Data, device: usize) -> Vec<Case> {
    rule_cases(data, |key| is_stadium(data, key), |key| by_time(data, device, key), far, "ms")
}

/// Claim 10, second half, by counts.
pub fn rule_far_counts(data: &Data, device: usize) -> Vec<Case> {
    rule_cases(data, |key| is_stadium(data, key), |key| by_counts(data, device, key), far, WORK)
}
