//! Loads scenes by name: files by their extension, folders and lists of files as one scene, built-in scenes, and scenes
//! of the catalogue.

use super::extent::Extent;
use super::options::settings as split;
use super::{
    FORMATS, Material, Options, Origin, ReadScene, Scene, Triangle, catalogue, did_you_mean, placement, procedural,
    sources,
};
use crate::error::{Error, Result};
use crate::names;
use glam::{DVec3, Vec3};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Loads a scene without a folder of scenes, see [`load_in`].
///
/// # Errors
/// Those of [`load_in`].
pub fn load(spec: &str) -> Result<Scene> {
    load_in(spec, None)
}

/// Loads a scene: a file, a folder or several files joined by `+` as one scene, a built-in scene, or a scene of the
/// catalogue with its file in `folder`. `spec` is `name[:key=value,...]`; see [`Options`] for the keys of files.
///
/// The name of a scene of the catalogue or of a built-in scene takes precedence over a file or folder of the same name
/// (`./bunny` names the folder). Any other name is a file if such a file exists, or if the name has a path separator or
/// a known extension.
///
/// # Errors
/// [`Error::Input`] if the name, an option or the file is not valid.
pub fn load_in(spec: &str, folder: Option<&Path>) -> Result<Scene> {
    let (name, settings) = split_settings(spec);
    if let Some(entry) = catalogue::find(name) {
        return load_entry(spec, entry, settings, folder);
    }
    let path = &*names::file(name);
    let built_in = is_built_in(spec);
    if !built_in && (reader_of(path).is_some() || name.contains(['/', std::path::MAIN_SEPARATOR]) || path.exists()) {
        let options = Options::parse(spec, settings)?;
        let mut scene = read(spec, name, settings, &options)?;
        scene.name = with_suffix(&scene.name, &options.suffix(&Options::default()));
        return finish(scene, name, &options);
    }
    if !built_in {
        return Err(unknown(spec));
    }
    let mut scene = procedural::build(spec)?;
    let extent = Extent::of(&scene);
    scene.complete(extent).map_err(|(problem, hint)| Error::argument(spec, problem, hint))?;
    scene.survey();
    Ok(scene)
}

/// True for the name of a built-in scene, with parameters or without.
pub(super) fn is_built_in(what: &str) -> bool {
    let bare = what.split(':').next().unwrap_or(what);
    procedural::list().iter().any(|info| info.name == bare)
}

/// Adds the option `time=...`, at which animated geometry is evaluated, to a scene's name. A scene without animation
/// ([`has_no_time`]) and a scene that already has a time are returned unchanged.
pub fn at_time(spec: &str, time: f64) -> String {
    let (name, settings) = split_settings(spec);
    if has_no_time(spec) || settings.split(',').any(|setting| setting.starts_with("time=")) {
        return spec.to_owned();
    }
    let comma = if settings.is_empty() { "" } else { "," };
    format!("{name}:{settings}{comma}time={time}")
}

/// True for built-in scenes, and for scenes of the catalogue in a format without animation.
pub fn has_no_time(spec: &str) -> bool {
    let timed =
        |path: &Path| format_of(path).is_some_and(|(_, _, supported_options)| supported_options.contains(&"time"));
    let entry = catalogue::find(split_settings(spec).0);
    is_built_in(spec) || entry.is_some_and(|entry| !entry.file.iter().any(|candidate| timed(&candidate.path)))
}

