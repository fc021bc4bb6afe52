//! MGF, the Materials and Geometry Format of Radiance (Ward 1995, version 2).
//!
//! An entity is a line, which a backslash right before its end continues. What it means depends on three contexts (vertex, colour, material), which may have names, and on
//! the transform; `xf` with arrays goes through its lines once for each place.
//!
//! **Shading.** What lets light through is shown opaque, with a warning. The diffuse colour is the reflectance `rd`, with
//! it what is let through diffusely (`td`) and half of what is let through straight (`ts`, or glass were black); the specular
//! colour is `rs`. A surface whose roughness is at most [`materials::SMOOTH`] mirrors as much as it reflects specularly; the
//! Phong exponent follows from the roughness. Ambient light is a tenth of the diffuse colour, and emitting surfaces show
//! their own. `ies`, `ir` and `sides` are passed over.
//!
//! **Lights.** Emitting surfaces become point lights, see [`lights`].
//!
//! **Curved surfaces** have [`SEGMENTS`] segments around as in the format's own library (five in a quarter).

mod colour;
mod context;
mod entities;
pub mod lights;
pub mod materials;
mod shapes;
mod transform;

use super::mesh_builder::MeshBuilder;
use super::text::{Fault, Includes, Syntax, Trouble, Words};
use super::{Options, Scene};
use crate::error::{Error, Result};
use colour::Chromaticity;
use context::Contexts;
use glam::{DVec3, Vec3};
use lights::Emitters;
use materials::Surface;
use std::path::Path;

/// Segments around a curved surface.
pub const SEGMENTS: u32 = 20;

/// Most blocks and files inside each other.
const MAX_DEPTH: usize = 100;

/// Words that may be gone through in all, repetitions counted: so many in any case, and so many more per byte of the files.
const WORDS: usize = 2_000_000;
const WORDS_PER_BYTE: usize = 16;

/// A comment is an entity here: `#` may stand within names.
static SYNTAX: Syntax = Syntax::new(b"", b"").with_continued_lines();

/// A vertex context.
#[derive(Clone, Copy, Default)]
struct Point {
    position: DVec3,
    /// Of length one; zero where the surface's own normal is meant. Single precision: a file may name all its vertices.
    normal: Vec3,
}

struct Reader {
    includes: Includes,
    mesh: MeshBuilder,
    segments: u32,
    vertices: Contexts<Point>,
    colours: Contexts<Chromaticity>,
    materials: Contexts<Surface>,
    /// True if the mesh has the current material already.
    material_set: bool,
    emitters: Emitters,
    /// Room for the vertices of a face, and for their positions: faces are many and small.
    points: Vec<Point>,
    corners: Vec<DVec3>,
    depth: usize,
    /// Words gone through.
    passed: usize,
}

/// Reads the file and what it includes.
///
/// # Errors
/// [`crate::Error::Input`] for whatever is wrong with one of the files.
pub fn read(path: &Path, options: &Options) -> Result<Scene> {
    let (includes, bytes) = Includes::new(path, options.outside)?;
    let mut reader = Reader {
        includes,
        mesh: MeshBuilder::new(options.offset),
        segments: options.segments.unwrap_or(SEGMENTS),
        vertices: Contexts::default(),
        colours: Contexts::default(),
        materials: Contexts::default(),
        material_set: false,
        emitters: Emitters::default(),
        points: Vec::new(),
        corners: Vec::new(),
        depth: 0,
        passed: 0,
    };
    reader.mesh.read(bytes.len());
    reader.file(path, &bytes)?;
    drop(bytes);
    let scene = reader.finish();
    if scene.triangles.is_empty() && !scene.warnings.is_empty() {
        let problem = format!("there is no triangle: {}", scene.warnings.join(", "));
        return Err(Error::file(path, None, problem, "a scene needs at least one"));
    }
    Ok(scene)
}

impl Reader {
    /// The scene.
    fn finish(self) -> Scene {
        let Reader { includes, mesh, vertices, emitters, .. } = self;
        // Before the mesh is copied into less room
        drop((includes, vertices));
        let mut scene = mesh.finish();
        emitters.light(&mut scene);
        scene
    }

    /// Goes through one file.
    fn file(&mut self, path: &Path, bytes: &[u8]) -> Result<()> {
        let mut words = Words::new(bytes, &SYNTAX);
        match self.block(path, &mut words, None) {
            Ok(()) => Ok(()),
            Err(trouble) => Err(Trouble::at(trouble, words.line()).of(path)),
        }
    }

    /// Counts words that are gone through.
    fn pass(&mut self, words: usize) -> Result<(), Fault> {
        self.passed += words;
        if self.passed > WORDS + WORDS_PER_BYTE * self.includes.bytes() {
            return Err(Fault::new(None, "arrays of arrays never end", "repeat less, or include less often"));
        }
        Ok(())
    }
}
