//! Buffers: the bytes that accessors look into.

use super::Fault;
use crate::scene::Options;
use crate::scene::text::Home;
use base64::Engine;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::Document;
use gltf::buffer::{Source, View};
use std::borrow::Cow;
use std::cell::LazyCell;
use std::collections::HashMap;
use std::path::{Component, Path, PathBuf};

/// All buffers of a file.
pub struct Buffers<'a> {
    /// By their index in the document, which of the contents they have.
    buffers: Vec<usize>,
    /// Each file once, however many buffers name it.
    contents: Vec<Cow<'a, [u8]>>,
    /// Bytes of files.
    beside: usize,
}

impl<'a> Buffers<'a> {
    /// Loads them: from the GLB itself, from data URIs, from files inside the scene's folder (elsewhere only if the option
    /// `outside` allows it).
    pub fn load(path: &Path, document: &Document, blob: Option<&'a [u8]>, options: &Options) -> Result<Self, Fault> {
        let mut all = Buffers { buffers: Vec::new(), contents: Vec::new(), beside: 0 };
        let mut files: HashMap<PathBuf, usize> = HashMap::new();
        let home = LazyCell::new(|| Home::of(path));
        for buffer in document.buffers() {
            let content = match buffer.source() {
                Source::Bin => match blob {
                    Some(blob) => all.add(blob.into()),
                    None => return Err(("the file has no binary chunk, but needs one".into(), "export it again")),
                },
                Source::Uri(uri) => match uri.strip_prefix("data:") {
                    Some(data) => all.add(decode(data)?.into()),
                    None => {
                        let (shown, file) = place(path, uri, options, &home)?;
                        match files.get(&file) {
                            Some(&content) => content,
                            None => {
                                let content = all.add(read(&shown, &file)?.into());
                                all.beside += all.contents[content].len();
                                files.insert(file, content);
                                content
                            }
                        }
                    }
                },
            };
            let bytes = &all.contents[content];
            if bytes.len() < buffer.length() {
                let (index, has, wants) = (buffer.index(), bytes.len(), buffer.length());
                let problem = format!("buffer {index} is truncated: it has {has} bytes of {wants}");
                return Err((problem, "copy the whole file"));
            }
            all.buffers.push(content);
        }
        Ok(all)
    }

    fn add(&mut self, content: Cow<'a, [u8]>) -> usize {
        self.contents.push(content);
        self.contents.len() - 1
    }

    /// The bytes of a view.
    pub fn view(&self, view: &View) -> Result<&[u8], Fault> {
        let bytes = &self.contents[self.buffers[view.buffer().index()]];
        let end = view.offset().checked_add(view.length());
        end.and_then(|end| bytes.get(view.offset()..end))
            .ok_or_else(|| (format!("buffer view {} reaches beyond its buffer", view.index()), "export the file again"))
    }

    /// Bytes of all buffers, each file counted once.
    pub fn total(&self) -> usize {
        self.contents.iter().map(|bytes| bytes.len()).sum()
    }

    /// Bytes of the files beside the scene's own.
    pub fn beside(&self) -> usize {
        self.beside
    }
}

/// A data URI behind `data:`.
fn decode(data: &str) -> Result<Vec<u8>, Fault> {
    const HINT: &str = "buffers in URIs must be base64";
    let Some((_, text)) = data.split_once(";base64,") else {
        return Err(("a buffer's data URI is not base64".into(), HINT));
    };
    // Padding is often forgotten.
    let config = GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
    GeneralPurpose::new(&base64::alphabet::STANDARD, config)
        .decode(text)
        .map_err(|e| (format!("a buffer's data URI is broken: {e}"), HINT))
}

/// A file beside the scene: its name for messages, and where it is.
fn place(path: &Path, uri: &str, options: &Options, home: &Home) -> Result<(String, PathBuf), Fault> {
    let name = percent_encoding::percent_decode_str(uri).decode_utf8_lossy();
    let shown: String = name.chars().filter(|c| !c.is_control()).take(80).collect();
    if name.contains("://") {
        return Err((format!("buffer {shown} is an address"), "download it, and name the file"));
    }
    let leaves = Path::new(&*name).components().any(|c| !matches!(c, Component::Normal(_) | Component::CurDir));
    let file = path.parent().unwrap_or(Path::new("")).join(&*name);
    if !options.outside && (leaves || !home.holds(&file)) {
        let problem = format!("buffer {shown} lies outside of the scene's folder");
        return Err((problem, "allow it with the option outside=yes"));
    }
    let file = file.canonicalize().unwrap_or(file);
    Ok((shown, file))
}

/// That file's bytes.
fn read(shown: &str, file: &Path) -> Result<Vec<u8>, Fault> {
    let content = crate::scene::read_file(file);
    content.map_err(|_| (format!("buffer {shown} cannot be read: {}", reason(file)), "put it beside the scene's file"))
}

/// Why a file could not be read, without its path, which may have line ends in it.
fn reason(file: &Path) -> String {
    match file.metadata() {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => "no such file".into(),
        Err(e) => e.to_string(),
        Ok(metadata) if !metadata.is_file() => "not a regular file".into(),
        Ok(_) => std::fs::File::open(file).err().map_or_else(|| "it has just changed".into(), |e| e.to_string()),
    }
}
