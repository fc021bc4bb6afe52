//! Tests of OBJ and MTL: all supported statements, all errors, and the real files.

use super::{real_scenes, refusal};
use crate::support::short;
use glam::Vec3;
use proptest::prelude::*;
use rtbench::Result;
use rtbench::scene::{self, Options, Scene, lamps, obj};
use std::path::Path;

/// A unit square in the plane z = 0.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// Loads OBJ and MTL texts from a temporary folder.
fn load_with(files: &[(&str, &[u8])], settings: &str) -> Result<Scene> {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    scene::load(&format!("{}{settings}", folder.path().join("a.obj").display()))
}

fn load(text: &str) -> Scene {
    load_with(&[("a.obj", text.as_bytes())], "").unwrap_or_else(|e| panic!("{e}"))
}

fn corners(scene: &Scene) -> Vec<[u32; 3]> {
    scene.triangles.iter().map(|t| t.vertices).collect()
}

#[test]
fn faces_in_all_notations_are_read() {
    let square = load(&format!("{SQUARE}f 1 2 3 4\n"));
    assert_eq!(corners(&square), [[0, 1, 2], [0, 2, 3]]);
    assert_eq!((short(&square.name).as_str(), square.vertices.len(), square.materials.len()), ("a", 4, 1));
    assert!(square.vertices.iter().all(|v| v.normal == Vec3::Z));
    for face in [
        "f -4 -3 -2 -1",
        "f 1/1 2/1 3/1 4/1",
        "f 1/ 2/ 3/ 4/",
        "f 1/1/ 2/1/ 3/1/ 4/1/",
        "fo 1 2 3 4",
        "f 1 2 \\\n 3 4",
        "f 1 2 \\\r\n3 4\r",
        "f 1 2 3\\\n 4",
        "f 1 2\\\r\n3 \\\n\\\n4",
        "vp 1 2 \\\n3\nf 1 2 3 4",
        "# C:\\models\\\nf 1 2 3 4",
        "f\t1  2 3 4 # a comment",
        "f 1/-1 2/-9 3 4",
    ] {
        let same = load(&format!("# a comment\n\n{SQUARE}vt 0.5 0.5\n  g x\no y\n{face}"));
        assert_eq!(same.content_hash(), square.content_hash(), "{face:?}");
    }
    // All line ends; a fourth coordinate or colours after a position; Latin-1 in names and comments
    for text in [
        format!("{SQUARE}f 1 2 3 4\n").replace('\n', "\r\n"),
        format!("{SQUARE}f 1 2 3 4\n").replace('\n', "\r"),
        SQUARE.replace(" 0\n", " 0.0 1.0\n") + "f 1 2 3 4",
        SQUARE.replace(" 0\n", " 0e0 0.1 0.2 0.3\n") + "f 1 2 3 4",
        SQUARE.replace(" 0\n", "\\\n 0\\\n\n") + "f 1 2 3 4",
        SQUARE.replace("v 1 0 0", "v 1. .0 -.0e5") + "f 1 2 3 4",
    ] {
        assert_eq!(corners(&load(&text)), corners(&square), "{text:?}");
    }
    let latin = [b"# caf\xe9\ng stra\xdfe\n".as_slice(), SQUARE.as_bytes(), b"usemtl gr\xfcn\nf 1 2 3 4"].concat();
    assert_eq!(corners(&load_with(&[("a.obj", &latin)], "").unwrap()), corners(&square));
}

