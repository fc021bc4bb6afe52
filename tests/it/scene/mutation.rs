//! Tests of the readers with thousands of mutated variants of every fixture, which are deterministic. Each variant is
//! read or refused with one line; none panics, none hangs, and none takes more memory than sixteen times its file and
//! 64 MiB: what a file may repeat is limited by the option `memory=64M`. RTBENCH_VARIANTS sets another number of
//! variants.

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

/// Formats by extension, and the folders of their fixtures in the folder of real scenes.
const FORMATS: [(&str, &str); 5] =
    [("aff", "fixtures/aff"), ("nff", "fixtures/nff"), ("ply", "fixtures/ply"), ("mgf", "mgf"), ("iv", "fixtures/iv")];

/// Size of the largest fixture that is mutated, in bytes.
const LARGEST: usize = 20_000;

/// Number of variants of each fixture.
const VARIANTS: u64 = 300;

/// Number of variants of each file in [`OWN`], unless RTBENCH_VARIANTS sets another.
const OWN_VARIANTS: u64 = 2000;

/// Small files with all features, which are tested even without the fixtures.
const OWN: [(&str, &str); 8] = [
    ("all.aff", include_str!("../../data/all.aff")),
    (
        "all.nff",
        "v from 0 3 10 at 0 0 0 up 0 1 0 angle 60 hither 0 resolution 640 480\nl 4 3 2\n\
        f 1 .9 .7 .5 .5 45.2776 0 1 a.jpg\ns 0 0 0 .5\nc 0 0 0 1 0 2 0 0\np 4 -7 -1 -7 -7 -1 7 7 -1 7 7 -1 -7\n",
    ),
    ("all.mgf", include_str!("../../data/all.mgf")),
    ("cube.ply", CUBE),
    (
        "strips.ply",
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty double z\nproperty float nx\n\
        property float ny\nproperty float nz\nelement tristrips 2\nproperty list float int vertex_indices\nelement face 1\n\
        property list uchar int64 vertex_index\nend_header\n0 0 0\n0 0 1\n2 0 0 0 0 -1.#IND\n0 3 0 0 0 1\n2 3 1 a b c\n\
        nan inf 1e39 0 0 1\n8 0 1 2 3 -1 0 1 2\n4 1 2 3 4\n4\n0 1 3.0 2\n",
    ),
    (
        "first.obj",
        "f 1//1 2/x/2 4/3/9 3\nf 1, 2, 5\nf +1 2 3\nv 0 0 0\nv 2.0D0 0 0\nv 0, 3, 0\nv 2 3 1\nv nan -1.#IND 1e39\n\
        vn 0 0 1\nvn 1.#QNAN 0 0\nf -5 -4 -3 -2\nf 5 4 3\nmtllib ..\\no\\no.mtl\n",
    ),
    ("all.iv", include_str!("../../data/all.iv")),
    (
        "all.wrl",
        "#VRML V1.0 ascii\nDEF Cameras Switch { whichChild 0 PerspectiveCamera { position 0 1 5 } }\n\
        Separator { Material { diffuseColor [ 1 0 0, 0 1 0 ] } MaterialBinding { value PER_FACE }\n\
        Coordinate3 { point [ 0 0 0, 1 0 0, 1 1 .2, 0 1 0 ] }\n\
        IndexedFaceSet { coordIndex [ 0, 1, 2, -1, 0, 2, 3, -1 ] } WWWInline { name \"cube.wrl\" ~ } }\n",
    ),
];

/// A file to be mutated.
struct Case<'a> {
    /// Name of the file that is mutated.
    name: &'a str,
    original: &'a [u8],
    /// Name of the file that is loaded: this file or one that includes it.
    load: &'a str,
    /// Further files in its folder.
    other_files: &'a [(String, Vec<u8>)],
    mutate: fn(&[u8], &mut Random) -> Vec<u8>,
    variants: u64,
}

impl<'a> Case<'a> {
    fn new(name: &'a str, original: &'a [u8], mutate: fn(&[u8], &mut Random) -> Vec<u8>) -> Case<'a> {
        Case { name, original, load: name, other_files: &[], mutate, variants: variants(VARIANTS) }
    }
}

/// The number of variants: RTBENCH_VARIANTS if it is set, otherwise this default.
fn variants(default: u64) -> u64 {
    std::env::var("RTBENCH_VARIANTS").map_or(default, |number| number.parse().expect("RTBENCH_VARIANTS is a number"))
}

/// A file with the option that sets what it may repeat to the memory that a file may always take. A cache repeats
/// nothing.
fn limited(name: &str) -> String {
    if name.ends_with(".rtb") { name.to_owned() } else { format!("{name}:memory=64M") }
}

/// The only variant to be tested, given as `NAME:NUMBER` in RTBENCH_VARIANT.
fn wanted() -> Option<(String, u64)> {
    let wanted = std::env::var("RTBENCH_VARIANT").ok()?;
    let (name, variant) = wanted.rsplit_once(':').expect("RTBENCH_VARIANT is NAME:NUMBER");
    Some((name.to_owned(), variant.parse().expect("RTBENCH_VARIANT is NAME:NUMBER")))
}

