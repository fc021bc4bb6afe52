//! Tests of glTF with geometry beyond floats in nodes: quantised attributes, instances, morph targets, corners that are
//! not finite, and extensions.

use super::gltf::{glb, load, positions, try_load, with};
use super::refusal;
use glam::Vec3;
use rtbench::scene::{Options, Scene, gltf};
use rtbench::{Result, math::Aabb};
use serde_json::{Value, json};
use std::path::Path;

/// A triangle with attributes in several views, to which a test adds accessors.
struct Mesh {
    document: Value,
    bytes: Vec<u8>,
}

impl Mesh {
    /// The corners (0, 0, 0), (2, 0, 0), (0, 3, 0) as floats, without normals and indices.
    fn new() -> Mesh {
        let document = json!({
            "asset": { "version": "2.0" }, "buffers": [{}], "bufferViews": [], "accessors": [],
            "meshes": [{ "primitives": [{ "attributes": {} }] }], "nodes": [{ "mesh": 0 }],
        });
        let mut mesh = Mesh { document, bytes: Vec::new() };
        mesh.attribute("POSITION", 5126, "VEC3", &floats(&[0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0, 0.0]));
        mesh
    }

    /// Adds an accessor of these bytes, and returns its index.
    fn accessor(&mut self, component: u32, kind: &str, bytes: &[u8]) -> usize {
        self.spaced(component, kind, bytes, None)
    }

