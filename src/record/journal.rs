//! The journal of a run: append-only, one JSON record per line, on disk as soon as it is written.

use super::row::{Artifact, Input, Key, Row, SCHEMA, Status, Value};
use super::run::{End, Provenance, Resumed};
use crate::error::{Error, Result};
use crate::guard;
use crate::record::files;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashMap};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

/// File name inside a run's folder.
pub const FILE_NAME: &str = "journal.jsonl";

/// The folder of a run that is named as such or by its journal.
pub fn folder_of(run: &Path) -> PathBuf {
    match run.parent() {
        Some(folder) if run.is_file() && run.ends_with(FILE_NAME) => match folder.as_os_str().is_empty() {
            true => PathBuf::from("."),
            false => folder.to_owned(),
        },
        _ => run.to_owned(),
    }
}

/// One line of a journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "record", rename_all = "kebab-case")]
pub enum Record {
    /// Where the run comes from: always the first line.
    Run(Box<Provenance>),
    /// Something that rows were measured on; written before the first of them.
    Input(Box<Input>),
    /// Something that was built for rows; written before the first of them.
    Artifact(Box<Artifact>),
    /// A case that was measured, or the reason why it was not.
    Row(Box<Row>),
    /// The run ended in order; absent where the process was killed.
    End(End),
    /// The run was resumed: what follows was measured from here on.
    Resumed(Box<Resumed>),
}

/// Appends records.
pub struct JournalWriter {
    path: PathBuf,
    file: File,
    /// Bytes of whole lines: what to cut the file back to if a line gets no further than half.
    length: u64,
}

impl JournalWriter {
    /// Creates the run's folder and its journal, and writes the first line.
    ///
    /// # Errors
    /// [`Error::Output`], or [`Error::Input`] if the folder is not empty.
    pub fn create(folder: &Path, provenance: Provenance) -> Result<JournalWriter> {
        files::create_run_folder(folder)?;
        let path = folder.join(FILE_NAME);
        let file = OpenOptions::new()
            .append(true)
            .create_new(true)
            .open(&path)
            .map_err(|source| Error::output(&path, source))?;
        lock(&path, &file)?;
        let mut writer = JournalWriter { path, file, length: 0 };
        writer.write(&Record::Run(Box::new(provenance)))?;
        Ok(writer)
    }

