//! Records the files that a scene is read from: [`super::read_file`] adds every file while a caller of [`record`]
//! waits.
//!
//! The recording is thread-local, so that readers need no parameter for it. All readers read their files on the thread
//! on which they are called.

use std::cell::RefCell;
use std::ffi::OsStr;
use std::fs::Metadata;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// An upper bound of the resolution of file times. A file that was modified less than this before it was read may be
/// modified again without a visible change of its time.
const TIME_RESOLUTION: Duration = Duration::from_millis(100);

/// The kind of file that a [`SourceFile`] refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum SourceKind {
    /// A file; the hash is BLAKE3 of its bytes.
    File,
    /// A folder with the files of one scene; the hash is BLAKE3 of their names.
    Folder,
    /// A cache; the hash is the content hash in its header.
    Cache,
    /// A file that was searched and did not exist.
    Absent,
}

/// A file that a scene was read from, with its state at that time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceFile {
    /// Path of the file; its folder is free of links.
    pub path: PathBuf,
    pub kind: SourceKind,
    /// Size in bytes; of a folder, the number of files.
    pub bytes: u64,
    /// Time of modification in nanoseconds since 1970; `None` if a later modification could have the same time.
    pub modified: Option<u64>,
    /// Time of the last change that the system noted, see [`changed`]; `None` as for `modified`.
    pub changed: Option<u64>,
    /// Hash of the content, hexadecimal; empty if only paths were requested.
    pub hash: String,
}

struct SourceLog {
    hashes: bool,
    sources: Vec<SourceFile>,
}

thread_local! {
    static LOG: RefCell<Option<SourceLog>> = const { RefCell::new(None) };
}

/// Runs `work`, and returns its result and the files that were read meanwhile, each once. They have hashes if `hashes`
/// is set. Calls may be nested.
pub fn record<T>(hashes: bool, work: impl FnOnce() -> T) -> (T, Vec<SourceFile>) {
    let outer = LOG.take();
    let hashes = hashes || outer.as_ref().is_some_and(|outer| outer.hashes);
    LOG.set(Some(SourceLog { hashes, sources: Vec::new() }));
    let result = work();
    let sources = LOG.take().map_or(Vec::new(), |log| log.sources);
    LOG.set(outer);
    sources.iter().for_each(|source| add(|_| source.clone()));
    (result, sources)
}

/// Adds a source to the current recording, if there is one. The argument of `source` tells whether hashes are
/// requested.
pub fn add(source: impl FnOnce(bool) -> SourceFile) {
    LOG.with_borrow_mut(|log| {
        if let Some(log) = log {
            let source = source(log.hashes);
            if !log.sources.contains(&source) {
                log.sources.push(source);
            }
        }
    });
}

/// Adds a file that was read; `metadata` was queried before the file was opened.
pub fn read(path: &Path, metadata: &Metadata, content: &[u8]) {
    add(|hashes| SourceFile {
        path: resolve_folder(path),
        kind: SourceKind::File,
        bytes: content.len() as u64,
        modified: modified(metadata).filter(is_conclusive),
        changed: changed(metadata).filter(is_conclusive),
        hash: if hashes { blake3::hash(content).to_hex().to_string() } else { String::new() },
    });
}

/// Adds a file that was searched and does not exist.
pub fn absent(path: &Path) {
    add(|_| SourceFile {
        path: resolve_folder(path),
        kind: SourceKind::Absent,
        bytes: 0,
        modified: None,
        changed: None,
        hash: String::new(),
    });
}

/// Adds a folder with these files.
pub fn folder(path: &Path, files: &[PathBuf]) {
    add(|_| SourceFile {
        path: path.canonicalize().unwrap_or_else(|_| path.to_owned()),
        kind: SourceKind::Folder,
        bytes: files.len() as u64,
        modified: None,
        changed: None,
        hash: names_hash(files),
    });
}

/// BLAKE3 of the files' names, hexadecimal.
pub fn names_hash(files: &[PathBuf]) -> String {
    let mut hasher = blake3::Hasher::new();
    for name in files.iter().map(|file| file.file_name().unwrap_or(OsStr::new("")).as_encoded_bytes()) {
        hasher.update(&(name.len() as u64).to_le_bytes());
        hasher.update(name);
    }
    hasher.finalize().to_hex().to_string()
}

/// Time of modification of a file, in nanoseconds since 1970.
pub fn modified(metadata: &Metadata) -> Option<u64> {
    let since = metadata.modified().ok()?.duration_since(SystemTime::UNIX_EPOCH).ok()?;
    u64::try_from(since.as_nanos()).ok()
}

/// Time at which the system noted the last change of a file's content, name or permissions (Unix: ctime), in
/// nanoseconds since 1970. Unlike the time of modification it cannot be set by `touch`, `cp -p`, archives and rsync.
/// `None` on systems without it.
#[cfg(unix)]
pub fn changed(metadata: &Metadata) -> Option<u64> {
    use std::os::unix::fs::MetadataExt;
    let nanoseconds = i128::from(metadata.ctime()) * 1_000_000_000 + i128::from(metadata.ctime_nsec());
    u64::try_from(nanoseconds).ok()
}

#[cfg(not(unix))]
pub fn changed(_: &Metadata) -> Option<u64> {
    None
}

/// True if any later change of the file will give it another time than this one, in nanoseconds since 1970.
fn is_conclusive(time: &u64) -> bool {
    let time = SystemTime::UNIX_EPOCH + Duration::from_nanos(*time);
    SystemTime::now().duration_since(time).is_ok_and(|age| age >= TIME_RESOLUTION)
}

/// The path with all links in its folder resolved. If the file itself is a link, the link is kept, since its target may
/// change.
pub fn resolve_folder(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    match (folder.canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    }
}
