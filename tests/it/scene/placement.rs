//! Tests of scenes far from the origin and of tiny and huge scenes: they behave like the same scenes near the origin,
//! in every format, for rays, cameras and caches.

use super::{Files, refusal};
use crate::scene::gltf::glb;
use crate::support::{gpu, random, short, soup};
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use rtbench::Error;
use rtbench::camera::{CameraPath, View};
use rtbench::math::{Aabb, Hit, MISS};
use rtbench::scene::cache::{self, Sources};
use rtbench::scene::placement::power_of_two;
use rtbench::scene::{self, Placement, Scene};
use rtbench::workloads::trace::CpuBackend;
use rtbench::workloads::trace::Selection;
use rtbench::workloads::trace::backend::{Backend, Config, GivenRay, Pixel, Prepared, Size, surface_epsilon};
use rtbench::workloads::trace::input::scene_record;
use rtbench::workloads::trace::rays_csv::ExactRay;
use rtbench::workloads::trace::record::SceneRecord;
use serde_json::json;
use std::fmt::Write;
use std::path::Path;

fn data(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/rays").join(name).to_str().unwrap().to_owned()
}

/// A square image of a frame of a camera path.
fn picture(scene: &Scene, path: &str, frame: usize, size: u32) -> Vec<Pixel> {
    let views = CameraPath::load(path).unwrap().views(scene, None).unwrap();
    picture_of(scene, &views[frame], size)
}

fn picture_of(scene: &Scene, view: &View, size: u32) -> Vec<Pixel> {
    let backend = CpuBackend::new(1).unwrap();
    with_prepared(&backend, scene, |prepared| {
        prepared.image(Config::PS, view, Size { width: size, height: size }).unwrap()
    })
}

fn with_prepared<T>(backend: &dyn Backend, scene: &Scene, work: impl FnOnce(&mut dyn Prepared) -> T) -> T {
    let selection = Selection::parse("bvh-stack").unwrap();
    let built = selection.build(scene, 1).unwrap();
    work(&mut *backend.prepare(scene, &*built.structure, selection.method()).unwrap())
}

/// Number of pixels that differ by more than `levels`.
fn differing(a: &[Pixel], b: &[Pixel], levels: u8) -> usize {
    let far = |(a, b): &(&Pixel, &Pixel)| {
        a.rgba.to_le_bytes().iter().zip(b.rgba.to_le_bytes()).any(|(a, b)| a.abs_diff(b) > levels)
    };
    a.iter().zip(b).filter(far).count()
}

#[test]
fn a_scene_in_utm_coordinates_looks_as_at_the_origin() {
    let [far, near] = ["utm.ply", "utm_at_origin.ply"].map(|name| scene::load(&data(name)).unwrap());
    assert_eq!(far.placement, Placement { offset: DVec3::new(500000.0, 0.0, 4649776.0), exponent: 0 });
    assert!(far.warnings[0].contains("500000,0,4649776 is the origin"), "{:?}", far.warnings);
    assert_eq!((near.placement, near.warnings.len()), (Placement::IDENTITY, 0));
    for (path, frame) in [("light-orbit", 0), ("light-orbit", 133), ("orbit", 77)] {
        let [a, b] = [&far, &near].map(|scene| picture(scene, path, frame, 96));
        assert_eq!(differing(&a, &b, 0), 0, "{path}, frame {frame}");
    }
    // Without the placement the images would differ.
    let kept = scene::load(&format!("{}:origin=keep", data("utm.ply"))).unwrap();
    assert_eq!((kept.placement, short(&kept.name).as_str()), (Placement::IDENTITY, "utm:origin=keep"));
    let [a, b] = [&kept, &near].map(|scene| picture(scene, "light-orbit", 0, 96));
    assert!(differing(&a, &b, 8) > 100);
}

/// Positions and triangles, which every format can store.
#[derive(Clone)]
struct Mesh {
    points: Vec<DVec3>,
    faces: Vec<[usize; 3]>,
}

impl Mesh {
    /// Random triangles with coordinates that are multiples of 2^-20, from -2 to 2.
    fn random(triangles: usize, seed: u32) -> Mesh {
        let scene = soup(triangles, seed, false);
        let points: Vec<DVec3> =
            scene.vertices.iter().map(|v| (v.position.as_dvec3() * 1048576.0).round() / 1048576.0).collect();
        // No duplicates, and no triangles without area
        let sound = |&[a, b, c]: &[usize; 3]| a + 1 == b && b + 1 == c && points[b] != points[c];
        let faces = scene.triangles.iter().map(|t| t.vertices.map(|v| v as usize)).filter(sound).collect();
        Mesh { points, faces }
    }

    fn map(&self, change: impl Fn(DVec3) -> DVec3) -> Mesh {
        Mesh { points: self.points.iter().map(|&p| change(p)).collect(), faces: self.faces.clone() }
    }