#[test]
fn normals_are_given_smooth_or_flat() {
    // A roof: two squares at a right angle with the common edge 2-3
    let roof = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 -1\nv 1 1 -1\n";
    let faces = ["f 1 2 3 4\n", "f 2 5 6 3\n"];
    let smooth = load(&format!("{roof}{}{}", faces[0], faces[1]));
    assert_eq!(smooth.vertices.len(), 6);
    // Normals are weighted by area: the corner belongs to one triangle of the first square and to both of the second.
    let edge = Vec3::new(2.0, 0.0, 1.0).normalize();
    assert!(smooth.vertices[1].normal.abs_diff_eq(edge, 1e-6), "{:?}", smooth.vertices);
    // With different groups, or with none, the edge is sharp.
    for (first, second) in [("s 1\n", "s 2\n"), ("s off\n", ""), ("s 0\n", "")] {
        let sharp = load(&format!("{roof}{first}{}{second}{}", faces[0], faces[1]));
        assert_eq!(sharp.vertices.len(), 8, "{first}");
        assert!(sharp.vertices.iter().all(|v| v.normal == Vec3::Z || v.normal == Vec3::X), "{first}");
    }
    let same = load(&format!("{roof}s 3\n{}s 3\n{}", faces[0], faces[1]));
    assert_eq!(same.vertices.len(), 6);
    // Normals of the file are normalised; different normals give different vertices.
    let given = load(&format!("{roof}vn 0 0 2\nvn 5 0 0\nf 1//1 2//1 3//1 4//1\nf 2//-1 5//2 6//2 3//2\n"));
    assert_eq!(given.vertices.len(), 8);
    assert!(given.warnings.is_empty(), "{:?}", given.warnings);
    // Invalid and missing normals are computed.
    let poor = load(&format!("{SQUARE}vn 0 0 0\nvn nan 0 1\nvn 0 0 -1\nf 1//1 2//2 3//3 4\n"));
    let normals: Vec<Vec3> = poor.vertices.iter().map(|v| v.normal).collect();
    assert_eq!(normals, [Vec3::Z, Vec3::Z, Vec3::NEG_Z, Vec3::Z]);
    assert!(poor.warnings[0].starts_with("2 normals"), "{:?}", poor.warnings);
}

#[test]
fn polygons_keep_their_count_and_cover_their_area() {
    let arrow = "v 0 0 0\nv 2 2 0\nv 0 1 0\nv -2 2 0\nf 4 1 2 3\n";
    let scene = load(arrow);
    let area: f32 = (0..2)
        .map(|i| {
            let [a, b, c] = scene.corners(i);
            let twice = (b - a).cross(c - a);
            assert!(twice.z > 0.0, "inside out");
            twice.z / 2.0
        })
        .sum();
    assert_eq!((scene.triangles.len(), area), (2, 2.0));
    let few = load(&format!("{SQUARE}f 1 2\nf 1\nf\nf 1 2 3\nl 1 2\np 1\n"));
    assert_eq!(few.triangles.len(), 1);
    assert!(few.warnings.iter().any(|w| w.starts_with("3 faces with fewer")), "{:?}", few.warnings);
    assert!(few.warnings.iter().any(|w| w == "unsupported statements ignored: l, p"), "{:?}", few.warnings);
}

const LIBRARY: &str = "newmtl dull\nKd .5 .25 0\nKa 1 1 1\nKs 1 1 1\nillum 1\nNs 5\n\
    newmtl gloss\nKd 0.1\nKs 0.5 0.25 0\nNs 64\nillum 2\nKa 0 0 0\n\
    newmtl mirror\nKd 0 0 0\nKs 0.5 0.9 0\nillum 3\nmap_Kd wood.png\n\
    newmtl loud\nKd 7 -1 0\nKd xyz 1 2 3\nillum 0\nunknown 3\n";

