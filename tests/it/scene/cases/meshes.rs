//! Variations of MGF, NFF and BART's files.

use super::{Files, TRIANGLE, is_box, load, warns};
use crate::scene::refusal;
use glam::Vec3;
use rtbench::scene::Scene;

const POINTS: &str = "v a =\np 0 0 0\nv b =\np 2 0 0\nv d =\np 0 3 0\n";

fn mgf(text: &str) -> Scene {
    load("a.mgf", text.as_bytes())
}

fn nff(text: &str) -> Scene {
    load("a.nff", text.as_bytes())
}

#[test]
fn colours_with_zero_chromaticities_are_colours() {
    for (x, y) in [("0", "0"), ("0.000000", "0.000000"), ("0", "1"), ("1", "0"), ("0", ".5")] {
        let scene = mgf(&format!("{POINTS}c blue =\ncxy {x} {y}\nm paint =\nc blue\nrd 0.5\nf a b d\n"));
        is_box(x, &scene, 1, TRIANGLE);
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
        let diffuse = scene.materials[0].diffuse;
        assert!(diffuse.is_finite() && diffuse.max_element() > 0.2, "{x} {y}: {diffuse}");
        let mixed = mgf(&format!("{POINTS}c z =\ncxy {x} {y}\nc w =\ncmix 1 z 1 z\nm p =\nc w\nrd 0.5\nf a b d\n"));
        assert!(mixed.materials[0].diffuse.is_finite());
    }
}

#[test]
fn materials_colours_and_normals_with_errors_have_their_defaults() {
    for (line, warning) in [
        ("cxy .9 .9", "a.mgf:8: cxy: the colour is not valid"),
        ("cxy nan 0", "cxy: `nan` is not a finite number"),
        ("cxy 0.3", "cxy: there are 1 arguments, but 2 numbers"),
        ("cxy -1.#IND -1.#IND", "cxy: `-1.#IND` is not a finite number"),
        ("cspec 400 700", "cspec: the colour is not valid"),
        ("cspec 400 700 0 0 0", "cspec: the colour is not valid"),
        ("cspec 400 700 a b", "cspec: `a` is not a finite number"),
        ("cct -5", "cct: the colour is not valid"),
        ("cct hot", "cct: `hot` is not a finite number"),
        ("cmix 1", "cmix: a weight without a colour"),
        ("cmix 1 nowhere", "cmix: `nowhere` is not defined"),
        ("rd -1", "a.mgf:8: rd: the amount of light or the roughness is negative"),
        ("rd nan", "rd: `nan` is not a finite number"),
        ("rd", "rd: there are 0 arguments"),
        ("rs .5", "rs: there are 1 arguments, but 2 numbers"),
        ("rs 1.#QNAN .1", "rs: `1.#QNAN` is not a finite number"),
        ("ed bright", "ed: `bright` is not a finite number"),
        ("td -nan(ind)", "td: "),
        ("c nowhere", "c: `nowhere` is not defined"),
        ("c x = nowhere", "c: `nowhere` is not defined"),
        ("m nowhere", "m: `nowhere` is not defined"),
        ("n 0 0", "n: there are 2 arguments, but 3 numbers"),
        ("n nan nan nan", "n: `nan` is not a finite number"),
        ("n -1.#IND 0 0", "n: `-1.#IND` is not a finite number"),
        ("n up", "n: there are 1 arguments"),
    ] {
        let scene = mgf(&format!("{POINTS}m paint =\n{line}\nf a b d\n"));
        is_box(line, &scene, 1, TRIANGLE);
        warns(line, &scene, warning);
        warns(line, &scene, ": the default is used");
        assert!(scene.vertices.iter().all(|v| v.normal == Vec3::Z), "{line}");
    }
    let grey = mgf(&format!("{POINTS}m nowhere\nf a b d\n")).materials[0].diffuse;
    assert!(grey.abs_diff_eq(Vec3::splat(0.5), 1e-2), "{grey}");
    // Geometry is still refused.
    for line in ["p 1 2", "f a b nowhere", "v x = nowhere", "p 1 2 z", "xf -t 0 0 nan\nf a b d\nxf"] {
        refusal(Files::new(&[("a.mgf", &format!("{POINTS}{line}\nf a b d\n"))]).load("a.mgf"));
    }
}

