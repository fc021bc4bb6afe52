//! Tests of the memory while loading, which is at most the file and four times the scene, with the largest real files
//! and with generated files of every format.

use super::gltf::glb;
use super::{Files, real_scenes};
use rtbench::scene::cache::{self, Sources};
use rtbench::scene::{self, Light, Material, Pose, Scene, Triangle};
use serde_json::json;
use std::fmt::Write;
use std::path::Path;

/// Memory in bytes that any file may take in addition: warnings, names, initial tables.
const BASE: u64 = 64 << 10;

/// Size of a scene in bytes.
fn size(scene: &Scene) -> u64 {
    let poses = scene.camera.as_ref().map_or(0, |camera| size_of_val(camera.frames.as_slice()));
    let [vertices, triangles] = [size_of_val(scene.vertices.as_slice()), size_of_val(scene.triangles.as_slice())];
    let [materials, lights] = [scene.materials.len() * size_of::<Material>(), scene.lights.len() * size_of::<Light>()];
    const { assert!(size_of::<Triangle>() == 16 && size_of::<Pose>() <= 64) };
    (vertices + triangles + materials + lights + poses) as u64
}

/// The limit of memory in bytes for a scene from files of this size.
fn limit(scene: &Scene, file: u64) -> u64 {
    4 * size(scene) + file + BASE
}

/// Loads a file; returns a message if the peak of memory exceeds the limit. `bytes` is the size of all files that are
/// read.
fn too_much(path: &Path, bytes: u64) -> Option<String> {
    let mut scene = None;
    // Readers allocate on the calling thread, of which allocations are counted.
    let counted = allocation_counter::measure(|| scene = Some(scene::load(path.to_str().unwrap())));
    let scene = scene.unwrap().unwrap_or_else(|error| panic!("{error}"));
    let multiple = (counted.bytes_max.saturating_sub(bytes)) as f64 / size(&scene) as f64;
    let name = path.file_name().unwrap().to_string_lossy();
    let line = format!("{name}: {} KiB at once, {multiple:.2} times the scene and the file", counted.bytes_max >> 10);
    eprintln!("{line}");
    (counted.bytes_max > limit(&scene, bytes)).then_some(line)
}

fn check_memory(files: &[(std::path::PathBuf, u64)]) {
    let wrong: Vec<String> = files.iter().filter_map(|(path, bytes)| too_much(path, *bytes)).collect();
    assert!(wrong.is_empty(), "more than the limit:\n{}", wrong.join("\n"));
}

#[test]
fn real_files_take_at_most_four_times_their_scene() {
    let Some(folder) = real_scenes("real_files_take_four_times_their_scene_at_most") else { return };
    let whole_folder = |path: &Path| -> u64 {
        let entries = std::fs::read_dir(path.parent().unwrap()).unwrap();
        entries.map(|entry| entry.unwrap().metadata().unwrap().len()).sum()
    };
    let alone = [
        "bunny/bun_zipper.ply",
        "dragon/dragon_vrip.ply",
        "sponza/sponza.obj",
        "conference/obj/arm_mat.obj",
        "mgf/graz.mgf",
        "mgf/classroom.mgf",
        "mgf/soda.mgf",
        "bart/museum/animart6-derived.aff",
    ];
    let mut files: Vec<_> =
        alone.iter().map(|name| folder.join(name)).map(|p| (p.clone(), p.metadata().unwrap().len())).collect();
    for name in ["bart/museum/museum6-derived.aff", "bart/robots/Robot.aff"] {
        let path = folder.join(name);
        files.push((path.clone(), whole_folder(&path)));
    }
    check_memory(&files);
}

