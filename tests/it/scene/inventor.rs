//! Open Inventor and VRML 1.0: what each node makes, what is refused, and the real fixtures with counts worked out by hand.

use super::{Files, real_scenes, refusal};
use glam::Vec3;
use rtbench::scene::{self, Material, Scene};

const HEADER: &str = "#Inventor V2.1 ascii\n";

fn iv(text: &str) -> Scene {
    let files = Files::new(&[("main.iv", &format!("{HEADER}{text}"))]);
    files.load("main.iv").unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// Positions of the corners of a triangle.
fn corners(scene: &Scene, triangle: usize) -> [Vec3; 3] {
    scene.triangles[triangle].vertices.map(|v| scene.vertices[v as usize].position)
}

fn near(found: Vec3, expected: [f32; 3], what: &str) {
    assert!((found - Vec3::from(expected)).abs().max_element() < 1e-5, "{what}: {found}, not {expected:?}");
}

/// The material of every triangle.
fn materials(scene: &Scene) -> Vec<Material> {
    scene.triangles.iter().map(|triangle| scene.materials[triangle.material as usize]).collect()
}

/// Diffuse colours of all triangles, a letter for each: white if all are 1, black if all are 0, `?` for what is none.
fn colours(scene: &Scene) -> String {
    let letter = |m: &Material| match m.diffuse.to_array() {
        [1.0, 0.0, 0.0] => 'r',
        [0.0, 1.0, 0.0] => 'g',
        [0.0, 0.0, 1.0] => 'b',
        [1.0, 1.0, 1.0] => 'w',
        _ => '?',
    };
    materials(scene).iter().map(letter).collect()
}

/// Every triangle's normals are on the side from which it turns counter-clockwise.
fn faces_out(scene: &Scene, what: &str) {
    for t in &scene.triangles {
        let [a, b, c] = t.vertices.map(|v| scene.vertices[v as usize]);
        let turn = (b.position - a.position).cross(c.position - a.position);
        for vertex in [a, b, c] {
            assert!(vertex.normal.is_normalized() && vertex.normal.dot(turn) > 0.0, "{what}: {vertex:?} {turn}");
        }
    }
}

/// A square in the plane z = 0 and a point above its middle, and faces of them.
const POINTS: &str = "Coordinate3 { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0, .5 .5 1 ] }\n";
const PYRAMID: &str =
    "IndexedFaceSet { coordIndex [ 3, 2, 1, 0, -1, 0, 1, 4, -1, 1, 2, 4, -1, 2, 3, 4, -1, 3, 0, 4, -1 ] }";

#[test]
fn solids_have_the_formats_sizes_and_look_outward() {
    for (text, triangles, vertices, min, max) in [
        ("Cube {}", 12, 24, [-1., -1., -1.], [1., 1., 1.]),
        ("Cube { width 1 height 4. depth .5 }", 12, 24, [-0.5, -2., -0.25], [0.5, 2., 0.25]),
        ("Sphere {}", 528, 266, [-1., -1., -1.], [1., 1., 1.]),
        ("Cone {}", 48, 73, [-1., -1., -1.], [1., 1., 1.]),
        ("Cone { bottomRadius 2 height 6 parts SIDES }", 24, 48, [-2., -3., -2.], [2., 3., 2.]),
        ("Cone { parts BOTTOM }", 24, 25, [-1., -1., -1.], [1., -1., 1.]),
        ("Cylinder {}", 96, 98, [-1., -1., -1.], [1., 1., 1.]),
        ("Cylinder { radius .5 height 3 parts (SIDES | BOTTOM) }", 72, 73, [-0.5, -1.5, -0.5], [0.5, 1.5, 0.5]),
        ("Cylinder { parts TOP }", 24, 25, [-1., 1., -1.], [1., 1., 1.]),
    ] {
        let scene = iv(text);
        assert_eq!((scene.triangles.len(), scene.vertices.len()), (triangles, vertices), "{text}");
        near(scene.bounds().min, min, text);
        near(scene.bounds().max, max, text);
        faces_out(&scene, text);
    }
    let files = Files::new(&[("main.wrl", "#VRML V1.0 ascii\nSphere {}")]);
    assert_eq!(files.load("main.wrl:segments=8").unwrap().triangles.len(), 8 * 3 * 2);
}

#[test]
fn transforms_apply_from_the_innermost_outwards_and_matrices_are_rows() {
    let triangle = "FaceSet { vertexProperty VertexProperty { vertex [ 0 0 0, 1 0 0, 0 1 0 ] } }";
    for (text, expected) in [
        (
            "Translation { translation 1 0 0 } RotationXYZ { axis Z angle 1.57079633 } Scale { scaleFactor 2 1 1 }",
            [[1., 0., 0.], [1., 2., 0.], [0., 0., 0.]],
        ),
        ("Rotation { rotation 0 2 0 1.57079633 }", [[0., 0., 0.], [0., 0., -1.], [0., 1., 0.]]),
        ("Rotation { rotation 0 0 0 2 }", [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]]),
        // About the center (1, 0, 0): a scale by two along y, since its axes are turned, then a quarter turn
        (
            "Transform { translation 10 0 0 rotation 0 0 1 1.57079633 scaleFactor 2 1 1 \
             scaleOrientation 0 0 1 1.57079633 center 1 0 0 }",
            [[11., -1., 0.], [11., 0., 0.], [9., -1., 0.]],
        ),
        ("MatrixTransform { matrix 0 1 0 0 -1 0 0 0 0 0 1 0 5 6 7 1 }", [[5., 6., 7.], [5., 7., 7.], [4., 6., 7.]]),
        ("Units { units CENTIMETERS }", [[0., 0., 0.], [0.01, 0., 0.], [0., 0.01, 0.]]),
        ("Units { units FEET } Units { units METERS }", [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]]),
        ("Scale { scaleFactor 7 7 7 } ResetTransform {}", [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]]),
        // A field that is to be ignored, and one that moves
        ("Translation { translation 9 9 9 ~ }", [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]]),
        ("Translation { translation 0 0 1 = Calculator { a 3 } . oA }", [[0., 0., 1.], [1., 0., 1.], [0., 1., 1.]]),
    ] {
        let scene = iv(&format!("{text} {triangle}"));
        for (found, expected) in corners(&scene, 0).into_iter().zip(expected) {
            near(found, expected, text);
        }
    }
}

