//! Tables on the page.

use super::html::escape;
use crate::thesis::table::{Cell, Column, Line, Table};

/// All tables.
pub fn write(tables: &[Table]) -> String {
    tables.iter().map(one).collect()
}

/// What there is no table of.
pub fn absent(ids: &[&str]) -> String {
    if ids.is_empty() {
        return String::new();
    }
    format!("<p class=\"note\">Nothing was measured for: {}.</p>\n", ids.join(", "))
}

fn one(table: &Table) -> String {
    let mut html =
        format!("<h3>{}</h3>\n<div class=\"scroll\" tabindex=\"0\"><table>\n<thead><tr>", escape(&table.caption()));
    for key in &table.keys {
        html += &format!("<th class=\"key\">{}</th>", escape(key));
    }
    if table.beside {
        html += "<th class=\"key\"></th>";
    }
    for (index, column) in table.columns.iter().enumerate() {
        let words = table.rows.iter().any(|row| matches!(row.cells.get(index), Some(Cell::Text(_))));
        html += &heading(column, if words { " class=\"key\"" } else { "" });
    }
    html += "</tr></thead>\n<tbody>\n";
    let mut lines = table.rows.iter().flat_map(|row| row.lines(table.beside).into_iter().map(move |line| (row, line)));
    for cells in table.body("–") {
        let Some((row, line)) = lines.next() else { break };
        let begins = if cells[0].is_empty() { "" } else { " begins" };
        let class = match line {
            Line::Value => "run",
            Line::Thesis => "thesis",
            Line::Ratio => "ratio",
        };
        html += &format!("<tr class=\"{class}{begins}\">");
        for (index, cell) in cells.iter().enumerate() {
            let words = index.checked_sub(table.key_columns()).and_then(|i| row.cells.get(i));
            let class = match words {
                None => " class=\"key\"",
                Some(Cell::Text(_)) => " class=\"words\"",
                Some(_) => "",
            };
            html += &format!("<td{class}>{}</td>", escape(cell));
        }
        html += "</tr>\n";
    }
    html += "</tbody></table></div>\n";
    for note in &table.notes {
        html += &format!("<p class=\"note\">{}</p>\n", escape(note));
    }
    html
}

fn heading(column: &Column, class: &str) -> String {
    let words = [column.group.as_str(), column.name.as_str()].join(" ");
    let unit = if column.unit.is_empty() { String::new() } else { format!("<small>{}</small>", escape(&column.unit)) };
    format!("<th{class}>{}{unit}</th>", escape(words.trim()))
}
