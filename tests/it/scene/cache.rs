//! Tests of the binary cache: it restores the whole scene; foreign, stale, truncated and corrupt caches are refused.

use super::refusal;
use crate::support::short;
use glam::Vec3;
use rtbench::scene::cache::{self, Sources};
use rtbench::scene::{self, Light, Pose, Scene, SceneCamera};
use std::path::{Path, PathBuf};

/// A scene with a value in every field.
fn full() -> Scene {
    let mut scene = scene::load("hall:triangles=15000").unwrap();
    let pose = |time: f64| Pose { time, position: Vec3::new(0.1, 0.2, time as f32), direction: Vec3::Z, up: Vec3::Y };
    scene.camera = Some(SceneCamera { field_of_view: 41.3, frames: vec![pose(0.1), pose(1.0 / 3.0)] });
    scene.warnings = vec!["one".into(), "zwei: ü".into()];
    scene.lights.push(Light::new(Vec3::ONE, Vec3::splat(0.3)));
    scene
}

fn cached(scene: &Scene, folder: &Path) -> PathBuf {
    let path = folder.join("scene.rtb");
    cache::write(scene, &Sources::default(), &path).unwrap();
    path
}

fn load(path: &Path) -> rtbench::Result<Scene> {
    scene::load(path.to_str().unwrap())
}

#[test]
fn a_cache_restores_the_whole_scene() {
    let folder = tempfile::tempdir().unwrap();
    let scene = full();
    let back = load(&cached(&scene, folder.path())).unwrap();
    assert_eq!(back.content_hash(), scene.content_hash());
    assert_eq!((&back.name, &back.camera_path, &back.camera), (&scene.name, &scene.camera_path, &scene.camera));
    assert_eq!((&back.warnings, back.degenerate_triangles), (&scene.warnings, scene.degenerate_triangles));
    let bare = Scene { camera: None, camera_path: None, lights: Vec::new(), warnings: Vec::new(), ..scene };
    let back = load(&cached(&bare, folder.path())).unwrap();
    assert_eq!((&back.camera, &back.camera_path, back.lights.len()), (&None, &None, 0));
    // The folder contains no other file than the cache.
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn options_apply_to_caches() {
    let folder = tempfile::tempdir().unwrap();
    let path = cached(&full(), folder.path());
    let scaled = scene::load(&format!("{}:scale=2", path.display())).unwrap();
    assert_eq!(scaled.vertices[5].position, full().vertices[5].position * 2.0);
    assert_eq!(scaled.name, format!("{},scale=2", full().name), "options are part of the name");
    for option in ["time=5", "cones=no", "segments=5", "lamp=foo", "camera=nix"] {
        let message = refusal(scene::load(&format!("{}:{option}", path.display())));
        assert!(message.contains("a .rtb file has no option") && message.contains("up, scale, fov"), "{message}");
    }
}

#[test]
fn damaged_caches_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = cached(&full(), folder.path());
    let sound = std::fs::read(&path).unwrap();
    let refused = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        refusal(load(&path))
    };
    assert!(refused(b"").contains("not a cache"));
    assert!(refused(b"ply\nformat ascii 1.0\n").contains("not a cache"));
    for length in [4, 8, 100, 135, 300, sound.len() / 2, sound.len() - 1] {
        assert!(refused(&sound[..length]).contains("truncated"), "{length}");
    }
    assert!(refused(&[&sound[..], b"x"].concat()).contains("bytes after its end"));
    // One bit is flipped in each part: header, vertices, triangles, texts.
    for at in [12, 40, 50, 131, 1000, sound.len() / 2, sound.len() - 3] {
        let mut bytes = sound.clone();
        bytes[at] ^= 4;
        let message = refused(&bytes);
        assert!(message.contains("corrupt") || message.contains("truncated"), "byte {at}: {message}");
    }
    let changed = |at: usize, value: &[u8]| {
        let mut bytes = sound.clone();
        bytes[at..at + value.len()].copy_from_slice(value);
        bytes
    };
    assert!(refused(&changed(8, &[9])).contains("stale: its layout has version 9"));
    assert!(refused(&changed(16, b"0123456789abcdef")).contains("stale: it was written by another version"));
    // Counts beyond the file and beyond all limits are refused before memory is allocated.
    assert!(refused(&changed(64, &(1u64 << 26).to_le_bytes())).contains("truncated"));
    assert!(refused(&changed(64, &u64::MAX.to_le_bytes())).contains("corrupt"));
    assert_eq!(refused(&sound[..0]).lines().count(), 1);
    std::fs::write(&path, &sound).unwrap();
    load(&path).unwrap();
    assert!(refusal(load(&folder.path().join("none.rtb"))).contains("no such file"));
    std::fs::create_dir(folder.path().join("folder.rtb")).unwrap();
    assert!(refusal(load(&folder.path().join("folder.rtb"))).contains("not a regular file"));
}

