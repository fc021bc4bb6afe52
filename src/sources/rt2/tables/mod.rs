//! The document's three bar charts, figures 4.4 to 4.6, as tables.

mod builds;
mod context;
mod memory;
mod times;

use super::data::Data;
use super::published::Published;
use crate::report::Table;
use crate::sources::{Options, Rows};
use context::Context;

/// Numbers of the figures that are tables here.
pub const IDS: [&str; 3] = ["4.4", "4.5", "4.6"];

/// The tables of these numbers, several of each: values with their order, the printed percentages, and what is beyond
/// the document. Without `data`, what was published.
pub fn build(data: Option<&Data>, published: &Published, options: &Options, ids: &[&str]) -> Vec<Table> {
    let context = Context { data, published, options };
    let mut tables: Vec<Table> = ids.iter().flat_map(|id| one(&context, id)).collect();
    for table in &mut tables {
        // The notes are about all rows: they name the models that are left out here
        table.rows.retain(|row| options.rows != Rows::Measured || row.is_filled());
    }
    tables
}

fn one(context: &Context, id: &str) -> Vec<Table> {
    match id {
        "4.4" => times::tables(context),
        "4.5" => builds::tables(context),
        _ => memory::tables(context),
    }
}
