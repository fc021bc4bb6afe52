//! The structures of today next to those of the other sources: rays per second against build time and bytes. It is no
//! document and has no published numbers; it shows what was measured in one run, scene by scene.

mod break_even;
mod data;
mod figures;
mod pareto;
mod report;
mod tables;

pub use break_even::{BreakEven, Cost, break_even};
pub use pareto::front;

use super::claims::Finding;
use super::{Options, Results, Rows, Section, Source};
use crate::error::Result;
use crate::report::figure::{Figure, Missing};
use crate::report::{Origin, Table};
use crate::sources::runs::RecordedRun;
use data::Data;

/// The structures of today.
pub const SOURCE: Source = Source {
    name: "structures",
    title: "The structures of today",
    tables: &tables::IDS,
    published_in: "",
    devices: &[],
    fits: |runs| runs.iter().any(data::has_rows),
    read: |runs| Box::new(Numbers(Data::of(runs))),
};

const ORIGIN: Origin = Origin { source: SOURCE.name, kind: "table", published: "" };

struct Numbers(Data);

impl Results for Numbers {
    fn notes(&self) -> &[String] {
        &self.0.notes
    }

    fn tables(&self, ids: &[&str], options: &Options) -> Vec<Table> {
        tables::build(&self.0, ids, options)
    }

    fn claims(&self, _options: &Options) -> Vec<Finding> {
        Vec::new()
    }

    fn figures(&self) -> Result<(Vec<Figure>, Vec<Missing>)> {
        figures::all(&self.0)
    }

    fn lead(&self, runs: &[RecordedRun], _rows: Rows) -> String {
        report::lead(&self.0, runs.len())
    }

    fn sections(&self, _runs: &[RecordedRun]) -> Vec<Section> {
        vec![report::reading()]
    }
}
