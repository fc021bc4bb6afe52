//! Tests of Open Inventor: face sets, and the binding of materials and normals.

use super::Files;
use super::inventor::{POINTS, PYRAMID, colours, corners, faces_out, iv, materials, near};
use glam::{DVec3, Vec3};

#[test]
fn all_kinds_of_face_sets_give_the_same_faces() {
    let square = "vertexProperty VertexProperty { vertex [ 9 9 9, 0 0 0, 1 0 0, 0 1 0, 1 1 0, 0 2 0, 1 2 0 ] }";
    for (text, triangles) in [
        (format!("{POINTS}{PYRAMID}"), 2 + 4),
        (format!("{POINTS}IndexedFaceSet {{ coordIndex [ 0 1 2 3 ] }}"), 2),
        (format!("{POINTS}IndexedFaceSet {{ coordIndex [ 0 1 2 -1 -1 0 1 -1 0 2 3 -1 ] }}"), 2),
        (format!("{POINTS}IndexedTriangleStripSet {{ coordIndex [ 0 1 3 2 -1 0 1 4 ] }}"), 3),
        (format!("FaceSet {{ startIndex 1 numVertices [ 3, -1 ] {square} }}"), 1 + 1),
        (format!("FaceSet {{ {square} }}"), 5),
        (format!("TriangleStripSet {{ startIndex 1 {square} }}"), 4),
        (format!("TriangleStripSet {{ startIndex 1 numVertices [ 4, 2 ] {square} }}"), 2),
        (format!("QuadMesh {{ startIndex 1 verticesPerColumn 3 verticesPerRow 2 {square} }}"), 4),
        ("Coordinate4 { point [ 0 0 0 2, 2 0 0 2, 2 2 0 2 ] } FaceSet {}".to_owned(), 1),
    ] {
        let scene = iv(&text);
        assert_eq!(scene.triangles.len(), triangles, "{text}");
        if !text.contains("{ vertexP") {
            // All except the face of all points, which intersects itself
            faces_out(&scene, &text);
        }
    }
    // A corner has the normal of its coordinate, even if the set does not begin with the first coordinate.
    let normals = "Normal { vector [ 0 0 1, 0 1 0, 1 0 0, 0 0 -1 ] } NormalBinding { value PER_VERTEX }";
    let scene = iv(&format!("{normals}{POINTS}FaceSet {{ startIndex 1 numVertices 3 }}"));
    assert_eq!(scene.triangles[0].vertices.map(|v| scene.vertices[v as usize].normal), [Vec3::Y, Vec3::X, Vec3::NEG_Z]);
    // All triangles of a strip have the same orientation, which CLOCKWISE inverts.
    for (hints, z) in [("", 1.0), ("ShapeHints { vertexOrdering CLOCKWISE }", -1.0)] {
        let scene = iv(&format!("{hints} TriangleStripSet {{ startIndex 1 {square} }}"));
        assert!(scene.vertices.iter().all(|v| v.normal == Vec3::Z * z), "{hints}: {:?}", scene.vertices);
        faces_out(&scene, hints);
    }
    let mesh = iv(&format!("QuadMesh {{ startIndex 1 verticesPerColumn 3 verticesPerRow 2 {square} }}"));
    assert_eq!(mesh.vertices.len(), 6, "coplanar faces share vertices");
    near(corners(&iv("Coordinate4 { point [ 0 0 0 2, 2 0 0 2, 2 2 0 2 ] } FaceSet {}"), 0)[2], [1., 1., 0.], "divided");
}

