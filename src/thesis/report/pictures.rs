//! Pictures of scenes and their steps, from the runs' folders, inside the page.

use super::html::escape;
use crate::error::{Error, Result};
use crate::record::picture::{FOLDER, STEPS};
use crate::thesis::runs::RecordedRun;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// What a step map shows: a sweep renders all of them with the same structure, whatever it measures.
const STEPS_IN_WORDS: &str = "steps of bvh-stack (one ray per thread) per pixel, all ray types: the brighter, the more";
/// What every PNG begins with.
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
/// Larger ones are left out and named: a page has to stay one that can be sent.
const MAX_BYTES: usize = 4 << 20;

/// All pictures; of several runs' pictures of a scene the last.
///
/// # Errors
/// [`Error::Input`]: a folder or a file that is there and cannot be read.
pub fn write(runs: &[RecordedRun]) -> Result<String> {
    let mut found: BTreeMap<String, Vec<u8>> = BTreeMap::new();
    for run in runs {
        collect(&run.folder.join(FOLDER), &mut found)?;
    }
    let mut notes = String::new();
    found.retain(|name, bytes| {
        let fits = bytes.len() <= MAX_BYTES;
        if !fits {
            notes += &format!("<p class=\"note\">{} is left out: larger than 4 MiB.</p>\n", escape(name));
        }
        fits
    });
    if found.is_empty() {
        return Ok(format!("<p class=\"note\">The runs' folders have no pictures.</p>\n{notes}"));
    }
    // Sorted by the scene's whole name: `conference-obj` stands between `conference` and `conference-steps`
    let scenes: BTreeSet<&str> = found.keys().map(|name| name.strip_suffix(STEPS).unwrap_or(name)).collect();
    let mut html = String::new();
    for scene in scenes {
        html += &format!("<h3>{}</h3>\n<div class=\"pair\">\n", escape(scene));
        for (name, what) in [(scene.to_owned(), "picture"), (format!("{scene}{STEPS}"), STEPS_IN_WORDS)] {
            if let Some(bytes) = found.get(&name) {
                html += &format!(
                    "<figure><img alt=\"{}\" src=\"data:image/png;base64,{}\"><figcaption>{what}</figcaption></figure>\n",
                    escape(&format!("{scene}, {what}")),
                    STANDARD.encode(bytes)
                );
            }
        }
        html += "</div>\n";
    }
    Ok(html + &notes)
}

/// Reads every PNG of a folder; there may be none.
fn collect(folder: &Path, found: &mut BTreeMap<String, Vec<u8>>) -> Result<()> {
    if !folder.is_dir() {
        return Ok(());
    }
    let failed = |path: &Path, e: std::io::Error| Error::file(path, None, format!("cannot read: {e}"), "");
    for entry in std::fs::read_dir(folder).map_err(|e| failed(folder, e))? {
        let path = entry.map_err(|e| failed(folder, e))?.path();
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let (true, Some(name)) = (path.extension().is_some_and(|e| e == "png"), name) else { continue };
        let bytes = std::fs::read(&path).map_err(|e| failed(&path, e))?;
        if !bytes.starts_with(SIGNATURE) {
            return Err(Error::file(&path, None, "no PNG", "remove it, or render it again"));
        }
        found.insert(name, bytes);
    }
    Ok(())
}
