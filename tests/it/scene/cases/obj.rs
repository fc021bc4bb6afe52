//! Variations of OBJ and MTL files.

use super::{Files, TRIANGLE, is_box, load, warns};
use crate::scene::refusal;
use glam::Vec3;
use rtbench::scene::Scene;

const POINTS: &str = "v 0 0 0\nv 2 0 0\nv 0 3 0\nv 2 3 1\n";

fn obj(text: &str) -> Scene {
    load("a.obj", text.as_bytes())
}

/// Loads a triangle with a material of this library, which is in the file `name`.
fn with_library(statement: &str, name: &str, library: &[u8]) -> Scene {
    let text = format!("mtllib {statement}\n{POINTS}usemtl red\nf 1 2 3\n");
    let files = Files::new(&[("a.obj", &text)]);
    files.write(name, library);
    files.load("a.obj").unwrap_or_else(|error| panic!("{statement}: {error}"))
}

#[test]
fn a_bad_line_in_a_library_costs_only_that_line() {
    for (line, problem) in [
        ("illum Phong", "illum: `Phong` is not a number"),
        ("illum", "illum has too few numbers"),
        ("illum -1.#IND", "illum is not finite"),
        ("Ns nan", "Ns is not finite"),
        ("Ns 1e999", "Ns is not finite"),
        ("Ns", "Ns has too few numbers"),
        ("Ns high", "Ns: `high` is not a number"),
        ("Kd", "Kd has too few numbers"),
        ("Kd 1 0", "Kd has too few numbers"),
        ("Kd nan nan nan", "Kd is not finite"),
        ("Kd red", "Kd: `red` is not a number"),
        ("Kd -nan(ind) 0 0", "Kd is not finite"),
        ("Kd 0,5 0,2 0,1", "Kd: `0,5` is not a number"),
        ("Ka 1.#QNAN 0 0", "Ka is not finite"),
        ("Ks 1 inf 1", "Ks is not finite"),
        ("Ke a b c", "Ke: `a` is not a number"),
        ("Ks 1 1 \\\nx", "Ks: `x` is not a number"),
    ] {
        let library = format!("newmtl red\nKd 1 0 0\n{line}\nKa 1 1 1\nnewmtl blue\nKd 0 0 1\n");
        let scene = with_library("b.mtl", "b.mtl", library.as_bytes());
        is_box(line, &scene, 1, TRIANGLE);
        warns(line, &scene, &format!("{problem}: the line is ignored"));
        warns(line, &scene, "b.mtl:");
        let material = scene.materials[scene.triangles[0].material as usize];
        assert_eq!((material.diffuse, material.exponent), (Vec3::X, 10.0), "{line}");
    }
    // These are not errors.
    for line in ["", "unknown", "d", "Tr nan", "Kd xyz 1 2 3", "Kd spectral x.rfl", "map_Kd", "map_Kd -bm x", "Ni"] {
        let scene = with_library("b.mtl", "b.mtl", format!("newmtl red\nKd 1 0 0\n{line}\n").as_bytes());
        assert!(scene.warnings.iter().all(|w| w.contains("textures ignored")), "{line}: {:?}", scene.warnings);
        assert_eq!(scene.materials[scene.triangles[0].material as usize].diffuse, Vec3::X, "{line}");
    }
    let scene = with_library("b.mtl", "b.mtl", b"newmtl red\nKd 1, 0, 0\n");
    assert_eq!(scene.materials[scene.triangles[0].material as usize].diffuse, Vec3::X, "commas between numbers");
}