#[test]
fn materials_are_mapped_as_documented() {
    let text = format!(
        "mtllib a.mtl\n{SQUARE}f 1 2 3\nusemtl mirror\nf 1 2 3\nusemtl dull\nf 1 2 3\nusemtl gloss\n\
                        f 1 2 3\nusemtl loud\nf 1 2 3\nusemtl nothing\nf 1 2 3\nusemtl dull\nf 1 2 3\n"
    );
    let scene = load_with(&[("a.obj", text.as_bytes()), ("a.mtl", LIBRARY.as_bytes())], "").unwrap();
    let of = |i: usize| scene.materials[scene.triangles[i].material as usize];
    assert_eq!(of(0), scene::Material::neutral());
    assert_eq!((of(1).reflectivity, of(1).specular), (0.9, Vec3::new(0.5, 0.9, 0.0)));
    let dull = of(2);
    assert_eq!((dull.diffuse, dull.specular, dull.reflectivity), (Vec3::new(0.5, 0.25, 0.0), Vec3::ZERO, 0.0));
    assert!(dull.ambient.abs_diff_eq(Vec3::new(0.05, 0.025, 0.0), 1e-7));
    let gloss = of(3);
    assert_eq!((gloss.diffuse, gloss.ambient, gloss.exponent), (Vec3::splat(0.1), Vec3::ZERO, 64.0));
    assert_eq!((gloss.specular, gloss.reflectivity), (Vec3::new(0.5, 0.25, 0.0), 0.0));
    assert_eq!((of(4).ambient, of(4).diffuse), (Vec3::X, Vec3::ZERO));
    assert_eq!(of(5), scene::Material::neutral());
    assert_eq!(of(6), dull);
    let warnings = scene.warnings.join("\n");
    assert!(warnings.contains("neutral grey: nothing") && warnings.contains("textures ignored"), "{warnings}");
}

#[test]
fn libraries_are_read_missing_or_refused() {
    let text = |library: &str| format!("mtllib {library}\n{SQUARE}usemtl gloss\nf 1 2 3\n").into_bytes();
    let with = |library: &str, name: &str| load_with(&[("a.obj", &text(library)), (name, LIBRARY.as_bytes())], "");
    for (library, name) in [
        ("b.mtl", "b.mtl"),
        ("my own.mtl", "my own.mtl"),
        ("no.mtl b.mtl", "b.mtl"),
        ("./b.mtl", "b.mtl"),
        ("no.mtl \\\nb.mtl", "b.mtl"),
        ("b.mtl # the library", "b.mtl"),
        ("no.mtl b.mtl # the library", "b.mtl"),
        ("b #2.mtl", "b #2.mtl"),
        (&format!("{}.mtl", "b".repeat(150)), &format!("{}.mtl", "b".repeat(150))),
        (&format!("{}/b.mtl", "./".repeat(60)), "b.mtl"),
    ] {
        let scene = with(library, name).unwrap();
        assert_eq!(scene.materials[scene.triangles[0].material as usize].exponent, 64.0, "{library}");
    }
    let scene = with("no.mtl", "b.mtl").unwrap();
    assert!(scene.warnings[0].contains("no.mtl does not exist"), "{:?}", scene.warnings);
    let message = refusal(with("/etc/passwd", "b.mtl"));
    assert!(message.contains("a.obj:1: ") && message.contains("outside=yes"), "{message}");
    let allowed = load_with(&[("a.obj", &text("../nowhere/b.mtl"))], ":outside=yes").unwrap();
    assert!(allowed.warnings[0].contains("does not exist"));
}

/// The name of the library is in Latin-1, in the file and in the file system.
#[cfg(target_os = "linux")]
#[test]
fn a_library_is_found_by_its_bytes() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let name = b"stra\xdfe.mtl";
    std::fs::write(folder.path().join(std::ffi::OsStr::from_bytes(name)), LIBRARY).unwrap();
    let text = [b"mtllib ", &name[..], b"\n", SQUARE.as_bytes(), b"usemtl gloss\nf 1 2 3"].concat();
    std::fs::write(folder.path().join("a.obj"), text).unwrap();
    let scene = scene::load(folder.path().join("a.obj").to_str().unwrap()).unwrap();
    assert_eq!(scene.materials[scene.triangles[0].material as usize].exponent, 64.0);
}

