//! The binary cache: all of a scene comes back; what is foreign, stale, truncated or corrupt is refused.

use super::refusal;
use glam::Vec3;
use rtbench::scene::cache::{self, Source};
use rtbench::scene::{self, Light, Pose, Scene, SceneCamera};
use std::path::{Path, PathBuf};

/// A scene with something in every field.
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
    cache::write(scene, &Source::default(), &path).unwrap();
    path
}

fn load(path: &Path) -> rtbench::Result<Scene> {
    scene::load(path.to_str().unwrap())
}

#[test]
fn everything_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let scene = full();
    let back = load(&cached(&scene, folder.path())).unwrap();
    assert_eq!(back.content_hash(), scene.content_hash());
    assert_eq!((&back.name, &back.camera_path, &back.camera), (&scene.name, &scene.camera_path, &scene.camera));
    assert_eq!((&back.warnings, back.degenerate_triangles), (&scene.warnings, scene.degenerate_triangles));
    let bare = Scene { camera: None, camera_path: None, lights: Vec::new(), warnings: Vec::new(), ..scene };
    let back = load(&cached(&bare, folder.path())).unwrap();
    assert_eq!((&back.camera, &back.camera_path, back.lights.len()), (&None, &None, 0));
    // Nothing is left behind beside the cache.
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn options_work_on_a_cache_as_on_any_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = cached(&full(), folder.path());
    let scaled = scene::load(&format!("{}:scale=2", path.display())).unwrap();
    assert_eq!(scaled.vertices[5].position, full().vertices[5].position * 2.0);
}

#[test]
fn every_damage_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = cached(&full(), folder.path());
    let sound = std::fs::read(&path).unwrap();
    let refused = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        refusal(load(&path))
    };
    assert!(refused(b"").contains("not a cache"));
    assert!(refused(b"ply\nformat ascii 1.0\n").contains("not a cache"));
    for length in [4, 8, 100, 159, 300, sound.len() / 2, sound.len() - 1] {
        assert!(refused(&sound[..length]).contains("truncated"), "{length}");
    }
    assert!(refused(&[&sound[..], b"x"].concat()).contains("bytes behind its end"));
    // One bit in every part: header, vertices, triangles, texts.
    for at in [12, 40, 155, 1000, sound.len() / 2, sound.len() - 3] {
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
    assert!(refused(&changed(16, b"0123456789abcdef")).contains("stale: it was made by another version"));
    // Counts beyond the file, and beyond all sense: nothing is allocated for them.
    assert!(refused(&changed(88, &(1u64 << 26).to_le_bytes())).contains("truncated"));
    assert!(refused(&changed(88, &u64::MAX.to_le_bytes())).contains("corrupt"));
    assert_eq!(refused(&sound[..0]).lines().count(), 1);
    std::fs::write(&path, &sound).unwrap();
    load(&path).unwrap();
    assert!(refusal(load(&folder.path().join("none.rtb"))).contains("no such file"));
    std::fs::create_dir(folder.path().join("folder.rtb")).unwrap();
    assert!(refusal(load(&folder.path().join("folder.rtb"))).contains("not a regular file"));
}

/// A checksum proves that the bytes are as written, not that the writer was sound.
#[test]
fn a_sound_checksum_does_not_excuse_a_broken_scene() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = full();
    scene.triangles[7].vertices[0] = u32::MAX;
    assert!(refusal(load(&cached(&scene, folder.path()))).contains("triangle 7 uses a vertex beyond"));
}

#[test]
fn a_changed_source_makes_it_stale() {
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("cube.ply");
    std::fs::write(&source, super::ply::CUBE).unwrap();
    let path = folder.path().join("cube.rtb");
    let what = source.to_str().unwrap();
    cache::write(&scene::load(what).unwrap(), &Source::of(what, None).unwrap(), &path).unwrap();
    load(&path).unwrap();
    let later = std::time::SystemTime::now() + std::time::Duration::from_secs(100);
    let touch = || std::fs::File::options().append(true).open(&source).unwrap().set_modified(later).unwrap();
    // Touched, but the same bytes
    touch();
    load(&path).unwrap();
    // Other bytes of the same length
    std::fs::write(&source, super::ply::CUBE.replacen('0', "1", 1)).unwrap();
    touch();
    assert!(refusal(load(&path)).contains("cube.ply beside it has changed"));
    std::fs::write(&source, "ply").unwrap();
    assert!(refusal(load(&path)).contains("stale"));
    // Without the source, it cannot be told, and need not.
    std::fs::remove_file(&source).unwrap();
    load(&path).unwrap();
}

#[test]
fn a_cache_that_cannot_be_written_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("no/such/folder/scene.rtb");
    let error = cache::write(&full(), &Source::default(), &path).unwrap_err().to_string();
    assert!(error.contains("cannot write"), "{error}");
    std::fs::create_dir(folder.path().join("taken.rtb")).unwrap();
    cache::write(&full(), &Source::default(), &folder.path().join("taken.rtb")).unwrap_err();
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}
