//! The statements `usemtl` and `mtllib`: materials by name, and material libraries.

use super::lines::{Lines, printable, without_comment};
use super::{Fault, NAMES, NamedMaterial, ObjReader, mtl};
use crate::error::{Error, Result};
use crate::scene::text::{SceneFolders, place, refuse_zeros};
use crate::scene::{Material, read_text, sources};
use glam::Vec3;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The largest number of names of libraries, each of which is searched.
const MAX_LIBRARIES: usize = 10_000;

/// Upper bound of the memory per material in bytes, without its name: material and emission in growing vectors, an
/// entry in a map, and one in the list of names.
const PER_MATERIAL: usize = 256;

impl ObjReader<'_> {
    pub(super) fn use_material(&mut self, name: Vec<u8>, line: usize) -> Result<(), Fault> {
        let plain = without_comment(&name);
        let index = match self.names.get(&name).or_else(|| self.names.get(plain)) {
            Some(named) => named.index,
            None => {
                let kept = self.faces.limits.keep(PER_MATERIAL + 4 * name.len());
                kept.map_err(|fault| Fault::new(line, fault.problem, "use fewer materials"))?;
                if plain.len() < name.len() {
                    self.commented.push(name.clone());
                }
                let index = self.add(name.clone(), Material::neutral(), Vec3::ZERO);
                self.names.insert(name, NamedMaterial { index, undefined: true });
                index
            }
        };
        self.faces.material = Some(index);
        Ok(())
    }

    pub(super) fn add(&mut self, name: Vec<u8>, material: Material, emission: Vec3) -> u32 {
        let index = self.materials.len() as u32;
        let (material, emission) = self.apply_lamp(&name, material, emission);
        self.materials.push(material);
        self.emission.push(emission);
        self.triangles.push(0);
        self.names.insert(name, NamedMaterial { index, undefined: false });
        index
    }

    /// The material and its emission, after the option `lamp` has been applied.
    fn apply_lamp(&self, name: &[u8], material: Material, emission: Vec3) -> (Material, Vec3) {
        let lamp = self.options.lamp.as_deref().is_some_and(|lamp| lamp.as_bytes() == name);
        let emission = if lamp && emission == Vec3::ZERO { material.diffuse } else { emission };
        (Material { ambient: material.ambient.max(emission.min(Vec3::ONE)), ..material }, emission)
    }

    /// Defines a material of a library. Of several with the same name the first is used.
    fn define(&mut self, name: Vec<u8>, material: Material, emission: Vec3) {
        match self.names.get_mut(&name) {
            None => drop(self.add(name, material, emission)),
            Some(named) if named.undefined => {
                named.undefined = false;
                let index = named.index;
                self.replace(index, &name, material, emission);
            }
            Some(_) => {}
        }
    }

    /// Replaces the neutral material of an undefined name.
    fn replace(&mut self, index: u32, name: &[u8], material: Material, emission: Vec3) {
        let index = index as usize;
        let (material, emission) = self.apply_lamp(name, material, emission);
        if self.emission[index] == Vec3::ZERO && emission != Vec3::ZERO {
            self.faces.emissive += self.triangles[index];
        }
        (self.materials[index], self.emission[index]) = (material, emission);
    }

    /// Replaces undefined materials with a comment after their name, if the last library defines the name without it.
    fn replace_commented(&mut self) {
        for name in std::mem::take(&mut self.commented) {
            let defined = self.names.get(without_comment(&name)).filter(|named| !named.undefined);
            let from = defined.map(|named| named.index as usize);
            match (self.names.get_mut(&name), from) {
                (Some(named), Some(from)) if named.undefined => {
                    named.undefined = false;
                    let index = named.index;
                    self.replace(index, &name, self.materials[from], self.emission[from]);
                }
                (Some(named), None) if named.undefined => self.commented.push(name),
                _ => {}
            }
        }
    }

    /// Reads the libraries of `mtllib`: one name, which may contain blanks, or several names.
    pub(super) fn libraries(&mut self, lines: &mut Lines) -> Result<()> {
        let (line, text) = (lines.line(), lines.rest());
        if !self.is_new(&text, line)? {
            return Ok(());
        }
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let plain = without_comment(&text);
        if let Some(name) = [&text, plain].into_iter().find(|name| find(folder, name).is_some()) {
            return self.library(name, line);
        }
        for name in plain.split(u8::is_ascii_whitespace).filter(|name| !name.is_empty()) {
            if *name == *text || self.is_new(name, line)? {
                self.library(name, line)?;
            }
        }
        Ok(())
    }

    /// True for a name of a library that has not been searched yet; marks it as searched.
    fn is_new(&mut self, name: &[u8], line: usize) -> Result<bool> {
        if self.tried.contains(name) {
            return Ok(false);
        }
        if self.tried.len() >= MAX_LIBRARIES {
            let problem = format!("there are more than {MAX_LIBRARIES} names of material libraries");
            return Err(Error::file(self.path, Some(line), problem, "put the materials into one library"));
        }
        Ok(self.tried.insert(name.to_vec()))
    }

    /// Reads the library of this name, if it exists.
    fn library(&mut self, name: &[u8], line: usize) -> Result<()> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let place = place(self.path, line);
        let Some(path) = find(folder, name) else {
            sources::absent(&folder.join(file_name(name)));
            let warning =
                format!("{place}: material library {} does not exist: its materials are neutral grey", printable(name));
            self.warnings.add(&warning);
            return Ok(());
        };
        if !self.options.outside && !self.folders.get_or_insert_with(|| SceneFolders::of(self.path)).contain(&path) {
            let problem = format!("the library {} lies outside of the scene's folder", printable(name));
            return Err(Error::file(self.path, Some(line), problem, "allow it with the option outside=yes"));
        }
        // A library is read once.
        if !self.libraries.insert(path.canonicalize().unwrap_or_else(|_| path.clone())) {
            return Ok(());
        }
        let text = read_text(&path).and_then(|bytes| match refuse_zeros(&bytes) {
            Ok(()) => Ok(bytes),
            Err(fault) => Err(fault.of(&path)),
        });
        let bytes = match text {
            Ok(bytes) => bytes,
            Err(error) => {
                let name = printable(name);
                self.warnings.add(&format!("{place}: material library {name} cannot be read, it is ignored: {error}"));
                return Ok(());
            }
        };
        self.faces.read(bytes.len());
        let library = mtl::parse(&bytes, |fault: Fault| {
            let place = self::place(&path, fault.line);
            self.warnings.add(&format!("{place}: {}: the line is ignored", fault.problem));
        });
        self.textures |= library.textures;
        for (name, material, emission) in library.materials {
            self.define(name, material, emission);
        }
        self.replace_commented();
        // There may be more emissive triangles than before.
        self.faces.check_memory(line).map_err(|fault| fault.of(self.path))
    }

    /// The alphabetically first names that no library defines.
    pub(super) fn undefined(&self) -> BTreeSet<String> {
        let mut undefined = BTreeSet::new();
        for name in self.names.iter().filter(|(_, named)| named.undefined).map(|(name, _)| name) {
            undefined.insert(printable(name));
            if undefined.len() > NAMES {
                undefined.pop_last();
            }
        }
        undefined
    }

    /// A warning if the material of the option `lamp` does not exist. There is none if the folder has several OBJ
    /// files, because they may be one scene, of which another file has the material.
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

/// The path of the library of this name, if it exists; backslashes may separate folders.
fn find(folder: &Path, name: &[u8]) -> Option<PathBuf> {
    let path = folder.join(file_name(name));
    if path.is_file() {
        return Some(path);
    }
    let slashes: Vec<u8> = name.iter().map(|&b| if b == b'\\' { b'/' } else { b }).collect();
    let path = folder.join(file_name(&slashes));
    (slashes != name && path.is_file()).then_some(path)
}

/// Converts a name in the file to a path; any encoding is possible.
#[cfg(unix)]
fn file_name(name: &[u8]) -> &Path {
    use std::os::unix::ffi::OsStrExt;
    Path::new(std::ffi::OsStr::from_bytes(name))
}

/// Converts a name in the file to a path; the path is empty if the name is not UTF-8.
#[cfg(not(unix))]
fn file_name(name: &[u8]) -> &Path {
    Path::new(std::str::from_utf8(name).unwrap_or_default())
}