/// A valid checksum does not prove that the written scene is valid.
#[test]
fn an_invalid_scene_with_a_valid_checksum_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = full();
    scene.triangles[7].vertices[0] = u32::MAX;
    assert!(refusal(load(&cached(&scene, folder.path()))).contains("triangle 7 uses a vertex beyond"));
}

/// Converts a scene as the program does.
fn convert(spec: &str, to: &Path) -> Scene {
    let (scene, sources) = cache::load(spec, None).unwrap();
    cache::write(&scene, &sources, to).unwrap();
    scene
}

/// Sets the time of modification of a file to this many seconds ago.
fn touch(path: &Path, ago: u64) {
    let time = std::time::SystemTime::now() - std::time::Duration::from_secs(ago);
    std::fs::File::options().append(true).open(path).unwrap().set_modified(time).unwrap();
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn a_changed_source_file_makes_a_cache_stale() {
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("cube.ply");
    let other = super::ply::CUBE.replacen('0', "1", 1);
    std::fs::write(&source, super::ply::CUBE).unwrap();
    touch(&source, 1000);
    let path = folder.path().join("cube.rtb");
    convert(text(&source), &path);
    load(&path).unwrap();
    // The file was touched and has the same bytes.
    for ago in [10, 100_000] {
        touch(&source, ago);
        load(&path).unwrap();
    }
    // The file has other bytes of the same length, and a newer or an older time.
    for ago in [10, 100_000] {
        std::fs::write(&source, &other).unwrap();
        touch(&source, ago);
        let message = refusal(load(&path));
        assert!(message.contains("stale") && message.contains("cube.ply has changed"), "{message}");
    }
    std::fs::write(&source, "ply").unwrap();
    assert!(refusal(load(&path)).contains("stale"));
    // The file was changed immediately, possibly within the resolution of file times.
    std::fs::write(&source, super::ply::CUBE).unwrap();
    convert(text(&source), &path);
    std::fs::write(&source, &other).unwrap();
    assert!(refusal(load(&path)).contains("stale"));
    // Without the source file changes cannot be detected, and the cache is accepted.
    std::fs::remove_file(&source).unwrap();
    load(&path).unwrap();
}

/// `touch -d`, `cp -p`, archives and rsync set the time of modification back, but not the time of change.
#[cfg(unix)]
#[test]
fn an_edit_with_a_restored_time_makes_a_cache_stale() {
    use std::os::unix::fs::PermissionsExt;
    let files = super::Files::new(&[("cube.ply", super::ply::CUBE)]);
    let (source, cached) = (files.path("cube.ply"), files.path("cube.rtb"));
    let past = std::time::SystemTime::now() - std::time::Duration::from_secs(1000);
    let set_back = || std::fs::File::options().append(true).open(&source).unwrap().set_modified(past).unwrap();
    set_back();
    // Waits until the time of change is conclusive, so that it is stored in the cache.
    std::thread::sleep(std::time::Duration::from_millis(300));
    convert(text(&source), &cached);
    load(&cached).unwrap();
    // Permissions and the name were changed temporarily; the content is the same.
    std::fs::set_permissions(&source, std::fs::Permissions::from_mode(0o600)).unwrap();
    load(&cached).unwrap();
    std::fs::rename(&source, files.path("away")).unwrap();
    std::fs::rename(files.path("away"), &source).unwrap();
    load(&cached).unwrap();
    files.write("cube.ply", super::ply::CUBE.replace("extras", "extraz").as_bytes());
    set_back();
    assert!(refusal(load(&cached)).contains("cube.ply has changed"));
    // The same immediately after writing, when a later edit could have the same time
    convert(text(&source), &cached);
    files.write("cube.ply", super::ply::CUBE.as_bytes());
    set_back();
    assert!(refusal(load(&cached)).contains("cube.ply has changed"));
}

#[test]
fn every_source_file_is_checked() {
    let files = super::Files::new(&[
        ("a.obj", "mtllib a.mtl b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"),
        ("sub/c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        ("a.mtl", "newmtl m\nKd 1 0 0\n"),
    ]);
    let cached = files.path("sub/caches/x.rtb");
    std::fs::create_dir_all(cached.parent().unwrap()).unwrap();
    let list = format!("{}+{}", text(&files.path("a.obj")), text(&files.path("sub/c.obj")));
    let stale = |words: &str| {
        let message = refusal(load(&cached));
        assert!(message.contains("stale") && message.contains(words), "{message}");
    };
    assert_eq!(short(&convert(&list, &cached).name), "a+c");
    load(&cached).unwrap();
    files.write("a.mtl", b"newmtl m\nKd 0 1 0\n");
    stale("a.mtl has changed");
    convert(&list, &cached);
    files.write("b.mtl", b"");
    stale("b.mtl exists now");
    convert(&list, &cached);
    std::fs::remove_file(files.path("sub/c.obj")).unwrap();
    stale("c.obj no longer exists");
    // A folder that contains its own cache
    let cached = files.path("folder.rtb");
    let folder = text(&files.path("")).to_owned();
    convert(&folder, &cached);
    load(&cached).unwrap();
    assert_eq!(convert(&folder, &cached).triangles.len(), 1);
    files.write("d.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert!(refusal(load(&cached)).contains("has other files"));
    convert(&folder, &cached);
    files.write("d.obj", b"v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n");
    assert!(refusal(load(&cached)).contains("d.obj has changed"));
}

#[test]
fn a_cache_of_a_cache_depends_on_the_same_source_files() {
    let files = super::Files::new(&[("a.ply", super::ply::CUBE)]);
    let (source, y, z) = (files.path("a.ply"), files.path("y.rtb"), files.path("z.rtb"));
    let scaled = format!("{}:scale=2", text(&y));
    convert(text(&source), &y);
    assert_eq!(short(&convert(&scaled, &z).name), "a:scale=2");
    // The same content, written at another time
    touch(&source, 1000);
    convert(text(&source), &y);
    load(&z).unwrap();
    convert("hall:triangles=15000", &y);
    assert!(refusal(load(&z)).contains("y.rtb has changed"));
    convert(text(&source), &y);
    load(&z).unwrap();
    files.write("a.ply", super::ply::CUBE.replacen('0', "1", 1).as_bytes());
    assert!(refusal(load(&z)).contains("a.ply has changed"));
    // A cache that replaces its own source
    convert("hall:triangles=15000", &y);
    convert(&scaled, &y);
    load(&y).unwrap();
}

#[cfg(unix)]
#[test]
fn a_pipe_is_refused_without_waiting() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe.rtb");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    assert!(refusal(load(&pipe)).contains("not a regular file"));
}

#[test]
fn a_cache_that_cannot_be_written_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("no/such/folder/scene.rtb");
    let error = cache::write(&full(), &Sources::default(), &path).unwrap_err().to_string();
    assert!(error.contains("cannot write"), "{error}");
    std::fs::create_dir(folder.path().join("taken.rtb")).unwrap();
    cache::write(&full(), &Sources::default(), &folder.path().join("taken.rtb")).unwrap_err();
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}
