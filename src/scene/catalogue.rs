//! The catalogue: published scenes by name. `scenes/catalog.toml` is embedded in the program; the scenes' files are
//! not, they are searched in a folder that the caller names.

use super::radiometry::Radiometry;
use super::{Light, Placement, did_you_mean, load, options, procedural};
use crate::error::{Error, Result};
use crate::guard;
use glam::Vec3;
use serde::Deserialize;
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

const TEXT: &str = include_str!("../../scenes/catalog.toml");

/// The two classes of scenes that the thesis of 2009 measured with different cameras.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Class {
    /// A single object: the camera or the light orbits around it.
    Object,
    /// An environment: the camera moves through it on a path.
    Walk,
}

/// A path inside the folder of scenes at which a scene's file is searched.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileLocation {
    /// Path of a file, or of a folder with the files of one scene, relative to the folder of scenes.
    pub path: PathBuf,
    /// SHA-256 of the file, hexadecimal, if it is known.
    pub sha256: Option<String>,
}

/// The official download of a scene, a `.tar.gz`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Archive {
    /// Address of the archive.
    pub url: String,
    /// SHA-256 of the archive, hexadecimal, if it is known.
    pub sha256: Option<String>,
    /// Path of the scene's file in the archive.
    pub member: PathBuf,
    /// Path of that file in the folder of scenes; it is one of [`Entry::file`].
    pub to: PathBuf,
}

/// A light that the catalogue adds to a scene.
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
    /// The name that `--scene` accepts and that records contain.
    pub name: String,
    /// Title for listings, one line.
    pub title: String,
    /// True if the thesis of 2009 measured it; the counts are then the published ones.
    #[serde(default)]
    pub published: bool,
    /// Decides the default camera.
    pub class: Class,
    /// Expected number of triangles.
    pub triangles: usize,
    /// Expected number of vertices, if known.
    pub vertices: Option<usize>,
    /// Number of lights in the measurements of the thesis, if published.
    pub lights: Option<usize>,
    /// Options of the structure `grid` that the thesis set for this scene.
    pub grid: Option<String>,
    /// Reading options, as after a file's name: `key=value,...`.
    #[serde(default)]
    pub options: String,
    /// Name of its camera path in `camera-paths/`.
    pub camera_path: Option<String>,
    /// Description of the source, with its address.
    pub source: String,
    /// Summary of the source's licence.
    pub licence: String,
    /// The authors to be credited.
    pub credit: String,
    /// Paths at which its file is searched, in this order.
    pub file: Vec<FileLocation>,
    /// The archive that `rtbench scenes fetch` downloads, if there is an official address.
    pub fetch: Option<Archive>,
    /// What light simulations need to know about it.
    pub radiometry: Option<Radiometry>,
    #[serde(default)]
    light: Vec<CatalogueLight>,
}

#[derive(Deserialize)]
struct Catalogue {
    scene: Vec<Entry>,
}

/// All scenes of the catalogue: those of the thesis in its order, then the others.
pub fn entries() -> &'static [Entry] {
    static ENTRIES: OnceLock<Vec<Entry>> = OnceLock::new();
    ENTRIES.get_or_init(|| {
        let catalogue: Catalogue = toml::from_str(TEXT).expect("the embedded catalogue is valid: a test reads it");
        catalogue.scene
    })
}

/// The entry of that name, if the catalogue has one.
pub fn find(name: &str) -> Option<&'static Entry> {
    entries().iter().find(|entry| entry.name == name)
}

/// The radiometry of the scene of this name or `name:key=value,...`. Lights and extent are in the coordinates of the
/// file as the catalogue reads it: with other options `up` or `scale` there is none.
pub fn radiometry(spec: &str) -> Option<&'static Radiometry> {
    let (name, settings) = load::split_settings(spec);
    let moves = |setting: &String| setting.starts_with("up=") || setting.starts_with("scale=");
    find(name)?.radiometry.as_ref().filter(|_| !options::settings(settings).iter().any(moves))
}

/// The entry of that name.
///
/// # Errors
/// [`Error::Input`] if the catalogue has no entry of that name.
pub fn get(name: &str) -> Result<&'static Entry> {
    find(name).ok_or_else(|| {
        let names: Vec<&str> = entries().iter().map(|entry| entry.name.as_str()).collect();
        Error::argument(name, "the catalogue has no scene of that name", did_you_mean(name, &names))
    })
}

/// The first of the entry's file locations that exists in `folder`.
pub fn locate(entry: &Entry, folder: &Path) -> Option<PathBuf> {
    entry.file.iter().map(|candidate| folder.join(&candidate.path)).find(|path| path.exists())
}

/// The SHA-256 of a file, hexadecimal.
///
/// # Errors
/// The file cannot be read.
pub(crate) fn sha256(path: &Path) -> std::io::Result<String> {
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
    /// The file or folder to load.
    ///
    /// # Errors
    /// [`Error::Input`] if no folder is given, or no file of the entry exists in it. The hint tells where to get the
    /// file.
    pub(crate) fn path_in(&self, folder: Option<&Path>) -> Result<PathBuf> {
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

    /// The SHA-256 that the catalogue has for the file at this path, if any.
    pub(crate) fn known_hash(&self, path: &Path) -> Option<&str> {
        self.file.iter().find(|candidate| path.ends_with(&candidate.path))?.sha256.as_deref()
    }

    /// The SHA-256 of the file at this path, if it differs from the one in the catalogue.
    ///
    /// # Errors
    /// [`Error::Input`] if the file cannot be read.
    pub(crate) fn other_hash(&self, path: &Path) -> Result<Option<String>> {
        let Some(known) = self.known_hash(path) else { return Ok(None) };
        let unreadable =
            |e| Error::file(path, None, format!("cannot be read: {e}"), "check the path and its permissions");
        if !path.is_file() {
            return Err(Error::file(path, None, "not a regular file", "name a file that holds a scene"));
        }
        guard::read(path);
        let found = sha256(path).map_err(unreadable)?;
        Ok((found != known).then_some(found))
    }

    /// The hint for a scene of which the file is absent.
    pub(crate) fn hint(&self) -> String {
        let place = format!("put its file there as {}", self.file[0].path.display());
        let folder = "--scenes-dir or RTBENCH_SCENES names the folder";
        match self.fetch {
            Some(_) => format!("{folder}; `rtbench scenes fetch {}` downloads it from {}", self.name, self.source),
            None => format!("{folder}; {place}, from {}", self.source),
        }
    }

    /// The lights that the catalogue adds to a file without lights, in the coordinates of a scene with this placement.
    pub(crate) fn lights(&self, placement: &Placement) -> Vec<Light> {
        let place = |position: [f32; 3]| placement.place(Vec3::from(position).as_dvec3());
        self.light.iter().map(|light| Light::new(place(light.position), Vec3::from(light.colour))).collect()
    }
}