#[test]
fn separators_save_what_groups_leak() {
    let sized = |text: &str| iv(text).bounds();
    let inner = "Scale { scaleFactor 3 3 3 } BaseColor { rgb 1 0 0 }";
    assert_eq!(sized(&format!("Separator {{ {inner} }} Cube {{}}")).max, Vec3::ONE);
    assert_eq!(sized(&format!("Group {{ {inner} }} Cube {{}}")).max, Vec3::splat(3.0));
    assert_eq!(sized(&format!("TransformSeparator {{ {inner} }} Cube {{}}")).max, Vec3::ONE);
    assert_eq!(colours(&iv(&format!("TransformSeparator {{ {inner} }} Cube {{}}"))), "r".repeat(12));
    assert_eq!(colours(&iv(&format!("Separator {{ {inner} }} Cube {{}}"))), "?".repeat(12));
    assert_eq!(sized(&format!("WWWAnchor {{ name \"x\" {inner} }} Cube {{}}")).max, Vec3::ONE);
}

#[test]
fn switches_levels_and_copies_choose_what_is_shown() {
    let solids = "Cube {} Sphere {} Cone {}";
    for (text, triangles) in [
        ("Switch { whichChild 0 SOLIDS } Cube {}".to_owned(), 24),
        ("Switch { whichChild 1 SOLIDS }".to_owned(), 528),
        ("Switch { SOLIDS } Cube {}".to_owned(), 12),
        ("Switch { whichChild -1 SOLIDS } Cube {}".to_owned(), 12),
        ("Switch { whichChild -3 SOLIDS }".to_owned(), 12 + 528 + 48),
        // The inner one takes over the outer one's choice, and starts again where it has fewer
        ("Switch { whichChild 2 Cube {} Cube {} Switch { whichChild -2 SOLIDS } }".to_owned(), 48),
        ("Switch { whichChild 2 Cube {} Cube {} Switch { whichChild -2 Sphere {} Cube {} } }".to_owned(), 528),
        ("Switch { whichChild 7 SOLIDS } Cube {}".to_owned(), 12),
        ("LOD { range [ 5, 9 ] SOLIDS }".to_owned(), 12),
        ("LevelOfDetail { SOLIDS }".to_owned(), 12),
        ("LevelOfDetail {} Cube {}".to_owned(), 12),
        ("DEF a Cube {} USE a DEF a Cone {} USE a".to_owned(), 12 * 2 + 48 * 2),
        ("DEF two Group { DEF one Cube {} USE one } USE two".to_owned(), 48),
    ] {
        let text = text.replace("SOLIDS", solids);
        assert_eq!(iv(&text).triangles.len(), triangles, "{text}");
    }
    let array = iv("Array { numElements1 3 separation1 4 0 0 numElements2 2 separation2 0 5 0 Cube {} }");
    assert_eq!((array.triangles.len(), array.bounds().max), (72, Vec3::new(9.0, 6.0, 1.0)));
    let array = iv("Array { numElements1 3 separation1 4 0 0 origin CENTER Cube {} }");
    assert_eq!((array.bounds().min.x, array.bounds().max.x), (-5.0, 5.0));
    let array = iv("Array { numElements1 3 separation1 4 0 0 origin LAST Cube {} }");
    assert_eq!((array.bounds().min.x, array.bounds().max.x), (-9.0, 1.0));
    let copies =
        iv("MultipleCopy { matrix [ 1 0 0 0 0 1 0 0 0 0 1 0 9 0 0 1, 2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1 ] Cube {} }");
    assert_eq!((copies.triangles.len(), copies.bounds().max), (24, Vec3::new(10.0, 2.0, 2.0)));
}

