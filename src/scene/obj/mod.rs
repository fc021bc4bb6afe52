//! Wavefront OBJ with MTL: polygonal meshes, materials, smoothing groups.
//!
//! Why a reader of our own: tobj 4.0.5, the well-kept crate, was measured at 24 to 52 MB/s on one core, below the bar of 60;
//! its errors name no line; it knows neither smoothing groups nor Latin-1 nor continued lines; a corner without a normal
//! takes its predecessor's; and a relative texture index beyond the start overflows. A test holds our triangles against
//! its.
//!
//! What is taken: `v`, `vn`, `f`, `s`, `usemtl`, `mtllib`; `vt`, `g` and `o` are passed over. Triangles stand in file
//! order, polygons as [`super::polygon`] says. A vertex is a position with a normal: corners with different normals become different vertices.
//! Where the file has no normals, they are smooth inside a smoothing group, flat after `s off`, and smooth everywhere if
//! the file never says `s`.
//!
//! A `#` in the name of a material or library begins a comment if there is none of the whole name. A material that is used
//! before its library is named is filled in then.
//!
//! Materials: see [`mtl`]. Surfaces that shine become point lights: see [`super::lamps`].

mod face;
mod library;
mod lines;
pub mod mtl;

use super::mesh_builder::Warnings;
use super::text::Home;
use super::{Material, Options, Placement, Scene, lamps, normals};
use crate::error::{Error, Result};
use crate::math::Vertex;
use face::{Faces, Smoothing};
use glam::{DVec3, Vec3};
use lines::{Lines, printable};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::{Path, PathBuf};

/// Names of each kind that warnings are to choose from.
const NAMES: usize = 16;

/// What is wrong at a line.
#[derive(Debug)]
pub(crate) struct Fault {
    line: usize,
    problem: String,
    hint: &'static str,
}

impl Fault {
    fn new(line: usize, problem: impl Into<String>, hint: &'static str) -> Fault {
        Fault { line, problem: problem.into(), hint }
    }

    fn of(self, path: &Path) -> Error {
        Error::file(path, Some(self.line), self.problem, self.hint)
    }
}

/// Reads the file and the material libraries that it names.
///
/// # Errors
/// [`Error::Input`] for whatever is wrong with one of them; a library that is not there is a warning.
pub fn read(path: &Path, options: &Options) -> Result<Scene> {
    read_bytes(path, &super::read_text(path)?, options)
}

/// Reads a file that is already in memory; `path` is where libraries are looked for.
///
/// # Errors
/// As [`read`].
pub fn read_bytes(path: &Path, bytes: &[u8], options: &Options) -> Result<Scene> {
    let mut reader = Reader::new(path, options);
    reader.faces.read(bytes.len());
    let mut lines = Lines::new(bytes);
    while let Some(keyword) = lines.keyword() {
        reader.line(keyword, &mut lines)?;
        lines.end_statement();
    }
    if reader.faces.triangles.is_empty() {
        let problem = "there is no face: points and curves cannot be ray traced";
        return Err(Error::file(path, None, problem, "export it as a polygonal mesh"));
    }
    Ok(reader.finish())
}

/// A material that has a name.
struct Named {
    index: u32,
    /// True if it is neutral because no library has had it yet.
    guessed: bool,
}

struct Reader<'a> {
    path: &'a Path,
    options: &'a Options,
    /// Where positions are counted from.
    placement: Placement,
    faces: Faces,
    materials: Vec<Material>,
    /// Colour that a material gives off, by its index.
    emission: Vec<Vec3>,
    /// Triangles of each.
    triangles: Vec<usize>,
    names: HashMap<Vec<u8>, Named>,
    /// Names that no library has had yet, and that may end with a comment.
    commented: Vec<Vec<u8>>,
    /// Libraries that have been read.
    libraries: HashSet<PathBuf>,
    /// What stood behind `mtllib`, and the names in it.
    tried: HashSet<Vec<u8>>,
    /// Where libraries may lie, once there is one.
    home: Option<Home>,
    /// Keywords that were passed over.
    ignored: BTreeSet<String>,
    warnings: Warnings,
    textures: bool,
}