#[test]
fn a_library_that_cannot_be_read_costs_only_its_materials() {
    let library = b"newmtl red\nKd 1 0 0\n".as_slice();
    for statement in [
        "../no.mtl",
        "../../../../../../../../../../../no/no.mtl",
        "/no/such/folder/x.mtl",
        "C:\\models\\x.mtl",
        "\\\\server\\share\\x.mtl",
        "sub/no.mtl",
        "sub\\no.mtl",
        "..\\no.mtl",
        "./",
        "..",
        "/",
        "file:///tmp/no.mtl",
    ] {
        let scene = with_library(statement, "b.mtl", library);
        is_box(statement, &scene, 1, TRIANGLE);
        warns(statement, &scene, "a.obj:1: material library ");
        warns(statement, &scene, "does not exist");
    }
    for (name, bytes, problem) in [
        ("zero.mtl", b"newmtl red\nKd 1\x00\x001 0 0\n".as_slice(), "zero byte"),
        ("half.mtl", b"\xff\xfen\0e\0w", "not valid UTF-16"),
    ] {
        let scene = with_library(name, name, bytes);
        is_box(name, &scene, 1, TRIANGLE);
        warns(name, &scene, problem);
    }
    assert!(with_library("", "b.mtl", library).triangles.len() == 1);
}

#[test]
fn libraries_are_found_with_backslashes_and_inside_the_folder() {
    let library = b"newmtl red\nKd 1 0 0\n".as_slice();
    for (statement, name) in [
        ("sub\\s.mtl", "sub/s.mtl"),
        (".\\s.mtl", "s.mtl"),
        ("sub\\deep\\s.mtl", "sub/deep/s.mtl"),
        ("sub\\s.mtl # a comment", "sub/s.mtl"),
        ("no.mtl sub\\s.mtl", "sub/s.mtl"),
        ("my sub\\s.mtl", "my sub/s.mtl"),
        ("sub/../s.mtl", "sub/../s.mtl"),
        #[cfg(unix)]
        ("sub\\s.mtl", "sub\\s.mtl"),
    ] {
        let scene = with_library(statement, name, library);
        assert_eq!(scene.materials[scene.triangles[0].material as usize].diffuse, Vec3::X, "{statement}");
    }
    let text = format!("mtllib ..\\s.mtl\n{POINTS}usemtl red\nf 1 2 3\n");
    let files = Files::new(&[("a.obj", &text), ("../s.mtl", "newmtl red\n")]);
    assert!(refusal(files.load("a.obj")).contains("outside=yes"), "a library outside that exists");
}

#[test]
fn bad_normals_and_texture_coordinates_cost_only_themselves() {
    for normal in [
        "vn -1.#IND -1.#IND -1.#IND",
        "vn 1.#QNAN 0 0",
        "vn -nan(ind) -nan(ind) -nan(ind)",
        "vn nan nan nan",
        "vn 0 0 inf",
        "vn 0 0 1.#INF",
        "vn 0 0 1e999",
        "vn 0 0",
        "vn",
        "vn a b c",
        "vn 0 0 1..2",
        "vn 0,5 0,5 0,5",
        "vn undefined undefined undefined",
    ] {
        let scene = obj(&format!("{POINTS}{normal}\nf 1//1 2//1 3//1\n"));
        is_box(normal, &scene, 1, TRIANGLE);
        warns(normal, &scene, "a.obj:5: a normal is not three finite numbers");
        assert!(scene.vertices.iter().all(|v| v.normal == Vec3::Z), "{normal}: {:?}", scene.vertices);
    }
    for (face, warning) in [
        ("f 1//0 2//0 3//0", "a.obj:6: a corner has a normal that does not exist: the normals of 3 corners"),
        ("f 1//2 2//2 3//2", "a.obj:6: a corner has normal 2, but the file has 1"),
        ("f 1//-2 2//-2 3//-2", "the normals of 3 corners"),
        ("f 1//x 2//1 3//1", "the normals of 1 corners"),
        ("f 1//nan 2//1 3//1", "the normals of 1 corners"),
        ("f 1/1/99999999999 2//1 3//1", "the normals of 1 corners"),
        ("f 1/a 2 3", "a.obj:6: a texture coordinate of a corner is not an index"),
        ("f 1/nan/1 2/-1.#IND/1 3/1/1", "a texture coordinate"),
        ("f 1/1.5 2/2 3/3", "a texture coordinate"),
    ] {
        let scene = obj(&format!("{POINTS}vn 0 0 1\n{face}\n"));
        is_box(face, &scene, 1, TRIANGLE);
        warns(face, &scene, warning);
        assert!(scene.vertices.iter().all(|v| v.normal == Vec3::Z), "{face}: {:?}", scene.vertices);
    }
    for line in ["vt nan nan", "vt", "vt a b", "vt -1.#IND 0", "vp x", "g", "o", "s x", "usemtl", "s -1.#IND"] {
        let scene = obj(&format!("{POINTS}{line}\nf 1/1 2/1 3/0\n"));
        is_box(line, &scene, 1, TRIANGLE);
        assert!(scene.warnings.iter().all(|w| w.contains("neutral grey")), "{line}: {:?}", scene.warnings);
    }
    // A normal after the face is used, also if it is negative in the file order.
    for (face, normal) in [("f 1//1 2//1 3//1", Vec3::NEG_Z), ("f 1//2 2//2 3//2", Vec3::X)] {
        let scene = obj(&format!("{POINTS}{face}\nvn 0 0 -2\nvn 5 0 0\n"));
        assert!(scene.vertices.iter().all(|v| v.normal == normal) && scene.warnings.is_empty(), "{:?}", scene.warnings);
    }
}