/// Loads a scene of the catalogue with the options of its entry; the user's settings override them.
fn load_entry(spec: &str, entry: &catalogue::Entry, settings: &str, folder: Option<&Path>) -> Result<Scene> {
    let path = entry.path_in(folder)?;
    let base = Options::parse(spec, &entry.options)?;
    let options = Options::parse(spec, &format!("{},{settings}", entry.options))?;
    let name = names::text(path.as_os_str());
    let mut scene = read(spec, &name, settings, &options)?;
    scene.name = format!("{}{}", entry.name, options.suffix(&base));
    let mut scene = finish(scene, &name, &options)?;
    if let Some(found) = entry.other_hash(&path)? {
        scene.warnings.push(format!("not the catalogue's file: the SHA-256 of {name} is {found}"));
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

/// Applies the options to a scene that was read from a file, checks it, and scales it to a comfortable extent.
fn finish(mut scene: Scene, place: &str, options: &Options) -> Result<Scene> {
    let path = &*names::file(place);
    // A cache holds a finished scene, which its reader has checked.
    if is_cache(path) && *options == Options::default() {
        return Ok(scene);
    }
    scene.transform(options.up, options.scale);
    match (options.fov, &mut scene.camera) {
        (Some(fov), Some(camera)) => camera.field_of_view = fov,
        (Some(_), None) => scene.warnings.push("fov: the option has no effect, because the file has no camera".into()),
        (None, _) => {}
    }
    let extent = Extent::of(&scene);
    let fault = |(problem, hint): (String, _)| Error::file(path, None, problem, hint);
    drop_lights(&mut scene, |position| position.is_finite());
    scene.complete(extent).map_err(fault)?;
    let bounds = scene.survey();
    scene.size_fault(bounds).map_or(Ok(()), |found| Err(fault(found)))?;
    scene.normalise(bounds);
    // Scaling can move a light out of the range of floats.
    drop_lights(&mut scene, |position| position.distance_squared(bounds.center()).is_finite());
    Ok(scene)
}

/// Drops the lights with other positions than those `allowed`, each with a warning.
fn drop_lights(scene: &mut Scene, allowed: impl Fn(Vec3) -> bool) {
    let Scene { lights, warnings, .. } = scene;
    let mut number = 0;
    lights.retain(|light| {
        number += 1;
        let keep = allowed(light.position);
        if !keep {
            let place = light.position;
            let extent = "too far away in relation to the scene's extent";
            warnings.push(format!("light {number} at {place} is {extent}: the light is ignored"));
        }
        keep
    });
}

/// The largest number of readings of a scene: a second time if it is far from the origin, and further times if its
/// extent was lost in the rounding of the first reading.
const READINGS: usize = 5;

/// Reads one file, a folder, or files joined by `+`. The scene's name is derived from the files' names, without
/// options.
fn read(spec: &str, name: &str, settings: &str, options: &Options) -> Result<Scene> {
    let files = parts(name)?;
    check_settings(spec, settings, &files)?;
    let whole = &*names::file(name);
    let folder = files.first() != Some(&whole.to_owned()) && whole.is_dir();
    if folder {
        sources::folder(whole, &files);
    }
    let mut options = options.clone();
    let mut readings = 1;
    let (scenes, moved) = loop {
        let scenes = if folder { read_folder(&files, &options)? } else { read_list(&files, &options)? };
        // A single cache keeps the placement that it was written with.
        let fixed = options.origin != Origin::Auto || files.len() == 1 && is_cache(&files[0]);
        let parts = scenes.iter().map(|(_, scene)| scene);
        match if fixed { None } else { placement::better_offset(parts) } {
            Some(offset) if readings < READINGS => (options.offset, readings) = (Some(offset), readings + 1),
            _ => break (scenes, !fixed && readings > 1),
        }
    };
    let names: Vec<String> = scenes.iter().map(|(file, scene)| own_name(file, scene)).collect();
    let taken: Vec<&str> = scenes.iter().filter_map(|(file, _)| file.file_name()?.to_str()).collect();
    let taken = (folder && 1 < taken.len()).then(|| format!("consists of {}", taken.join(", ")));
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

/// A warning about the scene's placement in memory, if there is a reason for one.
fn placement_warning(scene: &Scene, options: &Options, moved: bool) -> Option<String> {
    let offset = scene.placement.offset;
    if moved && offset != DVec3::ZERO {
        let point = offset.to_array().map(placement::number).join(",");
        return Some(format!(
            "the coordinates exceed {} times the extent: {point} is the origin while the scene is in memory \
            (origin=keep prevents this)",
            placement::FAR
        ));
    }
    if !matches!(options.origin, Origin::At(_)) {
        return None;
    }
    let distance = placement::distance(placement::used_bounds(scene));
    (distance > placement::FAR).then(|| {
        format!("the option origin= is {distance:.0} times the extent away from the scene: choose a point in it")
    })
}

/// Refuses options that none of the files' formats supports.
fn check_settings(spec: &str, settings: &str, files: &[PathBuf]) -> Result<()> {
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
            Err(Error::argument(spec, problem, format!("its options are {}", supported_options.join(", "))))
        }
    }
}

/// Refuses what a reading of files would refuse before it opens one; see [`super::probe`].
pub(super) fn check_file(what: &str, name: &str, settings: &str) -> Result<()> {
    let path = &*names::file(name);
    if !(reader_of(path).is_some() || name.contains(['/', std::path::MAIN_SEPARATOR]) || path.exists()) {
        return Err(unknown(what));
    }
    Options::parse(what, settings)?;
    let files = parts(name)?;
    check_settings(what, settings, &files)?;
    for file in &files {
        match reader_of(file) {
            Some(_) => super::regular_file(file).map(drop)?,
            // It says what is wrong, and reads nothing
            None => read_one(file, &Options::default()).map(drop)?,
        }
    }
    Ok(())
}

fn unknown(what: &str) -> Error {
    let bare = what.split(':').next().unwrap_or(what);
    let hint = format!("{}; or name a file such as mesh.ply", did_you_mean(bare, &catalogue::all_names()));
    Error::argument(what, format!("no file and no scene is called `{bare}`"), hint)
}

fn read_list(files: &[PathBuf], options: &Options) -> Result<Vec<(PathBuf, Scene)>> {
    let scene = |file: &PathBuf| read_one(file, options).map(|scene| (file.clone(), scene));
    files.iter().map(scene).collect()
}

/// Reads all files of a folder, except files that another one of them includes: those are already part of the scene.
fn read_folder(files: &[PathBuf], options: &Options) -> Result<Vec<(PathBuf, Scene)>> {
    let read = |file: &PathBuf| (sources::resolve_folder(file), sources::record(false, || read_one(file, options)));
    let read: Vec<_> = files.iter().map(read).collect();
    // A file with an error excludes no other file, so that the errors of files that include each other are reported.
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
        let warning = "several files of the folder include the same file: if they are versions of one scene, name one";
        scene.warnings.push(warning.into());
    }
    Ok(scenes)
}

