//! A comparison as tables: exact quantities first, then means, then rows.

use super::{Comparison, PairedRow, Ratio};
use crate::record::stream::{Name, Names};
use crate::report::{Cell, Column, Form, Origin, Row, Table};
use std::collections::HashMap;

const ORIGIN: Origin = Origin { source: "compare", kind: "table", published: "" };

/// How much tables show.
#[derive(Clone, Copy, Debug)]
pub struct Shown {
    /// Most rows of a table; those with the largest differences are shown.
    pub rows: usize,
}

/// The tables of a comparison.
pub fn tables(comparison: &Comparison, names: &Names, shown: Shown) -> Vec<Table> {
    let mut tables = vec![exact(comparison, names, shown)];
    if !comparison.means.is_empty() {
        tables.push(means(comparison));
    }
    tables.push(rows(comparison, shown));
    tables
}

fn table(id: &str, title: &str, keys: &[&str], columns: Vec<Column>, rows: Vec<Row>, notes: Vec<String>) -> Table {
    Table {
        origin: ORIGIN,
        id: id.to_owned(),
        title: title.to_owned(),
        keys: keys.iter().map(|key| (*key).to_owned()).collect(),
        columns,
        rows,
        notes,
        with_published: false,
        is_published: false,
    }
}

fn text(name: &str) -> Column {
    Column::new(name, "", Form::Whole)
}

fn exact(comparison: &Comparison, names: &Names, shown: Shown) -> Table {
    // By quantity: how many rows differ, and the first of them
    let mut order: Vec<Name> = Vec::new();
    let mut found: HashMap<Name, (usize, usize)> = HashMap::new();
    for (index, change) in comparison.changes.iter().enumerate() {
        let entry = found.entry(change.quantity).or_insert_with(|| {
            order.push(change.quantity);
            (0, index)
        });
        entry.0 += 1;
    }
    let row = |quantity: &Name| {
        let (count, first) = found[quantity];
        let change = comparison.changes[first];
        Row {
            keys: vec![names.text(*quantity).to_owned(), comparison.rows[change.row].label.clone()],
            cells: vec![
                Cell::Text(change.old.write(names)),
                Cell::Text(change.new.write(names)),
                Cell::number(count as f64),
            ],
        }
    };
    let rows: Vec<Row> = order.iter().take(shown.rows).map(row).collect();
    let (differing, all) = (comparison.changes.len(), comparison.exact_compared);
    let note = match differing {
        0 => format!("all {all} exact quantities agree"),
        _ => format!("{differing} of {all} exact quantities differ; of each quantity the first row is shown"),
    };
    let columns = vec![text("old"), text("new"), Column::new("rows", "", Form::Whole)];
    table("1", "Exact quantities that differ", &["quantity", "row"], columns, rows, vec![note])
}

fn means(comparison: &Comparison) -> Table {
    let row = |mean: &super::Mean| Row {
        keys: vec![if mean.axis.is_empty() { "all rows".into() } else { mean.axis.clone() }, mean.value.clone()],
        cells: vec![Cell::number(mean.rows as f64), Cell::number(mean.ratio)],
    };
    let columns = vec![Column::new("rows", "", Form::Whole), Column::new("new/old", "", Form::Fixed(3))];
    let rows = comparison.means.iter().map(row).collect();
    table("2", "Geometric means of time ratios", &["axis", "value"], columns, rows, Vec::new())
}

fn rows(comparison: &Comparison, shown: Shown) -> Table {
    let mut order: Vec<&PairedRow> = comparison.rows.iter().collect();
    let is_cut = order.len() > shown.rows;
    if is_cut {
        // What has no ratio first: it is what a reader has to know
        let size = |row: &PairedRow| row.ratio.map_or(f64::INFINITY, |ratio| ratio.estimate.value.ln().abs());
        order.sort_by(|a, b| size(b).total_cmp(&size(a)));
        order.truncate(shown.rows);
    }
    let mut columns: Vec<Column> =
        comparison.sides.iter().map(|side| Column::of("mean frame", &side.name, "ms", Form::Time)).collect();
    columns.extend([Column::new("new/old", "", Form::Fixed(3)), text("interval"), text("verdict")]);
    let row = |row: &&PairedRow| {
        let mut cells: Vec<Cell> = row.times_ms.iter().map(|time| Cell::number(*time)).collect();
        cells.push(Cell::number(row.ratio.map(|ratio| ratio.estimate.value)));
        cells.push(Cell::Text(row.ratio.map_or(String::new(), |ratio| interval(&ratio))));
        cells.push(Cell::Text(row.verdict.describe()));
        Row { keys: vec![row.label.clone()], cells }
    };
    let mut notes = vec![format!("{} rows: {}", comparison.rows.len(), comparison.counts())];
    if is_cut {
        notes.push(format!("the {} rows with the largest differences are shown; CSV and JSON have all", shown.rows));
    }
    notes.extend(comparison.notes.iter().cloned());
    table("3", "Times", &["row"], columns, order.iter().map(row).collect(), notes)
}

/// The ends of an interval; in brackets where they are those of all quotients.
pub(super) fn interval(ratio: &Ratio) -> String {
    let ends = format!("{:.3}..{:.3}", ratio.estimate.low, ratio.estimate.high);
    if ratio.has_interval { ends } else { format!("({ends})") }
}