    /// The extent along the longest axis.
    fn extent(&self) -> f64 {
        let (min, max) =
            self.points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), &p| (a.min(p), b.max(p)));
        (max - min).max_element()
    }

    /// The mesh as a file of a format, moved by `shift`. Formats with transforms store `shift` as a transform.
    fn file(&self, format: &str, shift: DVec3) -> Vec<u8> {
        let mut text = String::new();
        let moved = self.map(|p| p + shift);
        let [x, y, z] = shift.to_array();
        match format {
            "ascii.ply" | "binary.ply" => {
                let (n, m) = (self.points.len(), self.faces.len());
                let kind = if format == "ascii.ply" { "ascii" } else { "binary_little_endian" };
                let (bytes, list) = ("property double", "property list uchar int vertex_indices");
                let mut header = format!(
                    "ply\nformat {kind} 1.0\nelement vertex {n}\n{bytes} x\n{bytes} y\n{bytes} z\n\
                    element face {m}\n{list}\nend_header\n"
                );
                if kind != "ascii" {
                    let mut file = header.into_bytes();
                    file.extend(moved.points.iter().flat_map(|p| p.to_array()).flat_map(f64::to_le_bytes));
                    for face in &self.faces {
                        file.push(3);
                        file.extend(face.iter().flat_map(|&i| (i as i32).to_le_bytes()));
                    }
                    return file;
                }
                moved.points.iter().for_each(|p| writeln!(header, "{} {} {}", p.x, p.y, p.z).unwrap());
                self.faces.iter().for_each(|[a, b, c]| writeln!(header, "3 {a} {b} {c}").unwrap());
                text = header;
            }
            "a.obj" => {
                moved.points.iter().for_each(|p| writeln!(text, "v {} {} {}", p.x, p.y, p.z).unwrap());
                self.faces.iter().for_each(|f| writeln!(text, "f {} {} {}", f[0] + 1, f[1] + 1, f[2] + 1).unwrap());
            }
            "a.nff" => {
                text += "f 1 1 1 1 0 0 0 1\n";
                self.each(&moved, |[a, b, c]| format!("p 3\n{a}\n{b}\n{c}\n")).for_each(|face| text += &face);
            }
            "a.aff" => {
                text += &format!("f 1 1 1 1 0 0 0 1\nxs 1 1 1 0 1 0 0 {x} {y} {z} {{\n");
                self.each(self, |[a, b, c]| format!("p 3\n{a}\n{b}\n{c}\n")).for_each(|face| text += &face);
                text += "}\n";
            }
            "a.mgf" => {
                text += &format!("xf -t {x} {y} {z}\n");
                let face = |[a, b, c]: [String; 3]| format!("v a =\np {a}\nv b =\np {b}\nv c =\np {c}\nf a b c\n");
                self.each(self, face).for_each(|face| text += &face);
                text += "xf\n";
            }
            "a.iv" | "a.wrl" => {
                let head = if format == "a.iv" { "#Inventor V2.1 ascii" } else { "#VRML V1.0 ascii" };
                text += &format!("{head}\nTranslation {{ translation {x} {y} {z} }}\nCoordinate3 {{ point [\n");
                self.points.iter().for_each(|p| writeln!(text, "{} {} {},", p.x, p.y, p.z).unwrap());
                text += "] }\nIndexedFaceSet { coordIndex [\n";
                self.faces.iter().for_each(|[a, b, c]| writeln!(text, "{a}, {b}, {c}, -1,").unwrap());
                text += "] }\n";
            }
            "a.glb" => {
                let single = |p: &DVec3| p.as_vec3().to_array();
                let positions: Vec<u8> = self.points.iter().flat_map(single).flat_map(f32::to_le_bytes).collect();
                let indices: Vec<u8> = self.faces.iter().flatten().flat_map(|&i| (i as u32).to_le_bytes()).collect();
                let buffer = [positions.as_slice(), &indices].concat();
                let document = json!({
                    "asset": { "version": "2.0" },
                    "buffers": [{ "byteLength": buffer.len() }],
                    "bufferViews": [
                        { "buffer": 0, "byteLength": positions.len() },
                        { "buffer": 0, "byteOffset": positions.len(), "byteLength": indices.len() },
                    ],
                    "accessors": [
                        { "bufferView": 0, "componentType": 5126, "count": self.points.len(), "type": "VEC3",
                          "min": [-9, -9, -9], "max": [9, 9, 9] },
                        { "bufferView": 1, "componentType": 5125, "count": 3 * self.faces.len(), "type": "SCALAR" },
                    ],
                    "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
                    // A quarter turn and its inverse; neither may round.
                    "nodes": [
                        { "translation": [x, y, z], "children": [1] },
                        { "rotation": [0, 1, 0, 0], "children": [2] },
                        { "mesh": 0, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1] },
                    ],
                    "scenes": [{ "nodes": [0] }], "scene": 0,
                });
                return glb(&document, &buffer);
            }
            other => panic!("{other}"),
        }
        text.into_bytes()
    }

    /// The faces, formatted from the texts of their corners.
    fn each<'m>(
        &'m self,
        points: &'m Mesh,
        text: impl Fn([String; 3]) -> String + 'm,
    ) -> impl Iterator<Item = String> + 'm {
        let corner = |i: usize| points.points[i].to_array().map(|x| x.to_string()).join(" ");
        self.faces.iter().map(move |face| text(face.map(corner)))
    }
}

const FORMATS: [&str; 9] = ["ascii.ply", "binary.ply", "a.obj", "a.nff", "a.aff", "a.mgf", "a.iv", "a.wrl", "a.glb"];