#[test]
fn material_bindings_are_applied() {
    let rgb = "BaseColor { rgb [ 1 0 0, 0 1 0, 0 0 1, 1 1 1 ] } ";
    let bound = |binding: &str, shape: &str| {
        colours(&iv(&format!("{rgb}{POINTS}MaterialBinding {{ value {binding} }} {shape}")))
    };
    let faces = |indices: &str| PYRAMID.replace(" ] }", &format!(" ] materialIndex [ {indices} ] }}"));
    assert_eq!(bound("OVERALL", PYRAMID), "rrrrrr");
    assert_eq!(bound("DEFAULT", PYRAMID), "rrrrrr");
    // There are five faces and four materials: the fifth face has the first material.
    assert_eq!(bound("PER_FACE", PYRAMID), "rrgbwr");
    assert_eq!(bound("PER_PART", PYRAMID), "rrgbwr");
    assert_eq!(bound("PER_FACE_INDEXED", &faces("3 3 2 1 0")), "wwwbgr");
    assert_eq!(bound("PER_FACE", &faces("3 3 2 1 0")), "rrgbwr", "PER_FACE ignores indices");
    // Without materialIndex, faces use the entries of coordIndex, as in the reference implementation.
    assert_eq!(bound("PER_FACE_INDEXED", "IndexedFaceSet { coordIndex [ 2 1 0 -1 0 1 2 -1 1 2 3 ] }"), "bgr");
    let vertices = "0 0 0 0 -1 1 1 1 -1 2 2 2 -1 3 3 3 -1 0 1 2 -1";
    assert_eq!(bound("PER_VERTEX_INDEXED", &faces(vertices)), "rrgbw?");
    let strip = "IndexedTriangleStripSet { coordIndex [ 0 1 3 2 4 -1 0 1 4 ] }";
    assert_eq!(bound("PER_PART", strip), "rrrg");
    assert_eq!(bound("PER_FACE", strip), "rgbw");
    assert_eq!(bound("PER_PART", "Cube {}"), "rrggbbwwrrgg");
    assert_eq!(bound("PER_FACE", "Cube {}"), "rrggbbwwrrgg");
    assert_eq!(bound("PER_PART", "Cone {}"), format!("{}{}", "r".repeat(24), "g".repeat(24)));
    assert_eq!(bound("PER_PART", "Cylinder {}"), format!("{}{}{}", "r".repeat(48), "g".repeat(24), "b".repeat(24)));
    assert_eq!(bound("PER_PART", "Sphere {}"), "r".repeat(528));
    let mesh = "QuadMesh { verticesPerColumn 3 verticesPerRow 2 vertexProperty VertexProperty { \
        vertex [ 0 0 0, 1 0 0, 0 1 0, 1 1 0, 0 2 0, 1 2 0 ] } }";
    assert_eq!(bound("PER_PART", mesh), "rrgg");
    // Corners with different colours give their mean, and a warning.
    let scene = iv(&format!(
        "{rgb}MaterialBinding {{ value PER_VERTEX }} FaceSet {{ vertexProperty VertexProperty {{ vertex [ 0 0 0, 1 0 0, 0 1 0 ] }} }}"
    ));
    near(scene.materials[0].diffuse, [1. / 3.; 3], "mean");
    assert_eq!(scene.warnings, ["colours bound to corners: a face has the mean of its corners"]);
    // The colours of a vertex property have precedence, if there are any.
    let own = |colours: &str| {
        format!(
            "{rgb}MaterialBinding {{ value PER_FACE }} FaceSet {{ numVertices [ 3 3 ] vertexProperty VertexProperty {{ \
             vertex [ 0 0 0, 1 0 0, 0 1 0, 0 0 0, 1 0 0, 0 1 0 ] orderedRGBA [ {colours} ] materialBinding OVERALL }} }}"
        )
    };
    assert_eq!(colours(&iv(&own("0x0000ffff"))), "bb");
    assert_eq!(colours(&iv(&own(""))), "rg");
    assert_eq!(colours(&iv("PackedColor { orderedRGBA 0x00ff00ff } Cube {}")), "g".repeat(12));
    assert_eq!(
        colours(&iv("PackedColor { rgba 0xff0000ff } Cube {}")),
        "r".repeat(12),
        "V2.0 has the opposite byte order"
    );
}