    fn spaced(&mut self, component: u32, kind: &str, bytes: &[u8], stride: Option<usize>) -> usize {
        let parts = match kind {
            "SCALAR" => 1,
            "VEC3" => 3,
            _ => 4,
        };
        let size = parts
            * match component {
                5120 | 5121 => 1,
                5122 | 5123 => 2,
                _ => 4,
            };
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let views = self.document["bufferViews"].as_array_mut().unwrap();
        views.push(json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len(),
            "byteStride": stride }));
        let view = views.len() - 1;
        self.bytes.extend(bytes);
        let count = match stride {
            Some(stride) => bytes.len().div_ceil(stride),
            None => bytes.len() / size,
        };
        let accessors = self.document["accessors"].as_array_mut().unwrap();
        accessors.push(json!({ "bufferView": view, "componentType": component, "count": count, "type": kind }));
        accessors.len() - 1
    }

    fn attribute(&mut self, name: &str, component: u32, kind: &str, bytes: &[u8]) -> usize {
        let accessor = self.accessor(component, kind, bytes);
        self.document["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
        accessor
    }

    fn try_load(&self) -> Result<Scene> {
        gltf::read_bytes(Path::new("a.glb"), &glb(&self.document, &self.bytes), &Options::default())
    }

    fn load(&self) -> Scene {
        self.try_load().unwrap_or_else(|error| panic!("{error}"))
    }

    fn instances(&mut self, attributes: Value) {
        self.document["nodes"][0]["extensions"] = json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } });
    }
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn shorts(values: &[i16]) -> Vec<u8> {
    values.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn largest(scene: &Scene) -> Vec3 {
    let Aabb { min, max } = scene.bounds();
    assert!(min.abs().max_element() < 1e-6, "{min}");
    max
}

#[test]
fn quantised_positions_are_read() {
    let scaled = |bytes: &[u8], component: u32, normalized: bool, stride: Option<usize>| {
        let mut mesh = Mesh::new();
        let accessor = mesh.spaced(component, "VEC3", bytes, stride);
        mesh.document["accessors"][accessor]["normalized"] = json!(normalized);
        mesh.document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(accessor);
        mesh.document["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        mesh.document["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
        mesh.document["nodes"][0]["scale"] = json!([2, 3, 1]);
        let scene = mesh.load();
        assert_eq!((scene.triangles.len(), scene.warnings.len()), (1, 0));
        largest(&scene)
    };
    let full = |largest: u16| [0, 0, 0, largest, 0, 0, 0, largest, 0].map(|x: u16| x as i16);
    for (largest, component) in [(127, 5120), (255, 5121)] {
        let tight = full(largest).map(|x| x as u8);
        let spaced: Vec<u8> = tight.chunks(3).flat_map(|c| [c[0], c[1], c[2], 77]).collect();
        let whole = f32::from(largest);
        for (bytes, stride) in [(&tight[..], None), (&spaced, Some(4))] {
            assert_eq!(scaled(bytes, component, false, stride), Vec3::new(2.0 * whole, 3.0 * whole, 0.0));
            assert_eq!(scaled(bytes, component, true, stride), Vec3::new(2.0, 3.0, 0.0));
        }
    }
    for (largest, component) in [(32767, 5122), (65535, 5123)] {
        let tight = shorts(&full(largest));
        let spaced: Vec<u8> = tight.chunks(6).flat_map(|c| [c, &[7, 7]].concat()).collect();
        let whole = f32::from(largest);
        for (bytes, stride) in [(&tight, None), (&spaced, Some(8))] {
            assert_eq!(scaled(bytes, component, false, stride), Vec3::new(2.0 * whole, 3.0 * whole, 0.0));
            assert_eq!(scaled(bytes, component, true, stride), Vec3::new(2.0, 3.0, 0.0));
        }
    }
    // The least byte and short are as far as the largest.
    let mut least = Mesh::new();
    let accessor = least.attribute("POSITION", 5120, "VEC3", &[128, 0, 0, 127, 0, 0, 0, 127, 0]);
    least.document["accessors"][accessor]["normalized"] = json!(true);
    assert_eq!(positions(&least.load())[0], [-1.0, 0.0, 0.0]);
    let mut wide = Mesh::new();
    wide.attribute("POSITION", 5125, "VEC3", &[0; 36]);
    assert!(refusal(wide.try_load()).contains("must have three floats, bytes or shorts"));
}

#[test]
fn quantised_normals_are_read() {
    for (component, bytes) in [
        (5120, [0u8, 0, 127].repeat(3)),
        (5122, shorts(&[0, 0, 32767].repeat(3))),
        (5122, shorts(&[0, 0, 1].repeat(3))),
    ] {
        for normalized in [true, false] {
            let mut mesh = Mesh::new();
            let accessor = mesh.attribute("NORMAL", component, "VEC3", &bytes);
            mesh.document["accessors"][accessor]["normalized"] = json!(normalized);
            let scene = mesh.load();
            assert!(scene.vertices.iter().all(|v| v.normal == Vec3::Z) && scene.warnings.is_empty());
        }
    }
    let mut inclined = Mesh::new();
    inclined.attribute("NORMAL", 5120, "VEC3", &[0x81, 0, 127].repeat(3));
    let normal = inclined.load().vertices[0].normal;
    assert!(normal.abs_diff_eq(Vec3::new(-0.5f32.sqrt(), 0.0, 0.5f32.sqrt()), 1e-6), "{normal}");
    let mut unsigned = Mesh::new();
    unsigned.attribute("NORMAL", 5121, "VEC3", &[0, 0, 255].repeat(3));
    let warnings = unsigned.load().warnings;
    assert!(warnings[0].contains("must have three floats, signed bytes or signed shorts"), "{warnings:?}");
}

#[test]
fn attributes_may_be_interleaved() {
    // Positions, normals and something else in one view
    let corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0f32]];
    let bytes: Vec<u8> = corners.iter().flat_map(|p| floats(&[p[0], p[1], p[2], 0.0, 0.0, 1.0, 7.0, 8.0])).collect();
    let mut mesh = Mesh::new();
    let view = mesh.spaced(5126, "VEC3", &bytes, Some(32));
    let normals = mesh.document["accessors"][view].clone();
    mesh.document["accessors"].as_array_mut().unwrap().push(normals);
    mesh.document["accessors"][view + 1]["byteOffset"] = json!(12);
    mesh.document["meshes"][0]["primitives"][0]["attributes"] = json!({ "POSITION": view, "NORMAL": view + 1 });
    let scene = mesh.load();
    assert_eq!(positions(&scene), corners);
    assert!(scene.vertices.iter().all(|v| v.normal == Vec3::Z));
}

