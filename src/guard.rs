//! No command writes over a file that it has read.
//!
//! Whatever reads an input of the user remembers it here; whatever writes a file asks first. A file is known by its
//! device and inode, so that links and other spellings of its path count as the same.

use crate::error::{Error, Result};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// Device and inode; where the system has none, the path without links.
#[cfg(unix)]
type Identity = (u64, u64);
#[cfg(not(unix))]
type Identity = PathBuf;

static READ: Mutex<Vec<(PathBuf, Identity)>> = Mutex::new(Vec::new());

/// Identity of a regular file. Other things, such as a terminal, may well be read and written.
#[cfg(unix)]
fn identity(path: &Path) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    let metadata = std::fs::metadata(path).ok()?;
    metadata.is_file().then(|| (metadata.dev(), metadata.ino()))
}

#[cfg(not(unix))]
fn identity(path: &Path) -> Option<Identity> {
    std::fs::metadata(path).ok()?.is_file().then(|| path.canonicalize().ok())?
}

/// Remembers a file that is read as an input.
pub fn read(path: &Path) {
    let Some(identity) = identity(path) else { return };
    let mut read = READ.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    if !read.iter().any(|known| known.1 == identity && known.0 == path) {
        read.push((path.to_owned(), identity));
    }
}

/// Files of a run's folder that no reader of runs writes over.
const OF_A_RUN: [&str; 4] = ["journal.jsonl", "run.json", "summary.csv", "structures.csv"];

/// Remembers the files of a run that is read.
pub fn read_run(folder: &Path) {
    OF_A_RUN.iter().for_each(|name| read(&folder.join(name)));
}

/// Refuses to write over a file that was read, under any name or link. A file that was replaced since then does not
/// count.
///
/// # Errors
/// [`Error::Input`] that names both.
pub fn check_output(out: &Path) -> Result<()> {
    let Some(target) = identity(out) else { return Ok(()) };
    let read = READ.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let is_target = |(path, known): &&(PathBuf, Identity)| *known == target && identity(path).as_ref() == Some(known);
    match read.iter().find(is_target) {
        None => Ok(()),
        Some((input, _)) => {
            let problem = format!("it is the same file as {}, which is read", input.display());
            Err(Error::file(out, None, problem, "write to another file"))
        }
    }
}
