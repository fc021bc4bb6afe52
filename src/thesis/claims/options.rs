//! Cases of claims 7 to 12: one structure against itself with another option.

use super::Case;
use super::cases::{changed, is_shiny, is_uniform, ms};
use super::compare::{Outcome, Uncertain, less, less_by, not};
use crate::backend::{Config, RAY_TYPES};
use crate::thesis::data::{Counts, Data, STRUCTURES};
use crate::thesis::scenes::{SceneKey, ThesisScene};
use crate::thesis::sweeps::{Point, grid_sweep};
use crate::thesis::tables::occupancy::stand_ins;
use crate::thesis::variant::Variant;

/// At most this many times the best: near it.
pub const NEAR: f64 = 1.15;
/// At least this many times the best: far from it.
pub const FAR: f64 = 1.5;
/// A change of so many percent is worth speaking of.
pub const WORTH_PCT: f64 = 10.0;

/// "More than doubles".
const DOUBLE: f64 = 2.0;

/// The default against an option: does the default beat it, by this factor?
fn beats(data: &Data, device: usize, structure: &str, config: Config, option: (&str, &str), factor: f64) -> Vec<Case> {
    let case = |(plain, other): (&_, &_)| {
        let (a, b) = (Uncertain::frame(data, plain), Uncertain::frame(data, other));
        let numbers = format!(
            "default {}, {}={} {} ({:.2} times) at {side}x{side}",
            ms(a.value),
            option.0,
            option.1,
            ms(b.value),
            b.value / a.value,
            side = plain.width
        );
        Case::new(&plain.scene, format!("{structure} {config:?}"), less_by(a, b, factor), numbers)
    };
    changed((data, device), structure, config, option).into_iter().map(|(a, b)| case((a, b))).collect()
}

/// Work per ray: steps and triangle tests, by the default convention.
fn work(counts: &Counts) -> f64 {
    counts.steps.by(Default::default()) + counts.tests
}

/// The same by counts of one ray type: the work per ray stands for the time.
fn beats_by_counts(data: &Data, structure: &str, ray: usize, (key, value): (&str, &str), factor: f64) -> Vec<Case> {
    let mut cases = Vec::new();
    for other in data.counts.iter().filter(|c| c.structure == structure && c.ray == ray) {
        let base = Variant::of_thesis(other.scene.thesis(), structure);
        if !other.variant.is(&base, key, value) {
            continue;
        }
        let Some(plain) = data.counts_at(&other.scene, structure, &base, ray, other.resolution) else { continue };
        let (a, b) = (work(plain), work(other));
        let numbers = format!(
            "{side}x{side}, steps + tests per {} ray: default {a:.2}, {key}={value} {b:.2} ({:.2} times)",
            RAY_TYPES[ray],
            b / a,
            side = other.resolution
        );
        let outcome = less_by(Uncertain::exact(a), Uncertain::exact(b), factor);
        cases.push(Case::new(&other.scene, format!("{structure} {} rays", RAY_TYPES[ray]), outcome, numbers));
    }
    cases
}

/// Claim 7.
pub fn short_stack(data: &Data, device: usize) -> Vec<Case> {
    let of = |config| beats(data, device, "kdtree", config, ("search", "restart"), DOUBLE);
    Config::ALL.into_iter().flat_map(of).collect()
}

/// Claim 7, by counts of primary rays.
pub fn short_stack_counts(data: &Data) -> Vec<Case> {
    beats_by_counts(data, "kdtree", 0, ("search", "restart"), DOUBLE)
}

/// Claim 8.
pub fn vote(data: &Data, device: usize) -> Vec<Case> {
    shiny(data, beats(data, device, "bvh", Config::PSR, ("vote", "original"), 1.0))
}

/// Claim 8, by counts of reflected rays.
pub fn vote_counts(data: &Data) -> Vec<Case> {
    shiny(data, beats_by_counts(data, "bvh", 2, ("vote", "original"), 1.0))
}

/// Cases on scenes with mirrors.
fn shiny(data: &Data, mut cases: Vec<Case>) -> Vec<Case> {
    let shiny = data.scenes.iter().filter(|s| is_shiny(data, &s.key));
    let names: Vec<String> = shiny.map(|s| s.key.to_string()).collect();
    cases.retain(|case| names.contains(&case.scene));
    cases
}

/// Claim 9.
pub fn shadow_direction(data: &Data, device: usize) -> Vec<Case> {
    let of = |s| beats(data, device, s, Config::PS, ("shadows", "to-light"), 1.0);
    STRUCTURES.into_iter().flat_map(of).collect()
}

/// Claim 9, by counts of shadow rays.
pub fn shadow_direction_counts(data: &Data) -> Vec<Case> {
    STRUCTURES.into_iter().flat_map(|s| beats_by_counts(data, s, 1, ("shadows", "to-light"), 1.0)).collect()
}

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