/// The test writes one mesh in every format.
#[test]
fn generated_files_take_at_most_four_times_their_scene() {
    let scene = scene::load("hall:triangles=30000").unwrap();
    let points: Vec<[f32; 3]> = scene.vertices.iter().map(|v| v.position.to_array()).collect();
    let corners: Vec<[u32; 3]> = scene.triangles.iter().map(|t| t.vertices).collect();
    let files = Files::new(&[]);
    let mut written = Vec::new();
    let mut write = |name: &str, bytes: &[u8]| {
        files.write(name, bytes);
        written.push((files.path(name), bytes.len() as u64));
    };
    let (n, m) = (points.len(), corners.len());
    let mut ply = format!(
        "ply\nformat ascii 1.0\nelement vertex {n}\nproperty float x\nproperty float y\nproperty float z\n\
        element face {m}\nproperty list uchar int vertex_indices\nend_header\n"
    );
    let (mut obj, mut mgf, mut nff) = (String::new(), String::new(), "f 1 1 1 1 0 0 0 1\n".to_owned());
    let mut aff = format!("{nff}m\nvertices {n}\n");
    for (i, [x, y, z]) in points.iter().enumerate() {
        writeln!(ply, "{x} {y} {z}").unwrap();
        writeln!(obj, "v {x} {y} {z}").unwrap();
        writeln!(mgf, "v v{i} =\n\tp {x} {y} {z}").unwrap();
        writeln!(aff, "{x} {y} {z}").unwrap();
    }
    writeln!(aff, "triangles {m}").unwrap();
    for [a, b, c] in &corners {
        writeln!(ply, "3 {a} {b} {c}").unwrap();
        writeln!(obj, "f {} {} {}", a + 1, b + 1, c + 1).unwrap();
        writeln!(mgf, "f v{a} v{b} v{c}").unwrap();
        writeln!(aff, "{a} {b} {c}").unwrap();
        writeln!(nff, "p 3").unwrap();
        for corner in [a, b, c] {
            let [x, y, z] = points[*corner as usize];
            writeln!(nff, "{x} {y} {z}").unwrap();
        }
    }
    let positions: Vec<u8> = points.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let indices: Vec<u8> = corners.iter().flatten().flat_map(|i| i.to_le_bytes()).collect();
    let buffer = [positions.as_slice(), &indices].concat();
    let mut document = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": buffer.len() }],
        "bufferViews": [
            { "buffer": 0, "byteLength": positions.len() },
            { "buffer": 0, "byteOffset": positions.len(), "byteLength": indices.len() },
        ],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": n, "type": "VEC3", "min": [-1e9, -1e9, -1e9], "max": [1e9, 1e9, 1e9] },
            { "bufferView": 1, "componentType": 5125, "count": 3 * m, "type": "SCALAR" },
        ],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
        "nodes": [{ "mesh": 0 }],
    });
    // A scene far from the origin is read twice.
    let far = |text: &str, keyword: &str| {
        let numbers = |rest: &str| rest.split(' ').map(|x| x.parse().ok()).collect::<Option<Vec<f64>>>();
        let moved = |line: &str| match line.strip_prefix(keyword).and_then(numbers).as_deref() {
            Some([x, y, z]) => format!("{keyword}{} {y} {}\n", x + 5e6, z - 4e6),
            _ => format!("{line}\n"),
        };
        text.lines().map(moved).collect::<String>()
    };
    write("far.ply", far(&ply, "").as_bytes());
    write("far.obj", far(&obj, "v ").as_bytes());
    write("built.ply", ply.as_bytes());
    write("built.obj", obj.as_bytes());
    write("built.mgf", mgf.as_bytes());
    write("built.aff", aff.as_bytes());
    write("built.nff", nff.as_bytes());
    write("built.glb", &glb(&document, &buffer));
    document["buffers"][0]["uri"] = "built.bin".into();
    let text = document.to_string();
    files.write("built.bin", &buffer);
    files.write("built.gltf", text.as_bytes());
    written.push((files.path("built.gltf"), (text.len() + buffer.len()) as u64));
    cache::write(&scene, &Sources::default(), &files.path("built.rtb")).unwrap();
    // The bytes of a cache are not kept: they are read directly into the scene.
    written.push((files.path("built.rtb"), 0));
    check_memory(&written);
    assert!(limit(&scene, 7) == 4 * size(&scene) + 7 + BASE && size(&scene) > 600_000);
}

/// Covers face sets with computed normals: all of them smooth, some of them, none.
#[test]
fn computed_normals_take_at_most_four_times_the_scene() {
    const N: usize = 400;
    let mut mesh = "Coordinate3 { point [\n".to_owned();
    for i in 0..N {
        for j in 0..N {
            writeln!(mesh, "{i} {j} {},", (7 * i + 3 * j) % 5).unwrap();
        }
    }
    mesh += "] }\nIndexedFaceSet { coordIndex [\n";
    for a in (0..N - 1).flat_map(|i| (0..N - 1).map(move |j| i * N + j)) {
        writeln!(mesh, "{a},{},{},{},-1,", a + N, a + N + 1, a + 1).unwrap();
    }
    let files = Files::new(&[]);
    let written = ["3.1", "1", "0"].map(|angle| {
        let name = format!("crease{angle}.iv");
        let text = format!("#Inventor V2.1 ascii\nShapeHints {{ creaseAngle {angle} }}\n{mesh}] }}\n");
        files.write(&name, text.as_bytes());
        (files.path(&name), text.len() as u64)
    });
    check_memory(&written);
}
