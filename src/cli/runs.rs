//! What the readers of recorded runs share: their arguments, and the destinations of their output.

use super::output;
use crate::error::{Error, Result};
use crate::record::files;
use crate::report::splice::{self, Block, Need};
use crate::sources::runs::RecordedRun;
use crate::sources::{self, Options, Results, Rows, Source, convention::Convention};
use clap::Args;
use std::path::{Path, PathBuf};

/// Recorded runs, and the sources that show them.
#[derive(Args, Debug)]
pub struct RunArguments {
    /// Folders of recorded runs, as `rtbench sweep` or `rtbench spheres` writes them; none: the published numbers
    #[arg(value_name = "RUN")]
    runs: Vec<PathBuf>,
    /// Source of tables, figures and claims: thesis, rt2, spheres, splat, structures [default: every source that the
    /// runs fit]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    source: Vec<String>,
}

/// What tables show.
#[derive(Args, Debug)]
pub struct OptionArguments {
    /// Side of the square image (rt2 and spheres: width of the image) in tables of one size [default: the largest of
    /// the source's sizes at which nearly every scene was measured; the thesis's are 1024, 768, 512, 256, that of rt2
    /// is 1408x768; of spheres the size with most rows]
    #[arg(long, value_name = "PIXELS")]
    resolution: Option<u32>,
    /// What a step of a tree is, in tables of counts
    #[arg(long, value_enum, default_value_t)]
    convention: Convention,
    /// Which rows tables have
    #[arg(long, value_enum, default_value_t)]
    pub rows: Rows,
    #[command(flatten)]
    processors: ProcessorArguments,
}

/// How many processors a GPU has, which no driver says.
#[derive(Args, Debug)]
pub struct ProcessorArguments {
    /// Processors of the GPU, for the Karp-Flatt metric of spheres [default: none, so that a GPU has no such metric]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub processors: Option<u32>,
}

/// A published device.
#[derive(Args, Debug)]
pub struct DeviceArguments {
    /// The device whose published numbers are shown or compared with: GTX280, 8600GT [default: each table's own; the
    /// thesis has 8600GT in 5.7 and B.4 to B.6, GTX280 in the others; rt2 and spheres have none]
    #[arg(long, alias = "card", value_name = "NAME")]
    device: Option<String>,
}

/// Runs, and their numbers for each source.
pub struct Opened {
    /// The runs; empty for published numbers.
    pub runs: Vec<RecordedRun>,
    /// The sources that were named, or all that fit.
    pub sources: Vec<&'static Source>,
    /// The numbers, one for each source.
    pub results: Vec<Box<dyn Results>>,
}

impl RunArguments {
    /// Reads the runs, and prints what a reader should know about them.
    ///
    /// # Errors
    /// A run that cannot be read, an unknown source.
    pub fn read(&self) -> Result<Opened> {
        let runs = RecordedRun::read_all(&self.runs)?;
        let sources = sources::select(&self.source, &runs)?;
        let results: Vec<Box<dyn Results>> = sources.iter().map(|source| (source.read)(&runs)).collect();
        let mut printed: Vec<&str> = Vec::new();
        for note in results.iter().flat_map(|results| results.notes()) {
            // Several sources say the same about a run
            if !printed.contains(&note.as_str()) {
                output::note(note);
                printed.push(note);
            }
        }
        Ok(Opened { runs, sources, results })
    }
}

impl Opened {
    /// The sources with their numbers.
    pub fn each(&self) -> impl Iterator<Item = (&'static Source, &dyn Results)> {
        self.sources.iter().copied().zip(self.results.iter().map(|results| &**results))
    }
}

impl DeviceArguments {
    /// The device's index in each source; none: each table's own.
    ///
    /// # Errors
    /// A device that no source has.
    pub fn select(&self, sources: &[&'static Source]) -> Result<Vec<Option<usize>>> {
        match &self.device {
            Some(name) => sources::select_device(sources, name),
            None => Ok(vec![None; sources.len()]),
        }
    }
}

impl OptionArguments {
    /// The options for a source.
    pub fn options(&self, published: bool, device: Option<usize>) -> Options {
        Options {
            published,
            device,
            resolution: self.resolution,
            convention: self.convention,
            rows: self.rows,
            processors: self.processors.processors,
        }
    }
}

/// Prints a text, or writes a file whole.
pub fn write_or_print(text: &str, file: Option<&Path>) -> Result<()> {
    match file {
        Some(path) => files::replace(path, text.as_bytes()),
        None => output::print(text),
    }
}

/// A document with a place for a command's output.
#[derive(Args, Debug)]
pub struct Into {
    /// Replace the text between <!-- rtbench:NAME --> and <!-- /rtbench:NAME --> in this document, as Markdown; NAME is
    /// a table's number, or `claims`
    #[arg(long, value_name = "FILE", conflicts_with_all = ["output", "format"])]
    into: Option<PathBuf>,
    /// With --into: change nothing; exit code 1 if the document is not up to date
    #[arg(long, requires = "into")]
    check: bool,
}

impl Into {
    /// Puts the blocks in their places; false if no document was named.
    ///
    /// # Errors
    /// A document that cannot be read or written, or has no place for them; two sources, whose numbers of tables mean
    /// different tables; with --check [`Error::NotUpToDate`] for a document that would change.
    pub fn splice(&self, opened: &Opened, blocks: impl FnOnce() -> Vec<Block>, need: Need) -> Result<bool> {
        let Some(path) = &self.into else { return Ok(false) };
        if opened.sources.len() > 1 {
            let names: Vec<&str> = opened.sources.iter().map(|source| source.name).collect();
            let hint = format!("--source with one of {}", names.join(", "));
            return Err(Error::argument("--into", "several sources have tables of the same numbers", hint));
        }
        let text = std::fs::read_to_string(path)
            .map_err(|e| Error::file(path, None, format!("cannot read: {e}"), "give a text file with markers"))?;
        let new = splice::splice(path, &text, &blocks(), need)?;
        match (new == text, self.check) {
            (true, _) => Ok(true),
            (false, true) => Err(Error::NotUpToDate(path.clone())),
            (false, false) => files::replace(path, new.as_bytes()).map(|()| true),
        }
    }
}
