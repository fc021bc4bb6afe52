//! Tests of Open Inventor and VRML 1.0: each node, and the real fixtures with counts determined by hand.

use super::{Files, real_scenes, refusal};
use glam::Vec3;
use rtbench::scene::{self, Material, Scene};

pub(super) const HEADER: &str = "#Inventor V2.1 ascii\n";

pub(super) fn iv(text: &str) -> Scene {
    let files = Files::new(&[("main.iv", &format!("{HEADER}{text}"))]);
    files.load("main.iv").unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// The positions of a triangle's corners.
pub(super) fn corners(scene: &Scene, triangle: usize) -> [Vec3; 3] {
    scene.triangles[triangle].vertices.map(|v| scene.vertices[v as usize].position)
}

pub(super) fn near(found: Vec3, expected: [f32; 3], label: &str) {
    assert!((found - Vec3::from(expected)).abs().max_element() < 1e-4, "{label}: {found}, not {expected:?}");
}

/// The material of every triangle.
pub(super) fn materials(scene: &Scene) -> Vec<Material> {
    scene.triangles.iter().map(|triangle| scene.materials[triangle.material as usize]).collect()
}

/// A letter for the diffuse colour of each triangle: r, g, b or w(hite); `?` for other colours.
pub(super) fn colours(scene: &Scene) -> String {
    let letter = |m: &Material| match m.diffuse.to_array() {
        [1.0, 0.0, 0.0] => 'r',
        [0.0, 1.0, 0.0] => 'g',
        [0.0, 0.0, 1.0] => 'b',
        [1.0, 1.0, 1.0] => 'w',
        _ => '?',
    };
    materials(scene).iter().map(letter).collect()
}

/// Asserts that the normals of all triangles are on the side from which the triangle is counter-clockwise.
pub(super) fn faces_out(scene: &Scene, label: &str) {
    for t in &scene.triangles {
        let [a, b, c] = t.vertices.map(|v| scene.vertices[v as usize]);
        let turn = (b.position - a.position).cross(c.position - a.position);
        for vertex in [a, b, c] {
            assert!(vertex.normal.is_normalized() && vertex.normal.dot(turn) > 0.0, "{label}: {vertex:?} {turn}");
        }
    }
}

/// Coordinates of a square in the plane z = 0 and a point above its centre, and faces of them.
pub(super) const POINTS: &str = "Coordinate3 { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0, .5 .5 1 ] }\n";
pub(super) const PYRAMID: &str =
    "IndexedFaceSet { coordIndex [ 3, 2, 1, 0, -1, 0, 1, 4, -1, 1, 2, 4, -1, 2, 3, 4, -1, 3, 0, 4, -1 ] }";

#[test]
fn solids_have_their_default_sizes_and_face_outwards() {
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
fn the_innermost_transform_is_applied_first_and_matrices_are_by_rows() {
    let triangle = "FaceSet { vertexProperty VertexProperty { vertex [ 0 0 0, 1 0 0, 0 1 0 ] } }";
    for (text, expected) in [
        (
            "Translation { translation 1 0 0 } RotationXYZ { axis Z angle 1.57079633 } Scale { scaleFactor 2 1 1 }",
            [[1., 0., 0.], [1., 2., 0.], [0., 0., 0.]],
        ),
        ("Rotation { rotation 0 2 0 1.57079633 }", [[0., 0., 0.], [0., 0., -1.], [0., 1., 0.]]),
        ("Rotation { rotation 0 0 0 2 }", [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]]),
        // Around the centre (1, 0, 0): scaling by two along y, because its axes are rotated, then a quarter turn
        (
            "Transform { translation 10 0 0 rotation 0 0 1 1.57079633 scaleFactor 2 1 1 \
             scaleOrientation 0 0 1 1.57079633 center 1 0 0 }",
            [[11., -1., 0.], [11., 0., 0.], [9., -1., 0.]],
        ),
        // As in the reference implementation
        (
            "Transform { translation 10 0 0 rotation 0 0 1 1.57079633 scaleFactor 2 1 1 scaleOrientation 0 0 1 .5 center 1 0 0 }",
            [[11.4207, -1.77015, 0.], [11., 0., 0.], [10.1909, -1.34942, 0.]],
        ),
        ("MatrixTransform { matrix 0 1 0 0 -1 0 0 0 0 0 1 0 5 6 7 1 }", [[5., 6., 7.], [5., 7., 7.], [4., 6., 7.]]),
        ("Units { units CENTIMETERS }", [[0., 0., 0.], [0.01, 0., 0.], [0., 0.01, 0.]]),
        ("Units { units FEET } Units { units METERS }", [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]]),
        ("Scale { scaleFactor 7 7 7 } ResetTransform {}", [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]]),
        // An ignored field, and a connected field
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
fn separators_restore_the_state_and_groups_do_not() {
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
fn switches_levels_and_copies_select_their_children() {
    let solids = "Cube {} Sphere {} Cone {}";
    for (text, triangles) in [
        ("Switch { whichChild 0 SOLIDS } Cube {}".to_owned(), 24),
        ("Switch { whichChild 1 SOLIDS }".to_owned(), 528),
        ("Switch { SOLIDS } Cube {}".to_owned(), 12),
        ("Switch { whichChild -1 SOLIDS } Cube {}".to_owned(), 12),
        ("Switch { whichChild -3 SOLIDS }".to_owned(), 12 + 528 + 48),
        // The inner switch inherits the index of the outer one, modulo its number of children.
        ("Switch { whichChild 2 Cube {} Cube {} Switch { whichChild -2 SOLIDS } }".to_owned(), 48),
        ("Switch { whichChild 2 Cube {} Cube {} Switch { whichChild -2 Sphere {} Cube {} } }".to_owned(), 528),
        ("Switch { whichChild 7 SOLIDS } Cube {}".to_owned(), 12),
        ("LOD { range [ 5, 9 ] SOLIDS }".to_owned(), 12),
        ("LevelOfDetail { SOLIDS }".to_owned(), 12),
        ("LevelOfDetail {} Cube {}".to_owned(), 12),
        ("Blinker { whichChild 1 SOLIDS }".to_owned(), 528),
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
fn lights_and_the_first_camera_are_transformed() {
    let scene = iv("Translation { translation 0 10 0 } PointLight { location 1 2 3 intensity .5 color 1 .5 0 } \
         SpotLight { location 0 0 0 } PointLight { on FALSE } \
         RotationXYZ { axis X angle -1.57079633 } DirectionalLight { intensity .25 } \
         OrthographicCamera {} PerspectiveCamera { position 0 0 5 heightAngle 1.04719755 } PerspectiveCamera {} \
         ResetTransform {} Cube {}");
    assert_eq!(scene.lights.len(), 3);
    near(scene.lights[0].position, [1., 12., 3.], "point light");
    near(scene.lights[0].colour, [0.5, 0.25, 0.], "its colour");
    near(scene.lights[1].position, [0., 10., 0.], "spot light");
    // The light shines along -z, rotated to -y; it is therefore placed above, at ten diagonals.
    near(scene.lights[2].position / (10.0 * 12f32.sqrt()), [0., 1., 0.], "directional light");
    near(scene.lights[2].colour, [0.25; 3], "its colour");
    let camera = scene.camera.as_ref().unwrap();
    assert!((camera.field_of_view - 60.0).abs() < 1e-3);
    near(camera.frames[0].position, [0., 15., 0.], "camera");
    near(camera.frames[0].direction, [0., -1., 0.], "looks down");
    near(camera.frames[0].up, [0., 0., -1.], "its up");
    assert_eq!(scene.warnings, ["OrthographicCamera ignored", "spot light: shines in all directions"]);
    let scene = iv("PerspectiveCamera { orientation 0 1 0 1.57079633 } Cube {}");
    let camera = scene.camera.unwrap();
    assert!((camera.field_of_view - 45.0).abs() < 1e-3);
    near(camera.frames[0].position, [0., 0., 1.], "default");
    near(camera.frames[0].direction, [-1., 0., 0.], "turned left");
}

#[test]
fn unknown_nodes_are_ignored_with_their_children_and_reported_once() {
    let scene = iv(
        "DEF x Hologram { fields [ SFFloat a, MFNode b ] isA \"Cube\" a 3 b [ Cube {} Sphere { } ] Cube { width 5 } }\n\
        Hologram {} USE x Text3 { string \"}\" } Info { string \"{\" } # }\n Cube {}",
    );
    assert_eq!(scene.triangles.len(), 12);
    assert_eq!(scene.warnings, ["unknown node `Hologram` ignored (2 times)", "Text3 ignored"]);
}

#[test]
fn includes_inherit_the_state_and_do_not_change_it() {
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
        ("Group { File { name \"deep.iv\" } }", "nested more than"),
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
    assert_eq!(scene.warnings, ["includes from the network ignored", "include without a file name ignored"]);
}

/// The fixtures `chair` and `table` are binary, and `text` has only a cube after its text.
#[test]
fn the_real_fixtures_have_the_counts_determined_by_hand() {
    let Some(folder) = real_scenes("the_real_fixtures_have_the_counts_worked_out_by_hand") else { return };
    let load = |name: &str| scene::load(folder.join(format!("fixtures/iv/{name}.iv")).to_str().unwrap());
    for (name, triangles, lights) in [
        ("cube", 12, 0),
        ("sphere", 2 * 24 * 11, 0),
        ("cone", 24 + 24, 0),
        ("cylinder", 48 + 24 + 24, 0),
        ("tet", 4, 0),
        ("10by10", 10 * 10 * 2, 0),
        // Three arrowheads; lines and letters are ignored.
        ("axis", 3 * (24 + 24), 0),
        // Six squares, and two sets of six squares
        ("faceSet", 6 * 2, 0),
        ("indexedFaceSet", 2 * 6 * 2, 0),
        // Three strips of eight corners, which are repeated as lines, and four by four squares
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
        // Twelve pentagons; the two other models are drawn as lines.
        ("three", 12 * 3, 0),
    ] {
        let scene = load(name).unwrap();
        assert_eq!((scene.triangles.len(), scene.lights.len()), (triangles, lights), "{name}");
    }
    for name in ["chair", "table"] {
        assert!(refusal(load(name)).contains("ivcat"), "{name}");
    }
}
