//! Tests of glTF and GLB with generated files: all supported features, and all errors.

use super::refusal;
use crate::support::short;
use glam::Vec3;
use proptest::prelude::*;
use rtbench::Result;
use rtbench::scene::{self, Options, Scene, gltf};
use serde_json::{Value, json};
use std::path::Path;

/// The buffer of a triangle in the plane z = 0: 3 positions, 3 normals, 3 indices of two bytes, 2 bytes of padding.
pub(super) fn bytes() -> Vec<u8> {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0f32]];
    let floats: Vec<f32> = corners.into_iter().chain([[0.0, 0.0, 1.0]; 3]).flatten().collect();
    let mut bytes: Vec<u8> = floats.iter().flat_map(|f| f.to_le_bytes()).collect();
    bytes.extend([0u16, 1, 2, 0].iter().flat_map(|i| i.to_le_bytes()));
    bytes
}

/// The document for this buffer.
pub(super) fn document() -> Value {
    json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": 80 }],
        "bufferViews": [
            { "buffer": 0, "byteOffset": 0, "byteLength": 36 },
            { "buffer": 0, "byteOffset": 36, "byteLength": 36 },
            { "buffer": 0, "byteOffset": 72, "byteLength": 6 },
        ],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
            { "bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3" },
            { "bufferView": 2, "componentType": 5123, "count": 3, "type": "SCALAR" },
        ],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "NORMAL": 1 }, "indices": 2 }] }],
        "nodes": [{ "mesh": 0 }],
        "scenes": [{ "nodes": [0] }],
        "scene": 0,
    })
}

/// A GLB of a document and a buffer.
pub(super) fn glb(document: &Value, bytes: &[u8]) -> Vec<u8> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + text.len() + 8 + bytes.len();
    let word = |n: usize| (n as u32).to_le_bytes();
    [&b"glTF"[..], &word(2), &word(length), &word(text.len()), b"JSON", &text, &word(bytes.len()), b"BIN\0", bytes]
        .concat()
}

/// Loads a GLB of a document and the buffer of [`bytes`].
pub(super) fn try_load(document: &Value) -> Result<Scene> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.glb");
    std::fs::write(&path, glb(document, &bytes())).unwrap();
    scene::load(path.to_str().unwrap())
}

pub(super) fn load(document: &Value) -> Scene {
    try_load(document).unwrap_or_else(|e| panic!("{e}"))
}

/// The document with changed values at these JSON pointers.
pub(super) fn with(changes: &[(&str, Value)]) -> Value {
    let mut document = document();
    for (place, value) in changes {
        let (parent, key) = place.rsplit_once('/').unwrap();
        match document.pointer_mut(parent).unwrap_or_else(|| panic!("{place}")) {
            Value::Object(map) => drop(map.insert(key.into(), value.clone())),
            Value::Array(list) if key == "-" => list.push(value.clone()),
            Value::Array(list) => list[key.parse::<usize>().unwrap()] = value.clone(),
            _ => panic!("{place}"),
        }
    }
    document
}

pub(super) fn positions(scene: &Scene) -> Vec<[f32; 3]> {
    scene.vertices.iter().map(|v| v.position.to_array()).collect()
}

