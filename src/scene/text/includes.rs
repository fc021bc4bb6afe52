//! Opens included files: refuses loops and files outside of the scene's folder, and reads each file once.

use super::{Fault, quote_bytes};
use crate::error::Result;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// The largest nesting depth of includes.
const MAX_DEPTH: usize = 64;

/// The largest number of includes in one pass.
const MAX_READINGS: usize = 20_000;

/// The limit of bytes that are parsed in all passes together is `BASE` plus `TIMES` the size of all files. A second is
/// enough for some hundred megabytes.
const BASE: usize = 64 << 20;
const TIMES: usize = 16;

/// The scene's file and the files that it includes.
pub struct Includes {
    /// The scene's file as the user named it, and its bytes.
    first: (PathBuf, Rc<Vec<u8>>),
    /// Canonical path of the scene's folder; empty until the first include.
    root: PathBuf,
    /// True if includes may leave the scene's folder.
    outside: bool,
    /// The bytes of files by their canonical path.
    files: HashMap<PathBuf, Rc<Vec<u8>>>,
    /// Canonical paths of the open files, the scene's file first.
    open: Vec<PathBuf>,
    /// Number of includes in this pass.
    readings: usize,
    /// Size of all files in bytes, each counted once.
    bytes: usize,
    /// Number of bytes that were parsed, in all passes.
    passed: usize,
}

impl Includes {
    /// Reads the scene's file. `outside` allows includes to leave its folder.
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

    /// Resolves the path of the scene's file, before the first include.
    fn locate(&mut self) {
        let (path, bytes) = &self.first;
        let whole = path.canonicalize().unwrap_or_else(|_| path.clone());
        self.root = whole.parent().map(Path::to_owned).unwrap_or_default();
        self.files.insert(whole.clone(), Rc::clone(bytes));
        self.open.push(whole);
    }

    /// Size of all files so far in bytes, each counted once.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Releases the bytes of the scene's file. They are not needed again, because no file may include it.
    pub fn release_first(&mut self) {
        self.first.1 = Rc::default();
    }

    /// Opens the file `name` that the file `including` includes. Returns its path for messages, and its bytes. The
    /// caller must call [`Includes::close`] after reading it.
    ///
    /// # Errors
    /// The file must not be included, or cannot be read.
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
                // A quoted name may contain line ends.
                let place: String = shown.to_string_lossy().chars().filter(|c| !c.is_control()).collect();
                return fault("no such file", format!("it was searched as {place}"));
            }
            Err(e) => return fault(&format!("cannot be read: {e}"), String::new()),
        };
        if !self.outside && !whole.starts_with(&self.root) {
            return fault("lies outside of the scene's folder", "allow that with FILE:outside=yes".into());
        }
        if self.open.contains(&whole) {
            return fault("the file includes itself, directly or through other files", "break the loop".into());
        }
        if self.open.len() > MAX_DEPTH {
            return fault("the includes are nested too deeply", format!("{MAX_DEPTH} levels are allowed"));
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
            return fault(&problem, "reduce the nested includes".into());
        }
        self.open.push(whole);
        Ok((shown, bytes))
    }

    /// Closes the file that was opened last.
    pub fn close(&mut self) {
        self.open.pop();
    }

    /// Starts another pass at the scene's file. The bytes of earlier passes still count.
    pub fn rewind(&mut self) {
        self.open.truncate(1);
        self.readings = 0;
        self.passed += self.first.1.len();
    }
}