#[test]
fn faces_may_precede_their_vertices() {
    let reference = obj(&format!("{POINTS}f 1 2 4 3\nf 1 2 3\n"));
    for text in [
        format!("f 1 2 4 3\nf 1 2 3\n{POINTS}"),
        format!("f 1/1 2/2 4/4 3/3\nf 1// 2// 3//\n{POINTS}"),
        format!("v 0 0 0\nf 1 2 4 3\n{}f 1 2 3\n", &POINTS[8..]),
        format!("f 1 2 4 3\n{POINTS}f -4 -3 -2\n"),
    ] {
        let scene = obj(&text);
        assert_eq!(scene.content_hash(), reference.content_hash(), "{text}");
        assert!(scene.warnings.is_empty());
    }
    // A concave polygon is triangulated once its vertices are known.
    let arrow = "v 0 0 0\nv 2 2 0\nv 0 1 0\nv -2 2 0\n";
    assert_eq!(obj(&format!("f 4 1 2 3\n{arrow}")).content_hash(), obj(&format!("{arrow}f 4 1 2 3\n")).content_hash());
    let scene = obj(&format!("f 1 5 2 3\nf 1 2 3\nf 5 1\n{POINTS}v nan 0 0\n"));
    is_box("a vertex that is not finite after its face", &scene, 1, TRIANGLE);
    warns("after", &scene, "1 vertices are not finite (first: a.obj:8): 1 faces that use them are dropped");
    assert_eq!(scene.vertices.len(), 3);
}

#[test]
fn faces_with_vertices_that_are_not_finite_are_dropped_and_counted() {
    for x in ["nan", "-nan", "inf", "-1.#IND", "1.#QNAN", "1.#INF", "-nan(ind)", "1e999", "null", "undefined", "****"] {
        let scene = obj(&format!("{POINTS}v {x} 0 0\nf 1 2 3\nf 1 2 5\nf 1 2 3 5\nf 5 1\n"));
        is_box(x, &scene, 1, TRIANGLE);
        warns(x, &scene, "1 vertices are not finite (first: a.obj:5): 2 faces that use them are dropped");
        let unused = obj(&format!("v {x} {x} {x}\n{POINTS}f 2 3 4\n"));
        is_box(x, &unused, 1, TRIANGLE);
        warns(x, &unused, "1 vertices are not finite (first: a.obj:1): they are unused and dropped");
        let message = refusal(Files::new(&[("a.obj", &format!("{POINTS}v {x} 0 0\nf 1 2 5\n"))]).load("a.obj"));
        assert!(message.contains("a.obj:5: ") && message.contains("no face is without such a vertex"), "{message}");
    }
    is_box("far and unused", &obj(&format!("{POINTS}v 1e30 0 0\nv 1e39 0 0\nf 1 2 3\n")), 1, TRIANGLE);
    // The option `origin` reads positions in double precision.
    let files = Files::new(&[("a.obj", &format!("{POINTS}v nan 0 0\nv 1e300 0 0\nf 1 2 3\nf 1 2 5\n"))]);
    let scene = files.load("a.obj:origin=1,1,1").unwrap();
    assert_eq!(scene.triangles.len(), 1);
    warns("origin", &scene, "1 faces that use them are dropped");
}