#[cfg(unix)]
#[test]
fn links_to_files_outside_of_the_folder_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    std::fs::create_dir(place("in")).unwrap();
    std::fs::write(place("out.mtl"), LIBRARY).unwrap();
    std::fs::write(place("in/real.mtl"), LIBRARY).unwrap();
    std::os::unix::fs::symlink(place("out.mtl"), place("in/out.mtl")).unwrap();
    std::os::unix::fs::symlink(place("in/real.mtl"), place("in/link.mtl")).unwrap();
    let load = |library: &str, settings: &str| {
        std::fs::write(place("in/a.obj"), format!("mtllib {library}\n{SQUARE}usemtl gloss\nf 1 2 3\n")).unwrap();
        scene::load(&format!("{}{settings}", place("in/a.obj").display()))
    };
    let message = refusal(load("out.mtl", ""));
    assert!(message.contains("a.obj:1: the library out.mtl lies outside"), "{message}");
    for (library, settings) in [("out.mtl", ":outside=yes"), ("link.mtl", "")] {
        let scene = load(library, settings).unwrap();
        assert_eq!(scene.materials[scene.triangles[0].material as usize].exponent, 64.0, "{library}");
    }
    // If the scene's file is a link, libraries may be in the folder of the link or of its target.
    std::os::unix::fs::symlink(place("in/a.obj"), place("b.obj")).unwrap();
    assert!(scene::load(place("b.obj").to_str().unwrap()).unwrap().warnings[0].contains("link.mtl does not exist"));
    std::fs::write(place("link.mtl"), LIBRARY).unwrap();
    let warnings = scene::load(place("b.obj").to_str().unwrap()).unwrap().warnings;
    assert!(warnings.iter().all(|w| w.starts_with("textures")), "{warnings:?}");
}

#[test]
fn materials_may_be_defined_after_their_use_and_names_may_have_comments() {
    let of = |text: &str, library: &str| {
        let text = format!("{SQUARE}{text}\nf 1 2 3\nmtllib a.mtl\nusemtl dull\nf 1 2 3\n");
        let scene = load_with(&[("a.obj", text.as_bytes()), ("a.mtl", library.as_bytes())], "").unwrap();
        (scene.materials[scene.triangles[0].material as usize], scene.warnings, scene.lights.len())
    };
    let textures = "textures ignored: surfaces have their base colours";
    let early = of("mtllib a.mtl\nusemtl gloss", LIBRARY);
    assert_eq!((early.0.exponent, early.1.clone()), (64.0, vec![textures.to_owned()]));
    for text in
        ["usemtl gloss", "usemtl gloss # the material", "usemtl \\\ngloss", "mtllib a.mtl\nusemtl gloss # shiny"]
    {
        assert_eq!(of(text, LIBRARY), early, "{text}");
    }
    // A `#` is a part of the name if a library defines the whole name.
    for text in ["usemtl gloss #2", "mtllib a.mtl\nusemtl gloss #2"] {
        let two = of(text, &format!("{LIBRARY}newmtl gloss #2\nKd 1 0 0\n"));
        assert_eq!((two.0.diffuse, two.1.len()), (Vec3::X, 1), "{text}");
    }
    let never = of("usemtl nothing # at all", LIBRARY);
    assert!(never.1.iter().any(|w| w.contains("neutral grey: nothing # at all")), "{:?}", never.1);
    // A material that becomes emissive after its use gives lights as well.
    assert_eq!(of("usemtl late", &format!("{LIBRARY}newmtl late\nKe 1 1 1\n")).2, 1);
}

#[test]
fn an_unknown_lamp_gives_a_warning() {
    let text = format!("mtllib a.mtl\n{SQUARE}usemtl gloss\nf 1 2 3\n");
    let mut files = vec![("a.obj", text.as_bytes()), ("a.mtl", LIBRARY.as_bytes())];
    assert_eq!(
        load_with(&files, ":lamp=glos").unwrap().warnings[0],
        "lamp=glos: there is no such material, there are dull, gloss, loud, mirror"
    );
    assert_eq!(load_with(&files, ":lamp=gloss").unwrap().warnings.len(), 1);
    // If the folder has several files, which may be one scene, another file may have the material.
    files.push(("b.obj", text.as_bytes()));
    assert_eq!(load_with(&files, ":lamp=glos").unwrap().warnings.len(), 1);
}

