//! Tables 5.1 to 5.14 and B.1 to B.6 (SPEC section 9), of the published numbers or of recorded runs.

mod context;
mod counts;
mod devices;
pub mod occupancy;
pub mod side;
mod structures;
mod times;

pub use times::CARD_CONFIGS;

use super::convention::Convention;
use super::data::Data;
use super::table::{Row, Table};
use crate::error::{Error, Result};
use context::Context;

/// Numbers of all tables, in the thesis's order. 5.3.4 is a section: its speed-ups between devices stand in no table there.
pub const IDS: [&str; 21] = [
    "5.1", "5.2", "5.3", "5.4", "5.5", "5.6", "5.7", "5.8", "5.3.4", "5.9", "5.10", "5.11", "5.12", "5.13", "5.14",
    "B.1", "B.2", "B.3", "B.4", "B.5", "B.6",
];

/// Which rows a table has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Rows {
    /// All scenes of the thesis, measured or not, and every other measured scene
    #[default]
    All,
    /// Scenes of the thesis only, measured or not
    Thesis,
    /// Only what was measured
    Measured,
}

/// What tables are to show.
#[derive(Clone, Debug)]
pub struct Options {
    /// Each number beside the published one.
    pub beside: bool,
    /// What a step is.
    pub convention: Convention,
    /// Side of the image in tables 5.12 to 5.14; 1024 in the thesis.
    pub resolution: u32,
    /// Index of the published card whose numbers are shown, alone or beside measured ones; none: each table's own.
    pub card: Option<usize>,
    /// Which rows.
    pub rows: Rows,
}

impl Default for Options {
    fn default() -> Options {
        Options { beside: false, convention: Convention::default(), resolution: 1024, card: None, rows: Rows::All }
    }
}

/// Reads `all` or a comma list of numbers of tables.
///
/// # Errors
/// [`Error::Input`]: there is no such table.
pub fn select(list: &str) -> Result<Vec<&'static str>> {
    if list.eq_ignore_ascii_case("all") {
        return Ok(IDS.to_vec());
    }
    let named = list.split(',').map(str::trim).filter(|id| !id.is_empty());
    let ids: Vec<&str> = named
        .map(|wanted| {
            IDS.into_iter().find(|id| id.eq_ignore_ascii_case(wanted)).ok_or_else(|| {
                let hint = format!("all, or a list of {}", IDS.join(", "));
                Error::argument("--table", format!("there is no table '{wanted}'"), hint)
            })
        })
        .collect::<Result<_>>()?;
    if ids.is_empty() {
        return Err(Error::argument("--table", "no table is named", format!("all, or a list of {}", IDS.join(", "))));
    }
    Ok(ids)
}

/// The tables of these numbers: at least one of each, several where several devices were measured. What was not measured
/// stands empty, and a note names it; with [`Rows::Measured`] it has no rows.
pub fn build(data: &Data, published: &Data, options: &Options, ids: &[&str]) -> Vec<Table> {
    let options = Options { beside: options.beside && !data.published, ..options.clone() };
    let context = Context { data, published, options: &options };
    let mut tables: Vec<Table> = ids.iter().flat_map(|id| one(&context, id)).collect();
    for table in &mut tables {
        // The notes were made of all rows: they name what is left out here
        table.rows.retain(|row| options.rows != Rows::Measured || row.is_filled());
    }
    tables
}

/// Those of these numbers whose tables have nothing of `data` in them.
pub fn without_numbers<'a>(data: &Data, published: &Data, options: &Options, ids: &[&'a str]) -> Vec<&'a str> {
    let options = Options { beside: false, ..options.clone() };
    let tables = build(data, published, &options, ids);
    let is_empty = |id: &&str| tables.iter().filter(|t| t.id == *id).all(|t| !t.rows.iter().any(Row::is_filled));
    ids.iter().copied().filter(is_empty).collect()
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
        "5.9" => vec![counts::counts(context, id, "grid")],
        "5.10" => vec![counts::counts(context, id, "kdtree")],
        "5.11" => vec![counts::counts(context, id, "bvh")],
        "5.12" | "5.13" | "5.14" => times::at_one_resolution(context, id),
        _ => times::at_all_resolutions(context, id),
    }
}
