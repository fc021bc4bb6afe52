//! Variations of PLY files.

use super::{Files, SQUARE, TRIANGLE, is_box, load, warns};
use crate::scene::refusal;
use glam::Vec3;
use rtbench::scene::Scene;

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";
const LIST: &str = "property list uchar int vertex_indices\n";
const POINTS: &str = "0 0 0\n2 0 0\n0 3 0\n2 3 1\n";

fn ply(text: &str) -> Scene {
    load("mesh.ply", text.as_bytes())
}

fn refused(text: &str) -> String {
    refusal(Files::new(&[("mesh.ply", text)]).load("mesh.ply"))
}

/// A file of four vertices with further properties, and elements.
fn file(further: &str, elements: &str, body: &str) -> String {
    format!("ply\nformat ascii 1.0\nelement vertex 4\n{XYZ}{further}{elements}end_header\n{body}")
}

fn faces(count: usize) -> String {
    format!("element face {count}\n{LIST}")
}

#[test]
fn rows_may_extend_over_lines_and_lines_hold_rows() {
    let reference = ply(&file("", &faces(2), &format!("{POINTS}3 0 1 2\n3 1 3 2\n"))).content_hash();
    for body in [
        "0 0\n0\n2 0 0\n0\n3\n0\n2 3 1\n3 0 1 2\n3 1 3 2\n",
        "0 0 0\n2 0 0\n0 3 0\n2 3 1\n3\n0 1 2\n3\n1 3 2\n",
        "0 0 0\n2 0 0\n0 3 0\n2 3 1\n3 0\n1\n\n2\n3 1 3\n2",
        "0 0 0 2 0 0\n0 3 0 2 3 1\n3 0 1 2 3 1 3 2\n",
        "0 0 0 2 0 0 0 3 0 2 3 1 3 0 1 2 3 1 3 2\n",
    ] {
        for end in ["\n", "\r\n", "\r"] {
            let text = file("", &faces(2), body).replace('\n', end);
            let scene = ply(&text);
            assert_eq!(scene.content_hash(), reference, "{text:?}");
            assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
        }
    }
    // A missing value is not taken from the next row.
    for (body, error) in [
        ("0 0\n2 0 0\n0 3 0\n2 3 1\n3 0 1 2\n3 1 3 2\n", ":10: vertex 0 has too few values"),
        ("0 0\n2 0 0 0\n0 3 0\n2 3 1\n3 0 1 2\n3 1 3 2\n", ":10: vertex 0 has too few values"),
        ("0 0 0\n2 0 0\n0 3 0\n2 3 1\n4 0 1 2\n3 1 3 2\n", ":14: face 0 has too few values"),
        ("0 0 0\n2 0 0\n0 3 0\n2 3 1\n3 0 1 2\n3 1 3\n", ":15: face 1 has too few values"),
    ] {
        let message = refused(&file("", &faces(2), body));
        assert!(message.contains(error), "{body}: {message}");
    }
}

#[test]
fn further_values_in_a_row_are_ignored_with_a_warning() {
    for (body, line) in [
        ("0 0 0\n2 0 0\n0 3 0\n2 3 1\n3 0 1 2 9 1 1 1\n3 1 3 2 9 1 1 1\n", 14),
        ("0 0 0\n2 0 0\n0 3 0\n2 3 1\n3 0 1 2\n3 1 3 2 7\n", 15),
        ("0 0 0 255 255 255\n2 0 0 255 255 255\n0 3 0 1 2 3\n2 3 1 1 2 3\n3 0 1 2\n3 1 3 2\n", 10),
        ("0 0 0 .5\n2 0 0\n0 3 0\n2 3 1\n3 0 1 2 red\n3 1 3 2\n", 10),
    ] {
        let scene = ply(&file("", &faces(2), body));
        is_box(body, &scene, 2, SQUARE);
        warns(body, &scene, &format!("mesh.ply:{line}: the row has more values than declared"));
    }
}