#[test]
fn comments_may_follow_a_number_directly_and_backslashes_end_the_file() {
    for text in [
        "v 0 0 0#a\nv 2 0 0# b\nv 0 3 0#\nf 1 2 3#c",
        "v 0 0 0#a\\\nv 2 0 0\nv 0 3 0\nf 1 2 3#c\\",
        "v 0 0 0\nv 2 0 0\nv 0 3 0\nvn 0 0 1#n\nf 1//1 2//1 3//1#c 4",
        "v 0 0 0\nv 2 0 0\nv 0 3 0\nf 1 2 3\\",
        "v 0 0 0\nv 2 0 0\nv 0 3 0\nf 1 2 3 \\",
        "v 0 0 0\nv 2 0 0\nv 0 3 0\nf 1 2 \\  \n3\n",
        "v 0 0 0\nv 2 \\ \t\r\n0 0\nv 0 3\\ \n0\ns 1#x\nf 1 2\\ \n3\n",
    ] {
        let scene = obj(text);
        is_box(text, &scene, 1, TRIANGLE);
        assert!(scene.warnings.is_empty(), "{text}: {:?}", scene.warnings);
    }
    let text = "v 0 0 0\nv 2 0 0\nv 0 3 0\nf 1/1/1/1 2/1/1/1 3/1/1/1\nvn 0 0 1\n";
    let scene = obj(text);
    is_box(text, &scene, 1, TRIANGLE);
    warns(text, &scene, "a.obj:4: a corner of a face has more parts than v/vt/vn");
    // A `#` of a number that is none begins no comment.
    let scene = obj(&format!("{POINTS}v 1.#IND -1.#QNAN 0\nf 1 2 3\nf 1 2 5\n"));
    warns("1.#IND", &scene, "1 vertices are not finite");
    let red = with_library("b.mtl", "b.mtl", b"newmtl red\nKd 1 0 0#c\nNs 10#c\n");
    assert_eq!(red.materials[red.triangles[0].material as usize].diffuse, Vec3::X);
    assert!(red.warnings.is_empty(), "{:?}", red.warnings);
}

#[test]
fn numbers_in_unusual_notations_are_read() {
    for text in [
        "v 0, 0, 0\nv 2, 0, 0\nv 0, 3, 0\nf 1 2 3",
        "v 0,0,0\nv 2,0,0\nv 0,3,0\nf 1 2 3",
        "v 0 ,0 ,0\nv 2 , 0 , 0\nv 0 3 0\nf 1 2 3",
        "v 0 0 0\nv 2 0 0\nv 0 3 0\nf 1, 2, 3",
        "v 0 0 0\nv 2 0 0\nv 0 3 0\nf 1,2,3",
        "v 0 0 0\nv 2 0 0\nv 0 3 0\nf +1 +2 +3",
        "v 0 0 0\nv 2 0 0\nv 0 3 0\nvn 0 0 1\nf +1/+1/+1 +2//+1 +3//+1",
        "v 0 0 0\nv 2 0 0\nv 0 3 0\nf 1.0 2.0 3.0",
        "v 0 0 0\nv 2.0D0 0 0\nv 0 3.0d+00 0\nf 1 2 3",
        "v 0.D0 0 0\nv 20D-1 0 0\nv 0 +0.3D1 0\nf 1 2 3",
    ] {
        let scene = obj(text);
        is_box(text, &scene, 1, TRIANGLE);
        warns(text, &scene, ": a number has commas, a Fortran exponent");
        assert_eq!(scene.warnings.len(), 1, "{text}: {:?}", scene.warnings);
    }
    is_box("plus signs of numbers", &obj("v +0 0 0\nv +2 +0.0 0\nv 0 +3. 0\nf 1 2 3"), 1, TRIANGLE);
    for text in ["v 1,5 2,5 3,5\n", "v 0,0 1\n", "v 1,2,3,4 5\n", "v 1 2\n", "v 1 2 3x\n"] {
        let message = refusal(Files::new(&[("a.obj", &format!("{POINTS}{text}f 1 2 3\n"))]).load("a.obj"));
        assert!(message.contains("a.obj:5: a vertex"), "{text}: {message}");
    }
}
