//! Small files that could take much time or memory: each is read or refused within the same limits as the variants.

use super::super::gltf::glb;
use super::super::inventor::{HEADER, POINTS};
use super::Files;
use super::guard::{self, Watchdog};
use base64::Engine;
use serde_json::{Value, json};
use std::fmt::Write;

/// Loads such a file; the error must contain `words`, or the file must be read if they are empty.
fn load(name: &str, bytes: &[u8], words: &str) {
    let files = Files::new(&[]);
    files.write(name, bytes);
    let watchdog = Watchdog::new();
    let case_name = format!("{name}: {words}");
    watchdog.begin(&case_name);
    match guard::within_limits(&case_name, bytes.len(), || files.load(&format!("{name}:memory=64M"))) {
        Ok(_) => assert!(words.is_empty(), "{case_name}: read, but should be refused"),
        Err(error) => {
            let error = error.to_string();
            assert!(!words.is_empty() && error.contains(words) && !error.contains('\n'), "{case_name}: {error}");
        }
    }
}

#[test]
fn inventor() {
    let doubled = |i| format!("DEF n{i} FaceSet {{ vertexProperty USE n{0} vertexProperty USE n{0} }}\n", i - 1);
    let doublings: String = (1..70).map(doubled).collect();
    let around = "0,0,0,-1,".repeat(333);
    for (text, words) in [
        // An empty array with many copies
        ("Array { numElements1 0 numElements2 1e15 Cube {} } Cube {}", ""),
        ("Array { numElements2 0 numElements3 1e15 Cube {} } Cube {}", ""),
        // Refused before the memory of the first thousands of copies is exceeded
        ("Array { numElements1 1e30 Cube {} }", "nested copies repeat too many values"),
        (
            "Array { numElements1 900000 Array { numElements1 100 Cube {} } }",
            "there are more than 134217728 vertices or triangles",
        ),
        ("Array { numElements1 -1e300 origin CENTER Cube {} } Cube {}", ""),
        ("POINTS QuadMesh { verticesPerColumn 1e18 verticesPerRow 0 } Cube {}", ""),
        // Nested nodes with a cost of 2^70
        (
            &format!("Switch {{ DEF n0 VertexProperty {{ }} {doublings} }} USE n69"),
            "nested copies repeat too many values",
        ),
        ("File { name \"two\nlines\" }", "no such file"),
        // All faces meet at every corner, in many copies.
        (
            &format!(
                "ShapeHints {{ creaseAngle 1 }} POINTS DEF a IndexedFaceSet {{ coordIndex [ {around} ] }} {}",
                "USE a ".repeat(2900)
            ),
            "too many smooth faces",
        ),
        ("Cube {} Array { numElements1 500000 DirectionalLight { direction 0 0 0 } }", "more than 64 MiB"),
    ] {
        load("main.iv", format!("{HEADER}{}", text.replace("POINTS", POINTS.trim_end())).as_bytes(), words);
    }
}

#[test]
fn mgf() {
    let nested = format!("{}{}", "xf -a 100000 -t 0 0 1\n".repeat(90), "xf\n".repeat(90));
    let ones = format!("xf -a 100000 {}\nxf\n", "-a 1 -i 1 -mx ".repeat(8000));
    let colours = format!("xf -a 60000\n{}xf\n", "cct 3000\n".repeat(14));
    let comment = format!("xf -a 100000\n#{}\nxf\n", "-".repeat(50_000));
    let passed_over = format!("xf -a 100000\nxf -a 0\n{}xf\nxf\n", "o thing\n".repeat(8000));
    for (text, words) in [
        (comment.as_str(), "nested arrays repeat too many entities"),
        (&passed_over, "nested arrays repeat too many entities"),
        (nested.as_str(), "more than 64 MiB"),
        (&ones, "there is no triangle"),
        ("xf -a 100000\nxf -a 100000 -a 0\nxf\nxf\n", "there is no triangle"),
        (&colours, "nested arrays repeat too many entities"),
    ] {
        load("main.mgf", text.as_bytes(), words);
    }
}

#[test]
fn obj() {
    const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let mut normals = format!("{CORNERS}{}", "vn 0 0 1\n".repeat(50_000));
    (1..=50_000).for_each(|i| writeln!(normals, "f 1//{i} 2//{i} 3//{i}").unwrap());
    let mut materials = CORNERS.to_owned();
    (0..400_000).for_each(|i| writeln!(materials, "usemtl {i}").unwrap());
    for (text, words) in [
        // All vertices are at three positions: a linear search would take minutes.
        (format!("{CORNERS}s off\n{}", "f 1 2 3\n".repeat(150_000)), ""),
        (normals, ""),
        // The file names itself as its library.
        (format!("{CORNERS}f 1 2 3\n{}", "mtllib main.obj\n".repeat(30_000)), ""),
        (format!("{CORNERS}s off\n{}", "f 1 2 3\n".repeat(1_000_000)), "MiB of memory"),
        (format!("{CORNERS}f {}\n", "1 2 3 ".repeat(2_000_000)), "MiB of memory"),
        (materials, "there is no face"),
    ] {
        load("main.obj", text.as_bytes(), words);
    }
}

