//! Variations of Inventor and VRML 1.0 files.

use super::{Files, SQUARE, TRIANGLE, is_box, load, warns};
use crate::scene::refusal;
use glam::Vec3;
use rtbench::scene::Scene;

const POINTS: &str = "Coordinate3 { point [ 0 0 0, 2 0 0, 0 3 0, 2 3 1 ] }\n";
const FACES: &str = "IndexedFaceSet { coordIndex [ 0, 1, 2, -1, 1, 3, 2, -1 ] }\n";

fn iv(text: &str) -> Scene {
    load("a.iv", format!("#Inventor V2.1 ascii\n{text}").as_bytes())
}

#[test]
fn indices_of_materials_that_do_not_fit_are_warnings() {
    let colours = "Material { diffuseColor [ 1 0 0, 0 1 0 ] } MaterialBinding { value PER_FACE_INDEXED }";
    for (indices, warning) in [
        ("[ 0 ]", "materialIndex: 1 indices are not enough"),
        ("[ 0, 2 ]", "materialIndex: index 2 is out of range, there are 2 materials"),
        ("[ 0, 999999 ]", "materialIndex: index 999999 is out of range"),
        ("[ 0, -1 ]", "materialIndex: -1, entry 1 of the list, is not an index"),
        ("[ 0, -7 ]", "is not an index"),
        ("[ 0, 1.5 ]", "is not an index"),
        ("[ 0, nan ]", "is not an index"),
        ("[ 0, -1.#IND ]", "is not an index"),
    ] {
        let faces = FACES.replace(" ] }", &format!(" ] materialIndex {indices} }}"));
        let scene = iv(&format!("{colours}{POINTS}{faces}"));
        is_box(indices, &scene, 2, SQUARE);
        warns(
            indices,
            &scene,
            &format!("a.iv:3: {}", if warning.starts_with("is") { "materialIndex: " } else { warning }),
        );
        warns(indices, &scene, warning);
        assert_eq!(scene.materials[scene.triangles[0].material as usize].diffuse, Vec3::X, "{indices}");
    }
    for binding in ["PER_VERTEX_INDEXED", "PER_PART_INDEXED"] {
        let faces = FACES.replace(" ] }", " ] materialIndex [ 0 ] }");
        let scene = iv(&format!("MaterialBinding {{ value {binding} }}{POINTS}{faces}"));
        is_box(binding, &scene, 2, SQUARE);
        warns(binding, &scene, "materialIndex: ");
    }
}

#[test]
fn normals_that_do_not_fit_are_computed() {
    for (normals, warning) in [
        ("Normal { vector [ 0 0 1, 0 0 ] }", "a.iv:2: vector: 5 numbers are not a multiple of 3"),
        ("Normal { vector [ 0 0 -1.#IND, 0 0 1, 0 0 1, 0 0 1 ] }", "normal that is zero or not finite"),
        ("Normal { vector [ nan nan nan, 0 0 1, 0 0 1, 0 0 1 ] }", "normal that is zero or not finite"),
        ("Normal { vector [ -nan(ind) 0 0, 0 0 1, 0 0 1, 0 0 1 ] }", "normal that is zero or not finite"),
        ("Normal { vector [ 0 0 inf, 0 0 1.#QNAN, 0 0 a, 0 0 1..2 ] }", "normal that is zero or not finite"),
        ("Normal { vector [ 0 0 1 ] }", "fewer normals than bindings"),
        ("NormalBinding { value PER_MOON }", "value: `PER_MOON` is not one of its values"),
    ] {
        let scene = iv(&format!("{normals}\n{POINTS}{FACES}"));
        is_box(normals, &scene, 2, SQUARE);
        warns(normals, &scene, warning);
        let normal = scene.vertices[scene.triangles[0].vertices[0] as usize].normal;
        assert_eq!(normal, Vec3::Z, "{normals}");
    }
    for indices in ["[ 0 ]", "[ 0 -1 0 ]", "[ 9 9 9 -1 9 9 9 ]", "[ nan ]", "[ .5 .5 .5 -1 0 0 0 ]"] {
        let faces = FACES.replace(" ] }", &format!(" ] normalIndex {indices} }}"));
        let scene = iv(&format!("Normal {{ vector 0 0 -1 }}\n{POINTS}{faces}"));
        is_box(indices, &scene, 2, SQUARE);
        warns(indices, &scene, "normals are computed");
        assert_eq!(scene.vertices[scene.triangles[0].vertices[0] as usize].normal, Vec3::Z, "{indices}");
    }
}

