//! Results of [`super::path_traced`] on disk: they cost seconds to minutes, and each is a pure function of scene, view
//! and effort.
//!
//! A file is a line of text with a name, the key and a checksum, then the result as JSON. The key is a BLAKE3 hash of
//! all that decides the result, and the checksum is one of the JSON. What is broken, cut off or foreign is computed
//! again and replaced, with a warning.

use super::path_traced::{Effort, PathTraced, View, trace};
use crate::device::Interrupted;
use crate::error::Result;
use crate::record::files;
use crate::workloads::trace::backend::Prepared;
use glam::DVec3;
use rayon::ThreadPool;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// What every file begins with. The number changes with the estimator and with the layout.
const MAGIC: &str = "rtbench path-traced 1";

/// The largest file of a view with this many pixels: a pixel has seven numbers of at most 25 characters.
fn most_bytes(pixels: usize) -> u64 {
    4096 + 256 * pixels as u64
}

/// The hash of all that decides a result, hexadecimal.
pub fn key(view: &View, effort: Effort) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut add = |bytes: &[u8]| {
        hasher.update(&(bytes.len() as u64).to_le_bytes());
        hasher.update(bytes);
    };
    add(MAGIC.as_bytes());
    add(view.lit.scene.content_hash().as_bytes());
    for light in &view.lit.lights {
        add(bytemuck::bytes_of(&light.position));
        add(bytemuck::bytes_of(&light.flux));
    }
    add(bytemuck::cast_slice(&[view.lit.epsilon(), view.lit.reach()]));
    add(bytemuck::cast_slice(&[view.camera.position, view.camera.direction, view.camera.up]));
    add(&view.camera.field_of_view.to_le_bytes());
    add(bytemuck::cast_slice(&[view.size.width, view.size.height, view.hits]));
    add(bytemuck::cast_slice(view.pixels));
    add(bytemuck::cast_slice(&[effort.least, effort.most]));
    add(&effort.error.to_le_bytes());
    add(&effort.seed.to_le_bytes());
    hasher.finalize().to_hex().to_string()
}

/// The file of a key in a folder.
pub fn path(folder: &Path, key: &str) -> PathBuf {
    folder.join(format!("path-traced-{key}.json"))
}

/// The file's bytes for a result as JSON.
pub fn seal(key: &str, json: &[u8]) -> Vec<u8> {
    let mut bytes = format!("{MAGIC} {key} {}\n", blake3::hash(json).to_hex()).into_bytes();
    bytes.extend_from_slice(json);
    bytes
}

/// The result in a file's bytes, or what is wrong with them. A result fits the view and is finite.
///
/// # Errors
/// A problem in words.
pub fn read(bytes: &[u8], key: &str, pixels: &[u32]) -> std::result::Result<PathTraced, String> {
    let line = bytes.iter().position(|&byte| byte == b'\n').ok_or("it has no first line")?;
    let (first, json) = (&bytes[..=line], &bytes[line + 1..]);
    if !first.starts_with(MAGIC.as_bytes()) {
        return Err("it was not written by this version".into());
    }
    if seal(key, json)[..] != *bytes {
        return Err("its key or its checksum is wrong".into());
    }
    let result: PathTraced = serde_json::from_slice(json).map_err(|_| "it cannot be parsed".to_string())?;
    let lengths = [result.pixels.len(), result.irradiance.len(), result.error.len()];
    if result.pixels != pixels || lengths != [pixels.len(); 3] || result.paths < 2 {
        return Err("it belongs to another view".into());
    }
    if !is_sound(&result) {
        return Err("it holds a number that is not finite or negative".into());
    }
    Ok(result)
}

/// True if all numbers are finite and none is negative.
fn is_sound(result: &PathTraced) -> bool {
    let sound = |v: &DVec3| v.is_finite() && v.min_element() >= 0.0;
    let means = [result.mean, result.mean_error, DVec3::splat(result.sum_error)];
    result.irradiance.iter().all(sound) && result.error.iter().all(sound) && means.iter().all(sound)
}

/// The result of a view: from its file in `folder` if that is whole, else traced and written there. With it come
/// warnings: why a file was not used or not written.
///
/// # Errors
/// Those of [`trace`], whose threads are those of `pool` and the caster's.
pub fn path_traced(
    pool: &ThreadPool,
    folder: &Path,
    caster: &mut dyn Prepared,
    view: &View,
    effort: Effort,
    interrupted: Interrupted,
) -> Result<(PathTraced, Vec<String>)> {
    let key = key(view, effort);
    let path = path(folder, &key);
    let mut warnings = Vec::new();
    match load(&path, &key, view.pixels) {
        Ok(Some(result)) => return Ok((result, warnings)),
        Ok(None) => {}
        Err(problem) => warnings.push(format!("{}: {problem}; the reference is traced again", path.display())),
    }
    let result = trace(pool, caster, view, effort, interrupted)?;
    let written = std::fs::create_dir_all(folder).map_err(|e| e.to_string()).and_then(|()| {
        let json = serde_json::to_vec(&result).map_err(|e| e.to_string())?;
        files::replace(&path, &seal(&key, &json)).map_err(|e| e.to_string())
    });
    if let Err(problem) = written {
        warnings.push(format!("the reference is not kept: {problem}"));
    }
    Ok((result, warnings))
}

/// The result in a file; nothing if there is no file.
fn load(path: &Path, key: &str, pixels: &[u32]) -> std::result::Result<Option<PathTraced>, String> {
    // Opening a pipe would wait for a writer
    match std::fs::metadata(path) {
        Ok(metadata) if metadata.is_file() => {}
        Ok(_) => return Err("it is no regular file".into()),
        Err(_) => return Ok(None),
    }
    let most = most_bytes(pixels.len());
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(|e| format!("cannot be read: {e}"))?;
    file.take(most + 1).read_to_end(&mut bytes).map_err(|e| format!("cannot be read: {e}"))?;
    if bytes.len() as u64 > most {
        return Err(format!("it has more than {most} bytes"));
    }
    read(&bytes, key, pixels).map(Some)
}
