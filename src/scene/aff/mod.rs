//! Reader of BART's scenes (`.aff`; Lext, Assarsson, Möller 2000), and of NFF (`.nff`; Haines 1987), which they extend.
//!
//! Animated geometry is evaluated at one time (`FILE:time=3`): by default at the start of the animation (`a`), without
//! an animation at the first of all keys. The keyframes named `camera` become [`Scene::camera`], with a pose per frame
//! of `a`.
//!
//! Keyframes and the animation's times may follow the objects that refer to them, so the files are read in two passes:
//! the first reads only those, the second reads the rest.
//!
//! **Shading.** BART's renderers treat a surface with a specular colour as a mirror of that colour; mirrors in this
//! program have a single reflectivity. `fm` keeps its colours, and its reflectivity is the luminance of its specular
//! colour. `f` has the diffuse colour rgb * Kd, a white highlight of Ks, and the reflectivity Ks. The ambient colour of
//! `fm` is multiplied by the global ambient light (`am`); `f` has none and gets a tenth of its diffuse colour.
//! Transparency and textures are ignored with a warning.
//!
//! **Curved surfaces** have [`SEGMENTS`] segments around their axis, unless the user sets others (`FILE:segments=64`).
//! Cones can be omitted (`FILE:cones=no`), as in the thesis of 2009.

mod camera;
mod entities;
mod keys;
mod loose;
mod primitives;
mod spline;

use super::mesh_builder::MeshBuilder;
use super::text::{Includes, ReadError, Syntax, Tokenizer, refuse_zeros};
use super::{Options, Scene};
use crate::error::{Error, Result};
use camera::{Animation, Viewpoint};
use glam::{DVec3, Vec3};
use keys::Keyframes;
use std::collections::HashMap;
use std::path::Path;

/// The default number of segments around a sphere or cone.
pub const SEGMENTS: u32 = 24;

static SYNTAX: Syntax = Syntax::new(b"#%", b"{}");

/// The two passes over the files.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pass {
    /// Reads keyframes, animation, ambient light and viewpoint.
    Keys,
    /// Reads everything else, at a known time.
    Mesh,
}

/// The state while the files are read.
struct AffReader {
    includes: Includes,
    pass: Pass,
    segments: u32,
    cones: bool,
    keys: HashMap<Vec<u8>, Keyframes>,
    animation: Option<Animation>,
    view: Option<Viewpoint>,
    /// The place of the viewpoint for the user.
    view_place: String,
    ambient: DVec3,
    background: Vec3,
    detail: i64,
    time: f64,
    /// Number of open blocks that are invisible.
    hidden: usize,
    mesh: MeshBuilder,
}

/// Reads the file and the files that it includes.
///
/// # Errors
/// [`crate::Error::Input`] if one of the files is not valid.
pub fn read(path: &Path, options: &Options) -> Result<Scene> {
    let (includes, bytes) = Includes::new(path, options.outside)?;
    let mut reader = AffReader {
        includes,
        pass: Pass::Keys,
        segments: options.segments.unwrap_or(SEGMENTS),
        cones: options.cones,
        keys: HashMap::new(),
        animation: None,
        view: None,
        view_place: String::new(),
        ambient: DVec3::ONE,
        background: Vec3::ZERO,
        detail: 0,
        time: 0.0,
        hidden: 0,
        mesh: MeshBuilder::new(options),
    };
    reader.file(path, &bytes)?;
    let first_key = || reader.keys.values().filter_map(Keyframes::first_time).min_by(f64::total_cmp);
    let begin = reader.animation.map(|a| a.start).or_else(first_key);
    let time = options.time.or(begin);
    // Without keys the time is the earliest possible, at which animated triangles have their first position.
    reader.time = time.unwrap_or(f64::MIN);
    reader.pass = Pass::Mesh;
    reader.detail = 0;
    reader.includes.rewind();
    reader.mesh.read(reader.includes.bytes());
    reader.file(path, &bytes)?;

    let keys = match &options.camera {
        None => reader.keys.get(&b"camera"[..]),
        Some(name) => Some(reader.keys.get(name.as_bytes()).ok_or_else(|| {
            let hint = "give the name of keyframes that the file has, or leave `camera=` out";
            Error::file(path, None, format!("there are no keyframes `{name}`"), hint)
        })?),
    };
    let (time, offset) = (time.unwrap_or(0.0), reader.mesh.offset());
    let camera = camera::camera(reader.view.as_ref(), keys, reader.animation.as_ref(), time, offset);
    if camera.is_none() && reader.view.is_some() {
        let problem = "v: the viewpoint has no direction, because `from` and `at` are the same point: it is ignored";
        reader.mesh.warnings.add(&format!("{}: {problem}", reader.view_place));
    }
    Ok(Scene { background: reader.background, camera, ..reader.mesh.finish() })
}

impl AffReader {
    /// Reads one file in the current pass.
    fn file(&mut self, path: &Path, bytes: &[u8]) -> Result<()> {
        refuse_zeros(bytes).map_err(|fault| fault.of(path))?;
        let mut tokens = Tokenizer::new(bytes, &SYNTAX);
        self.entities(path, &mut tokens).map_err(|error: ReadError| error.at(tokens.line()).of(path))
    }

    /// True if geometry and lights are added to the scene, which they are in visible blocks of the second pass.
    fn building(&self) -> bool {
        self.pass == Pass::Mesh && self.hidden == 0
    }
}