#[test]
fn surfaces_with_numbers_that_are_not_finite_are_dropped_and_counted() {
    for x in ["nan", "-nan(ind)", "-1.#IND", "1.#QNAN", "inf", "1.#INF", "1e999"] {
        let mgf_bad = format!("{POINTS}v n =\np {x} 0 0\n");
        for shape in ["f a b n", "f a n b d", "fh a b d - n b d", "sph n 1", "cyl a 1 n", "prism a b n 1"] {
            let scene = mgf(&format!("{mgf_bad}f a b d\n{shape}\n"));
            is_box(shape, &scene, 1, TRIANGLE);
            warns(shape, &scene, "1 faces with vertices that are not finite are dropped (first: a.mgf:10)");
        }
        for shape in [format!("sph a {x}"), format!("cyl a {x} b"), format!("prism a b d {x}")] {
            is_box(&shape, &mgf(&format!("{POINTS}f a b d\n{shape}\n")), 1, TRIANGLE);
        }
        is_box("unused", &mgf(&format!("{mgf_bad}f a b d\n")), 1, TRIANGLE);
        let triangle = "p 3 0 0 0 2 0 0 0 3 0\n";
        for shape in [
            format!("p 3 0 0 0 {x} 0 0 0 3 0"),
            format!("pp 3 0 0 {x} 0 0 1 2 0 0 0 0 1 0 3 0 0 0 1"),
            format!("s 0 {x} 0 1"),
            format!("s 0 0 0 {x}"),
            format!("c 0 0 0 1 0 0 {x} 1"),
            format!("tt t.jpg 0 0 {x} 0 0 1 0 0 1 1 0 1 0 0 1"),
            format!("m vertices 3 0 0 0 {x} 0 0 0 3 0 triangles 1 0 1 2"),
            format!("tpa 1 0 0 0 {x} 0 0 1 2 0 0 0 0 1 0 3 0 0 0 1"),
        ] {
            let scene = nff(&format!("{triangle}{shape}\n"));
            is_box(&shape, &scene, 1, TRIANGLE);
            warns(&shape, &scene, "1 faces with vertices that are not finite are dropped (first: a.nff:2)");
        }
        let unused = format!("m vertices 4 0 0 0 2 0 0 0 3 0 {x} 0 0 triangles 1 0 1 2");
        assert!(nff(&unused).warnings.is_empty());
        let message =
            refusal(Files::new(&[("a.nff", &format!("xs 1 1 {x} 0 0 1 0 0 0 0 {{ {triangle} }}"))]).load("a.nff"));
        assert!(message.contains("is not a finite number"), "{x}: {message}");
    }
}

#[test]
fn normals_and_texture_coordinates_of_bart_cost_only_themselves() {
    for x in ["nan", "-nan(ind)", "-1.#IND", "1.#QNAN", "inf"] {
        for shape in [
            format!("pp 3 0 0 0 {x} 0 1 2 0 0 0 0 1 0 3 0 0 0 1"),
            format!("ttp t.jpg 0 0 0 0 0 {x} 0 0 2 0 0 0 0 1 1 0 0 3 0 0 0 1 0 1"),
            format!("tt t.jpg 0 0 0 {x} {x} 2 0 0 1 0 0 3 0 0 1"),
            format!("m vertices 3 0 0 0 2 0 0 0 3 0 normals 1 {x} 0 1 triangles 1 0 1 2 0 0 0"),
            "m vertices 3 0 0 0 2 0 0 0 3 0 normals 1 0 0 1 triangles 1 0 1 2 0 0 9".to_owned(),
            "m vertices 3 0 0 0 2 0 0 0 3 0 normals 1 0 0 1 triangles 1 0 1 2 0 -1 0".to_owned(),
            format!("m vertices 3 0 0 0 2 0 0 0 3 0 texturecoords 1 t {x} 0 triangles 1 0 1 2 0 7 {x}"),
        ] {
            let scene = load("a.aff", shape.as_bytes());
            is_box(&shape, &scene, 1, TRIANGLE);
            assert!(!scene.warnings.is_empty(), "{shape}");
        }
    }
}