#[test]
fn materials_have_their_defaults_and_ambient_light() {
    let only = |text: &str| iv(&format!("{text} Cube {{}}")).materials[0];
    let plain = only("");
    near(plain.ambient, [0.04; 3], "ambientColor 0.2 times ambient light 0.2");
    near(plain.diffuse, [0.8; 3], "default");
    assert_eq!((plain.specular, plain.reflectivity), (Vec3::ZERO, 0.0));
    assert!((plain.exponent - 25.6).abs() < 1e-4);
    let full = only(
        "Environment { ambientIntensity .5 ambientColor 1 0 0 } Material { ambientColor .4 .4 .4 diffuseColor .1 .2 .3 \
         specularColor .5 .6 .7 emissiveColor 0 .25 0 shininess 1 }",
    );
    near(full.ambient, [0.2, 0.25, 0.], "ambient light plus emission");
    near(full.diffuse, [0.1, 0.2, 0.3], "diffuse");
    near(full.specular, [0.5, 0.6, 0.7], "specular");
    assert_eq!((full.exponent, full.reflectivity), (128.0, 0.0));
    let unlit = only("LightModel { model BASE_COLOR } BaseColor { rgb 1 .5 0 }");
    assert_eq!((unlit.ambient, unlit.diffuse, unlit.specular), (Vec3::new(1.0, 0.5, 0.0), Vec3::ZERO, Vec3::ZERO));
    // Absent fields of a material have their defaults, unless they are ignored (`~`); lists are repeated.
    near(only("BaseColor { rgb 1 0 0 } Material { shininess 1 }").diffuse, [0.8; 3], "set again");
    near(only("BaseColor { rgb 1 0 0 } Material { diffuseColor 0 1 0 ~ }").diffuse, [1., 0., 0.], "ignored");
    near(only("BaseColor { rgb 1 0 0 } Material { diffuseColor ~ }").diffuse, [1., 0., 0.], "ignored");
    near(only("BaseColor { rgb 1 0 0 } Material { diffuseColor [] }").diffuse, [1., 0., 0.], "empty");
    near(only("BaseColor { rgb 1 0 0 } BaseColor { rgb [] }").diffuse, [1., 0., 0.], "empty");
    near(only("BaseColor { rgb 1 0 0 } BaseColor {}").diffuse, [0.8; 3], "default");
    near(only("BaseColor { rgb 1 0 0 } PackedColor {}").diffuse, [0.8; 3], "default");
    let lists = iv(
        "Material { diffuseColor [ 1 0 0, 0 1 0, 0 0 1 ] shininess [ 0, 1 ] } MaterialBinding { value PER_PART } Cube {}",
    );
    let exponents: Vec<f32> = materials(&lists).iter().step_by(2).map(|m| m.exponent).collect();
    assert_eq!((colours(&lists).as_str(), exponents), ("rrggbbrrggbb", vec![0.0, 128.0, 0.0, 128.0, 0.0, 128.0]));
    let clear = iv(
        "Material { transparency .5 } Cube {} DrawStyle { style LINES } Cube {} DrawStyle { style INVISIBLE } Cube {}",
    );
    assert_eq!(clear.triangles.len(), 12);
    assert_eq!(
        clear.warnings,
        [
            "transparent material: rendered opaque (6 times)",
            "shape with a draw style other than FILLED ignored (2 times)"
        ]
    );
}

#[test]
fn normals_are_bound_or_computed() {
    let normals = "Normal { vector [ 0 0 -1, 0 -1 1, 1 0 1, 0 1 1, -1 0 1 ] } ";
    let of = |text: &str| {
        let scene = iv(text);
        let normals: Vec<[Vec3; 3]> =
            scene.triangles.iter().map(|t| t.vertices.map(|v| scene.vertices[v as usize].normal)).collect();
        (normals, scene)
    };
    for (binding, indices) in [
        ("PER_FACE", ""),
        ("PER_PART", ""),
        ("PER_FACE_INDEXED", "normalIndex [ 0 1 2 3 4 ]"),
        ("PER_VERTEX_INDEXED", "normalIndex [ 0 0 0 0 -1 1 1 1 -1 2 2 2 -1 3 3 3 -1 4 4 4 -1 ]"),
    ] {
        let pyramid = PYRAMID.replace(" ] }", &format!(" ] {indices} }}"));
        let (found, scene) = of(&format!("{normals}NormalBinding {{ value {binding} }} {POINTS}{pyramid}"));
        assert_eq!(scene.vertices.len(), 4 + 4 * 3, "{binding}");
        assert_eq!(found[0], [Vec3::NEG_Z; 3], "{binding}");
        near(found[2][0], [0., -0.5f32.sqrt(), 0.5f32.sqrt()], binding);
        near(found[5][2], [-0.5f32.sqrt(), 0., 0.5f32.sqrt()], binding);
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    }
    // By default corners have the normals of their coordinates, and share vertices.
    let (found, scene) = of(&format!("{normals}{POINTS}{PYRAMID}"));
    assert_eq!((scene.vertices.len(), found[2][0], found[0][2]), (5, Vec3::NEG_Z, found[2][1]));
    let (found, _) = of(&format!("{normals}NormalBinding {{ value OVERALL }} {POINTS}{PYRAMID}"));
    assert!(found.iter().flatten().all(|&normal| normal == Vec3::NEG_Z));
    // With PER_VERTEX, 4 + 3 * 4 corners need 16 normals.
    let (_, scene) = of(&format!("{normals}NormalBinding {{ value PER_VERTEX }} {POINTS}{PYRAMID}"));
    assert_eq!(scene.warnings, ["fewer normals than bindings: normals are computed"]);
    faces_out(&scene, "made");
    assert_eq!(scene.vertices.len(), 4 + 4 * 3, "the crease angle of V2.1 is 0");
    // The angles between normals are 1.37 for adjacent sides, 2.03 for a side and the base, 2.21 for opposite sides.
    for (angle, vertices) in [("1.3", 16), ("1.4", 4 + 4 + 4), ("2.1", 4 + 4), ("2.3", 5)] {
        let (found, scene) = of(&format!("ShapeHints {{ creaseAngle {angle} }} {POINTS}{PYRAMID}"));
        assert_eq!(scene.vertices.len(), vertices, "{angle}");
        let up = found[2][2];
        assert!((up.z > 0.9999) == (angle == "2.3"), "{angle}: {up}");
    }
    // The crease angle of VRML 1.0 is 0.5.
    let bent = "Coordinate3 { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0, 1 2 .3, 0 2 .3 ] } \
        IndexedFaceSet { coordIndex [ 0 1 2 3 -1 3 2 4 5 -1 ] }";
    for (header, vertices) in [("#VRML V1.0 ascii", 6), ("#Inventor V2.0 ascii", 8), ("#Inventor V2.1 ascii", 8)] {
        let scene = Files::new(&[("main.wrl", &format!("{header}\n{bent}"))]).load("main.wrl").unwrap();
        assert_eq!(scene.vertices.len(), vertices, "{header}");
    }
}

