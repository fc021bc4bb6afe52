//! Loading by name: files by their extension, folders and lists of files as one scene, built-in scenes, the catalogue.

use super::extent::Extent;
use super::options::settings as split;
use super::{
    FORMATS, Material, Options, Origin, Reader, Scene, Triangle, catalogue, did_you_mean, placement, procedural,
    sources,
};
use crate::error::{Error, Result};
use glam::DVec3;
use std::collections::HashSet;
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
        let mut scene = read(what, name, settings, &options)?;
        scene.name = with_suffix(&scene.name, &options.suffix(&Options::default()));
        return finish(scene, name, &options);
    }
    if !built_in {
        let hint = format!("{}; or name a file such as mesh.ply", did_you_mean(bare, &catalogue::all_names()));
        return Err(Error::argument(what, format!("no file and no scene is called `{bare}`"), hint));
    }
    let mut scene = procedural::build(what)?;
    let extent = Extent::of(&scene);
    scene.complete(extent).map_err(|(problem, hint)| Error::argument(what, problem, hint))?;
    scene.survey();
    Ok(scene)
}

/// True for the name of a built-in scene, with parameters or without.
fn is_built_in(what: &str) -> bool {
    let bare = what.split(':').next().unwrap_or(what);
    procedural::list().iter().any(|info| info.name == bare)
}

/// The same scene with its moving geometry frozen at a time: `time=...` among the options behind its name. What cannot
/// move ([`has_no_time`]), and a scene for which a time is given already, stay as they are.
pub fn at_time(what: &str, time: f64) -> String {
    let (name, settings) = split_settings(what);
    if has_no_time(what) || settings.split(',').any(|setting| setting.starts_with("time=")) {
        return what.to_owned();
    }
    let comma = if settings.is_empty() { "" } else { "," };
    format!("{name}:{settings}{comma}time={time}")
}

/// True for built-in scenes, and for scenes of the catalogue whose format knows no time.
pub fn has_no_time(what: &str) -> bool {
    let timed =
        |path: &Path| format_of(path).is_some_and(|(_, _, supported_options)| supported_options.contains(&"time"));
    let entry = catalogue::find(split_settings(what).0);
    is_built_in(what) || entry.is_some_and(|entry| !entry.file.iter().any(|candidate| timed(&candidate.path)))
}