fn by_counts(data: &Data, key: &SceneKey) -> Option<[(Uncertain, u32); 2]> {
    let points: Vec<Point> =
        (0..data.devices.len()).flat_map(|device| grid_sweep(data, device, key, Config::P)).collect();
    let counts = |p: &Point| data.counts_at(key, "grid", &p.frame.variant, 0, p.frame.width);
    rule_and_best(&points, |p| Some(Uncertain::exact(work(counts(p)?))))
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
fn is_stadium(key: &SceneKey) -> bool {
    match key {
        SceneKey::Thesis(scene) => *scene == ThesisScene::Robots,
        SceneKey::Other(name, _) => {
            name.split(':').next() == Some("stadium") || key.tessellation_of() == Some(ThesisScene::Robots)
        }
    }
}

const WORK: &str = "steps + tests per ray";

/// Claim 10, first half.
pub fn rule_near(data: &Data, device: usize) -> Vec<Case> {
    rule_cases(data, |key| is_uniform(data, key) == Some(true), |key| by_time(data, device, key), near, "ms")
}

/// Claim 10, first half, by counts.
pub fn rule_near_counts(data: &Data) -> Vec<Case> {
    rule_cases(data, |key| is_uniform(data, key) == Some(true), |key| by_counts(data, key), near, WORK)
}

/// Claim 10, second half.
pub fn rule_far(data: &Data, device: usize) -> Vec<Case> {
    rule_cases(data, is_stadium, |key| by_time(data, device, key), far, "ms")
}

/// Claim 10, second half, by counts.
pub fn rule_far_counts(data: &Data) -> Vec<Case> {
    rule_cases(data, is_stadium, |key| by_counts(data, key), far, WORK)
}

/// Claim 11: another grid traversal against the plain one, same options, largest size of both.
pub fn other_grid(data: &Data, device: usize, structure: &str) -> Vec<Case> {
    let mut cases = Vec::new();
    for scene in data.scenes.iter().map(|s| &s.key) {
        for config in Config::ALL {
            let pair = data.sides(device).into_iter().rev().find_map(|side| {
                let variant = Variant::of_thesis(scene.thesis(), "grid");
                let of = |structure| data.frame(device, scene, (structure, &variant), config, side);
                of("grid").zip(of(structure))
            });
            let Some((plain, other)) = pair else { continue };
            let (a, b) = (Uncertain::frame(data, plain), Uncertain::frame(data, other));
            let side = plain.width;
            let numbers = format!("grid {}, {structure} {} at {side}x{side}", ms(a.value), ms(b.value));
            cases.push(Case::new(scene, format!("{config:?}"), less(a, b), numbers));
        }
    }
    cases
}

/// Claim 12: the register limit where it is printed, its stand-ins where they are measured. A case is a scene and a
/// structure; what counts is the option that changes most, in either direction.
pub fn occupancy(data: &Data, device: usize) -> Vec<Case> {
    if data.published {
        let rows = data.register_limit.iter().filter(|row| row.device == device);
        let case = |row: &crate::thesis::data::RegisterLimit| {
            let speedup = f64::from(row.speedup?);
            let outcome = if speedup.abs() >= WORTH_PCT { Outcome::Agrees } else { Outcome::Contradicts };
            let numbers = format!("{} registers: {speedup} % faster", row.registers);
            Some(Case::new(&SceneKey::Thesis(row.scene), row.structure.clone(), outcome, numbers))
        };
        return rows.filter_map(case).collect();
    }
    let pairs = stand_ins(data, device);
    let mut cases: Vec<(f64, Case)> = Vec::new();
    for pair in &pairs {
        let (a, b) = (Uncertain::frame(data, pair.base), Uncertain::frame(data, pair.changed));
        let change = 100.0 * (1.0 - b.value / a.value);
        let noise = 100.0 * (a.noise + b.noise);
        let outcome = match change.abs() {
            size if size >= WORTH_PCT + noise => Outcome::Agrees,
            size if size < WORTH_PCT - noise => Outcome::Contradicts,
            _ => Outcome::Undecided,
        };
        let numbers = format!("default {}, {} {}: {change:.0} % faster", ms(a.value), pair.option, ms(b.value));
        let case = Case::new(&pair.base.scene, pair.base.structure.clone(), outcome, numbers);
        match cases.iter_mut().find(|(_, c)| (&c.scene, &c.what) == (&case.scene, &case.what)) {
            Some(known) if known.0 < change.abs() => *known = (change.abs(), case),
            Some(_) => {}
            None => cases.push((change.abs(), case)),
        }
    }
    cases.into_iter().map(|(_, case)| case).collect()
}
