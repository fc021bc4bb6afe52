//! Tests of glTF with what is no geometry: it is passed over, or becomes a warning, and never costs the geometry.

use super::gltf::{bytes, document, glb, load, positions, try_load, with};
use super::{Files, refusal};
use glam::Vec3;
use rtbench::scene::{Options, Scene, gltf};
use serde_json::{Value, json};
use std::path::Path;

/// Asserts that a document is the triangle of [`document`], and returns its warnings.
fn warnings(document: &Value, what: &str) -> Vec<String> {
    let scene = try_load(document).unwrap_or_else(|error| panic!("{what}: {error}"));
    is_triangle(&scene, what);
    scene.warnings
}

fn is_triangle(scene: &Scene, what: &str) {
    assert_eq!(positions(scene), [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], "{what}");
    assert_eq!((scene.triangles.len(), scene.triangles[0].vertices), (1, [0, 1, 2]), "{what}");
}

/// A document with every kind of object that is read.
fn rich() -> Value {
    let mut rich = with(&[
        ("/materials", json!([{ "pbrMetallicRoughness": { "baseColorFactor": [1, 0.5, 0, 1] } }])),
        ("/meshes/0/primitives/0/material", json!(0)),
        ("/meshes/0/primitives/0/targets", json!([{ "POSITION": 0 }])),
        ("/meshes/0/weights", json!([0.0])),
        ("/cameras", json!([{ "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1 } }])),
        ("/nodes/0/camera", json!(0)),
        ("/nodes/0/children", json!([1])),
        ("/nodes/-", json!({ "translation": [0, 0, 9] })),
        ("/extensions", json!({ "KHR_lights_punctual": { "lights": [{ "type": "point" }] } })),
        ("/nodes/0/extensions", json!({ "KHR_lights_punctual": { "light": 0 } })),
        ("/extensionsUsed", json!(["KHR_lights_punctual"])),
        ("/images", json!([{ "uri": "a.png" }])),
        ("/textures", json!([{ "source": 0 }])),
        ("/samplers", json!([{}])),
    ]);
    rich["accessors"][0]["sparse"] = json!({ "count": 1,
        "indices": { "bufferView": 2, "componentType": 5123 }, "values": { "bufferView": 0 } });
    rich
}

/// All objects of a document, as JSON pointers.
fn objects(value: &Value, place: &str, found: &mut Vec<String>) {
    match value {
        Value::Object(map) => {
            found.push(place.to_owned());
            map.iter().for_each(|(key, inner)| objects(inner, &format!("{place}/{key}"), found));
        }
        Value::Array(list) => {
            list.iter().enumerate().for_each(|(i, inner)| objects(inner, &format!("{place}/{i}"), found));
        }
        _ => {}
    }
}

/// Whole numbers become floats with a fraction of zero.
fn as_floats(value: &mut Value) {
    match value {
        Value::Object(map) => map.values_mut().for_each(as_floats),
        Value::Array(list) => list.iter_mut().for_each(as_floats),
        Value::Number(number) => {
            let float = serde_json::Number::from_f64(number.as_f64().unwrap()).unwrap();
            *number = float;
        }
        _ => {}
    }
}

#[test]
fn extras_and_extensions_of_any_type_are_passed_over_everywhere() {
    let rich = rich();
    is_triangle(&load(&rich), "rich");
    let mut places = Vec::new();
    objects(&rich, "", &mut places);
    assert!(places.len() > 30, "{places:?}");
    let deep = (0..300).fold(json!(1), |inner, _| json!([inner]));
    for extra in [json!(null), json!(true), json!(1.5), json!("text"), json!([1, 2]), json!({ "a": [{}] }), deep] {
        for place in &places {
            let mut document = rich.clone();
            let object = document.pointer_mut(place).unwrap().as_object_mut().unwrap();
            object.insert("extras".into(), extra.clone());
            object.insert("an unknown \"property\"".into(), extra.clone());
            assert_eq!(warnings(&document, place), [""; 0], "{place}: {extra}");
            let object = document.pointer_mut(place).unwrap().as_object_mut().unwrap();
            let extensions = object.entry("extensions").or_insert_with(|| json!({}));
            extensions["VENDOR_anything"] = extra.clone();
            assert_eq!(warnings(&document, place), [""; 0], "{place}: {extra}");
        }
    }
}

#[test]
fn whole_numbers_may_have_a_fraction_of_zero() {
    let mut floats = rich();
    as_floats(&mut floats);
    assert!(floats.to_string().contains("\"count\":3.0"));
    let [read, expected] = [load(&floats), load(&rich())];
    assert_eq!(read.content_hash(), expected.content_hash());
    assert_eq!(read.camera, expected.camera);
    for (count, words) in [(json!(3.5), "accessors[0].count: invalid value"), (json!(-3), "accessors[0].count")] {
        let message = refusal(try_load(&with(&[("/accessors/0/count", count)])));
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn absent_may_be_null() {
    let mut nulls = document();
    for (place, keys) in [
        ("", &["cameras", "materials", "extensions", "extensionsUsed", "extensionsRequired", "animations"][..]),
        ("/asset", &["minVersion"]),
        ("/nodes/0", &["children", "camera", "skin", "matrix", "rotation", "weights", "extensions", "name"]),
        ("/meshes/0", &["weights"]),
        ("/meshes/0/primitives/0", &["material", "mode", "targets", "extensions"]),
        ("/accessors/0", &["sparse", "normalized", "byteOffset", "min", "max"]),
        ("/bufferViews/0", &["byteStride", "target"]),
        ("/buffers/0", &["uri"]),
    ] {
        let object = nulls.pointer_mut(place).unwrap().as_object_mut().unwrap();
        keys.iter().for_each(|key| drop(object.insert((*key).into(), json!(null))));
    }
    assert_eq!(warnings(&nulls, "null"), [""; 0]);
    nulls["scene"] = json!(null);
    nulls["scenes"] = json!(null);
    assert_eq!(warnings(&nulls, "null scenes"), [""; 0]);
}

#[test]
fn what_is_never_read_is_not_validated() {
    let attribute = |name: &str, accessor: Value| {
        let mut document = with(&[("/accessors/-", accessor)]);
        document["meshes"][0]["primitives"][0]["attributes"][name] = json!(3);
        document
    };
    let bad = json!({ "bufferView": 77, "componentType": 5130, "count": -1, "type": "VEC9" });
    let mut cases = vec![
        ("an attribute of an application", attribute("_FEATURE_ID_0", bad.clone())),
        (
            "a scalar attribute",
            attribute(
                "_BATCHID",
                json!({ "bufferView": 0, "componentType": 5126, "count": 3,
            "type": "SCALAR" }),
            ),
        ),
        ("texture coordinates", attribute("TEXCOORD_0", bad.clone())),
        ("tangents", attribute("TANGENT", json!("none"))),
        ("an accessor that nothing uses", with(&[("/accessors/-", json!(7))])),
        ("a view that nothing uses", with(&[("/bufferViews/-", json!({ "buffer": 9, "byteLength": "many" }))])),
        ("a buffer without uri", with(&[("/buffers/-", json!({}))])),
        ("a buffer without its file", with(&[("/buffers/-", json!({ "byteLength": 12, "uri": "not_there.bin" }))])),
        ("a buffer outside", with(&[("/buffers/-", json!({ "byteLength": 12, "uri": "../a.bin" }))])),
        ("a web address", with(&[("/buffers/-", json!({ "byteLength": 12, "uri": "https://a.org/a.bin" }))])),
        ("a mesh that nothing uses", with(&[("/meshes/-", json!({ "primitives": [{ "mode": 99 }] }))])),
        ("a node outside of the scene", with(&[("/nodes/-", json!({ "mesh": 9, "matrix": "none" }))])),
        ("another scene", with(&[("/scenes/-", json!({ "name": "empty" }))])),
        ("a broken scene", with(&[("/scenes/-", json!({ "nodes": [99, "x"] }))])),
        (
            "an empty scene before",
            with(&[("/scenes", json!([{ "name": "empty" }, { "nodes": [0] }])), ("/scene", json!(1))]),
        ),
        ("no default", with(&[("/scenes", json!([{ "name": "empty" }, { "nodes": [0] }])), ("/scene", json!(null))])),
        ("no scenes", with(&[("/scenes", json!([]))])),
        (
            "a channel without node",
            with(&[(
                "/animations",
                json!([{ "channels": [{ "sampler": 0,
            "target": { "path": "translation" } }], "samplers": [{ "input": 9, "output": 9 }] }]),
            )]),
        ),
        ("a skin that nothing uses", with(&[("/skins", json!([{ "joints": [99] }]))])),
        ("a camera that nothing uses", with(&[("/cameras", json!([{ "type": 7 }]))])),
        ("weights without targets", with(&[("/meshes/0/weights", json!("none")), ("/nodes/0/weights", json!({}))])),
        ("null bounds", with(&[("/accessors/0/min", json!([null, null, null])), ("/accessors/0/max", json!(null))])),
        ("false bounds", with(&[("/accessors/0/min", json!([9, 9, 9])), ("/accessors/0/max", json!([]))])),
        ("targets of views", with(&[("/bufferViews/0/target", json!(1)), ("/bufferViews/2/target", json!("x"))])),
        ("a stride of zero", with(&[("/bufferViews/0/byteStride", json!(0))])),
        ("no byteLength", with(&[("/buffers/0", json!({}))])),
        (
            "a texture without source",
            with(&[
                (
                    "/textures",
                    json!([{ "extensions": { "KHR_texture_basisu":
            { "source": 0 } } }, 5]),
                ),
                ("/images", json!({})),
                ("/extensionsUsed", json!(["KHR_texture_basisu"])),
            ]),
        ),
    ];
    for version in [json!(2), json!(2.0), json!("2.0"), json!("2")] {
        cases.push(("a version", with(&[("/asset/version", version)])));
    }
    for (what, document) in cases {
        assert_eq!(warnings(&document, what), [""; 0], "{what}");
    }
}

#[test]
fn malformed_materials_lights_and_cameras_are_warnings() {
    let material =
        |material: Value, index: Value| with(&[("/materials", material), ("/meshes/0/primitives/0/material", index)]);
    let camera = |camera: Value| with(&[("/cameras", camera), ("/nodes/0/camera", json!(0))]);
    let light = |lights: Value| {
        with(&[
            ("/extensions", json!({ "KHR_lights_punctual": { "lights": lights } })),
            ("/nodes/0/extensions", json!({ "KHR_lights_punctual": { "light": 0 } })),
        ])
    };
    let three = json!([{ "pbrMetallicRoughness": { "baseColorFactor": [1, 1, 1] } }, 5]);
    for (document, words) in [
        (material(three, json!(0)), "materials[0].pbrMetallicRoughness.baseColorFactor"),
        (material(json!([{}]), json!(1)), "meshes[0].primitives[0] has a material that does not exist"),
        (material(json!([{}]), json!("red")), "meshes[0].primitives[0] has a material that does not exist"),
        (material(json!({}), json!(0)), "materials: invalid type"),
        (camera(json!([{ "type": "perspective", "perspective": {} }])), "cameras[0].perspective: missing field `yfov`"),
        (camera(json!([])), "nodes[0].camera names camera 0, which does not exist"),
        (light(json!([{ "type": "ambient" }])), "lights[0].type: unknown variant `ambient`"),
        (light(json!([])), "nodes[0] names light 0, which does not exist"),
    ] {
        let told = warnings(&document, words);
        assert!(told.len() == 1 && told[0].starts_with("material, light or camera ignored"), "{told:?}");
        assert!(told[0].contains(words), "{words}: {told:?}");
    }
    // A spot light without a cone is a light, and colours have defaults.
    let spot = load(&light(json!([{ "type": "spot" }])));
    assert_eq!((spot.lights.len(), spot.lights[0].colour), (1, Vec3::ONE));
}

#[test]
fn primitives_without_positions_are_skipped() {
    let document = with(&[
        ("/meshes/0/primitives/-", json!({ "attributes": { "NORMAL": 1 } })),
        ("/meshes/0/primitives/-", json!({ "attributes": {}, "indices": 99 })),
        ("/meshes/0/primitives/-", json!({})),
    ]);
    assert_eq!(warnings(&document, "skipped"), ["3 primitives without POSITION ignored"]);
    // A mesh without primitives, and nodes without anything
    let document =
        with(&[("/meshes/-", json!({})), ("/nodes/-", json!({ "mesh": 1 })), ("/scenes/0/nodes", json!([1, 0]))]);
    assert_eq!(warnings(&document, "empty"), [""; 0]);
}

#[test]
fn accessors_without_view_are_zeros() {
    let normals = load(&with(&[("/accessors/1", json!({ "componentType": 5126, "count": 3, "type": "VEC3" }))]));
    is_triangle(&normals, "normals");
    assert!(normals.vertices.iter().all(|v| v.normal == Vec3::Z));
    assert_eq!(normals.warnings, ["3 normals in the file are zero or not finite: computed instead"]);
    // Sparse elements over zeros: the corners themselves
    let mut sparse = with(&[(
        "/accessors/0",
        json!({ "componentType": 5126, "count": 3, "type": "VEC3", "sparse": { "count": 3,
            "indices": { "bufferView": 2, "componentType": 5123 }, "values": { "bufferView": 0 } } }),
    )]);
    is_triangle(&load(&sparse), "sparse");
    sparse["accessors"][0]["sparse"]["indices"]["componentType"] = json!(5126);
    assert!(refusal(try_load(&sparse)).contains("accessor 0 has sparse indices that are not unsigned integers"));
    // An attribute that is not read
    let colours = with(&[
        ("/accessors/-", json!({ "componentType": 5126, "count": 3, "type": "VEC3" })),
        ("/meshes/0/primitives/0/attributes/COLOR_0", json!(3)),
    ]);
    assert_eq!(warnings(&colours, "colours"), ["vertex colours ignored"]);
}

/// A GLB of chunks with their names.
fn chunks(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let word = |n: usize| (n as u32).to_le_bytes();
    let mut all: Vec<u8> = [&b"glTF"[..], &word(2), &word(0)].concat();
    for (name, content) in chunks {
        all.extend(word(content.len()));
        all.extend(*name);
        all.extend(*content);
    }
    let length = word(all.len());
    all[8..12].copy_from_slice(&length);
    all
}

#[test]
fn chunks_of_other_kinds_are_passed_over() {
    let (mut text, bytes) = (document().to_string().into_bytes(), bytes());
    text.resize(text.len().next_multiple_of(4), b' ');
    let (json, bin, other): (_, _, (&[u8; 4], &[u8])) =
        ((b"JSON", &text[..]), (b"BIN\0", &bytes[..]), (b"XMP ", &[1, 2, 3, 4]));
    let read = |bytes: &[u8]| gltf::read_bytes(Path::new("a.glb"), bytes, &Options::default());
    for (what, parts) in [
        ("first", vec![other, json, bin]),
        ("between", vec![json, other, bin]),
        ("last", vec![json, bin, other]),
        ("empty", vec![json, (b"XMP ", &[]), bin]),
        ("twice", vec![json, bin, (b"BIN\0", &[0])]),
    ] {
        is_triangle(&read(&chunks(&parts)).unwrap(), what);
    }
    let whole = chunks(&[json, bin]);
    is_triangle(&read(&[&whole[..], b"behind the end"].concat()).unwrap(), "bytes behind the end");
    let zeros = [&text[..], &[0; 8]].concat();
    is_triangle(&read(&chunks(&[(b"JSON", &zeros), bin])).unwrap(), "zeros as padding");
    assert!(refusal(read(&chunks(&[bin]))).contains("the GLB has no JSON chunk"));
    assert!(refusal(read(&chunks(&[json]))).contains("buffer 0 has neither a uri nor a binary chunk"));
    let mut long = chunks(&[json, bin]);
    long[12..16].copy_from_slice(&1_000_000u32.to_le_bytes());
    assert!(refusal(read(&long)).contains("a chunk of the GLB has 1000000 bytes, but only"));
}

#[test]
fn names_may_be_in_any_encoding() {
    let text = with(&[("/nodes/0/name", json!("NAME")), ("/buffers/0/uri", json!("b.bin"))]).to_string();
    let files = Files::new(&[]);
    files.write("b.bin", &bytes());
    let (before, behind) = text.split_once("NAME").unwrap();
    files.write("latin.gltf", &[before.as_bytes(), b"Geb\xe4ude", behind.as_bytes()].concat());
    is_triangle(&files.load("latin.gltf").unwrap(), "Latin-1");
    files.write("mark.gltf", &["\u{feff}".as_bytes(), text.as_bytes()].concat());
    is_triangle(&files.load("mark.gltf").unwrap(), "byte order mark");
    let wide: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    files.write("wide.gltf", &[b"\xff\xfe", &wide[..]].concat());
    is_triangle(&files.load("wide.gltf").unwrap(), "UTF-16 with a byte order mark");
    files.write("wide.gltf", &wide);
    assert!(refusal(files.load("wide.gltf")).contains("UTF-16"));
}

#[test]
fn numbers_that_json_does_not_have_are_null() {
    let mut bare = with(&[
        ("/accessors/0/min", json!([7771, 7772, 7773])),
        ("/nodes/0/name", json!("a \"NaN\" \\")),
        ("/nodes/0/extras", json!([7774, "NaN", -1])),
    ])
    .to_string();
    for (number, bare_number) in [("7771", "-Infinity"), ("7772", "NaN"), ("7773", "Infinity"), ("7774", "-nan")] {
        bare = bare.replace(number, bare_number);
    }
    let read = |text: &str| {
        let mut chunk = text.as_bytes().to_vec();
        chunk.resize(chunk.len().next_multiple_of(4), b' ');
        let whole = chunks(&[(b"JSON", &chunk), (b"BIN\0", &bytes())]);
        gltf::read_bytes(Path::new("a.glb"), &whole, &Options::default())
    };
    is_triangle(&read(&bare).unwrap(), "NaN");
    let message = refusal(read(&document_with_nan()));
    assert!(message.contains("nodes[0].translation[1]: invalid type: null"), "{message}");
}

/// A document with NaN where it is read.
fn document_with_nan() -> String {
    with(&[("/nodes/0/translation", json!([0, 7777, 0]))]).to_string().replace("7777", "NaN")
}

#[test]
fn uris_are_read_as_exporters_write_them() {
    use base64::Engine;
    let data = base64::engine::general_purpose::STANDARD.encode(bytes());
    let files = Files::new(&[]);
    files.write("sub/b.bin", &bytes());
    let lines = data.as_bytes().chunks(20).map(|line| std::str::from_utf8(line).unwrap()).collect::<Vec<_>>();
    for uri in [
        "sub\\b.bin",
        ".\\sub\\b.bin",
        &format!("data:;base64,{}", lines.join("\n")),
        &format!("data:application/gltf-buffer;base64,{}", data.replace('/', "%2F").replace('=', "%3D")),
    ] {
        files.write("a.gltf", with(&[("/buffers/0/uri", json!(uri))]).to_string().as_bytes());
        is_triangle(&files.load("a.gltf").unwrap_or_else(|error| panic!("{uri}: {error}")), uri);
    }
    files.write("a.gltf", with(&[("/buffers/0/uri", json!("..\\scene\\sub\\b.bin"))]).to_string().as_bytes());
    assert!(refusal(files.load("a.gltf")).contains("outside=yes"));
}

#[test]
fn faults_have_their_place_and_line() {
    let files = Files::new(&[]);
    files.write("b.bin", &bytes());
    let mut document = with(&[("/buffers/0/uri", json!("b.bin"))]);
    document["nodes"][0]["rotation"] = json!([0, 0, 1]);
    let text = serde_json::to_string_pretty(&document).unwrap();
    let line = 1 + text.lines().position(|line| line.contains("rotation")).unwrap();
    files.write("a.gltf", text.as_bytes());
    let message = refusal(files.load("a.gltf"));
    assert!(message.contains(&format!("a.gltf:{}: nodes[0].rotation: invalid length 3", line + 4)), "{message}");
    for (changes, words) in [
        (("/nodes/0/children", json!(["x"])), "nodes[0].children[0]: invalid type: string"),
        (("/nodes/0/mesh", json!("a\nb")), "nodes[0].mesh: invalid type: string"),
        (("/nodes/0/mesh", json!(-1)), "nodes[0].mesh: invalid value: integer `-1`"),
        (("/nodes/0/children", json!([7])), "nodes[0].children names node 7, which does not exist"),
        (("/scenes/0/nodes", json!([3])), "the scene names node 3, which does not exist"),
        (("/scene", json!(4)), "scene names scene 4, which does not exist"),
        (("/scene", json!("first")), "scene: invalid type: string"),
        (
            ("/meshes/0/primitives/0/mode", json!(7)),
            "meshes[0].primitives: primitive 0 has the mode 7, which is not 0 to 6",
        ),
        (("/meshes/0/primitives/0/indices", json!({})), "meshes[0].primitives[0].indices: invalid type: map"),
        (("/meshes", json!({})), "meshes: invalid type: map, expected an array"),
        (("/accessors/0/bufferView", json!(9)), "accessors[0] names buffer view 9, which does not exist"),
        (("/bufferViews/0/buffer", json!(5)), "bufferViews[0] names buffer 5, which does not exist"),
        (("/accessors/0", json!({ "count": 3 })), "accessors[0]: missing field"),
        (("/accessors/0/componentType", json!(5130)), "accessor 0 must have three floats, bytes or shorts"),
        (("/asset", json!({})), "it has no asset.version"),
        (("/asset", json!(null)), "it has no asset.version"),
    ] {
        let message = refusal(try_load(&with(&[changes])));
        assert!(message.contains(words), "{words}: {message}");
    }
    // The place is also found behind properties that are parsed later.
    let mut rich = rich();
    rich["nodes"][0]["weights"] = json!([0]);
    rich["nodes"][0]["translation"] = json!([0, "x", 0]);
    let message = refusal(try_load(&rich));
    assert!(message.contains("nodes[0].translation[1]: invalid type: string"), "{message}");
    rich["nodes"][0]["translation"] = json!([0, 0, 0]);
    rich["meshes"][0]["primitives"][0]["indices"] = json!("x");
    let message = refusal(try_load(&rich));
    assert!(message.contains("meshes[0].primitives[0].indices: invalid type: string"), "{message}");
    for text in ["", "[]", "5", "{", "{}", "nonsense", "{\"asset\":{\"version\":\"2.0\"}} x"] {
        let message = refusal(gltf::read_bytes(Path::new("a.gltf"), text.as_bytes(), &Options::default()));
        assert!(message.contains("not glTF") || message.contains("no asset.version"), "{text}: {message}");
    }
    let glb = glb(&with(&[("/nodes/0/mesh", json!("x"))]), &bytes());
    assert!(refusal(gltf::read_bytes(Path::new("a.glb"), &glb, &Options::default())).starts_with("a.glb: nodes[0]"));
}

#[test]
fn malformed_normals_are_computed() {
    let mut reference = document();
    reference["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("NORMAL");
    for (place, value, words) in [
        ("/meshes/0/primitives/0/attributes/NORMAL", json!(77), "NORMAL names accessor 77, which does not exist"),
        ("/meshes/0/primitives/0/attributes/NORMAL", json!("x"), "meshes[0].primitives[0].NORMAL is not an index"),
        ("/accessors/1/count", json!(2), "has different numbers of normals and positions"),
        ("/accessors/1/type", json!("VEC4"), "accessor 1 must have three floats"),
        ("/accessors/1/componentType", json!(5121), "accessor 1 must have three floats"),
        ("/accessors/1/count", json!(1_000_000), "accessor 1 reaches beyond its buffer view"),
        ("/accessors/1/componentType", json!("x"), "accessors[1].componentType"),
    ] {
        let wrong = with(&[(place, value)]);
        let warnings = warnings(&wrong, words);
        assert!(warnings.len() == 1 && warnings[0].starts_with("normals or morph targets ignored"), "{warnings:?}");
        assert!(warnings[0].contains(words), "{warnings:?}");
        assert_eq!(load(&wrong).content_hash(), load(&reference).content_hash(), "{words}");
    }
}

#[test]
fn lights_and_cameras_that_are_not_usable_are_named() {
    for (light, translation, words) in [
        (json!({ "type": "point" }), json!([0.0, 0.0, 1e39]), "nodes[1] has a light at [0, 0, inf]"),
        (json!({ "type": "point", "intensity": 1e39 }), json!([0, 0, 9]), "lights[0].intensity: number out of range"),
    ] {
        let scene = with(&[
            (
                "/nodes/-",
                json!({ "translation": translation, "extensions": { "KHR_lights_punctual": { "light": 0 } } }),
            ),
            ("/scenes/0/nodes", json!([0, 1])),
            ("/extensions", json!({ "KHR_lights_punctual": { "lights": [light] } })),
        ]);
        let warnings = warnings(&scene, words);
        assert!(warnings.iter().any(|warning| warning.contains(words)), "{words}: {warnings:?}");
    }
    for (kind, words) in [("perspective", "cameras[0] has no perspective"), ("orthographic", "orthographic camera")] {
        let scene = with(&[("/cameras", json!([{ "type": kind }])), ("/nodes/0/camera", json!(0))]);
        let warnings = warnings(&scene, words);
        assert!(warnings.len() == 1 && warnings[0].contains(words), "{kind}: {warnings:?}");
    }
}
