//! The thesis on splatting photons onto clusters of view samples: its published times, axes and sizes, and its tables,
//! figures and claims from recorded runs. Nothing here measures, reads a clock or looks at the machine.

pub mod axes;
mod claims;
mod data;
mod figures;
mod measured;
pub mod published;
mod report;
mod scenes;
pub mod stages;
mod tables;

use super::claims::Finding;
use super::{Options, Results, Rows, Section, Source};
use crate::error::Result;
use crate::report::figure::{Figure, Missing};
use crate::report::{Origin, Table};
use crate::sources::runs::RecordedRun;
use data::Data;
use published::Published;
pub use tables::slices;

/// The thesis on photon splatting.
pub const SOURCE: Source = Source {
    name: "splat",
    title: "The thesis on photon splatting",
    tables: &tables::IDS,
    published_in: "The labels and axes of charts and the numbers in sentences of the thesis on photon splatting, from \
                   <code>results/splat-thesis</code>.",
    devices: &published::DEVICES,
    fits: |runs| runs.iter().any(measured::has_rows),
    read: |runs| Box::new(Numbers::of(runs)),
};

/// Its tables.
const ORIGIN: Origin = Origin { source: SOURCE.name, kind: "table", published: "printed" };

/// The document in a sentence.
const DOCUMENT: &str = "the thesis on photon splatting";

/// The numbers of runs with what was published, or the latter alone.
#[derive(Clone, Debug)]
pub struct Numbers {
    /// Measured; `None` if there are no runs.
    data: Option<Data>,
    /// Published.
    published: Published,
}

impl Numbers {
    /// The numbers of these runs.
    pub fn of(runs: &[RecordedRun]) -> Numbers {
        let data = (!runs.is_empty()).then(|| measured::data(runs));
        Numbers { data, published: published::data() }
    }
}

impl Results for Numbers {
    fn notes(&self) -> &[String] {
        self.data.as_ref().map_or(&[], |data| &data.notes)
    }

    fn tables(&self, ids: &[&str], options: &Options) -> Vec<Table> {
        tables::build(self.data.as_ref(), &self.published, options, ids)
    }

    fn claims(&self, _options: &Options) -> Vec<Finding> {
        claims::judge(self.data.as_ref(), &self.published)
    }

    fn figures(&self) -> Result<(Vec<Figure>, Vec<Missing>)> {
        figures::all(self.data.as_ref(), &self.published)
    }

    fn lead(&self, runs: &[RecordedRun], rows: Rows) -> String {
        report::lead(self.data.as_ref(), measured::with_rows(runs).len(), rows)
    }

    fn sections(&self, _runs: &[RecordedRun]) -> Vec<Section> {
        vec![report::differences(), report::kernels(&self.published)]
    }
}
