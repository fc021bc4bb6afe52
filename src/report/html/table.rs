//! Tables on a page.

use super::escape;
use crate::report::table::{Column, Line, Table};

/// Writes a table with its title above and its notes below.
pub fn write(table: &Table) -> String {
    let (title, head) = (escape(&table.caption()), head(table));
    let mut html =
        format!("<h3>{title}</h3>\n<div class=\"scroll\" tabindex=\"0\"><table>\n<thead>{head}</thead>\n<tbody>\n");
    let mut lines =
        table.rows.iter().flat_map(|row| row.lines(table.with_published).into_iter().map(move |line| (row, line)));
    for cells in table.body("–") {
        let Some((row, line)) = lines.next() else { break };
        let begins = if cells[0].is_empty() { "" } else { " begins" };
        let class = match line {
            Line::Value => "run",
            Line::Published => "published",
            Line::Ratio => "ratio",
        };
        html += &format!("<tr class=\"{class}{begins}\">");
        for (index, cell) in cells.iter().enumerate() {
            let words = index.checked_sub(table.key_columns()).and_then(|i| row.cells.get(i));
            let class = match words {
                None => " class=\"key\"",
                Some(cell) if cell.is_words() => " class=\"words\"",
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

/// One row of headings, or two if columns have groups.
fn head(table: &Table) -> String {
    let grouped = table.columns.iter().any(|column| !column.group.is_empty());
    let span = if grouped { " rowspan=\"2\"" } else { "" };
    let keys = table.keys.iter().map(String::as_str).chain(table.with_published.then_some(""));
    let keys: String = keys.map(|key| format!("<th class=\"key\"{span}>{}</th>", escape(key))).collect();
    let class = |index| if table.has_words(index) { " class=\"key\"" } else { "" };
    let names: String = table.columns.iter().enumerate().map(|(i, column)| heading(column, class(i))).collect();
    if !grouped {
        return format!("<tr>{keys}{names}</tr>");
    }
    let groups: String = table
        .columns
        .chunk_by(|a, b| a.group == b.group)
        .map(|group| format!("<th class=\"group\" colspan=\"{}\">{}</th>", group.len(), escape(&group[0].group)))
        .collect();
    format!("<tr>{keys}{groups}</tr><tr>{names}</tr>")
}

fn heading(column: &Column, class: &str) -> String {
    let unit = if column.unit.is_empty() { String::new() } else { format!("<small>{}</small>", escape(&column.unit)) };
    format!("<th{class}>{}{unit}</th>", escape(&column.name))
}
