//! Tables for other programs: one line per number, all tables under the same header.

use crate::thesis::table::{Cell, Table};

/// What the columns are.
const HEADER: [&str; 9] = ["table", "title", "row", "detail", "column", "unit", "value", "thesis", "ratio"];

/// All tables. Numbers stand in full; nothing is written where there is none. What the thesis printed stands in the column
/// `thesis` and nowhere else, so that whoever reads `value` has a run's numbers only.
pub fn write(tables: &[Table]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut line = |fields: [&str; 9]| {
        // Writing to memory cannot fail
        let _ = writer.write_record(fields);
    };
    line(HEADER);
    for table in tables {
        for row in &table.rows {
            let (first, rest) = row.keys.split_first().map_or(("", String::new()), |(f, r)| (f.as_str(), r.join(" ")));
            for (cell, column) in row.cells.iter().zip(&table.columns) {
                let (own, beside) = match cell {
                    Cell::Text(text) => (text.clone(), String::new()),
                    Cell::Number { value, thesis } => (number(value.map(|n| n.value)), number(thesis.map(|n| n.value))),
                };
                let (value, thesis) = if table.published { (String::new(), own) } else { (own, beside) };
                let name = [column.group.as_str(), column.name.as_str()].join(" ");
                let ratio = number(cell.ratio());
                line([&table.id, &table.title, first, &rest, name.trim(), &column.unit, &value, &thesis, &ratio]);
            }
        }
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// At most six decimals: no number here is worth more.
fn number(value: Option<f64>) -> String {
    value.map_or_else(String::new, |v| ((v * 1e6).round() / 1e6).to_string())
}
