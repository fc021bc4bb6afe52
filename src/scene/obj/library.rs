//! `usemtl` and `mtllib`: materials by name, and the libraries that bring them.

use super::lines::{Lines, printable, without_comment};
use super::{Fault, NAMES, Named, Reader, mtl};
use crate::error::{Error, Result};
use crate::scene::text::Home;
use crate::scene::{Material, read_text, sources};
use glam::Vec3;
use std::collections::BTreeSet;
use std::path::{Component, Path};

/// Most names of libraries: each of them is looked for.
const MAX_LIBRARIES: usize = 10_000;

/// Memory per material, at most: itself and what it gives off in vectors that grow, its name in a table.
const PER_MATERIAL: usize = 256;

impl Reader<'_> {
    pub(super) fn use_material(&mut self, name: Vec<u8>, line: usize) -> Result<(), Fault> {
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

    pub(super) fn add(&mut self, name: Vec<u8>, material: Material, emission: Vec3) -> u32 {
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
    pub(super) fn libraries(&mut self, lines: &mut Lines) -> Result<()> {
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
            sources::absent(&path);
            let name = printable(name);
            self.warnings.add(&format!("material library {name} is not there: its materials are neutral grey"));
            return Ok(());
        }
        // Read again, it would say nothing new
        if !self.libraries.insert(path.canonicalize().unwrap_or_else(|_| path.clone())) {
            return Ok(());
        }
        let bytes = read_text(&path)?;
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
    pub(super) fn unknown(&self) -> BTreeSet<String> {
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
    pub(super) fn no_lamp(&self) -> Option<String> {
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