#[test]
fn materials_lights_and_cameras_with_errors_have_their_defaults() {
    for (node, warning) in [
        ("Material { diffuseColor [ 1 0 ] }", "a.iv:2: diffuseColor: 2 numbers are not a multiple of 3"),
        ("Material { diffuseColor nan nan nan }", "a.iv:2: diffuseColor: a number is not finite"),
        ("Material { diffuseColor red shininess -1.#IND }", "diffuseColor"),
        ("Material { transparency 1.#QNAN }", "transparency: a number is not finite"),
        ("BaseColor { rgb [ 1 0 1.#INF ] }", "rgb: a number is not finite"),
        ("PackedColor { orderedRGBA [ xyz ] }", "orderedRGBA: a number is not finite"),
        ("MaterialBinding { value PER_MOON }", "value: `PER_MOON` is not one of its values"),
        ("DrawStyle { style SOLID }", "style: `SOLID` is not one of its values"),
        ("ShapeHints { creaseAngle wide }", "a.iv:2: creaseAngle: the number is not finite"),
        ("Environment { ambientIntensity -nan }", "ambientIntensity: the number is not finite"),
        ("PointLight { on PERHAPS }", "a.iv:2: on: give TRUE or FALSE: the light is ignored"),
        ("PointLight { location 0 0 }", "location: needs 3 numbers: the light is ignored"),
        ("PointLight { location 0 0 1e39 }", "is not finite: the light is ignored"),
        ("PointLight { intensity 1e39 }", "is not finite: the light is ignored"),
        ("PointLight { color 1e39 0 0 }", "is not finite: the light is ignored"),
        ("PointLight { location nan 0 0 }", "a number of the light is not finite: the light is ignored"),
        ("DirectionalLight { direction 0 0 -1.#IND }", "the light is ignored"),
        ("PerspectiveCamera { position 0 0 }", "position: needs 3 numbers: the camera is ignored"),
        ("PerspectiveCamera { heightAngle nan }", "the camera has no valid direction or field of view"),
        ("TextureCoordinate2 { point [ -1.#IND nan, 1..2 x ] }", ""),
        ("Texture2 { image 1 1 3 0xffffff }", "Texture2 ignored"),
    ] {
        let scene = iv(&format!("{node}\n{POINTS}{FACES}"));
        is_box(node, &scene, 2, SQUARE);
        if !warning.is_empty() {
            warns(node, &scene, warning);
        }
        assert!(scene.lights.is_empty() && scene.camera.is_none(), "{node}");
    }
}

#[test]
fn strings_without_quotes_may_begin_like_numbers() {
    for node in [
        "Texture2 { filename 3dview.gif }",
        "Texture2 { filename ../tex/a.gif wrapS CLAMP }",
        "Texture2 { filename .hidden }",
        "Texture2 { filename +plus.gif }",
        "Info { string -made-by-hand- }",
        "Info { string 2001-09-11T12:00 }",
        "Info { string ... }",
        "Info { string 1.2.3 }",
        "Info { string 7 }",
        "Label { label -5b }",
        "Info { string -nan(ind) }",
        "DEF 3box Info { string .5x }",
        "Unknown { fields [ SFString a ] a -x- b 5 }",
    ] {
        is_box(node, &iv(&format!("{node}\n{POINTS}{FACES}")), 2, SQUARE);
    }
    for name in ["3d.iv", "-part.iv", ".part.iv", "../scene/3d.iv", "+x.iv", "7"] {
        let files = Files::new(&[("a.iv", &format!("#Inventor V2.1 ascii\nFile {{ name {name} }}\n"))]);
        files.write(name, format!("#Inventor V2.1 ascii\n{POINTS}{FACES}").as_bytes());
        let scene = files.load("a.iv").unwrap_or_else(|error| panic!("{name}: {error}"));
        is_box(name, &scene, 2, SQUARE);
    }
    // Numbers that are no strings are still errors.
    for text in ["Cube { width 1..2 }", "Cube { width 3d }", "Translation { translation 0 0 nan } Cube {}"] {
        refusal(Files::new(&[("a.iv", &format!("#Inventor V2.1 ascii\n{text}"))]).load("a.iv"));
    }
}

