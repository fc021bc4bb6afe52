//! Tests of the memory budgets: small files that repeat their geometry are read, and refused beyond the option
//! `memory=`; what a file declares must be backed by its bytes, whatever that option is.

use super::gltf::glb;
use super::{Files, refusal};
use crate::support::short;
use rtbench::scene::Options;
use serde_json::{Value, json};
use std::fmt::Write;

/// Asserts that a file has this many triangles, is refused with `memory=64M` by an error that names the option, and is
/// read with `memory=` as well.
fn repeats(name: &str, bytes: &[u8], triangles: usize) {
    let files = Files::new(&[]);
    files.write(name, bytes);
    let [alone, allowed] = ["", ":memory=2G"].map(|option| files.load(&format!("{name}{option}")).unwrap());
    assert_eq!((alone.triangles.len(), allowed.triangles.len()), (triangles, triangles), "{name}");
    assert_eq!((alone.content_hash(), &alone.name), (allowed.content_hash(), &allowed.name));
    let message = refusal(files.load(&format!("{name}:memory=64M")));
    assert!(message.contains("memory=SIZE") && message.contains("MiB of memory"), "{name}: {message}");
}

/// A strip of `triangles` triangles as a glTF mesh, with these nodes.
fn strip(triangles: usize, nodes: Value) -> (Value, Vec<u8>) {
    let corners = triangles + 2;
    let bytes: Vec<u8> = (0..corners)
        .flat_map(|i| [(i / 2) as f32, (i % 2) as f32, ((i / 2) as f32).sin()])
        .flat_map(|x| x.to_le_bytes())
        .collect();
    let document = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": bytes.len() }],
        "bufferViews": [{ "buffer": 0, "byteLength": bytes.len() }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "count": corners, "type": "VEC3" }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "mode": 5 }] }],
        "nodes": nodes,
    });
    (document, bytes)
}

#[test]
fn gltf_nodes_repeat_a_mesh() {
    let nodes = (0..200).map(|i| json!({ "mesh": 0, "translation": [0, i, 0] })).collect();
    let (document, bytes) = strip(5120, nodes);
    repeats("a.glb", &glb(&document, &bytes), 1_024_000);
}

#[test]
fn gltf_instances_repeat_a_mesh() {
    let instancing = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": 1 } } });
    let (mut document, mut bytes) = strip(5120, json!([{ "mesh": 0, "extensions": instancing }]));
    let begin = bytes.len();
    bytes.extend((0..600).flat_map(|i| (i as f32).to_le_bytes()));
    document["buffers"][0] = json!({});
    document["bufferViews"]
        .as_array_mut()
        .unwrap()
        .push(json!({ "buffer": 0, "byteOffset": begin, "byteLength": 2400 }));
    let places = json!({ "bufferView": 1, "componentType": 5126, "count": 200, "type": "VEC3" });
    document["accessors"].as_array_mut().unwrap().push(places);
    repeats("a.glb", &glb(&document, &bytes), 1_024_000);
}

#[test]
fn inventor_repeats_nodes() {
    let sphere = "DEF ball Sphere { }";
    let one =
        Files::new(&[("a.iv", &format!("#Inventor V2.1 ascii\n{sphere}\n"))]).load("a.iv").unwrap().triangles.len();
    let uses = "Translation { translation 3 0 0 }\nUSE ball\n".repeat(2999);
    let matrices = (0..3000).map(|i| format!("1 0 0 0 0 1 0 0 0 0 1 0 {i} 0 0 1,")).collect::<String>();
    for repeated in [
        format!("{sphere}\n{uses}"),
        format!("Array {{ numElements1 60 numElements2 50 separation1 3 0 0 separation2 0 3 0 {sphere} }}"),
        format!("MultipleCopy {{ matrix [ {matrices} ] {sphere} }}"),
    ] {
        repeats("a.iv", format!("#Inventor V2.1 ascii\n{repeated}\n").as_bytes(), 3000 * one);
    }
}

