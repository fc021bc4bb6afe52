//! Tests of invalid PLY files: each gives one error, and none panics.

use super::ply::{Encoded, encode};
use super::{load_bytes, refusal};
use proptest::prelude::*;

/// The header of a valid file; with [`BODY`], three vertices and a face.
const HEADER: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
    element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const BODY: &str = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

#[test]
fn each_error_has_its_line_and_a_hint() {
    let whole = format!("{HEADER}{BODY}");
    load_bytes(whole.as_bytes()).unwrap();
    // (text to be replaced, replacement, parts of the error)
    let cases: &[(&str, &str, &[&str])] = &[
        (&whole, "", &["mesh.ply: the file is empty"]),
        (&whole, "solid cube\n", &["mesh.ply:1: not a PLY file"]),
        (&whole, "ply", &["not a PLY file"]),
        (&whole, "plyx\n", &["not a PLY file"]),
        ("ascii", "asci", &[":2: PLY format `asci` is unknown", "binary_little_endian"]),
        ("1.0", "2.0", &[":2: PLY version `2.0` is unknown"]),
        ("format ascii 1.0\n", "", &["no `format` line"]),
        ("end_header\n", "", &[":9: `0 0 0` is not a line of a PLY header", "end_header"]),
        (&whole, &HEADER[..60], &["end_header"]),
        (BODY, "", &["at least 18 bytes, but only 0 bytes are left", "truncated"]),
        ("property float z\n", "", &[":3: the vertices have no coordinate `z`"]),
        ("property float x", "property list uchar float x", &["no coordinate `x`"]),
        ("property float y", "property float x", &[":5: the property `x` of element `vertex` is declared twice"]),
        ("property float y", "property real y", &[":5: type `real` is unknown", "double"]),
        ("property float y", "property float", &[":5: this is not the declaration of a property"]),
        ("element vertex 3", "element vertices 3", &["no element `vertex`"]),
        ("element vertex 3", "element vertex three", &[":3: `three` is not a number"]),
        ("element vertex 3", "element vertex -3", &[":3: `-3` is not a number"]),
        ("element vertex 3", "property int x\nelement vertex 3", &[":3: there is a property before the first element"]),
        (
            "element vertex 3",
            "element vertex 1099511627776",
            &[":3: 1099511627776 elements `vertex` are more than rtbench supports (134217728)"],
        ),
        ("element vertex 3", "element vertex 134217729", &["more than rtbench supports"]),
        ("element vertex 3", "element vertex 134217728", &[":3: 134217728 elements `vertex` need", "bytes are left"]),
        ("element face 1", "element face 1099511627776", &[":7: 1099511627776 elements `face` are more"]),
        ("element face 1", "element face 18446744073709551615", &["elements `face` are more"]),
        ("element face 1", "element face 100000000", &[":7: 100000000 elements `face` need at least"]),
        (
            "element face 1",
            "element junk 18446744073709551615\nproperty int a\nelement face 1",
            &[":7: 18446744073709551615 elements `junk` need"],
        ),
        ("element face 1", "element face 99999999999999999999", &["not a number"]),
        ("element face 1", "element vertex 1", &[":7: the element `vertex` is declared twice"]),
        (
            "element face 1\nproperty list uchar int vertex_indices\n",
            "",
            &["no faces: a point cloud cannot be ray traced"],
        ),
        ("element face 1", "element face 0", &[":7: there are no faces: a point cloud"]),
        ("vertex_indices", "corners", &[":7: the faces have no list `vertex_indices`"]),
        ("list uchar int", "list uchar half", &[":8: type `half` is unknown"]),
        ("list uchar int", "int", &["not a list of integers"]),
        ("1 0 0\n", "1 nan 0\n", &[":11: vertex 1 lies at (1, NaN, 0), which is not finite"]),
        ("1 0 0\n", "1 inf 0\n", &[":11: vertex 1", "not finite"]),
        ("1 0 0\n", "1 1e39 0\n", &[":11: vertex 1", "not finite"]),
        ("1 0 0\n", "1 zero 0\n", &[":11: vertex 1: `zero` is not a number"]),
        ("1 0 0\n", "1 0\n", &[":11: vertex 1 has too few values"]),
        ("3 0 1 2", "3 0 1 3", &[":13: face 0 uses vertex 3, but there are only 3 vertices (0 to 2)"]),
        ("3 0 1 2", "3 0 1 -1", &[":13: face 0 uses vertex -1"]),
        ("3 0 1 2", "3 0 1 4294967296", &[":13: face 0 uses vertex 4294967296"]),
        ("3 0 1 2", "3 0 1 1.5", &[":13: face 0: `1.5` is not a whole number"]),
        ("3 0 1 2", "-3 0 1 2", &[":13: face 0 has a list with a negative number"]),
        ("3 0 1 2", "4 0 1 2", &[":13: face 0 has too few values"]),
        ("3 0 1 2\n", "4 0 1 2", &["the file ends within face 0 of 1", "truncated"]),
        ("3 0 1 2", "2 0 1", &["no face has three corners"]),
        ("3 0 1 2", "3 0 1 é\u{7f}\u{85}", &["`é\\u{7f}\\u{85}` is not a whole number"]),
    ];
    for (from, to, words) in cases {
        assert!(whole.contains(from), "{from}");
        let message = refusal(load_bytes(whole.replacen(from, to, 1).as_bytes()));
        for word in *words {
            assert!(message.contains(word), "{from:?} -> {to:?}: {message}");
        }
    }
}