#[test]
fn a_library_is_searched_once() {
    let scene = load(&format!("{}{SQUARE}f 1 2 3", "mtllib no.mtl\n".repeat(5)));
    assert_eq!(scene.warnings, ["a.obj:1: material library no.mtl does not exist: its materials are neutral grey"]);
    let many: String = (0..10_001).map(|i| format!(" m{i}.mtl")).collect();
    let message = refusal(load_with(&[("a.obj", format!("\nmtllib{many}\n").as_bytes())], ""));
    assert!(message.contains("a.obj:2: there are more than 10000 names of material libraries"), "{message}");
}

#[test]
fn emissive_surfaces_become_lights() {
    // A floor, and lamps of area 1 each: unit squares at height 5 with normals that point down
    let lamps = |places: &[f32], emission: &str, settings: &str| {
        let mut text =
            "mtllib a.mtl\nv -9 0 -9\nv -9 0 9\nv 9 0 9\nv 9 0 -9\nusemtl floor\nf 1 2 3 4\nusemtl lamp\n".to_owned();
        for x in places {
            text += &format!("v {x} 5 0\nv {} 5 0\nv {} 5 1\nv {x} 5 1\nf -4 -3 -2 -1\n", x + 1.0, x + 1.0);
        }
        let library = format!("newmtl floor\nKd 1 1 1\nnewmtl lamp\nKd 1 0.5 0.5\n{emission}");
        load_with(&[("a.obj", text.as_bytes()), ("a.mtl", library.as_bytes())], settings).unwrap()
    };
    assert!(lamps(&[0.0], "", "").lights.is_empty());
    let one = lamps(&[0.0], "Ke 8 4 0\n", "");
    let light = one.lights[0];
    assert_eq!((one.lights.len(), light.colour), (1, Vec3::new(1.0, 0.5, 0.0)));
    assert!(light.position.abs_diff_eq(Vec3::new(0.5, 5.0, 0.5), 0.1) && light.position.y < 5.0, "{light:?}");
    assert_eq!(one.materials[one.triangles[2].material as usize].ambient, Vec3::new(1.0, 1.0, 0.05));
    // An emissive material by the option `lamp`
    let named = lamps(&[0.0], "", ":lamp=lamp");
    assert_eq!(named.lights[0].colour, Vec3::new(1.0, 0.5, 0.5));
    // Two adjacent lamps are one light; four lamps are four lights; more are merged, and their total power is kept.
    assert_eq!(lamps(&[0.0, 1.0], "Ke 1 1 1\n", "").lights.len(), 1);
    assert_eq!(lamps(&[-6.0, -2.0, 2.0, 6.0], "Ke 1 1 1\n", "").lights.len(), 4);
    let many = lamps(&[-8.0, -6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0], "Ke 1 1 1\n", "");
    assert_eq!(many.lights.len(), lamps::MAX_LIGHTS);
    let total: Vec3 = many.lights.iter().map(|l| l.colour).sum();
    assert!(total.abs_diff_eq(Vec3::ONE, 1e-5), "{total}");
}