impl<'a> Reader<'a> {
    fn new(path: &'a Path, options: &'a Options) -> Reader<'a> {
        Reader {
            path,
            options,
            placement: Placement { offset: options.offset.unwrap_or(DVec3::ZERO), exponent: 0 },
            faces: Faces::default(),
            materials: Vec::new(),
            emission: Vec::new(),
            triangles: Vec::new(),
            names: HashMap::new(),
            commented: Vec::new(),
            libraries: HashSet::new(),
            tried: HashSet::new(),
            home: None,
            ignored: BTreeSet::new(),
            warnings: Warnings::default(),
            textures: false,
        }
    }

    fn line(&mut self, keyword: &[u8], lines: &mut Lines) -> Result<()> {
        match keyword {
            b"v" => lines.position(self.placement.offset).map(|v| self.faces.positions.push(v)),
            b"vn" => lines.normal().map(|v| self.faces.normals.push(v)),
            b"f" | b"fo" => {
                let (material, before) = (self.material(), self.faces.triangles.len());
                let read = self.faces.face(lines, material);
                let more = self.faces.triangles.len() - before;
                self.triangles[material as usize] += more;
                if self.emission[material as usize] != Vec3::ZERO {
                    self.faces.shining += more;
                }
                read
            }
            b"vt" | b"vp" | b"g" | b"o" => Ok(()),
            b"s" => {
                let word = lines.word().unwrap_or_default();
                self.faces.smoothing(if word == b"off" { Smoothing::Flat } else { Smoothing::group(word) });
                Ok(())
            }
            b"usemtl" => {
                let (line, name) = (lines.line(), lines.rest().into_owned());
                self.use_material(name, line)
            }
            b"mtllib" => return self.libraries(lines),
            other => {
                if self.ignored.len() < NAMES {
                    self.ignored.insert(printable(other));
                }
                Ok(())
            }
        }
        .map_err(|fault: Fault| fault.of(self.path))
    }

    /// The current material; the neutral one before the first `usemtl`.
    fn material(&mut self) -> u32 {
        match self.faces.material {
            Some(material) => material,
            None => {
                let index = self.add(Vec::new(), Material::neutral(), Vec3::ZERO);
                *self.faces.material.insert(index)
            }
        }
    }

    fn finish(self) -> Scene {
        let (unknown, no_lamp) = (self.unknown(), self.no_lamp());
        let Faces { positions, normals: given, keys, triangles, .. } = &self.faces;
        let mut bad = 0;
        let mut vertices: Vec<Vertex> = keys
            .iter()
            .map(|key| {
                let normal = key.normal().map_or(Vec3::ZERO, |n| normals::unit(given[n]));
                bad += usize::from(key.normal().is_some() && normal == Vec3::ZERO);
                Vertex::new(positions[key.position as usize], normal)
            })
            .collect();
        normals::normalise_or_smooth(&mut vertices, triangles);
        let lights = lamps::lights(&vertices, triangles, &self.emission);
        let (materials, placement) = (self.materials, self.placement);
        let mut scene = Scene { vertices, lights, materials, placement, ..Scene::default() };
        scene.triangles = self.faces.triangles;
        scene.warnings = self.warnings.lines();
        let mut warn = |warning: String| scene.warnings.push(warning);
        no_lamp.into_iter().for_each(&mut warn);
        let list = |names: &BTreeSet<String>| names.iter().take(8).cloned().collect::<Vec<_>>().join(", ");
        if bad > 0 {
            warn(format!("{bad} normals in the file are zero or not finite: computed instead"));
        }
        if !unknown.is_empty() {
            warn(format!("materials that no library has are neutral grey: {}", list(&unknown)));
        }
        if self.faces.small > 0 {
            warn(format!("{} faces with fewer than three corners skipped", self.faces.small));
        }
        if self.textures {
            warn("textures are left out: surfaces have their plain colours".into());
        }
        if !self.ignored.is_empty() {
            warn(format!("passed over: {}", list(&self.ignored)));
        }
        scene
    }
}
