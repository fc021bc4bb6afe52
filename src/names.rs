//! File names as text, and the names that records and output files derive from them.
//!
//! Names travel through command lines, presets, journals and tables as text. A file name that is not UTF-8 is written
//! with `%XX` for each byte that is none, and read back to the same bytes.

use std::ffi::{OsStr, OsString};
use std::fmt::Write;
use std::path::{Component, Path, PathBuf};

/// Digits of a hash in a name: 24 bits.
const HASH_DIGITS: usize = 6;

/// Longest part of a file's name that is derived from a name, in characters. File systems end names at 255 bytes, and
/// four bytes are the longest character.
const MAX_SLUG: usize = 48;

/// A file name as text: UTF-8 as it is, `%XX` (two capital hexadecimal digits, 80 to FF) for each other byte, and `%25`
/// for a percent sign that could be taken for one of these. [`file`] is the inverse.
pub fn text(name: &OsStr) -> String {
    let mut text = String::new();
    for chunk in name.as_encoded_bytes().utf8_chunks() {
        for (at, c) in chunk.valid().char_indices() {
            match c {
                '%' if escaped(&chunk.valid().as_bytes()[at..]).is_some() => text.push_str("%25"),
                _ => text.push(c),
            }
        }
        for byte in chunk.invalid() {
            write!(text, "%{byte:02X}").expect("a String takes all text");
        }
    }
    text
}

/// The path of a text that [`text`] made. On systems whose file names are not bytes, escapes of bytes are kept
/// as they are.
pub fn file(text: &str) -> PathBuf {
    let bytes = text.as_bytes();
    let (mut name, mut at) = (Vec::with_capacity(bytes.len()), 0);
    while at < bytes.len() {
        let (byte, length) = match escaped(&bytes[at..]) {
            Some(byte) => (byte, 3),
            None => (bytes[at], 1),
        };
        name.push(byte);
        at += length;
    }
    PathBuf::from(os_string(name, text))
}

#[cfg(unix)]
fn os_string(bytes: Vec<u8>, _: &str) -> OsString {
    std::os::unix::ffi::OsStringExt::from_vec(bytes)
}

#[cfg(not(unix))]
fn os_string(bytes: Vec<u8>, text: &str) -> OsString {
    String::from_utf8(bytes).map_or_else(|_| text.into(), OsString::from)
}

/// The byte of an escape at the beginning of some bytes.
fn escaped(bytes: &[u8]) -> Option<u8> {
    let [b'%', high, low, ..] = *bytes else { return None };
    let digit = |c: u8| match c {
        b'0'..=b'9' => Some(c - b'0'),
        b'A'..=b'F' => Some(c - b'A' + 10),
        _ => None,
    };
    let byte = digit(high)? << 4 | digit(low)?;
    (byte == b'%' || byte >= 0x80).then_some(byte)
}

/// The name of the scene in a file or folder, from its path alone, so that it does not depend on what else a run
/// measures: `FILE` or `FOLDER/FILE` for a relative path of at most one folder, and otherwise `FOLDER/FILE~HASH` with
/// six digits of the hash of the whole path as it was given.
pub fn of_file(path: &Path) -> String {
    let parts: Vec<Component> = path.components().filter(|part| *part != Component::CurDir).collect();
    let names: Vec<String> = parts.iter().map(|part| text(part.as_os_str())).collect();
    let plain = parts.iter().all(|part| matches!(part, Component::Normal(_)));
    match names.as_slice() {
        [] => "scene".into(),
        [.., folder, file] if !plain || names.len() > 2 => {
            let whole = parts.iter().collect::<PathBuf>();
            let folder = if matches!(parts[parts.len() - 2], Component::Normal(_)) { folder } else { "" };
            let separator = if folder.is_empty() { "" } else { "/" };
            format!("{folder}{separator}{file}~{}", hash(whole.as_os_str().as_encoded_bytes()))
        }
        names => names.join("/"),
    }
}

/// The stem of the file in a scene's name, or the whole name of a scene that is no file: `bunny` for `bunny`,
/// `bunny.ply`, `scans/bunny.ply` and `scans/bunny.ply~a1b2c3`, each with or without `:key=value,...` behind it.
pub fn stem(name: &str) -> &str {
    let bare = name.split(':').next().unwrap_or(name);
    let whole = bare.rsplit_once('~').filter(|(_, hash)| hash.len() == HASH_DIGITS).map_or(bare, |(whole, _)| whole);
    let file = whole.rsplit('/').next().unwrap_or(whole);
    match file.rsplit_once('.') {
        Some((stem, extension)) if !stem.is_empty() && !extension.contains(' ') => stem,
        _ => file,
    }
}

/// A name as a part of a file's name: letters, digits, dots and single dashes. Different names may give the same one.
pub fn slug(name: &str) -> String {
    let mut slug = String::new();
    for c in name.chars() {
        if c.is_alphanumeric() || c == '.' {
            slug.extend(c.to_lowercase());
        } else if !slug.ends_with('-') {
            slug.push('-');
        }
    }
    slug.trim_matches(['-', '.']).chars().take(80).collect()
}

/// Like [`slug`], and different for different names: what the slug does not keep (case, other characters, the end of a
/// long name) decides six digits of a hash at its end.
pub fn distinct_slug(name: &str) -> String {
    let slug = slug(name);
    if slug == name && slug.len() <= MAX_SLUG {
        return slug;
    }
    let kept: String = slug.chars().take(MAX_SLUG).collect();
    format!("{}-{}", kept.trim_end_matches(['-', '.']), hash(name.as_bytes()))
}

fn hash(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex()[..HASH_DIGITS].to_owned()
}