#[test]
fn sets_of_faces_share_one_meaning() {
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
            // All but the face of every point there is, which runs into itself
            faces_out(&scene, &text);
        }
    }
    // A strip's triangles all turn the same way; turned around, they turn the other way
    for (hints, z) in [("", 1.0), ("ShapeHints { vertexOrdering CLOCKWISE }", -1.0)] {
        let scene = iv(&format!("{hints} TriangleStripSet {{ startIndex 1 {square} }}"));
        assert!(scene.vertices.iter().all(|v| v.normal == Vec3::Z * z), "{hints}: {:?}", scene.vertices);
        faces_out(&scene, hints);
    }
    let mesh = iv(&format!("QuadMesh {{ startIndex 1 verticesPerColumn 3 verticesPerRow 2 {square} }}"));
    assert_eq!(mesh.vertices.len(), 6, "flat: corners are shared");
    near(corners(&iv("Coordinate4 { point [ 0 0 0 2, 2 0 0 2, 2 2 0 2 ] } FaceSet {}"), 0)[2], [1., 1., 0.], "divided");
}

#[test]
fn materials_are_bound_as_the_file_says() {
    let rgb = "BaseColor { rgb [ 1 0 0, 0 1 0, 0 0 1, 1 1 1 ] } ";
    let bound = |binding: &str, shape: &str| {
        colours(&iv(&format!("{rgb}{POINTS}MaterialBinding {{ value {binding} }} {shape}")))
    };
    let faces = |indices: &str| PYRAMID.replace(" ] }", &format!(" ] materialIndex [ {indices} ] }}"));
    assert_eq!(bound("OVERALL", PYRAMID), "rrrrrr");
    assert_eq!(bound("DEFAULT", PYRAMID), "rrrrrr");
    // Five faces of four materials: the fifth has the first again
    assert_eq!(bound("PER_FACE", PYRAMID), "rrgbwr");
    assert_eq!(bound("PER_PART", PYRAMID), "rrgbwr");
    assert_eq!(bound("PER_FACE_INDEXED", &faces("3 3 2 1 0")), "wwwbgr");
    assert_eq!(bound("PER_FACE", &faces("3 3 2 1 0")), "rrgbwr", "indices that do not count");
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
    // Corners of different colours: their mean, and the user is told
    let scene = iv(&format!(
        "{rgb}MaterialBinding {{ value PER_VERTEX }} FaceSet {{ vertexProperty VertexProperty {{ vertex [ 0 0 0, 1 0 0, 0 1 0 ] }} }}"
    ));
    near(scene.materials[0].diffuse, [1. / 3.; 3], "mean");
    assert_eq!(scene.warnings, ["colours bound to corners: a face has their mean"]);
    // Those of a vertex property go before, if there are any
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
        "V2.0 has them the other way round"
    );
}

