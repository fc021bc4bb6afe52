//! Tests of scenes: readers, built-in scenes, loading by name.

mod aff;
mod broken_aff;
mod broken_inventor;
mod broken_ply;
mod built_in;
mod cache;
mod catalogue;
mod estimate;
mod fetch;
mod gltf;
mod inventor;
mod inventor_faces;
mod mark;
mod memory;
mod mgf;
mod mutation;
mod obj;
mod placement;
mod ply;

use crate::support::short;
use rtbench::scene::{self, Scene};
use rtbench::{Error, Result};
use std::path::PathBuf;

/// The folder of real scenes. Without one, prints that the test did not run.
fn real_scenes(test: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("RTBENCH_SCENES").filter(|folder| !folder.is_empty()).map(PathBuf::from);
    if folder.is_none() {
        eprintln!("{test}: did not run, RTBENCH_SCENES does not name a folder of scenes");
    }
    folder
}

/// Files of a scene in a temporary folder inside another one, which is removed when this is dropped.
struct Files {
    folder: tempfile::TempDir,
}

impl Files {
    /// Writes files by name and text.
    fn new(files: &[(&str, &str)]) -> Files {
        let folder = Files { folder: tempfile::tempdir().unwrap() };
        std::fs::create_dir_all(folder.path("")).unwrap();
        for (name, text) in files {
            folder.write(name, text.as_bytes());
        }
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join("scene").join(name)
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        std::fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        std::fs::write(self.path(name), bytes).unwrap();
    }

    /// Loads one of the files; options may follow its name.
    fn load(&self, spec: &str) -> Result<Scene> {
        scene::load(self.path(spec).to_str().unwrap())
    }
}

/// Loads a PLY file with these bytes.
fn load_bytes(bytes: &[u8]) -> Result<Scene> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.ply");
    std::fs::write(&path, bytes).unwrap();
    scene::load(path.to_str().unwrap())
}

/// The message of a refused scene; asserts that it is one line.
fn refusal(result: Result<Scene>) -> String {
    let error = result.expect_err("must be refused");
    assert!(matches!(error, Error::Input(_)), "{error:?}");
    let message = error.to_string();
    assert!(!message.contains('\n'), "{message}");
    message
}

#[test]
fn unknown_names_are_refused_with_a_hint() {
    for (spec, words) in [
        ("hal", &["did you mean hall?", "sphereflake"][..]),
        ("cathedral", &["no scene is called", "terrain", "dragon"]),
        ("kitchen", &["no folder of scenes is given", "RTBENCH_SCENES", "kitchen.aff", "BART"]),
        ("no/such/mesh.ply", &["no/such/mesh.ply: no such file"]),
        ("mesh.PLY", &["mesh.PLY: no such file"]),
        ("no/such/mesh", &["no such file"]),
        ("hall:triangle=1000", &["no parameter `triangle`", "did you mean triangles?"]),
        ("hall:triangles", &["key=value"]),
        ("hall:triangles=many", &["not a whole number"]),
        ("hall:triangles=-5", &["not a whole number"]),
        ("hall:triangles=7", &["out of range", "15000"]),
        ("hall:triangles=99999999999999", &["out of range"]),
        ("hall:triangles=99999999999999999999999999", &["not a whole number"]),
        ("", &["no scene is called"]),
    ] {
        let message = refusal(scene::load(spec));
        for word in words {
            assert!(message.contains(word), "{spec}: {message}");
        }
    }
}

#[test]
fn files_of_unknown_format_and_folders_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let text = folder.path().join("mesh.txt");
    std::fs::write(&text, "ply\n").unwrap();
    let message = refusal(scene::load(text.to_str().unwrap()));
    assert!(message.contains("format is unknown") && message.contains("ply"), "{message}");
    let mesh = folder.path().join("folder.ply");
    std::fs::create_dir(&mesh).unwrap();
    assert!(refusal(scene::load(mesh.to_str().unwrap())).contains("not a regular file"));
}

#[test]
fn check_detects_every_violated_invariant() {
    let sound = load_bytes(ply::CUBE.as_bytes()).unwrap();
    sound.check().unwrap();
    type Break = fn(&mut Scene);
    let faults: [(&str, Break); 9] = [
        ("no triangle", |s| s.triangles.clear()),
        ("uses a vertex beyond", |s| s.triangles[3].vertices[1] = 8),
        ("uses a material beyond", |s| s.triangles[3].material = 1),
        ("vertex 2 is not finite", |s| s.vertices[2].position.y = f32::NAN),
        ("vertex 2 is not finite", |s| s.vertices[2].normal.y = f32::INFINITY),
        ("too large", |s| s.vertices[2].position.y = 3e38),
        ("material 0 is outside", |s| s.materials[0].reflectivity = 1.5),
        ("material 0 is outside", |s| s.materials[0].diffuse.x = -1.0),
        ("light 0 is not finite", |s| s.lights.push(scene::Light::new(glam::Vec3::NAN, glam::Vec3::ONE))),
    ];
    for (words, break_it) in faults {
        let mut broken = sound.clone();
        break_it(&mut broken);
        let message = broken.check().expect_err(words).to_string();
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn the_content_hash_depends_on_every_part_and_not_on_the_name() {
    let scene = scene::load("hall:triangles=15000").unwrap();
    let hash = scene.content_hash();
    assert_eq!(hash.len(), 64);
    let changes: [fn(&mut Scene); 5] = [
        |s| s.vertices[7].normal.x += 0.5,
        |s| s.triangles.swap(0, 1),
        |s| s.materials[0].exponent += 1.0,
        |s| s.lights[0].colour.x += 0.1,
        |s| s.background.x += 0.1,
    ];
    for change in changes {
        let mut changed = scene.clone();
        change(&mut changed);
        assert_ne!(changed.content_hash(), hash);
    }
    let renamed = Scene { name: "other".into(), ..scene };
    assert_eq!(renamed.content_hash(), hash);
}

#[test]
fn options_may_follow_the_name_of_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cube.ply");
    std::fs::write(&path, ply::CUBE).unwrap();
    let file = path.to_str().unwrap();
    let plain = scene::load(file).unwrap();
    let turned = scene::load(&format!("{file}:up=z,scale=2")).unwrap();
    assert_eq!(scene::at_time(file, 3.5), format!("{file}:time=3.5"));
    assert_eq!(scene::at_time(&format!("{file}:up=z"), -1.0), format!("{file}:up=z,time=-1"));
    for stays in [format!("{file}:time=2"), "hall:triangles=15000".to_owned(), "hall".to_owned()] {
        assert_eq!(scene::at_time(&stays, 3.0), stays);
    }
    assert_eq!((short(&plain.name), short(&turned.name)), ("cube".into(), "cube:up=z,scale=2".into()));
    let v = |scene: &Scene, i: usize| scene.vertices[i].position;
    for i in 0..plain.vertices.len() {
        let p = v(&plain, i);
        assert_eq!(v(&turned, i), glam::Vec3::new(p.x, p.z, -p.y) * 2.0);
    }
    for (settings, words) in [
        ("tim=3", "did you mean time?"),
        ("time=soon", "the value `soon` is not valid"),
        ("segments=2", "3 to 1024"),
        ("up=x", "y or z"),
        ("scale=-1", "positive"),
        ("scale=inf", "positive"),
        ("outside=maybe", "yes or no"),
        ("cones=3", "yes or no"),
    ] {
        let message = refusal(scene::load(&format!("{file}:{settings}")));
        assert!(message.contains(words), "{settings}: {message}");
    }
}