    /// Opens the journal of a run that is resumed, truncates a partial last line, and records the resumption. `known`
    /// is the number of bytes that the caller has read of it.
    ///
    /// # Errors
    /// [`Error::Output`], or [`Error::Input`] if another process is writing it or has written to it since.
    pub fn resume(folder: &Path, resumed: Resumed, known: u64) -> Result<JournalWriter> {
        let path = folder.join(FILE_NAME);
        let output = |source| Error::output(&path, source);
        let mut file = OpenOptions::new().read(true).append(true).open(&path).map_err(output)?;
        lock(&path, &file)?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(output)?;
        if bytes.len() as u64 != known {
            return Err(being_written(&path));
        }
        let end = bytes.iter().rposition(|&b| b == b'\n').map_or(0, |end| end + 1);
        let length = if end < bytes.len() && serde_json::from_slice::<Record>(&bytes[end..]).is_ok() {
            // A whole record that only lacks the end of its line: readers take it, so it is kept
            file.write_all(b"\n").map_err(output)?;
            bytes.len() as u64 + 1
        } else {
            end as u64
        };
        file.set_len(length).map_err(output)?;
        let mut writer = JournalWriter { path, file, length };
        writer.write(&Record::Resumed(Box::new(resumed)))?;
        Ok(writer)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Appends one line and brings it to the disk. If that fails, the lines before it stay whole.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn write(&mut self, record: &Record) -> Result<()> {
        let output = |source| Error::output(&self.path, source);
        let mut line = serde_json::to_vec(record).map_err(|e| output(e.into()))?;
        line.push(b'\n');
        if let Err(source) = self.file.write_all(&line) {
            // Truncate the partial line; readers would tolerate it.
            let _ = self.file.set_len(self.length);
            return Err(output(source));
        }
        self.length += line.len() as u64;
        match self.file.sync_data() {
            // Some file systems have nothing to synchronise with.
            Err(source) if !matches!(source.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => {
                Err(output(source))
            }
            _ => Ok(()),
        }
    }
}

/// Keeps other sweeps away from a journal for as long as the file is open. Where the file system knows no locks,
/// nothing does.
fn lock(path: &Path, file: &File) -> Result<()> {
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => Err(being_written(path)),
        Err(TryLockError::Error(_)) | Ok(()) => Ok(()),
    }
}

fn being_written(path: &Path) -> Error {
    Error::file(path, None, "another process is writing this run", "wait until it is done, or stop it first")
}

/// A journal, read back.
#[derive(Clone, Debug, PartialEq)]
pub struct Journal {
    /// First line.
    pub provenance: Provenance,
    /// In the order in which they were opened.
    pub inputs: Vec<Input>,
    /// In the order in which they were built.
    pub artifacts: Vec<Artifact>,
    /// In the order of measuring; a row that was measured again after the run was resumed is where it first was.
    pub rows: Vec<Row>,
    /// Each time that the run was resumed.
    pub resumed: Vec<Resumed>,
    /// Last line, if the run ended in order.
    pub end: Option<End>,
    /// What had to be left out: a last line that was cut off.
    pub truncated: Option<String>,
    /// Bytes of the file.
    pub length: u64,
}

/// `run.json`: a journal as one document, with rows as in `summary.csv`.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RunDocument<'j> {
    /// Where the run comes from.
    pub run: &'j Provenance,
    /// In the order in which they were opened.
    pub inputs: &'j [Input],
    /// In the order in which they were built.
    pub artifacts: &'j [Artifact],
    /// A value for each column; null where a column has no meaning for a row.
    pub rows: Vec<BTreeMap<String, Option<Value>>>,
    /// Each time that the run was resumed.
    pub resumed: &'j [Resumed],
    /// How it ended; null where the process was killed.
    pub end: &'j Option<End>,
}

impl<'j> RunDocument<'j> {
    /// The document of a journal with its rows by column.
    pub fn new(journal: &'j Journal, rows: Vec<BTreeMap<String, Option<Value>>>) -> RunDocument<'j> {
        let Journal { provenance: run, inputs, artifacts, resumed, end, .. } = journal;
        RunDocument { run, inputs, artifacts, rows, resumed, end }
    }
}

/// The bytes of a run's journal.
///
/// # Errors
/// [`Error::Input`] if it cannot be read.
pub fn bytes_of(path: &Path) -> Result<Vec<u8>> {
    guard::read(path);
    std::fs::read(path).map_err(|e| Error::file(path, None, format!("cannot read: {e}"), "give the folder of a run"))
}

/// The lines of a journal with their numbers, and what had to be left out.
pub type Lines<T> = (Vec<(usize, T)>, Option<String>);

/// The lines of a journal as JSON with their numbers, which count from 1, and what had to be left out: a last line that
/// is cut off.
///
/// # Errors
/// [`Error::Input`] with file and line for a line that `parse` refuses.
pub fn lines<T>(path: &Path, bytes: &[u8], parse: impl Fn(&[u8]) -> serde_json::Result<T>) -> Result<Lines<T>> {
    let mut records = Vec::new();
    for (index, line) in bytes.split_inclusive(|&b| b == b'\n').enumerate() {
        let number = index + 1;
        match parse(line) {
            Ok(record) => records.push((number, record)),
            Err(_) if !line.ends_with(b"\n") && number > 1 => {
                return Ok((records, Some(format!("line {number} of {} is cut off and left out", path.display()))));
            }
            Err(e) => {
                let hint = "it is no journal of rtbench, or it was edited";
                // The record is one line: the parser's own position would be another number
                let text = e.to_string();
                let problem = text.rsplit_once(" at line ").map_or(&*text, |(problem, _)| problem);
                return Err(Error::file(path, Some(number), format!("not a record: {problem}"), hint));
            }
        }
    }
    Ok((records, None))
}

/// The schema that a journal's first line names; `None` if that is not a line of a journal.
pub fn schema_of(bytes: &[u8]) -> Option<String> {
    #[derive(serde::Deserialize)]
    struct First {
        schema: String,
    }
    let line = bytes.split_inclusive(|&b| b == b'\n').next()?;
    Some(serde_json::from_slice::<First>(line).ok()?.schema)
}

impl Journal {
    /// Reads a journal of the current schema. A last line that was cut off is left out, and said to be.
    ///
    /// # Errors
    /// [`Error::Input`] with file and line for anything else that is not a journal of this schema.
    pub fn read(path: &Path) -> Result<Journal> {
        Journal::parse(path, &bytes_of(path)?)
    }

