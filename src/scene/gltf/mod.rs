//! Reader of glTF 2.0 and GLB: meshes, nodes and instances, materials, punctual lights, cameras.
//!
//! The crate `gltf` parses and validates the JSON. Accessors are read by [`accessor`], because the crate's iterators
//! rely on unchecked lengths.
//!
//! The reader converts the default scene (otherwise the first, otherwise all nodes), with each mesh once per node that
//! refers to it, in the order of the nodes: triangles, strips and fans. A primitive without normals has flat shading,
//! as the format demands. The camera is the one that the option `camera=` names, by default the first perspective
//! camera. [`material`] converts materials. Punctual lights become point lights: a spot light shines in all directions,
//! and a directional light is placed ten diagonals away. Lights have no attenuation in this program, so colours are
//! scaled such that the brightest channel of their sum is 1. If there are no lights, emissive surfaces become lights
//! ([`super::lamps`]).
//!
//! Textures, vertex colours, transparency, skins, morph targets, animations, points and lines are ignored.

mod accessor;
mod buffers;
mod head;
mod locals;
mod material;
mod memory;
mod reader;

use super::mesh_builder::Limits;
use super::{Options, Scene};
use crate::error::{Error, Result};
use buffers::Buffers;
use locals::Locals;
use reader::GltfReader;
use std::path::Path;

/// An error without the file's name: problem and hint.
type Problem = (String, &'static str);

/// Reads the file and the buffers that it names.
///
/// # Errors
/// [`Error::Input`] if one of them is not valid.
pub fn read(path: &Path, options: &Options) -> Result<Scene> {
    read_bytes(path, &super::read_text(path)?, options)
}

/// Reads a file from memory; buffers are searched in the folder of `path`.
///
/// # Errors
/// As [`read`].
pub fn read_bytes(path: &Path, bytes: &[u8], options: &Options) -> Result<Scene> {
    let at = |(problem, hint): Problem| Error::file(path, None, problem, hint);
    head::check_container(bytes).map_err(at)?;
    let json = if bytes.starts_with(b"glTF") { json_chunk(bytes) } else { bytes };
    let mut limits = Limits::default();
    limits.read(bytes.len());
    document_fits(json, &mut limits).map_err(at)?;
    head::check(json).map_err(at)?;
    let locals = Locals::read(json);
    limits.keep(locals.bytes()).map_err(|fault| at(memory::too_much(fault)))?;
    let unchecked = gltf::Gltf::from_slice_without_validation(bytes).map_err(|error| refusal(path, error))?;
    let json = unchecked.document.into_json();
    positions_exist(&json).map_err(at)?;
    let document = gltf::Document::from_json(json).map_err(|error| refusal(path, error))?;
    let buffers = Buffers::load(path, &document, unchecked.blob.as_deref(), options).map_err(at)?;
    limits.read(buffers.external_bytes());
    let mut reader = GltfReader::new(&document, &buffers, limits, locals, options);
    reader.scene().map_err(at)?;
    reader.finish().map_err(at)
}

/// The content of the first chunk of a GLB.
fn json_chunk(bytes: &[u8]) -> &[u8] {
    let length = bytes.get(12..16).map_or(0, |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    let behind = bytes.get(20..).unwrap_or_default();
    &behind[..length.min(behind.len())]
}

/// Upper bound of the memory in bytes that the crate (1.4.1) needs per `{` of the JSON, while the vectors that hold the
/// objects grow. Nodes are the largest objects that can be as short as `{}`.
const PER_OBJECT: usize = 704;
/// Upper bound of the memory in bytes per quotation mark; a string has two.
const PER_MARK: usize = 36;

/// Refuses a document that needs more memory than the file may take, before the crate allocates it.
fn document_fits(json: &[u8], limits: &mut Limits) -> Result<(), Problem> {
    let count = |byte| json.iter().filter(|&&b| b == byte).count();
    let needed = count(b'{') * PER_OBJECT + count(b'"') * PER_MARK;
    limits.keep(needed).map_err(|_| {
        let problem = format!("the JSON's {} objects need {} MiB of memory", count(b'{'), needed >> 20);
        (problem, "a file may take 16 times its size and 64 MiB: export fewer nodes")
    })
}

/// Refuses primitives with positions in an accessor that does not exist: the crate's validation (1.4.1) panics on them.
fn positions_exist(json: &gltf::json::Root) -> Result<(), Problem> {
    let positions = gltf::json::validation::Checked::Valid(gltf::Semantic::Positions);
    let mut primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let beyond = |index: usize| index >= json.accessors.len();
    match primitives.find_map(|p| p.attributes.get(&positions).map(|i| i.value()).filter(|&i| beyond(i))) {
        Some(index) => {
            Err((format!("a primitive uses accessor {index}, which does not exist"), "export the file again"))
        }
        None => Ok(()),
    }
}

/// Converts an error of the crate to one line.
fn refusal(path: &Path, error: gltf::Error) -> Error {
    const EXPORT: &str = "export it again";
    match error {
        gltf::Error::Deserialize(e) => {
            let line = path.extension().is_some_and(|x| x.eq_ignore_ascii_case("gltf")).then(|| e.line());
            Error::file(path, line, format!("the JSON is not glTF: {e}"), EXPORT)
        }
        gltf::Error::Validation(faults) => {
            let first = faults.first().map(|(place, fault)| format!("{place}: {fault}")).unwrap_or_default();
            Error::file(path, None, format!("{} faults, the first: {first}", faults.len()), EXPORT)
        }
        other => Error::file(path, None, format!("this is not glTF: {other}").replace('\n', " "), EXPORT),
    }
}