/// Every corner of a bumpy surface has the normal by the definition, with and without creases.
#[test]
fn creases_agree_with_the_definition() {
    const SIDE: usize = 12;
    let height =
        |i: usize| ((i * 7919 + i / 5 * 104_729) % 97) as f64 / 97.0 * if i % SIDE < SIDE / 2 { 0.1 } else { 1.5 };
    let points: Vec<DVec3> =
        (0..SIDE * SIDE).map(|i| DVec3::new((i % SIDE) as f64, (i / SIDE) as f64, height(i))).collect();
    let corner = |i: usize| i / (SIDE - 1) * SIDE + i % (SIDE - 1);
    let faces: Vec<[usize; 3]> = (0..(SIDE - 1) * (SIDE - 1))
        .map(corner)
        .flat_map(|i| [[i, i + 1, i + SIDE], [i + 1, i + SIDE + 1, i + SIDE]])
        .collect();
    let flat: Vec<DVec3> =
        faces.iter().map(|face| face.map(|i| points[i])).map(|[a, b, c]| (b - a).cross(c - a).normalize()).collect();
    let texts = |lists: Vec<String>| lists.join(", ");
    let point = texts(points.iter().map(|p| format!("{} {} {}", p.x, p.y, p.z)).collect());
    let index = texts(faces.iter().map(|[a, b, c]| format!("{a} {b} {c} -1")).collect());
    let (mut creased, mut whole) = (0, 0);
    for angle in [0.05f64, 0.3, 0.6, 1.2, 2.0, 4.0] {
        let scene = iv(&format!(
            "ShapeHints {{ creaseAngle {angle} }} Coordinate3 {{ point [ {point} ] }} IndexedFaceSet {{ coordIndex [ {index} ] }}"
        ));
        for (face, triangle) in scene.triangles.iter().enumerate() {
            for (k, &vertex) in triangle.vertices.iter().enumerate() {
                let around: Vec<usize> =
                    (0..faces.len()).filter(|&other| faces[other].contains(&faces[face][k])).collect();
                let smooth = |&&other: &&usize| flat[other].angle_between(flat[face]) <= angle;
                let sum: DVec3 = around.iter().filter(smooth).map(|&other| flat[other]).sum();
                near(scene.vertices[vertex as usize].normal, sum.normalize().as_vec3().to_array(), &angle.to_string());
                let count = around.iter().filter(smooth).count();
                *(if count < around.len() { &mut creased } else { &mut whole }) += 1;
            }
        }
    }
    assert!(creased > 1000 && whole > 1000, "{creased} {whole}");
}