#[test]
fn mgf_arrays_repeat_entities() {
    let sphere = "v c =\n\tp 0 0 0\nm grey =\nc\nsph c 1\n";
    let one = Files::new(&[("a.mgf", sphere)]).load("a.mgf").unwrap().triangles.len();
    repeats("a.mgf", format!("xf -a 60 -t 3 0 0 -a 60 -t 0 3 0\n{sphere}xf\n").as_bytes(), 3600 * one);
    // More entities than the limit of time for 64 MiB
    let faces = "v a =\n\tp 0 0 0\nv b =\n\tp 1 0 0\nv d =\n\tp 0 1 0\nf a b d\n";
    let files = Files::new(&[("a.mgf", &format!("xf -a 300 -t 3 0 0 -a 300 -t 0 3 0\n{faces}xf\n"))]);
    assert_eq!(files.load("a.mgf:memory=1G").unwrap().triangles.len(), 90_000);
    assert!(refusal(files.load("a.mgf:memory=16M")).contains("memory=SIZE"));
}

#[test]
fn nff_tessellates_spheres_and_aff_repeats_includes() {
    let mut spheres = "f 1 1 1 1 0 0 0 1\n".to_owned();
    (0..7381).for_each(|i| writeln!(spheres, "s {} {} {} 0.4", i % 20, i / 20 % 20, i / 400).unwrap());
    let files = Files::new(&[("one.nff", "f 1 1 1 1 0 0 0 1\ns 0 0 0 1\n")]);
    let one = files.load("one.nff").unwrap().triangles.len();
    repeats("balls.nff", spheres.as_bytes(), 7381 * one);
    let includes: String = (0..3000).map(|i| format!("xs 1 1 1 0 0 1 0 {i} 0 0 {{ i 0 ball.nff }}\n")).collect();
    let files = Files::new(&[("main.aff", &includes), ("ball.nff", "f 1 1 1 1 0 0 0 1\ns 0 0 0 .4\n")]);
    assert_eq!(files.load("main.aff").map(|scene| scene.triangles.len()).map_err(|e| e.to_string()), Ok(3000 * one));
    assert!(refusal(files.load("main.aff:memory=64M")).contains("memory=SIZE"));
}

#[test]
fn what_is_declared_is_backed_by_bytes() {
    let files = Files::new(&[("a.ply", super::ply::CUBE)]);
    let (mut document, bytes) = strip(1, json!([{ "mesh": 0 }]));
    document["accessors"][0] = json!({ "componentType": 5126, "count": 1_000_000_000, "type": "VEC3" });
    files.write("a.glb", &glb(&document, &bytes));
    files.write("b.ply", super::ply::CUBE.replace("vertex 8", "vertex 800000000").as_bytes());
    for memory in ["1M", "64M", "1T"] {
        assert!(
            refusal(files.load(&format!("a.glb:memory={memory}"))).contains("more elements than the file can fill")
        );
        assert!(files.load(&format!("b.ply:memory={memory}")).is_err());
        assert_eq!(short(&files.load(&format!("a.ply:memory={memory}")).unwrap().name), "a");
    }
}

#[test]
fn the_option_is_a_size() {
    for (value, bytes) in [("64M", 64 << 20), ("2G", 2 << 30), ("1.5k", 1536), ("100000", 100_000)] {
        let options = Options::parse("a.glb", &format!("memory={value}")).unwrap();
        assert_eq!((options.memory, options.repeatable_bytes()), (Some(bytes), bytes), "{value}");
    }
    for value in ["", "0", "-1M", "many", "64X", "1e9", "M"] {
        let message = Options::parse("a.glb", &format!("memory={value}")).unwrap_err().to_string();
        assert!(message.contains("memory=64M"), "{value}: {message}");
    }
    assert!(Options::default().repeatable_bytes() >= 32 << 20);
}