#[test]
fn vertices_that_are_not_finite_are_dropped_with_their_faces() {
    for x in ["nan", "-nan", "-nan(ind)", "inf", "-1.#IND", "1.#QNAN", "1.#INF", "1e999", "NaN", "null"] {
        let points = POINTS.replace("2 3 1", &format!("{x} {x} {x}"));
        let scene = ply(&file("", &faces(3), &format!("{points}3 0 1 2\n3 1 3 2\n4 0 1 3 2\n")));
        is_box(x, &scene, 1, TRIANGLE);
        warns(x, &scene, "mesh.ply: 1 vertices are not finite (first: line 13): 2 faces that use them are dropped");
        assert_eq!(scene.vertices.len(), 3);
        let only = refused(&file("", &faces(1), &format!("{points}3 1 3 2\n")));
        assert!(only.contains("mesh.ply:13: vertex 3 lies at") && only.contains("no face is without"), "{only}");
    }
    let late = format!(
        "ply\nformat ascii 1.0\n{}element vertex 4\n{XYZ}end_header\n3 0 1 2\n4 0 1 3 2\n3 3 1 2\nnan 0 0\n0 0 0\n2 0 0\n0 3 0\n",
        faces(3)
    );
    let scene = ply(&late.replace("3 0 1 2\n", "3 1 2 3\n"));
    is_box("vertices after the faces", &scene, 2, TRIANGLE);
    warns("late", &scene, "1 faces that use them");
    for far in ["1e19", "1e39"] {
        let points = POINTS.replace("2 3 1", &format!("{far} 0 0"));
        is_box(far, &ply(&file("", &faces(1), &format!("{points}3 0 1 2\n"))), 1, TRIANGLE);
        let message = refused(&file("", &faces(2), &format!("{points}3 0 1 2\n3 1 3 2\n")));
        assert!(message.contains("mesh.ply:13: vertex 3 lies at"), "{message}");
    }
}

#[test]
fn triangle_strips_are_read_in_all_encodings() {
    let strips =
        |count: usize, item: &str| format!("element tristrips {count}\nproperty list int {item} vertex_indices\n");
    let corners = |scene: &Scene| scene.triangles.iter().map(|t| t.vertices).collect::<Vec<_>>();
    for (body, expected) in [
        ("8 0 1 2 3 -1 0 1 2\n", vec![[0, 1, 2], [2, 1, 3], [0, 1, 2]]),
        ("9 -1 -1 0 1 2 3 -1 0 1\n", vec![[0, 1, 2], [2, 1, 3]]),
        ("5 0 1 2 3 -1\n", vec![[0, 1, 2], [2, 1, 3]]),
        ("6 0 1 2 3 0 1\n", vec![[0, 1, 2], [2, 1, 3], [2, 3, 0], [0, 3, 1]]),
        ("8\n0 1 2 3 -1 0 1 2\n", vec![[0, 1, 2], [2, 1, 3], [0, 1, 2]]),
    ] {
        let scene = ply(&file("", &strips(1, "int"), &format!("{POINTS}{body}")));
        assert_eq!(corners(&scene), expected, "{body}");
        is_box(body, &scene, expected.len(), SQUARE);
    }
    let two = ply(&file("", &strips(2, "int"), &format!("{POINTS}3 0 1 2\n3 1 3 2\n")));
    assert_eq!(corners(&two), [[0, 1, 2], [1, 3, 2]]);
    let both = format!("{}{}", faces(1), strips(1, "int"));
    assert_eq!(corners(&ply(&file("", &both, &format!("{POINTS}3 0 1 2\n3 1 3 2\n")))), [[0, 1, 2], [1, 3, 2]]);
    let none = format!("{}{}", faces(0), strips(1, "int"));
    assert_eq!(ply(&file("", &none, &format!("{POINTS}3 0 1 2\n"))).triangles.len(), 1);
    let short = ply(&file("", &strips(1, "int"), &format!("{POINTS}6 0 1 -1 0 1 2\n")));
    warns("short", &short, "1 faces with fewer than three corners");
    let nan = file("", &strips(1, "int"), &format!("{}4 0 1 2 3\n", POINTS.replace("2 3 1", "nan 0 0")));
    is_box("a strip with a vertex that is not finite", &ply(&nan), 1, TRIANGLE);
    assert!(refused(&file("", &strips(1, "int"), &format!("{POINTS}3 0 1 9\n"))).contains("tristrips 0 uses vertex 9"));
    // Binary, with signed and unsigned restarts
    for (name, item, size) in [("int", -1i64, 4), ("uint", 0xffff_ffff, 4), ("short", -1, 2), ("ushort", 0xffff, 2)] {
        for big in [false, true] {
            let format = if big { "binary_big_endian" } else { "binary_little_endian" };
            let head = file("", &strips(1, name), "").replace("ascii", format);
            let number = |value: i64, size: usize| match big {
                true => value.to_be_bytes()[8 - size..].to_vec(),
                false => value.to_le_bytes()[..size].to_vec(),
            };
            let mut bytes = head.into_bytes();
            for x in [0f32, 0., 0., 2., 0., 0., 0., 3., 0., 2., 3., 1.] {
                bytes.extend(if big { x.to_be_bytes() } else { x.to_le_bytes() });
            }
            bytes.extend(number(8, 4));
            for index in [0, 1, 2, 3, item, 0, 1, 2] {
                bytes.extend(number(index, size));
            }
            let scene = load("mesh.ply", &bytes);
            assert_eq!(corners(&scene), [[0, 1, 2], [2, 1, 3], [0, 1, 2]], "{name} {format}");
        }
    }
}