#[test]
fn instances_are_read() {
    // Two instances at (0, 0, 0) and (5, 0, 0), below a node that is moved
    let mut mesh = Mesh::new();
    let places = mesh.accessor(5126, "VEC3", &floats(&[0.0, 0.0, 0.0, 5.0, 0.0, 0.0]));
    mesh.instances(json!({ "TRANSLATION": places }));
    mesh.document["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    mesh.document["nodes"][0]["translation"] = json!([0, 0, 1]);
    mesh.document["nodes"][0]["children"] = json!([1]);
    mesh.document["nodes"].as_array_mut().unwrap().push(json!({ "mesh": 0, "translation": [0, 0, 9] }));
    let scene = mesh.load();
    // The child is not repeated.
    assert_eq!((scene.triangles.len(), scene.warnings.len()), (3, 0));
    assert_eq!(positions(&scene)[4], [7.0, 0.0, 1.0]);
    assert_eq!(scene.bounds().max, Vec3::new(7.0, 3.0, 10.0));
    // A quarter turn around z and a scale: (2, 0, 0) becomes (0, 4, 0), (0, 3, 0) becomes (-9, 0, 0).
    let quarter = [0.0, 0.0, 0.5f32.sqrt(), 0.5f32.sqrt()];
    let byte = quarter.map(|x| (x * 127.0).round() as u8);
    let short = quarter.map(|x| (x * 32767.0).round() as i16);
    for (component, bytes) in [(5126, floats(&quarter)), (5120, byte.to_vec()), (5122, shorts(&short))] {
        for normalized in [true, false] {
            let mut mesh = Mesh::new();
            let turns = mesh.accessor(component, "VEC4", &bytes);
            mesh.document["accessors"][turns]["normalized"] = json!(normalized);
            let scales = mesh.accessor(5126, "VEC3", &floats(&[2.0, 3.0, 1.0]));
            mesh.instances(json!({ "ROTATION": turns, "SCALE": scales, "_ID": 99 }));
            let scene = mesh.load();
            let [.., b, c] = [0, 1, 2].map(|i: usize| scene.vertices[i].position);
            assert!(b.abs_diff_eq(Vec3::new(0.0, 4.0, 0.0), 1e-5), "{component}: {b}");
            assert!(c.abs_diff_eq(Vec3::new(-9.0, 0.0, 0.0), 1e-5), "{component}: {c}");
        }
    }
    // A mirrored instance keeps its orientation.
    let mut mirrored = Mesh::new();
    let scales = mirrored.accessor(5126, "VEC3", &floats(&[1.0, 1.0, 1.0, -1.0, 1.0, 1.0]));
    mirrored.instances(json!({ "SCALE": scales }));
    assert!(mirrored.load().vertices.iter().all(|v| v.normal == Vec3::Z));
    // Attributes of applications alone give the node itself.
    let mut own = Mesh::new();
    own.instances(json!({ "_FEATURE_ID_0": 0 }));
    assert_eq!(own.load().triangles.len(), 1);
}

#[test]
fn wrong_instances_are_refused() {
    let refused = |attributes: fn(&mut Mesh) -> Value| {
        let mut mesh = Mesh::new();
        let attributes = attributes(&mut mesh);
        mesh.instances(attributes);
        refusal(mesh.try_load())
    };
    let message = refused(|mesh| {
        let places = mesh.accessor(5126, "VEC3", &floats(&[0.0; 6]));
        let scales = mesh.accessor(5126, "VEC3", &floats(&[1.0; 3]));
        json!({ "TRANSLATION": places, "SCALE": scales })
    });
    assert!(message.contains("nodes[0] has instances with attributes of different lengths"), "{message}");
    let message = refused(|_| json!({ "ROTATION": 0 }));
    assert!(message.contains("accessor 0 must have four floats, signed bytes or signed shorts"), "{message}");
    let message = refused(|_| json!({ "TRANSLATION": 9 }));
    assert!(message.contains("EXT_mesh_gpu_instancing.attributes.TRANSLATION names accessor 9"), "{message}");
    let message = refused(|mesh| json!({ "SCALE": mesh.accessor(5126, "VEC3", &floats(&[f32::NAN; 3])) }));
    assert!(message.contains("instance 0 of node 0 has a transform that is not finite"), "{message}");
    let message = refused(|_| json!({ "TRANSLATION": "a" }));
    assert!(message.contains("nodes[0].extensions.EXT_mesh_gpu_instancing.attributes.TRANSLATION"), "{message}");
    let none = refused(|mesh| json!({ "TRANSLATION": mesh.accessor(5126, "VEC3", &[]) }));
    assert!(none.contains("has no triangles"), "{none}");
}

#[test]
fn default_weights_of_morph_targets_are_applied() {
    let mesh = |weights: Value| {
        let mut mesh = Mesh::new();
        mesh.attribute("NORMAL", 5126, "VEC3", &floats(&[0.0, 0.0, 1.0].repeat(3)));
        let up = mesh.accessor(5126, "VEC3", &floats(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0]));
        let turned = mesh.accessor(5126, "VEC3", &floats(&[1.0, 0.0, -1.0].repeat(3)));
        let right = mesh.accessor(5120, "VEC3", &[0, 0, 0, 127, 0, 0, 0, 0, 0]);
        mesh.document["accessors"][right]["normalized"] = json!(true);
        mesh.document["meshes"][0]["primitives"][0]["targets"] =
            json!([{ "POSITION": up, "NORMAL": turned, "TANGENT": 99 }, { "POSITION": right, "_OTHER": 98 }, {}]);
        mesh.document["meshes"][0]["weights"] = weights;
        mesh
    };
    for (weights, max) in [
        (json!([1.0]), [2.0, 5.0]),
        (json!([0.5, 0]), [2.0, 4.0]),
        (json!([1, 1, 1]), [3.0, 5.0]),
        (json!([0, 2]), [4.0, 3.0]),
        (json!([0, 0]), [2.0, 3.0]),
        (json!([]), [2.0, 3.0]),
        (json!(null), [2.0, 3.0]),
        (json!([0, 0, 0, 5, 6]), [2.0, 3.0]),
    ] {
        let scene = mesh(weights.clone()).load();
        assert_eq!((largest(&scene), scene.warnings.len()), (Vec3::new(max[0], max[1], 0.0), 0), "{weights}");
    }
    assert_eq!(mesh(json!([1])).load().vertices[0].normal, Vec3::X);
    assert_eq!(mesh(json!([0, 1])).load().vertices[0].normal, Vec3::Z);
    // The node's weights replace those of the mesh, for this node alone.
    let mut own = mesh(json!([1]));
    own.document["nodes"] = json!([{ "mesh": 0, "weights": [0, 1] }, { "mesh": 0, "translation": [10, 0, 0] }]);
    let scene = own.load();
    assert_eq!([positions(&scene)[1], positions(&scene)[5]], [[3.0, 0.0, 0.0], [10.0, 5.0, 0.0]]);
    // Sparse targets without a view
    let mut sparse = Mesh::new();
    let places = sparse.accessor(5121, "SCALAR", &[2]);
    let values = sparse.accessor(5126, "VEC3", &floats(&[0.0, 2.0, 0.0]));
    let view = |sparse: &Mesh, i: usize| sparse.document["accessors"][i]["bufferView"].clone();
    let accessor = json!({ "componentType": 5126, "count": 3, "type": "VEC3", "sparse": { "count": 1,
        "indices": { "bufferView": view(&sparse, places), "componentType": 5121 },
        "values": { "bufferView": view(&sparse, values) } } });
    sparse.document["accessors"].as_array_mut().unwrap().push(accessor);
    sparse.document["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": values + 1 }]);
    sparse.document["meshes"][0]["weights"] = json!([1]);
    assert_eq!(largest(&sparse.load()), Vec3::new(2.0, 5.0, 0.0));
    // What is wrong is refused where it is used, and only there.
    let mut wrong = mesh(json!([0, 1]));
    wrong.document["meshes"][0]["primitives"][0]["targets"][0] = json!({ "POSITION": 77 });
    assert_eq!(largest(&wrong.load()), Vec3::new(3.0, 3.0, 0.0));
    wrong.document["meshes"][0]["weights"] = json!([1]);
    let message = refusal(wrong.try_load());
    assert!(message.contains("meshes[0].primitives[0].targets[0] names accessor 77"), "{message}");
    wrong.document["meshes"][0]["weights"] = json!(["x"]);
    for weights in [json!(["x"]), json!([null]), json!("x")] {
        wrong.document["meshes"][0]["weights"] = weights;
        let scene = wrong.load();
        assert_eq!(largest(&scene), Vec3::new(2.0, 3.0, 0.0));
        assert!(
            scene.warnings[0].contains("normals or morph targets ignored: meshes[0].weights"),
            "{:?}",
            scene.warnings
        );
    }
    let mut none = mesh(json!([1]));
    none.document["meshes"][0]["primitives"][0]["targets"] = json!([null]);
    let scene = none.load();
    assert_eq!(largest(&scene), Vec3::new(2.0, 3.0, 0.0));
    assert!(scene.warnings[0].contains("morph targets ignored: meshes[0].primitives[0]"), "{:?}", scene.warnings);
    let mut short = mesh(json!([1]));
    let accessor = short.accessor(5126, "VEC3", &floats(&[0.0; 6]));
    short.document["meshes"][0]["primitives"][0]["targets"][0] = json!({ "POSITION": accessor });
    assert!(refusal(short.try_load()).contains("targets[0] has 2 elements, but the primitive 3"));
}