#[test]
fn materials_have_the_formats_defaults_and_light() {
    let only = |text: &str| iv(&format!("{text} Cube {{}}")).materials[0];
    let plain = only("");
    near(plain.ambient, [0.04; 3], "a fifth of a fifth");
    near(plain.diffuse, [0.8; 3], "default");
    assert_eq!((plain.specular, plain.reflectivity), (Vec3::ZERO, 0.0));
    assert!((plain.exponent - 25.6).abs() < 1e-4);
    let full = only(
        "Environment { ambientIntensity .5 ambientColor 1 0 0 } Material { ambientColor .4 .4 .4 diffuseColor .1 .2 .3 \
         specularColor .5 .6 .7 emissiveColor 0 .25 0 shininess 1 }",
    );
    near(full.ambient, [0.2, 0.25, 0.], "ambient light and its own");
    near(full.diffuse, [0.1, 0.2, 0.3], "diffuse");
    near(full.specular, [0.5, 0.6, 0.7], "specular");
    assert_eq!((full.exponent, full.reflectivity), (128.0, 0.0));
    let unlit = only("LightModel { model BASE_COLOR } BaseColor { rgb 1 .5 0 }");
    assert_eq!((unlit.ambient, unlit.diffuse, unlit.specular), (Vec3::new(1.0, 0.5, 0.0), Vec3::ZERO, Vec3::ZERO));
    // A material sets what it does not mention as well, unless it is told to ignore it; lists start again
    near(only("BaseColor { rgb 1 0 0 } Material { shininess 1 }").diffuse, [0.8; 3], "set again");
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
            "transparent material: shown opaque (6 times)",
            "shape drawn as lines, as points or not at all left out (2 times)"
        ]
    );
}

#[test]
fn normals_are_bound_or_made() {
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
    // By default corners have the normals of their coordinates, and share vertices
    let (found, scene) = of(&format!("{normals}{POINTS}{PYRAMID}"));
    assert_eq!((scene.vertices.len(), found[2][0], found[0][2]), (5, Vec3::NEG_Z, found[2][1]));
    let (found, _) = of(&format!("{normals}NormalBinding {{ value OVERALL }} {POINTS}{PYRAMID}"));
    assert!(found.iter().flatten().all(|&normal| normal == Vec3::NEG_Z));
    // One by one: 4 + 3 * 4 corners, and so 16 normals, are needed
    let (_, scene) = of(&format!("{normals}NormalBinding {{ value PER_VERTEX }} {POINTS}{PYRAMID}"));
    assert_eq!(scene.warnings, ["fewer normals than are bound: others made"]);
    faces_out(&scene, "made");
    assert_eq!(scene.vertices.len(), 4 + 4 * 3, "V2.1 makes none smooth");
    // The sides meet the base at 116.6 degrees (2.03) and each other at 78.5 (1.37)
    for (angle, vertices) in [("1.3", 16), ("1.4", 4 + 8 + 1), ("2.1", 5)] {
        let (found, scene) = of(&format!("ShapeHints {{ creaseAngle {angle} }} {POINTS}{PYRAMID}"));
        assert_eq!(scene.vertices.len(), vertices, "{angle}");
        let up = found[2][2];
        assert!((up.z > 0.9999) == (angle != "1.3"), "{angle}: {up}");
    }
    // VRML 1.0 smooths half a radian
    let bent = "Coordinate3 { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0, 1 2 .3, 0 2 .3 ] } \
        IndexedFaceSet { coordIndex [ 0 1 2 3 -1 3 2 4 5 -1 ] }";
    for (header, vertices) in [("#VRML V1.0 ascii", 6), ("#Inventor V2.0 ascii", 8), ("#Inventor V2.1 ascii", 8)] {
        let scene = Files::new(&[("main.wrl", &format!("{header}\n{bent}"))]).load("main.wrl").unwrap();
        assert_eq!(scene.vertices.len(), vertices, "{header}");
    }
}