#[test]
fn ply() {
    let mut header = "ply\nformat ascii 1.0\nelement vertex 3\n".to_owned();
    (0..2000).for_each(|i| writeln!(header, "property char p{i}").unwrap());
    load("main.ply", header.as_bytes(), ":1004: there are more than 1000 properties");
    let mut corners = b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty char x\nproperty char y\n\
        property char z\nelement face 1\nproperty list uint uchar vertex_indices\nend_header\n"
        .to_vec();
    corners.extend([0, 0, 0, 1, 0, 0, 0, 1, 0]);
    corners.extend(8_000_000u32.to_le_bytes());
    corners.extend([0, 1, 2, 0].repeat(2_000_000));
    load("main.ply", &corners, "MiB of memory");
}

/// A document with sparse accessors over zeros, which need few bytes; one mesh, one node.
fn zeros() -> (Value, Vec<u8>) {
    let corners = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let mut bytes: Vec<u8> = corners.iter().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend([0; 4]);
    let document = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": 40 }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": 1 }],
        "accessors": [{
            "componentType": 5126, "count": 65536, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1],
            "sparse": {
                "count": 1,
                "indices": { "bufferView": 1, "componentType": 5121 },
                "values": { "bufferView": 0 },
            },
        }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "nodes": [{ "mesh": 0 }],
    });
    (document, bytes)
}