/// A scene of the catalogue: the file as its entry says, and what the user sets on top.
fn load_entry(what: &str, entry: &catalogue::Entry, settings: &str, folder: Option<&Path>) -> Result<Scene> {
    let path = entry.path_in(folder)?;
    let base = Options::parse(what, &entry.options)?;
    let options = Options::parse(what, &format!("{},{settings}", entry.options))?;
    let name = path.to_string_lossy();
    let mut scene = read(what, &name, settings, &options)?;
    scene.name = format!("{}{}", entry.name, options.suffix(&base));
    let mut scene = finish(scene, &name, &options)?;
    if let Some(found) = entry.other_hash(&path)? {
        scene.warnings.push(format!("not the catalogue's file: the SHA-256 of {} is {found}", path.display()));
    }
    if scene.lights.is_empty() {
        scene.lights = entry.lights(&scene.placement);
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
    let fault = |(problem, hint): (String, _)| Error::file(path, None, problem, hint);
    scene.complete(extent).map_err(fault)?;
    let bounds = scene.survey();
    scene.size_fault(bounds).map_or(Ok(()), |found| Err(fault(found)))?;
    scene.normalise(bounds);
    // What is scaled may have left the range of floats
    if let Some(i) = scene.lights.iter().position(|light| !light.position.is_finite()) {
        return Err(fault((format!("light {i} is too far away for so small a scene"), "bring it nearer")));
    }
    Ok(scene)
}

/// Most readings of a scene: a second one where it is far from the origin, further ones where its extent was lost in
/// the rounding of the first.
const READINGS: usize = 5;

/// Reads one file, a folder, or files joined by `+`, and names the scene after them (without options).
fn read(what: &str, name: &str, settings: &str, options: &Options) -> Result<Scene> {
    let files = parts(name)?;
    check_settings(what, settings, &files)?;
    let whole = Path::new(name);
    let folder = files.first() != Some(&whole.to_owned()) && whole.is_dir();
    if folder {
        sources::folder(whole, &files);
    }
    let mut options = options.clone();
    let mut readings = 1;
    let (scenes, moved) = loop {
        let scenes = if folder { read_folder(&files, &options)? } else { read_list(&files, &options)? };
        // A cache alone has its place already, also where that is far away
        let fixed = options.origin != Origin::Auto || files.len() == 1 && is_cache(&files[0]);
        let parts = scenes.iter().map(|(_, scene)| scene);
        match if fixed { None } else { placement::better_offset(parts) } {
            Some(offset) if readings < READINGS => (options.offset, readings) = (Some(offset), readings + 1),
            _ => break (scenes, !fixed && readings > 1),
        }
    };
    let names: Vec<String> = scenes.iter().map(|(file, scene)| own_name(file, scene)).collect();
    let taken: Vec<&str> = scenes.iter().filter_map(|(file, _)| file.file_name()?.to_str()).collect();
    let taken = (folder && 1 < taken.len()).then(|| format!("made of {}", taken.join(", ")));
    let mut scenes = scenes.into_iter().map(|(_, scene)| scene);
    let Some(mut scene) = scenes.next() else {
        let hint = format!("known extensions: {}", extensions());
        return Err(Error::file(whole, None, "the folder holds no file of a known format", hint));
    };
    scenes.for_each(|other| append(&mut scene, other));
    scene.name = if folder { folder_name(whole) } else { names.join("+") };
    scene.warnings.extend(placement_warning(&scene, &options, moved));
    scene.warnings.extend(taken);
    Ok(scene)
}

/// What the user should know of where the scene was put.
fn placement_warning(scene: &Scene, options: &Options, moved: bool) -> Option<String> {
    let offset = scene.placement.offset;
    if moved && offset != DVec3::ZERO {
        let point = offset.to_array().map(placement::number).join(",");
        return Some(format!(
            "coordinates of more than {} times the extent: {point} is the origin while the scene is in memory \
            (origin=keep leaves it)",
            placement::FAR
        ));
    }
    if !matches!(options.origin, Origin::At(_)) {
        return None;
    }
    let distance = placement::distance(placement::used_bounds(scene));
    (distance > placement::FAR)
        .then(|| format!("the origin that was given is {distance:.0} times the extent away: choose one in the scene"))
}

/// Refuses options that none of the files' formats heeds.
fn check_settings(what: &str, settings: &str, files: &[PathBuf]) -> Result<()> {
    let formats: Vec<_> = files.iter().filter_map(|file| format_of(file)).collect();
    let [(extension, ..), ..] = formats.as_slice() else { return Ok(()) };
    let mut supported_options = Options::COMMON.to_vec();
    supported_options.extend(formats.iter().flat_map(|(_, _, supported_options)| supported_options.iter()));
    supported_options.dedup();
    let key = |setting: &str| setting.split('=').next().unwrap_or(setting).to_owned();
    match split(settings).iter().map(|s| key(s)).find(|key| !supported_options.contains(&key.as_str())) {
        None => Ok(()),
        Some(key) => {
            let cache =
                if *extension == super::cache::EXTENSION { ": give it to `rtbench scenes convert`" } else { "" };
            let problem = format!("a .{extension} file has no option `{key}`{cache}");
            Err(Error::argument(what, problem, format!("its options are {}", supported_options.join(", "))))
        }
    }
}

fn read_list(files: &[PathBuf], options: &Options) -> Result<Vec<(PathBuf, Scene)>> {
    let scene = |file: &PathBuf| read_one(file, options).map(|scene| (file.clone(), scene));
    files.iter().map(scene).collect()
}

/// Reads all files of a folder but those that another of them includes: these are in the scene already, where and as often
/// as that file wants them.
fn read_folder(files: &[PathBuf], options: &Options) -> Result<Vec<(PathBuf, Scene)>> {
    let read = |file: &PathBuf| (sources::whole(file), sources::record(false, || read_one(file, options)));
    let read: Vec<_> = files.iter().map(read).collect();
    // A file that is broken speaks for itself alone: of two that include each other, none is left out.
    let sound = read.iter().filter(|(_, (scene, _))| scene.is_ok());
    let included: HashSet<PathBuf> = sound
        .flat_map(|(file, (_, sources))| sources.iter().map(|source| &source.path).filter(move |path| *path != file))
        .cloned()
        .collect();
    let (mut scenes, mut shared, mut seen) = (Vec::new(), false, HashSet::new());
    for (file, (whole, (scene, sources))) in files.iter().zip(read).filter(|(_, (whole, _))| !included.contains(whole))
    {
        scenes.push((file.clone(), scene?));
        let parts = sources.into_iter().map(|source| source.path).filter(|path| *path != whole);
        for part in parts.filter(|path| format_of(path).is_some()) {
            shared |= !seen.insert(part);
        }
    }
    if shared && let Some((_, scene)) = scenes.first_mut() {
        let warning = "several files of the folder include the same ones: if they are versions of one scene, name one";
        scene.warnings.push(warning.into());
    }
    Ok(scenes)
}

/// The files that make one scene, in the order of their names for a folder, as given for a list.
fn parts(name: &str) -> Result<Vec<PathBuf>> {
    let path = Path::new(name);
    if !path.exists() && name.contains('+') {
        return Ok(name.split('+').map(PathBuf::from).collect());
    }
    // A folder called like a file is told so by the reader.
    if path.is_dir() && reader_of(path).is_none() { files_of_folder(path) } else { Ok(vec![path.to_owned()]) }
}

/// The files of a folder that make a scene, in the order of their names. A cache of the folder's own scene may lie in it.
pub(super) fn files_of_folder(path: &Path) -> Result<Vec<PathBuf>> {
    let fault = |e: std::io::Error| Error::file(path, None, format!("cannot be read: {e}"), "check its permissions");
    let mut files = Vec::new();
    for entry in std::fs::read_dir(path).map_err(fault)? {
        let file = entry.map_err(fault)?.path();
        if file.is_file() && !is_cache(&file) && reader_of(&file).is_some() {
            files.push(file);
        }
    }
    files.sort();
    Ok(files)
}

fn read_one(path: &Path, options: &Options) -> Result<Scene> {
    if let Some(reader) = reader_of(path) {
        return reader(path, options);
    }
    let known = || format!("known extensions: {}", extensions());
    let (problem, hint) = match (path.exists(), path.is_dir()) {
        (false, _) => ("no such file", "check the path".to_owned()),
        (_, true) => ("it is a folder, and a list is one of files", "name its files, or the folder alone".to_owned()),
        _ => ("the format is unknown: formats are told by the file's extension", known()),
    };
    Err(Error::file(path, None, problem, hint))
}

fn extensions() -> String {
    FORMATS.iter().map(|(extension, ..)| *extension).collect::<Vec<_>>().join(", ")
}

fn is_cache(path: &Path) -> bool {
    path.is_file() && path.extension().is_some_and(|e| e.eq_ignore_ascii_case(super::cache::EXTENSION))
}

/// The line of a file's format in [`FORMATS`].
fn format_of(path: &Path) -> Option<&'static (&'static str, Reader, &'static [&'static str])> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    FORMATS.iter().find(|(known, ..)| *known == extension)
}

