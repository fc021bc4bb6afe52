//! Open Inventor (`.iv`, ASCII, V2.0 and V2.1; Wernecke 1994) and VRML 1.0 (`.wrl`; Bell, Parisi and Pesce 1995), which is
//! the same language with fewer nodes.
//!
//! A file is a tree of nodes. Most of them set something (a transform, coordinates, materials) for the shapes that follow;
//! a separator ends what was set inside of it, a group does not. A file is read into a tree first (`parse`), so that `USE`
//! costs nothing until it makes triangles, and then walked through (`walk`). Where specification and tutorials are silent,
//! it does what the format's own library (SGI's, 2.1.5) was seen to do.
//!
//! **Shading.** Materials have the colours of the file: ambient is `ambientColor` times the ambient light of `Environment`,
//! and `emissiveColor`; the Phong exponent is 128 times the shininess. The format knows no mirrors, and there are none.
//! Transparency, textures, text, lines and points are left out with a warning, and shapes that are drawn as lines or points
//! as well. Under `LightModel BASE_COLOR` a shape shows its diffuse colour whatever the light. A triangle has one material
//! here: where the file binds colours to corners, a face gets the mean of its corners'. Where a material has lists of
//! different lengths, each starts again where it ends.
//!
//! **Normals** are the file's if there are enough of them. Otherwise they are made: where faces meet at less than the crease
//! angle, a corner has the mean of their normals (`crease`). That angle is 0 by default, and 0.5 in VRML 1.0.
//!
//! **Faces** that are concave are cut as such, whatever `ShapeHints` says of them.
//!
//! **Lights.** A light shines everywhere here, not just behind its node. Spots are point lights. A directional light stands
//! far away, at ten times the scene's diagonal. Colours are colour times intensity.
//!
//! **The first camera** that is met, if it is a perspective one, becomes the scene's.
//!
//! **Curved surfaces** have [`SEGMENTS`] segments around, unless the user wants others; `Complexity` is passed over.

mod crease;
mod faces;
mod header;
mod kind;
mod parse;
mod shapes;
mod state;
mod transform;
mod tree;
mod view;
mod walk;

use super::mesh_builder::MeshBuilder;
use super::text::{Fault, Includes, Trouble};
use super::{Options, Scene, SceneCamera};
use crate::error::{Error, Result};
use state::State;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use tree::Tree;

/// Segments around a curved surface.
pub const SEGMENTS: u32 = 24;

/// Values that may be gone through in all, repetitions counted: so many in any case, and so many more per byte of the files.
const WORK: usize = 4_000_000;
const WORK_PER_BYTE: usize = 16;

/// Faces around a corner that are looked at in the time of one value.
const FACES_PER_VALUE: usize = 8;

struct Reader {
    includes: Includes,
    mesh: MeshBuilder,
    segments: u32,
    /// Files as trees, with the crease angle of their dialect.
    trees: HashMap<PathBuf, Rc<(Tree, f64)>>,
    camera: Option<SceneCamera>,
    /// Directions of lights that are far away, and their colours.
    suns: Vec<view::Sun>,
    /// Nodes that are being walked through, from the outermost inwards.
    depth: usize,
    /// Values gone through.
    work: usize,
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
        trees: HashMap::new(),
        camera: None,
        suns: Vec::new(),
        depth: 0,
        work: 0,
    };
    reader.mesh.read(bytes.len());
    reader.file(path, bytes, None)?;
    let mut scene = Scene { camera: reader.camera, ..reader.mesh.finish() };
    if scene.triangles.is_empty() && !scene.warnings.is_empty() {
        let problem = format!("there is no triangle: {}", scene.warnings.join(", "));
        return Err(Error::file(path, None, problem, "a scene needs at least one"));
    }
    view::shine(&mut scene, &reader.suns);
    Ok(scene)
}

impl Reader {
    /// Goes through one file, with what was set around the node that includes it.
    fn file(&mut self, path: &Path, bytes: Rc<Vec<u8>>, around: Option<&State>) -> Result<()> {
        let known = self.trees.get(path).cloned();
        let tree = match known {
            Some(tree) => tree,
            None => {
                let tree = Rc::new(self.tree(&bytes).map_err(|fault| fault.of(path))?);
                self.trees.insert(path.to_owned(), Rc::clone(&tree));
                tree
            }
        };
        // The tree has all that is needed of them
        drop(bytes);
        if around.is_none() {
            self.includes.release_first();
        }
        let (tree, crease_angle) = &*tree;
        let mut state = around.copied().unwrap_or(State::new(*crease_angle));
        let walked = tree.roots.iter().try_for_each(|&root| self.walk(path, tree, root, &mut state, *crease_angle));
        walked.map_err(|trouble: Trouble| trouble.of(path))
    }

    fn tree(&mut self, bytes: &[u8]) -> Result<(Tree, f64), Fault> {
        let dialect = header::dialect(bytes)?;
        Ok((parse::parse(bytes, &mut self.mesh)?, dialect.crease_angle))
    }

    /// Counts values that are gone through.
    fn pass(&mut self, values: usize) -> Result<(), Fault> {
        if self.work_is_too_much(values) {
            return Err(Fault::new(None, "copies of copies never end", "use a node less often"));
        }
        Ok(())
    }

    /// Counts the faces that a normal was made of.
    fn smooth(&mut self, faces: usize) -> Result<(), Fault> {
        if self.work_is_too_much(faces / FACES_PER_VALUE) {
            return Err(Fault::new(
                None,
                "too many smooth faces meet in its corners",
                "give normals, or no creaseAngle",
            ));
        }
        Ok(())
    }

    fn work_is_too_much(&mut self, more: usize) -> bool {
        self.work = self.work.saturating_add(more);
        self.work > WORK + WORK_PER_BYTE * self.includes.bytes()
    }
}
