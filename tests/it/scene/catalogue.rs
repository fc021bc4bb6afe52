//! Tests of the catalogue: valid entries, unique names, existing and missing files.

use super::{real_scenes, refusal};
use crate::support::short;
use rtbench::scene::catalogue::{Class, entries, find, get, locate};
use rtbench::scene::{self, load_in};
use std::path::{Component, Path};

#[test]
fn entries_are_valid() {
    let published: Vec<&str> = entries().iter().filter(|e| e.published).map(|e| e.name.as_str()).collect();
    assert_eq!(
        published,
        ["bunny", "dragon", "buddha", "robots", "museum", "kitchen", "theatre", "office", "conference"]
    );
    for entry in entries() {
        let name = &entry.name;
        assert!(name.chars().all(|c| c.is_ascii_lowercase() || c == '-'), "{name}");
        assert!(entry.triangles > 0 && !entry.file.is_empty(), "{name}");
        for text in [&entry.title, &entry.source, &entry.licence, &entry.credit] {
            assert!(!text.is_empty() && !text.contains('\n'), "{name}");
        }
        let inside = |path: &Path| path.components().all(|c| matches!(c, Component::Normal(_)));
        for candidate in &entry.file {
            assert!(inside(&candidate.path), "{name}");
            let hash = candidate.sha256.as_deref().unwrap_or(&"0".repeat(64)).to_owned();
            assert!(hash.len() == 64 && hash.bytes().all(|b| b"0123456789abcdef".contains(&b)), "{name}");
        }
        if let Some(archive) = &entry.fetch {
            assert!(archive.url.starts_with("https://") && archive.url.ends_with(".tar.gz"), "{name}");
            assert!(inside(&archive.member), "{name}");
            assert!(entry.file.iter().any(|c| c.path == archive.to), "{name}: the downloaded file would not be found");
        }
        if let Some(path) = &entry.camera_path {
            assert!(rtbench::camera::names().contains(&path.as_str()), "{name}: no camera path {path}");
        }
        assert!(entry.options.split(',').all(|o| o.is_empty() || o.contains('=')), "{name}");
    }
    assert_eq!(
        (get("robots").unwrap().grid.as_deref(), get("kitchen").unwrap().grid.as_deref()),
        (Some("x=128"), Some("y=128"))
    );
    assert_eq!((get("dragon").unwrap().class, get("office").unwrap().class), (Class::Object, Class::Walk));
    assert!(get("dragn").unwrap_err().to_string().contains("did you mean dragon?"));
}

#[test]
fn names_are_unique() {
    let mut names: Vec<&str> = entries().iter().map(|e| e.name.as_str()).collect();
    names.extend(scene::list().iter().map(|info| info.name));
    let all = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), all);
}

#[test]
fn a_name_loads_its_file_in_the_folder_of_scenes() {
    let folder = tempfile::tempdir().unwrap();
    let entry = find("bunny").unwrap();
    assert_eq!(locate(entry, folder.path()), None);
    let message = refusal(load_in("bunny", Some(folder.path())));
    assert!(message.contains("has no bunny/bun_zipper.ply") && message.contains("scenes fetch bunny"), "{message}");
    let message = refusal(load_in("bunny", Some(&folder.path().join("nowhere"))));
    assert!(message.contains("does not exist"), "{message}");
    // The last of the locations, then the first
    for place in ["bun_zipper.ply", "bunny/bun_zipper.ply"] {
        let path = folder.path().join(place);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, super::ply::CUBE).unwrap();
        assert_eq!(locate(entry, folder.path()), Some(path));
    }
    let cube = load_in("bunny", Some(folder.path())).unwrap();
    assert_eq!(cube.name, "bunny");
    assert!(cube.warnings.iter().any(|w| w.contains("the catalogue expects 69451")), "{:?}", cube.warnings);
    assert!(cube.warnings.iter().any(|w| w.contains("not the catalogue's file")), "{:?}", cube.warnings);
    let message = refusal(load_in("bunny:segments=9", Some(folder.path())));
    assert!(message.contains("a .ply file has no option `segments`"), "{message}");
    assert_eq!(scene::at_time("bunny", 3.0), "bunny", "nothing moves");
    assert_eq!(scene::at_time("robots", 3.0), "robots:time=3");
    assert_eq!(load_in("bunny:scale=2", Some(folder.path())).unwrap().name, "bunny:scale=2");
    assert!(refusal(load_in("bunny:size=2", Some(folder.path()))).contains("no option `size`"));
}

