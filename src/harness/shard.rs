//! Division of a plan among machines. Cases that are timed in interleaved passes stay together, so that everything that
//! is compared within a turn is measured on one machine.

use super::workload::Case;
use crate::error::{Error, Result};
use crate::record::run::Shard;
use std::collections::HashMap;
use std::str::FromStr;

/// Most shards of a plan.
const MAX_SHARDS: usize = 100_000;

impl FromStr for Shard {
    type Err = Error;

    /// Reads `I/N`, with I from 1 to N.
    fn from_str(text: &str) -> Result<Shard> {
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((index, count)) if (1..=MAX_SHARDS).contains(&count) && (1..=count).contains(&index) => {
                Ok(Shard { index, count })
            }
            _ => {
                let hint = format!("give I/N, such as 1/4: I from 1 to N, N from 1 to {MAX_SHARDS}");
                Err(Error::argument("--shard", format!("{text:?} is no shard"), hint))
            }
        }
    }
}

/// The shard of each case, from 1 to `count`: turns by decreasing work, each to the shard with the least work until
/// then. It depends on nothing but the cases.
pub fn assign(cases: &[Case], count: usize) -> Vec<usize> {
    let mut units: Vec<(u64, Vec<usize>)> = Vec::new();
    let mut unit_of: HashMap<(&str, &str), usize> = HashMap::new();
    for (index, case) in cases.iter().enumerate() {
        let unit = *unit_of.entry((&case.input, &case.turn)).or_insert_with(|| {
            units.push((0, Vec::new()));
            units.len() - 1
        });
        units[unit].0 = units[unit].0.saturating_add(case.work);
        units[unit].1.push(index);
    }
    // Stable: units of equal work keep the plan's order
    units.sort_by_key(|(work, _)| std::cmp::Reverse(*work));
    let (mut shards, mut work) = (vec![0; cases.len()], vec![0u64; count]);
    for (unit, indices) in units {
        let least = (0..count).min_by_key(|&shard| work[shard]).unwrap_or(0);
        // A unit without work still occupies a machine
        work[least] += unit.max(1);
        indices.iter().for_each(|&index| shards[index] = least + 1);
    }
    shards
}

/// The cases of a shard, in the plan's order.
///
/// # Errors
/// [`Error::Input`] if there are more shards than turns, so that this one is empty.
pub fn select(cases: &[Case], shard: Shard) -> Result<Vec<Case>> {
    let shards = assign(cases, shard.count);
    let own: Vec<Case> =
        cases.iter().zip(&shards).filter(|(_, of)| **of == shard.index).map(|(case, _)| case.clone()).collect();
    if own.is_empty() {
        let most = shards.iter().max().copied().unwrap_or(0);
        let problem = format!("shard {} of {} is empty", shard.index, shard.count);
        let hint = format!("divide this plan into at most {most}: cases that are timed together stay together");
        return Err(Error::argument("--shard", problem, hint));
    }
    Ok(own)
}
