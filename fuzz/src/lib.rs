//! What the fuzz targets share: from bytes to everything that the program does with such a file.
//!
//! Bytes go through a file, since most readers look for others beside it, and since what lies behind the reader (checks,
//! transforms, counts) is to be broken as well. A scene that is read must keep the invariants that everything relies on; what
//! is refused must be refused in one line. Panics, hangs (`-timeout`) and memory (`-rss_limit_mb`) are the fuzzer's.

use rtbench::Result;
use rtbench::camera::CameraPath;
use rtbench::scene::{self, FORMATS, Scene};
use std::path::PathBuf;
use std::sync::LazyLock;

/// A folder for this process alone.
static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = std::env::temp_dir().join(format!("rtbench-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for the file");
    folder
});

/// What a camera path is held against.
static ROOM: LazyLock<Scene> = LazyLock::new(|| scene::load("room").expect("a built-in scene"));

/// A file of these bytes; its path.
fn file(name: &str, bytes: &[u8]) -> String {
    let path = FOLDER.join(name);
    std::fs::write(&path, bytes).expect("a file can be written");
    path.to_string_lossy().into_owned()
}

fn one_line<T>(result: Result<T>) -> Option<T> {
    result.inspect_err(|error| assert!(!error.to_string().contains('\n'), "more than one line: {error}")).ok()
}

/// Loads these bytes as a scene of that extension.
pub fn scene(extension: &str, bytes: &[u8]) {
    assert!(FORMATS.iter().any(|(known, _)| *known == extension), "there is no reader of .{extension}");
    let path = file(&format!("scene.{extension}"), bytes);
    if let Some(scene) = one_line(scene::load(&path)) {
        scene.check().expect("what is read is sound");
    }
}

/// Loads these bytes as a camera path and goes along it.
pub fn camera_path(bytes: &[u8]) {
    let path = file("path.toml", bytes);
    if let Some(path) = one_line(CameraPath::load(&path)) {
        one_line(path.views(&ROOM, Some(8)));
    }
}
