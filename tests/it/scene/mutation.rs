//! Thousands of broken variants of every fixture, the same ones on every machine: each is read or refused with one line;
//! none panics, none hangs, and none takes more memory than sixteen times its file and 64 MiB.

mod bombs;
mod guard;
mod mutate;

use super::ply::CUBE;
use super::{Files, gltf, real_scenes};
use base64::Engine;
use guard::Watchdog;
use mutate::Random;
use rtbench::Error;
use rtbench::scene::cache::{self, Sources};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Formats by extension, and where their fixtures lie below the folder of real scenes.
const FORMATS: [(&str, &str); 5] =
    [("aff", "fixtures/aff"), ("nff", "fixtures/nff"), ("ply", "fixtures/ply"), ("mgf", "mgf"), ("iv", "fixtures/iv")];

/// Largest fixture to be broken: a larger one is more of the same.
const LARGEST: usize = 20_000;

/// Variants of each fixture, and of each file of our own.
const VARIANTS: u64 = 300;
const OWN_VARIANTS: u64 = 2000;

/// Small files with everything in them, for where the fixtures are not at hand.
const OWN: [(&str, &str); 6] = [
    ("all.aff", include_str!("../../data/all.aff")),
    (
        "all.nff",
        "v from 0 3 10 at 0 0 0 up 0 1 0 angle 60 hither 0 resolution 640 480\nl 4 3 2\n\
        f 1 .9 .7 .5 .5 45.2776 0 1 a.jpg\ns 0 0 0 .5\nc 0 0 0 1 0 2 0 0\np 4 -7 -1 -7 -7 -1 7 7 -1 7 7 -1 -7\n",
    ),
    ("all.mgf", include_str!("../../data/all.mgf")),
    ("cube.ply", CUBE),
    ("all.iv", include_str!("../../data/all.iv")),
    (
        "all.wrl",
        "#VRML V1.0 ascii\nDEF Cameras Switch { whichChild 0 PerspectiveCamera { position 0 1 5 } }\n\
        Separator { Material { diffuseColor [ 1 0 0, 0 1 0 ] } MaterialBinding { value PER_FACE }\n\
        Coordinate3 { point [ 0 0 0, 1 0 0, 1 1 .2, 0 1 0 ] }\n\
        IndexedFaceSet { coordIndex [ 0, 1, 2, -1, 0, 2, 3, -1 ] } WWWInline { name \"cube.wrl\" ~ } }\n",
    ),
];

/// One fixture to be broken.
struct Case<'a> {
    /// The file that is broken.
    name: &'a str,
    original: &'a [u8],
    /// The file that is loaded: this one or one that uses it.
    load: &'a str,
    /// What lies beside it.
    beside: &'a [(String, Vec<u8>)],
    mutate: fn(&[u8], &mut Random) -> Vec<u8>,
    variants: u64,
}

impl<'a> Case<'a> {
    fn new(name: &'a str, original: &'a [u8], mutate: fn(&[u8], &mut Random) -> Vec<u8>) -> Case<'a> {
        Case { name, original, load: name, beside: &[], mutate, variants: VARIANTS }
    }
}

/// The variant that alone is wanted, as `NAME:NUMBER` in RTBENCH_VARIANT.
fn wanted() -> Option<(String, u64)> {
    let wanted = std::env::var("RTBENCH_VARIANT").ok()?;
    let (name, variant) = wanted.rsplit_once(':').expect("RTBENCH_VARIANT is NAME:NUMBER");
    Some((name.to_owned(), variant.parse().expect("RTBENCH_VARIANT is NAME:NUMBER")))
}

/// Loads the variants of one file, in a folder with what it includes. Returns how many were read.
fn break_it(case: &Case) -> u64 {
    let files = Files::new(&[]);
    for (name, bytes) in case.beside {
        files.write(name, bytes);
    }
    let beside: usize = case.beside.iter().filter(|(name, _)| name != case.name).map(|(_, bytes)| bytes.len()).sum();
    let watchdog = Watchdog::new();
    let mut read = 0;
    let only = wanted();
    for variant in 0..case.variants {
        if only.as_ref().is_some_and(|(name, number)| name != case.name || *number != variant) {
            continue;
        }
        let what = format!(
            "{0}, variant {variant} (again: RTBENCH_VARIANT={0}:{variant} cargo test --release --test it mutation)",
            case.name
        );
        // Each has a seed of its own, so that it can be made again without those before it
        let mut random = Random(seed_of(&format!("{} {variant}", case.name)) | 1);
        let bytes = (case.mutate)(case.original, &mut random);
        // A byte may have been replaced by its like
        if bytes == case.original {
            continue;
        }
        if only.is_some() {
            eprintln!("{what}:\n{}", String::from_utf8_lossy(&bytes));
        }
        files.write(case.name, &bytes);
        watchdog.begin(&what);
        let result = guard::held(&what, beside + bytes.len(), || {
            catch_unwind(AssertUnwindSafe(|| files.load(case.load))).unwrap_or_else(|_| panic!("{what}: panics"))
        });
        match result {
            Ok(scene) => {
                read += 1;
                scene.check().unwrap_or_else(|error| panic!("{what}: {error}"));
            }
            Err(error) => {
                assert!(matches!(error, Error::Input(_)), "{what}: {error:?}");
                assert!(!error.to_string().contains('\n'), "{what}: {error}");
            }
        }
    }
    read
}

