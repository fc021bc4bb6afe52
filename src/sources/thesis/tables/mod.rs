//! Tables 5.1 to 5.14 and B.1 to B.6, of the published numbers or of recorded runs; and the order of structures by the
//! SIMT model.

mod context;
mod counts;
mod devices;
pub mod occupancy;
pub mod side;
mod simt;
mod structures;
mod times;

use super::Numbers;
use super::structures::{BVH, GRID, KDTREE};
use crate::report::Table;
use crate::sources::{Options, Rows};
use context::Context;

/// The numbers of all tables, in the thesis's order. 5.3.4 is a section: it has the speed-ups between devices in its
/// text. `simt` is none of the thesis's.
pub const IDS: [&str; 22] = [
    "5.1", "5.2", "5.3", "5.4", "5.5", "5.6", "5.7", "5.8", "5.3.4", "5.9", "5.10", "5.11", "5.12", "5.13", "5.14",
    "B.1", "B.2", "B.3", "B.4", "B.5", "B.6", "simt",
];

/// The tables of these numbers: at least one of each, several if several devices were measured. A scene that was not
/// measured has an empty row and is named by a note; with [`Rows::Measured`] it has no row.
pub fn build(numbers: &Numbers, options: &Options, ids: &[&str]) -> Vec<Table> {
    let Numbers { data, published, modelled } = numbers;
    let options = Options { published: options.published && !data.published, ..options.clone() };
    let resolution = options.resolution.unwrap_or_else(|| side::usual(data, options.device.unwrap_or(0)));
    let context = Context { data, published, modelled, options: &options, resolution };
    let mut tables: Vec<Table> = ids.iter().flat_map(|id| one(&context, id)).collect();
    for table in &mut tables {
        // The notes are about all rows: they name the scenes that are left out here
        table.rows.retain(|row| options.rows != Rows::Measured || row.is_filled());
    }
    tables
}

fn one(context: &Context, id: &str) -> Vec<Table> {
    match id {
        "5.1" => vec![structures::scenes(context)],
        "5.2" => devices::devices(context),
        "5.3" => structures::build_times(context),
        "5.4" => vec![structures::grid(context)],
        "5.5" => vec![structures::kdtree(context)],
        "5.6" => vec![structures::bvh(context)],
        "5.7" | "5.8" => occupancy::occupancy(context, id),
        "5.3.4" => devices::speedups(context),
        "5.9" => vec![counts::counts(context, id, GRID)],
        "5.10" => vec![counts::counts(context, id, KDTREE)],
        "5.11" => vec![counts::counts(context, id, BVH)],
        "simt" => simt::orders(context),
        "5.12" | "5.13" | "5.14" => times::at_one_resolution(context, id),
        _ => times::at_all_resolutions(context, id),
    }
}
