//! Cases of claims 7, 8, 9 and 11: one structure against itself with another option.

use super::cases::{changed, is_shiny};
use super::{Case, case as new_case, frame_time};
use crate::compare::judge::{Uncertain, less, less_by};
use crate::sources::thesis::data::{CONFIGS, Counts, Data, config_adding};
use crate::sources::thesis::structures::{BVH, GRID, KDTREE, STRUCTURES};
use crate::sources::thesis::variant::Variant;
use crate::workloads::trace::backend::{Config, RAY_TYPES};

/// The factor of "more than doubles".
const DOUBLE: f64 = 2.0;

/// Cases of the default options against one other option: the default is claimed to be faster by this factor.
fn beats(data: &Data, device: usize, structure: &str, config: Config, option: (&str, &str), factor: f64) -> Vec<Case> {
    let case = |(plain, other): (&_, &_)| {
        let (a, b) = (frame_time(data, plain), frame_time(data, other));
        let numbers = format!(
            "default {}, {}={} {} ({:.2} times) at {side}x{side}",
            data.write_time(a.value),
            option.0,
            option.1,
            data.write_time(b.value),
            b.value / a.value,
            side = plain.width
        );
        new_case(&plain.scene, format!("{structure} {config:?}"), less_by(a, b, factor), numbers)
    };
    changed((data, device), structure, config, option).into_iter().map(|(a, b)| case((a, b))).collect()
}

/// Work per ray: steps and triangle tests, by the default convention.
pub(super) fn work(counts: &Counts) -> f64 {
    counts.steps.by(Default::default()) + counts.tests
}

/// The same cases by counts of one ray type of a device, with the work per ray in place of the time. A ray type is
/// traced under several configurations; of those that have both, the one that adds it is taken, and the largest image.
fn beats_by_counts(
    (data, device): (&Data, usize),
    structure: &str,
    ray: usize,
    (key, value): (&str, &str),
    factor: f64,
) -> Vec<Case> {
    let mut pairs: Vec<(&Counts, &Counts)> = Vec::new();
    for other in data.counts.iter().filter(|c| (c.device, c.ray) == (device, ray) && c.structure == structure) {
        let base = Variant::of_thesis(other.scene.thesis(), structure);
        if !other.variant.is(&base, key, value) {
            continue;
        }
        let Some(plain) = data.counts_with(other, &base) else { continue };
        let rank = |c: &Counts| (c.config == config_adding(ray), c.resolution);
        match pairs.iter_mut().find(|(p, _)| p.scene == plain.scene) {
            Some(pair) if rank(pair.0) < rank(plain) => *pair = (plain, other),
            Some(_) => {}
            None => pairs.push((plain, other)),
        }
    }
    let case = |(plain, other): (&Counts, &Counts)| {
        let (a, b) = (work(plain), work(other));
        let numbers = format!(
            "{side}x{side}, {:?}, steps + tests per {} ray: default {a:.2}, {key}={value} {b:.2} ({:.2} times)",
            plain.config,
            RAY_TYPES[ray],
            b / a,
            side = other.resolution
        );
        let outcome = less_by(Uncertain::exact(a), Uncertain::exact(b), factor);
        new_case(&other.scene, format!("{structure} {} rays", RAY_TYPES[ray]), outcome, numbers)
    };
    pairs.into_iter().map(case).collect()
}

/// Claim 7: a short stack against restart.
pub fn short_stack(data: &Data, device: usize) -> Vec<Case> {
    let of = |config| beats(data, device, KDTREE, config, ("search", "restart"), DOUBLE);
    CONFIGS.into_iter().flat_map(of).collect()
}

/// Claim 7, by counts of primary rays.
pub fn short_stack_counts(data: &Data, device: usize) -> Vec<Case> {
    beats_by_counts((data, device), KDTREE, 0, ("search", "restart"), DOUBLE)
}

/// Claim 8: the corrected vote against the original one.
pub fn vote(data: &Data, device: usize) -> Vec<Case> {
    shiny(data, beats(data, device, BVH, Config::PSR, ("vote", "original"), 1.0))
}

/// Claim 8, by counts of reflected rays.
pub fn vote_counts(data: &Data, device: usize) -> Vec<Case> {
    shiny(data, beats_by_counts((data, device), BVH, 2, ("vote", "original"), 1.0))
}

/// Keeps the cases on scenes with mirrors.
fn shiny(data: &Data, mut cases: Vec<Case>) -> Vec<Case> {
    let shiny = data.scenes.iter().filter(|s| is_shiny(data, &s.key));
    let names: Vec<String> = shiny.map(|s| s.key.to_string()).collect();
    cases.retain(|case| names.contains(&case.scene));
    cases
}

/// Claim 9: shadow rays from the light against those to it.
pub fn shadow_direction(data: &Data, device: usize) -> Vec<Case> {
    let of = |s| beats(data, device, s, Config::PS, ("shadows", "to-light"), 1.0);
    STRUCTURES.into_iter().flat_map(of).collect()
}

/// Claim 9, by counts of shadow rays.
pub fn shadow_direction_counts(data: &Data, device: usize) -> Vec<Case> {
    STRUCTURES.into_iter().flat_map(|s| beats_by_counts((data, device), s, 1, ("shadows", "to-light"), 1.0)).collect()
}

/// Claim 11: another grid traversal against the plain one, same options, largest size of both.
pub fn other_grid(data: &Data, device: usize, structure: &str) -> Vec<Case> {
    let mut cases = Vec::new();
    for scene in data.scenes.iter().map(|s| &s.key) {
        for config in CONFIGS {
            let pair = data.sides(device).into_iter().rev().find_map(|side| {
                let variant = Variant::of_thesis(scene.thesis(), GRID);
                let of = |structure| data.frame(device, scene, (structure, &variant), config, side);
                of(GRID).zip(of(structure))
            });
            let Some((plain, other)) = pair else { continue };
            let (a, b) = (frame_time(data, plain), frame_time(data, other));
            let side = plain.width;
            let numbers =
                format!("grid {}, {structure} {} at {side}x{side}", data.write_time(a.value), data.write_time(b.value));
            cases.push(new_case(scene, format!("{config:?}"), less(a, b), numbers));
        }
    }
    cases
}