#[test]
fn each_error_has_its_line() {
    for (text, words) in [
        ("", "there is no face"),
        ("v 0 0 0\n", "there is no face"),
        ("v 0 0\n", ":1: a vertex has too few numbers"),
        ("v 0 0 zero\n", ":1: a vertex: `zero` is not a number"),
        ("\n\nv 0 0 nan\nf 1 1 1", ":3: a vertex has the values (0, 0, NaN), which are not finite"),
        ("v 0 0 1e39\nf 1 1 1", ":1: a vertex has the values"),
        ("v 0 0 1e19\nv 1e19 0 0\nf 2 2 2", ":3: a vertex has the values (10000000000000000000, 0, 0), which exceed"),
        ("f 1 1 1\nv 0 0 1e19\n", ":2: a vertex has the values"),
        ("v 1,5 2,5 0\n", ":1: a vertex: `1,5` is not a number (write decimals with a point)"),
        ("v 0 0\x000 1 2\n", ":1: there is a zero byte inside a word"),
        ("f 1 2 9\nv 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 0 0\n", ":1: a face uses vertex 9, but 0 are defined before it"),
        ("f 1 2 4\nv 0.0 0.0 0.0\nv 1 0 0\nv 1 1 1\n", ":1: a face uses vertex 4, but the file has 3"),
        ("v 0 0 0\nf 1 2 3\n", ":2: a face uses vertex 2, but 1 are defined before it"),
        ("v 0 0 0\nf 0 1 1\n", ":2: a face uses vertex 0"),
        ("v 0 0 0\nf -2 1 1\n", ":2: a face uses vertex -2"),
        ("v 0 0 0\nf 1 1 99999999999999999999\n", ":2: `99999999999999999999` is not a corner"),
        ("v 0 0 0\nf 1 1 x\n", ":2: `x` is not a corner"),
        ("v 0 0 0\nf 1 1 1.5\n", ":2: `1.5` is not a corner"),
        ("v 0 0 0\nf 1 1 //\n", ":2: `//` is not a corner"),
        ("v 0 0 0\nf \\\n1 \\\n1 7\n", ":4: a face uses vertex 7"),
    ] {
        let message = refusal(load_with(&[("a.obj", text.as_bytes())], ""));
        assert!(message.contains(words), "{text:?}: {message}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    /// A file with changed, removed or inserted bytes gives a valid scene or one error, and does not panic.
    #[test]
    fn mutated_files_never_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4u8), 1..6),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut bytes = format!("mtllib none.mtl\n{SQUARE}vt 0 0\nvn 0 0 1\ns 1\nusemtl a\nf 1/1/1 2/1/1 3//1 4\n\
            v 0.5 0.5 1e-3\ns off\nf -1 -2 \\\n-3\nf 1 2 5 3 4\n# end\n").into_bytes();
        for (index, value, kind) in changes {
            let at = index.index(bytes.len());
            match kind {
                0 => bytes[at] = value,
                1 => bytes.insert(at, value),
                2 => { bytes.remove(at); }
                _ => bytes[at] = b"0123456789-+.e /\\\nvf"[value as usize % 20],
            }
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        if let Ok(scene) = obj::read_bytes(Path::new("mutated.obj"), &bytes, &Options::default())
            && let Err(error) = scene.check()
        {
            prop_assert!(error.to_string().contains("too large"), "{}", error);
        }
    }
}

#[test]
fn the_conference_room_is_a_folder_with_lamps() {
    let Some(folder) = real_scenes("the_conference_room_is_a_folder_with_lamps") else { return };
    let scene = scene::load(folder.join("conference/obj").to_str().unwrap()).unwrap();
    assert_eq!((scene.triangles.len(), short(&scene.name).as_str()), (207_512, "obj"));
    let mut positions: Vec<_> = scene.vertices.iter().map(|v| v.position.to_array().map(f32::to_bits)).collect();
    positions.sort_unstable();
    positions.dedup();
    // The files have 139,373 lines `v`, of which 13 are unused and some are equal; normals split further vertices.
    assert!(
        positions.len() <= 139_360 && scene.vertices.len() == 219_830,
        "{} {}",
        positions.len(),
        scene.vertices.len()
    );
    assert!(scene.lights.is_empty());
    let lit = scene::load_in("conference-obj", Some(&folder)).unwrap();
    assert!(!lit.lights.is_empty() && lit.lights.len() <= lamps::MAX_LIGHTS);
    let bounds = lit.bounds();
    assert!(lit.lights.iter().all(|l| l.position.cmpgt(bounds.min).all() && l.position.cmplt(bounds.max).all()));
}

