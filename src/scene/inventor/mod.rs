//! Reader of Open Inventor (`.iv`, ASCII, V2.0 and V2.1; Wernecke 1994) and VRML 1.0 (`.wrl`; Bell, Parisi and Pesce
//! 1995), which is the same language with fewer nodes.
//!
//! A file is a tree of nodes. Most nodes set a part of the state (a transform, coordinates, materials) for the shapes
//! that follow; a separator restores the state at its end, a group does not. A file is parsed into a tree (`parse`), so
//! that `USE` needs no memory until it creates triangles, and then the tree is traversed (`traverse`). If specification
//! and tutorials do not define a behaviour, the reader does what the reference implementation (SGI's Open Inventor
//! 2.1.5) was observed to do.
//!
//! **Shading.** Materials have the colours of the file. Ambient is `ambientColor` times the ambient light of
//! `Environment`, plus `emissiveColor`; the Phong exponent is 128 times the shininess. The format has no mirrors.
//! Transparency, textures, text, lines and points are ignored with a warning, as are shapes that are drawn as lines or
//! points. Under `LightModel BASE_COLOR` a shape has its diffuse colour under any light. A triangle has one material in
//! this program: if the file binds colours to corners, a face has the mean of its corners' colours. The lists of a
//! material can have different lengths; each is repeated from its start.
//!
//! **Normals** are the file's if there are enough of them. Otherwise they are computed: if faces meet at less than the
//! crease angle, a corner has the mean of their normals (`crease`). That angle is 0 by default, and 0.5 in VRML 1.0.
//!
//! **Concave faces** are triangulated correctly, independent of `ShapeHints`.
//!
//! **Lights** illuminate the whole scene, not only the nodes that follow them. Spot lights become point lights. A
//! directional light is placed at a distance of ten times the scene's diagonal. The colour of a light is its colour
//! times its intensity.
//!
//! **The first camera** becomes the scene's, if it is a perspective camera.
//!
//! **Curved surfaces** have [`SEGMENTS`] segments around their axis, unless the user sets others; `Complexity` is
//! ignored.

mod copies;
mod crease;
mod faces;
mod header;
mod list;
mod node_type;
mod parse;
mod shapes;
mod state;
mod strings;
mod transform;
mod traverse;
mod tree;
mod view;

use super::mesh_builder::MeshBuilder;
use super::text::{Fault, Includes, ReadError, refuse_zeros};
use super::{Options, Scene, SceneCamera};
use crate::error::{Error, Result};
use state::State;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use tree::Tree;

/// The default number of segments around a curved surface.
pub const SEGMENTS: u32 = 24;

/// The limit of values that are processed, counting repetitions, is `WORK` for each 64 MiB that repetitions may take
/// ([`MeshBuilder::work_factor`]), plus `WORK_PER_BYTE` per byte of the files.
const WORK: usize = 4_000_000;
const WORK_PER_BYTE: usize = 16;

/// What to do about too many repetitions.
const REPEATED: &str =
    "allow more with the option memory=SIZE, as in FILE:memory=8G, or reduce the repetitions of nodes";

/// Number of faces around a corner that can be examined in the time of one value.
const FACES_PER_VALUE: usize = 8;

struct InventorReader {
    includes: Includes,
    mesh: MeshBuilder,
    segments: u32,
    /// Parsed files, with the crease angle of their dialect.
    trees: HashMap<PathBuf, Rc<(Tree, f64)>>,
    camera: Option<SceneCamera>,
    distant_lights: Vec<view::DistantLight>,
    /// Depth of the current node in the tree, through `USE` and includes.
    depth: usize,
    /// Number of values processed so far.
    work: usize,
    /// Errors of the current node that are warnings.
    faults: Vec<Fault>,
}

/// Reads the file and the files that it includes.
///
/// # Errors
/// [`crate::Error::Input`] if one of the files is not valid.
pub fn read(path: &Path, options: &Options) -> Result<Scene> {
    let (includes, bytes) = Includes::new(path, options.outside)?;
    let mut reader = InventorReader {
        includes,
        mesh: MeshBuilder::new(options),
        segments: options.segments.unwrap_or(SEGMENTS),
        trees: HashMap::new(),
        camera: None,
        distant_lights: Vec::new(),
        depth: 0,
        work: 0,
        faults: Vec::new(),
    };
    reader.mesh.read(bytes.len());
    reader.file(path, bytes, None)?;
    let mut scene = Scene { camera: reader.camera, ..reader.mesh.finish() };
    if scene.triangles.is_empty() && !scene.warnings.is_empty() {
        let problem = format!("there is no triangle: {}", scene.warnings.join(", "));
        return Err(Error::file(path, None, problem, "a scene needs at least one"));
    }
    view::add_distant_lights(&mut scene, &reader.distant_lights);
    Ok(scene)
}

impl InventorReader {
    /// Reads one file; `outer` is the state of the node that includes it.
    fn file(&mut self, path: &Path, bytes: Rc<Vec<u8>>, outer: Option<&State>) -> Result<()> {
        let known = self.trees.get(path).cloned();
        let tree = match known {
            Some(tree) => tree,
            None => {
                let tree = Rc::new(self.tree(&bytes).map_err(|fault| fault.of(path))?);
                self.trees.insert(path.to_owned(), Rc::clone(&tree));
                tree
            }
        };
        // The tree holds copies of all values that are needed.
        drop(bytes);
        if outer.is_none() {
            self.includes.release_first();
        }
        let (tree, crease_angle) = &*tree;
        let mut state = outer.copied().unwrap_or(State::new(*crease_angle));
        let mut roots = tree.roots.iter();
        let result = roots.try_for_each(|&root| self.traverse(path, tree, root, &mut state, *crease_angle));
        result.map_err(|error: ReadError| error.of(path))
    }

    fn tree(&mut self, bytes: &[u8]) -> Result<(Tree, f64), Fault> {
        let dialect = header::dialect(bytes)?;
        refuse_zeros(bytes)?;
        Ok((parse::parse(bytes, &mut self.mesh)?, dialect.crease_angle))
    }

    /// Counts processed values.
    ///
    /// # Errors
    /// The limit is exceeded.
    fn count_work(&mut self, values: usize) -> Result<(), Fault> {
        self.check_work(values)?;
        self.work += values;
        Ok(())
    }

    /// Checks that this many more values may be processed.
    fn check_work(&self, values: usize) -> Result<(), Fault> {
        if self.work.saturating_add(values) > self.most_work() {
            return Err(Fault::new(None, "nested copies repeat too many values", REPEATED));
        }
        Ok(())
    }

    /// Counts the faces that were examined for a normal.
    ///
    /// # Errors
    /// The limit is exceeded.
    fn count_faces(&mut self, faces: usize) -> Result<(), Fault> {
        self.work = self.work.saturating_add(faces / FACES_PER_VALUE);
        if self.work > self.most_work() {
            return Err(Fault::new(
                None,
                "too many smooth faces meet in its corners",
                "give normals, or set creaseAngle to 0",
            ));
        }
        Ok(())
    }

    /// The limit of processed values.
    fn most_work(&self) -> usize {
        WORK * self.mesh.work_factor() + WORK_PER_BYTE * self.includes.bytes()
    }
}
