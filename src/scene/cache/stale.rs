//! What a cache is made from, as it stands in the cache, and whether that is still so.

use super::layout::Header;
use crate::scene::load;
use crate::scene::sources::{self, Kind, Source};
use bytemuck::Zeroable;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// A [`Source`] in a cache.
#[derive(Serialize, Deserialize)]
pub struct Stored {
    /// Seen from the cache's folder, with `/`: cache and sources may be moved together, and no cache can name another
    /// computer.
    path: String,
    kind: Kind,
    bytes: u64,
    modified: Option<u64>,
    changed: Option<u64>,
    hash: String,
}

/// The sources of a cache at `cache`. Left out are the cache itself, if it is written over what it was made from, and paths
/// that cannot be written down (another drive, no UTF-8).
pub fn store(sources: &[Source], cache: &Path) -> Vec<Stored> {
    let cache = sources::whole(cache);
    let folder = cache.parent().unwrap_or(Path::new(""));
    let stored = |source: &Source| {
        let Source { kind, bytes, modified, changed, .. } = *source;
        let path = relative(folder, &source.path)?;
        Some(Stored { path, kind, bytes, modified, changed, hash: source.hash.clone() })
    };
    sources.iter().filter(|source| source.path != cache).filter_map(stored).collect()
}

/// The way from a folder to a file, both without links.
fn relative(folder: &Path, file: &Path) -> Option<String> {
    let (from, to): (Vec<_>, Vec<_>) = (folder.components().collect(), file.components().collect());
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return None;
    }
    let up = std::iter::repeat_n(Some(".."), from.len() - shared);
    let down = to[shared..].iter().map(|part| part.as_os_str().to_str());
    // A folder may be that of the cache itself.
    let way = up.chain(down).collect::<Option<Vec<&str>>>()?.join("/");
    Some(if way.is_empty() { ".".into() } else { way })
}

/// The sources of a cache in `folder`; `None` if one of them does not lie where [`store`] would have found it.
pub fn restore(stored: Vec<Stored>, folder: &Path) -> Option<Vec<Source>> {
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
        Some(Source { path: place, kind, bytes, modified, changed, hash })
    };
    stored.into_iter().map(restored).collect()
}

/// The first source that is no longer what it was, and what happened to it. Where none of the files is there, nothing can be
/// told, and the cache stands for itself.
pub fn changed(sources: &[Source]) -> Option<(&Path, &'static str)> {
    let here = |source: &&Source| matches!(source.kind, Kind::File | Kind::Folder) && source.path.exists();
    let alone = sources.iter().find(here).is_none();
    let fate = |source: &Source| match (source.kind, source.path.exists()) {
        (Kind::Absent, true) if !alone => Some("is there now"),
        (Kind::Absent, _) => None,
        (Kind::Cache, false) => None,
        (_, false) => (!alone).then_some("is gone"),
        (Kind::File, true) => (!is_same_file(source)).then_some("has changed"),
        (Kind::Folder, true) => (!is_same_folder(source)).then_some("has other files"),
        (Kind::Cache, true) => (content(&source.path).as_ref() != Some(&source.hash)).then_some("has changed"),
    };
    sources.iter().find_map(|source| Some((source.path.as_path(), fate(source)?)))
}

/// A file of the same length and times is taken for the same; one of another time is hashed: copies and checkouts change
/// the time of modification alone, renaming and other permissions the system's alone.
fn is_same_file(source: &Source) -> bool {
    let Ok(metadata) = std::fs::metadata(&source.path) else { return false };
    if !metadata.is_file() || metadata.len() != source.bytes {
        return false;
    }
    let untouched = source.modified.is_some()
        && source.modified == sources::modified(&metadata)
        && source.changed == sources::changed(&metadata);
    untouched || hash(&source.path).is_some_and(|hash| hash == source.hash)
}

fn is_same_folder(source: &Source) -> bool {
    load::files_of_folder(&source.path).is_ok_and(|files| sources::names_hash(&files) == source.hash)
}

fn hash(path: &Path) -> Option<String> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(File::open(path).ok()?).ok()?;
    Some(hasher.finalize().to_hex().to_string())
}

/// What the cache at `path` says of the scene in it.
fn content(path: &Path) -> Option<String> {
    let mut header = Header::zeroed();
    if !std::fs::metadata(path).ok()?.is_file() {
        return None;
    }
    File::open(path).ok()?.read_exact(bytemuck::bytes_of_mut(&mut header)).ok()?;
    Some(hexadecimal(&header))
}

/// The hash of a cache's scene, as a [`Source`] has it.
pub fn hexadecimal(header: &Header) -> String {
    header.content.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Where a cache's sources are counted from.
pub fn folder_of(cache: &Path) -> PathBuf {
    sources::whole(cache).parent().map(Path::to_owned).unwrap_or_default()
}
