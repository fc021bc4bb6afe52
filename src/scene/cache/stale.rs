//! The source files of a cache as stored in it, and the check whether they have changed.

use super::layout::Header;
use crate::scene::load;
use crate::scene::sources::{self, SourceFile, SourceKind};
use bytemuck::Zeroable;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// A [`SourceFile`] as stored in a cache.
#[derive(Serialize, Deserialize)]
pub struct Stored {
    /// Path relative to the cache's folder, with `/`. Cache and sources can be moved together, and a cache cannot name
    /// another computer.
    path: String,
    kind: SourceKind,
    bytes: u64,
    modified: Option<u64>,
    changed: Option<u64>,
    hash: String,
}

/// Converts the sources of the cache at `cache` to their stored form. It omits the cache itself, if the cache replaces
/// a file that it was made from, and paths that have no relative form in UTF-8 (as those on another drive).
pub fn store(sources: &[SourceFile], cache: &Path) -> Vec<Stored> {
    let cache = sources::resolve_folder(cache);
    let folder = cache.parent().unwrap_or(Path::new(""));
    let stored = |source: &SourceFile| {
        let SourceFile { kind, bytes, modified, changed, .. } = *source;
        let path = relative(folder, &source.path)?;
        Some(Stored { path, kind, bytes, modified, changed, hash: source.hash.clone() })
    };
    sources.iter().filter(|source| source.path != cache).filter_map(stored).collect()
}

/// The relative path from a folder to a file; both paths must be free of links.
fn relative(folder: &Path, file: &Path) -> Option<String> {
    let (from, to): (Vec<_>, Vec<_>) = (folder.components().collect(), file.components().collect());
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return None;
    }
    let up = std::iter::repeat_n(Some(".."), from.len() - shared);
    let down = to[shared..].iter().map(|part| part.as_os_str().to_str());
    // The path is empty if the source is the cache's folder.
    let way = up.chain(down).collect::<Option<Vec<&str>>>()?.join("/");
    Some(if way.is_empty() { ".".into() } else { way })
}

/// Converts the stored sources of a cache in `folder` back; `None` if a path is not one that [`store`] could have
/// written.
pub fn restore(stored: Vec<Stored>, folder: &Path) -> Option<Vec<SourceFile>> {
    let restored = |stored: Stored| {
        let Stored { path, kind, bytes, modified, changed, hash } = stored;
        let way = Path::new(&path);
        let allowed = |part| matches!(part, Component::Normal(_) | Component::ParentDir | Component::CurDir);
        if path.is_empty() || !way.components().all(allowed) {
            return None;
        }
        let mut place = folder.to_owned();
        for part in way.components() {
            match part {
                Component::ParentDir => _ = place.pop(),
                Component::Normal(name) => place.push(name),
                _ => {}
            }
        }
        Some(SourceFile { path: place, kind, bytes, modified, changed, hash })
    };
    stored.into_iter().map(restored).collect()
}

/// The first source that has changed, with a description of the change. If none of the source files exists, changes
/// cannot be detected, and the result is `None`.
pub fn changed(sources: &[SourceFile]) -> Option<(&Path, &'static str)> {
    let exists =
        |source: &&SourceFile| matches!(source.kind, SourceKind::File | SourceKind::Folder) && source.path.exists();
    let alone = sources.iter().find(exists).is_none();
    let change = |source: &SourceFile| match (source.kind, source.path.exists()) {
        (SourceKind::Absent, true) if !alone => Some("exists now"),
        (SourceKind::Absent, _) => None,
        (SourceKind::Cache, false) => None,
        (_, false) => (!alone).then_some("no longer exists"),
        (SourceKind::File, true) => (!is_same_file(source)).then_some("has changed"),
        (SourceKind::Folder, true) => (!is_same_folder(source)).then_some("has other files"),
        (SourceKind::Cache, true) => (content(&source.path).as_ref() != Some(&source.hash)).then_some("has changed"),
    };
    sources.iter().find_map(|source| Some((source.path.as_path(), change(source)?)))
}

/// True if the file's content is unchanged. If length and both times are equal, the content is assumed to be equal;
/// otherwise it is hashed, since copies and checkouts change the time of modification without changing the content, and
/// renaming and permissions change the time that the system notes.
fn is_same_file(source: &SourceFile) -> bool {
    let Ok(metadata) = std::fs::metadata(&source.path) else { return false };
    if !metadata.is_file() || metadata.len() != source.bytes {
        return false;
    }
    let untouched = source.modified.is_some()
        && source.modified == sources::modified(&metadata)
        && source.changed == sources::changed(&metadata);
    untouched || hash(&source.path).is_some_and(|hash| hash == source.hash)
}

fn is_same_folder(source: &SourceFile) -> bool {
    load::files_of_folder(&source.path).is_ok_and(|files| sources::names_hash(&files) == source.hash)
}

fn hash(path: &Path) -> Option<String> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(File::open(path).ok()?).ok()?;
    Some(hasher.finalize().to_hex().to_string())
}

/// The content hash in the header of the cache at `path`, hexadecimal.
fn content(path: &Path) -> Option<String> {
    let mut header = Header::zeroed();
    if !std::fs::metadata(path).ok()?.is_file() {
        return None;
    }
    File::open(path).ok()?.read_exact(bytemuck::bytes_of_mut(&mut header)).ok()?;
    Some(hexadecimal(&header))
}

/// The content hash of a cache, hexadecimal.
pub fn hexadecimal(header: &Header) -> String {
    header.content.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The folder that the stored paths of a cache are relative to.
pub fn folder_of(cache: &Path) -> PathBuf {
    sources::resolve_folder(cache).parent().map(Path::to_owned).unwrap_or_default()
}
