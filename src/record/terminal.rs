//! Tables for a terminal.

use comfy_table::{CellAlignment, LineStyle, Table, TableStyle};

/// One line below the headings and nothing else.
pub(crate) const STYLE: TableStyle = TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─'));

/// A table with these headings; columns from `numbers` on are aligned to the right. An empty line separates groups.
pub(crate) fn table(headings: &[&str], numbers: usize, lines: &[Vec<String>]) -> String {
    let mut table = Table::new();
    table.load_style(STYLE).set_header(headings.iter().copied());
    for column in table.column_iter_mut().skip(numbers) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    for line in lines {
        if line.is_empty() {
            table.add_row([""]);
        } else {
            table.add_row(line);
        }
    }
    table.trim_fmt()
}

/// A number with as many decimals as fit its size; a dash where there is none.
pub(crate) fn number(value: Option<f64>) -> String {
    match value {
        None => "-".into(),
        Some(0.0) => "0".into(),
        Some(v) if v.abs() >= 1000.0 => format!("{v:.0}"),
        Some(v) if v.abs() >= 100.0 => format!("{v:.1}"),
        Some(v) if v.abs() >= 1.0 => format!("{v:.2}"),
        Some(v) => format!("{v:.3}"),
    }
}

/// Bytes as MiB with two decimals.
pub(crate) fn mib(bytes: u64) -> String {
    format!("{:.2}", bytes as f64 / (1024.0 * 1024.0))
}

/// A number of things: `1 case`, `2 cases`.
pub(crate) fn counted(number: usize, one: &str, several: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { several })
}

/// A value of an axis in a row's name: with the axis for a switch, which says nothing alone.
pub fn spelt_out(axis: &str, value: &str) -> String {
    match value {
        "on" | "off" => format!("{}={value}", axis.replace('_', "-")),
        word => word.to_owned(),
    }
}