#[test]
fn errors_in_binary_files_have_the_number_of_the_vertex_or_face() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let sound = encode(&points, &[vec![0, 1, 2]]);
    load_bytes(&sound.little).unwrap();
    let cut = &sound.little[..sound.little.len() - 1];
    assert!(refusal(load_bytes(cut)).contains("the file ends within face 0 of 1"));
    let message = refusal(load_bytes(&encode(&points, &[vec![0, 1, 2], vec![0, 1, 7]]).big));
    assert!(message.contains("face 1 uses vertex 7, but there are only 3 vertices"), "{message}");
    let infinite = [[0.0; 3], [1.0, f32::INFINITY, 0.0], [0.0, 1.0, 0.0]];
    let message = refusal(load_bytes(&encode(&infinite, &[vec![0, 1, 2]]).little));
    assert!(message.contains("vertex 1 lies at (1, inf, 0), which is not finite"), "{message}");

    // A list of 2^31 items in an ignored property
    let text = "ply\nformat binary_big_endian 1.0\nelement junk 1\nproperty list uint double a\nelement vertex 3\n\
        property float x\nproperty float y\nproperty float z\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n";
    let bytes = [text.as_bytes(), &[0x80, 0, 0, 0], &[0; 64]].concat();
    assert!(refusal(load_bytes(&bytes)).contains("the file ends within junk 0"));
}

/// A small valid mesh in all encodings.
fn sample() -> Encoded {
    let points: Vec<[f32; 3]> = (0..8).map(|i| [(i & 1) as f32, (i >> 1 & 1) as f32 * 1.5, (i >> 2) as f32]).collect();
    encode(&points, &[vec![0, 1, 3, 2], vec![4, 6, 7, 5], vec![0, 4, 5], vec![1, 5, 7, 3], vec![2, 3, 7]])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..ProptestConfig::default() })]

    /// A file with changed, removed or inserted bytes gives a valid scene or one error, and does not panic.
    #[test]
    fn mutated_files_never_panic(
        encoding in 0..3usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4u8), 1..6),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let sample = sample();
        let mut bytes = [sample.ascii, sample.little, sample.big][encoding].clone();
        for (index, value, kind) in changes {
            let at = index.index(bytes.len());
            match kind {
                0 => bytes[at] = value,
                1 => bytes.insert(at, value),
                2 => { bytes.remove(at); }
                // Changed digits find most errors in headers and texts.
                _ => bytes[at] = b"0123456789-+.e \n"[value as usize % 16],
            }
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        let path = std::path::Path::new("mutated.ply");
        if let Ok(mut scene) = rtbench::scene::ply::read_bytes(path, &bytes) {
            scene.materials.push(rtbench::scene::Material::neutral());
            // Coordinates can become so large that the bounds are not finite, which `load` refuses.
            if let Err(error) = scene.check() {
                prop_assert!(error.to_string().contains("too large"), "{}", error);
            }
        }
    }
}

/// Found by fuzzing: the vertices take all bytes of the body, including the blank that the last value may lack.
#[test]
fn a_body_that_ends_with_its_first_element_is_refused() {
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty uchar x\nproperty uchar y\nproperty uchar z\n\
        element face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
    let message = super::refusal(super::load_bytes(&[header.as_bytes(), &[0; 5]].concat()));
    assert!(message.contains("only 0 bytes are left"), "{message}");
}
