//! The thesis of 2009: its published numbers, and its tables, figures and claims from recorded runs. Nothing here
//! measures, reads a clock or looks at the machine.

mod builds;
pub mod claims;
pub mod data;
pub mod figures;
mod indexed;
pub mod measured;
pub mod published;
mod report;
pub mod scenes;
pub mod structures;
mod sweeps;
pub mod tables;
pub mod variant;

use super::claims::Finding;
use super::{Options, Results, Rows, Section, Source};
use crate::error::Result;
use crate::report::figure::{Figure, Missing};
use crate::report::{Origin, Table};
use crate::sources::runs::{RecordedRun, with_traces};
use crate::workloads::trace::simt::model::Gpu;
use data::Data;
use published::{GT8600, GTX280};

/// The thesis.
pub const SOURCE: Source = Source {
    name: "thesis",
    title: "The thesis of 2009",
    tables: &tables::IDS,
    published_in: "The numbers that the thesis printed, from <code>results/thesis-2009</code>.",
    devices: &[GTX280, GT8600],
    fits: |runs| runs.iter().any(measured::has_rows),
    read: |runs| Box::new(Numbers::of(runs)),
};

/// Its tables.
const ORIGIN: Origin = Origin { source: SOURCE.name, kind: "table", published: "2009" };

/// The thesis in a sentence.
const DOCUMENT: &str = "the thesis";

/// The numbers of runs, or the published ones, with the published ones.
#[derive(Clone, Debug)]
pub struct Numbers {
    /// Measured, or published if there are no runs.
    pub data: Data,
    /// Published.
    pub published: Data,
    /// By the SIMT model of each validated GPU, where warps were counted.
    pub modelled: Vec<Data>,
}

impl Numbers {
    /// The numbers of these runs.
    pub fn of(runs: &[RecordedRun]) -> Numbers {
        let published = published::data();
        let data = if runs.is_empty() { published.clone() } else { measured::data(runs) };
        let modelled = Gpu::validated().iter().filter_map(|gpu| measured::modelled(runs, gpu)).collect();
        Numbers { data, published, modelled }
    }
}

impl Results for Numbers {
    fn notes(&self) -> &[String] {
        &self.data.notes
    }

    fn tables(&self, ids: &[&str], options: &Options) -> Vec<Table> {
        tables::build(self, options, ids)
    }

    fn claims(&self, options: &Options) -> Vec<Finding> {
        let device = options.device.unwrap_or(0);
        let mut findings = claims::judge(&self.data, &self.published, device);
        findings.extend(claims::by_model(&self.modelled, &self.published, device));
        findings
    }

    fn figures(&self) -> Result<(Vec<Figure>, Vec<Missing>)> {
        figures::all(&self.data)
    }

    fn lead(&self, runs: &[RecordedRun], rows: Rows) -> String {
        report::lead(&self.data, with_traces(runs).len(), rows)
    }

    fn sections(&self, runs: &[RecordedRun]) -> Vec<Section> {
        vec![report::differences(&self.data, runs)]
    }
}
