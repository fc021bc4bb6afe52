//! Loads buffers, which hold the bytes of accessors, when they are first used.

use super::json::{List, Whole};
use super::schema::{Buffer, Uri, View};
use super::{extensions, shown};
use crate::scene::Options;
use crate::scene::mesh_builder::Limits;
use crate::scene::text::{Fault, SceneFolders};
use base64::Engine;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use foldhash::fast::RandomState;
use std::collections::HashMap;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};
use std::rc::Rc;

/// The bytes of a buffer.
#[derive(Clone)]
pub enum Content<'a> {
    /// The binary chunk of a GLB.
    Chunk(&'a [u8]),
    /// A file, or a decoded URI.
    Owned(Rc<Vec<u8>>),
}

impl Content<'_> {
    pub fn bytes(&self) -> &[u8] {
        match self {
            Content::Chunk(bytes) => bytes,
            Content::Owned(bytes) => bytes,
        }
    }
}

/// A buffer view: a range of the bytes of a buffer.
#[derive(Clone)]
pub struct Bytes<'a> {
    content: Content<'a>,
    range: Range<usize>,
    /// Distance of elements in bytes, if it is not their size.
    pub stride: Option<usize>,
}

impl Bytes<'_> {
    pub fn bytes(&self) -> &[u8] {
        &self.content.bytes()[self.range.clone()]
    }
}

/// The buffers and buffer views of a file.
pub struct Buffers<'a> {
    path: &'a Path,
    options: &'a Options,
    blob: Option<&'a [u8]>,
    views: List<'a>,
    buffers: List<'a>,
    known_views: HashMap<usize, Bytes<'a>, RandomState>,
    contents: HashMap<usize, Content<'a>, RandomState>,
    files: HashMap<PathBuf, Content<'a>>,
    folders: Option<SceneFolders>,
    /// Size of the file and of all buffers' files in bytes.
    pub file_bytes: usize,
}

/// Memory of an entry of a table in bytes, while the table grows.
const PER_ENTRY: usize = 3 * (size_of::<usize>() + size_of::<Bytes>());

impl<'a> Buffers<'a> {
    pub fn new(
        (path, bytes): (&'a Path, &[u8]),
        options: &'a Options,
        blob: Option<&'a [u8]>,
        views: List<'a>,
        buffers: List<'a>,
    ) -> Buffers<'a> {
        Buffers {
            path,
            options,
            blob,
            views,
            buffers,
            known_views: HashMap::default(),
            contents: HashMap::default(),
            files: HashMap::new(),
            folders: None,
            file_bytes: bytes.len(),
        }
    }