#[test]
fn gltf() {
    let (document, bytes) = zeros();
    load("main.glb", &glb(&document, &bytes), "");
    let mut copies = document.clone();
    copies["nodes"] = vec![json!({ "mesh": 0 }); 2000].into();
    load("main.glb", &glb(&copies, &bytes), "MiB of memory");
    // Elements of three bytes, of which objects in memory could take hundreds
    let empty = |list: &str, element: Value, count: usize| {
        let mut empty = document.clone();
        empty[list] = vec![element; count].into();
        glb(&empty, &bytes)
    };
    load("main.glb", &empty("nodes", json!({}), 2_000_000), "has no triangles");
    load("main.glb", &empty("nodes", json!(0), 3_000_000), "nodes[0]: invalid type: integer");
    load("main.glb", &empty("accessors", json!(0), 3_000_000), "accessors[0]: invalid type: integer");
    load("main.glb", &empty("meshes", json!({}), 2_000_000), "has no triangles");
    load("main.glb", &empty("materials", json!({}), 1_500_000), "");
    load("main.glb", &empty("materials", json!(0), 600_000), "");
    load("main.glb", &empty("cameras", json!(0), 3_000_000), "");
    load("main.glb", &empty("extensionsUsed", json!(""), 2_000_000), "");
    load("main.glb", &empty("extensionsRequired", json!("KHR_xmp"), 1_000_000), "");
    load("main.glb", &empty("scenes", json!({}), 2_000_000), "");
    let mut nothing = document.clone();
    nothing["meshes"][0]["primitives"] = vec![json!({}); 2_000_000].into();
    load("main.glb", &glb(&nothing, &bytes), "has no triangles");
    // A chain of nodes, each the child of the one before
    let mut chain = document.clone();
    chain["nodes"] = (1..=300_000).map(|i| json!({ "children": [i] })).chain([json!({ "mesh": 0 })]).collect();
    chain["scenes"] = json!([{ "nodes": [0] }]);
    load("main.glb", &glb(&chain, &bytes), "");
    // Long lists that many nodes share
    let mut cameras = document.clone();
    cameras["cameras"] = json!([{ "extras": vec![0; 500_000] }]);
    cameras["nodes"] = [json!({ "mesh": 0 })].into_iter().chain(vec![json!({ "camera": 0 }); 100_000]).collect();
    load("main.glb", &glb(&cameras, &bytes), "");
    let mut lights = cameras.clone();
    lights["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "extras": vec![0; 500_000] }] } });
    let lit = json!({ "extensions": { "KHR_lights_punctual": { "light": 0 } } });
    lights["nodes"] = [json!({ "mesh": 0 })].into_iter().chain(vec![lit; 100_000]).collect();
    load("main.glb", &glb(&lights, &bytes), "");
    let mut morph = document.clone();
    morph["accessors"][0] = json!({ "componentType": 5126, "count": 3, "type": "VEC3", "bufferView": 0 });
    morph["meshes"][0]["primitives"][0]["targets"] = vec![json!({ "POSITION": 0 }); 20_000].into();
    morph["meshes"][0]["weights"] = vec![1; 20_000].into();
    morph["nodes"] = vec![json!({ "mesh": 0 }); 100_000].into();
    load("main.glb", &glb(&morph, &bytes), "MiB of memory");
    // Long accessors of which nothing is used
    let mut unused = document.clone();
    let indices = json!({ "componentType": 5123, "count": 3, "type": "SCALAR" });
    unused["accessors"].as_array_mut().unwrap().push(indices);
    unused["meshes"][0]["primitives"][0]["indices"] = json!(1);
    unused["nodes"] = vec![json!({ "mesh": 0 }); 100_000].into();
    load("main.glb", &glb(&unused, &bytes), "MiB of memory");
    // Instances without bytes
    let mut instances = document.clone();
    let places = json!({ "componentType": 5126, "count": 65536, "type": "VEC3" });
    instances["accessors"].as_array_mut().unwrap().push(places);
    let attributes = json!({ "attributes": { "TRANSLATION": 1 } });
    instances["nodes"][0]["extensions"] = json!({ "EXT_mesh_gpu_instancing": attributes });
    load("main.glb", &glb(&instances, &bytes), "memory=SIZE");
    // Many buffers that name the file itself
    let mut again = document.clone();
    let data = base64::engine::general_purpose::STANDARD.encode(&bytes);
    let mut buffers = vec![json!({ "byteLength": 40, "uri": format!("data:application/octet-stream;base64,{data}") })];
    buffers.extend(vec![json!({ "byteLength": 1, "uri": "./main.gltf" }); 10_000]);
    again["buffers"] = buffers.into();
    load("main.gltf", again.to_string().as_bytes(), "");
    // A child of two bytes, listed many times
    let mut children = document.clone();
    children["nodes"] = json!([{ "children": vec![1; 2_000_000] }, {}]);
    load("main.glb", &glb(&children, &bytes), "two parents");
    // Many nodes with many empty primitives
    let mut nothing = document.clone();
    nothing["accessors"] = json!([{ "componentType": 5126, "count": 0, "type": "VEC3", "bufferView": 0, "min": [0, 0, 0],
        "max": [0, 0, 0] }]);
    nothing["meshes"][0]["primitives"] = vec![json!({ "attributes": { "POSITION": 0 } }); 8_000].into();
    nothing["nodes"] = vec![json!({ "mesh": 0 }); 8_000].into();
    load("main.glb", &glb(&nothing, &bytes), "MiB of memory");
}

/// Many flat triangles with short indices: the largest memory that an ordinary file takes in relation to its size.
#[test]
fn a_large_glb_without_normals_is_read() {
    let (shown, points) = (25, 20_000u16);
    let mut bytes: Vec<u8> = (0..3 * u32::from(points)).flat_map(|i| (i as f32).sin().to_le_bytes()).collect();
    let corners = 3 * 2 * u32::from(points);
    let count = bytes.len();
    bytes.extend((0..corners).flat_map(|i| ((i * 7919 % u32::from(points)) as u16).to_le_bytes()));
    let length = bytes.len();
    let mut all = Vec::new();
    (0..shown).for_each(|_| all.extend_from_slice(&bytes));
    let views = (0..shown).flat_map(|i| {
        [
            json!({ "buffer": 0, "byteOffset": i * length, "byteLength": count }),
            json!({ "buffer": 0, "byteOffset": i * length + count, "byteLength": length - count }),
        ]
    });
    let accessors = (0..shown).flat_map(|i| {
        [
            json!({ "componentType": 5126, "count": points, "type": "VEC3", "bufferView": 2 * i, "min": [-1, -1, -1],
                "max": [1, 1, 1] }),
            json!({ "componentType": 5123, "count": corners, "type": "SCALAR", "bufferView": 2 * i + 1 }),
        ]
    });
    let document = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": all.len() }],
        "bufferViews": views.collect::<Vec<_>>(),
        "accessors": accessors.collect::<Vec<_>>(),
        "meshes": (0..shown).map(|i| json!({ "primitives": [{ "attributes": { "POSITION": 2 * i },
            "indices": 2 * i + 1 }] })).collect::<Vec<_>>(),
        "nodes": (0..shown).map(|i| json!({ "mesh": i })).collect::<Vec<_>>(),
    });
    load("main.glb", &glb(&document, &all), "");
}