/// The files of one scene: sorted by name for a folder, in the given order for a list.
fn parts(name: &str) -> Result<Vec<PathBuf>> {
    let path = &*names::file(name);
    if !path.exists() && name.contains('+') {
        return Ok(name.split('+').map(names::file).collect());
    }
    // The reader refuses a folder with the extension of a file.
    if path.is_dir() && reader_of(path).is_none() { files_of_folder(path) } else { Ok(vec![path.to_owned()]) }
}

/// The scene files in a folder, sorted by name. Caches are excluded, so that a cache of the folder can lie in it.
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
        (_, true) => ("it is a folder, but a list consists of files", "name its files, or the folder alone".to_owned()),
        _ => ("the format is unknown: the file's extension decides it", known()),
    };
    Err(Error::file(path, None, problem, hint))
}

fn extensions() -> String {
    FORMATS.iter().map(|(extension, ..)| *extension).collect::<Vec<_>>().join(", ")
}

fn is_cache(path: &Path) -> bool {
    path.is_file() && path.extension().is_some_and(|e| e.eq_ignore_ascii_case(super::cache::EXTENSION))
}

/// The entry of a file's format in [`FORMATS`].
fn format_of(path: &Path) -> Option<&'static (&'static str, ReadScene, &'static [&'static str])> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    FORMATS.iter().find(|(known, ..)| *known == extension)
}

fn reader_of(path: &Path) -> Option<ReadScene> {
    format_of(path).map(|(_, reader, _)| *reader)
}

/// Appends a scene to another one with the same placement. The camera and background of the first one have precedence.
fn append(scene: &mut Scene, mut other: Scene) {
    for part in [&mut *scene, &mut other] {
        // A scene without materials gets the neutral one, as it would if it were loaded alone.
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
    if !(scene.material_names.is_empty() && other.material_names.is_empty()) {
        scene.material_names.resize(scene.materials.len(), String::new());
        scene.material_names.extend(other.material_names);
        scene.material_names.resize(scene.materials.len() + other.materials.len(), String::new());
    }
    scene.materials.extend(other.materials);
    scene.lights.extend(other.lights);
    for warning in other.warnings {
        if !scene.warnings.contains(&warning) {
            scene.warnings.push(warning);
        }
    }
    scene.camera = scene.camera.take().or(other.camera);
}

/// The name of a scene from a file: the name in the file, which only caches have, otherwise that of its path.
fn own_name(file: &Path, scene: &Scene) -> String {
    if scene.name.is_empty() { names::of_file(file) } else { scene.name.clone() }
}

/// The name of a scene from a folder; one that ends in `.` or `..` is resolved.
fn folder_name(folder: &Path) -> String {
    let whole = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    names::of_file(if folder.file_name().is_some() { folder } else { &whole })
}

/// A name with a suffix of options; the name in a cache may already have options.
fn with_suffix(name: &str, suffix: &str) -> String {
    match suffix.strip_prefix(':') {
        Some(more) if name.contains(':') => format!("{name},{more}"),
        _ => format!("{name}{suffix}"),
    }
}

/// Name or path, and what follows its last colon if that is `key=value,...`; a file may have a colon in its name.
pub(super) fn split_settings(what: &str) -> (&str, &str) {
    match what.rsplit_once(':') {
        Some((name, settings)) if settings.contains('=') && !names::file(what).exists() => (name, settings),
        _ => (what, ""),
    }
}
