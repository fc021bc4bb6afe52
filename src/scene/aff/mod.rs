//! BART's scenes (`.aff`; Lext, Assarsson, Möller 2000), and NFF (`.nff`; Haines 1987), which they extend.
//!
//! What moves is frozen at one time (`FILE:time=3`): by default where the animation (`a`) begins, without one at the
//! first key of all. The keyframes called `camera` become [`Scene::camera`], a pose per frame of `a`.
//!
//! Keyframes and the animation's times may stand behind what they move, so the files are gone through twice: first for
//! those alone, then for the rest.
//!
//! **Shading.** BART's renderers take a surface with a specular colour for a mirror of that colour; our mirrors have one
//! number. So `fm` keeps its colours and mirrors as much as its specular colour is bright (by luminance), and `f` has the
//! diffuse colour rgb * Kd, a white highlight of Ks and mirrors as much as Ks. `fm`'s ambient colour is taken times the
//! global ambient light (`am`); `f`, which has none, gets a tenth of its diffuse colour. Transparency and textures are
//! passed over with a warning.
//!
//! **Curved surfaces** have [`SEGMENTS`] segments around, unless the user wants others (`FILE:segments=64`); cones may be
//! left out (`FILE:cones=no`), as the thesis did.

mod camera;
mod entities;
mod keys;
mod primitives;
mod spline;

use super::mesh_builder::MeshBuilder;
use super::text::{Includes, Syntax, Trouble, Words};
use super::{Options, Scene};
use crate::error::{Error, Result};
use camera::{Animation, Viewpoint};
use glam::{DVec3, Vec3};
use keys::Keyframes;
use std::collections::HashMap;
use std::path::Path;

/// Segments around a sphere or cone.
pub const SEGMENTS: u32 = 24;

static SYNTAX: Syntax = Syntax::new(b"#%", b"{}");

/// What is looked for while the files are gone through.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pass {
    /// Keyframes, animation, ambient light, viewpoint.
    Keys,
    /// Everything else, at a known time.
    Mesh,
}

/// Everything that is known while the files are gone through.
struct Reader {
    includes: Includes,
    pass: Pass,
    segments: u32,
    cones: bool,
    keys: HashMap<Vec<u8>, Keyframes>,
    animation: Option<Animation>,
    view: Option<Viewpoint>,
    ambient: DVec3,
    background: Vec3,
    detail: i64,
    time: f64,
    /// Braces around what is not visible.
    hidden: usize,
    mesh: MeshBuilder,
}

/// Reads the file and what it includes.
///
/// # Errors
/// [`crate::Error::Input`] for whatever is wrong with one of the files.
pub fn read(path: &Path, options: &Options) -> Result<Scene> {
    let (includes, bytes) = Includes::new(path, options.outside)?;
    let mut reader = Reader {
        includes,
        pass: Pass::Keys,
        segments: options.segments.unwrap_or(SEGMENTS),
        cones: options.cones,
        keys: HashMap::new(),
        animation: None,
        view: None,
        ambient: DVec3::ONE,
        background: Vec3::ZERO,
        detail: 0,
        time: 0.0,
        hidden: 0,
        mesh: MeshBuilder::new(options.offset),
    };
    reader.file(path, &bytes)?;
    let first_key = || reader.keys.values().filter_map(Keyframes::first_time).min_by(f64::total_cmp);
    let begin = reader.animation.map(|a| a.start).or_else(first_key);
    let time = options.time.or(begin);
    // Without any key, the earliest time there is stands for the first key of animated triangles as well
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
    Ok(Scene { background: reader.background, camera, ..reader.mesh.finish() })
}

impl Reader {
    /// Goes through one file.
    fn file(&mut self, path: &Path, bytes: &[u8]) -> Result<()> {
        let mut words = Words::new(bytes, &SYNTAX);
        self.entities(path, &mut words).map_err(|trouble: Trouble| trouble.at(words.line()).of(path))
    }

    /// True if geometry and lights are wanted here.
    fn building(&self) -> bool {
        self.pass == Pass::Mesh && self.hidden == 0
    }
}
