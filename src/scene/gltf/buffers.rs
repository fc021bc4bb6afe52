//! Loads the buffers, which hold the bytes of accessors.

use super::Problem;
use crate::scene::Options;
use crate::scene::text::SceneFolders;
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
    /// Index into `contents` for each buffer of the document.
    buffers: Vec<usize>,
    /// The bytes of buffers; buffers with the same file share an entry.
    contents: Vec<Cow<'a, [u8]>>,
    /// Size of all external files in bytes.
    external_bytes: usize,
}

impl<'a> Buffers<'a> {
    /// Loads all buffers: from the GLB itself, from data URIs, and from files in the scene's folder (outside of it only
    /// with the option `outside`).
    pub fn load(path: &Path, document: &Document, blob: Option<&'a [u8]>, options: &Options) -> Result<Self, Problem> {
        let mut all = Buffers { buffers: Vec::new(), contents: Vec::new(), external_bytes: 0 };
        let mut files: HashMap<PathBuf, usize> = HashMap::new();
        let folders = LazyCell::new(|| SceneFolders::of(path));
        for buffer in document.buffers() {
            let content = match buffer.source() {
                Source::Bin => match blob {
                    Some(blob) => all.add(blob.into()),
                    None => return Err(("the file has no binary chunk, but needs one".into(), "export it again")),
                },
                Source::Uri(uri) => match uri.strip_prefix("data:") {
                    Some(data) => all.add(decode(data)?.into()),
                    None => {
                        let (shown, file) = place(path, uri, options, &folders)?;
                        match files.get(&file) {
                            Some(&content) => content,
                            None => {
                                let content = all.add(read(&shown, &file)?.into());
                                all.external_bytes += all.contents[content].len();
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

    /// The bytes of a buffer view.
    pub fn view(&self, view: &View) -> Result<&[u8], Problem> {
        let bytes = &self.contents[self.buffers[view.buffer().index()]];
        let end = view.offset().checked_add(view.length());
        end.and_then(|end| bytes.get(view.offset()..end))
            .ok_or_else(|| (format!("buffer view {} reaches beyond its buffer", view.index()), "export the file again"))
    }

    /// Size of all buffers in bytes; each file is counted once.
    pub fn total(&self) -> usize {
        self.contents.iter().map(|bytes| bytes.len()).sum()
    }

    /// Size of all external files in bytes.
    pub fn external_bytes(&self) -> usize {
        self.external_bytes
    }
}

/// Decodes the part of a data URI after `data:`.
fn decode(data: &str) -> Result<Vec<u8>, Problem> {
    const HINT: &str = "buffers in URIs must be base64";
    let Some((_, text)) = data.split_once(";base64,") else {
        return Err(("a buffer's data URI is not base64".into(), HINT));
    };
    // Many exporters omit the padding.
    let config = GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
    GeneralPurpose::new(&base64::alphabet::STANDARD, config)
        .decode(text)
        .map_err(|e| (format!("a buffer's data URI is broken: {e}"), HINT))
}

/// Resolves the URI of an external file: its name for messages, and its path.
fn place(path: &Path, uri: &str, options: &Options, folders: &SceneFolders) -> Result<(String, PathBuf), Problem> {
    let name = percent_encoding::percent_decode_str(uri).decode_utf8_lossy();
    let shown: String = name.chars().filter(|c| !c.is_control()).take(80).collect();
    if name.contains("://") {
        return Err((format!("buffer {shown} is a web address"), "download it, and name the file in the scene"));
    }
    let leaves = Path::new(&*name).components().any(|c| !matches!(c, Component::Normal(_) | Component::CurDir));
    let file = path.parent().unwrap_or(Path::new("")).join(&*name);
    if !options.outside && (leaves || !folders.contain(&file)) {
        let problem = format!("buffer {shown} lies outside of the scene's folder");
        return Err((problem, "allow it with the option outside=yes"));
    }
    let file = file.canonicalize().unwrap_or(file);
    Ok((shown, file))
}

/// Reads an external file; `shown` is its name for messages.
fn read(shown: &str, file: &Path) -> Result<Vec<u8>, Problem> {
    let content = crate::scene::read_file(file);
    content.map_err(|_| {
        (format!("buffer {shown} cannot be read: {}", reason(file)), "put it into the folder of the scene's file")
    })
}

/// The reason why a file could not be read, without its path, which may contain line ends.
fn reason(file: &Path) -> String {
    match file.metadata() {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => "no such file".into(),
        Err(e) => e.to_string(),
        Ok(metadata) if !metadata.is_file() => "not a regular file".into(),
        Ok(_) => std::fs::File::open(file).err().map_or_else(|| "it was changed meanwhile".into(), |e| e.to_string()),
    }
}