#[test]
fn a_folder_or_a_list_of_files_is_one_scene() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let whole = folder.path().to_str().unwrap();
    assert!(refusal(scene::load(whole)).contains("no file of a known format"));
    for name in ["b.ply", "a.ply"] {
        std::fs::write(folder.path().join(name), super::ply::CUBE).unwrap();
    }
    std::fs::write(folder.path().join("notes.txt"), "not a scene").unwrap();
    let one = scene::load(&at("a.ply")).unwrap();
    for spec in [whole.to_owned(), format!("{}+{}", at("a.ply"), at("b.ply")), format!("{whole}/")] {
        let both = scene::load(&spec).unwrap();
        assert_eq!(both.triangles.len(), 2 * one.triangles.len(), "{spec}");
        assert_eq!(both.vertices.len(), 2 * one.vertices.len());
        let (first, second) = (both.triangles[0], both.triangles[one.triangles.len()]);
        assert_eq!(second.vertices, first.vertices.map(|v| v + one.vertices.len() as u32));
        assert_eq!(second.material, 1);
        let own = folder.path().file_name().unwrap().to_string_lossy().into_owned();
        match spec.contains('+') {
            true => assert_eq!(short(&both.name), "a+b"),
            false => assert!(both.name.contains(&own), "{}", both.name),
        }
    }
    let message = refusal(scene::load(&format!("{}+{whole}", at("a.ply"))));
    assert!(message.contains("it is a folder"), "{message}");
    assert!(refusal(scene::load(&format!("{}+{}", at("a.ply"), at("c.ply")))).contains("c.ply: no such file"));
    std::fs::write(folder.path().join("c.ply"), "ply\n").unwrap();
    assert!(refusal(scene::load(whole)).contains("c.ply"));
}

#[test]
fn included_files_of_a_folder_are_not_read_twice() {
    let square = "p 3\n0 0 0\n1 0 0\n0 1 0\n";
    let level = format!("i 0 part.aff\n{square}");
    let files = super::Files::new(&[("part.aff", square), ("scene.aff", &level), ("text.txt", "")]);
    let folder = files.path("");
    let scene = scene::load(folder.to_str().unwrap()).unwrap();
    assert_eq!((short(&scene.name).as_str(), scene.triangles.len()), ("scene", 2));
    assert!(!scene.warnings.iter().any(|w| w.contains("consists of")), "{:?}", scene.warnings);
    files.write("two.aff", level.as_bytes());
    let scene = scene::load(folder.to_str().unwrap()).unwrap();
    assert_eq!(scene.triangles.len(), 4);
    for words in ["consists of scene.aff, two.aff", "versions of one scene"] {
        assert!(scene.warnings.iter().any(|w| w.contains(words)), "{words}: {:?}", scene.warnings);
    }
}

#[test]
fn options_are_part_of_the_name_of_a_catalogue_scene() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir_all(folder.path().join("museum")).unwrap();
    std::fs::write(folder.path().join("museum/museum6.aff"), "p 3\n0 0 0\n1 0 0\n0 1 0\n").unwrap();
    for (spec, name) in [
        ("museum", "museum"),
        ("museum:time=3", "museum"),
        ("museum:cones=yes", "museum:cones=yes"),
        ("museum:time=4,scale=2", "museum:time=4,scale=2"),
    ] {
        assert_eq!(load_in(spec, Some(folder.path())).unwrap().name, name);
    }
}

/// The real scenes have the counts and hashes of the catalogue.
#[test]
fn real_scenes_agree_with_the_catalogue() {
    use sha2::{Digest, Sha256};
    let Some(folder) = real_scenes("real_scenes_are_as_the_catalogue_says") else { return };
    for entry in entries() {
        let Some(path) = locate(entry, &folder) else {
            eprintln!("{}: not checked, not here", entry.name);
            continue;
        };
        let candidate = entry.file.iter().find(|c| folder.join(&c.path) == path).unwrap();
        if let Some(expected) = &candidate.sha256 {
            let hash = Sha256::digest(std::fs::read(&path).unwrap());
            let hash: String = hash.iter().map(|b| format!("{b:02x}")).collect();
            assert_eq!(&hash, expected, "{}", entry.name);
        }
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("obj");
        if !scene::FORMATS.iter().any(|(known, ..)| *known == extension) {
            eprintln!("{}: not loaded, no reader for .{extension}", entry.name);
            continue;
        }
        let loaded = load_in(&entry.name, Some(&folder)).unwrap();
        assert_eq!(loaded.triangles.len(), entry.triangles, "{}", entry.name);
        assert_eq!(loaded.name, entry.name);
        if let Some(vertices) = entry.vertices {
            assert_eq!(loaded.vertices.len(), vertices, "{}", entry.name);
        }
    }
}
