//! Writing derived files: whole or not at all.

use crate::error::{Error, Result};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Writes a file by way of a temporary file in the same folder and a rename, so that a reader never sees half of it and
/// a full disk leaves the old one. What is no regular file (`/dev/stdout`, a pipe) is written to directly: replacing a
/// device node by a file would be a nasty surprise.
///
/// # Errors
/// [`Error::Output`].
pub fn replace(path: &Path, content: &[u8]) -> Result<()> {
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

/// Refuses to write over a file that is read, under any name or link.
///
/// # Errors
/// [`Error::Input`] that names both.
pub fn refuse_overwrite<'a>(out: &Path, mut inputs: impl Iterator<Item = &'a Path>) -> Result<()> {
    match inputs.find(|input| is_same(input, out)) {
        None => Ok(()),
        Some(input) => {
            let problem = format!("it is the same file as {}, which is read", input.display());
            Err(Error::file(out, None, problem, "write to another file"))
        }
    }
}

/// True for two names of one regular file. What is none, as a terminal, may well be read and written.
fn is_same(a: &Path, b: &Path) -> bool {
    match (fs::canonicalize(a), fs::canonicalize(b)) {
        (Ok(a), Ok(b)) => a.is_file() && (a == b || is_linked(&a, &b)),
        _ => false,
    }
}

#[cfg(unix)]
fn is_linked(a: &Path, b: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |path: &Path| fs::metadata(path).map(|m| (m.dev(), m.ino())).ok();
    place(a).is_some_and(|a| place(b) == Some(a))
}

#[cfg(not(unix))]
fn is_linked(_: &Path, _: &Path) -> bool {
    false
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

/// A name as a part of a file's name: letters, digits, dots and single dashes.
pub fn slug(name: &str) -> String {
    let mut slug = String::new();
    for c in name.chars() {
        if c.is_alphanumeric() || c == '.' {
            slug.extend(c.to_lowercase());
        } else if !slug.ends_with('-') {
            slug.push('-');
        }
    }
    let slug = slug.trim_matches(['-', '.']);
    // File systems end names at 255 bytes; a scene's name may be any file's.
    slug.chars().take(80).collect()
}
