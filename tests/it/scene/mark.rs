//! Tests of byte order marks: readers of all text formats ignore a mark at the beginning of a file.

use super::ply::CUBE;
use super::{Files, refusal};
use base64::Engine;
use rtbench::scene::Scene;

const MARK: &str = "\u{feff}";

/// A file of each text format. The first line is needed (a vertex, a material, an entity), so that a mark must not hide
/// it.
fn texts() -> Vec<(&'static str, String)> {
    let buffer = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0f32]].as_flattened();
    let buffer = base64::engine::general_purpose::STANDARD.encode(bytemuck::cast_slice::<f32, u8>(buffer));
    let gltf = serde_json::json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": 36, "uri": format!("data:application/octet-stream;base64,{buffer}") }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
        ],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "nodes": [{ "mesh": 0 }],
    });
    vec![
        ("a.obj", "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 2 3 4\n".into()),
        ("a.ply", CUBE.into()),
        ("a.aff", "f 1 .5 .25 .5 .5 10 0 1\np 3\n0 0 0\n1 0 0\n0 1 0\n".into()),
        ("a.nff", "f 1 .5 .25 .5 .5 10 0 1\np 3\n0 0 0\n1 0 0\n0 1 0\n".into()),
        ("a.mgf", "v a =\n\tp 0 0 0\nv b =\n\tp 1 0 0\nv c =\n\tp 0 1 0\nf a b c\n".into()),
        ("a.iv", "#Inventor V2.1 ascii\nCube {}\n".into()),
        ("a.wrl", "#VRML V1.0 ascii\nCube {}\n".into()),
        ("a.gltf", gltf.to_string()),
    ]
}

fn same(marked: &Scene, plain: &Scene, name: &str) {
    assert_eq!(marked.content_hash(), plain.content_hash(), "{name}");
    assert_eq!(marked.warnings, plain.warnings, "{name}");
}

#[test]
fn a_mark_is_ignored_in_every_format() {
    for (name, text) in texts() {
        let load = |text: &str| Files::new(&[(name, text)]).load(name);
        let plain = load(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        same(&load(&format!("{MARK}{text}")).unwrap_or_else(|error| panic!("{name}: {error}")), &plain, name);
        // A mark is ignored only once, and only at the beginning.
        assert!(
            load(&format!("{MARK}{MARK}{text}")).is_err() || name.ends_with("obj") || name.ends_with("mgf"),
            "{name}"
        );
    }
}

#[test]
fn a_file_of_only_a_mark_is_empty() {
    for (name, _) in texts() {
        let message = |text: &str| {
            let files = Files::new(&[(name, text)]);
            refusal(files.load(name)).replace(files.folder.path().to_str().unwrap(), "")
        };
        assert_eq!(message(MARK), message(""), "{name}");
    }
}

#[test]
fn a_mark_is_ignored_in_libraries_and_includes() {
    let load = |mark: &str| {
        let library = format!("{mark}newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
        let mesh = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl blue\nf 3 2 1\n";
        let entities = format!("{mark}v a =\n\tp 0 0 0\n");
        let scene = "i part.mgf\nv b =\n\tp 1 0 0\nv c =\n\tp 0 1 0\nf a b c\n";
        Files::new(&[("a.mtl", &library), ("a.obj", mesh), ("part.mgf", &entities), ("a.mgf", scene)])
    };
    let (marked, plain) = (load(MARK), load(""));
    for name in ["a.obj", "a.mgf"] {
        same(&marked.load(name).unwrap(), &plain.load(name).unwrap(), name);
    }
    assert_eq!(marked.load("a.obj").unwrap().materials[0].diffuse, glam::Vec3::X);
}

#[test]
fn a_mark_changes_no_line_number() {
    let files = Files::new(&[("a.obj", "\u{feff}v 0 0\n"), ("b.obj", "\u{feff}v 0 0 0\nv 1 0 0\nf 1 2 9\n")]);
    assert!(refusal(files.load("a.obj")).contains("a.obj:1:"));
    assert!(refusal(files.load("b.obj")).contains("b.obj:3:"));
}

/// Binary data can begin with the same bytes.
#[test]
fn the_bytes_of_a_mark_are_kept_in_a_buffer() {
    let gltf = |name: &str| {
        texts().pop().map(|(_, text)| {
            let mut document: serde_json::Value = serde_json::from_str(&text).unwrap();
            document["buffers"][0]["uri"] = name.into();
            document.to_string()
        })
    };
    let files = Files::new(&[("a.gltf", &gltf("a.bin").unwrap())]);
    // The first coordinate has the bytes EF BB BF and a small exponent.
    let corners = [[f32::from_le_bytes([0xef, 0xbb, 0xbf, 0x3f]), 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0f32]];
    files.write("a.bin", bytemuck::cast_slice(corners.as_flattened()));
    assert_eq!(files.load("a.gltf").unwrap().vertices[0].position.x, corners[0][0]);
}
