//! Sources: documents whose experiments are repeated here. Each brings its published numbers, and tables, figures and
//! claims as pure functions of recorded runs: the same runs give the same bytes.
//!
//! A source is a folder and a line in [`ALL`].

pub mod claims;
pub mod convention;
pub mod report;
pub mod rows;
pub mod rt2;
pub mod runs;
pub mod spheres;
pub mod splat;
pub mod structures;
pub mod thesis;

use crate::error::{Error, Result};
use crate::report::figure::{Figure, Missing};
use crate::report::{Row, Table};
use crate::sources::runs::RecordedRun;
use claims::Finding;
use convention::Convention;

/// All sources.
pub const ALL: [&Source; 5] = [&thesis::SOURCE, &rt2::SOURCE, &spheres::SOURCE, &splat::SOURCE, &structures::SOURCE];

/// A source.
pub struct Source {
    /// Its name, as `--source` takes it.
    pub name: &'static str,
    /// Its title, at the beginning of a sentence: `The thesis of 2009`.
    pub title: &'static str,
    /// The numbers of its tables, in its order.
    pub tables: &'static [&'static str],
    /// Where its published numbers come from: a sentence in HTML; empty if it has none.
    pub published_in: &'static str,
    /// The devices whose times it published, the one of most tables first.
    pub devices: &'static [&'static str],
    /// True if its tables have rows for what these runs measured.
    pub fits: fn(&[RecordedRun]) -> bool,
    /// Reads the numbers of runs; of no runs, the published numbers.
    pub read: fn(&[RecordedRun]) -> Box<dyn Results>,
}

/// Numbers in the form of a source: those of recorded runs and the published ones, or the published ones alone.
pub trait Results {
    /// What a reader should know about the runs as a whole.
    fn notes(&self) -> &[String];
    /// The tables of these numbers, at least one of each. A note names what was not measured.
    fn tables(&self, ids: &[&str], options: &Options) -> Vec<Table>;
    /// The claims, judged by these numbers and, for exceptions, by the published numbers of [`Options::device`].
    fn claims(&self, options: &Options) -> Vec<Finding>;
    /// The figures that there is data for, and the others.
    ///
    /// # Errors
    /// None in practice: drawing goes to memory.
    fn figures(&self) -> Result<(Vec<Figure>, Vec<Missing>)>;
    /// The first lines of the HTML report.
    fn lead(&self, runs: &[RecordedRun], rows: Rows) -> String;
    /// Sections of the HTML report besides claims, tables, figures, pictures and provenance.
    fn sections(&self, runs: &[RecordedRun]) -> Vec<Section>;
}

/// A section of the HTML report.
pub struct Section {
    /// Its anchor.
    pub id: &'static str,
    /// Its entry in the navigation.
    pub name: &'static str,
    /// Its heading.
    pub title: &'static str,
    /// Its HTML.
    pub content: String,
}

/// Which rows a table has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Rows {
    /// All scenes of the source, measured or not, and every other measured scene
    #[default]
    All,
    /// Scenes of the source only, measured or not
    #[value(alias = "thesis")]
    Source,
    /// Only what was measured
    Measured,
}

/// What tables show.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// True for the published number with each measured one.
    pub published: bool,
    /// Index of the published device ([`Source::devices`]); none: each table's own.
    pub device: Option<usize>,
    /// Side of the image where a table shows one size; none: the source chooses.
    pub resolution: Option<u32>,
    /// What a step of a tree is.
    pub convention: Convention,
    /// Which rows.
    pub rows: Rows,
    /// Processors of the GPU, for metrics that need their number; none: not known.
    pub processors: Option<u32>,
}

/// The sources of these names; without any, all that fit the runs.
///
/// # Errors
/// [`Error::Input`]: there is no such source, or none fits.
pub fn select(names: &[String], runs: &[RecordedRun]) -> Result<Vec<&'static Source>> {
    if names.is_empty() {
        let fitting: Vec<_> = ALL
            .into_iter()
            .filter(|source| if runs.is_empty() { !source.published_in.is_empty() } else { (source.fits)(runs) })
            .collect();
        if fitting.is_empty() {
            let hint = format!("--source takes {}", list(ALL.iter().map(|source| source.name)));
            return Err(Error::argument("RUN", "no source has tables of what these runs measured", hint));
        }
        return Ok(fitting);
    }
    let named = |name: &String| {
        ALL.into_iter().find(|source| source.name == name).ok_or_else(|| {
            let hint = format!("one of {}", list(ALL.iter().map(|source| source.name)));
            Error::argument("--source", format!("there is no source '{name}'"), hint)
        })
    };
    let mut found: Vec<&Source> = Vec::new();
    for name in names {
        let source = named(name)?;
        if !found.iter().any(|known| known.name == source.name) {
            found.push(source);
        }
    }
    Ok(found)
}

/// Reads `all` or a comma list of numbers of tables: for each source, those that it has.
///
/// # Errors
/// [`Error::Input`]: no source has such a table.
pub fn select_tables(sources: &[&'static Source], text: &str) -> Result<Vec<Vec<&'static str>>> {
    if text.eq_ignore_ascii_case("all") {
        return Ok(sources.iter().map(|source| source.tables.to_vec()).collect());
    }
    let hint = || format!("all, or a list of {}", list(sources.iter().flat_map(|source| source.tables).copied()));
    let wanted: Vec<&str> = text.split(',').map(str::trim).filter(|id| !id.is_empty()).collect();
    let is = |wanted: &str, id: &str| id.eq_ignore_ascii_case(wanted);
    let exists = |wanted: &str| sources.iter().flat_map(|source| source.tables).any(|id| is(wanted, id));
    if let Some(unknown) = wanted.iter().find(|wanted| !exists(wanted)) {
        return Err(Error::argument("--table", format!("there is no table '{unknown}'"), hint()));
    }
    if wanted.is_empty() {
        return Err(Error::argument("--table", "no table is named", hint()));
    }
    let of = |source: &&'static Source| {
        wanted.iter().filter_map(|wanted| source.tables.iter().copied().find(|id| is(wanted, id))).collect()
    };
    Ok(sources.iter().map(of).collect())
}

/// The index of a published device in each source; none in a source without it.
///
/// # Errors
/// [`Error::Input`]: no source has it.
pub fn select_device(sources: &[&'static Source], name: &str) -> Result<Vec<Option<usize>>> {
    let of = |source: &&'static Source| source.devices.iter().position(|device| device.eq_ignore_ascii_case(name));
    let found: Vec<Option<usize>> = sources.iter().map(of).collect();
    if found.iter().all(Option::is_none) {
        let devices = list(sources.iter().flat_map(|source| source.devices).copied());
        let hint = match devices.as_str() {
            "" => format!("{} published times of no device", list(sources.iter().map(|source| source.name))),
            devices => format!("one of {devices}"),
        };
        let problem = format!("no published numbers are of a device '{name}'");
        return Err(Error::argument("--device", problem, hint));
    }
    Ok(found)
}

fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.collect::<Vec<_>>().join(", ")
}

/// Those of these numbers whose tables have nothing but published values.
pub fn without_numbers<'a>(results: &dyn Results, ids: &[&'a str], options: &Options) -> Vec<&'a str> {
    let tables = results.tables(ids, &Options { published: false, ..options.clone() });
    let is_empty = |id: &&str| tables.iter().filter(|t| t.id == *id).all(|t| !t.rows.iter().any(Row::is_filled));
    ids.iter().copied().filter(is_empty).collect()
}
