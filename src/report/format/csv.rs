//! Tables for other programs: one line per number, all tables under the same header.

use crate::report::Form;
use crate::report::table::{Cell, Table};

/// The names of the columns.
const HEADER: [&str; 10] =
    ["source", "table", "title", "row", "detail", "column", "unit", "value", "published", "ratio"];

/// Writes all tables. Numbers have all their digits; an absent one is empty. Published numbers are in the column
/// `published` and nowhere else, so that a program that reads `value` has a run's numbers only.
pub fn write(tables: &[Table]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut line = |fields: [&str; 10]| {
        // Writing to memory cannot fail
        let _ = writer.write_record(fields);
    };
    line(HEADER);
    for table in tables {
        for row in &table.rows {
            let (first, rest) = row.keys.split_first().map_or(("", String::new()), |(f, r)| (f.as_str(), r.join(" ")));
            for (cell, column) in row.cells.iter().zip(&table.columns) {
                let (own, other) = match cell {
                    Cell::Text(text) => (text.clone(), String::new()),
                    Cell::Words { value, published } => {
                        (value.clone().unwrap_or_default(), published.clone().unwrap_or_default())
                    }
                    Cell::Number { value, published } => {
                        (number(value.map(|n| n.value)), number(published.map(|n| n.value)))
                    }
                };
                let (value, published) = if table.is_published { (String::new(), own) } else { (own, other) };
                let name = [column.group.as_str(), column.name.as_str()].join(" ");
                let (source, ratio) = (table.origin.source, number(cell.ratio().filter(|_| column.form != Form::Gain)));
                let (id, title, unit) = (&table.id, &table.title, &column.unit);
                line([source, id, title, first, &rest, name.trim(), unit, &value, &published, &ratio]);
            }
        }
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// At most six decimals: no number here is known more precisely.
fn number(value: Option<f64>) -> String {
    value.map_or_else(String::new, |v| ((v * 1e6).round() / 1e6).to_string())
}