#[test]
fn lights_and_the_first_camera_stand_where_transforms_put_them() {
    let scene = iv("Translation { translation 0 10 0 } PointLight { location 1 2 3 intensity .5 color 1 .5 0 } \
         SpotLight { location 0 0 0 } PointLight { on FALSE } \
         RotationXYZ { axis X angle -1.57079633 } DirectionalLight { intensity .25 } \
         OrthographicCamera {} PerspectiveCamera { position 0 0 5 heightAngle 1.04719755 } PerspectiveCamera {} \
         ResetTransform {} Cube {}");
    assert_eq!(scene.lights.len(), 3);
    near(scene.lights[0].position, [1., 12., 3.], "point light");
    near(scene.lights[0].colour, [0.5, 0.25, 0.], "its colour");
    near(scene.lights[1].position, [0., 10., 0.], "spot light");
    // It shines along -z, turned to -y: so it stands above, at ten diagonals
    near(scene.lights[2].position / (10.0 * 12f32.sqrt()), [0., 1., 0.], "directional light");
    near(scene.lights[2].colour, [0.25; 3], "its colour");
    let camera = scene.camera.as_ref().unwrap();
    assert!((camera.field_of_view - 60.0).abs() < 1e-3);
    near(camera.frames[0].position, [0., 15., 0.], "camera");
    near(camera.frames[0].direction, [0., -1., 0.], "looks down");
    near(camera.frames[0].up, [0., 0., -1.], "its up");
    assert_eq!(scene.warnings, ["OrthographicCamera left out", "spot light: shines to all sides"]);
    let scene = iv("PerspectiveCamera { orientation 0 1 0 1.57079633 } Cube {}");
    let camera = scene.camera.unwrap();
    assert!((camera.field_of_view - 45.0).abs() < 1e-3);
    near(camera.frames[0].position, [0., 0., 1.], "default");
    near(camera.frames[0].direction, [-1., 0., 0.], "turned left");
}

#[test]
fn unknown_nodes_are_passed_over_whole_and_named_once() {
    let scene = iv(
        "DEF x Hologram { fields [ SFFloat a, MFNode b ] isA \"Cube\" a 3 b [ Cube {} Sphere { } ] Cube { width 5 } }\n\
        Hologram {} USE x Text3 { string \"}\" } Info { string \"{\" } # }\n Cube {}",
    );
    assert_eq!(scene.triangles.len(), 12);
    assert_eq!(scene.warnings, ["unknown node `Hologram` passed over (2 times)", "Text3 left out"]);
}

#[test]
fn includes_take_over_the_state_and_keep_theirs() {
    let files = Files::new(&[
        (
            "main.iv",
            &format!(
                "{HEADER}Translation {{ translation 5 0 0 }} File {{ name \"parts/a.iv\" }} Cube {{}} DEF b Group {{}}"
            ),
        ),
        (
            "parts/a.iv",
            &format!("{HEADER}Scale {{ scaleFactor 2 2 2 }} WWWInline {{ name \"../parts/b.wrl\" }} Cube {{}}"),
        ),
        ("parts/b.wrl", "#VRML V1.0 ascii\nTranslation { translation 1 0 0 } Cube {} Cube {}"),
    ]);
    let scene = files.load("main.iv").unwrap();
    assert_eq!((scene.triangles.len(), scene.bounds().min.x, scene.bounds().max.x), (48, 3.0, 9.0));
    for (text, words) in [
        ("File { name \"main.iv\" }", "main.iv:2: include `main.iv`: the file includes itself"),
        ("\n\nFile { name \"none.iv\" }", "main.iv:4: include `none.iv`: no such file"),
        ("File { name \"../outside.iv\" }", "lies outside of the scene's folder"),
        ("File { name \"bad.iv\" }", "bad.iv:3: coordIndex: index 4 is out of range"),
        ("Group { File { name \"deep.iv\" } }", "inside each other"),
    ] {
        let deep = format!("{HEADER}{}{}", "Group {".repeat(199), "}".repeat(199));
        let files = Files::new(&[
            ("main.iv", &format!("{HEADER}{text}")),
            ("../outside.iv", HEADER),
            (
                "bad.iv",
                &format!(
                    "{HEADER}Coordinate3 {{ point [ 0 0 0, 1 0 0, 0 1 0, 1 1 0 ] }}\nIndexedFaceSet {{ coordIndex 4 }}"
                ),
            ),
            ("deep.iv", &deep),
        ]);
        let message = refusal(files.load("main.iv"));
        assert!(message.contains(words), "{text}: {message}");
    }
    let scene = iv("File { name \"http://example.org/x.iv\" } File {} Cube {}");
    assert_eq!(scene.warnings, ["includes from the network left out", "include without a file's name left out"]);
}

