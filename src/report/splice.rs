//! Parts of a document that a command keeps up to date: the text between `<!-- rtbench:NAME -->` and
//! `<!-- /rtbench:NAME -->`.

use crate::error::{Error, Result};
use std::path::Path;

/// A part: its name and its new text.
pub type Block = (String, String);

/// Which blocks must have a place in the document.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Every block.
    All,
    /// At least one block.
    Any,
}

/// Puts the blocks in their places. Everything outside stays as it is, to the byte; everything inside is replaced, so
/// that doing it twice changes nothing.
///
/// # Errors
/// [`Error::Input`] with file and line: a marker without its other half, or no place for a block.
pub fn splice(path: &Path, text: &str, blocks: &[Block], need: Need) -> Result<String> {
    let newline = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let mut out = String::with_capacity(text.len());
    let mut open: Option<(&str, usize)> = None;
    let mut placed = vec![false; blocks.len()];
    for (index, line) in text.split_inclusive('\n').enumerate() {
        let number = index + 1;
        let wrong = |problem: String| Error::file(path, Some(number), problem, "markers come in pairs, one a line");
        match (marker(line), open) {
            (Some((false, name)), Some((other, _))) => {
                return Err(wrong(format!("'{name}' begins before '{other}' ends")));
            }
            (Some((true, name)), Some((begun, _))) if name == begun => {
                open = None;
                out += line;
            }
            (Some((true, name)), _) => return Err(wrong(format!("'{name}' ends and has not begun"))),
            (Some((false, name)), None) => {
                out += line;
                open = Some((name, number));
                if let Some(block) = blocks.iter().position(|(wanted, _)| wanted == name) {
                    placed[block] = true;
                    let content = blocks[block].1.trim_end().replace('\n', newline);
                    out += &format!("{newline}{content}{newline}{newline}");
                }
            }
            (None, Some((name, _))) if blocks.iter().any(|(wanted, _)| wanted == name) => {}
            (None, _) => out += line,
        }
    }
    if let Some((name, number)) = open {
        return Err(Error::file(path, Some(number), format!("'{name}' begins and does not end"), end_of(name)));
    }
    let missing: Vec<&str> =
        blocks.iter().zip(&placed).filter(|(_, p)| !**p).map(|((name, _), _)| name.as_str()).collect();
    let (Some(first), false) = (missing.first(), need == Need::Any && missing.len() < blocks.len()) else {
        return Ok(out);
    };
    let hint = format!("put <!-- rtbench:{first} --> and {} at its place, each on a line", end_of(first));
    Err(Error::file(path, None, format!("no place for {}", missing.join(", ")), hint))
}

fn end_of(name: &str) -> String {
    format!("<!-- /rtbench:{name} -->")
}

/// Reads a line that is a marker: whether it ends a part, and the name of the part.
fn marker(line: &str) -> Option<(bool, &str)> {
    let inside = line.trim().strip_prefix("<!--")?.strip_suffix("-->")?.trim();
    let (ends, name) = match inside.strip_prefix('/') {
        Some(rest) => (true, rest.strip_prefix("rtbench:")?),
        None => (false, inside.strip_prefix("rtbench:")?),
    };
    Some((ends, name.trim()))
}