/// Compares all triangles of Sponza with those of the crate tobj.
#[test]
fn sponza_has_the_triangles_that_tobj_reads() {
    let Some(folder) = real_scenes("sponza_is_as_somebody_else_reads_it") else { return };
    let path = folder.join("sponza/sponza.obj");
    let scene = scene::load(path.to_str().unwrap()).unwrap();
    let options = tobj::LoadOptions { triangulate: true, ..Default::default() };
    let (models, _) = tobj::load_obj(&path, &options).unwrap();
    let theirs = models.iter().flat_map(|model| {
        let point = |i: &u32| Vec3::from_slice(&model.mesh.positions[3 * *i as usize..]);
        model.mesh.indices.chunks_exact(3).map(move |t| [point(&t[0]), point(&t[1]), point(&t[2])])
    });
    let ours = (0..scene.triangles.len() as u32).map(|i| scene.corners(i).map(Vec3::from));
    let (mut all, mut other) = (0, 0);
    for (a, b) in ours.zip(theirs) {
        all += 1;
        other += usize::from(a != b);
    }
    // tobj makes fans of all polygons; this reader does not if the fan does not cover the polygon.
    assert!(all == 66_450 && other < 500, "{other} of {all} differ");
}

#[test]
fn materials_keep_their_names() {
    let text = format!("mtllib a.mtl\n{SQUARE}f 1 2 3\nusemtl known\nf 1 3 4\nusemtl unknown\nf 2 3 4\n");
    let library = b"newmtl unused\nnewmtl known\nKd 1 0 0\n";
    let scene = load_with(&[("a.obj", text.as_bytes()), ("a.mtl", library)], "").unwrap();
    assert_eq!(scene.material_names, ["unused", "known", "", "unknown"]);
    let name = |triangle: usize| scene.material_names[scene.triangles[triangle].material as usize].as_str();
    assert_eq!([0, 1, 2].map(name), ["", "known", "unknown"]);
    scene.check().unwrap();
    let wrong = Scene { material_names: vec![String::new()], ..scene.clone() };
    assert!(wrong.check().unwrap_err().to_string().contains("names"));
    // They are no part of a scene's identity
    let nameless = Scene { material_names: Vec::new(), ..scene.clone() };
    assert_eq!(nameless.content_hash(), scene.content_hash());
    // Names in any encoding, with blanks and with comments that are none
    let names = [SQUARE.as_bytes(), b"usemtl st\xe9in\nf 1 2 3\nusemtl a b # c\nf 1 2 3\n"].concat();
    let scene = load_with(&[("a.obj", &names)], "").unwrap();
    assert_eq!(scene.material_names, ["st\u{fffd}in", "a b # c"]);
}

#[test]
fn joined_scenes_keep_the_names_of_those_that_have_some() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    for (name, text) in [
        ("a.obj", format!("{SQUARE}usemtl stone\nf 1 2 3\n").as_str()),
        ("b.ply", super::ply::CUBE),
        ("c.obj", &format!("{SQUARE}usemtl glass\nf 1 2 3\n")),
    ] {
        std::fs::write(path(name), text).unwrap();
    }
    let names = |files: &[&str]| {
        let scene = scene::load(&files.iter().map(|name| path(name)).collect::<Vec<_>>().join("+")).unwrap();
        scene.check().unwrap();
        scene.material_names
    };
    assert_eq!(names(&["a.obj", "b.ply", "c.obj"]), ["stone", "", "glass"]);
    assert_eq!(names(&["b.ply", "a.obj"]), ["", "stone"]);
    assert!(names(&["b.ply", "b.ply"]).is_empty());
    // A cache does not hold them
    let (scene, sources) = scene::cache::load(&path("a.obj"), None).unwrap();
    let cache = folder.path().join("a.rtb");
    scene::cache::write(&scene, &sources, &cache).unwrap();
    let cached = scene::load(cache.to_str().unwrap()).unwrap();
    assert!(cached.material_names.is_empty() && cached.content_hash() == scene.content_hash());
}
