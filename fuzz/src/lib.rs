//! The shared part of the fuzz targets: loads bytes as the program loads a file.
//!
//! The bytes are written to a file, because most readers search further files in its folder, and so that the steps
//! after the reader (checks, transforms, counts) are tested as well. A scene that is read must keep its invariants; an
//! error must be a single line. Reading may take as much memory as in `tests/it/scene/mutation`: sixteen times the file
//! and 64 MiB. The fuzzer detects panics, and hangs by `-timeout`.

use rtbench::Result;
use rtbench::camera::CameraPath;
use rtbench::harness::workload::Part;
use rtbench::scene::{self, FORMATS, Scene};
use rtbench::workloads::size::Size;
use rtbench::workloads::spheres;
use rtbench::workloads::splat::radius::Radius;
use rtbench::workloads::splat::reference::cache;
use rtbench::workloads::splat::technique::Technique;
use rtbench::workloads::splat::{self, SplatCase};
use rtbench::workloads::trace::Selection;
use std::path::PathBuf;
use std::sync::LazyLock;

/// A temporary folder of this process.
static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = std::env::temp_dir().join(format!("rtbench-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for the file");
    folder
});

/// The scene in which camera paths are evaluated.
static ROOM: LazyLock<Scene> = LazyLock::new(|| scene::load("room").expect("a built-in scene"));

/// The scene of which structures are built.
static SMALL: LazyLock<Scene> = LazyLock::new(|| scene::load("hall:triangles=1000").expect("a built-in scene"));

/// Memory in bytes that reading may take in addition to sixteen times the file's size.
const BASE: u64 = 64 << 20;

/// Writes a file and returns its path.
fn file(name: &str, bytes: &[u8]) -> String {
    let path = FOLDER.join(name);
    std::fs::write(&path, bytes).expect("a file can be written");
    path.to_string_lossy().into_owned()
}

fn one_line<T>(result: Result<T>) -> Option<T> {
    result.inspect_err(|error| assert!(!error.to_string().contains('\n'), "more than one line: {error}")).ok()
}

/// Runs a reader of a file of this size, and asserts that its peak of memory is within the limit.
fn read<T>(file_bytes: usize, reader: impl FnOnce() -> Result<T>) -> Option<T> {
    let mut result = None;
    let counted = allocation_counter::measure(|| result = Some(reader()));
    let limit = 16 * file_bytes as u64 + BASE;
    assert!(counted.bytes_max <= limit, "{} bytes allocated at once for a file of {file_bytes}", counted.bytes_max);
    result.and_then(one_line)
}

/// Loads these bytes as a scene file with this extension.
pub fn scene(extension: &str, bytes: &[u8]) {
    assert!(FORMATS.iter().any(|(known, ..)| *known == extension), "there is no reader of .{extension}");
    let path = file(&format!("scene.{extension}"), bytes);
    // What a file may repeat is limited to the memory that a file may always take. A cache repeats nothing.
    let spec = if extension == "rtb" { path } else { format!("{path}:memory=64M") };
    if let Some(scene) = read(bytes.len(), || scene::load(&spec)) {
        scene.check().expect("a scene that is read is valid");
    }
}

/// Reads these bytes as an element of `--structure`: what is read is written in one way, and builds of a small scene.
pub fn structure(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    for selection in one_line(Selection::parse_all(text)).into_iter().flatten() {
        let again = Selection::parse(&selection.full_name()).expect("what was written is read");
        assert_eq!(again, selection);
        if let Some(built) = one_line(selection.build(&SMALL, 1)) {
            built.structure.validate(&SMALL).expect("a structure that is built is valid");
        }
    }
}

/// Loads these bytes as a camera path and evaluates its views.
pub fn camera_path(bytes: &[u8]) {
    let path = file("path.toml", bytes);
    if let Some(path) = read(bytes.len(), || CameraPath::load(&path)) {
        one_line(path.views(&ROOM, Some(8)));
    }
}

/// Loads these bytes as a scene of spheres and computes views of it.
pub fn spheres(bytes: &[u8]) {
    let path = file("spheres.json", bytes);
    if let Some(scene) = read(bytes.len(), || spheres::scene::Scene::load(&path)) {
        for frame in 0..4 {
            let view = spheres::view::View::of(&scene, Size { width: 3, height: 2 }, 5, frame, 4);
            assert!(view.origin.is_finite() && view.corner.is_finite(), "{view:?}");
        }
    }
}

/// Reads these bytes as values of flags of `rtbench splat`: what is read is written in one way.
pub fn splat(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    one_line(splat::light_choices(text));
    if let Some(radius) = one_line(Radius::parse(text)) {
        assert_eq!(Radius::parse(&radius.to_string()).expect("what was written is read"), radius);
        one_line(radius.length(10.0, &ROOM.placement));
    }
    if let Some(technique) = one_line(Technique::parse(text)) {
        assert_eq!(Technique::parse(&technique.to_string()).expect("what was written is read"), technique);
    }
    for axis in splat::cluster_axes::AXES {
        let mut part = Part::default();
        for (axis, value) in [("technique", "per-sample"), ("resolution", "64x36"), (axis, text)] {
            part.values.insert(axis.to_owned(), vec![value.to_owned()]);
        }
        for case in one_line(SplatCase::all(&part)).unwrap_or_default() {
            let again = SplatCase::parse(&case.to_case("box")).expect("what was written is read");
            assert_eq!(again, case);
        }
    }
}

/// Reads these bytes as a reference that was kept, once as they are and once with a valid checksum.
pub fn path_traced(bytes: &[u8]) {
    let pixels = [0, 1];
    for file in [bytes.to_vec(), cache::seal("key", bytes)] {
        if let Ok(reference) = cache::read(&file, "key", &pixels) {
            assert_eq!(reference.pixels, pixels);
        }
    }
}
