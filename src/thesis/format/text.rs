//! Tables for a terminal.

use crate::record::table::STYLE;
use crate::thesis::table::{Cell, Table};
use comfy_table::{CellAlignment, ColumnConstraint, Width};

/// Columns of a terminal that notes are broken at; tables are made to fit it too.
const WIDTH: usize = 100;
/// Every scene of the thesis has room for its name.
const NAME: usize = 10;
/// Room for the names of rows beside descriptions.
const KEYS: usize = 20;

/// A table with its title above and its notes below.
pub fn write(table: &Table) -> String {
    let mut text = wrap(&table.caption(), "");
    let mut drawn = comfy_table::Table::new();
    let mut headings = table.keys.clone();
    if table.beside {
        headings.push(String::new());
    }
    // Three lines of heading, as far as they are used: group (above the first of its columns), name, unit
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
    let words = |index: usize| table.rows.iter().any(|row| matches!(row.cells.get(index), Some(Cell::Text(_))));
    for index in (0..table.columns.len()).filter(|index| words(*index)) {
        // Descriptions share what the terminal has, and are broken at their spaces
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
        // Long names are broken at their spaces before anything else gets less room
        let most = names.saturating_sub(too_much).max(NAME) as u16;
        column.set_constraint(ColumnConstraint::UpperBoundary(Width::Fixed(most + 1)));
    }
    if width(&drawn) > WIDTH {
        // Then columns stand closer together: one space is left between them
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

/// Breaks a text at spaces; lines begin with `indent`. A word that is longer than a line stands on its own.
pub fn wrap(text: &str, indent: &str) -> String {
    let (mut out, mut line) = (String::new(), String::new());
    for word in text.split_whitespace() {
        if !line.is_empty() && indent.len() + line.chars().count() + 1 + word.chars().count() > WIDTH {
            out += &format!("{indent}{line}\n");
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line += word;
    }
    out + indent + &line + "\n"
}
