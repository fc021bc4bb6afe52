//! The journal of a run: append-only, one JSON record per line, on disk as soon as it is written.

use crate::error::{Error, Result};
use crate::record::files;
use crate::record::schema::{ConfigurationRecord, End, Identity, Provenance, Record, Resumed, SCHEMA, StructureRecord};
use std::collections::HashMap;
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

    /// Opens the journal of a run that is taken up again, cuts off what is left of a half-written last line, and notes
    /// the resumption. `known` is the number of bytes that the caller has read of it.
    ///
    /// # Errors
    /// [`Error::Output`], or [`Error::Input`] if another sweep is writing it or has written to it since.
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
        let length = bytes.iter().rposition(|&b| b == b'\n').map_or(0, |end| end as u64 + 1);
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
            // Half a line is tolerated by the reader; none is nicer.
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

/// Keeps other sweeps away from a journal for as long as the file is open. Where the file system knows no locks, nothing does.
fn lock(path: &Path, file: &File) -> Result<()> {
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => Err(being_written(path)),
        Err(TryLockError::Error(_)) | Ok(()) => Ok(()),
    }
}

fn being_written(path: &Path) -> Error {
    Error::file(path, None, "another sweep is writing this run", "wait until it is done, or stop it first")
}

/// A journal, read back.
#[derive(Clone, Debug, PartialEq)]
pub struct Journal {
    /// First line.
    pub provenance: Provenance,
    /// In the order of building.
    pub structures: Vec<StructureRecord>,
    /// In the order of measuring; one that was tried again after the run was resumed stands where it first stood.
    pub configurations: Vec<ConfigurationRecord>,
    /// Each time that the run was taken up again.
    pub resumed: Vec<Resumed>,
    /// Last line, if the run ended in order.
    pub end: Option<End>,
    /// What had to be left out, in words: a last line that was cut off.
    pub truncated: Option<String>,
    /// Bytes of the file.
    pub length: u64,
}

impl Journal {
    /// Reads a journal. A last line that was cut off is left out, and said to be.
    ///
    /// # Errors
    /// [`Error::Input`] with file and line for anything else that is not a journal of this schema.
    pub fn read(path: &Path) -> Result<Journal> {
        let bytes = std::fs::read(path).map_err(|e| {
            Error::file(
                path,
                None,
                format!("cannot read: {e}"),
                "give the folder of a run, as `rtbench sweep` writes it",
            )
        })?;
        Journal::parse(path, &bytes)
    }

    /// Parses the bytes of a journal; `path` is for messages.
    ///
    /// # Errors
    /// As [`Journal::read`].
    pub fn parse(path: &Path, bytes: &[u8]) -> Result<Journal> {
        let mut provenance: Option<Provenance> = None;
        let (mut structures, mut configurations, mut end, mut truncated) = (Vec::new(), Vec::new(), None, None);
        let mut resumed = Vec::new();
        let mut places: HashMap<Identity, usize> = HashMap::new();
        for (index, line) in bytes.split_inclusive(|&b| b == b'\n').enumerate() {
            let number = index + 1;
            let record = match serde_json::from_slice::<Record>(line) {
                Ok(record) => record,
                Err(_) if !line.ends_with(b"\n") && number > 1 => {
                    truncated = Some(format!("line {number} of {} is cut off and left out", path.display()));
                    break;
                }
                Err(e) => {
                    let hint = "it is no journal of rtbench, or it was edited";
                    return Err(Error::file(path, Some(number), format!("not a record: {e}"), hint));
                }
            };
            match (record, provenance.is_some()) {
                (Record::Run(run), false) if run.schema == SCHEMA => provenance = Some(*run),
                (Record::Run(run), false) => {
                    let problem = format!("schema {:?} instead of {SCHEMA:?}", run.schema);
                    return Err(Error::file(path, Some(number), problem, "read it with the version that wrote it"));
                }
                (_, false) => {
                    return Err(Error::file(path, Some(number), "the first line is no run's provenance", ""));
                }
                (Record::Run(_), true) => {
                    let hint = "journals of several runs must not be joined";
                    return Err(Error::file(path, Some(number), "a second provenance", hint));
                }
                (Record::Structure(structure), true) => structures.push(*structure),
                (Record::Configuration(configuration), true) => {
                    // Without a resumption nothing is measured twice, and nothing is taken for it
                    match places.get(&configuration.identity()) {
                        Some(&place) if !resumed.is_empty() => configurations[place] = *configuration,
                        _ => {
                            places.insert(configuration.identity(), configurations.len());
                            configurations.push(*configuration);
                        }
                    }
                }
                (Record::End(last), true) => end = Some(last),
                (Record::Resumed(again), true) => {
                    resumed.push(*again);
                    end = None;
                }
            }
        }
        match provenance {
            Some(provenance) => {
                let length = bytes.len() as u64;
                Ok(Journal { provenance, structures, configurations, resumed, end, truncated, length })
            }
            None => Err(Error::file(path, None, "empty", "the run was killed before it began")),
        }
    }
}
