//! Pictures inside an HTML page.

use super::html::escape;
use crate::error::{Error, Result};
use crate::guard;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::collections::BTreeMap;
use std::path::Path;

/// The first bytes of every PNG.
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
/// Larger pictures are left out, so that the page can still be sent.
const MAX_BYTES: usize = 4 << 20;

/// PNG files by their name without `.png`.
#[derive(Default)]
pub struct Pictures {
    files: BTreeMap<String, Vec<u8>>,
}

impl Pictures {
    /// Reads every PNG of a folder, which need not exist. Of two of the same name the later one is kept.
    ///
    /// # Errors
    /// [`Error::Input`]: a folder or a file cannot be read, or is no PNG.
    pub fn read(&mut self, folder: &Path) -> Result<()> {
        if !folder.is_dir() {
            return Ok(());
        }
        let failed = |path: &Path, e: std::io::Error| Error::file(path, None, format!("cannot read: {e}"), "");
        for entry in std::fs::read_dir(folder).map_err(|e| failed(folder, e))? {
            let path = entry.map_err(|e| failed(folder, e))?.path();
            let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
            let (true, Some(name)) = (path.extension().is_some_and(|e| e == "png"), name) else { continue };
            guard::read(&path);
            let bytes = std::fs::read(&path).map_err(|e| failed(&path, e))?;
            if !bytes.starts_with(SIGNATURE) {
                return Err(Error::file(&path, None, "no PNG", "remove it, or render it again"));
            }
            self.files.insert(name, bytes);
        }
        Ok(())
    }

    /// Removes pictures that are too large for a page, and returns their names.
    pub fn remove_large(&mut self) -> Vec<String> {
        let large = self.files.extract_if(.., |_, bytes| bytes.len() > MAX_BYTES);
        large.map(|(name, _)| name).collect()
    }

    /// The names, sorted.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// A picture as an element with its caption; nothing if there is no such picture.
    pub fn figure(&self, name: &str, title: &str, caption: &str) -> String {
        let Some(bytes) = self.files.get(name) else { return String::new() };
        format!(
            "<figure><img alt=\"{}\" src=\"data:image/png;base64,{}\"><figcaption>{caption}</figcaption></figure>\n",
            escape(&format!("{title}, {caption}")),
            STANDARD.encode(bytes)
        )
    }
}
