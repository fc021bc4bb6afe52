//! Files that include others: found, held against loops and against leaving the scene's folder, read once.

use super::{Fault, quote_bytes};
use crate::error::Result;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Most files inside each other.
const MAX_DEPTH: usize = 64;

/// Most includes that are followed in all.
const MAX_READINGS: usize = 20_000;

/// Bytes that may be gone through in all, readers' second passes included: so many in any case, and so many times the
/// files' sizes. Some hundred megabytes are a second.
const BASE: usize = 64 << 20;
const TIMES: usize = 16;

/// The files of a scene.
pub struct Includes {
    /// The first file, as it was named, and its bytes.
    first: (PathBuf, Rc<Vec<u8>>),
    /// Its folder, without links; empty until something is included, for most files include nothing.
    root: PathBuf,
    outside: bool,
    /// Bytes by the file's path without links.
    files: HashMap<PathBuf, Rc<Vec<u8>>>,
    /// What is being read, from the first file inwards.
    open: Vec<PathBuf>,
    readings: usize,
    /// Bytes of all files, each once.
    bytes: usize,
    /// Bytes gone through.
    passed: usize,
}

impl Includes {
    /// The scene whose first file is `path`, and its bytes. `outside` says that includes may leave its folder.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn new(path: &Path, outside: bool) -> Result<(Includes, Rc<Vec<u8>>)> {
        let bytes = Rc::new(crate::scene::read_text(path)?);
        let includes = Includes {
            first: (path.to_owned(), Rc::clone(&bytes)),
            root: PathBuf::new(),
            outside,
            files: HashMap::new(),
            open: Vec::new(),
            readings: 0,
            bytes: bytes.len(),
            passed: bytes.len(),
        };
        Ok((includes, bytes))
    }

    /// Finds out where the first file is.
    fn locate(&mut self) {
        let (path, bytes) = &self.first;
        let whole = path.canonicalize().unwrap_or_else(|_| path.clone());
        self.root = whole.parent().map(Path::to_owned).unwrap_or_default();
        self.files.insert(whole.clone(), Rc::clone(bytes));
        self.open.push(whole);
    }

    /// Bytes of all files so far, each counted once.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Lets go of the first file's bytes: no file may include it, so that nobody asks for them again.
    pub fn release_first(&mut self) {
        self.first.1 = Rc::default();
    }

    /// Opens the file that `including` calls `name`: its path as errors show it, and its bytes. [`Includes::close`]
    /// ends it.
    ///
    /// # Errors
    /// It may not be included, or cannot be read.
    pub fn open(&mut self, including: &Path, name: &[u8]) -> Result<(PathBuf, Rc<Vec<u8>>), Fault> {
        let fault = |problem: &str, hint: String| {
            Err(Fault::new(None, format!("include {}: {problem}", quote_bytes(name)), hint))
        };
        if self.open.is_empty() {
            self.locate();
        }
        let shown = including.with_file_name("").join(String::from_utf8_lossy(name).as_ref());
        let whole = match shown.canonicalize() {
            Ok(whole) => whole,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
                // A quoted name may have line ends in it
                let place: String = shown.to_string_lossy().chars().filter(|c| !c.is_control()).collect();
                return fault("no such file", format!("it would be {place}"));
            }
            Err(e) => return fault(&format!("cannot be read: {e}"), String::new()),
        };
        if !self.outside && !whole.starts_with(&self.root) {
            return fault("lies outside of the scene's folder", "allow that with FILE:outside=yes".into());
        }
        if self.open.contains(&whole) {
            return fault("the file includes itself, perhaps by way of others", "break the loop".into());
        }
        if self.open.len() > MAX_DEPTH {
            return fault("too many files inside each other", format!("{MAX_DEPTH} are allowed"));
        }
        let bytes = match self.files.get(&whole) {
            Some(bytes) => Rc::clone(bytes),
            None => {
                let bytes = match crate::scene::read_text(&whole) {
                    Ok(bytes) => Rc::new(bytes),
                    Err(error) => return fault(&error.to_string(), String::new()),
                };
                self.bytes += bytes.len();
                self.files.insert(whole.clone(), Rc::clone(&bytes));
                bytes
            }
        };
        self.readings += 1;
        self.passed += bytes.len();
        if self.readings > MAX_READINGS || self.passed > BASE + TIMES * self.bytes {
            let problem = format!("files are included too often, {} MiB in all", self.passed >> 20);
            return fault(&problem, "are there includes of includes of includes?".into());
        }
        self.open.push(whole);
        Ok((shown, bytes))
    }

    /// Ends the file that was opened last.
    pub fn close(&mut self) {
        self.open.pop();
    }

    /// Starts again with the first file. What has been gone through before counts.
    pub fn rewind(&mut self) {
        self.open.truncate(1);
        self.readings = 0;
        self.passed += self.first.1.len();
    }
}
