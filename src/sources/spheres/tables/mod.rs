//! The paper's four tables of times and its metrics, and what it did not measure: each switch on its own, the fastest
//! settings, how times scale, half precision, and the work of a frame.

mod best;
mod context;
mod half;
mod metrics;
mod scaling;
mod switches;
mod times;
mod work;

use super::data::Data;
use super::published::Published;
use crate::report::Table;
use crate::sources::{Options, Rows};
pub use best::fastest;
use context::Context;

/// Numbers of the tables; those after the fourth are ours.
pub const IDS: [&str; 10] = ["1", "2", "3", "4", "best", "metrics", "switches", "scaling", "half", "work"];

/// The tables of these numbers. Without `data`, what was published.
pub fn build(data: Option<&Data>, published: &Published, options: &Options, ids: &[&str]) -> Vec<Table> {
    let context = Context { data, published, options };
    let mut tables: Vec<Table> = ids.iter().flat_map(|id| one(&context, id)).collect();
    for table in &mut tables {
        // The notes are about all rows: they name the scenes that are left out here
        table.rows.retain(|row| options.rows != Rows::Measured || row.is_filled());
    }
    tables
}

fn one(context: &Context, id: &str) -> Vec<Table> {
    let table = match id {
        "best" => best::table,
        "metrics" => metrics::table,
        "switches" => switches::table,
        "half" => half::table,
        "scaling" => return context.sides().iter().flat_map(|side| scaling::tables(context, side)).collect(),
        "work" => return context.sides().iter().flat_map(|side| work::tables(context, side)).collect(),
        _ => return context.sides().iter().map(|side| times::table(context, side, id)).collect(),
    };
    context.sides().iter().map(|side| table(context, side)).collect()
}
