//! glTF 2.0 and GLB, read by the `gltf` crate: meshes, nodes and instances, materials, punctual lights, cameras.
//!
//! The crate reads and validates the JSON. Accessors are read here ([`accessor`]): the crate's own iterators rely on
//! lengths that nobody has checked.
//!
//! What is taken: the default scene (else the first, else all nodes), every mesh once per node that shows it, in the
//! order of the nodes; triangles, strips and fans. A primitive without normals is flat, as the format demands. The first
//! perspective camera is the scene's, or the one that `camera=` names. Materials: see [`material`]. Punctual lights become
//! point lights: a spot shines all around, a directional light stands ten diagonals away; since our lights do not fade, their
//! colours are scaled so that together their brightest channel is 1. Without any, surfaces that shine become lights
//! ([`super::lamps`]).
//!
//! What is not: textures, vertex colours, transparency, skins, morph targets, animations (the pose of the nodes counts), points and lines.

mod accessor;
mod buffers;
mod head;
mod locals;
mod material;
mod room;
mod walk;

use super::mesh_builder::Limits;
use super::{Options, Scene};
use crate::error::{Error, Result};
use buffers::Buffers;
use locals::Locals;
use std::path::Path;
use walk::Walk;

/// What is wrong: problem and mend.
type Fault = (String, &'static str);

/// Reads the file and the buffers that it names.
///
/// # Errors
/// [`Error::Input`] for whatever is wrong with one of them.
pub fn read(path: &Path, options: &Options) -> Result<Scene> {
    read_bytes(path, &super::read_text(path)?, options)
}

/// Reads a file that is already in memory; `path` is where buffers are looked for.
///
/// # Errors
/// As [`read`].
pub fn read_bytes(path: &Path, bytes: &[u8], options: &Options) -> Result<Scene> {
    let at = |(problem, hint): Fault| Error::file(path, None, problem, hint);
    head::check_container(bytes).map_err(at)?;
    let json = if bytes.starts_with(b"glTF") { json_chunk(bytes) } else { bytes };
    let mut limits = Limits::default();
    limits.read(bytes.len());
    document_fits(json, &mut limits).map_err(at)?;
    head::check(json).map_err(at)?;
    let locals = Locals::read(json);
    limits.keep(locals.bytes()).map_err(|fault| at(room::too_much(fault)))?;
    let unchecked = gltf::Gltf::from_slice_without_validation(bytes).map_err(|error| refusal(path, error))?;
    let json = unchecked.document.into_json();
    positions_exist(&json).map_err(at)?;
    let document = gltf::Document::from_json(json).map_err(|error| refusal(path, error))?;
    let buffers = Buffers::load(path, &document, unchecked.blob.as_deref(), options).map_err(at)?;
    limits.read(buffers.beside());
    let mut walk = Walk::new(&document, &buffers, limits, locals, options);
    walk.scene().map_err(at)?;
    walk.finish().map_err(at)
}

/// The first chunk of a GLB, behind the headers of file and chunk.
fn json_chunk(bytes: &[u8]) -> &[u8] {
    let length = bytes.get(12..16).map_or(0, |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    let behind = bytes.get(20..).unwrap_or_default();
    &behind[..length.min(behind.len())]
}

/// Memory that the crate (1.4.1) takes for an object of the JSON, nodes being the largest that may be as short as `{}`, and for
/// a string, by its two marks; both while the vectors that hold them grow.
const PER_OBJECT: usize = 704;
const PER_MARK: usize = 36;

/// Holds the document against what the file may take of memory, before the crate makes it.
fn document_fits(json: &[u8], limits: &mut Limits) -> Result<(), Fault> {
    let count = |byte| json.iter().filter(|&&b| b == byte).count();
    let needed = count(b'{') * PER_OBJECT + count(b'"') * PER_MARK;
    limits.keep(needed).map_err(|_| {
        let problem = format!("the JSON's {} objects need {} MiB of memory", count(b'{'), needed >> 20);
        (problem, "it may take 16 times the file and 64 MiB: export fewer nodes")
    })
}

/// The crate's validation (1.4.1) looks into the accessor of a primitive's positions before it has checked that there is
/// one, and panics.
fn positions_exist(json: &gltf::json::Root) -> Result<(), Fault> {
    let positions = gltf::json::validation::Checked::Valid(gltf::Semantic::Positions);
    let mut primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let beyond = |index: usize| index >= json.accessors.len();
    match primitives.find_map(|p| p.attributes.get(&positions).map(|i| i.value()).filter(|&i| beyond(i))) {
        Some(index) => Err((format!("a primitive uses accessor {index}, which is not there"), "export the file again")),
        None => Ok(()),
    }
}

/// What the crate does not like, as one line.
fn refusal(path: &Path, error: gltf::Error) -> Error {
    const EXPORT: &str = "export it again";
    match error {
        gltf::Error::Deserialize(e) => {
            let line = path.extension().is_some_and(|x| x.eq_ignore_ascii_case("gltf")).then(|| e.line());
            Error::file(path, line, format!("the JSON is no glTF: {e}"), EXPORT)
        }
        gltf::Error::Validation(faults) => {
            let first = faults.first().map(|(place, fault)| format!("{place}: {fault}")).unwrap_or_default();
            Error::file(path, None, format!("{} faults, the first: {first}", faults.len()), EXPORT)
        }
        other => Error::file(path, None, format!("this is no glTF: {other}").replace('\n', " "), EXPORT),
    }
}