/// Loads a mesh from a file of a format, with options.
fn load(mesh: &Mesh, format: &str, shift: DVec3, options: &str) -> Scene {
    let files = Files::new(&[]);
    files.write(format, &mesh.file(format, shift));
    files.load(&format!("{format}{options}")).unwrap_or_else(|error| panic!("{error}"))
}

fn words(v: &[rtbench::math::Vertex]) -> &[u8] {
    bytemuck::cast_slice(v)
}

/// The largest distance between a corner of the scene, converted to the file's coordinates, and the corner in the file.
fn greatest_error(scene: &Scene, mesh: &Mesh, shift: DVec3) -> f64 {
    assert_eq!(scene.triangles.len(), mesh.faces.len());
    let corners = scene.triangles.iter().flat_map(|t| t.vertices).map(|v| scene.vertices[v as usize].position);
    let given = mesh.faces.iter().flatten().map(|&i| mesh.points[i] + shift);
    corners.zip(given).map(|(p, q)| (scene.placement.file(p) - q).abs().max_element()).fold(0.0, f64::max)
}

#[test]
fn every_format_is_read_in_double_precision() {
    let mesh = Mesh::random(60, 3);
    for format in FORMATS {
        let near = load(&mesh, format, DVec3::ZERO, "");
        assert!(near.placement.is_identity() && near.warnings.is_empty(), "{format}: {:?}", near.warnings);
        for shift in [DVec3::new(5e5, 0.0, 4649776.0), DVec3::new(-3.25e7, 1e7, 77.5), DVec3::splat(1e3)] {
            let [x, y, z] = shift.to_array();
            let given = load(&mesh, format, shift, &format!(":origin={x},{y},{z}"));
            assert_eq!(given.placement, Placement { offset: shift, exponent: 0 });
            assert!(given.warnings.is_empty(), "{format}: {:?}", given.warnings);
            assert!(words(&given.vertices) == words(&near.vertices), "{format} at {shift}");
            assert_eq!(given.triangles, near.triangles);
            let auto = load(&mesh, format, shift, "");
            assert!(auto.warnings.iter().any(|w| w.contains("origin=keep")), "{format}: {:?}", auto.warnings);
            assert!(greatest_error(&auto, &mesh, shift) < 2e-7 * mesh.extent(), "{format} at {shift}");
            let kept = load(&mesh, format, shift, ":origin=keep");
            assert!(kept.placement.is_identity() && kept.warnings.is_empty());
            // The same measure detects the error of single precision.
            let error = greatest_error(&kept, &mesh, shift);
            assert!(error > 5e-6 * mesh.extent(), "{format} at {shift}: {error}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A scene that is moved by up to ten million extents and scaled by a power of two gives the same vertices, images,
    /// hits and distances, to the bit.
    #[test]
    fn a_moved_and_scaled_scene_is_the_same(
        seed in 1u32..1000,
        shift in prop::array::uniform3(-20_000_000i64..20_000_000),
        exponent in -58i32..=34,
        format in prop::sample::select(&FORMATS[..6]),
    ) {
        let (mesh, scale) = (Mesh::random(40, seed), power_of_two(exponent));
        let shift = DVec3::from(shift.map(|x| x as f64));
        let near = load(&mesh, format, DVec3::ZERO, "");
        let [x, y, z] = (shift * scale).to_array();
        let far = load(&mesh.map(|p| p * scale), format, shift * scale, &format!(":origin={x},{y},{z}"));
        prop_assert_eq!(far.placement.offset, shift * scale);
        // A comfortable extent is kept, any other becomes about one.
        let left = far.placement.exponent + exponent;
        let scaled = far.placement.exponent != 0;
        prop_assert!(if scaled { (-3..1).contains(&left) } else { (-11..=23).contains(&exponent) }, "2^{}", left);
        let factor = power_of_two(left) as f32;
        for (a, b) in near.vertices.iter().zip(&far.vertices) {
            prop_assert_eq!((a.position * factor, a.normal), (b.position, b.normal));
        }
        prop_assert_eq!(&near.triangles, &far.triangles);
        let [a, b] = [&near, &far].map(|scene| picture(scene, "light-orbit", 17, 24));
        prop_assert_eq!(a, b);
        let mut random = random(seed);
        let mut point = |size: f32| Vec3::new(random(), random(), random()) * size;
        let rays: Vec<GivenRay> = (0..50)
            .map(|i| {
                let [a, b, c] = near.corners(i % near.triangles.len() as u32);
                let (origin, target) = ((point(4.0) * 1024.0).round() / 1024.0, Vec3::from(a + b + c) / 3.0);
                GivenRay { origin, direction: target - origin }
            })
            .collect();
        let moved: Vec<ExactRay> = rays
            .iter()
            .map(|GivenRay { origin, direction }| [origin.as_dvec3(), direction.as_dvec3()])
            .map(|[origin, direction]| ExactRay { origin: (origin + shift) * scale, direction })
            .collect();
        let backend = CpuBackend::new(1).unwrap();
        let expected = with_prepared(&backend, &near, |prepared| prepared.trace(&rays, false).unwrap());
        let placed: Vec<_> = moved.iter().map(|ray| ray.place(&far.placement)).collect();
        let given: Vec<GivenRay> = placed.iter().map(|ray| ray.ray).collect();
        let found = with_prepared(&backend, &far, |prepared| prepared.trace(&given, false).unwrap());
        prop_assert!(expected.iter().any(|hit| hit.triangle != MISS));
        for ((a, b), ray) in expected.iter().zip(&found).zip(&placed) {
            prop_assert_eq!(a.triangle, b.triangle);
            if a.triangle != MISS {
                prop_assert_eq!(f64::from(a.t) * scale, f64::from(b.t) * power_of_two(ray.exponent));
            }
        }
    }
}

#[test]
fn an_extent_lost_in_rounding_is_recovered_by_further_readings() {
    let mesh = Mesh::random(30, 9);
    for (extent, shift) in [(1e-3, 5e6), (1e-6, 1.5e5), (1.0, 1e12), (1e-9, 3e-3)] {
        let small = mesh.map(|p| p * extent);
        for format in ["ascii.ply", "binary.ply", "a.obj", "a.aff"] {
            let shift = DVec3::new(shift, -0.7 * shift, 0.0);
            let scene = load(&small, format, shift, "");
            let error = greatest_error(&scene, &small, shift);
            let double = shift.length() * f64::EPSILON;
            assert!(error < 3e-7 * extent + 2.0 * double, "{format}: {error} at {shift}, {:?}", scene.placement);
            let bounds = scene.bounds();
            let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
            assert!(reach < 2.0 * bounds.diagonal(), "{format}: {:?}", scene.placement);
        }
    }
}

/// `up` and `scale` apply to the file's coordinates, and the placement's offset is converted accordingly.
#[test]
fn up_and_scale_apply_to_the_offset() {
    let (mesh, shift) = (Mesh::random(20, 4), DVec3::new(1e6, -2e6, 3e6));
    let near = load(&mesh, "a.obj", DVec3::ZERO, ":up=z,scale=0.5");
    let far = load(&mesh, "a.obj", shift, ":up=z,scale=0.5,origin=1000000,-2000000,3000000");
    assert!(words(&near.vertices) == words(&far.vertices));
    assert_eq!(far.placement.offset, DVec3::new(5e5, 1.5e6, 1e6));
    assert_eq!(short(&far.name), "a:up=z,scale=0.5,origin=1000000,-2000000,3000000");
    // Small in the file and large after scaling, and vice versa
    for (factor, scale) in [(1e-12, "1e12"), (1e12, "1e-12"), (1.0, "1e-14"), (1.0, "1e14")] {
        let scene = load(&mesh.map(|p| p * factor), "a.obj", DVec3::ZERO, &format!(":scale={scale}"));
        let extent = scene.placement.length(scene.bounds().extent().max_element());
        let wanted = mesh.extent() * factor * scale.parse::<f64>().unwrap();
        assert!((extent / wanted - 1.0).abs() < 1e-6, "{extent}, {wanted}");
        let placed = scene.bounds().extent().max_element();
        assert!((3.9e-3..1.7e7).contains(&placed), "{placed}");
    }
}

#[test]
fn joined_files_have_one_common_origin() {
    let (a, b) = (Mesh::random(20, 5), Mesh::random(20, 6));
    let shift = DVec3::new(5e5, 0.0, 4649776.0);
    let files = Files::new(&[]);
    files.write("a.ply", &a.file("ascii.ply", shift));
    files.write("b.obj", &b.file("a.obj", shift + DVec3::X * 3.0));
    files.write("c.mgf", &b.file("a.mgf", shift + DVec3::Z * 7.0));
    let both = |names: &[&str]| {
        let paths: Vec<String> = names.iter().map(|name| files.path(name).to_str().unwrap().to_owned()).collect();
        scene::load(&paths.join("+")).unwrap()
    };
    let whole = Mesh {
        points: a.points.iter().copied().chain(b.points.iter().map(|&p| p + DVec3::X * 3.0)).collect(),
        faces: a.faces.iter().copied().chain(b.faces.iter().map(|f| f.map(|i| i + a.points.len()))).collect(),
    };
    let joined = both(&["a.ply", "b.obj"]);
    assert!(joined.placement.offset.x.abs() > 4e5 && joined.warnings.len() == 1, "{:?}", joined.warnings);
    assert!(greatest_error(&joined, &whole, shift) < 5e-7 * whole.extent());
    // A cache with another placement is converted to the common placement.
    let alone = scene::load(files.path("a.ply").to_str().unwrap()).unwrap();
    cache::write(&alone, &Sources::default(), &files.path("a.rtb")).unwrap();
    let mixed = both(&["a.rtb", "b.obj"]);
    assert!(greatest_error(&mixed, &whole, shift) < 1e-6 * whole.extent());
    // All files of a folder
    std::fs::remove_file(files.path("a.rtb")).unwrap();
    let folder = scene::load(files.path("").to_str().unwrap()).unwrap();
    assert_eq!(folder.triangles.len(), a.faces.len() + 2 * b.faces.len());
    assert!(folder.placement.offset.z > 4e6);
    // One part is near and one is far: the origin is not moved, and the near part loses no precision.
    files.write("near.obj", &b.file("a.obj", DVec3::ZERO));
    let spread = both(&["near.obj", "b.obj"]);
    assert!(spread.placement.is_identity());
}

#[test]
fn caches_keep_their_placement() {
    let mesh = Mesh::random(20, 7).map(|p| p * 1e-9);
    let files = Files::new(&[]);
    files.write("far.ply", &mesh.file("binary.ply", DVec3::new(0.5, 0.0, -0.25)));
    let (scene, sources) = cache::load(files.path("far.ply").to_str().unwrap(), None).unwrap();
    assert!(scene.placement.exponent > 20 && scene.placement.offset.x > 0.4, "{:?}", scene.placement);
    cache::write(&scene, &sources, &files.path("far.rtb")).unwrap();
    let again = files.load("far.rtb").unwrap();
    assert_eq!(again.placement, scene.placement);
    assert!(words(&again.vertices) == words(&scene.vertices));
    assert_eq!((again.content_hash(), &again.warnings), (scene.content_hash(), &scene.warnings));
    // Options apply to the scene in the cache.
    let scaled = files.load("far.rtb:scale=1e9,up=z").unwrap();
    assert_eq!(scaled.placement.exponent, 0);
    assert!((scaled.placement.offset - DVec3::new(5e8, -2.5e8, 0.0)).length() < 1.0, "{:?}", scaled.placement);
    assert!(refusal(files.load("far.rtb:origin=keep")).contains("no option `origin`"));
    // A scene that was loaded with origin=keep keeps its placement.
    let kept = files.load("far.ply:origin=keep").unwrap();
    cache::write(&kept, &sources, &files.path("kept.rtb")).unwrap();
    assert_eq!(files.load("kept.rtb").unwrap().placement, kept.placement);
    // The previous version of the layout
    let mut old = std::fs::read(files.path("far.rtb")).unwrap();
    old[8..12].copy_from_slice(&4u32.to_le_bytes());
    cache::reseal(&mut old);
    files.write("old.rtb", &old);
    assert!(refusal(files.load("old.rtb")).contains("the cache is stale: its layout has version 4"));
}

#[test]
fn hash_and_record_include_the_placement() {
    let mesh = Mesh::random(10, 8);
    let near = load(&mesh, "a.obj", DVec3::ZERO, "");
    let far = load(&mesh, "a.obj", DVec3::X * 1e6, ":origin=1e6,0,0");
    assert!(words(&near.vertices) == words(&far.vertices));
    assert_ne!(near.content_hash(), far.content_hash());
    let moved = Scene { placement: Placement::IDENTITY, ..far.clone() };
    assert_eq!(near.content_hash(), moved.content_hash());
    let [near, far] = [near, far].map(|scene| serde_json::to_string(&scene_record(&scene)).unwrap());
    assert!(!near.contains("placement") && far.contains(r#""placement":{"offset":[1000000.0,0.0,0.0],"exponent":0}"#));
    // Older records have no placement.
    let [near, far]: [SceneRecord; 2] = [near, far].map(|text| serde_json::from_str(&text).unwrap());
    assert_eq!((near.placement, far.placement.unwrap().offset), (None, [1e6, 0.0, 0.0]));
}

const FAR_FILE: &str = "v from 500003.1 2 4649780.25 at 500000 0.5 4649776 up 0 1 0 angle 50\nl 500010 20 4649770\n\
    f 1 .5 .5 1 0 0 0 1\ns 500000 0.5 4649776 1\n\
    p 4 499995 -.5 4649771 499995 -.5 4649781 500005 -.5 4649781 500005 -.5 4649771\n";

/// The scene of [`FAR_FILE`] at the origin.
fn near_file() -> String {
    let zero = |text: &str, from: &[(&str, &str)]| from.iter().fold(text.to_owned(), |t, (a, b)| t.replace(a, b));
    zero(
        FAR_FILE,
        &[
            ("500003.1", "3.1"),
            ("4649780.25", "4.25"),
            ("500000", "0"),
            ("4649776", "0"),
            ("500010", "10"),
            ("4649770", "-6"),
            ("499995", "-5"),
            ("500005", "5"),
            ("4649771", "-5"),
            ("4649781", "5"),
        ],
    )
}

#[test]
fn cameras_and_lights_are_moved_with_the_scene() {
    let near = near_file();
    let files = Files::new(&[("far.nff", FAR_FILE), ("near.nff", &near)]);
    let [far, near] = ["far.nff:origin=500000,0,4649776", "near.nff"].map(|name| files.load(name).unwrap());
    assert_eq!(far.lights, near.lights);
    // Values that are computed with sines differ by the rounding of doubles.
    let pairs = || far.vertices.iter().zip(&near.vertices);
    assert!(pairs().all(|(a, b)| a.position.abs_diff_eq(b.position, 1e-7) && a.normal == b.normal));
    let view =
        |scene: &Scene| CameraPath::for_scene(scene, Config::PS.shadows()).views(scene, None).unwrap()[0].clone();
    let [a, b] = [&far, &near].map(|scene| picture_of(scene, &view(scene), 48));
    // The digits of the camera's position are not exact at either place.
    assert!(differing(&a, &b, 8) <= 4);
    let position = far.placement.file(view(&far).camera.position);
    assert!((position - DVec3::new(500003.1, 2.0, 4649780.25)).length() < 1e-6, "{position}");
    // Camera paths in the file's coordinates, with lights
    let path = |x: f64, z: f64| {
        let at = |p: [f64; 3]| format!("[{}, {}, {}]", p[0] + x, p[1], p[2] + z);
        let text = format!(
            "kind = \"walk\"\nframes = 5\n[[keys]]\ntime = 0\nposition = {}\ntarget = {}\n\
            [[keys]]\ntime = 1\nposition = {}\ntarget = {}\n[[lights]]\nposition = {}\n",
            at([3.25, 2.0, 4.0]),
            at([0.0, 0.5, 0.0]),
            at([-3.0, 2.5, 4.5]),
            at([0.0, 0.5, 0.0]),
            at([1.0, 9.0, 2.0])
        );
        files.write("walk.toml", text.as_bytes());
        CameraPath::load(files.path("walk.toml").to_str().unwrap()).unwrap()
    };
    let views = [path(5e5, 4649776.0).views(&far, None).unwrap(), path(0.0, 0.0).views(&near, None).unwrap()];
    assert_eq!(views[0], views[1]);
    let elsewhere = path(5e5 + 1.0, 4649776.0).views(&far, None).unwrap();
    assert_ne!(elsewhere, views[1]);
}

#[test]
fn exported_cameras_are_in_the_files_coordinates_and_convert_back() {
    let files = Files::new(&[("far.nff", FAR_FILE)]);
    let file = files.path("far.nff").to_str().unwrap().to_owned();
    let program = |arguments: &[&str]| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_rtbench")).args(arguments).output().unwrap();
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let info = program(&["scenes", "info", &file]);
    for words in ["[499995, -0.5, 4649771]", "[500000, 0, 4649776] is the origin", "at [500003.1, 2, 4649780.25], 50"] {
        assert!(info.contains(words), "{words}: {info}");
    }
    let (csv, toml) = (files.path("c.csv"), files.path("c.toml"));
    program(&["camera-path", "export", &file, "-o", csv.to_str().unwrap()]);
    let csv = std::fs::read_to_string(csv).unwrap();
    assert!(csv.lines().nth(1).unwrap().starts_with("0,0,500003.1,2,4649780.25,"), "{csv}");
    let scene = files.load("far.nff").unwrap();
    for own in ["orbit", "inside", "far"] {
        let path = match own {
            "far" => CameraPath::for_scene(&scene, Config::P.shadows()),
            name => CameraPath::load(name).unwrap(),
        };
        let mut arguments = vec!["camera-path", "export", &file, "-o", toml.to_str().unwrap()];
        if own != "far" {
            arguments.extend(["--camera-path", own]);
        }
        program(&arguments);
        let again = CameraPath::load(toml.to_str().unwrap()).unwrap();
        let [a, b] = [&path, &again].map(|path| path.views(&scene, None).unwrap());
        assert_eq!(
            a.iter().map(|v| v.camera).collect::<Vec<_>>(),
            b.iter().map(|v| v.camera).collect::<Vec<_>>(),
            "{own}"
        );
    }
}

fn trace(scene: &str, rays: &str, any_hit: bool) -> Result<Vec<(String, i64)>, String> {
    let folder = tempfile::tempdir().unwrap();
    let (given, out) = (folder.path().join("rays.csv"), folder.path().join("hits.csv"));
    std::fs::write(&given, rays).unwrap();
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_rtbench"));
    command.args(["trace", "--backend", "cpu", "--scene", scene, "--rays"]).arg(given).arg("-o").arg(&out);
    if any_hit {
        command.arg("--any-hit");
    }
    let output = command.output().unwrap();
    if output.status.code() == Some(0) {
        let text = std::fs::read_to_string(out).unwrap();
        let row = |line: &str| line.split_once(',').map(|(t, i)| (t.to_owned(), i.parse().unwrap())).unwrap();
        return Ok(text.lines().skip(1).map(row).collect());
    }
    assert_eq!(output.status.code(), Some(2));
    let errors = String::from_utf8(output.stderr).unwrap();
    Err(errors.lines().last().unwrap().to_owned())
}

const HEAD: &str = "origin_x,origin_y,origin_z,direction_x,direction_y,direction_z\n";

#[test]
fn a_triangle_of_1e_15_is_hit_by_all_rays() {
    let rays = std::fs::read_to_string(data("tiny_1e-15.csv")).unwrap();
    let hits = trace(&data("tiny_1e-15.ply"), &rays, false).unwrap();
    for ((t, triangle), wanted) in hits.iter().zip([4.99999991225835e-15, 1.0, 1.0 / 0.0010000000474974513]) {
        assert_eq!(*triangle, 0);
        assert!((t.parse::<f64>().unwrap() / wanted - 1.0).abs() < 1e-6, "{t}");
    }
    assert_eq!(hits.len(), 3);
    assert!(trace(&data("tiny_1e-15.ply"), &format!("{HEAD}2e-15,2e-15,1,0,0,-1\n"), false).unwrap()[0].1 == -1);
}

#[test]
fn directions_of_any_length_give_distances_in_their_units() {
    let rays = std::fs::read_to_string(data("direction_lengths.csv")).unwrap();
    let lengths = rays.lines().skip(1).map(|line| -line.split(',').next_back().unwrap().parse::<f64>().unwrap());
    let hits = trace(&data("direction_lengths.ply"), &rays, false).unwrap();
    assert_eq!(hits.len(), 28);
    for ((t, triangle), length) in hits.iter().zip(lengths) {
        assert_eq!(*triangle, 0);
        assert!((t.parse::<f64>().unwrap() * length / 5.0 - 1.0).abs() < 1e-6, "{t} of {length}");
    }
    // The largest and the smallest doubles
    let rays = format!("{HEAD}0,0,5,0,0,-3e38\n0,0,5,0,0,-1e-300\n");
    let hits = trace(&data("direction_lengths.ply"), &rays, false).unwrap();
    assert_eq!(hits.iter().map(|hit| hit.1).collect::<Vec<_>>(), [0, 0]);
    assert!((hits[1].0.parse::<f64>().unwrap() / 5e300 - 1.0).abs() < 1e-6, "{hits:?}");
    // The distance exceeds the range of doubles; any-hit queries still work.
    let rays = format!("{rays}0,0,5,0,0,-5e-324\n");
    let error = trace(&data("direction_lengths.ply"), &rays, false).unwrap_err();
    assert!(error.contains("ray 3: the distance of its hit is beyond double precision"), "{error}");
    assert!(trace(&data("direction_lengths.ply"), &rays, true).unwrap().iter().all(|hit| *hit == ("0".into(), 0)));
}

#[test]
fn invalid_rays_are_refused_with_their_line() {
    for (ray, words) in [
        ("0,0,5,0,0,0", ":3: the direction has no length"),
        ("0,0,nan,0,0,1", ":3: origin_z is \"nan\", not a finite number"),
        ("0,inf,0,0,0,1", ":3: origin_y is \"inf\", not a finite number"),
        ("0,0,5,0,NaN,1", ":3: direction_y is \"NaN\", not a finite number"),
        ("0,0,5,1e400,0,1", ":3: direction_x is \"1e400\", not a finite number"),
        ("-2e18,0,5,0,0,1", ":3: origin_x is \"-2e18\", beyond 1e18"),
        ("0,0,5,0,0,4e38", ":3: direction_z is \"4e38\", beyond single precision"),
    ] {
        let error = trace(&data("direction_lengths.ply"), &format!("{HEAD}0,0,5,0,0,1\n{ray}\n"), false).unwrap_err();
        assert!(error.contains(words), "{error}");
    }
}

/// Both backends accept directions of any length.
#[test]
fn a_backend_traces_directions_of_any_length() {
    let scene = scene::load(&data("direction_lengths.ply")).unwrap();
    let ray =
        |length: f32| GivenRay { origin: Vec3::new(0.1, 0.1, 5.0), direction: Vec3::new(0.01, 0.0, -1.0) * length };
    let check = |backend: &dyn Backend| {
        with_prepared(backend, &scene, |prepared| {
            let lengths = [1e30, 1e10, 3.0, 1e-3, 1e-20, 1e-30, 1e-35, 2e-38f32];
            let rays = lengths.map(ray);
            for (hit, length) in prepared.trace(&rays, false).unwrap().iter().zip(lengths) {
                assert_eq!(hit.triangle, 0, "{length:e}");
                assert!((hit.t * length / 5.0 - 1.0).abs() < 1e-5, "{length:e}: {hit:?}");
            }
            let refused = prepared.trace(&[ray(1.0), ray(1e-40)], false).unwrap_err();
            assert!(matches!(refused, Error::Input(_)) && refused.to_string().contains("ray 1: its hit"), "{refused}");
            let any = prepared.trace(&[ray(1e-40), ray(-1e-40)], true).unwrap();
            assert_eq!(any, [Hit { t: 0.0, triangle: 0 }, Hit::NONE]);
        });
    };
    check(&CpuBackend::new(1).unwrap());
    if let Some(gpu) = gpu() {
        check(gpu);
    }
}

#[test]
fn input_rays_are_moved_with_the_scene() {
    let shift = DVec3::new(5e5, 0.0, 4649776.0);
    let files = Files::new(&[]);
    files.write("far.obj", b"v 499999 -1 4649776\nv 500001 -1 4649776\nv 500000 1 4649776\nf 1 2 3\n");
    let rays = format!("{HEAD}500000.1,0.01,4649780.5,0,0,-2\n0,0,4,0,0,-1\n500000.2,0.2,4649777,0,0,-1e-3\n");
    let file = files.path("far.obj").to_str().unwrap().to_owned();
    let hits = trace(&file, &rays, false).unwrap();
    assert_eq!(hits[1].1, -1);
    assert_eq!(hits[0], ("2.25".into(), 0));
    assert!((hits[2].0.parse::<f64>().unwrap() / 1e3 - 1.0).abs() < 1e-6 && hits[2].1 == 0);
    assert_eq!(
        trace(&format!("{file}:origin=keep"), &rays, false).unwrap()[0],
        hits[0],
        "this ray does not need double precision"
    );
    let mesh = Mesh::random(10, 1);
    assert!(greatest_error(&load(&mesh, "a.obj", shift, ""), &mesh, shift) < 1e-6, "both have the same offset");
}

#[test]
fn extents_from_1e_15_to_1e15_are_traced_and_rendered() {
    let mesh = Mesh::random(40, 2);
    let near = load(&mesh, "ascii.ply", DVec3::ZERO, "");
    let expected = picture(&near, "light-orbit", 0, 32);
    for exponent in [-50, -40, -30, -21, 21, 31, 49] {
        let size = power_of_two(exponent);
        for format in FORMATS.into_iter().filter(|format| *format != "a.glb") {
            let scene = load(&mesh.map(|p| p * size), format, DVec3::ZERO, "");
            assert!(!scene.warnings.iter().any(|w| w.contains("origin")), "{:?}", scene.warnings);
            let extent = scene.placement.length(scene.bounds().extent().max_element());
            assert!((extent / size / mesh.extent() - 1.0).abs() < 1e-6, "{format}: {extent}");
            if format == "ascii.ply" {
                assert_eq!(picture(&scene, "light-orbit", 0, 32), expected, "2^{exponent}");
            }
        }
    }
}

#[test]
fn scenes_beyond_the_limits_are_refused() {
    let triangle = |x: &str| format!("v 0 0 0\nv {x} 0 0\nv 0 {x} 0\nf 1 2 3\n");
    for (text, words) in [
        (triangle("1e19"), &[":2: a vertex has the values", "exceed the largest coordinate 1e18"][..]),
        (triangle("1e39"), &[":2: a vertex has the values", "not finite"]),
        (triangle("nan"), &[":2: a vertex has the values", "not finite"]),
        (triangle("1e-19"), &["the scene is too small: its extent is 1e-19", "1e-18", "scale it up"]),
    ] {
        let message = refusal(Files::new(&[("a.obj", &text)]).load("a.obj"));
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    }
    for x in ["1e18", "-1e18", "2e-18"] {
        let scene = Files::new(&[("a.obj", &triangle(x))]).load("a.obj").unwrap();
        let extent = scene.placement.length(scene.bounds().extent().max_element());
        assert!((extent / x.parse::<f64>().unwrap().abs() - 1.0).abs() < 1e-6, "{extent}");
    }
    for (x, words) in [("1e19", "largest coordinate 1e18"), ("1e99", "not finite"), ("1e-19", "too small")] {
        for format in FORMATS.into_iter().filter(|format| *format != "a.glb") {
            let size: f64 = x.parse().unwrap();
            let files = Files::new(&[]);
            files.write(format, &Mesh::random(10, 2).map(|p| p * size).file(format, DVec3::ZERO));
            let message = refusal(files.load(format));
            assert!(message.contains(words), "{format}: {message}");
            let line =
                size < 1.0 || format == "binary.ply" || message.split(':').nth(1).unwrap().parse::<u32>().is_ok();
            assert!(line, "{format}: {message}");
        }
    }
    // Beyond the limits because of options
    let unit = triangle("1");
    let files = Files::new(&[("a.obj", &unit)]);
    assert!(refusal(files.load("a.obj:scale=1e-19")).contains("too small"));
    assert!(refusal(files.load("a.obj:scale=1e19")).contains("too large"));
    assert!(refusal(files.load("a.obj:scale=1e21")).contains("give a positive number, 1e-20 to 1e20"));
    assert!(files.load("a.obj:scale=1e-17").is_ok() && files.load("a.obj:scale=1e17").is_ok());
}

#[test]
fn invalid_origins_are_refused() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let files = Files::new(&[("a.obj", text)]);
    for value in ["", "here", "1,2", "1,2,3,4", "1,2,nan", "1,2,1e19", "1;2;3", "keep,keep"] {
        let message = refusal(files.load(&format!("a.obj:origin={value}")));
        assert!(
            message.contains("origin: ") && message.contains("keep, auto, or a point of the file as x,y,z"),
            "{message}"
        );
    }
    let scene = files.load("a.obj:origin=-0.5,0,1e3,scale=2").unwrap();
    assert_eq!(scene.placement.offset, DVec3::new(-1.0, 0.0, 2e3));
    assert!(scene.warnings[0].contains("the option origin= is"), "{:?}", scene.warnings);
    assert_eq!(short(&scene.name), "a:scale=2,origin=-0.5,0,1000");
    assert_eq!(short(&files.load("a.obj:origin=auto").unwrap().name), "a");
    assert!(refusal(scene::load("hall:origin=keep")).contains("no parameter `origin`"));
}

#[test]
fn the_surface_epsilon_increases_with_large_coordinates() {
    let bounds = |at: f32| Aabb { min: Vec3::new(at - 1.0, 0.0, 0.0), max: Vec3::new(at + 1.0, 2.0, 2.0) };
    for at in [0.0, 3.0, -20.0] {
        assert_eq!(surface_epsilon(bounds(at)), bounds(at).diagonal() * 1e-5, "{at}");
    }
    for at in [1e4, -1e6] {
        assert_eq!(surface_epsilon(bounds(at)), (at.abs() + 1.0) / 2097152.0);
    }
}