#[test]
fn each_fault_is_named_with_its_line() {
    // Every one doubles the last: 2^40 cubes
    let doubling: String = (1..40).map(|i| format!("DEF n{i} Group {{ USE n{} USE n{} }}\n", i - 1, i - 1)).collect();
    let chain: String = (1..400).map(|i| format!("DEF n{i} Group {{ USE n{} }}\n", i - 1)).collect();
    for (text, words) in [
        ("", "there is no triangle"),
        ("Separator {", "main.iv:2: the Separator that begins here has no `}`"),
        ("Separator {\nCube {\n", ":3: the Cube that begins here has no `}`"),
        ("Cube {} }", ":2: `}` where a node should begin"),
        ("Cube", "the file ends within a node"),
        ("Cube [", "`Cube` has no `{`"),
        ("Cube {\n5 }", ":3: `5` where a field or a node should begin"),
        ("Cube {\nSphere {} }", ":3: a Cube holds no other nodes"),
        ("Cube { width }", "width: `}` where a value should be"),
        ("Cube {\n\nwidth wide }", ":4: width: `wide` is not a number"),
        ("Cube { width 1 2 }", "width: needs 1 numbers"),
        ("Cube { width 1e999 }", "width: `1e999` is not a finite number"),
        ("Cube { width 1e99 }", "is not finite in single precision"),
        ("Cube { width 1..2 }", "`1..2` is not a finite number"),
        ("USE nothing", ":2: USE `nothing`: there is no such name"),
        ("DEF a Group { USE a }", "USE `a`: there is no such name"),
        ("\nCoordinate3 {\npoint [ 0 0 0, 1 0 ] }", ":4: point: 5 numbers are no multiple of 3"),
        ("IndexedFaceSet { coordIndex [ 0, 1, 2 ] }", "there are no coordinates"),
        ("POINTS\nIndexedFaceSet {\ncoordIndex [ 0, 1, 5 ] }", ":4: coordIndex: index 5 is out of range (give 0 to 4)"),
        ("POINTS IndexedFaceSet { coordIndex [ 0, 1, 2.5 ] }", "index 2.5 is out of range"),
        ("POINTS FaceSet { numVertices [ 3, 3 ] }", "6 coordinates are needed, but there are 5"),
        ("POINTS FaceSet { startIndex -1 }", "startIndex: -1 is negative"),
        ("POINTS QuadMesh { verticesPerColumn 1000000000 verticesPerRow 1000000000 }", "coordinates are needed"),
        (
            "POINTS MaterialBinding { value PER_FACE_INDEXED } IndexedFaceSet { coordIndex [ 0 1 2 ] materialIndex 1 }",
            "materialIndex: index 1 is out of range, there are 1 materials",
        ),
        (
            "POINTS MaterialBinding { value PER_FACE_INDEXED } IndexedFaceSet { coordIndex [ 0 1 2 -1 0 2 3 ] materialIndex 0 }",
            "materialIndex: 1 indices are too few",
        ),
        (
            "POINTS Normal { vector 0 0 1 } IndexedFaceSet { coordIndex [ 0 1 2 ] normalIndex [ 0 -1 0 ] }",
            "normalIndex: -1, number 1 of the list, is no index",
        ),
        ("MaterialBinding { value PER_MOON }", "value: `PER_MOON` is none of its values"),
        ("RotationXYZ { axis W }", "axis: `W` is none"),
        ("Units { units CUBITS }", "`CUBITS` is none"),
        ("MatrixTransform { matrix 1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1 }", "matrix: the fourth column"),
        ("Switch { whichChild .5 }", "whichChild: 0.5 is not a whole number"),
        ("PointLight { on PERHAPS }", "on: give TRUE or FALSE"),
        ("FaceSet { vertexProperty Cube {} }", "vertexProperty: the node is none"),
        ("FaceSet { vertexProperty 3 }", "vertexProperty: a node is needed"),
        ("Scale { scaleFactor 1e30 1e30 1e30 } Cube {}", "main.iv"),
        ("DOUBLING USE n39", "more than 64 MiB"),
        ("DEF n0 Group {} DOUBLINGUSE n39", "copies of copies never end"),
        ("DEF n0 Group {} CHAIN", "nodes inside each other"),
        ("Array { numElements1 1000000000 numElements2 1000000000 }", "copies of copies never end"),
        ("NESTED", "nodes inside each other"),
    ] {
        let whole = text
            .replace("DOUBLING USE", &format!("DEF n0 Cube {{}}\n{doubling} USE"))
            .replace("DOUBLING", &doubling)
            .replace("CHAIN", &chain)
            .replace("POINTS", POINTS.trim_end())
            .replace("NESTED", &"Separator {".repeat(100_000));
        let files = Files::new(&[("main.iv", &format!("{HEADER}{whole}"))]);
        let message = refusal(files.load("main.iv"));
        assert!(message.contains(words), "{text:?}: {message}");
    }
}