fn reader_of(path: &Path) -> Option<Reader> {
    format_of(path).map(|(_, reader, _)| *reader)
}

/// Puts a scene behind another with the same placement; the first camera and background stay.
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

/// What a file's scene is called: as it says itself (a cache does), or like the file.
fn own_name(file: &Path, scene: &Scene) -> String {
    match file.file_stem() {
        _ if !scene.name.is_empty() => scene.name.clone(),
        Some(stem) => stem.to_string_lossy().into_owned(),
        None => "scene".into(),
    }
}

/// What a folder's scene is called, `.` being as good as its name.
fn folder_name(folder: &Path) -> String {
    let whole = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    folder.file_name().or(whole.file_name()).map_or("scene".into(), |name| name.to_string_lossy().into_owned())
}

/// A name and more options behind it; that of a cache may have some already.
fn with_suffix(name: &str, suffix: &str) -> String {
    match suffix.strip_prefix(':') {
        Some(more) if name.contains(':') => format!("{name},{more}"),
        _ => format!("{name}{suffix}"),
    }
}

/// Name or path, and what follows its last colon if that is `key=value,...`; a file may have a colon in its name.
fn split_settings(what: &str) -> (&str, &str) {
    match what.rsplit_once(':') {
        Some((name, settings)) if settings.contains('=') && !Path::new(what).exists() => (name, settings),
        _ => (what, ""),
    }
}
