//! Reader of Wavefront OBJ with MTL: polygonal meshes, materials, smoothing groups.
//!
//! The crate tobj 4.0.5 is not used for these reasons: it was measured at 24 to 52 MB/s on one core, below the required
//! 60; its errors have no line numbers; it supports neither smoothing groups nor Latin-1 nor continued lines; a corner
//! without a normal gets its predecessor's; and a relative texture index beyond the start overflows. A test compares
//! the triangles of both readers.
//!
//! The reader supports `v`, `vn`, `f`, `s`, `usemtl` and `mtllib`; it ignores `vt`, `g` and `o`. Triangles are in file
//! order; [`super::polygon`] triangulates polygons. Corners with different normals become different vertices. If the
//! file has no normals, they are smooth inside a smoothing group, flat after `s off`, and smooth everywhere without
//! `s`.
//!
//! A `#` in the name of a material or library begins a comment, unless the whole name exists. A material can be used
//! before the statement that names its library.
//!
//! [`mtl`] converts materials. Emissive surfaces become point lights, see [`super::lamps`].

mod corner;
mod face;
mod library;
mod lines;
pub mod mtl;
mod pending;

use super::mesh_builder::{DROPPED, Warnings, drop_invalid, is_valid};
use super::text::{SceneFolders, place, refuse_zeros};
use super::{Material, Options, Placement, Scene, lamps, normals};
use crate::error::{Error, Result};
use crate::math::Vertex;
use face::{Faces, Smoothing};
use glam::{DVec3, Vec3};
use lines::{Lines, printable};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::{Path, PathBuf};

/// The largest number of names of each kind that are collected for warnings.
const NAMES: usize = 16;

/// An error in a line, without the file's name.
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
/// [`Error::Input`] if one of them is not valid. A library that does not exist is a warning.
pub fn read(path: &Path, options: &Options) -> Result<Scene> {
    read_bytes(path, &super::read_text(path)?, options)
}

/// Reads a file from memory; libraries are searched in the folder of `path`.
///
/// # Errors
/// As [`read`].
pub fn read_bytes(path: &Path, bytes: &[u8], options: &Options) -> Result<Scene> {
    let mut reader = ObjReader::new(path, options);
    refuse_zeros(bytes).map_err(|fault| fault.of(path))?;
    reader.faces.read(bytes.len());
    let mut lines = Lines::new(bytes);
    while let Some(keyword) = lines.keyword() {
        reader.line(keyword, &mut lines)?;
        lines.end_statement();
    }
    reader.unusual = lines.unusual;
    let drops = reader.faces.complete().map_err(|fault| fault.of(path))?;
    if reader.faces.triangles.iter().all(|triangle| triangle.vertices[0] == DROPPED) {
        if let Some(fault) = reader.faces.problems.nothing_left() {
            return Err(fault.of(path));
        }
        let problem = "there is no face: points and curves cannot be ray traced";
        return Err(Error::file(path, None, problem, "export it as a polygonal mesh"));
    }
    Ok(reader.finish(drops))
}

/// The material of a name.
struct NamedMaterial {
    index: u32,
    /// True if no library has defined the name; the material is then neutral.
    undefined: bool,
}

struct ObjReader<'a> {
    path: &'a Path,
    options: &'a Options,
    placement: Placement,
    faces: Faces,
    materials: Vec<Material>,
    /// Emission of each material.
    emission: Vec<Vec3>,
    /// Number of triangles of each material.
    triangles: Vec<usize>,
    names: HashMap<Vec<u8>, NamedMaterial>,
    /// Undefined names that may contain a comment.
    commented: Vec<Vec<u8>>,
    /// Canonical paths of the libraries that have been read.
    libraries: HashSet<PathBuf>,
    /// Names of libraries that have been searched, including whole lines after `mtllib`.
    tried: HashSet<Vec<u8>>,
    /// The folders that libraries must lie in; computed when the first library is named.
    folders: Option<SceneFolders>,
    /// Unsupported keywords.
    ignored: BTreeSet<String>,
    warnings: Warnings,
    textures: bool,
    /// The first line with a number in an unusual notation.
    unusual: Option<usize>,
}