#[test]
fn what_is_not_geometry_costs_no_geometry() {
    for (property, values) in [
        ("property uchar red\n", "-1.#IND"),
        ("property uchar red\n", "abc"),
        ("property float16 quality\n", "0.5"),
        ("property string label\n", "word"),
        ("property uchar red\nproperty uchar red\n", "1 2"),
        ("property list uchar float16 weights\n", "2 x y"),
        ("property int64 id\n", "99999999999999999999"),
        ("property float nx\n", "nan"),
    ] {
        let points: String = POINTS.lines().map(|line| format!("{line} {values}\n")).collect();
        let scene = ply(&file(property, &faces(2), &format!("{points}3 0 1 2\n3 1 3 2\n")));
        is_box(property, &scene, 2, SQUARE);
    }
    for normal in
        ["-1.#IND -1.#IND -1.#IND", "nan nan nan", "a b c", "-nan(ind) 0 0", "0 0 1.#INF", "0 0 0", "1e999 0 0"]
    {
        let normals = "property float nx\nproperty float ny\nproperty float nz\n";
        let points: String = POINTS.lines().map(|line| format!("{line} {normal}\n")).collect();
        for text in [
            file(normals, &faces(1), &format!("{points}3 0 1 2\n")),
            file(&normals.replace("float", "double"), &faces(1), &format!("{points}3 0 1 2\n")),
        ] {
            let scene = ply(&text);
            is_box(normal, &scene, 1, TRIANGLE);
            warns(normal, &scene, "normals in the file are zero or not finite: computed instead");
            let corners = scene.triangles[0].vertices.map(|v| scene.vertices[v as usize].normal);
            assert_eq!(corners, [Vec3::Z; 3], "{normal}");
        }
    }
    // In a binary file the size of an unknown type is unknown.
    let binary = file("property half q\n", &faces(1), "").replace("ascii", "binary_little_endian");
    assert!(refused(&binary).contains("mesh.ply:7: type `half` is unknown"));
    assert!(refused(&file("", &faces(1), POINTS).replace("float y", "half y")).contains(":5: type `half` is unknown"));
}

