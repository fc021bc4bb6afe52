//! Splits a GLB into its chunks, and decodes the JSON's characters.

use super::shown;
use crate::scene::text::Fault;
use std::borrow::Cow;

/// Size of the header of a GLB in bytes, and of a chunk.
const HEADER: usize = 12;
const CHUNK: usize = 8;

/// The JSON, and the binary chunk of a GLB. Other chunks are passed over, wherever they are.
///
/// # Errors
/// The GLB is truncated, has another version, or has no JSON.
pub fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Fault> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes, None));
    }
    let cut = |problem: String| Fault::new(None, problem, "copy the whole file");
    let word = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let (Some(version), Some(length)) = (word(4), word(8)) else {
        return Err(cut("the file is truncated within its header".into()));
    };
    if version != 2 {
        let problem = format!("this is a GLB of version {version}, only 2 is supported");
        return Err(Fault::new(None, problem, "export it as glTF 2.0"));
    }
    let length = length as usize;
    if length < HEADER {
        let problem = format!("this is not a GLB: its header gives the length {length}");
        return Err(Fault::new(None, problem, "export it again"));
    }
    if length > bytes.len() {
        return Err(cut(format!("the file is truncated: it has {} bytes of {length}", bytes.len())));
    }
    let (mut json, mut blob) = (None, None);
    let mut rest = &bytes[HEADER..length];
    // What is shorter than the header of a chunk is padding.
    while let Some((head, behind)) = rest.split_at_checked(CHUNK) {
        let size = u32::from_le_bytes([head[0], head[1], head[2], head[3]]) as usize;
        let Some((content, next)) = behind.split_at_checked(size) else {
            let problem = format!("a chunk of the GLB has {size} bytes, but only {} follow", behind.len());
            return Err(Fault::new(None, problem, "export the file again"));
        };
        match &head[4..] {
            b"JSON" => json = json.or(Some(content.strip_prefix("\u{feff}".as_bytes()).unwrap_or(content))),
            b"BIN\0" => blob = blob.or(Some(content)),
            _ => {}
        }
        rest = next;
    }
    match json {
        Some(json) => Ok((json, blob)),
        None => Err(Fault::new(None, "the GLB has no JSON chunk", "export the file again")),
    }
}

/// The characters of the JSON. Bytes that are not UTF-8 are replaced: they are in names, or they are found later.
///
/// # Errors
/// The JSON is UTF-16, with a byte order mark or without.
pub fn characters(json: &[u8]) -> Result<Cow<'_, str>, Fault> {
    if matches!(json, [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [0, 1..=255, ..] | [1..=255, 0, ..]) {
        return Err(Fault::new(None, "the JSON is encoded as UTF-16", "save the file as UTF-8"));
    }
    // Some exporters fill the chunk with zeros instead of spaces.
    let end = json.iter().rposition(|&b| b != 0).map_or(0, |last| last + 1);
    Ok(String::from_utf8_lossy(&json[..end]))
}

/// The JSON with `null` in place of numbers that JSON does not have, such as NaN in bounds; `None` if it has none.
/// Lines keep their numbers.
pub fn without_nan(text: &str) -> Option<String> {
    const NONE: [&str; 6] = ["-Infinity", "Infinity", "-NaN", "NaN", "-nan", "nan"];
    let (mut result, mut kept, mut at) = (String::new(), 0, 0);
    let bytes = text.as_bytes();
    while at < bytes.len() {
        match bytes[at] {
            b'"' => {
                at += 1;
                while at < bytes.len() && bytes[at] != b'"' {
                    at += if bytes[at] == b'\\' { 2 } else { 1 };
                }
                at += 1;
            }
            b'-' | b'I' | b'N' | b'n' => match NONE.iter().find(|none| bytes[at..].starts_with(none.as_bytes())) {
                Some(none) => {
                    result += &text[kept..at];
                    result += "null";
                    at += none.len();
                    kept = at;
                }
                None => at += 1,
            },
            _ => at += 1,
        }
    }
    (kept > 0).then(|| result + &text[kept..])
}

/// Checks the version, and returns the warning for a later minor version, which is compatible. `least` is the version
/// that a reader needs at least.
///
/// # Errors
/// The major version is not 2, or a reader needs more than 2.0.
pub fn check_version(version: Option<&str>, least: Option<&str>) -> Result<Option<String>, Fault> {
    /// The largest supported minor version of glTF 2.
    const MINOR: u32 = 0;
    const HINT: &str = "export it as glTF 2.0";
    let minor = |text: &str| {
        let (major, minor) = text.split_once('.').unwrap_or((text, "0"));
        let digits = [major, minor].iter().all(|part| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit()));
        (digits && major == "2").then(|| minor.parse().unwrap_or(u32::MAX))
    };
    let Some(version) = version else {
        return Err(Fault::new(None, "the JSON is not glTF: it has no asset.version", HINT));
    };
    let Some(later) = minor(version).map(|minor| minor > MINOR) else {
        let problem = format!("this is glTF of version {}, only 2.0 is supported", shown(version, 20));
        return Err(Fault::new(None, problem, HINT));
    };
    match least.filter(|least| minor(least).is_none_or(|minor| minor > MINOR)) {
        Some(least) => {
            let problem = format!("the file needs a reader of glTF {}, only 2.0 is supported", shown(least, 20));
            Err(Fault::new(None, problem, HINT))
        }
        None => Ok(later.then(|| format!("glTF of version {}: read as 2.0", shown(version, 20)))),
    }
}
