//! What files a scene is made from: noted where files are read ([`super::read_file`]), while somebody asks for it.
//!
//! Readers know nothing of it, and all of them read on the thread that they are called on; so what is asked for is kept per
//! thread.

use std::cell::RefCell;
use std::ffi::OsStr;
use std::fs::Metadata;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// File systems tell times in steps; a file that was modified less than this before it was read may be modified again at
/// what they take for the same time.
const STEP: Duration = Duration::from_millis(100);

/// What stands behind a [`Source`]'s path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Kind {
    /// A file; the hash is BLAKE3 of its bytes.
    File,
    /// A folder that is a scene as a whole; the hash is BLAKE3 of the names of its files.
    Folder,
    /// A cache; the hash is that of the scene in it.
    Cache,
    /// A file that is named, but was not there.
    Absent,
}

/// A file that a scene is made from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// Where it is, its folder without links.
    pub path: PathBuf,
    /// What it is.
    pub kind: Kind,
    /// Its length.
    pub bytes: u64,
    /// When it was modified, in nanoseconds since 1970; `None` if that would not tell it from a later state.
    pub modified: Option<u64>,
    /// When the system noted its last change, in the same way: see [`changed`].
    pub changed: Option<u64>,
    /// What it holds, hexadecimal; empty if only paths were asked for.
    pub hash: String,
}

struct Record {
    hashes: bool,
    sources: Vec<Source>,
}

thread_local! {
    static RECORD: RefCell<Option<Record>> = const { RefCell::new(None) };
}

/// Does something, and returns with it what files were read meanwhile, each once; with their hashes if those are asked for.
/// Records may lie inside each other.
pub fn record<T>(hashes: bool, work: impl FnOnce() -> T) -> (T, Vec<Source>) {
    let outer = RECORD.take();
    let hashes = hashes || outer.as_ref().is_some_and(|outer| outer.hashes);
    RECORD.set(Some(Record { hashes, sources: Vec::new() }));
    let result = work();
    let sources = RECORD.take().map_or(Vec::new(), |record| record.sources);
    RECORD.set(outer);
    sources.iter().for_each(|source| add(|_| source.clone()));
    (result, sources)
}

/// Notes a source, if anybody asks; what makes it is told whether hashes are wanted.
pub fn add(source: impl FnOnce(bool) -> Source) {
    RECORD.with_borrow_mut(|record| {
        if let Some(record) = record {
            let source = source(record.hashes);
            if !record.sources.contains(&source) {
                record.sources.push(source);
            }
        }
    });
}

/// Notes a file that was read; `metadata` is from before that.
pub fn read(path: &Path, metadata: &Metadata, content: &[u8]) {
    add(|hashes| Source {
        path: whole(path),
        kind: Kind::File,
        bytes: content.len() as u64,
        modified: modified(metadata).filter(settled),
        changed: changed(metadata).filter(settled),
        hash: if hashes { blake3::hash(content).to_hex().to_string() } else { String::new() },
    });
}

/// Notes that a file was looked for and is not there.
pub fn absent(path: &Path) {
    add(|_| Source {
        path: whole(path),
        kind: Kind::Absent,
        bytes: 0,
        modified: None,
        changed: None,
        hash: String::new(),
    });
}

/// Notes a folder with these files.
pub fn folder(path: &Path, files: &[PathBuf]) {
    add(|_| Source {
        path: path.canonicalize().unwrap_or_else(|_| path.to_owned()),
        kind: Kind::Folder,
        bytes: files.len() as u64,
        modified: None,
        changed: None,
        hash: names_hash(files),
    });
}

/// A hash of the files' names.
pub fn names_hash(files: &[PathBuf]) -> String {
    let mut hasher = blake3::Hasher::new();
    for name in files.iter().map(|file| file.file_name().unwrap_or(OsStr::new("")).as_encoded_bytes()) {
        hasher.update(&(name.len() as u64).to_le_bytes());
        hasher.update(name);
    }
    hasher.finalize().to_hex().to_string()
}

/// When a file was modified, in nanoseconds since 1970.
pub fn modified(metadata: &Metadata) -> Option<u64> {
    let since = metadata.modified().ok()?.duration_since(SystemTime::UNIX_EPOCH).ok()?;
    u64::try_from(since.as_nanos()).ok()
}

/// When the system noted the last change of a file's content, name or permissions, in nanoseconds since 1970. The other
/// time is set back by `touch`, `cp -p`, archives and rsync; this one by nobody. `None` on systems without it.
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

/// True if whatever is done to the file from now on will show in this time of it, in nanoseconds since 1970.
fn settled(time: &u64) -> bool {
    let time = SystemTime::UNIX_EPOCH + Duration::from_nanos(*time);
    SystemTime::now().duration_since(time).is_ok_and(|age| age >= STEP)
}

/// The path with its folder free of links. The file itself may be one: then it is the link that counts, since it may come
/// to lead elsewhere.
pub fn whole(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    match (folder.canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    }
}
