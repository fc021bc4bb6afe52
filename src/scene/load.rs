//! Loading by name: files by their extension, folders and lists of files as one scene, built-in scenes, the catalogue.

use super::extent::Extent;
use super::{FORMATS, Material, Options, Reader, Scene, Triangle, catalogue, did_you_mean, procedural};
use crate::error::{Error, Result};
use std::path::{Path, PathBuf};

/// Loads a scene that needs no folder of scenes: see [`load_in`].
///
/// # Errors
/// Those of [`load_in`].
pub fn load(what: &str) -> Result<Scene> {
    load_in(what, None)
}

/// Loads a scene: a file by its extension, a folder or several files joined by `+` as one scene, a built-in scene, or a
/// scene of the catalogue whose file lies in `folder`; each as `name[:key=value,...]` (see [`Options`] for the keys of
/// files).
///
/// A name of the catalogue or of a built-in scene means just that, even where a file or folder is called the same
/// (write `./bunny` for the folder). Anything else is a file if there is one of that name, or if it has a path separator
/// or a known extension.
///
/// # Errors
/// [`Error::Input`] for whatever is wrong with the name, the parameters or the file.
pub fn load_in(what: &str, folder: Option<&Path>) -> Result<Scene> {
    let (name, settings) = split_settings(what);
    if let Some(entry) = catalogue::find(name) {
        return load_entry(what, entry, settings, folder);
    }
    let path = Path::new(name);
    let bare = what.split(':').next().unwrap_or(what);
    let built_in = is_built_in(what);
    if !built_in && (reader_of(path).is_some() || name.contains(['/', std::path::MAIN_SEPARATOR]) || path.exists()) {
        let options = Options::parse(what, settings)?;
        let mut scene = read(name, &options)?;
        if scene.name.is_empty() {
            scene.name = format!("{}{}", stem(name), options.suffix());
        }
        return finish(scene, name, &options);
    }
    if !built_in {
        let mend = format!("{}; or name a file such as mesh.ply", did_you_mean(bare, &catalogue::all_names()));
        return Err(Error::argument(what, format!("no file and no scene is called `{bare}`"), mend));
    }
    let mut scene = procedural::build(what)?;
    let extent = Extent::of(&scene);
    scene.complete(extent).map_err(|(problem, mend)| Error::argument(what, problem, mend))?;
    scene.count_degenerate();
    Ok(scene)
}

/// True for the name of a built-in scene, with parameters or without.
fn is_built_in(what: &str) -> bool {
    let bare = what.split(':').next().unwrap_or(what);
    procedural::list().iter().any(|info| info.name == bare)
}

/// The same scene with its moving geometry frozen at a time: `time=...` among the options behind its name. A built-in
/// scene, and a scene for which a time is given already, stay as they are.
pub fn at_time(what: &str, time: f64) -> String {
    let (name, settings) = split_settings(what);
    if is_built_in(what) || settings.split(',').any(|setting| setting.starts_with("time=")) {
        return what.to_owned();
    }
    let comma = if settings.is_empty() { "" } else { "," };
    format!("{name}:{settings}{comma}time={time}")
}

/// The file, folder or list behind `what`; `None` for a built-in scene.
pub(super) fn file_behind(what: &str, folder: Option<&Path>) -> Result<Option<String>> {
    let (name, _) = split_settings(what);
    if let Some(entry) = catalogue::find(name) {
        return Ok(Some(entry.path_in(folder)?.to_string_lossy().into_owned()));
    }
    Ok((!is_built_in(what)).then(|| name.to_owned()))
}

/// A scene of the catalogue: the file as its entry says, and what the user sets on top.
fn load_entry(what: &str, entry: &catalogue::Entry, settings: &str, folder: Option<&Path>) -> Result<Scene> {
    let path = entry.path_in(folder)?;
    let options = Options::parse(what, &format!("{},{settings}", entry.options))?;
    let name = path.to_string_lossy();
    let mut scene = read(&name, &options)?;
    scene.name = format!("{}{}", entry.name, Options::parse(what, settings)?.suffix());
    let mut scene = finish(scene, &name, &options)?;
    if scene.lights.is_empty() {
        scene.lights = entry.lights();
    }
    scene.camera_path = scene.camera_path.or_else(|| entry.camera_path.clone());
    let found = scene.triangles.len();
    if settings.is_empty() && found != entry.triangles {
        let warning = format!("{found} triangles, but the catalogue expects {}: is it another file?", entry.triangles);
        scene.warnings.push(warning);
    }
    Ok(scene)
}