/// Breaks a file of our own: some variants should still be read, some not.
fn break_own(case: &Case) {
    let read = break_it(case);
    let some = wanted().is_some() || (1..case.variants).contains(&read);
    assert!(some, "{}: {read} of {} variants read; some should be, some not", case.name, case.variants);
}

/// A seed from a name (FNV-1a).
fn seed_of(name: &str) -> u64 {
    name.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[test]
fn own_files_survive_every_mutation() {
    for (name, text) in OWN {
        let whole = Files::new(&[(name, text)]).load(name);
        assert!(whole.is_ok(), "{name}: {}", whole.unwrap_err());
        break_own(&Case { variants: OWN_VARIANTS, ..Case::new(name, text.as_bytes(), mutate::text) });
    }
}

#[test]
fn fixtures_survive_every_mutation() {
    let Some(folder) = real_scenes("fixtures_survive_every_mutation") else { return };
    for (format, place) in FORMATS {
        let entries = std::fs::read_dir(folder.join(place)).unwrap();
        let mut files: Vec<(String, Vec<u8>)> = entries
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|extension| extension == format))
            .map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), std::fs::read(&path).unwrap()))
            .filter(|(_, bytes)| bytes.len() <= LARGEST)
            .collect();
        files.sort();
        assert!(files.len() >= 3, "{format}: only {} fixtures", files.len());
        let read: u64 = files
            .iter()
            .map(|(name, bytes)| break_it(&Case { beside: &files, ..Case::new(name, bytes, mutate::text) }))
            .sum();
        eprintln!("{format}: {read} of {} variants read, the others refused", VARIANTS * files.len() as u64);
    }
}

#[test]
fn meshes_with_a_material_library_survive_every_mutation() {
    let [obj, mtl] = [("all.obj", include_str!("../../data/all.obj")), ("all.mtl", include_str!("../../data/all.mtl"))];
    let files = [obj, mtl].map(|(name, text)| (name.to_owned(), text.as_bytes().to_vec()));
    let whole = Files::new(&[obj, mtl]).load("all.obj").unwrap();
    assert!(whole.materials.len() >= 3 && !whole.lights.is_empty(), "{:?}", whole.warnings);
    for (name, bytes) in &files {
        let case = Case::new(name, bytes, mutate::text);
        break_own(&Case { load: "all.obj", beside: &files, variants: OWN_VARIANTS, ..case });
    }
}

#[test]
fn gltf_of_both_kinds_survives_every_mutation() {
    let text = include_str!("../../data/all.gltf");
    let mut document: serde_json::Value = serde_json::from_str(text).unwrap();
    let uri = document["buffers"][0].as_object_mut().unwrap().remove("uri").unwrap();
    let (_, data) = uri.as_str().unwrap().split_once(',').unwrap();
    let buffer = base64::engine::general_purpose::STANDARD.decode(data).unwrap();
    let binary = gltf::glb(&document, &buffer);
    let files = Files::new(&[("all.gltf", text)]);
    files.write("all.glb", &binary);
    let [a, b] = ["all.gltf", "all.glb"].map(|name| files.load(name).unwrap());
    assert!(
        a.content_hash() == b.content_hash() && a.triangles.len() >= 8 && a.camera.is_some() && a.lights.len() == 3
    );
    break_own(&Case { variants: OWN_VARIANTS, ..Case::new("all.gltf", text.as_bytes(), mutate::text) });
    break_own(&Case { variants: OWN_VARIANTS, ..Case::new("all.glb", &binary, mutate::bytes) });
}

#[test]
fn caches_survive_every_mutation() {
    let files = Files::new(&[("all.aff", OWN[0].1)]);
    let mut scene = files.load("all.aff:segments=4").unwrap();
    scene.warnings.truncate(2);
    cache::write(&scene, &Sources::default(), &files.path("all.rtb")).unwrap();
    let bytes = std::fs::read(files.path("all.rtb")).unwrap();
    // The checksum sees everything; with a right one, the other checks have to.
    let caught = break_it(&Case::new("all.rtb", &bytes, mutate::bytes));
    assert!(wanted().is_some() || caught == 0, "{caught} broken caches were read");
    let resealed = |original: &[u8], random: &mut Random| {
        let mut bytes = mutate::bytes(original, random);
        cache::reseal(&mut bytes);
        bytes
    };
    break_own(&Case { variants: OWN_VARIANTS, ..Case::new("resealed.rtb", &bytes, resealed) });
}
