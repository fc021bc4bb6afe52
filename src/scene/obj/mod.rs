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
//! Materials: see [`mtl`]. Surfaces that shine become point lights: see [`super::lamps`].

mod face;
mod lines;
pub mod mtl;

use super::mesh_builder::Warnings;
use super::{Material, Options, Scene, lamps, normals};
use crate::error::{Error, Result};
use crate::math::Vertex;
use face::{Faces, Smoothing};
use glam::Vec3;
use lines::Lines;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::{Component, Path, PathBuf};

/// Names of each kind that warnings are to choose from.
const NAMES: usize = 16;

/// Memory per material, at most: itself and what it gives off in vectors that grow, its name in a table.
const PER_MATERIAL: usize = 256;

/// What is wrong at a line.
#[derive(Debug)]
pub(crate) struct Fault {
    line: usize,
    problem: String,
    mend: &'static str,
}

impl Fault {
    fn new(line: usize, problem: impl Into<String>, mend: &'static str) -> Fault {
        Fault { line, problem: problem.into(), mend }
    }

    fn of(self, path: &Path) -> Error {
        Error::file(path, Some(self.line), self.problem, self.mend)
    }
}

/// Reads the file and the material libraries that it names.
///
/// # Errors
/// [`Error::Input`] for whatever is wrong with one of them; a library that is not there is a warning.
pub fn read(path: &Path, options: &Options) -> Result<Scene> {
    read_bytes(path, &super::read_file(path)?, options)
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
        lines.skip_line();
    }
    if reader.faces.triangles.is_empty() {
        let problem = "there is no face: points and curves cannot be ray traced";
        return Err(Error::file(path, None, problem, "export it as a polygonal mesh"));
    }
    Ok(reader.finish())
}

struct Reader<'a> {
    path: &'a Path,
    options: &'a Options,
    faces: Faces,
    materials: Vec<Material>,
    /// Colour that a material gives off, by its index.
    emission: Vec<Vec3>,
    names: HashMap<Vec<u8>, u32>,
    /// Libraries that have been read.
    libraries: HashSet<PathBuf>,
    /// Names of materials that no library has.
    unknown: BTreeSet<String>,
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
            faces: Faces::default(),
            materials: Vec::new(),
            emission: Vec::new(),
            names: HashMap::new(),
            libraries: HashSet::new(),
            unknown: BTreeSet::new(),
            ignored: BTreeSet::new(),
            warnings: Warnings::default(),
            textures: false,
        }
    }

    fn line(&mut self, keyword: &[u8], lines: &mut Lines) -> Result<()> {
        match keyword {
            b"v" => lines.vector("a vertex").map(|v| self.faces.positions.push(v)),
            b"vn" => lines.normal().map(|v| self.faces.normals.push(v)),
            b"f" | b"fo" => {
                let (material, before) = (self.material(), self.faces.triangles.len());
                let read = self.faces.face(lines, material);
                if self.emission[material as usize] != Vec3::ZERO {
                    self.faces.shining += self.faces.triangles.len() - before;
                }
                read
            }
            b"vt" | b"vp" | b"g" | b"o" => Ok(()),
            b"s" => {
                let word = lines.rest();
                self.faces.smoothing(if word == b"off" { Smoothing::Flat } else { Smoothing::group(word) });
                Ok(())
            }
            b"usemtl" => {
                let (line, name) = (lines.line(), lines.rest().to_vec());
                self.use_material(name, line)
            }
            b"mtllib" => return self.libraries(lines),
            other => {
                if self.ignored.len() < NAMES {
                    self.ignored.insert(lines::printable(other));
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

    fn use_material(&mut self, name: Vec<u8>, line: usize) -> Result<(), Fault> {
        let index = match self.names.get(&name) {
            Some(&index) => index,
            None => {
                if self.unknown.len() < NAMES {
                    self.unknown.insert(lines::printable(&name));
                }
                let kept = self.faces.limits.keep(PER_MATERIAL + name.len());
                kept.map_err(|fault| Fault::new(line, fault.problem, "use fewer materials"))?;
                self.add(name, Material::neutral(), Vec3::ZERO)
            }
        };
        self.faces.material = Some(index);
        Ok(())
    }

    fn add(&mut self, name: Vec<u8>, material: Material, emission: Vec3) -> u32 {
        let index = self.materials.len() as u32;
        let lamp = self.options.lamp.as_deref().is_some_and(|lamp| lamp.as_bytes() == name);
        let emission = if lamp && emission == Vec3::ZERO { material.diffuse } else { emission };
        let material = Material { ambient: material.ambient.max(emission.min(Vec3::ONE)), ..material };
        self.materials.push(material);
        self.emission.push(emission);
        self.names.insert(name, index);
        index
    }

    /// `mtllib`: one name that may have blanks, or several names.
    fn libraries(&mut self, lines: &mut Lines) -> Result<()> {
        let line = lines.line();
        let text = lines::printable(lines.rest());
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let names: Vec<&str> = if folder.join(&text).is_file() { vec![&text] } else { text.split(' ').collect() };
        for name in names.into_iter().filter(|name| !name.is_empty()) {
            let leaves = Path::new(name).components().any(|c| !matches!(c, Component::Normal(_) | Component::CurDir));
            if leaves && !self.options.outside {
                let problem = format!("the library {name} lies outside of the scene's folder");
                return Err(Error::file(self.path, Some(line), problem, "allow it with the option outside=yes"));
            }
            let path = folder.join(name);
            if !path.is_file() {
                super::sources::absent(&path);
                self.warnings.add(&format!("material library {name} is not there: its materials are neutral grey"));
                continue;
            }
            // Read again, it would say nothing new
            if !self.libraries.insert(path.canonicalize().unwrap_or_else(|_| path.clone())) {
                continue;
            }
            let bytes = super::read_file(&path)?;
            self.faces.read(bytes.len());
            let library = mtl::parse(&bytes).map_err(|fault| fault.of(&path))?;
            self.textures |= library.textures;
            for (name, material, emission) in library.materials {
                // The first of a name counts; later ones would change faces that are already there.
                if !self.names.contains_key(&name) {
                    self.add(name, material, emission);
                }
            }
        }
        Ok(())
    }

    fn finish(self) -> Scene {
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
        let mut scene = Scene { vertices, lights, materials: self.materials, ..Scene::default() };
        scene.triangles = self.faces.triangles;
        scene.warnings = self.warnings.lines();
        let mut warn = |warning: String| scene.warnings.push(warning);
        let list = |names: &BTreeSet<String>| names.iter().take(8).cloned().collect::<Vec<_>>().join(", ");
        if bad > 0 {
            warn(format!("{bad} normals in the file are zero or not finite: computed instead"));
        }
        if !self.unknown.is_empty() {
            warn(format!("materials that no library has are neutral grey: {}", list(&self.unknown)));
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
