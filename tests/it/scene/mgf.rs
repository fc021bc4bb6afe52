//! Tests of MGF: each entity, all errors, and the real scenes, compared with the counts of the reference
//! implementation.

use super::{Files, real_scenes, refusal};
use glam::Vec3;
use rtbench::scene::{self, Scene};

fn mgf(text: &str) -> Scene {
    Files::new(&[("main.mgf", text)]).load("main.mgf").unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// Vertices of a square in the plane z = 0, and further vertices.
const POINTS: &str = "v a =\np 0 0 0\nv b =\np 1 0 0\nv c =\np 1 1 0\nv d =\np 0 1 0\nv up =\np 0 0 2\nn 0 0 1\n\
    v e =\np .2 .3 0\nv f =\np .3 .6 0\nv g =\np .6 .5 0\n";

#[test]
fn every_shape_gives_the_triangles_of_the_reference_implementation() {
    for (text, triangles, vertices) in [
        ("f a b c", 1, 3),
        ("f a b c d", 2, 4),
        ("f a b \\\n  c d", 2, 4),
        ("f a b\\\nc d", 2, 4),
        ("f a b \\\r\n\\\r\n\\\r\nc d\r\n", 2, 4),
        ("f\\\n a b c \\\n\nf b d c", 2, 6),
        ("# a comment \\\nf this is still the comment\nf a b c", 1, 3),
        ("f a b c \\", 1, 3),
        ("v x\\y =\np 0\\\n 5\\\n\\\n 0\nf a b x\\y", 1, 3),
        ("xf -a 0\n# xf \\\nxf\nsph a 1\nxf\nf a b c", 1, 3),
        ("fh a b c d - e f g", 7, 7),
        ("sph a 1", 20 * 9 * 2, 20 * 9 + 2),
        ("cyl a .5 up", 40, 40),
        ("cone a .5 up 0", 20, 40),
        ("cone a -.5 up -.25", 40, 40),
        ("ring up 0 1", 20, 21),
        ("ring up .5 1", 40, 40),
        ("torus up .5 1", 800, 400),
        ("torus up -.5 -1", 800, 400),
        ("prism a b c d 1", 12, 24),
        ("prism a b c d -1", 12, 24),
        ("o thing\nf a b c\no\nf a c d", 2, 6),
        ("xf -a 3 -t 5 0 0\nf a b c\nxf", 3, 9),
        ("xf -t 5 0 0\nxf -t 3 0 0 -a 2 -rz 90 -a 3 -t 0 0 1\n# xf\nf a b c\nxf\nxf\nf a b c", 7, 21),
        ("xf -a 0\nxf -s 2\nsph a 1\nxf\nxf\nf a b c", 1, 3),
    ] {
        let scene = mgf(&format!("{POINTS}{text}"));
        assert_eq!((scene.triangles.len(), scene.vertices.len()), (triangles, vertices), "{text}");
        for triangle in 0..scene.triangles.len() {
            let [a, b, c] = scene.corners(triangle as u32);
            let turn = Vec3::from((b - a).cross(c - a));
            for index in scene.triangles[triangle].vertices {
                let normal = scene.vertices[index as usize].normal;
                assert!(normal.dot(turn) > 0.0 && normal.is_normalized(), "{text}: {normal}, {turn}");
            }
        }
    }
    let files = Files::new(&[("main.mgf", &format!("{POINTS}sph a 1"))]);
    assert_eq!(files.load("main.mgf:segments=8").unwrap().triangles.len(), 8 * 3 * 2);
}

#[test]
fn contexts_are_selected_copied_and_changed_by_name() {
    let scene = mgf("v a =\np 0 0 0\nv b = a\np 1 0 0\nv c = b\n\tp 1 1 0\nv b\n p 2 0 0\n\
        v c = c\nn 0 0 -5\nv\np 9 9 9\nm red =\n c r =\n cxy .64 .33\n rd .1\nm blue = red\nc\nrs .5 .01\nm\nm red\nf a b c\nm blue\nf a b c");
    assert_eq!(scene.bounds().max, Vec3::new(2.0, 1.0, 0.0), "b was changed, the unnamed vertex has no face");
    let c = scene.vertices.iter().find(|v| v.position == Vec3::new(1.0, 1.0, 0.0)).unwrap();
    assert_eq!(c.normal, Vec3::NEG_Z);
    let [red, blue] = scene.materials[..] else { panic!("{:?}", scene.materials) };
    assert!(red.diffuse.x > 4.0 * red.diffuse.y && red.reflectivity == 0.0, "{red:?}");
    assert_eq!((blue.diffuse, blue.reflectivity), (red.diffuse, 0.5));
    assert!((blue.specular - Vec3::splat(0.5)).abs().max_element() < 1e-3, "{blue:?}");
    // A rough surface has a highlight, but is not a mirror.
    let rough = mgf(&format!("{POINTS}m x =\nrs .5 .2\nf a b c")).materials[0];
    assert!(rough.reflectivity == 0.0 && (rough.exponent - 48.0).abs() < 1e-3, "{rough:?}");
}

#[test]
fn colours_are_given_by_coordinates_spectra_temperatures_and_mixtures() {
    for (colour, share) in [
        ("cxy .3333 .3333", [1.0, 1.0, 1.0]),
        ("cspec 380 780 1 1", [1.0, 1.0, 1.0]),
        ("cmix 1 r 1 r", [4.7, 0.0, 0.0]),
        ("cct 2700", [1.67, 0.88, 0.22]),
    ] {
        let scene = mgf(&format!("{POINTS}c r =\ncxy .64 .33\nc x =\n{colour}\nm y =\nc x\nrd .1\nf a b c"));
        let found = scene.materials[0].diffuse.to_array();
        for (found, share) in found.iter().zip(share) {
            assert!((found / 0.1 - share).abs() < 0.45, "{colour}: {:?}", scene.materials[0].diffuse);
        }
    }
}

#[test]
fn includes_are_transformed_and_share_the_names() {
    let files = Files::new(&[
        ("main.mgf", &format!("{POINTS}xf -t 0 0 5\ni parts/face.mgf -a 2 -t 3 0 0\nxf\nf made b c")),
        ("parts/face.mgf", "i ../parts/new.mgf\nf a b c\nies lamp.ies -m 2"),
        ("parts/new.mgf", "v made =\np 0 0 1"),
    ]);
    let scene = files.load("main.mgf").unwrap();
    assert_eq!((scene.triangles.len(), scene.bounds().max), (3, Vec3::new(4.0, 1.0, 5.0)));
    assert_eq!(scene.warnings, ["`ies`: luminaire data ignored (2 times)"]);
}

#[test]
fn emissive_surfaces_become_a_few_point_lights() {
    let panel = format!("{POINTS}m lamp =\ned 100\nf a b c d\nm x =\nrd .5\nf a d c b\n");
    let scene = mgf(&panel);
    assert_eq!(scene.lights.len(), 1);
    let light = scene.lights[0];
    assert!((light.position.truncate() - Vec3::splat(0.5).truncate()).length() < 1e-6);
    assert!(light.position.z > 0.0 && light.position.z < 0.01, "just in front: {}", light.position);
    assert!((light.colour - Vec3::ONE).abs().max_element() < 1e-3);
    // Twelve panels, one of which is twice as bright, and a bulb, which has its light outside
    let many = format!("{panel}m lamp\nxf -a 11 -t 5 0 0\nf a b c d\nxf\nm bulb =\ned 9\nsph up .5\n");
    let scene = mgf(&many);
    assert_eq!(scene.lights.len(), 8);
    let total: Vec3 = scene.lights.iter().map(|light| light.colour).sum();
    assert!((total - Vec3::ONE).abs().max_element() < 1e-3, "{total}");
    assert!(scene.lights.iter().all(|light| light.position.distance(Vec3::Z * 2.0) > 0.45));
    assert_eq!(scene.warnings, ["13 emissive surfaces merged into 8 point lights"]);
}

#[test]
fn each_error_has_its_line() {
    for (text, words) in [
        ("", &["there is no triangle"][..]),
        ("f a b nowhere", &["main.mgf:18: f: `nowhere` is not defined"]),
        ("f a b", &["there is no triangle"]),
        ("v x = nowhere", &[":18: v: `nowhere` is not defined"]),
        ("v x y", &[":18: v: the arguments do not select a context"]),
        ("p 1 2", &[":18: p: there are 2 arguments, but 3 numbers are needed"]),
        ("p 1 2 z", &["`z` is not a finite number"]),
        ("v x =\np 1 2 1e999\nf a b x", &["there is no triangle: 1 faces with vertices that are not finite"]),
        ("v x =\np 1e99 0 0\nf a b x", &[":20: f: a corner at"]),
        ("cxy .9 .9", &["the colour is not valid"]),
        ("cspec 400 700", &["the colour is not valid"]),
        ("cmix 1", &["a weight without a colour"]),
        ("cct -5", &["the colour is not valid"]),
        ("rd -1", &["the amount of light or the roughness is negative"]),
        ("rs .5", &["there are 1 arguments, but 2 numbers"]),
        ("sph a", &["sph: 1 arguments are the wrong number"]),
        ("sph a 1e99", &["not finite in single precision"]),
        ("ring up 2 1", &["0 <= inner < outer"]),
        ("torus up 2 1", &[":18: torus: the radii are not 0 <= inner < outer", "both are negative"]),
        ("torus up 1 1", &["0 <= inner < outer"]),
        ("torus up -1 2", &["0 <= inner < outer"]),
        ("torus up -2 -1", &["0 <= inner < outer"]),
        ("torus up .5 -1", &["0 <= inner < outer"]),
        ("F a b c\nf a b", &["there is no triangle: unknown entity `F` ignored, polygon with fewer"]),
        ("f a \\\nb \\\n\\\nc\n# more \\\nof it\nf a b nowhere", &[":24: f: `nowhere`"]),
        ("p 1 \\\n2", &[":18: p: there are 2 arguments"]),
        ("cone a 1 up -1", &["one radius is positive"]),
        ("xf -t 1 0", &[":18: `-t` needs more numbers"]),
        ("xf -q", &["`-q` is not a part of a transform"]),
        ("xf -a 1e9", &["not a number of copies"]),
        ("xf -t 1 0 0\nf a b c", &[":18: the transform that begins here has no closing `xf`"]),
        ("xf", &[":18: `xf` closes no transform"]),
        ("i main.mgf", &[":18: include `main.mgf`: the file includes itself"]),
        ("i nowhere.mgf", &[":18: include `nowhere.mgf`: no such file"]),
        ("i ../outside.mgf", &["lies outside of the scene's folder"]),
        ("i", &["`i` has no file name"]),
        (&"xf -s 1\n".repeat(200), &["nested more than"]),
        (&format!("{}sph a 1\n{}", "xf -a 1000 -t 1 0 0\n".repeat(4), "xf\n".repeat(4)), &["more than 64 MiB"]),
        (
            &format!("{}{}", "xf -a 1000 -t 1 0 0\n".repeat(4), "xf\n".repeat(4)),
            &["nested arrays repeat too many entities"],
        ),
    ] {
        let files = Files::new(&[("main.mgf", &format!("{POINTS}{text}")), ("../outside.mgf", "f a b c")]);
        let message = refusal(files.load("main.mgf:memory=64M"));
        for word in words {
            assert!(message.contains(word), "{text:?}: {message}");
        }
    }
    let scene = mgf(&format!("{POINTS}hologram 1 2 3\nf a b c"));
    assert_eq!(scene.warnings, ["unknown entity `hologram` ignored"]);
}

/// The expected counts are those of the reference implementation, without the triangles without area that it creates at
/// the tips of cones and at the centres of disks: 20 at one disk in graz, 20 at each of 52 cones and 44 disks in soda.
#[test]
fn the_real_scenes_have_the_counts_of_the_reference_implementation() {
    let Some(folder) = real_scenes("the_real_scenes_have_the_counts_of_the_library") else { return };
    for (file, triangles, lights) in [
        ("classroom", 9_253, 8),
        ("graz", 27_089 - 20, 4),
        ("soda", 143_556 - 20 * (52 + 44), 5),
        ("corridor", 1_376, 8),
        ("cube", 67, 1),
        ("examp1", 500, 2),
    ] {
        let scene = scene::load(folder.join(format!("mgf/{file}.mgf")).to_str().unwrap()).unwrap();
        assert_eq!((scene.triangles.len(), scene.lights.len()), (triangles, lights), "{file}");
    }
}
