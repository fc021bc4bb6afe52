//! Run folders read row by row. A row keeps what comparing needs: what was asked for, what is exact about it, and its
//! times. Texts are stored once for all runs that are read with the same [`Names`], so that runs of many rows take
//! little memory; time and memory are linear in the rows.

mod line;

use super::journal::{FILE_NAME, folder_of};
use super::row::{SCHEMA, Settings, Status};
use super::run::{End, Provenance};
use crate::error::{Error, Result};
use crate::guard;
use foldhash::fast::RandomState;
use line::{ArtifactLine, InputLine, Line, RowLine};
use std::collections::HashMap;
use std::fs::{File, TryLockError};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A text that is stored once, in [`Names`].
pub type Name = u32;

/// Texts, each stored once.
#[derive(Debug, Default)]
pub struct Names {
    texts: Vec<Arc<str>>,
    known: HashMap<Arc<str>, Name, RandomState>,
}

impl Names {
    /// The number of a text.
    pub fn intern(&mut self, text: &str) -> Name {
        if let Some(&name) = self.known.get(text) {
            return name;
        }
        let (text, name): (Arc<str>, Name) = (text.into(), self.texts.len() as Name);
        self.texts.push(text.clone());
        self.known.insert(text, name);
        name
    }

    /// The number of a text that may not have been stored.
    pub fn find(&self, text: &str) -> Option<Name> {
        self.known.get(text).copied()
    }

    /// The text of a number.
    pub fn text(&self, name: Name) -> &str {
        self.texts.get(name as usize).map_or("", |text| text)
    }

    /// The numbers of all quantities that are one of these metrics ([`is_metric`]).
    pub fn of_metrics(&self, metrics: &[String]) -> Vec<Name> {
        let known = self.texts.iter().enumerate().filter(|(_, text)| is_metric(text, metrics));
        known.map(|(name, _)| name as Name).collect()
    }
}

/// True for the name of a quantity that is one of these metrics, of a whole row or of a part of it (`PART.METRIC`).
pub fn is_metric(quantity: &str, metrics: &[String]) -> bool {
    let is =
        |metric: &String| quantity.strip_suffix(metric.as_str()).is_some_and(|of| of.is_empty() || of.ends_with('.'));
    metrics.iter().any(is)
}

/// Frame times of a row, by the clock that was chosen for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Times {
    /// Mean over frames of the median over passes, in milliseconds: `frame_ms_mean` of `summary.csv`.
    pub mean_ms: f64,
    /// Spread over passes in percent; `None` after a single pass.
    pub noise_pct: Option<f64>,
    /// Mean over frames of each pass, in milliseconds.
    pub passes_ms: Box<[f32]>,
}

/// A row, as far as comparing needs it.
#[derive(Clone, Debug)]
pub struct LeanRow {
    /// Value of each axis, by the axis' name, in the order of the texts of the names.
    pub axes: Box<[(Name, Name)]>,
    /// Content hash of each input, by kind.
    pub inputs: Box<[(Name, Name)]>,
    /// Index into the run's devices.
    pub device: usize,
    /// How it was measured.
    pub settings: Settings,
    /// Whether there is a result.
    pub status: Status,
    /// Why there is none; the empty text otherwise.
    pub message: Name,
    /// Content hashes of what was computed, by name.
    pub outputs: Box<[(Name, Name)]>,
    /// Whole numbers: what was counted, and the sizes of what was built; `part.name`, or `name`.
    pub exact: Box<[(Name, u64)]>,
    /// Hashes of the kernels, joined.
    pub kernels: Name,
    /// Frame times; `None` for a row without a result.
    pub times: Option<Times>,
}

impl LeanRow {
    /// Value of an axis; the empty text where the row has no such axis.
    pub fn axis<'n>(&self, names: &'n Names, axis: &str) -> &'n str {
        let value = self.axes.iter().find(|(name, _)| names.text(*name) == axis);
        value.map_or("", |(_, value)| names.text(*value))
    }
}

/// Something that was built, with its exact quantities.
#[derive(Clone, Debug)]
pub struct LeanArtifact {
    /// The axes that it depends on.
    pub axes: Box<[(Name, Name)]>,
    /// Whole numbers, by name.
    pub exact: Box<[(Name, u64)]>,
}

/// A run, as far as comparing needs it.
#[derive(Debug)]
pub struct LeanRun {
    /// The run's folder.
    pub folder: PathBuf,
    /// First line of its journal.
    pub provenance: Provenance,
    /// Kind, name and content hash of what rows were measured on.
    pub inputs: Vec<(Name, Name, Name)>,
    /// In the order of building.
    pub artifacts: Vec<LeanArtifact>,
    /// In the order of measuring; a row that was measured again after the run was resumed is where it first was.
    pub rows: Vec<LeanRow>,
    /// Last line.
    pub end: End,
}

/// How a case is called after it was measured again.
type RowKey = (Box<[(Name, Name)]>, Box<[(Name, Name)]>, usize);

impl LeanRun {
    /// Reads a run that has ended from its folder or its journal.
    ///
    /// # Errors
    /// [`Error::Input`] with file and line: there is no run, it is of another schema, it is damaged, another process is
    /// writing it, or it did not end.
    pub fn read(path: &Path, names: &mut Names) -> Result<LeanRun> {
        let folder = folder_of(path);
        let journal = folder.join(FILE_NAME);
        let hint = "give the folder of a run, or its journal.jsonl";
        if !journal.is_file() {
            return Err(Error::file(path, None, format!("no run: there is no {FILE_NAME} in it"), hint));
        }
        guard::read_run(&folder);
        let file = File::open(&journal).map_err(|e| Error::file(&journal, None, format!("cannot read: {e}"), hint))?;
        if let Err(TryLockError::WouldBlock) = file.try_lock_shared() {
            let problem = "another process is writing this run";
            return Err(Error::file(&journal, None, problem, "wait until it has ended"));
        }
        let mut reader = Reader::new(&journal, names);
        let mut source = BufReader::with_capacity(1 << 18, file);
        let mut bytes = Vec::new();
        loop {
            bytes.clear();
            let read = source.read_until(b'\n', &mut bytes);
            let length = read.map_err(|e| Error::file(&journal, None, format!("cannot read: {e}"), hint))?;
            if length == 0 {
                return reader.finished(folder);
            }
            reader.line(&bytes)?;
        }
    }
}

