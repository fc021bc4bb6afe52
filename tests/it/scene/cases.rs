//! Files of text formats that were once refused or read wrongly, with their right values, and variations of them.

mod inventor;
mod inventor_values;
mod meshes;
mod obj;
mod ply;
mod text;

use super::Files;
use glam::Vec3;
use rtbench::scene::{self, Scene};
use std::path::Path;

/// Asserts the number of triangles and the box around them.
fn is_box(name: &str, scene: &Scene, triangles: usize, [from, to]: [[f32; 3]; 2]) {
    let bounds = scene.bounds();
    assert_eq!(scene.triangles.len(), triangles, "{name}: {:?}", scene.warnings);
    let near = bounds.min.abs_diff_eq(Vec3::from(from), 1e-4) && bounds.max.abs_diff_eq(Vec3::from(to), 1e-4);
    assert!(near, "{name}: {bounds:?}");
    for vertex in &scene.vertices {
        assert!(vertex.position.is_finite() && vertex.normal.is_finite(), "{name}: {vertex:?}");
    }
}

/// Loads one file; asserts that it is read.
fn load(name: &str, text: &[u8]) -> Scene {
    let files = Files::new(&[]);
    files.write(name, text);
    files.load(name).unwrap_or_else(|error| panic!("{}: {error}", String::from_utf8_lossy(text)))
}

/// Asserts that a warning has these words.
fn warns(name: &str, scene: &Scene, words: &str) {
    assert!(scene.warnings.iter().any(|warning| warning.contains(words)), "{name}: {words:?}: {:?}", scene.warnings);
}

const TRIANGLE: [[f32; 3]; 2] = [[0.0; 3], [2.0, 3.0, 0.0]];
const SQUARE: [[f32; 3]; 2] = [[0.0; 3], [2.0, 3.0, 1.0]];

#[test]
fn files_that_were_refused_or_read_wrongly_have_their_right_values() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/cases");
    for (file, triangles, bounds, warning) in [
        ("iv/array_inherit.iv", 6, [[0.0; 3], [12.0, 3.0, 1.0]], ""),
        ("iv/material_short.wrl", 2, SQUARE, "material_short.wrl:3: materialIndex: 1 indices are not enough"),
        ("iv/reset_ignored.iv", 2, [[0.0, 0.0, -1.40656], [2.12511, 3.0, 0.0]], ""),
        ("iv/unquoted_digit.wrl", 2, SQUARE, "Texture2 ignored"),
        ("iv/unquoted_minus.wrl", 2, SQUARE, ""),
        ("mgf/cxy_zero.mgf", 1, TRIANGLE, ""),
        ("nff/fill_rgb_only.nff", 1, TRIANGLE, "fill_rgb_only.nff:11: f: 3 numbers instead of 8"),
        ("obj/commas.obj", 1, TRIANGLE, "commas.obj:1: a number has commas"),
        ("obj/faces_first.obj", 1, TRIANGLE, ""),
        ("obj/indices_plus.obj", 1, TRIANGLE, "indices_plus.obj:5: a number has"),
        (
            "obj/lib_illum_text.obj",
            1,
            TRIANGLE,
            "lib_illum_text.mtl:3: illum: `Phong` is not a number: the line is ignored",
        ),
        ("obj/lib_kd_ind.obj", 1, TRIANGLE, "lib_kd_ind.mtl:3: Kd is not finite"),
        ("obj/lib_kd_none.obj", 1, TRIANGLE, "lib_kd_none.mtl:3: Kd has too few numbers"),
        ("obj/lib_ns_nan.obj", 1, TRIANGLE, "lib_ns_nan.mtl:3: Ns is not finite"),
        ("obj/lib_ns_text.obj", 1, TRIANGLE, "lib_ns_text.mtl:3: Ns: `default` is not a number"),
        ("obj/mtllib_backslash_sub.obj", 1, TRIANGLE, ""),
        (
            "obj/mtllib_parent_missing.obj",
            1,
            TRIANGLE,
            "mtllib_parent_missing.obj:1: material library ../mtl/x.mtl does not",
        ),
        (
            "obj/nan_vertex_one_face.obj",
            1,
            TRIANGLE,
            "1 vertices are not finite (first: nan_vertex_one_face.obj:3): 1 faces",
        ),
        ("obj/normal_ind.obj", 1, TRIANGLE, "normal_ind.obj:5: a normal is not three finite numbers"),
        ("obj/normal_qnan.obj", 1, TRIANGLE, "normal_qnan.obj:5: a normal is not three finite numbers"),
        ("obj/normals_after_faces.obj", 1, TRIANGLE, ""),
        ("obj/number_d.obj", 1, TRIANGLE, "number_d.obj:2: a number has"),
        ("obj/utf16_silent.obj", 1, [[0.0; 3], [34.0, 56.0, 0.0]], ""),
        ("ply/blender_line.ply", 2, SQUARE, "blender_line.ply:3: the line is none of a PLY header"),
        ("ply/count_float.ply", 2, SQUARE, "count_float.ply:8: the list has a count"),
        ("ply/extra_face_values.ply", 2, SQUARE, "extra_face_values.ply:14: the row has more values"),
        ("ply/float_index_text.ply", 2, SQUARE, "float_index_text.ply:14: a number has"),
        ("ply/int64.ply", 2, SQUARE, ""),
        ("ply/mind1.ply", 1, TRIANGLE, "1 normals in the file are zero or not finite"),
        (
            "ply/nan_unused.ply",
            2,
            SQUARE,
            "nan_unused.ply: 1 vertices are not finite (first: line 14): they are unused",
        ),
        ("ply/no_version.ply", 2, SQUARE, "no_version.ply:2: the format has no version"),
        ("ply/normal_nanind_m.ply", 2, SQUARE, "4 normals in the file are zero or not finite"),
        ("ply/qnan_unused.ply", 1, TRIANGLE, "qnan_unused.ply: 1 vertices are not finite (first: line 11)"),
        ("ply/realsense.ply", 1, TRIANGLE, ""),
        ("ply/tristrips.ply", 3, SQUARE, ""),
        ("ply/upper.ply", 2, SQUARE, "upper.ply:1: the keywords are not in lower case"),
    ] {
        let scene = scene::load(folder.join(file).to_str().unwrap()).unwrap_or_else(|error| panic!("{file}: {error}"));
        is_box(file, &scene, triangles, bounds);
        if warning.is_empty() {
            assert!(scene.warnings.is_empty(), "{file}: {:?}", scene.warnings);
        } else {
            warns(file, &scene, warning);
        }
    }
    let library = scene::load(folder.join("obj/mtllib_backslash_sub.obj").to_str().unwrap()).unwrap();
    assert_eq!(library.materials[library.triangles[0].material as usize].diffuse, Vec3::X);
}