#[test]
fn all_kinds_of_files_and_buffers_are_read() {
    let scene = load(&document());
    assert_eq!(positions(&scene), [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert!(scene.vertices.iter().all(|v| v.normal == Vec3::Z));
    assert_eq!((scene.triangles[0].vertices, short(&scene.name).as_str()), ([0, 1, 2], "a"));
    assert_eq!((scene.materials[0], scene.warnings.len()), (scene::Material::neutral(), 0));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gltf");
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    let load = |uri: &str, settings: &str| {
        std::fs::write(&path, with(&[("/buffers/0/uri", json!(uri))]).to_string()).unwrap();
        scene::load(&format!("{}{settings}", path.display()))
    };
    use base64::Engine;
    let data = base64::engine::general_purpose::STANDARD.encode(bytes());
    for name in ["b.bin", "sub/b.bin", "my file.bin"] {
        std::fs::write(folder.path().join(name), bytes()).unwrap();
    }
    for uri in [
        "b.bin",
        "./sub/b.bin",
        "missing/../b.bin",
        "sub/../b.bin",
        "sub/deep/../b.bin",
        "my%20file.bin",
        &format!("data:application/octet-stream;base64,{data}"),
        &format!("data:;base64,{}", data.trim_end_matches('=')),
    ] {
        assert_eq!(load(uri, "").unwrap().content_hash(), scene.content_hash(), "{uri}");
    }
    for (uri, words) in [
        ("c.bin", "buffer c.bin cannot be read: no such file"),
        ("sub", "buffer sub cannot be read: not a regular file"),
        ("../b.bin", "outside=yes"),
        ("sub/../../b.bin", "outside=yes"),
        ("%2e%2e/b.bin", "outside=yes"),
        ("/etc/passwd", "outside=yes"),
        ("https://example.org/b.bin", "is a web address"),
        ("data:text/plain,hello", "not base64"),
        ("data:;base64,!!!", "data URI is broken"),
        ("data:;base64,AAAA", "buffer 0 is truncated: it has 3 bytes of 80"),
    ] {
        let message = refusal(load(uri, ""));
        assert!(message.contains(words), "{uri}: {message}");
    }
    let inner = folder.path().join("sub/a.gltf");
    std::fs::write(&inner, with(&[("/buffers/0/uri", json!("../b.bin"))]).to_string()).unwrap();
    scene::load(&format!("{}:outside=yes", inner.display())).unwrap();
    let message = refusal(load("\u{1}", ""));
    assert!(message.contains("cannot be read"), "{message}");
    std::fs::write(&path, "{\n  \"asset\": { \"version\": }\n}").unwrap();
    assert!(refusal(scene::load(path.to_str().unwrap())).contains("a.gltf:2: the JSON is not glTF"));
}

#[test]
fn nodes_transform_and_repeat_meshes() {
    let scene = load(&with(&[(
        "/nodes",
        json!([
            { "children": [1, 2], "translation": [10, 0, 0] },
            { "mesh": 0, "scale": [2, 2, 2] },
            { "mesh": 0, "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1] },
            { "mesh": 0, "translation": [99, 99, 99] },
        ]),
    )]));
    // No scene contains node 3.
    assert_eq!(
        positions(&scene),
        [[10.0, 0.0, 0.0], [12.0, 0.0, 0.0], [10.0, 2.0, 0.0], [10.0, 0.0, 5.0], [10.0, 1.0, 5.0], [9.0, 0.0, 5.0]]
    );
    assert!(scene.vertices.iter().all(|v| v.normal == Vec3::Z));
    // Mirroring inverts the winding, so that it agrees with the normals.
    let mirrored = load(&with(&[("/nodes/0", json!({ "mesh": 0, "scale": [-1, 1, 1] }))]));
    assert_eq!((mirrored.triangles[0].vertices, mirrored.vertices[0].normal), ([0, 2, 1], Vec3::Z));
    // With a singular transform, normals are computed.
    let flat = load(&with(&[("/nodes/0", json!({ "mesh": 0, "scale": [1, 1, 0] }))]));
    assert!(flat.vertices.iter().all(|v| v.normal == Vec3::Z));
    // Without a scene all nodes are read.
    let mut document = document();
    document.as_object_mut().unwrap().retain(|key, _| key != "scene" && key != "scenes");
    assert_eq!(load(&document).triangles.len(), 1);
    for nodes in [json!([{ "mesh": 0, "children": [0] }]), json!([{ "children": [1, 1] }, { "mesh": 0 }])] {
        let message = refusal(try_load(&with(&[("/nodes", nodes)])));
        assert!(message.contains("two parents or is its own ancestor"), "{message}");
    }
}

#[test]
fn strips_and_fans_are_read_and_points_and_lines_ignored() {
    // Four indices: 0, 1, 2, 1
    let mode = |mode: u32| {
        let primitive = json!({ "attributes": { "POSITION": 0, "NORMAL": 1 }, "mode": mode });
        with(&[("/meshes/0/primitives/0", primitive)])
    };
    for triangles in [4, 5, 6] {
        assert_eq!(load(&mode(triangles)).triangles[0].vertices, [0, 1, 2], "mode {triangles}");
    }
    for nothing in [0, 1, 2, 3] {
        assert!(refusal(try_load(&mode(nothing))).contains("has no triangles"), "mode {nothing}");
    }
    let lines = json!({ "attributes": { "POSITION": 0 }, "mode": 1 });
    let both = load(&with(&[("/meshes/0/primitives/-", lines.clone()), ("/meshes/0/primitives/-", lines)]));
    assert_eq!(both.warnings, ["2 primitives that are points or lines ignored"]);
    // In a strip every other triangle is inverted.
    let mut long = bytes();
    long.extend([0u8, 1, 2, 1, 0, 2, 0, 0]);
    let mut document = with(&[
        ("/buffers/0/byteLength", json!(88)),
        ("/bufferViews/-", json!({ "buffer": 0, "byteOffset": 80, "byteLength": 6 })),
        ("/accessors/2", json!({ "bufferView": 3, "componentType": 5121, "count": 6, "type": "SCALAR" })),
        ("/meshes/0/primitives/0/mode", json!(5)),
    ]);
    let read = |document: &Value| {
        gltf::read_bytes(Path::new("a.glb"), &glb(document, &long), &Options::default()).unwrap().triangles
    };
    let strip: Vec<[u32; 3]> = read(&document).iter().map(|t| t.vertices).collect();
    assert_eq!(strip, [[0, 1, 2], [2, 1, 1], [2, 1, 0], [0, 1, 2]]);
    document["meshes"][0]["primitives"][0]["mode"] = json!(6);
    let fan: Vec<[u32; 3]> = read(&document).iter().map(|t| t.vertices).collect();
    assert_eq!(fan, [[0, 1, 2], [0, 2, 1], [0, 1, 0], [0, 0, 2]]);
}

#[test]
fn missing_normals_give_flat_shading_and_sparse_values_replace_elements() {
    let mut document = document();
    document["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("NORMAL");
    let flat = load(&document);
    assert!(flat.vertices.len() == 3 && flat.vertices.iter().all(|v| v.normal == Vec3::Z) && flat.warnings.is_empty());
    // Vertex 2 is replaced by a sparse value, which is read from the bytes of the positions.
    let sparse = json!({ "count": 1,
        "indices": { "bufferView": 2, "byteOffset": 4, "componentType": 5123 },
        "values": { "bufferView": 1, "byteOffset": 12 } });
    let moved = load(&with(&[("/accessors/0/sparse", sparse.clone())]));
    assert_eq!(positions(&moved)[2], [0.0, 0.0, 1.0]);
    let mut zero = with(&[("/accessors/1/sparse", sparse)]);
    zero["accessors"][1].as_object_mut().unwrap().remove("bufferView");
    let repaired = load(&zero);
    assert!(repaired.warnings[0].starts_with("2 normals"), "{:?}", repaired.warnings);
    zero["accessors"][1]["count"] = json!(1_000_000_000);
    assert!(load(&zero).warnings[0].contains("more elements than the file can fill"));
    zero["accessors"][1]["count"] = json!(2);
    assert!(load(&zero).warnings[0].contains("different numbers of normals and positions"));
}

#[test]
fn materials_lights_and_cameras() {
    let scene = load(&with(&[
        (
            "/materials",
            json!([
                { "pbrMetallicRoughness": { "baseColorFactor": [1, 0.5, 0, 1], "metallicFactor": 0, "roughnessFactor": 1 } },
                { "pbrMetallicRoughness": { "baseColorFactor": [1, 0.5, 0, 1], "metallicFactor": 1, "roughnessFactor": 0.1 } },
            ]),
        ),
        ("/meshes/0/primitives/0/material", json!(1)),
        ("/extensionsUsed", json!(["KHR_lights_punctual"])),
        (
            "/extensions",
            json!({ "KHR_lights_punctual": { "lights": [
                { "type": "point", "color": [1, 0.5, 0], "intensity": 30 },
                { "type": "spot", "intensity": 10, "spot": {} },
                { "type": "directional" },
            ] } }),
        ),
        ("/cameras", json!([{ "type": "perspective", "perspective": { "yfov": 45f32.to_radians(), "znear": 0.1 } }])),
        ("/nodes/0", json!({ "mesh": 0, "children": [1, 2, 3, 4] })),
        ("/nodes/-", json!({ "translation": [1, 2, 3], "extensions": { "KHR_lights_punctual": { "light": 0 } } })),
        ("/nodes/-", json!({ "extensions": { "KHR_lights_punctual": { "light": 1 } } })),
        (
            "/nodes/-",
            json!({ "rotation": [-0.5f32.sqrt(), 0, 0, 0.5f32.sqrt()], "extensions": { "KHR_lights_punctual": { "light": 2 } } }),
        ),
        ("/nodes/-", json!({ "translation": [0, 0, 9], "rotation": [0, 1, 0, 0], "camera": 0 })),
    ]));
    let [matt, metal] = [scene.materials[0], scene.materials[1]];
    assert_eq!((matt.diffuse, matt.specular, matt.reflectivity), (Vec3::new(1.0, 0.5, 0.0), Vec3::splat(0.04), 0.0));
    assert_eq!((matt.exponent, scene.triangles[0].material), (1.0, 1));
    assert!((metal.reflectivity - 0.81).abs() < 1e-6 && metal.diffuse == Vec3::ZERO && metal.exponent == 10_000.0);
    assert_eq!(scene.lights.len(), 3);
    assert_eq!(scene.lights[0].position, Vec3::new(1.0, 2.0, 3.0));
    // The point lights of 30 and 10 candela share half of the brightness. The directional light has the other half and
    // is placed above.
    assert!(scene.lights[0].colour.abs_diff_eq(Vec3::new(0.375, 0.1875, 0.0), 1e-6), "{:?}", scene.lights);
    assert!(scene.lights[1].colour.abs_diff_eq(Vec3::splat(0.125), 1e-6));
    assert!(scene.lights[2].colour == Vec3::splat(0.5) && scene.lights[2].position.y > 10.0, "{:?}", scene.lights);
    let camera = scene.camera.unwrap();
    assert!((camera.field_of_view - 45.0).abs() < 1e-4 && camera.frames.len() == 1);
    let pose = camera.frames[0];
    assert_eq!(pose.position, Vec3::new(0.0, 0.0, 9.0));
    assert!(pose.direction.abs_diff_eq(Vec3::Z, 1e-6) && pose.up.abs_diff_eq(Vec3::Y, 1e-6));
    // The first camera is used, or the one that is named.
    let document = with(&[
        ("/cameras", json!([{ "name": "lens", "type": "perspective", "perspective": { "yfov": 1, "znear": 0.1 } }])),
        ("/nodes/0", json!({ "mesh": 0, "children": [1, 2] })),
        ("/nodes/-", json!({ "translation": [0, 0, 9], "camera": 0 })),
        ("/nodes/-", json!({ "name": "back", "translation": [0, 0, -9], "camera": 0 })),
    ]);
    let named = |camera: Option<&str>| {
        let options = Options { camera: camera.map(str::to_owned), ..Options::default() };
        gltf::read_bytes(Path::new("a.glb"), &glb(&document, &bytes()), &options)
    };
    for (camera, z) in [(None, 9.0), (Some("lens"), 9.0), (Some("back"), -9.0)] {
        assert_eq!(named(camera).unwrap().camera.unwrap().frames[0].position.z, z, "{camera:?}");
    }
    let error = named(Some("front")).unwrap_err().to_string();
    assert!(error.contains("there is no valid perspective camera `front`"), "{error}");
    // Emissive surfaces become lights if there are no other lights.
    let lamp = load(&with(&[
        ("/materials", json!([{ "emissiveFactor": [1, 1, 0.5] }])),
        ("/meshes/0/primitives/0/material", json!(0)),
    ]));
    assert_eq!((lamp.lights.len(), lamp.lights[0].colour), (1, Vec3::new(1.0, 1.0, 0.5)));
    let orthographic =
        json!([{ "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 1, "zfar": 9, "znear": 1 } }]);
    let flat = load(&with(&[("/cameras", orthographic), ("/nodes/0/camera", json!(0))]));
    assert!(flat.camera.is_none() && flat.warnings[0].contains("orthographic"));
}

#[test]
fn invalid_files_are_refused() {
    for (changes, words) in [
        (("/buffers/0/byteLength", json!(81)), "buffer 0 is truncated: it has 80 bytes of 81"),
        (("/bufferViews/0/byteOffset", json!(60)), "buffer view 0 reaches beyond its buffer"),
        (("/bufferViews/0/byteLength", json!(35)), "accessor 0 reaches beyond its buffer view"),
        (("/bufferViews/0/byteStride", json!(24)), "accessor 0 reaches beyond its buffer view"),
        (("/bufferViews/0/byteStride", json!(4)), "accessor 0 reaches beyond its buffer view"),
        (("/accessors/0/count", json!(1_000_000_000_000u64)), "accessor 0 reaches beyond its buffer view"),
        (("/accessors/0/byteOffset", json!(u64::MAX)), "accessor 0 reaches beyond its buffer view"),
        (("/accessors/0/type", json!("VEC2")), "accessor 0 must have three floats"),
        (("/accessors/2/componentType", json!(5126)), "accessor 2 must hold unsigned integers"),
        (("/accessors/2/type", json!("VEC3")), "accessor 2 must have one index"),
        (("/accessors/2/byteOffset", json!(2)), "accessor 2 reaches beyond"),
        (("/bufferViews/2/byteOffset", json!(68)), "a primitive uses vertex"),
        (("/meshes/0/primitives/0/attributes", json!({})), "no triangles: 1 primitives without POSITION ignored"),
        (
            ("/meshes/0/primitives/0/indices", json!(7)),
            "meshes[0].primitives[0].indices names accessor 7, which does not exist",
        ),
        (("/accessors", json!([])), "accessor 0, which does not exist"),
        (("/nodes/0/mesh", json!(1)), "nodes[0].mesh names mesh 1, which does not exist"),
        (("/nodes/0/scale", json!([1e38, 1e38, 1e38])), ""),
        (
            ("/extensionsRequired", json!(["KHR_lights_punctual", "X_y"])),
            "requires the extension X_y, which is not supported",
        ),
    ] {
        let (place, value) = changes;
        let message = refusal(try_load(&with(&[(place, value.clone())])));
        assert!(message.contains(words), "{place} {value}: {message}");
    }
    let sound = glb(&document(), &bytes());
    for length in [0, 3, 4, 11, 12, 20, 40, sound.len() - 80, sound.len() - 1] {
        let cut = gltf::read_bytes(Path::new("a.glb"), &sound[..length], &Options::default());
        assert!(!refusal(cut).is_empty(), "{length}");
    }
}

#[test]
fn other_versions_and_compression_are_reported_first() {
    for (version, least, read) in [
        ("2.0", None, true),
        ("2.1", None, true),
        ("2.5", Some("2.0"), true),
        ("2.5", Some("2.5"), false),
        ("1.0", None, false),
        ("3.0", None, false),
        ("banana", None, false),
        ("2.", None, false),
    ] {
        let mut document = with(&[("/asset/version", json!(version))]);
        if let Some(least) = least {
            document["asset"]["minVersion"] = json!(least);
        }
        match try_load(&document) {
            Ok(scene) => {
                let warned = scene.warnings.iter().any(|w| w.contains(&format!("glTF of version {version}")));
                assert!(read && warned == (version != "2.0"), "{version} {least:?}: {:?}", scene.warnings);
            }
            Err(error) => assert!(!read && error.to_string().contains("only 2.0 is supported"), "{version}: {error}"),
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("old.gltf");
    std::fs::write(&path, r#"{"asset": {"version": "1.0"}, "buffers": {"b": {"uri": "b.bin"}}, "meshes": {}}"#)
        .unwrap();
    let message = refusal(scene::load(path.to_str().unwrap()));
    assert!(message.contains("old.gltf: this is glTF of version 1.0, only 2.0 is supported"), "{message}");
    // Compressed files have accessors without data.
    let mut document = with(&[("/extensionsRequired", json!(["KHR_draco_mesh_compression"]))]);
    for accessor in document["accessors"].as_array_mut().unwrap() {
        accessor.as_object_mut().unwrap().remove("bufferView");
    }
    let message = refusal(try_load(&document));
    assert!(message.contains("KHR_draco_mesh_compression") && message.contains("gltf-transform"), "{message}");
    let sound = glb(&document, &bytes());
    let read = |bytes: &[u8]| refusal(gltf::read_bytes(Path::new("a.glb"), bytes, &Options::default()));
    assert!(read(&sound[..sound.len() - 1]).contains("the file is truncated: it has"));
    assert!(read(&sound[..10]).contains("the file is truncated within its header"));
    assert!(read(&[&sound[..4], &[1, 0, 0, 0], &sound[8..]].concat()).contains("a GLB of version 1"));
}

#[test]
fn ignored_features_give_warnings() {
    let material = |mode: &str, alpha: f32| {
        with(&[
            (
                "/materials",
                json!([{ "alphaMode": mode, "pbrMetallicRoughness": { "baseColorFactor": [1, 1, 1, alpha] } }]),
            ),
            ("/meshes/0/primitives/0/material", json!(0)),
        ])
    };
    for (mode, alpha, told) in
        [("BLEND", 0.5, true), ("MASK", 0.5, true), ("OPAQUE", 0.5, false), ("BLEND", 1.0, false)]
    {
        let expected: &[&str] = if told { &["transparent material: rendered opaque"] } else { &[] };
        assert_eq!(load(&material(mode, alpha)).warnings, expected, "{mode} {alpha}");
    }
    let coloured = with(&[("/meshes/0/primitives/0/attributes/COLOR_0", json!(1))]);
    assert_eq!(load(&coloured).warnings, ["vertex colours ignored"]);
}

#[cfg(unix)]
#[test]
fn links_to_files_outside_of_the_folder_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("in")).unwrap();
    std::fs::write(folder.path().join("out.bin"), bytes()).unwrap();
    std::os::unix::fs::symlink(folder.path().join("out.bin"), folder.path().join("in/b.bin")).unwrap();
    let path = folder.path().join("in/a.gltf");
    std::fs::write(&path, with(&[("/buffers/0/uri", json!("b.bin"))]).to_string()).unwrap();
    let message = refusal(scene::load(path.to_str().unwrap()));
    assert!(message.contains("buffer b.bin lies outside of the scene's folder"), "{message}");
    scene::load(&format!("{}:outside=yes", path.display())).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    /// A file with changed, removed or inserted bytes gives a valid scene or one error, and does not panic.
    #[test]
    fn mutated_files_never_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4u8), 1..5),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut document = with(&[
            ("/accessors/0/sparse", json!({ "count": 1,
                "indices": { "bufferView": 2, "byteOffset": 4, "componentType": 5123 },
                "values": { "bufferView": 1, "byteOffset": 12 } })),
            ("/materials", json!([{ "emissiveFactor": [1, 1, 0.5] }])),
            ("/meshes/0/primitives/0/material", json!(0)),
            ("/cameras", json!([{ "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1 } }])),
            ("/nodes/0/camera", json!(0)),
        ]);
        document["extensionsUsed"] = json!(["KHR_lights_punctual"]);
        document["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "spot", "spot": {} }] } });
        document["nodes"][0]["extensions"] = json!({ "KHR_lights_punctual": { "light": 0 } });
        let mut bytes = glb(&document, &bytes());
        for (index, value, kind) in changes {
            let at = index.index(bytes.len());
            match kind {
                0 => bytes[at] = value,
                1 => bytes.insert(at, value),
                2 => { bytes.remove(at); }
                _ => bytes[at] = b"0123456789-.e,:\"[]{}"[value as usize % 20],
            }
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        if let Ok(scene) = gltf::read_bytes(Path::new("mutated.glb"), &bytes, &Options::default())
            && let Err(error) = scene.check()
        {
            let error = error.to_string();
            prop_assert!(["too large", "is not finite"].iter().any(|words| error.contains(words)), "{}", error);
        }
    }
}

/// Found by fuzzing: the length in the header is smaller than the header.
#[test]
fn a_glb_shorter_than_its_header_is_refused() {
    let mut bytes = glb(&document(), &bytes());
    bytes[8..12].copy_from_slice(&11u32.to_le_bytes());
    let message = refusal(gltf::read_bytes(Path::new("a.glb"), &bytes, &Options::default()));
    assert!(message.contains("its header gives the length 11"), "{message}");
}
