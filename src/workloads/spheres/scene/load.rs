//! Names of scenes, and files on the disk.

use super::{NAMES, Scene, file, random};
use crate::error::{Error, Result};
use crate::{guard, names};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Most bytes of a file: three times what 100,000 spheres take at a number per line.
pub const MAX_BYTES: u64 = 64 << 20;

/// The texts of [`NAMES`].
const TEXTS: [&str; 3] = [
    include_str!("../../../../scenes/spheres/default.json"),
    include_str!("../../../../scenes/spheres/random20.json"),
    include_str!("../../../../scenes/spheres/random100.json"),
];

/// See [`Scene::load`].
pub fn load(spec: &str) -> Result<Scene> {
    if let Some(index) = NAMES.iter().position(|name| *name == spec) {
        return file::parse(spec, Path::new(spec), TEXTS[index]);
    }
    if spec == random::NAME || spec.starts_with("random:") {
        return random::load(spec);
    }
    let path = names::file(spec);
    let is_path = spec.contains(['/', '\\']) || path.extension().is_some();
    if !is_path && !path.exists() {
        let known = [NAMES.as_slice(), &[random::NAME]].concat();
        let hint = format!("{}; or name a file such as spheres.json", crate::scene::did_you_mean(spec, &known));
        return Err(Error::argument(spec, format!("no file and no scene of spheres is called `{spec}`"), hint));
    }
    let bytes = read(&path)?;
    let text = std::str::from_utf8(&bytes).map_err(|error| {
        let line = 1 + bytes[..error.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count();
        Error::file(&path, Some(line), "the file is not UTF-8", "save it as UTF-8")
    })?;
    file::parse(spec, &path, text)
}

/// The bytes of a file that is not too large.
fn read(path: &Path) -> Result<Vec<u8>> {
    let fault = |problem: String, hint: &str| Error::file(path, None, problem, hint);
    crate::scene::regular_file(path)?;
    let unreadable = |error: std::io::Error| fault(format!("cannot be read: {error}"), "check its permissions");
    let mut bytes = Vec::new();
    File::open(path).and_then(|file| file.take(MAX_BYTES + 1).read_to_end(&mut bytes)).map_err(unreadable)?;
    if bytes.len() as u64 > MAX_BYTES {
        let problem = format!("the file has more than {} MiB", MAX_BYTES >> 20);
        return Err(fault(problem, "a scene has at most 100000 spheres"));
    }
    if bytes.is_empty() {
        return Err(fault("the file is empty".into(), "name a file that holds a scene of spheres"));
    }
    guard::read(path);
    Ok(bytes)
}