#[test]
fn headers_against_the_letter_are_read_where_they_are_unambiguous() {
    let whole = file("", &faces(2), &format!("{POINTS}3 0 1 2\n3 1 3 2\n"));
    for (from, to, warning) in [
        ("ply\n", "PLY\n", "keywords are not in lower case"),
        ("ply\n", "Ply\n", "keywords are not in lower case"),
        ("element", "ELEMENT", "keywords are not in lower case"),
        ("end_header", "END_HEADER", "keywords are not in lower case"),
        ("float x", "FLOAT X", ""),
        ("vertex 4", "Vertex 4", ""),
        ("ascii 1.0", "ascii", "mesh.ply:2: the format has no version"),
        ("ascii 1.0", "ascii 1.00", ""),
        ("ascii", "ASCII", ""),
        ("element vertex", "Created by X 1 - source file:\nelement vertex", "mesh.ply:3: the line is none"),
        ("element vertex", "\nelement vertex", ""),
        ("uchar int", "float int", "mesh.ply:8: the list has a count or indices"),
        ("uchar int", "double int", "mesh.ply:8: the list has a count or indices"),
        ("uchar int", "uchar float", "mesh.ply:8: the list has a count or indices"),
        ("uchar int", "uint64 int64", ""),
        ("uchar int", "uchar uint64", ""),
        ("3 0 1 2", "3 0.0 1.0 2.0", "mesh.ply:14: a number has"),
        ("3 0 1 2", "3.0 0 1 2", "mesh.ply:14: a number has"),
        ("2 3 1\n", "2D0 3.0d+00 1\n", "mesh.ply:13: a number has"),
        ("2 3 1\n", "2, 3, 1\n", "mesh.ply:13: a number has"),
    ] {
        assert!(whole.contains(from), "{from}");
        let scene = ply(&whole.replacen(from, to, 1));
        is_box(to, &scene, 2, SQUARE);
        match warning {
            "" => assert!(scene.warnings.is_empty(), "{to}: {:?}", scene.warnings),
            warning => warns(to, &scene, warning),
        }
    }
    let zeros = whole.replacen("element", "comment made by a\0b\nelement", 1);
    is_box("a comment with a zero byte", &ply(&zeros), 2, SQUARE);
    assert!(refused(&whole.replacen("2 3 1", "2 3\x001 1", 1)).contains("mesh.ply:13: there is a zero byte"));
    for (from, to) in
        [("ascii 1.0", "ascii 2.0"), ("3 0 1 2", "3 0.5 1 2"), ("3 0 1 2", "2.5 0 1"), ("ply\n", "plyx\n")]
    {
        refused(&whole.replacen(from, to, 1));
    }
}

/// Counts and indices as floats, and indices of 64 bits, in binary files.
#[test]
fn unusual_types_are_read_in_binary_files() {
    for (count, item) in [("float", "int"), ("double", "float"), ("uchar", "int64"), ("uint64", "double")] {
        let list = format!("element face 1\nproperty list {count} {item} vertex_indices\n");
        let mut bytes = file("", &list, "").replace("ascii", "binary_little_endian").into_bytes();
        for x in [0f32, 0., 0., 2., 0., 0., 0., 3., 0., 2., 3., 1.] {
            bytes.extend(x.to_le_bytes());
        }
        for (kind, value) in [(count, 3u8), (item, 0), (item, 1), (item, 2)] {
            match kind {
                "float" => bytes.extend(f32::from(value).to_le_bytes()),
                "double" => bytes.extend(f64::from(value).to_le_bytes()),
                "int" => bytes.extend(i32::from(value).to_le_bytes()),
                "uchar" => bytes.push(value),
                _ => bytes.extend(u64::from(value).to_le_bytes()),
            }
        }
        is_box(item, &load("mesh.ply", &bytes), 1, TRIANGLE);
    }
}
