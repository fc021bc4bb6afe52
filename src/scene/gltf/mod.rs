//! Reader of glTF 2.0 and GLB: meshes, nodes and instances, materials, punctual lights, cameras.
//!
//! The JSON is parsed in pieces, each when it is used ([`json`]), by types that know only what is read ([`schema`]). So
//! no geometry is lost over what is not geometry: textures, animations, attributes of applications, `extras`. The crate
//! `gltf` validates all of that, and refuses what exporters write.
//!
//! The reader converts the default scene (otherwise the first with nodes, otherwise all nodes), with each mesh once per
//! node that refers to it and once per instance (EXT_mesh_gpu_instancing), in the order of the nodes: triangles, strips
//! and fans. Positions and normals may be bytes or shorts (KHR_mesh_quantization). Morph targets are applied with their
//! default weights. A primitive without normals has flat shading, as the format demands. A triangle with a corner that
//! is not finite is dropped. The camera is the one that the option `camera=` names, by default the first perspective
//! camera. [`material`] converts materials. Punctual lights become point lights: a spot light shines in all directions,
//! and a directional light is placed ten diagonals away. Lights have no attenuation in this program, so colours are
//! scaled such that the brightest channel of their sum is 1. If there are no lights, emissive surfaces become lights
//! ([`super::lamps`]).
//!
//! Textures, vertex colours, transparency, skins, animations, points and lines are ignored; [`extensions`] decides what
//! an extension means. Malformed materials, lights and cameras are warnings.

mod accessor;
mod buffers;
mod container;
mod extensions;
mod json;
mod lights;
mod material;
mod memory;
mod nodes;
mod notes;
mod reader;
mod schema;
mod shape;

use super::mesh_builder::Limits;
use super::text::Fault;
use super::{Options, Scene};
use crate::error::Result;
use accessor::Accessors;
use buffers::Buffers;
use json::{Json, Loose};
use notes::Notes;
use reader::{GltfReader, Lists};
use schema::{Root, Text};
use std::path::Path;

/// Reads the file and the buffers that it names.
///
/// # Errors
/// [`crate::Error::Input`] if one of them is not valid.
pub fn read(path: &Path, options: &Options) -> Result<Scene> {
    read_bytes(path, &super::read_text(path)?, options)
}

/// Reads a file from memory; buffers are searched in the folder of `path`.
///
/// # Errors
/// As [`read`].
pub fn read_bytes(path: &Path, bytes: &[u8], options: &Options) -> Result<Scene> {
    scene(path, bytes, options).map_err(|fault| fault.of(path))
}

fn scene(path: &Path, bytes: &[u8], options: &Options) -> std::result::Result<Scene, Fault> {
    let mut limits = Limits::new(options);
    limits.read(bytes.len());
    let (json, blob) = container::split(bytes)?;
    let text = container::characters(json)?;
    let is_text = !bytes.starts_with(b"glTF");
    let repaired;
    let (json, root) = match Json::new(&text, is_text).root::<Root>() {
        Ok(root) => (Json::new(&text, is_text), root),
        Err(fault) => {
            repaired = container::without_nan(&text).ok_or(fault)?;
            let json = Json::new(&repaired, is_text);
            (json, json.root()?)
        }
    };
    let version = |which: for<'r> fn(&'r schema::Asset<'r>) -> &'r Loose<Text<'r>>| match &root.asset {
        Loose::Given(asset) => match which(asset) {
            Loose::Given(Text(version)) => Some(&**version),
            Loose::Absent | Loose::Malformed => None,
        },
        Loose::Absent | Loose::Malformed => None,
    };
    let newer = container::check_version(version(|asset| &asset.version), version(|asset| &asset.min_version))?;
    let mut warnings = extensions::check(json, &root)?;
    warnings.extend(newer);
    let views = json.list("bufferViews", "buffer view", root.buffer_views)?;
    let buffers = json.list("buffers", "buffer", root.buffers)?;
    let buffers = Buffers::new((path, bytes), options, blob, views, buffers);
    let accessors = Accessors::new(json.list("accessors", "accessor", root.accessors)?, buffers);
    let lights = match &root.extensions {
        Loose::Given(schema::RootExtensions { lights: Loose::Given(lights) }) => lights.lights,
        _ => None,
    };
    let mut notes = Notes::default();
    let mut optional = |name, element, raw| match json.list(name, element, raw) {
        Ok(list) => Ok(list),
        Err(fault) => {
            notes.malformed(|| fault.problem);
            json.list(name, element, None)
        }
    };
    let lists = Lists {
        nodes: json.list("nodes", "node", root.nodes)?,
        meshes: json.list("meshes", "mesh", root.meshes)?,
        cameras: optional("cameras", "camera", root.cameras)?,
        lights: optional("lights", "light", lights)?,
    };
    let mut reader = GltfReader::new((json, &root), lists, accessors, limits, options);
    reader.notes = notes;
    reader.scene.warnings = warnings;
    reader.materials()?;
    reader.scene()?;
    reader.finish()
}

/// A piece of the file for a message: without control characters, at most this many characters.
fn shown(text: &str, most: usize) -> String {
    text.chars().filter(|c| !c.is_control()).take(most).collect()
}
