//! Figure 5.2 as a table, and what the thesis has no table of: every stage, frames along the animation, clusters,
//! memory, keys, quality, options and sweeps.

mod clusters;
mod context;
mod frames;
mod groups;
mod keys;
mod memory;
mod options;
mod quality;
mod sweeps;

use super::data::Data;
use super::published::Published;
use crate::report::Table;
use crate::sources::{Options, Rows};
use context::Context;
pub use keys::slices;

/// Numbers of the tables; the first is that of the thesis's figure, the others are ours.
pub const IDS: [&str; 9] = ["5.2", "stages", "frames", "clusters", "memory", "keys", "quality", "options", "sweeps"];

/// The tables of these numbers. Without `data`, what was published.
pub fn build(data: Option<&Data>, published: &Published, options: &Options, ids: &[&str]) -> Vec<Table> {
    let context = Context { data, published, options };
    let mut tables: Vec<Table> = ids.iter().flat_map(|id| one(&context, id)).collect();
    for table in &mut tables {
        table.rows.retain(|row| options.rows != Rows::Measured || row.is_filled());
    }
    tables
}

fn one(context: &Context, id: &str) -> Vec<Table> {
    match id {
        "5.2" => groups::tables(context),
        "stages" => groups::stages(context),
        "frames" => frames::tables(context),
        "clusters" => clusters::tables(context),
        "memory" => memory::tables(context),
        "keys" => keys::tables(context),
        "quality" => quality::tables(context),
        "options" => options::tables(context),
        _ => sweeps::tables(context),
    }
}