    /// Parses the bytes of a journal; `path` is for messages.
    ///
    /// # Errors
    /// As [`Journal::read`].
    pub fn parse(path: &Path, bytes: &[u8]) -> Result<Journal> {
        if let Some(other) = schema_of(bytes).filter(|schema| schema != SCHEMA) {
            let problem = format!("schema {other:?} instead of {SCHEMA:?}");
            return Err(Error::file(
                path,
                Some(1),
                problem,
                "tables and reports read it; a run is resumed by the version that began it",
            ));
        }
        let (records, truncated) = lines(path, bytes, |line| serde_json::from_slice::<Record>(line))?;
        let mut records = records.into_iter();
        let provenance = match records.next() {
            Some((_, Record::Run(run))) => *run,
            Some((number, _)) => {
                return Err(Error::file(path, Some(number), "the first line is no run's provenance", ""));
            }
            None => return Err(Error::file(path, None, "empty", "the run was killed before it began")),
        };
        let mut journal = Journal {
            provenance,
            inputs: Vec::new(),
            artifacts: Vec::new(),
            rows: Vec::new(),
            resumed: Vec::new(),
            end: None,
            truncated,
            length: bytes.len() as u64,
        };
        let mut known: HashMap<(Key, usize), usize> = HashMap::new();
        for (number, record) in records {
            match record {
                Record::Run(_) => {
                    let hint = "journals of several runs must not be joined";
                    return Err(Error::file(path, Some(number), "a second provenance", hint));
                }
                Record::Input(input) => journal.inputs.push(*input),
                Record::Artifact(artifact) => journal.artifacts.push(*artifact),
                Record::Row(row) => {
                    // Only a resumed run measures a case again
                    let key = (row.key.clone(), row.device);
                    match known.get(&key) {
                        Some(&index) if !journal.resumed.is_empty() => journal.rows[index] = *row,
                        _ => {
                            known.insert(key, journal.rows.len());
                            journal.rows.push(*row);
                        }
                    }
                }
                Record::End(end) => journal.end = Some(end),
                Record::Resumed(resumed) => {
                    journal.resumed.push(*resumed);
                    journal.end = None;
                    // Without an input their keys are not complete; the resumed run tries them again
                    let no_result = |row: &Row| matches!(row.status, Status::Failed | Status::Skipped);
                    journal.rows.retain(|row| !(no_result(row) && row.key.inputs.is_empty()));
                    let rows = journal.rows.iter().enumerate();
                    known = rows.map(|(index, row)| ((row.key.clone(), row.device), index)).collect();
                }
            }
        }
        Ok(journal)
    }

    /// The input of a kind that a key names.
    pub fn input(&self, key: &Key, kind: &str) -> Option<&Input> {
        let hash = key.inputs.get(kind)?;
        let same = || self.inputs.iter().filter(|input| input.kind == kind && input.hash == *hash);
        same().find(|input| input.name == key.axis(kind)).or_else(|| same().next())
    }
}