#[test]
fn triangles_with_corners_that_are_not_finite_are_dropped() {
    for normals in [false, true] {
        let mut mesh = Mesh::new();
        let nan = f32::NAN;
        let corners = [0.0, 0.0, 0.0, nan, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, f32::INFINITY, 0.0];
        mesh.attribute("POSITION", 5126, "VEC3", &floats(&corners));
        if normals {
            mesh.attribute("NORMAL", 5126, "VEC3", &floats(&[0.0, 0.0, 1.0].repeat(5)));
        }
        let unused = mesh.accessor(5123, "SCALAR", &shorts(&[0, 2, 3]));
        let used = mesh.accessor(5123, "SCALAR", &shorts(&[0, 1, 2, 0, 2, 3, 2, 3, 4]));
        for (indices, warnings) in [(unused, ""), (used, "2 triangles dropped: a corner is not finite")] {
            mesh.document["meshes"][0]["primitives"][0]["indices"] = json!(indices);
            let scene = mesh.load();
            assert_eq!((scene.triangles.len(), scene.warnings.join(", ").as_str()), (1, warnings));
            assert_eq!(largest(&scene), Vec3::new(2.0, 3.0, 0.0));
            scene.check().unwrap();
        }
    }
}

#[test]
fn extensions_that_touch_no_geometry_may_be_required() {
    for name in [
        "EXT_texture_webp",
        "EXT_texture_avif",
        "KHR_materials_emissive_strength",
        "KHR_materials_pbrSpecularGlossiness",
        "KHR_materials_unlit",
        "KHR_materials_variants",
        "KHR_texture_transform",
        "KHR_texture_basisu",
        "KHR_lights_image_based",
        "KHR_animation_pointer",
        "KHR_xmp_json_ld",
        "KHR_xmp",
        "MSFT_texture_dds",
    ] {
        let document = with(&[("/extensionsRequired", json!([name, name])), ("/extensionsUsed", json!([name]))]);
        let scene = load(&document);
        let note = format!("the file requires the extension {name}, which does not concern the geometry: ignored");
        assert_eq!((scene.triangles.len(), scene.warnings), (1, vec![note]), "{name}");
        assert!(load(&with(&[("/extensionsUsed", json!([name]))])).warnings.is_empty(), "{name}");
    }
    for name in ["KHR_lights_punctual", "KHR_mesh_quantization", "EXT_mesh_gpu_instancing"] {
        let document = with(&[("/extensionsRequired", json!([name])), ("/extensionsUsed", json!([name]))]);
        assert!(load(&document).warnings.is_empty(), "{name}");
    }
}

