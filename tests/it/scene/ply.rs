//! Tests of valid PLY files: all encodings, all orders of properties, real files.

use super::{load_bytes, real_scenes};
use crate::support::short;
use glam::Vec3;
use rtbench::scene::{self, Scene};
use std::fmt::Write;

/// A cube of quads with properties and elements that are ignored.
pub const CUBE: &str = "ply
format ascii 1.0
comment a cube with extras
obj_info num_cols 512
element camera 1
property float view_px
property list uchar float matrix
element vertex 8
property uchar red
property float z
property double y
property list uchar int neighbours
property short x
element face 6
property uchar flags
property list uchar uint vertex_index
property list int float texcoord
element edge 2
property int vertex1
property int vertex2
end_header
1.5 3 1 0 0
255 0 0 0 0
255 0 0 2 5 6 1
255 0 1 0 1
255 0 1 0 0
255 1 0 0 0
255 1 0 0 1
255 1 1 0 1
255 1 1 0 0
0 4 3 2 1 0 0
0 4 4 5 6 7 0
0 4 0 1 5 4 2 0.5 .25
0 4 1 2 6 5 0
0 4 2 3 7 6 0
0 4 3 0 4 7 0
0 1
1 2
";

fn positions(scene: &Scene) -> Vec<Vec3> {
    scene.vertices.iter().map(|v| v.position).collect()
}

fn indices(scene: &Scene) -> Vec<[u32; 3]> {
    scene.triangles.iter().map(|t| t.vertices).collect()
}

/// One mesh in all three encodings.
pub struct Encoded {
    pub ascii: Vec<u8>,
    pub little: Vec<u8>,
    pub big: Vec<u8>,
}

/// Writes a mesh, with a colour and a list as extra properties.
pub fn encode(points: &[[f32; 3]], faces: &[Vec<u32>]) -> Encoded {
    let header = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\ncomment made by a test\nelement vertex {}\nproperty float x\nproperty float y\n\
             property float z\nproperty uchar red\nelement face {}\nproperty list uchar int vertex_indices\n\
             property list ushort double weights\nend_header\n",
            points.len(),
            faces.len()
        )
    };
    let mut ascii = header("ascii");
    let mut little = header("binary_little_endian").into_bytes();
    let mut big = header("binary_big_endian").into_bytes();
    for p in points {
        writeln!(ascii, "{} {} {} 200", p[0], p[1], p[2]).unwrap();
        little.extend(p.iter().flat_map(|x| x.to_le_bytes()).chain([200]));
        big.extend(p.iter().flat_map(|x| x.to_be_bytes()).chain([200]));
    }
    for face in faces {
        let corners: String = face.iter().map(|i| format!(" {i}")).collect();
        writeln!(ascii, "{}{corners} 1 0.5", face.len()).unwrap();
        little.push(face.len() as u8);
        little.extend(face.iter().flat_map(|i| i.to_le_bytes()).chain(1u16.to_le_bytes()).chain(0.5f64.to_le_bytes()));
        big.push(face.len() as u8);
        big.extend(face.iter().flat_map(|i| i.to_be_bytes()).chain(1u16.to_be_bytes()).chain(0.5f64.to_be_bytes()));
    }
    Encoded { ascii: ascii.into_bytes(), little, big }
}

#[test]
fn other_properties_are_ignored_and_polygons_become_fans() {
    let scene = load_bytes(CUBE.as_bytes()).unwrap();
    assert_eq!(short(&scene.name), "mesh");
    assert_eq!(scene.vertices.len(), 8);
    assert_eq!(positions(&scene)[1], Vec3::new(1.0, 0.0, 0.0));
    assert_eq!(positions(&scene)[6], Vec3::new(1.0, 1.0, 1.0));
    assert_eq!(indices(&scene)[..4], [[3, 2, 1], [3, 1, 0], [4, 5, 6], [4, 6, 7]]);
    assert_eq!(scene.triangles.len(), 12);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    assert_eq!((scene.materials.len(), scene.materials[0].reflectivity), (1, 0.0));
    // Computed normals point outwards.
    for vertex in &scene.vertices {
        assert!(vertex.normal.is_normalized() && vertex.normal.dot(vertex.position - 0.5) > 0.5, "{vertex:?}");
    }
}

#[test]
fn line_ends_do_not_matter() {
    let expected = load_bytes(CUBE.as_bytes()).unwrap().content_hash();
    for end in ["\r\n", "\r", "  \n", "\t\n\n"] {
        let text = if end.trim() != end && end.contains('\n') && end != "\r\n" {
            // Additional blanks and empty lines are allowed only in the body.
            let (head, body) = CUBE.split_once("end_header\n").unwrap();
            format!("{head}end_header\n{}", body.replace('\n', end))
        } else {
            CUBE.replace('\n', end)
        };
        assert_eq!(load_bytes(text.as_bytes()).unwrap().content_hash(), expected, "{end:?}");
    }
    // The last line has no line end.
    assert_eq!(load_bytes(CUBE.trim_end().as_bytes()).unwrap().content_hash(), expected);
}

