//! Reader of MGF, the Materials and Geometry Format of Radiance (Ward 1995, version 2).
//!
//! An entity is a line; a backslash directly before the end of a line continues it. The meaning of an entity depends on
//! the current vertex, colour and material contexts, which can have names, and on the transform. A block of `xf` with
//! arrays is read once for each instance.
//!
//! **Shading.** Transparent surfaces are rendered opaque, with a warning. The diffuse colour is the sum of the diffuse
//! reflectance (`rd`), the diffuse transmittance (`td`), and half of the specular transmittance (`ts`), without which
//! glass would be black. The specular colour is `rs`. A surface with a roughness of at most [`materials::SMOOTH`] is a
//! mirror with the reflectivity `rs`; the Phong exponent is computed from the roughness. The ambient colour is a tenth
//! of the diffuse colour, plus the emission. `ies`, `ir` and `sides` are ignored.
//!
//! **Lights.** Emissive surfaces become point lights, see [`lights`].
//!
//! **Curved surfaces** have [`SEGMENTS`] segments around their axis, as in the format's reference implementation (five
//! per quarter).

mod colour;
mod context;
mod entities;
pub mod lights;
pub mod materials;
mod shapes;
mod transform;

use super::mesh_builder::MeshBuilder;
use super::text::{Fault, Includes, ReadError, Syntax, Tokenizer, refuse_zeros};
use super::{Options, Scene};
use crate::error::{Error, Result};
use colour::Chromaticity;
use context::Contexts;
use glam::{DVec3, Vec3};
use lights::Emitters;
use materials::MaterialContext;
use std::path::Path;

/// The default number of segments around a curved surface.
pub const SEGMENTS: u32 = 20;

/// The largest nesting depth of blocks and files.
const MAX_DEPTH: usize = 100;

/// The limit of tokens that are read, counting repetitions, is `TOKENS` for each 64 MiB that repetitions may take
/// ([`MeshBuilder::work_factor`]), plus `TOKENS_PER_BYTE` per byte of the files.
const TOKENS: usize = 2_000_000;
const TOKENS_PER_BYTE: usize = 16;

/// What to do about too many repetitions.
const REPEATED: &str = "allow more with the option memory=SIZE, as in FILE:memory=8G, or reduce copies and includes";

/// A comment is an entity in this format, since names may contain `#`.
static SYNTAX: Syntax = Syntax::new(b"", b"").with_continued_lines();

/// A vertex context.
#[derive(Clone, Copy, Default)]
struct VertexContext {
    position: DVec3,
    /// Unit normal; zero means the normal of the surface. It is in single precision to save memory, since a file may
    /// name all of its vertices.
    normal: Vec3,
}

struct MgfReader {
    includes: Includes,
    mesh: MeshBuilder,
    segments: u32,
    vertices: Contexts<VertexContext>,
    colours: Contexts<Chromaticity>,
    materials: Contexts<MaterialContext>,
    /// True if the mesh's material is the current material context.
    material_set: bool,
    emitters: Emitters,
    /// Buffer for the vertices of a face, reused between faces.
    points: Vec<VertexContext>,
    /// Buffer for the positions of a face, reused between faces.
    corners: Vec<DVec3>,
    depth: usize,
    /// Number of tokens read so far.
    passed: usize,
}

/// Reads the file and the files that it includes.
///
/// # Errors
/// [`crate::Error::Input`] if one of the files is not valid.
pub fn read(path: &Path, options: &Options) -> Result<Scene> {
    let (includes, bytes) = Includes::new(path, options.outside)?;
    let mut reader = MgfReader {
        includes,
        mesh: MeshBuilder::new(options),
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

impl MgfReader {
    fn finish(self) -> Scene {
        let MgfReader { includes, mesh, vertices, emitters, .. } = self;
        // This is released before the mesh is copied to vectors of its exact size.
        drop((includes, vertices));
        let mut scene = mesh.finish();
        emitters.set_lights(&mut scene);
        scene
    }

    /// Reads one file.
    fn file(&mut self, path: &Path, bytes: &[u8]) -> Result<()> {
        refuse_zeros(bytes).map_err(|fault| fault.of(path))?;
        let mut tokens = Tokenizer::new(bytes, &SYNTAX);
        match self.block(path, &mut tokens, None) {
            Ok(()) => Ok(()),
            Err(error) => Err(ReadError::at(error, tokens.line()).of(path)),
        }
    }

    /// Counts tokens.
    ///
    /// # Errors
    /// The limit is exceeded.
    fn count_work(&mut self, tokens: usize) -> Result<(), Fault> {
        self.passed += tokens;
        if self.passed > TOKENS * self.mesh.work_factor() + TOKENS_PER_BYTE * self.includes.bytes() {
            return Err(Fault::new(None, "nested arrays repeat too many entities", REPEATED));
        }
        Ok(())
    }
}
