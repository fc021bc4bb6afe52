//! Thousands of broken variants of every fixture, the same ones on every machine: each is read or refused with one line;
//! none panics, and none grows beyond the limit.

use super::ply::CUBE;
use super::{Files, real_scenes};
use rtbench::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Formats by extension, and where their fixtures lie below the folder of real scenes.
const FORMATS: [(&str, &str); 5] =
    [("aff", "fixtures/aff"), ("nff", "fixtures/nff"), ("ply", "fixtures/ply"), ("mgf", "mgf"), ("iv", "fixtures/iv")];

/// Largest fixture to be broken: a larger one is more of the same.
const LARGEST: usize = 20_000;

/// Variants of each fixture.
const VARIANTS: u64 = 300;

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

/// Numbers that a reader should not trust.
const NUMBERS: [&str; 14] = [
    "0",
    "-1",
    "1e38",
    "1e400",
    "-1e38",
    "nan",
    "inf",
    "2147483648",
    "4294967296",
    "1000000000",
    "18446744073709551616",
    "1e-320",
    "1.",
    ".",
];

struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

/// Where words (or lines) begin and end.
fn pieces(bytes: &[u8], ends: fn(u8) -> bool) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut start = None;
    for (i, &byte) in bytes.iter().chain(b"\n").enumerate() {
        match (ends(byte), start) {
            (false, None) => start = Some(i),
            (true, Some(from)) => {
                found.push((from, i));
                start = None;
            }
            _ => {}
        }
    }
    found
}

/// Breaks the file in one to four places.
fn mutate(original: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = original.to_vec();
    for _ in 0..1 + random.below(4) {
        if bytes.is_empty() {
            return bytes;
        }
        let by_line = random.below(2) == 0;
        let pieces = pieces(&bytes, if by_line { |b| b == b'\n' } else { |b| b <= b' ' });
        let (from, to) = pieces.get(random.below(pieces.len())).copied().unwrap_or((0, bytes.len()));
        match random.below(8) {
            0 => {
                let at = random.below(bytes.len());
                bytes[at] ^= 1 << random.below(8);
            }
            1 => bytes.truncate(random.below(bytes.len())),
            2 => drop(bytes.drain(from..to)),
            3 => {
                let copy = [&bytes[from..to], b"\n"].concat();
                bytes.splice(from..from, copy);
            }
            4 => {
                let at = random.below(bytes.len());
                bytes[at] = random.next() as u8;
            }
            5 => {
                let other = pieces.get(random.below(pieces.len())).map(|&(from, to)| bytes[from..to].to_vec());
                bytes.splice(from..to, other.unwrap_or_default());
            }
            _ => drop(bytes.splice(from..to, NUMBERS[random.below(NUMBERS.len())].bytes())),
        }
    }
    bytes
}

/// Loads the variants of one file, in a folder with what it includes. Returns how many were read.
fn break_it(name: &str, original: &[u8], beside: &[(String, Vec<u8>)]) -> u64 {
    let files = Files::new(&[]);
    for (name, bytes) in beside {
        files.write(name, bytes);
    }
    let total: usize = original.len() + beside.iter().map(|(_, bytes)| bytes.len()).sum::<usize>();
    let mut random = Random(0x9e37_79b9_7f4a_7c15 ^ seed_of(name));
    let mut read = 0;
    for variant in 0..VARIANTS {
        let bytes = mutate(original, &mut random);
        files.write(name, &bytes);
        let result = catch_unwind(AssertUnwindSafe(|| files.load(name)));
        let Ok(result) = result else {
            panic!("{name}, variant {variant} panics:\n{}", String::from_utf8_lossy(&bytes));
        };
        match result {
            Ok(scene) => {
                read += 1;
                scene.check().unwrap();
                let size = scene.vertices.len() * 32 + scene.triangles.len() * 16;
                assert!(size <= 16 * (total + bytes.len()) + (64 << 20), "{name}, variant {variant}: {size} bytes");
            }
            Err(error) => {
                assert!(matches!(error, Error::Input(_)), "{name}, variant {variant}: {error:?}");
                assert!(!error.to_string().contains('\n'), "{name}, variant {variant}: {error}");
            }
        }
    }
    read
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
        let read = break_it(name, text.as_bytes(), &[]);
        assert!((1..VARIANTS).contains(&read), "{name}: {read} of {VARIANTS} variants read; some should be, some not");
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
        let read: u64 = files.iter().map(|(name, bytes)| break_it(name, bytes, &files)).sum();
        eprintln!("{format}: {read} of {} variants read, the others refused", VARIANTS * files.len() as u64);
    }
}