impl<'a> ObjReader<'a> {
    fn new(path: &'a Path, options: &'a Options) -> ObjReader<'a> {
        ObjReader {
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
            folders: None,
            ignored: BTreeSet::new(),
            warnings: Warnings::default(),
            textures: false,
            unusual: None,
        }
    }

    fn line(&mut self, keyword: &[u8], lines: &mut Lines) -> Result<()> {
        match keyword {
            b"v" => {
                let line = lines.line();
                lines.position(self.placement.offset).map(|v| match is_valid(v) {
                    true => self.faces.positions.push(v),
                    false => self.faces.add_invalid(v, line, || place(self.path, line)),
                })
            }
            b"vn" => {
                let line = lines.line();
                let normal = lines.normal();
                if normal.is_none() {
                    self.faces.problems.normal.get_or_insert(line);
                }
                self.faces.normals.push(normal.unwrap_or(Vec3::ZERO));
                Ok(())
            }
            b"f" | b"fo" => {
                let (material, before) = (self.material(), self.faces.triangles.len());
                let read = self.faces.face(lines, material);
                let more = self.faces.triangles.len() - before;
                self.triangles[material as usize] += more;
                if self.emission[material as usize] != Vec3::ZERO {
                    self.faces.emissive += more;
                }
                read
            }
            b"vt" | b"vp" | b"g" | b"o" => Ok(()),
            b"s" => {
                let word = lines.word().map(|word| lines.before_comment(word)).unwrap_or_default();
                self.faces.set_smoothing(if word == b"off" { Smoothing::Flat } else { Smoothing::group(word) });
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

    /// The scene; `drops` tells that there are triangles to be dropped.
    fn finish(mut self, drops: bool) -> Scene {
        let (undefined, no_lamp) = (self.undefined(), self.no_lamp());
        let Faces { positions, normals: given, keys, triangles, problems, .. } = &mut self.faces;
        let mut bad = 0;
        let mut vertices: Vec<Vertex> = keys
            .iter()
            .map(|key| {
                let normal = |n: usize| given.get(n).map_or(Vec3::ZERO, |&normal| normals::unit(normal));
                let normal = key.normal().map_or(Vec3::ZERO, normal);
                bad += usize::from(key.normal().is_some() && normal == Vec3::ZERO);
                // A vertex that only ignored faces with fewer than three corners use may not exist.
                let position = positions.get(key.position as usize).copied().unwrap_or_default();
                Vertex::new(position, normal)
            })
            .collect();
        if drops || problems.has_invalid {
            drop_invalid(&mut vertices, triangles);
        }
        normals::normalise_or_smooth(&mut vertices, triangles);
        let lights = lamps::lights(&vertices, triangles, &self.emission);
        let material_names = material_names(self.names, self.materials.len());
        let (materials, placement) = (self.materials, self.placement);
        let mut scene = Scene { vertices, lights, materials, material_names, placement, ..Scene::default() };
        scene.triangles = self.faces.triangles;
        scene.warnings = self.warnings.lines();
        let problems = self.faces.problems.warnings(self.path, self.faces.normals.len(), self.unusual);
        let mut warn = |warning: String| scene.warnings.push(warning);
        no_lamp.into_iter().for_each(&mut warn);
        let list = |names: &BTreeSet<String>| names.iter().take(8).cloned().collect::<Vec<_>>().join(", ");
        if bad > 0 {
            warn(format!("{bad} normals in the file are zero or not finite: computed instead"));
        }
        problems.into_iter().for_each(&mut warn);
        if !undefined.is_empty() {
            warn(format!("materials that no library defines are neutral grey: {}", list(&undefined)));
        }
        if self.faces.small > 0 {
            warn(format!("{} faces with fewer than three corners ignored", self.faces.small));
        }
        if self.textures {
            warn("textures ignored: surfaces have their base colours".into());
        }
        if !self.ignored.is_empty() {
            warn(format!("unsupported statements ignored: {}", list(&self.ignored)));
        }
        scene
    }
}

/// The names of all materials by their indices; that of faces before the first `usemtl` is empty.
fn material_names(names: HashMap<Vec<u8>, NamedMaterial>, materials: usize) -> Vec<String> {
    let mut by_index = vec![String::new(); materials];
    for (name, NamedMaterial { index, .. }) in names {
        // What is not UTF-8 becomes replacement characters
        by_index[index as usize] =
            String::from_utf8(name).unwrap_or_else(|error| String::from_utf8_lossy(error.as_bytes()).into_owned());
    }
    by_index
}
