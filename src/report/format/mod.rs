//! The formats of a table.

mod csv;
mod latex;
mod markdown;
mod text;

use super::table::Table;

/// A format of tables.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// Aligned, for a terminal of 100 columns
    #[default]
    Text,
    /// GitHub's pipes
    Markdown,
    /// One line per number: source, table, row, column, unit, value, published value, ratio
    Csv,
    /// A longtable per table, which continues on the next page: needs \usepackage{longtable}, which every LaTeX has
    Latex,
}

/// Writes tables in a format.
pub fn write(tables: &[Table], format: Format) -> String {
    let join = |write: fn(&Table) -> String| tables.iter().map(write).collect::<Vec<_>>().join("\n");
    match format {
        Format::Text => join(text::write),
        Format::Markdown => join(markdown::write),
        Format::Csv => csv::write(tables),
        Format::Latex => latex::HEADER.to_owned() + &join(latex::write),
    }
}