#[test]
fn fills_lights_and_views_with_errors_have_their_defaults() {
    let triangle = "p 3 0 0 0 2 0 0 0 3 0\n";
    for (line, warning) in [
        ("f 1 0 0", "a.nff:1: f: 3 numbers instead of 8"),
        ("f", "a.nff:1: f: 0 numbers instead of 8"),
        ("f 1 0", "a.nff:1: f: 2 numbers instead of 8"),
        ("f 1 0 0 .5", "a.nff:1: f: 4 numbers instead of 8"),
        ("f 1 0 0 .8 .2 20 0", "f: 7 numbers instead of 8"),
        ("f nan 0 0 .8 .2 20 0 1", "f: a number is not finite"),
        ("f -1.#IND -1.#IND -1.#IND .8 .2 20 0 1", "f: a number is not finite"),
        ("f 1 0 0 .8 .2 1.#QNAN 0 1", "f: a number is not finite"),
        ("fm 1 0 0 1 nan 0 1 0 0 10 0 1", "fm: the colour is not finite"),
        ("fm 1 0 0 1 0 0 1 0 0 inf 0 1", "fm: a number is not finite"),
        ("b nan 0 0", "b: the colour is not finite"),
        ("am 1 1 -nan(ind)", "am: the colour is not finite"),
        ("l nan 0 0", "l: the light's position is not finite"),
        ("l 1 1 1 nan 0 0", "l: the colour is not finite"),
        ("l foo 0 0", "a.nff:1: l: 0 numbers instead of 3: the light is ignored"),
        ("l 1 2", "a.nff:1: l: 2 numbers instead of 3"),
        ("l 1 2 3 0.5", "a.nff:1: l: a colour of 1 numbers instead of 3"),
        ("l 0 0 1e39", "a.nff:1: l: a light at [0, 0, inf]"),
        ("l 0 0 5 1e39 1 1", "a.nff:1: l: a light at [0, 0, 5] of colour [inf, 1, 1] is not finite"),
        ("l 1e999 0 0", "the light is ignored"),
        ("b foo 0 0", "a.nff:1: b: 0 numbers instead of 3"),
        ("b 1", "a.nff:1: b: 1 numbers instead of 3"),
        ("b 1e39 0 0", "b: the colour is not finite"),
        ("b 1 0 0 7", "a.nff:1: b: `7` and what follows in the line is ignored"),
        ("f red", "a.nff:1: f: 0 numbers instead of 8"),
        ("f 1 0 0 1 0 1 0 1 .5", "a.nff:1: f: `.5` and what follows in the line is ignored"),
        ("f 1 0 0 1 0 1 0 1 tex", "texture ignored"),
        ("fm 1 1 1", "a.nff:1: fm: 3 numbers instead of 12"),
        ("fm red", "a.nff:1: fm: 0 numbers instead of 12"),
        ("am", "am: 0 numbers instead of 3"),
        ("v\nfrom foo 0 0\nat 0 0 0", "a.nff:2: v: from: it is not 3 numbers: the viewpoint is ignored"),
        ("v\nfrom 0 0 5\nresolution nan x", "a.nff:3: v: resolution: it is not 2 numbers"),
        ("v\nfrom 0 0 5\nangle 0", "a.nff:3: v: the field of view of 0 degrees is not between 0 and 180"),
        ("v\nfrom 0 0 5\nangle 180", "the field of view of 180 degrees"),
        ("v\nfrom 0 0 5\nangle 200", "the field of view of 200 degrees"),
        ("v\nfrom 0 0 5 6\nangle 40", "a.nff:2: v: from: it is not 3 numbers"),
        ("v\nfrom 1 1 5\nat 1 1 5", "a.nff:1: v: the viewpoint has no direction"),
        ("v from nan 0 5 at 0 0 0 up 0 1 0 angle 40 hither 1 resolution 64 64", "v: the viewpoint is not finite"),
        ("v from 0 0 5 at 0 0 0 up 0 1 0 angle -1.#IND hither 1 resolution 64 64", "v: the viewpoint is not finite"),
    ] {
        let scene = nff(&format!("{line}\n{triangle}"));
        is_box(line, &scene, 1, TRIANGLE);
        warns(line, &scene, warning);
        assert!(scene.warnings.len() == 1 && scene.camera.is_none(), "{line}: {:?}", scene.warnings);
    }
    let red = nff(&format!("f 1 0 0\n{triangle}"));
    assert_eq!(red.materials[red.triangles[0].material as usize].diffuse, Vec3::X);
    let text = "pp 3\n0 0 0 foo bar baz\n2 0 0 0 0 1\n0 3 0 0 0 1\n";
    let scene = nff(text);
    is_box(text, &scene, 1, TRIANGLE);
    warns(text, &scene, "a normal is not three finite numbers");
    assert!(scene.vertices.iter().all(|vertex| vertex.normal == Vec3::Z), "{:?}", scene.vertices);
    // Several entities in a line
    let scene = nff("l foo b 1 p 3 0 0 0 2 0 0 0 3 0 f 1 s 0 0 0 1\n");
    assert!(scene.triangles.len() > 1 && scene.warnings.len() == 3, "{:?}", scene.warnings);
    // Over several lines, and with a texture
    for line in ["f 1 0 0\n.8 .2\n20 0 1", "f 1 0 0 .8 .2 20 0 1 wood.jpg", "v hither nan from 0 0 5 at 0 0 0 angle 40"]
    {
        let scene = nff(&format!("{line}\n{triangle}"));
        assert!(scene.warnings.iter().all(|w| w.contains("texture")), "{line}: {:?}", scene.warnings);
    }
}