/// What every scene from a file goes through.
fn finish(mut scene: Scene, place: &str, options: &Options) -> Result<Scene> {
    let path = Path::new(place);
    // A cache holds what has been through this; its reader has checked it again.
    if is_cache(path) && *options == Options::default() {
        return Ok(scene);
    }
    scene.transform(options.up, options.scale);
    match (options.fov, &mut scene.camera) {
        (Some(fov), Some(camera)) => camera.field_of_view = fov,
        (Some(_), None) => scene.warnings.push("fov: there is no camera in the file that it could change".into()),
        (None, _) => {}
    }
    let extent = Extent::of(&scene);
    scene.complete(extent).map_err(|(problem, mend)| Error::file(path, None, problem, mend))?;
    scene.count_degenerate();
    Ok(scene)
}

/// Reads one file, a folder, or files joined by `+`.
fn read(name: &str, options: &Options) -> Result<Scene> {
    let files = parts(name)?;
    let [first, others @ ..] = files.as_slice() else {
        let known = extensions();
        return Err(Error::file(
            Path::new(name),
            None,
            "the folder holds no file of a known format",
            format!("known extensions: {known}"),
        ));
    };
    let mut scene = read_one(first, options)?;
    if !others.is_empty() {
        scene.name.clear();
    }
    for file in others {
        append(&mut scene, read_one(file, options)?);
    }
    Ok(scene)
}

/// The files that make one scene, in the order of their names for a folder, as given for a list.
pub(super) fn parts(name: &str) -> Result<Vec<PathBuf>> {
    let path = Path::new(name);
    if !path.exists() && name.contains('+') {
        return Ok(name.split('+').map(PathBuf::from).collect());
    }
    // A folder called like a file is told so by the reader.
    if !path.is_dir() || reader_of(path).is_some() {
        return Ok(vec![path.to_owned()]);
    }
    let fault = |e: std::io::Error| Error::file(path, None, format!("cannot be read: {e}"), "check its permissions");
    let mut files = Vec::new();
    for entry in std::fs::read_dir(path).map_err(fault)? {
        let file = entry.map_err(fault)?.path();
        // A cache of the folder's own scene may lie in it.
        if file.is_file() && !is_cache(&file) && reader_of(&file).is_some() {
            files.push(file);
        }
    }
    files.sort();
    Ok(files)
}

fn read_one(path: &Path, options: &Options) -> Result<Scene> {
    let Some(reader) = reader_of(path) else {
        if !path.exists() {
            return Err(Error::file(path, None, "no such file", "check the path"));
        }
        return Err(Error::file(
            path,
            None,
            "the format is unknown: formats are told by the file's extension",
            format!("known extensions: {}", extensions()),
        ));
    };
    reader(path, options)
}

fn extensions() -> String {
    FORMATS.iter().map(|(extension, _)| *extension).collect::<Vec<_>>().join(", ")
}

fn is_cache(path: &Path) -> bool {
    path.is_file() && path.extension().is_some_and(|e| e.eq_ignore_ascii_case(super::cache::EXTENSION))
}

fn reader_of(path: &Path) -> Option<Reader> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    FORMATS.iter().find(|(known, _)| *known == extension).map(|(_, reader)| *reader)
}

/// Puts a scene behind another; the first camera and background stay.
fn append(scene: &mut Scene, mut other: Scene) {
    for part in [&mut *scene, &mut other] {
        // A part without materials gets the neutral one, as it would alone.
        if part.materials.is_empty() {
            part.materials.push(Material::neutral());
        }
    }
    let (vertices, materials) = (scene.vertices.len() as u32, scene.materials.len() as u32);
    scene.vertices.extend(other.vertices);
    scene.triangles.extend(other.triangles.iter().map(|t| Triangle {
        vertices: t.vertices.map(|v| v.saturating_add(vertices)),
        material: t.material.saturating_add(materials),
    }));
    scene.materials.extend(other.materials);
    scene.lights.extend(other.lights);
    for warning in other.warnings {
        if !scene.warnings.contains(&warning) {
            scene.warnings.push(warning);
        }
    }
    scene.camera = scene.camera.take().or(other.camera);
}

/// The stem of a file's or folder's name; of a list's first.
fn stem(name: &str) -> String {
    let first = Path::new(name.split('+').next().unwrap_or(name));
    let path = if Path::new(name).exists() { Path::new(name) } else { first };
    let stem = if path.is_dir() { path.file_name() } else { path.file_stem() };
    match stem {
        Some(stem) => stem.to_string_lossy().into_owned(),
        None => "scene".into(),
    }
}

/// Name or path, and what follows its last colon if that is `key=value,...`; a file may have a colon in its name.
fn split_settings(what: &str) -> (&str, &str) {
    match what.rsplit_once(':') {
        Some((name, settings)) if settings.contains('=') && !Path::new(what).exists() => (name, settings),
        _ => (what, ""),
    }
}
