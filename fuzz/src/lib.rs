//! What the fuzz targets share: from bytes to everything that the program does with such a file.
//!
//! Bytes go through a file, since most readers look for others beside it, and since what lies behind the reader (checks,
//! transforms, counts) is to be broken as well. A scene that is read must keep the invariants that everything relies on; what
//! is refused must be refused in one line. Reading may take as much memory as in `tests/it/scene/mutation`: sixteen times the
//! file and 64 MiB. Panics and hangs (`-timeout`) are the fuzzer's.

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

/// Bytes that reading may take beside sixteen times the file's.
const BASE: u64 = 64 << 20;

/// A file of these bytes; its path.
fn file(name: &str, bytes: &[u8]) -> String {
    let path = FOLDER.join(name);
    std::fs::write(&path, bytes).expect("a file can be written");
    path.to_string_lossy().into_owned()
}

fn one_line<T>(result: Result<T>) -> Option<T> {
    result.inspect_err(|error| assert!(!error.to_string().contains('\n'), "more than one line: {error}")).ok()
}

/// Reads a file of so many bytes, and looks how much memory that takes at once.
fn read<T>(file_bytes: usize, reader: impl FnOnce() -> Result<T>) -> Option<T> {
    let mut result = None;
    let counted = allocation_counter::measure(|| result = Some(reader()));
    let limit = 16 * file_bytes as u64 + BASE;
    assert!(counted.bytes_max <= limit, "{} bytes allocated at once for a file of {file_bytes}", counted.bytes_max);
    result.and_then(one_line)
}

/// Loads these bytes as a scene of that extension.
pub fn scene(extension: &str, bytes: &[u8]) {
    assert!(FORMATS.iter().any(|(known, ..)| *known == extension), "there is no reader of .{extension}");
    let path = file(&format!("scene.{extension}"), bytes);
    if let Some(scene) = read(bytes.len(), || scene::load(&path)) {
        scene.check().expect("what is read is sound");
    }
}

/// Loads these bytes as a camera path and goes along it.
pub fn camera_path(bytes: &[u8]) {
    let path = file("path.toml", bytes);
    if let Some(path) = read(bytes.len(), || CameraPath::load(&path)) {
        one_line(path.views(&ROOM, Some(8)));
    }
}