    /// The bytes of a buffer view, which `from` names. Loading a buffer raises the limits by the size of its file.
    ///
    /// # Errors
    /// The view does not exist or reaches beyond its buffer, or the buffer cannot be loaded.
    pub fn view(&mut self, index: usize, from: &str, limits: &mut Limits) -> Result<Bytes<'a>, Fault> {
        if let Some(known) = self.known_views.get(&index) {
            return Ok(known.clone());
        }
        let view: View = self.views.get(index, from)?;
        let compressed = view.extensions.given().is_some_and(|e| e.is_meshopt());
        let content = match self.content(view.buffer.0, &format!("bufferViews[{index}]"), limits) {
            // The buffer of compressed views may have no bytes.
            Err(fault) if compressed => {
                let problem = format!("buffer view {index} is compressed (meshopt), which is not supported");
                return Err(Fault::new(fault.line, problem, extensions::UNPACK));
            }
            content => content?,
        };
        let start = view.byte_offset.unwrap_or_default().0;
        let end = start.checked_add(view.byte_length.0).filter(|&end| end <= content.bytes().len());
        let Some(end) = end else {
            let problem = format!("buffer view {index} reaches beyond its buffer");
            return Err(Fault::new(None, problem, "export the file again"));
        };
        limits.keep(PER_ENTRY)?;
        let stride = view.byte_stride.map(|Whole(stride)| stride).filter(|&stride| stride > 0);
        let bytes = Bytes { content, range: start..end, stride };
        self.known_views.insert(index, bytes.clone());
        Ok(bytes)
    }

    /// The bytes of a buffer: of the GLB itself, of a data URI, or of a file in the scene's folder (outside of it only
    /// with the option `outside`).
    fn content(&mut self, index: usize, from: &str, limits: &mut Limits) -> Result<Content<'a>, Fault> {
        if let Some(known) = self.contents.get(&index) {
            return Ok(known.clone());
        }
        let buffer: Buffer = self.buffers.get(index, from)?;
        // Views of compressed data have a buffer for what they give, which has no bytes.
        let has_bytes = !buffer.extensions.given().is_some_and(|e| e.is_meshopt());
        let content = match (buffer.uri, self.blob) {
            (None, Some(blob)) if has_bytes => Content::Chunk(blob),
            (None, _) => {
                let problem = format!("buffer {index} has neither a uri nor a binary chunk");
                return Err(Fault::new(None, problem, "export the file again"));
            }
            (Some(Uri(uri)), _) => match uri.strip_prefix("data:") {
                Some(data) => {
                    limits.keep(2 * data.len())?;
                    Content::Owned(Rc::new(decode(data)?))
                }
                None => self.file(&uri, limits)?,
            },
        };
        let (has, wants) = (content.bytes().len(), buffer.byte_length.unwrap_or_default().0);
        if has < wants {
            let problem = format!("buffer {index} is truncated: it has {has} bytes of {wants}");
            return Err(Fault::new(None, problem, "copy the whole file"));
        }
        limits.keep(PER_ENTRY)?;
        self.contents.insert(index, content.clone());
        Ok(content)
    }

    /// The content of an external file, which is read once.
    fn file(&mut self, uri: &str, limits: &mut Limits) -> Result<Content<'a>, Fault> {
        let name = percent_encoding::percent_decode_str(uri).decode_utf8_lossy();
        let label = shown(&name, 80);
        if name.contains("://") {
            let problem = format!("buffer {label} is a web address");
            return Err(Fault::new(None, problem, "download it, and name the file in the scene"));
        }
        let folder = self.path.parent().unwrap_or(Path::new(""));
        // Some exporters write the path as Windows does.
        let windows = name.contains('\\') && !folder.join(&*name).exists();
        let name = if windows { name.replace('\\', "/").into() } else { name };
        let name = without_parents(Path::new(&*name));
        let leaves = name.components().any(|c| !matches!(c, Component::Normal(_)));
        let file = folder.join(&name);
        let folders = self.folders.get_or_insert_with(|| SceneFolders::of(self.path));
        if !self.options.outside && (leaves || !folders.contain(&file)) {
            let problem = format!("buffer {label} lies outside of the scene's folder");
            return Err(Fault::new(None, problem, "allow it with the option outside=yes"));
        }
        let file = file.canonicalize().unwrap_or(file);
        if let Some(known) = self.files.get(&file) {
            return Ok(known.clone());
        }
        let bytes = crate::scene::read_file(&file).map_err(|_| {
            let problem = format!("buffer {label} cannot be read: {}", reason(&file));
            Fault::new(None, problem, "put it into the folder of the scene's file")
        })?;
        limits.read(bytes.len());
        self.file_bytes += bytes.len();
        let content = Content::Owned(Rc::new(bytes));
        self.files.insert(file, content.clone());
        Ok(content)
    }
}

/// A path without the folders that `..` leaves again, which need not exist.
fn without_parents(path: &Path) -> PathBuf {
    let mut whole = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir if matches!(whole.components().next_back(), Some(Component::Normal(_))) => {
                whole.pop();
            }
            other => whole.push(other),
        }
    }
    whole
}

/// Decodes the part of a data URI after `data:`.
fn decode(data: &str) -> Result<Vec<u8>, Fault> {
    const HINT: &str = "buffers in URIs must be base64";
    let Some((_, text)) = data.split_once(";base64,") else {
        return Err(Fault::new(None, "a buffer's data URI is not base64", HINT));
    };
    // Many exporters omit the padding.
    let config = GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
    let engine = GeneralPurpose::new(&base64::alphabet::STANDARD, config);
    let without_escapes = |_| {
        let bytes = percent_encoding::percent_decode_str(text).filter(|b| !b.is_ascii_whitespace());
        engine.decode(bytes.collect::<Vec<u8>>())
    };
    engine
        .decode(text)
        .or_else(without_escapes)
        .map_err(|e| Fault::new(None, format!("a buffer's data URI is broken: {e}"), HINT))
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
