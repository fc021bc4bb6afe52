//! Which rows of a baseline a run should have.

use crate::compare::baseline::Baseline;
use crate::compare::conditions::ComparedRun;
use crate::record::stream::Names;
use std::collections::{BTreeMap, BTreeSet};

/// Rows of a baseline that a run does not have.
pub(super) struct Vanished {
    /// Rows that the run's plan names.
    pub expected: Vec<String>,
    /// Number of the others.
    pub outside: usize,
}

/// The rows of a baseline that are not among those of a run, by whether its plan names their values.
pub(super) fn vanished(names: &Names, run: &ComparedRun, baseline: &Baseline, seen: &BTreeSet<String>) -> Vanished {
    let plan = &run.run.provenance.plan.axes;
    // An axis that a plan leaves to the workload, or whose values are called otherwise in rows, excludes nothing
    let mut usable: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (axis, values) in plan {
        let values: BTreeSet<&str> = values.iter().map(String::as_str).collect();
        if run.run.rows.iter().all(|row| values.contains(row.axis(names, axis))) {
            usable.insert(axis, values);
        }
    }
    let mut vanished = Vanished { expected: Vec::new(), outside: 0 };
    for key in baseline.rows.keys().filter(|key| !seen.contains(*key)) {
        let axes: BTreeMap<&str, &str> = key.split("; ").filter_map(|axis| axis.split_once('=')).collect();
        let is_planned =
            usable.iter().all(|(axis, values)| values.contains(axes.get(axis).copied().unwrap_or_default()));
        if is_planned { vanished.expected.push(key.clone()) } else { vanished.outside += 1 }
    }
    vanished
}
