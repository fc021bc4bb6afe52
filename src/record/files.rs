//! Writing derived files: whole or not at all.

use crate::error::{Error, Result};
use crate::guard;
use std::fs;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Writes a file by way of a temporary file in the same folder and a rename, so that a reader never sees half of it and
/// a full disk leaves the old one. What is no regular file (`/dev/stdout`, a pipe) is written to directly: replacing a
/// device node by a file would be a nasty surprise.
///
/// # Errors
/// [`Error::Output`]; [`Error::Input`] for a file that was read, see [`guard`].
pub fn replace(path: &Path, content: &[u8]) -> Result<()> {
    guard::check_output(path)?;
    // A link is followed first: it is its target that is to be replaced.
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if fs::metadata(&path).is_ok_and(|m| !m.is_file()) {
        let mut file = fs::OpenOptions::new().write(true).open(&path).map_err(|source| Error::output(&path, source))?;
        return file.write_all(content).map_err(|source| Error::output(&path, source));
    }
    let temporary = temp_path(&path);
    let written = fs::File::create(&temporary)
        .and_then(|mut file| {
            file.write_all(content)?;
            file.sync_data()
        })
        .and_then(|()| fs::rename(&temporary, &path));
    written.map_err(|source| {
        // Best effort: the error that matters is the one being reported.
        let _ = fs::remove_file(&temporary);
        Error::output(&path, source)
    })
}

/// A name in the folder of `path` that no other process uses.
fn temp_path(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.part", std::process::id()));
    path.with_file_name(name)
}

/// Creates a folder for a run's output, with its parents. It must be new or empty: a run never mixes with another.
///
/// # Errors
/// [`Error::Output`] if it cannot be created, [`Error::Input`] if something is in it.
pub fn create_run_folder(path: &Path) -> Result<()> {
    if path.exists() && !path.is_dir() {
        let problem = format!("{} is no folder", path.display());
        return Err(Error::argument("--out", problem, "give a new folder"));
    }
    fs::create_dir_all(path).map_err(|source| Error::output(path, source))?;
    let mut entries = fs::read_dir(path).map_err(|source| Error::output(path, source))?;
    if entries.next().is_some() {
        return Err(Error::argument(
            "--out",
            format!("{} is not empty", path.display()),
            "give a new folder, so that runs do not mix",
        ));
    }
    Ok(())
}

/// Creates a new folder, and its parents: `path`, or where there is something of this name `path-2`, `path-3`, ...
///
/// # Errors
/// [`Error::Output`].
pub fn create_numbered_folder(path: &Path) -> Result<PathBuf> {
    if let Some(parent) = path.parent() {
        fs::create_dir_all(parent).map_err(|source| Error::output(parent, source))?;
    }
    let mut folder = path.to_owned();
    for number in 2.. {
        match fs::create_dir(&folder) {
            Ok(()) => break,
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                let mut name = path.file_name().unwrap_or_default().to_owned();
                name.push(format!("-{number}"));
                folder = path.with_file_name(name);
            }
            Err(source) => return Err(Error::output(&folder, source)),
        }
    }
    Ok(folder)
}