#[test]
fn all_encodings_of_a_mesh_give_the_same_scene() {
    let points = [[0.0, -1.5, 1e-7], [3.25, 0.1, 0.0], [0.3333333, 7.0, -12345.678], [1e10, 1.0, 2.0], [0.0, 0.0, 5.0]];
    let faces = [vec![0, 1, 2], vec![0, 1, 2, 3, 4], vec![4, 3], vec![2, 2, 1]];
    let encoded = encode(&points, &faces);
    let [ascii, little, big] = [&encoded.ascii, &encoded.little, &encoded.big].map(|bytes| load_bytes(bytes).unwrap());
    assert_eq!(indices(&ascii), [[0, 1, 2], [0, 1, 2], [0, 2, 3], [0, 3, 4], [2, 2, 1]]);
    // The scene has an extent of 1e10, so that it is scaled in memory.
    let in_file: Vec<Vec3> = positions(&ascii).iter().map(|&p| ascii.placement.file(p).as_vec3()).collect();
    assert_eq!(in_file, points.map(Vec3::from));
    assert_eq!(ascii.content_hash(), little.content_hash());
    assert_eq!(ascii.content_hash(), big.content_hash());
    assert_eq!(ascii.degenerate_triangles, 1);
    assert_eq!(ascii.warnings, ["1 faces with fewer than three corners ignored"]);
    assert_eq!(big.warnings, ascii.warnings);
}

#[test]
fn numbers_in_every_notation_are_read() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n\
        1.e5 -.5 +1\n1e-3 -0 1E+2\n16777217 0.1 00012.500\n3 0 +1 2\n";
    let scene = load_bytes(text.as_bytes()).unwrap();
    assert_eq!(
        positions(&scene),
        [Vec3::new(1e5, -0.5, 1.0), Vec3::new(1e-3, 0.0, 100.0), Vec3::new(16777216.0, 0.1, 12.5)]
    );
}

#[test]
fn normals_of_the_file_are_used_and_invalid_ones_replaced() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float nx\nproperty float ny\nproperty float nz\n\
        property float x\nproperty float y\nproperty float z\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n\
        0 3 4 0 0 0\nnan 0 0 1 0 0\n0 0 0 0 1 0\n3 0 1 2\n";
    let scene = load_bytes(text.as_bytes()).unwrap();
    let normals: Vec<Vec3> = scene.vertices.iter().map(|v| v.normal).collect();
    assert!(normals[0].abs_diff_eq(Vec3::new(0.0, 0.6, 0.8), 1e-6));
    assert_eq!(normals[1..], [Vec3::Z, Vec3::Z]);
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
}

#[test]
fn bytes_after_the_last_element_are_reported() {
    let mut encoded = encode(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[vec![0, 1, 2]]);
    encoded.big.extend(b"rest");
    assert_eq!(load_bytes(&encoded.big).unwrap().warnings, ["4 bytes after the last element ignored"]);
    encoded.ascii.extend(b"\n \r\n\x1a");
    assert!(load_bytes(&encoded.ascii).unwrap().warnings.is_empty());
}

#[test]
fn the_real_bunny_and_dragon_have_the_published_counts() {
    let Some(folder) = real_scenes("the_real_bunny_and_dragon_have_the_published_counts") else { return };
    for (file, vertices, triangles, degenerate) in
        [("bunny/bun_zipper.ply", 35_947, 69_451, 0), ("dragon/dragon_vrip.ply", 437_645, 871_414, 108)]
    {
        let scene = scene::load(folder.join(file).to_str().unwrap()).unwrap();
        let found = (scene.vertices.len(), scene.triangles.len(), scene.degenerate_triangles);
        assert_eq!(found, (vertices, triangles, degenerate), "{file}");
        assert!(scene.warnings.is_empty());
    }
}

#[test]
fn the_fixtures_are_read_or_refused() {
    let Some(folder) = real_scenes("the_fixtures_are_read_or_refused") else { return };
    let load = |file: &str| scene::load(folder.join("fixtures/ply").join(file).to_str().unwrap());
    for (file, vertices, triangles) in
        [("cube.ply", 8, 12), ("cube_binary.ply", 8, 12), ("cube_uv.ply", 24, 12), ("float-color.ply", 3, 1)]
    {
        let scene = load(file).unwrap();
        assert_eq!((scene.vertices.len(), scene.triangles.len(), scene.degenerate_triangles), (vertices, triangles, 0));
    }
    for file in ["points.ply", "issue623.ply"] {
        assert!(super::refusal(load(file)).contains("no faces: a point cloud cannot be ray traced"), "{file}");
    }
}

/// A polygon with a notch, of which the fan overlaps itself; also with the vertices after the faces in the file.
#[test]
fn concave_polygons_are_covered_once() {
    let points = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [2.0, 1.0, 0.0], [0.0, 4.0, 0.0]];
    let encoded = encode(&points, &[vec![0, 1, 2], vec![1, 2, 3, 4, 0], vec![0, 1, 2, 4]]);
    let head = "ply\nformat ascii 1.0\n";
    let faces = "element face 3\nproperty list uchar int vertex_indices\n";
    let vertices = "element vertex 5\nproperty float x\nproperty float y\nproperty float z\n";
    let behind = format!(
        "{head}{faces}{vertices}end_header\n3 0 1 2\n5 1 2 3 4 0\n4 0 1 2 4\n0 0 0\n4 0 0\n4 4 0\n2 1 0\n0 4 0\n"
    );
    for bytes in [&encoded.ascii, &encoded.little, &encoded.big, behind.as_bytes()] {
        let scene = load_bytes(bytes).unwrap();
        let twice: Vec<f32> = (0..6)
            .map(|i| {
                let [a, b, c] = scene.corners(i);
                (b - a).cross(c - a).z
            })
            .collect();
        assert!(twice.iter().all(|&twice| twice > 0.0), "{twice:?}");
        assert_eq!([&twice[..1], &twice[1..4], &twice[4..]].map(|part| part.iter().sum::<f32>()), [16.0, 20.0, 32.0]);
        assert_eq!(indices(&scene)[4..], [[0, 1, 2], [0, 2, 4]], "a convex polygon is a fan");
    }
}
