//! Tests of invalid BART files: each gives one error with file and line.

use super::{Files, refusal};

#[test]
fn each_error_has_its_line() {
    let cases: &[(&str, &[&str])] = &[
        ("", &["main.aff: there is no triangle"]),
        ("\n# only a comment", &["there is no triangle"]),
        ("\ns 0 0 0", &["main.aff:2: the file ends within a primitive", "truncated"]),
        ("s 0 0 zero 1", &["main.aff:1: s: `zero` is not a number"]),
        ("xs 1 1 nan 0 0 1 0 0 0 0 {\ns 0 0 0 1 }", &[":1: xs: `nan` is not a finite number"]),
        ("xs 1 1 1e999 0 0 1 0 0 0 0 {\ns 0 0 0 1 }", &[":1: xs: `1e999` is not a finite number"]),
        ("s 0 0 -1.#IND 1", &["there is no triangle"]),
        ("s 0 0 1.#comment", &["the file ends within"]),
        ("s 1\x002 0 1 1", &[":1: there is a zero byte inside a word"]),
        ("s 0 0 1e99 1", &[":1: a corner at", "not finite in single precision"]),
        ("l 0 1e99 0", &["there is no triangle"]),
        ("\n\nsphere 0 0 0 1", &[":3: `sphere` is not an entity"]),
        ("f 1 0 0\nhex 0 0 0", &[":2: `hex` is not an entity"]),
        ("f 1 0\nhex 0 0 0", &[":2: `hex` is not an entity"]),
        ("p 1000000000 0 0 0", &[":1: p: 1000000000 do not fit into the remaining 6 bytes"]),
        ("p -3 0 0 0", &[":1: p: -3 is negative"]),
        ("p 3.5 0 0 0", &[":1: p: `3.5` is not a whole number"]),
        ("p 99999999999999999999 0 0 0", &["not a whole number"]),
        ("p 2 0 0 0 1 1 1", &["there is no triangle"]),
        ("m vertices 1000000000 0 0 0", &[":1: vertices: 1000000000 do not fit"]),
        ("m vertices 1 0 0 0 triangles 1000000000 0 0 0", &["triangles: 1000000000 do not fit"]),
        ("m vertices 1 0 0 0 triangles 1 0 0 1", &[":1: m: index 1 is out of range (give 0 to 0)"]),
        ("m vertices 1 0 0 0 triangles 1 0 0 -1", &["index -1 is out of range"]),
        ("m vertices 0 triangles 1 0 0 0", &["index 0 is out of range (there are none)"]),
        ("m vertices 1 0 0 0 faces 1 0 0 0", &["`faces` is not a part of a mesh", "texturecoords"]),
        ("m points 1 0 0 0", &["m needs `vertices` here"]),
        ("s 0 0 0 1\n}", &[":2: `}` closes no transform"]),
        ("\nxs 1 1 1 0 0 1 0 0 0 0 {\ns 0 0 0 1", &[":2: the transform that begins here has no `}`"]),
        ("x name s 0 0 0 1", &["a transform needs `{` here, but there is `s`"]),
        ("tpa 0", &["the triangle has no times"]),
        (
            "tpa 2 2 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1 1 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1",
            &["tpa: time 1 follows the later time 2"],
        ),
        ("k a { transl 3 0 0 0 0 0 0 0 1 0 0 0 0 0 0 2 0 0 0 0 0 0 }", &["transl: 3 keys", "needs at least four"]),
        ("k a { transl 1000000000 0 }", &["transl: 1000000000 do not fit"]),
        ("k a { turn 4 }", &["`turn` is not a block of keyframes", "visibility"]),
        ("k a\n{ visibility 1 0 1", &["the file ends within k"]),
        ("a 0 1 0", &["the animation has 0 frames", "1 to 100000"]),
        ("a 0 1 1000000000", &["the animation has 1000000000 frames"]),
        ("i 0 main.aff", &["main.aff:1: include `main.aff`: the file includes itself"]),
        ("i 0 loop.aff", &["main.aff"; 0]),
        ("i 0 nowhere.aff", &["main.aff:1: include `nowhere.aff`: no such file"]),
        ("i 0 parts", &["include `parts`"]),
        ("i 0 parts/broken.aff", &["parts/broken.aff:2: `oops` is not an entity"]),
        ("i x main.aff", &["`x` is not a whole number"]),
        ("i 0 ../outside.aff", &["lies outside of the scene's folder", "outside=yes"]),
        ("i 0 bomb0.aff", &["files are included too often"]),
    ];
    let mut files = vec![
        ("loop.aff".to_owned(), "i 0 parts/back.aff".to_owned()),
        ("parts/back.aff".to_owned(), "\n i 0 ../loop.aff".to_owned()),
        ("parts/broken.aff".to_owned(), "s 0 0 0 1\noops".to_owned()),
        ("bomb20.aff".to_owned(), "# nothing".to_owned()),
    ];
    let bomb = |i: usize| (format!("bomb{i}.aff"), format!("i 0 bomb{0}.aff i 0 bomb{0}.aff", i + 1));
    files.extend((0..20).map(bomb));
    for (text, words) in cases {
        let mut all: Vec<(&str, &str)> = files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
        all.push(("main.aff", text));
        all.push(("../outside.aff", "s 0 0 0 1"));
        let message = refusal(Files::new(&all).load("main.aff"));
        for word in *words {
            assert!(message.contains(word), "{text:?}: {message}");
        }
        if text.contains("loop") {
            assert!(message.contains("parts/back.aff:2: include `../loop.aff`: the file includes itself"), "{message}");
        }
    }
}

#[test]
fn a_file_outside_of_the_folder_is_read_if_it_is_allowed() {
    let files = Files::new(&[("main.aff", "i 0 ../outside.aff"), ("../outside.aff", "s 0 0 0 1")]);
    assert!(files.load("main.aff").is_err());
    assert!(files.load("main.aff:outside=yes").unwrap().triangles.len() > 100);
}

/// Invisible objects take no memory, but reading them takes time.
#[test]
fn a_large_file_cannot_be_included_too_often() {
    let large = "p 3 0 0 0 1 0 0 0 1 0\n".repeat(200_000);
    let including = |times: usize| {
        let includes = "i 0 large.aff\n".repeat(times);
        Files::new(&[
            ("main.aff", &format!("s 0 0 0 1 x ghost {{\n{includes}}}\nk ghost {{ visibility 1 0 0 }}")),
            ("large.aff", &large),
        ])
    };
    let message = refusal(including(200).load("main.aff:time=1"));
    assert!(message.contains("main.aff:") && message.contains("included too often"), "{message}");
    assert_eq!(including(10).load("main.aff:time=1").unwrap().triangles.len(), 24 * 11 * 2);
}

#[test]
fn nested_copies_are_limited() {
    // Each file includes the next one ten times.
    let ten = |line: &str| format!("{line}\n").repeat(10);
    let mut files = vec![("copies0.aff".to_owned(), ten("s 0 0 0 1"))];
    files.extend((1..6).map(|i| (format!("copies{i}.aff"), ten(&format!("i 0 copies{}.aff", i - 1)))));
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    let files = Files::new(&files);
    assert_eq!(files.load("copies1.aff").unwrap().triangles.len(), 100 * 24 * 11 * 2);
    let message = refusal(files.load("copies5.aff:memory=64M"));
    assert!(message.contains("more than 64 MiB of memory") || message.contains("too often"), "{message}");
}