/// Loads the variants of a file, in a folder with its further files. Returns the number of variants that were read.
fn load_variants(case: &Case) -> u64 {
    let files = Files::new(&[]);
    for (name, bytes) in case.other_files {
        files.write(name, bytes);
    }
    let other_bytes: usize =
        case.other_files.iter().filter(|(name, _)| name != case.name).map(|(_, bytes)| bytes.len()).sum();
    let watchdog = Watchdog::new();
    let mut read = 0;
    let only = wanted();
    for variant in 0..case.variants {
        if only.as_ref().is_some_and(|(name, number)| name != case.name || *number != variant) {
            continue;
        }
        let case_name = format!(
            "{0}, variant {variant} (repeat with RTBENCH_VARIANT={0}:{variant} cargo test --release --test it mutation)",
            case.name
        );
        // Each variant has its own seed, so that it can be repeated alone.
        let mut random = Random(seed_of(&format!("{} {variant}", case.name)) | 1);
        let bytes = (case.mutate)(case.original, &mut random);
        // A byte may have been replaced by itself.
        if bytes == case.original {
            continue;
        }
        if only.is_some() {
            eprintln!("{case_name}:\n{}", String::from_utf8_lossy(&bytes));
        }
        files.write(case.name, &bytes);
        watchdog.begin(&case_name);
        let result = guard::within_limits(&case_name, other_bytes + bytes.len(), || {
            catch_unwind(AssertUnwindSafe(|| files.load(&limited(case.load))))
                .unwrap_or_else(|_| panic!("{case_name}: panics"))
        });
        match result {
            Ok(scene) => {
                read += 1;
                scene.check().unwrap_or_else(|error| panic!("{case_name}: {error}"));
            }
            Err(error) => {
                assert!(matches!(error, Error::Input(_)), "{case_name}: {error:?}");
                assert!(!error.to_string().contains('\n'), "{case_name}: {error}");
            }
        }
    }
    read
}

/// Tests the variants of a file; asserts that some are read and some are refused.
fn load_own_variants(case: &Case) {
    let read = load_variants(case);
    let some = wanted().is_some() || (1..case.variants).contains(&read);
    assert!(some, "{}: {read} of {} variants are read; some must be read and some refused", case.name, case.variants);
}

/// A seed computed from a name (FNV-1a).
fn seed_of(name: &str) -> u64 {
    name.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[test]
fn own_files_survive_every_mutation() {
    for (name, text) in OWN {
        let whole = Files::new(&[(name, text)]).load(name);
        assert!(whole.is_ok(), "{name}: {}", whole.unwrap_err());
        load_own_variants(&Case { variants: variants(OWN_VARIANTS), ..Case::new(name, text.as_bytes(), mutate::text) });
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
            .map(|(name, bytes)| load_variants(&Case { other_files: &files, ..Case::new(name, bytes, mutate::text) }))
            .sum();
        eprintln!("{format}: {read} of {} variants read, the others refused", variants(VARIANTS) * files.len() as u64);
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
        load_own_variants(&Case { load: "all.obj", other_files: &files, variants: variants(OWN_VARIANTS), ..case });
    }
}

/// Tests the variants of a glTF file with a single buffer that is used, and of the same file as a GLB.
fn load_both_kinds(name: &str, text: &str) -> rtbench::scene::Scene {
    let mut document: serde_json::Value = serde_json::from_str(text).unwrap();
    let uri = document["buffers"][0].as_object_mut().unwrap().remove("uri").unwrap();
    let (_, data) = uri.as_str().unwrap().split_once(',').unwrap();
    let buffer = base64::engine::general_purpose::STANDARD.decode(data).unwrap();
    let binary = gltf::glb(&document, &buffer);
    let [text_name, binary_name] = ["gltf", "glb"].map(|extension| format!("{name}.{extension}"));
    let files = Files::new(&[(&text_name, text)]);
    files.write(&binary_name, &binary);
    let [a, b] = [&text_name, &binary_name].map(|name| files.load(name).unwrap());
    assert_eq!(a.content_hash(), b.content_hash());
    let many = variants(OWN_VARIANTS);
    load_own_variants(&Case { variants: many, ..Case::new(&text_name, text.as_bytes(), mutate::text) });
    load_own_variants(&Case { variants: many, ..Case::new(&binary_name, &binary, mutate::bytes) });
    a
}

#[test]
fn gltf_of_both_kinds_survives_every_mutation() {
    let all = load_both_kinds("all", include_str!("../../data/all.gltf"));
    assert!(all.triangles.len() >= 8 && all.camera.is_some() && all.lights.len() == 3);
}

#[test]
fn gltf_with_extensions_survives_every_mutation() {
    let all = load_both_kinds("extensions", include_str!("../../data/extensions.gltf"));
    assert!(all.triangles.len() == 3 * 2 + 2 + 2 && all.lights.len() == 1, "{:?}", all.warnings);
}

#[test]
fn caches_survive_every_mutation() {
    let files = Files::new(&[("all.aff", OWN[0].1)]);
    let mut scene = files.load("all.aff:segments=4").unwrap();
    scene.warnings.truncate(2);
    cache::write(&scene, &Sources::default(), &files.path("all.rtb")).unwrap();
    let bytes = std::fs::read(files.path("all.rtb")).unwrap();
    // The checksum detects every change; with a valid checksum, the other checks have to.
    let caught = load_variants(&Case::new("all.rtb", &bytes, mutate::bytes));
    assert!(wanted().is_some() || caught == 0, "{caught} damaged caches were read");
    let resealed = |original: &[u8], random: &mut Random| {
        let mut bytes = mutate::bytes(original, random);
        cache::reseal(&mut bytes);
        bytes
    };
    load_own_variants(&Case { variants: variants(OWN_VARIANTS), ..Case::new("resealed.rtb", &bytes, resealed) });
}
