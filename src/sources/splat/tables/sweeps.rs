//! Rows that differ in radius, number of paths or tile alone.

use super::context::{Context, Draft, keys};
use crate::report::{Cell, Column, Form, Row, Table};
use crate::sources::splat::data::View;

/// The axes, with words for titles.
pub const AXES: [(&str, &str); 3] = [("radius", "radius"), ("paths", "number of paths"), ("tile", "size of a tile")];

/// A table for each device and axis.
pub fn tables(context: &Context) -> Vec<Table> {
    let of = |(axis, words): (&'static str, &str)| {
        context.tables(|view| measured(view, axis, words), || draft(words)).into_iter()
    };
    AXES.into_iter().flat_map(of).collect()
}

fn draft(words: &str) -> Draft {
    let whole = |group: &str, name: &str| Column::of(group, name, "", Form::Whole);
    let columns = vec![
        Column::new("time", "ms", Form::Time),
        whole("clusters", ""),
        whole("assignments", ""),
        whole("fullest", ""),
        whole("box", "tests"),
        whole("photon", "eval."),
        Column::new("RMSE", "", Form::Time),
        Column::of("RMSE", "scaled", "", Form::Time),
    ];
    let mut draft = Draft::new("sweeps", &format!("By {words}"), columns);
    draft.notes.push("Means over frames; rows of a group differ in this alone.".into());
    draft
}

fn measured(view: &View, axis: &str, words: &str) -> Draft {
    let mut draft = draft(words);
    for (_, m) in view.sweeps(axis).into_iter().flatten() {
        let metrics = [
            "clusters_mean",
            "assignments_mean",
            "fullest_cluster_mean",
            "box_tests_mean",
            "photon_evaluations_mean",
            "rmse",
            "rmse_scaled",
        ];
        let cells = std::iter::once(Cell::number(m.mean_ms)).chain(metrics.map(|name| Cell::number(m.metric(name))));
        draft.rows.push(Row { keys: keys(view, m), cells: cells.collect() });
    }
    draft
}
