//! The catalogue: real scenes by name (`scenes/catalog.toml`, part of the program). Their files are not part of it; they
//! are looked for in a folder that the caller names.

use super::{Light, Placement, did_you_mean, procedural};
use crate::error::{Error, Result};
use glam::Vec3;
use serde::Deserialize;
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

const TEXT: &str = include_str!("../../scenes/catalog.toml");

/// How a scene is looked at (SPEC section 8).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Class {
    /// A single object: the camera or the light turns once around it.
    Object,
    /// A place: a camera path leads through it.
    Walk,
}

/// A place inside the folder of scenes where a scene may lie.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Candidate {
    /// A file, or a folder that is one scene as a whole.
    pub path: PathBuf,
    /// SHA-256 of the file, hexadecimal, where it is known.
    pub sha256: Option<String>,
}

/// Where a scene is officially to be had, as a `.tar.gz`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Archive {
    /// Its address.
    pub url: String,
    /// SHA-256 of the archive, hexadecimal, where it is known.
    pub sha256: Option<String>,
    /// The scene's file inside of it.
    pub member: PathBuf,
    /// Where that file goes inside the folder of scenes: one of the entry's candidates.
    pub to: PathBuf,
}

/// A light of the catalogue's.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct CatalogueLight {
    position: [f32; 3],
    colour: [f32; 3],
}

/// A scene of the catalogue.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// As given to `--scene`, and as it stands in records.
    pub name: String,
    /// One line for people.
    pub title: String,
    /// True if the thesis measured it; the counts are then the published ones.
    #[serde(default)]
    pub published: bool,
    /// How it is looked at.
    pub class: Class,
    /// Triangles that it has.
    pub triangles: usize,
    /// Vertices that it has, where known.
    pub vertices: Option<usize>,
    /// Lights that it is measured with, where published.
    pub lights: Option<usize>,
    /// Options of the structure `grid` that the thesis set by hand.
    pub grid: Option<String>,
    /// How the file is to be read, as behind a file's name.
    #[serde(default)]
    pub options: String,
    /// The camera path in `camera-paths/` that was made for it.
    pub camera_path: Option<String>,
    /// Where it comes from, in words.
    pub source: String,
    /// What the source says about its use, in our words.
    pub licence: String,
    /// Whom to name.
    pub credit: String,
    /// Where it may lie inside the folder of scenes.
    pub file: Vec<Candidate>,
    /// What `rtbench scenes fetch` downloads, where there is an official address.
    pub fetch: Option<Archive>,
    #[serde(default)]
    light: Vec<CatalogueLight>,
}

#[derive(Deserialize)]
struct Catalogue {
    scene: Vec<Entry>,
}

/// All scenes of the catalogue: the thesis's, in its order, then others.
pub fn entries() -> &'static [Entry] {
    static ENTRIES: OnceLock<Vec<Entry>> = OnceLock::new();
    ENTRIES.get_or_init(|| {
        let catalogue: Catalogue = toml::from_str(TEXT).expect("the embedded catalogue is sound: a test reads it");
        catalogue.scene
    })
}

/// The scene of that name.
pub fn find(name: &str) -> Option<&'static Entry> {
    entries().iter().find(|entry| entry.name == name)
}

/// The scene of that name.
///
/// # Errors
/// [`Error::Input`] if there is none.
pub fn get(name: &str) -> Result<&'static Entry> {
    find(name).ok_or_else(|| {
        let names: Vec<&str> = entries().iter().map(|entry| entry.name.as_str()).collect();
        Error::argument(name, "the catalogue has no scene of that name", did_you_mean(name, &names))
    })
}

/// The first of a scene's candidates that exists in `folder`.
pub fn locate(entry: &Entry, folder: &Path) -> Option<PathBuf> {
    entry.file.iter().map(|candidate| folder.join(&candidate.path)).find(|path| path.exists())
}

/// The SHA-256 of a file, hexadecimal.
///
/// # Errors
/// It cannot be read.
pub fn sha256(path: &Path) -> std::io::Result<String> {
    let (mut file, mut hasher, mut buffer) = (File::open(path)?, Sha256::new(), vec![0; 1 << 18]);
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()),
            read => hasher.update(&buffer[..read]),
        }
    }
}

/// The names that can be given to `--scene`: built-in scenes and the catalogue.
pub(super) fn all_names() -> Vec<&'static str> {
    let built_in = procedural::list().into_iter().map(|info| info.name);
    built_in.chain(entries().iter().map(|entry| entry.name.as_str())).collect()
}

impl Entry {
    /// The file or folder to load, or an error that says what is absent and where to get it.
    ///
    /// # Errors
    /// [`Error::Input`] if no folder is given, or none of the candidates is there.
    pub fn path_in(&self, folder: Option<&Path>) -> Result<PathBuf> {
        let absent = |problem: String| Err(Error::argument(&self.name, problem, self.hint()));
        let Some(folder) = folder else {
            return absent("it is a scene of the catalogue, but no folder of scenes is given".into());
        };
        if !folder.is_dir() {
            return absent(format!("the folder of scenes {} does not exist", folder.display()));
        }
        match locate(self, folder) {
            Some(path) => Ok(path),
            None => absent(format!("{} has no {}", folder.display(), self.file[0].path.display())),
        }
    }

    /// The SHA-256 that the catalogue knows for the candidate at this path, if it does.
    pub fn known_hash(&self, path: &Path) -> Option<&str> {
        self.file.iter().find(|candidate| path.ends_with(&candidate.path))?.sha256.as_deref()
    }

    /// The SHA-256 of the candidate at this path, if it is not the one that the catalogue knows.
    ///
    /// # Errors
    /// [`Error::Input`] if the file cannot be read.
    pub fn other_hash(&self, path: &Path) -> Result<Option<String>> {
        let Some(known) = self.known_hash(path) else { return Ok(None) };
        let unreadable =
            |e| Error::file(path, None, format!("cannot be read: {e}"), "check the path and its permissions");
        if !path.is_file() {
            return Err(Error::file(path, None, "not a regular file", "name a file that holds a scene"));
        }
        let found = sha256(path).map_err(unreadable)?;
        Ok((found != known).then_some(found))
    }

    /// What to do about an absent scene.
    pub fn hint(&self) -> String {
        let place = format!("put it there as {}", self.file[0].path.display());
        let folder = "--scenes-dir or RTBENCH_SCENES name the folder";
        match self.fetch {
            Some(_) => format!("{folder}; `rtbench scenes fetch {}` gets it from {}", self.name, self.source),
            None => format!("{folder}; {place}, from {}", self.source),
        }
    }

    /// The lights that the catalogue gives to a file without any, for a scene that is placed so.
    pub fn lights(&self, placement: &Placement) -> Vec<Light> {
        let place = |position: [f32; 3]| placement.place(Vec3::from(position).as_dvec3());
        self.light.iter().map(|light| Light::new(place(light.position), Vec3::from(light.colour))).collect()
    }
}