#[test]
fn other_languages_are_refused_with_what_to_do() {
    for (bytes, words) in [
        (&b"#Inventor V2.1 binary  \n\0\0\0"[..], "ivcat -o out.iv in.iv"),
        (b"#VRML V2.0 utf8\nShape {}", "MeshLab"),
        (b"\x1f\x8b\x08\0\0", "gunzip it first"),
        (b"Separator { Cube {} }", "the first line is `#Inventor V2.1 ascii`"),
        (b"", "no header"),
        (b"\xff\xfe#\0I\0", "no header"),
    ] {
        let files = Files::new(&[]);
        files.write("main.wrl", bytes);
        let message = refusal(files.load("main.wrl"));
        assert!(message.contains("main.wrl:1: ") && message.contains(words), "{message}");
    }
}

#[test]
fn line_ends_encodings_and_missing_last_lines_do_not_matter() {
    let text = format!("{HEADER}Info {{ string \"caf\u{e9}\" }}\nSeparator {{\n\tCube {{ }} # \u{fc}ber\n}}\n");
    let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
    for bytes in [
        text.clone().into_bytes(),
        text.replace('\n', "\r\n").into_bytes(),
        text.replace('\n', "\r").into_bytes(),
        text.trim_end().as_bytes().to_vec(),
        latin,
    ] {
        let files = Files::new(&[]);
        files.write("main.iv", &bytes);
        assert_eq!(files.load("main.iv").unwrap().triangles.len(), 12, "{}", String::from_utf8_lossy(&bytes));
    }
    let files = Files::new(&[("main.iv", &format!("{HEADER}\n\nCube {{\n").replace('\n', "\r\n"))]);
    assert!(refusal(files.load("main.iv")).contains("main.iv:4: "));
}

/// Of these, `chair` and `table` are binary and `text` has nothing but a cube behind its text.
#[test]
fn the_real_fixtures_have_the_counts_worked_out_by_hand() {
    let Some(folder) = real_scenes("the_real_fixtures_have_the_counts_worked_out_by_hand") else { return };
    let load = |name: &str| scene::load(folder.join(format!("fixtures/iv/{name}.iv")).to_str().unwrap());
    for (name, triangles, lights) in [
        ("cube", 12, 0),
        ("sphere", 2 * 24 * 11, 0),
        ("cone", 24 + 24, 0),
        ("cylinder", 48 + 24 + 24, 0),
        ("tet", 4, 0),
        ("10by10", 10 * 10 * 2, 0),
        // Three arrowheads; lines and letters are left out
        ("axis", 3 * (24 + 24), 0),
        // Six squares; two sets of six squares
        ("faceSet", 6 * 2, 0),
        ("indexedFaceSet", 2 * 6 * 2, 0),
        // Three strips of eight corners, the second time as lines; four squares by four
        ("indexedTriangleMesh", 3 * 6, 0),
        ("triangleStripSet", 3 * 6, 0),
        ("quadMesh", 4 * 4 * 2, 0),
        // Strips of 14, 11, 11, 9, 10, 5 and 4 corners
        ("star", 12 + 9 + 9 + 7 + 8 + 3 + 2, 0),
        // Strips of 6, 6, 6, 5, 4 and 3 corners
        ("tri", 4 + 4 + 4 + 3 + 2 + 1, 0),
        ("text", 12, 0),
        ("text3", 12, 0),
        // Cube, cylinder, cone, a square, sphere
        ("texture", 12 + 96 + 48 + 2 + 528, 0),
        // Twelve pentagons; the two other models are drawn as lines
        ("three", 12 * 3, 0),
    ] {
        let scene = load(name).unwrap();
        assert_eq!((scene.triangles.len(), scene.lights.len()), (triangles, lights), "{name}");
    }
    for name in ["chair", "table"] {
        assert!(refusal(load(name)).contains("ivcat"), "{name}");
    }
}