#[test]
fn other_extensions_are_refused_or_named() {
    for name in [
        "KHR_draco_mesh_compression",
        "EXT_meshopt_compression",
        "KHR_meshopt_compression",
        "KHR_node_visibility",
        "KHR_gaussian_splatting",
        "VENDOR_materials",
        "khr_materials_unlit",
        "",
    ] {
        let message = refusal(try_load(&with(&[("/extensionsRequired", json!(["KHR_texture_transform", name]))])));
        let words = format!("requires the extension {name}, which is not supported");
        assert!(message.contains(&words) && message.contains("gltf-transform"), "{message}");
    }
    let told = |names: Value| load(&with(&[("/extensionsUsed", names)])).warnings;
    assert_eq!(
        told(json!(["KHR_node_visibility", "VENDOR_terrain\n", "KHR_node_visibility"])),
        [
            "the file uses the extension KHR_node_visibility, which is not read: the geometry may differ",
            "the file uses the extension VENDOR_terrain, which is not read: the geometry may differ",
        ]
    );
    assert!(told(json!(["KHR_draco_mesh_compression", "EXT_structural_metadata", true, null])).is_empty());
    assert_eq!(told(json!("one")), ["extensionsUsed: invalid type: string \"one\", expected an array: ignored"]);
    assert!(
        refusal(try_load(&with(&[("/extensionsRequired", json!({}))]))).contains("extensionsRequired: invalid type")
    );
    // Compressed geometry with a fallback is read, without one it is refused.
    let draco = json!({ "KHR_draco_mesh_compression": { "bufferView": 0, "attributes": {} } });
    let mut fallback = with(&[("/meshes/0/primitives/0/extensions", draco)]);
    assert_eq!(load(&fallback).triangles.len(), 1);
    fallback["accessors"][0] = json!({ "componentType": 5126, "count": 3, "type": "VEC3" });
    let message = refusal(try_load(&fallback));
    assert!(message.contains("meshes[0].primitives[0] is compressed (KHR_draco_mesh_compression)"), "{message}");
    for name in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
        let meshopt = json!({ name: { "buffer": 0, "byteLength": 1, "count": 3 } });
        let mut fallback = with(&[("/bufferViews/0/extensions", meshopt)]);
        assert_eq!(load(&fallback).triangles.len(), 1);
        fallback["buffers"].as_array_mut().unwrap().push(json!({ "byteLength": 1000 }));
        fallback["bufferViews"][0]["buffer"] = json!(1);
        let message = refusal(try_load(&fallback));
        assert!(message.contains("buffer view 0 is compressed (meshopt), which is not supported"), "{message}");
    }
}

#[test]
fn skins_are_a_warning() {
    let document = with(&[("/nodes/0/skin", json!(0))]);
    assert_eq!(load(&document).warnings, ["skins ignored: meshes are in their rest pose"]);
}
