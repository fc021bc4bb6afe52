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
mod lines;
pub mod mtl;

use super::mesh_builder::Warnings;
use super::text::Home;
use super::{Material, Options, Scene, lamps, normals};
use crate::error::{Error, Result};
use crate::math::Vertex;
use face::{Faces, Smoothing};
use glam::Vec3;
use lines::{Lines, printable, without_comment};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::{Component, Path, PathBuf};

/// Names of each kind that warnings are to choose from.
const NAMES: usize = 16;

/// Most names of libraries: each of them is looked for.
const MAX_LIBRARIES: usize = 10_000;

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
            b"v" => lines.vector("a vertex").map(|v| self.faces.positions.push(v)),
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

    fn use_material(&mut self, name: Vec<u8>, line: usize) -> Result<(), Fault> {
        let plain = without_comment(&name);
        let index = match self.names.get(&name).or_else(|| self.names.get(plain)) {
            Some(named) => named.index,
            None => {
                let kept = self.faces.limits.keep(PER_MATERIAL + 2 * name.len());
                kept.map_err(|fault| Fault::new(line, fault.problem, "use fewer materials"))?;
                if plain.len() < name.len() {
                    self.commented.push(name.clone());
                }
                let index = self.add(name.clone(), Material::neutral(), Vec3::ZERO);
                self.names.insert(name, Named { index, guessed: true });
                index
            }
        };
        self.faces.material = Some(index);
        Ok(())
    }

    fn add(&mut self, name: Vec<u8>, material: Material, emission: Vec3) -> u32 {
        let index = self.materials.len() as u32;
        let (material, emission) = self.lit(&name, material, emission);
        self.materials.push(material);
        self.emission.push(emission);
        self.triangles.push(0);
        self.names.insert(name, Named { index, guessed: false });
        index
    }

    /// The material and what it gives off, with what the user says of it.
    fn lit(&self, name: &[u8], material: Material, emission: Vec3) -> (Material, Vec3) {
        let lamp = self.options.lamp.as_deref().is_some_and(|lamp| lamp.as_bytes() == name);
        let emission = if lamp && emission == Vec3::ZERO { material.diffuse } else { emission };
        (Material { ambient: material.ambient.max(emission.min(Vec3::ONE)), ..material }, emission)
    }

    /// A material of a library. The first of a name counts; later ones would change faces that are already there.
    fn define(&mut self, name: Vec<u8>, material: Material, emission: Vec3) {
        match self.names.get_mut(&name) {
            None => drop(self.add(name, material, emission)),
            Some(named) if named.guessed => {
                named.guessed = false;
                let index = named.index;
                self.fill(index, &name, material, emission);
            }
            Some(_) => {}
        }
    }

    /// Puts a material in the place of a neutral one.
    fn fill(&mut self, index: u32, name: &[u8], material: Material, emission: Vec3) {
        let index = index as usize;
        let (material, emission) = self.lit(name, material, emission);
        if self.emission[index] == Vec3::ZERO && emission != Vec3::ZERO {
            self.faces.shining += self.triangles[index];
        }
        (self.materials[index], self.emission[index]) = (material, emission);
    }

    /// Fills in materials whose names end with a comment, and that the library just read has without it.
    fn fill_commented(&mut self) {
        for name in std::mem::take(&mut self.commented) {
            let defined = self.names.get(without_comment(&name)).filter(|named| !named.guessed);
            let from = defined.map(|named| named.index as usize);
            match (self.names.get_mut(&name), from) {
                (Some(named), Some(from)) if named.guessed => {
                    named.guessed = false;
                    let index = named.index;
                    self.fill(index, &name, self.materials[from], self.emission[from]);
                }
                (Some(named), None) if named.guessed => self.commented.push(name),
                _ => {}
            }
        }
    }

    /// `mtllib`: one name that may have blanks, or several names.
    fn libraries(&mut self, lines: &mut Lines) -> Result<()> {
        let (line, text) = (lines.line(), lines.rest());
        if !self.is_new(&text, line)? {
            return Ok(());
        }
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let plain = without_comment(&text);
        if let Some(name) = [&text, plain].into_iter().find(|name| folder.join(file_name(name)).is_file()) {
            return self.library(name, line);
        }
        for name in plain.split(u8::is_ascii_whitespace).filter(|name| !name.is_empty()) {
            if *name == *text || self.is_new(name, line)? {
                self.library(name, line)?;
            }
        }
        Ok(())
    }

    /// False for a name that has been looked for.
    fn is_new(&mut self, name: &[u8], line: usize) -> Result<bool> {
        if self.tried.contains(name) {
            return Ok(false);
        }
        if self.tried.len() >= MAX_LIBRARIES {
            let problem = format!("more than {MAX_LIBRARIES} names of material libraries");
            return Err(Error::file(self.path, Some(line), problem, "put the materials into one library"));
        }
        Ok(self.tried.insert(name.to_vec()))
    }

    /// Reads the library of this name, if it is there.
    fn library(&mut self, name: &[u8], line: usize) -> Result<()> {
        let path = self.path.parent().unwrap_or(Path::new("")).join(file_name(name));
        if !self.options.outside {
            let leaves = file_name(name).components().any(|c| !matches!(c, Component::Normal(_) | Component::CurDir));
            if leaves || !self.home.get_or_insert_with(|| Home::of(self.path)).holds(&path) {
                let problem = format!("the library {} lies outside of the scene's folder", printable(name));
                return Err(Error::file(self.path, Some(line), problem, "allow it with the option outside=yes"));
            }
        }
        if !path.is_file() {
            super::sources::absent(&path);
            let name = printable(name);
            self.warnings.add(&format!("material library {name} is not there: its materials are neutral grey"));
            return Ok(());
        }
        // Read again, it would say nothing new
        if !self.libraries.insert(path.canonicalize().unwrap_or_else(|_| path.clone())) {
            return Ok(());
        }
        let bytes = super::read_file(&path)?;
        self.faces.read(bytes.len());
        let library = mtl::parse(&bytes).map_err(|fault| fault.of(&path))?;
        self.textures |= library.textures;
        for (name, material, emission) in library.materials {
            self.define(name, material, emission);
        }
        self.fill_commented();
        // More may shine than before
        self.faces.hold(line).map_err(|fault| fault.of(self.path))
    }

    /// The first in the alphabet of the names that no library has.
    fn unknown(&self) -> BTreeSet<String> {
        let mut unknown = BTreeSet::new();
        for name in self.names.iter().filter(|(_, named)| named.guessed).map(|(name, _)| name) {
            unknown.insert(printable(name));
            if unknown.len() > NAMES {
                unknown.pop_last();
            }
        }
        unknown
    }

    /// A warning if the user's lamp is not there. Of several files in a folder, which may be one scene, another may have it.
    fn no_lamp(&self) -> Option<String> {
        let lamp = self.options.lamp.as_ref().filter(|lamp| !self.names.contains_key(lamp.as_bytes()))?;
        let folder = self.path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let is_obj = |file: &Path| file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj"));
        let files = std::fs::read_dir(folder).ok()?.flatten().filter(|entry| is_obj(&entry.path()));
        if files.take(2).count() > 1 {
            return None;
        }
        let mut names: Vec<String> = self.names.keys().filter(|name| !name.is_empty()).map(|n| printable(n)).collect();
        names.sort_unstable();
        names.truncate(NAMES);
        let names = if names.is_empty() { "none has a name".into() } else { format!("there are {}", names.join(", ")) };
        Some(format!("lamp={lamp}: there is no such material, {names}"))
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
        let mut scene = Scene { vertices, lights, materials: self.materials, ..Scene::default() };
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

/// A name in the file as one of a file, whatever its encoding.
#[cfg(unix)]
fn file_name(name: &[u8]) -> &Path {
    use std::os::unix::ffi::OsStrExt;
    Path::new(std::ffi::OsStr::from_bytes(name))
}

/// A name in the file as one of a file; empty, and so no file's, if it is not UTF-8.
#[cfg(not(unix))]
fn file_name(name: &[u8]) -> &Path {
    Path::new(std::str::from_utf8(name).unwrap_or_default())
}
