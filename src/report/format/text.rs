//! Tables for a terminal.

use crate::record::terminal::STYLE;
use crate::report::table::Table;
use crate::report::wrap::{WIDTH, wrap};
use comfy_table::{CellAlignment, ColumnConstraint, Width};

/// The least width of the first column and of words: ten letters, as in "conference".
const NAME: usize = 10;
/// Width that is kept for keys where other columns have words.
const KEYS: usize = 20;

/// Breaks keys that have options into lines of at most so many characters.
fn break_keys(drawn: &mut comfy_table::Table, table: &Table, most: usize) {
    for (row, mut cells) in drawn.row_iter_mut().zip(table.body("-")) {
        if let Some(key) = cells.first_mut() {
            *key = broken(key, most);
        }
        *row = cells.into();
    }
}

/// A name with options, in lines of at most `most` characters as far as its parts allow: `name:`, then ` a=1,` and
/// ` b=2`.
fn broken(key: &str, most: usize) -> String {
    if key.contains(' ') {
        return key.to_owned();
    }
    let mut lines = vec![String::new()];
    for part in key.split_inclusive([':', ',']) {
        let line = lines.last_mut().expect("there is one");
        if line.is_empty() || line.chars().count() + part.chars().count() <= most {
            line.push_str(part);
        } else {
            lines.push(format!(" {part}"));
        }
    }
    lines.join("\n")
}

/// Writes a table with its title above and its notes below.
pub fn write(table: &Table) -> String {
    let mut text = wrap(&table.caption(), "");
    let mut drawn = comfy_table::Table::new();
    let mut headings = table.keys.clone();
    if table.with_published {
        headings.push(String::new());
    }
    // Up to three lines of heading: group (above the first of its columns), name, unit
    let groups = table.columns.iter().any(|c| !c.group.is_empty());
    let units = table.columns.iter().any(|c| !c.unit.is_empty());
    let mut group = "";
    headings.extend(table.columns.iter().map(|column| {
        let mut lines = Vec::new();
        if groups {
            lines.push(if column.group == group { "" } else { column.group.as_str() });
            group = &column.group;
        }
        lines.push(&column.name);
        if units {
            lines.push(&column.unit);
        }
        lines.join("\n")
    }));
    drawn.load_style(STYLE).set_header(headings);
    for row in table.body("-") {
        drawn.add_row(row);
    }
    let last = table.key_columns() + table.columns.len() - 1;
    for (index, column) in drawn.column_iter_mut().enumerate() {
        column.set_padding((0, u16::from(index < last)));
        if index >= table.key_columns() {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    for index in (0..table.columns.len()).filter(|index| table.has_words(*index)) {
        // Columns of words share the terminal's width and are broken at spaces
        let share = (WIDTH - KEYS) / table.columns.len();
        if let Some(column) = drawn.column_mut(table.key_columns() + index) {
            column.set_cell_alignment(CellAlignment::Left);
            column.set_constraint(ColumnConstraint::UpperBoundary(Width::Fixed(share.max(NAME) as u16)));
        }
    }
    let width = |drawn: &comfy_table::Table| drawn.to_string().lines().map(|l| l.chars().count()).max().unwrap_or(0);
    let too_much = width(&drawn).saturating_sub(WIDTH);
    let names = table.rows.iter().map(|row| row.keys[0].chars().count()).max().unwrap_or(0);
    if let Some(column) = drawn.column_mut(0).filter(|_| too_much > 0) {
        // Long keys are broken at spaces, and in front of options, before any other column gets narrower
        let most = names.saturating_sub(too_much).max(NAME);
        column.set_constraint(ColumnConstraint::UpperBoundary(Width::Fixed(most as u16 + 1)));
        break_keys(&mut drawn, table, most);
    }
    if width(&drawn) > WIDTH {
        // Then one space between columns has to do
        drawn.column_iter_mut().skip(1).for_each(|column| {
            column.set_padding((0, 0));
        });
    }
    text += &drawn.trim_fmt();
    text.push('\n');
    for note in &table.notes {
        text += &wrap(note, "  ");
    }
    text
}