/// A journal being read.
struct Reader<'a> {
    path: &'a Path,
    names: &'a mut Names,
    number: usize,
    cut_off: bool,
    provenance: Option<Provenance>,
    inputs: Vec<(Name, Name, Name)>,
    artifacts: Vec<LeanArtifact>,
    rows: Vec<LeanRow>,
    /// Filled once the run is resumed: only then a case can be measured again.
    known: Option<HashMap<RowKey, usize>>,
    end: Option<End>,
}

fn key(row: &LeanRow) -> RowKey {
    (row.axes.clone(), row.inputs.clone(), row.device)
}

impl<'a> Reader<'a> {
    fn new(path: &'a Path, names: &'a mut Names) -> Reader<'a> {
        Reader {
            path,
            names,
            number: 0,
            cut_off: false,
            provenance: None,
            inputs: Vec::new(),
            artifacts: Vec::new(),
            rows: Vec::new(),
            known: None,
            end: None,
        }
    }

    fn refusal(&self, problem: impl Into<String>, hint: &str) -> Error {
        Error::file(self.path, Some(self.number), problem, hint)
    }

    fn line(&mut self, bytes: &[u8]) -> Result<()> {
        self.number += 1;
        if self.number == 1 {
            self.check_schema(bytes)?;
        }
        let line = match line::parse(bytes) {
            Ok(line) => line,
            Err(_) if !bytes.ends_with(b"\n") && self.number > 1 => {
                self.cut_off = true;
                return Ok(());
            }
            Err(error) => {
                // The record is one line: the parser's own position would be another number
                let text = error.to_string();
                let problem = text.rsplit_once(" at line ").map_or(&*text, |(problem, _)| problem);
                let hint = "it is no journal of rtbench, or it was edited";
                return Err(self.refusal(format!("not a record: {problem}"), hint));
            }
        };
        match (line, self.provenance.is_some()) {
            (Line::Run(run), false) => self.provenance = Some(*run),
            (Line::Run(_), true) => {
                return Err(self.refusal("a second provenance", "journals of several runs must not be joined"));
            }
            (_, false) => return Err(self.refusal("the first line is no run's provenance", "")),
            (Line::Input(input), _) => self.input(&input),
            (Line::Artifact(artifact), _) => self.artifact(&artifact),
            (Line::Row(row), _) => self.row(&row),
            (Line::End(end), _) => self.end = Some(end),
            (Line::Resumed, _) => self.resumed(),
        }
        Ok(())
    }

    fn check_schema(&self, bytes: &[u8]) -> Result<()> {
        match super::journal::schema_of(bytes) {
            Some(other) if other != SCHEMA => Err(self.refusal(
                format!("schema {other:?} instead of {SCHEMA:?}"),
                "only runs of this schema are compared; tables and reports read older ones",
            )),
            _ => Ok(()),
        }
    }

    fn input(&mut self, input: &InputLine) {
        let [kind, name, hash] = [&input.kind, &input.name, &input.hash].map(|text| self.names.intern(text));
        self.inputs.push((kind, name, hash));
    }

    fn artifact(&mut self, line: &ArtifactLine) {
        let axes = line::texts(self.names, &line.key.axes);
        let exact = line::exact(self.names, &line.metrics);
        self.artifacts.push(LeanArtifact { axes, exact });
    }

    fn row(&mut self, line: &RowLine) {
        let row = line.lean(self.names);
        if let Some(known) = &mut self.known {
            let key = key(&row);
            if let Some(&index) = known.get(&key) {
                self.rows[index] = row;
                return;
            }
            known.insert(key, self.rows.len());
        }
        self.rows.push(row);
    }

    fn resumed(&mut self) {
        self.end = None;
        // Without an input their keys are not complete; the resumed run tries them again
        let no_result = |row: &LeanRow| matches!(row.status, Status::Failed | Status::Skipped);
        self.rows.retain(|row| !(no_result(row) && row.inputs.is_empty()));
        self.known = Some(self.rows.iter().enumerate().map(|(index, row)| (key(row), index)).collect());
    }

    fn finished(self, folder: PathBuf) -> Result<LeanRun> {
        let Some(provenance) = self.provenance else {
            return Err(Error::file(self.path, None, "empty", "the run was killed before it began"));
        };
        let resume = format!("rtbench {} --resume {} measures the rest", provenance.workload, folder.display());
        match self.end {
            Some(end) if end.complete && !self.cut_off => {
                Ok(LeanRun { folder, provenance, inputs: self.inputs, artifacts: self.artifacts, rows: self.rows, end })
            }
            Some(_) => Err(Error::file(self.path, None, "the run ended before all rows were measured", resume)),
            None => Err(Error::file(self.path, None, "the run has not ended: it has no last line", resume)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::is_metric;

    #[test]
    fn a_metric_is_meant_with_and_without_a_part() {
        let metrics = ["bytes".to_owned()];
        assert!(is_metric("bytes", &metrics) && is_metric("light samples.bytes", &metrics));
        assert!(!is_metric("structure_bytes", &metrics) && !is_metric("bytes.ms", &metrics));
    }
}
