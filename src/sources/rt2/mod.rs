//! The thesis of 2010 on the ray tracer RT2, which compares a kd-tree, with and without ropes, with a BVH: its
//! published orders and percentages, and its tables, figures and claims from recorded runs. Nothing here measures,
//! reads a clock or looks at the machine.

mod claims;
mod data;
mod figures;
pub mod gains;
mod measured;
pub mod models;
pub mod published;
mod report;
pub mod structures;
mod tables;

use super::claims::Finding;
use super::{Options, Results, Rows, Section, Source};
use crate::error::Result;
use crate::report::figure::{Figure, Missing};
use crate::report::{Origin, Table};
use crate::sources::runs::{RecordedRun, with_traces};
use crate::workloads::trace::simt::model::Gpu;
use data::Data;
use published::Published;

/// The thesis of 2010.
pub const SOURCE: Source = Source {
    name: "rt2",
    title: "The thesis of 2010 on RT2",
    tables: &tables::IDS,
    published_in: "The orders and percentages that the thesis of 2010 printed, from <code>results/rt2-2010</code>; the \
                   values of its bar charts are in no text.",
    devices: &[],
    fits: |runs| runs.iter().any(measured::has_rows),
    read: |runs| Box::new(Numbers::of(runs)),
};

/// Its tables.
const ORIGIN: Origin = Origin { source: SOURCE.name, kind: "figure", published: "2010" };

/// The document in a sentence.
const DOCUMENT: &str = "the thesis of 2010";

/// The numbers of runs with what was published, or the latter alone.
#[derive(Clone, Debug)]
pub struct Numbers {
    /// Measured; `None` if there are no runs.
    data: Option<Data>,
    /// Published.
    published: Published,
    /// By the SIMT model of each validated GPU, where warps were counted.
    modelled: Vec<Data>,
}

impl Numbers {
    /// The numbers of these runs.
    pub fn of(runs: &[RecordedRun]) -> Numbers {
        let data = (!runs.is_empty()).then(|| measured::data(runs));
        let modelled = Gpu::validated().iter().filter_map(|gpu| measured::modelled(runs, gpu)).collect();
        Numbers { data, published: published::data(), modelled }
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
        let mut findings = claims::judge(self.data.as_ref(), &self.published);
        findings.extend(claims::by_model(&self.modelled, &self.published));
        findings
    }

    fn figures(&self) -> Result<(Vec<Figure>, Vec<Missing>)> {
        figures::all(self.data.as_ref(), &self.published)
    }

    fn lead(&self, runs: &[RecordedRun], rows: Rows) -> String {
        report::lead(self.data.as_ref(), with_traces(runs).len(), rows)
    }

    fn sections(&self, _runs: &[RecordedRun]) -> Vec<Section> {
        vec![report::differences(&self.published)]
    }
}
