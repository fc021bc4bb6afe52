//! Clusters, nodes, assignments and work, and the nodes of each level.

use super::context::{Context, Draft, KEYS, keys};
use crate::report::{Cell, Column, Form, Number, Row, Table};
use crate::sources::splat::data::{Measurement, View};
use crate::sources::splat::scenes::Role;

/// Levels of the hierarchy.
const LEVELS: usize = 5;

/// Both tables of each device: counts, and nodes by level.
pub fn tables(context: &Context) -> Vec<Table> {
    let counts = context.tables(|view| counts(context, view), || printed(context));
    let levels = context.tables(levels, levels_draft);
    counts.into_iter().chain(levels).collect()
}

fn draft() -> Draft {
    let of = |group: &str, name: &str| Column::of(group, name, "", Form::Whole);
    let columns = vec![
        of("clusters", "mean"),
        of("clusters", "max"),
        of("assignments", "mean"),
        of("assignments", "max"),
        of("fullest", "mean"),
        of("fullest", "max"),
        Column::of("fullest", "by mean", "", Form::Fixed(1)),
        of("box", "tests"),
        Column::of("tests", "by assign.", "", Form::Fixed(2)),
    ];
    let mut draft = Draft::new("clusters", "Clusters and their photons", columns);
    draft.notes.push(
        "Means over frames. Fullest: most photons in a cluster; by mean: the mean of each frame's fullest cluster by \
         the mean photons of a cluster."
            .into(),
    );
    draft
}

/// Upper bounds and the fullest cluster that were printed.
fn bounds(context: &Context, role: Role, technique: &str) -> [Option<Number>; 9] {
    let mut bounds = [None; 9];
    let chart = context.published.chart(role, technique, context.published_device());
    bounds[3] = chart.and_then(|chart| chart.assignments_max);
    bounds[5] = context.published.statement("photons of the fullest cluster").filter(|_| role == Role::Sponza);
    bounds
}

fn about_printed() -> String {
    "Printed: assignments at most the end of the charts' axes; the fullest cluster of figure 5.3, whose scene is not \
     named; clusters at most a few tens of thousands."
        .into()
}

fn printed(context: &Context) -> Draft {
    let mut draft = draft();
    for role in Role::THESIS {
        let bounds = bounds(context, role, "per-sample");
        let cells = bounds.map(|value| Cell::Number { value, published: None }).into();
        draft.rows.push(Row { keys: super::context::printed_keys(context.published, role, "both"), cells });
    }
    draft.notes.push(about_printed());
    draft
}

/// How many times the photons of a mean cluster the fullest one has.
pub fn unevenness(m: &Measurement) -> Option<f64> {
    let (clusters, assignments) = (m.metric("clusters_mean")?, m.metric("assignments_mean")?);
    let fullest = m.metric("fullest_cluster_mean").or_else(|| m.metric("fullest_cluster"))?;
    (assignments > 0.0).then(|| fullest * clusters / assignments)
}

fn counts(context: &Context, view: &View) -> Draft {
    let mut draft = draft();
    for m in view.rows.iter().filter(|m| m.metric("clusters_mean").is_some()) {
        let metric = |name: &str| m.metric(name);
        let tests = metric("box_tests_mean");
        let by_assignments = tests.zip(metric("assignments_mean")).map(|(tests, of)| tests / of);
        let own = [
            metric("clusters_mean"),
            metric("clusters_max"),
            metric("assignments_mean"),
            metric("assignments_max"),
            metric("fullest_cluster_mean"),
            metric("fullest_cluster"),
            unevenness(m),
            tests,
            by_assignments.filter(|ratio| ratio.is_finite()),
        ];
        let bounds = bounds(context, m.scene.role, m.technique());
        let cells = own.into_iter().zip(bounds).map(|(own, bound)| context.cell(own, bound)).collect();
        draft.rows.push(Row { keys: keys(view, m), cells });
    }
    if context.options.published {
        draft.notes.push(about_printed());
    }
    draft
}

fn levels_draft() -> Draft {
    let level = |level| Column::of("level", &format!("{level}"), "", Form::Whole);
    let mut columns: Vec<Column> = (0..LEVELS).map(level).collect();
    columns.push(Column::new("inner nodes", "", Form::Whole));
    columns.push(Column::new("clusters", "", Form::Whole));
    let mut draft = Draft::new("clusters", "Nodes with children by level", columns);
    draft.keys = KEYS.into_iter().collect();
    draft.notes.push("Means over frames; the array has room for 1, 8, 256, 8192 and 262144 nodes at 23 bits.".into());
    draft
}

fn levels(view: &View) -> Draft {
    let mut draft = levels_draft();
    for m in view.rows.iter().filter(|m| m.part("level-0", "nodes").is_some()) {
        let of_level = |level| Cell::number(m.part(&format!("level-{level}"), "nodes"));
        let mut cells: Vec<Cell> = (0..LEVELS).map(of_level).collect();
        cells.extend(["inner_nodes_mean", "clusters_mean"].map(|name| Cell::number(m.metric(name))));
        draft.rows.push(Row { keys: keys(view, m), cells });
    }
    draft
}