#[test]
fn copies_set_what_switches_inherit() {
    let switch = "Switch { whichChild -2 Cube {} Group { Cube {} Cube {} } Group { Cube {} Cube {} Cube {} } }";
    let identity = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
    for (text, cubes) in [
        (format!("Array {{ numElements1 2 {switch} }}"), 1 + 2),
        (format!("Array {{ numElements1 3 {switch} }}"), 1 + 2 + 3),
        (format!("Array {{ numElements1 4 {switch} }}"), 1 + 2 + 3 + 1),
        (format!("Array {{ numElements1 2 numElements2 2 {switch} }}"), 1 + 2 + 3 + 1),
        (format!("Array {{ numElements3 3 {switch} }}"), 1 + 2 + 3),
        (format!("MultipleCopy {{ matrix [ {identity}, {identity} ] {switch} }}"), 1 + 2),
        (
            format!("MultipleCopy {{ matrix [ {identity}, {identity}, {identity} ] Separator {{ {switch} }} }}"),
            1 + 2 + 3,
        ),
        (format!("Array {{ numElements1 2 Array {{ numElements1 3 {switch} }} }}"), 2 * 6),
        (format!("Switch {{ whichChild 1 Cube {{}} {switch} }}"), 2),
        (format!("Switch {{ whichChild 0 Array {{ numElements1 2 {switch} }} }}"), 1 + 2),
        (format!("Array {{ numElements1 2 Cube {{}} }} {switch} Cube {{}}"), 2 + 1),
    ] {
        assert_eq!(iv(&text).triangles.len(), 12 * cubes, "{text}");
    }
}

#[test]
fn ignored_fields_leave_the_state_unchanged() {
    let turned = iv(&format!("Rotation {{ rotation 0 1 0 0.78 }} {POINTS}{FACES}")).bounds();
    for reset in ["whatToReset ~", "whatToReset TRANSFORM ~", "whatToReset BBOX", "whatToReset ALL~"] {
        let scene = iv(&format!("Rotation {{ rotation 0 1 0 0.78 }} ResetTransform {{ {reset} }} {POINTS}{FACES}"));
        assert_eq!(scene.bounds(), turned, "{reset}");
    }
    for node in [
        "Units { units ~ }",
        "Units { units FEET ~ }",
        "Scale { scaleFactor 5 5 5 ~ }",
        "Translation { translation ~ }",
        "Transform { translation 1 2 3 ~ rotation 0 1 0 1 ~ }",
        "RotationXYZ { axis Y ~ angle 1 }",
        "RotationXYZ { axis Y angle 1 ~ }",
        "MatrixTransform { matrix ~ }",
        "Coordinate3 { point [ 9 9 9 ] ~ }",
        "DrawStyle { style INVISIBLE ~ }",
        "Switch { whichChild 0 ~ Cube {} }",
        "Array { numElements1 ~ }",
    ] {
        let scene = iv(&format!("{POINTS}{node}{FACES}"));
        is_box(node, &scene, 2, SQUARE);
    }
    // The other fields of a node are applied.
    let scene = iv(&format!("{POINTS}ShapeHints {{ creaseAngle 1 ~ vertexOrdering CLOCKWISE }}{FACES}"));
    assert_eq!(scene.vertices[scene.triangles[0].vertices[0] as usize].normal, Vec3::NEG_Z);
}

#[test]
fn faces_with_coordinates_that_are_not_finite_are_dropped_and_counted() {
    for x in ["nan", "-1.#IND", "1.#QNAN", "inf", "-nan(ind)", "1e999", "1.#INF"] {
        let points = POINTS.replace("2 3 1", &format!("{x} {x} {x}"));
        for (crease, vertices) in [("", ""), ("ShapeHints { creaseAngle 3 }", ""), ("", "USE")] {
            let text = match vertices {
                "" => format!("{crease}{points}{FACES}"),
                _ => FACES
                    .replace("{ ", &format!("{{ vertexProperty VertexProperty {{ {} ", &points[14..]))
                    .replace("point", "vertex"),
            };
            let scene = iv(&text);
            is_box(x, &scene, 1, TRIANGLE);
            warns(x, &scene, "1 faces with vertices that are not finite are dropped (first: a.iv:");
        }
        is_box(x, &iv(&format!("{points}IndexedFaceSet {{ coordIndex [ 0 1 2 ] }}")), 1, TRIANGLE);
    }
}
