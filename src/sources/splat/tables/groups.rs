//! Times of the five groups of figure 5.2, their shares of the frame, and every stage on its own.

use super::context::{Context, Draft, KEYS, failures, keys, printed_keys};
use crate::report::{Cell, Column, Form, Number, Row, Table};
use crate::sources::splat::data::{Measurement, View};
use crate::sources::splat::published::Published;
use crate::sources::splat::scenes::Role;
use crate::sources::splat::stages::{Group, STAGES};

/// The techniques of the figure.
const TECHNIQUES: [&str; 2] = ["per-sample", "buckets"];

/// Both tables of each device: milliseconds, and shares.
pub fn tables(context: &Context) -> Vec<Table> {
    let of = |shares: bool| {
        context.tables(|view| measured(context, view, shares), || printed(context.published, shares)).into_iter()
    };
    of(false).chain(of(true)).collect()
}

fn draft(shares: bool) -> Draft {
    let (unit, form) = if shares { ("%", Form::Fixed(1)) } else { ("ms", Form::Time) };
    let column = |group: Group| Column::of(group.letter(), "", unit, form);
    let mut columns: Vec<Column> = Group::ALL.into_iter().map(column).collect();
    let title = if shares { "Shares of a frame by groups of stages" } else { "Mean frame by groups of stages" };
    if !shares {
        columns.push(Column::of("sum", "", unit, form));
        columns.push(Column::of("frame", "", unit, form));
    }
    let mut draft = Draft::new("5.2", title, columns);
    let words = Group::ALL.map(|group| format!("{}: {}", group.letter(), group.title()));
    draft.notes.push(format!("{}.", words.join("; ")));
    draft
}

/// Numbers of a technique in a scene: groups, and where milliseconds are shown, their sum.
fn numbers(published: &Published, role: Role, technique: &str, shares: bool) -> Vec<Option<Number>> {
    let total = published.total_ms(role, technique);
    let of = |group: Group| {
        let ms = published.group_ms(role, technique, group)?;
        if !shares {
            return Some(ms);
        }
        Some(Number { value: 100.0 * ms.value / total?.value, places: Some(1) })
    };
    let mut numbers: Vec<Option<Number>> = Group::ALL.into_iter().map(of).collect();
    if !shares {
        numbers.extend([total, None]);
    }
    numbers
}

fn printed(published: &Published, shares: bool) -> Draft {
    let mut draft = draft(shares);
    for technique in TECHNIQUES {
        let numbers = numbers(published, Role::Sponza, technique, shares).into_iter();
        let cells = numbers.map(|value| Cell::Number { value, published: None }).collect();
        draft.rows.push(Row { keys: printed_keys(published, Role::Sponza, technique), cells });
    }
    draft.notes.push(about_printed());
    draft
}

fn about_printed() -> String {
    "Printed: figure 5.2, Sponza by Crytek; the GPU is not named (RTX 2080 by the size of its times), and small values \
     are in groups by their place in the chart."
        .into()
}

fn measured(context: &Context, view: &View, shares: bool) -> Draft {
    let mut draft = draft(shares);
    let rows: Vec<&Measurement> = view.usual_rows().collect();
    for m in &rows {
        let printed = numbers(context.published, m.scene.role, m.technique(), shares).into_iter();
        let own = own(m, shares).into_iter();
        let cells = own.zip(printed).map(|(own, printed)| context.cell(own, printed)).collect();
        draft.rows.push(Row { keys: keys(view, m), cells });
    }
    for role in context.absent(&rows).into_iter().filter(|role| *role == Role::Sponza) {
        for technique in TECHNIQUES {
            let printed = numbers(context.published, role, technique, shares).into_iter();
            let cells = printed.map(|printed| context.cell(None, printed)).collect();
            let keys = ["sponza", technique, "", "", "", ""].map(str::to_owned).into();
            draft.rows.push(Row { keys, cells });
        }
    }
    draft.notes.extend(about_rows(&rows));
    if context.options.published {
        draft.notes.push(about_printed());
    }
    draft.notes.extend(failures(view));
    draft
}

/// What the groups of these rows do not show.
fn about_rows(rows: &[&Measurement]) -> Vec<String> {
    let mut notes = Vec::new();
    if rows.iter().any(|m| m.technique() == "tiled") {
        notes.push("tiled: group E contains the search for the photons of each tile.".into());
    }
    if rows.iter().any(|m| m.axis("sync") == "readback") {
        notes.push("sync=readback: the frame contains the wait for the host, the sum of the stages does not.".into());
    }
    notes
}

/// Measured groups of a row, and where milliseconds are shown, sum of the stages and the frame.
fn own(m: &Measurement, shares: bool) -> Vec<Option<f64>> {
    let total = m.total_ms().filter(|total| *total > 0.0);
    let of = |group: Group| {
        let ms = m.group_ms(group)?;
        if shares { total.map(|total| 100.0 * ms / total) } else { Some(ms) }
    };
    let mut numbers: Vec<Option<f64>> = Group::ALL.into_iter().map(of).collect();
    if !shares {
        numbers.extend([total, Some(m.mean_ms)]);
    }
    numbers
}

/// A row for each stage of every row with times of stages.
pub fn stages(context: &Context) -> Vec<Table> {
    let draft = || {
        let columns = vec![Column::new("time", "ms", Form::Time), Column::new("share", "%", Form::Fixed(1))];
        let mut draft = Draft::new("stages", "Mean time of each stage", columns);
        draft.keys = KEYS.into_iter().chain(["stage"]).collect();
        draft
    };
    let of = |view: &View| {
        let mut draft = draft();
        for m in view.usual_rows() {
            let total = m.total_ms();
            let known = STAGES.iter().map(|(name, group)| format!("{} {name}", group.letter()));
            for stage in &m.stages {
                let ms = m.stages_ms(|other| other == stage);
                let label = known.clone().find(|label| label[2..] == *stage).unwrap_or_else(|| match stage {
                    hit if hit.starts_with("hit-") => format!("A {hit}"),
                    other => other.clone(),
                });
                let share = ms.zip(total).map(|(ms, total)| 100.0 * ms / total);
                let keys = keys(view, m).into_iter().chain([label]).collect();
                draft.rows.push(Row { keys, cells: vec![Cell::number(ms), Cell::number(share)] });
            }
        }
        draft
    };
    let printed = || {
        let mut draft = draft();
        draft.notes.push("Figure 5.1 stacks the times of all kernels; its lines cannot be read.".into());
        draft
    };
    context.tables(of, printed)
}
