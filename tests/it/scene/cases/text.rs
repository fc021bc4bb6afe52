//! Encodings of all text formats.

use super::Files;
use crate::scene::refusal;

/// A scene in every text format, in which all numbers have several digits.
const SCENES: [(&str, &str); 6] = [
    ("a.obj", "# text\nv 10 10 10\nv 34 10 10\nv 10 56 10\nf 1 2 3\n"),
    (
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
         property list uchar int vertex_indices\nend_header\n10 10 10\n34 10 10\n10 56 10\n3 0 1 2\n",
    ),
    ("a.iv", "#Inventor V2.1 ascii\nCoordinate3 { point [ 10 10 10, 34 10 10, 10 56 10 ] } FaceSet { }\n"),
    (
        "a.wrl",
        "#VRML V1.0 ascii\nCoordinate3 { point [10 10 10, 34 10 10, 10 56 10] }\nIndexedFaceSet { coordIndex [0,1,2] }",
    ),
    ("a.mgf", "v a =\np 10 10 10\nv b =\np 34 10 10\nv c =\np 10 56 10\nf a b c\n"),
    ("a.nff", "# text\np 3\n10 10 10\n34 10 10\n10 56 10\n"),
];

fn utf16(text: &str, unit: fn(u16) -> [u8; 2]) -> Vec<u8> {
    text.encode_utf16().flat_map(unit).collect()
}

#[test]
fn utf16_is_read_by_its_byte_order_mark_and_refused_without() {
    for (name, text) in SCENES {
        let files = Files::new(&[(name, text)]);
        let expected = files.load(name).unwrap_or_else(|error| panic!("{name}: {error}")).content_hash();
        for unit in [u16::to_le_bytes, u16::to_be_bytes] {
            let ends = text.replace('\n', "\r\n");
            for text in [text, &ends] {
                files.write(name, &utf16(&format!("\u{feff}{text}"), unit));
                assert_eq!(files.load(name).unwrap().content_hash(), expected, "{name}");
            }
            files.write(name, &utf16(text, unit));
            let message = refusal(files.load(name));
            let known = ["zero byte inside a word", "not a PLY file", "is not a header"];
            assert!(known.iter().any(|words| message.contains(words)), "{name}: {message}");
        }
        files.write(name, format!("\u{feff}{text}").as_bytes());
        assert_eq!(files.load(name).unwrap().content_hash(), expected, "{name}: UTF-8 with a mark");
        let mut whole = utf16(&format!("\u{feff}{text}"), u16::to_le_bytes);
        whole.pop();
        files.write(name, &whole);
        assert!(refusal(files.load(name)).contains("not valid UTF-16"), "{name}");
        let wide: Vec<u8> = format!("\u{feff}{text}").chars().flat_map(|c| (c as u32).to_le_bytes()).collect();
        files.write(name, &wide);
        assert!(refusal(files.load(name)).contains("UTF-32"), "{name}");
    }
}

#[test]
fn a_zero_byte_inside_a_word_is_an_error_and_after_the_text_it_is_none() {
    for (name, text) in SCENES {
        let files = Files::new(&[]);
        files.write(name, text.replacen("34", "3\x004", 1).as_bytes());
        let message = refusal(files.load(name));
        assert!(message.contains("there is a zero byte inside a word"), "{name}: {message}");
        assert!(message.split(':').nth(1).is_some_and(|line| line.parse::<usize>().is_ok()), "{name}: {message}");
        files.write(name, format!("{text}\0\0\0").as_bytes());
        files.load(name).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}
