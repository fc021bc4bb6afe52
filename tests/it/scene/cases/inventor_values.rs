//! Values of Inventor and VRML 1.0 files: strings without quotes, ignored fields, switches and copies.

use super::{Files, SQUARE, TRIANGLE, is_box, load, warns};
use rtbench::scene::Scene;

const POINTS: &str = "Coordinate3 { point [ 0 0 0, 2 0 0, 0 3 0, 2 3 1 ] }\n";
const FACES: &str = "IndexedFaceSet { coordIndex [ 0, 1, 2, -1, 1, 3, 2, -1 ] }\n";

fn iv(text: &str) -> Scene {
    load("a.iv", format!("#Inventor V2.1 ascii\n{text}").as_bytes())
}

#[test]
fn a_switch_that_inherits_leaves_the_number_for_the_next() {
    let short = "Switch { whichChild -2 Group {} Group {} }";
    let long = format!("Switch {{ whichChild -2 {FACES} Group {{ {FACES}{FACES} }} Group {{ {0}{0} }} {FACES} }}", {
        FACES.repeat(2)
    });
    let row = "Array { numElements1 4 separation1 10 0 0";
    let all = [[0.0; 3], [32.0, 3.0, 1.0]];
    is_box("one after another", &iv(&format!("{POINTS}{row} {short} {long} }}")), 16, all);
    let nested = format!("Switch {{ whichChild -2 {short} Group {{ {short} }} }}");
    is_box("nested", &iv(&format!("{POINTS}{row} {nested} {long} }}")), 16, all);
    let matrix = |x: usize| format!("1 0 0 0 0 1 0 0 0 0 1 0 {} 0 0 1", 10 * x);
    let matrices = [0, 1, 2, 3].map(matrix).join(", ");
    let copies = format!("MultipleCopy {{ matrix [ {matrices} ] {short} {long} }}");
    is_box("MultipleCopy", &iv(&format!("{POINTS}{copies}")), 16, all);
    // Another switch with an index of its own replaces the number.
    let own = format!("{row} Switch {{ whichChild 1 Group {{}} Group {{}} }} {long} }}");
    is_box("own index", &iv(&format!("{POINTS}{own}")), 4 * 4, all);
}

#[test]
fn strings_without_quotes_extend_to_white_space() {
    for name in [
        "tex(1).rgb",
        "a#b.rgb",
        "http://h/t#x",
        "http://h/t.cgi?a=1&b=2",
        "a=b.rgb",
        "a,b.rgb",
        "a|b.rgb",
        "[a].rgb",
        "a[1].rgb",
        "(a).rgb",
        r"C:\t(1)\a.rgb",
        "tex{1}.rgb",
        "TEX~1.RGB",
        "a\"b.rgb",
    ] {
        for node in [
            format!("Texture2 {{ filename {name} }}"),
            format!("Texture2 {{ filename {name}\nwrapS CLAMP }}"),
            format!("Info {{ string {name} }}"),
            format!("WWWAnchor {{ name {name} description {name} }}"),
            format!("Unknown {{ fields [ SFString filename ] filename {name} }}"),
        ] {
            let text = format!("#VRML V1.0 ascii\nSeparator {{ {node}\n{POINTS}{FACES} }}");
            is_box(&text, &load("a.wrl", text.as_bytes()), 2, SQUARE);
        }
    }
    for node in [
        "Texture2 { filename tex.rgb}",
        "Separator { Texture2 { filename tex.rgb}}",
        "Texture2 { filename tex.rgb~ }",
        "Texture2 { filename ~ }",
        "Texture2 { filename [ \"a\" ] }",
        "Texture2 { filename tex.rgb # comment { \"\n }",
        "Text3 { string [\"a]b\", \"c\"] }",
        "Text3 { string [a, b] parts ALL }",
        "AsciiText { string [] }",
        "Info{string a}Info{string b}",
    ] {
        is_box(node, &iv(&format!("{node}\n{POINTS}{FACES}")), 2, SQUARE);
    }
    for name in ["a(1).iv", "a#b.iv", "a=b.iv", "[a].iv", "a{1}.iv"] {
        let files = Files::new(&[("a.iv", &format!("#Inventor V2.1 ascii\nFile {{ name {name} }}\n"))]);
        files.write(name, format!("#Inventor V2.1 ascii\n{POINTS}{FACES}").as_bytes());
        is_box(name, &files.load("a.iv").unwrap_or_else(|error| panic!("{name}: {error}")), 2, SQUARE);
    }
}

#[test]
fn ignored_values_of_face_sets_and_copies_count() {
    let two = [[0.0; 3], [12.0, 3.0, 1.0]];
    let matrix = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1, 1 0 0 0 0 1 0 0 0 0 1 0 10 0 0 1";
    for (text, triangles, bounds) in [
        (format!("{FACES} IndexedFaceSet {{ coordIndex [ 0, 1, 2, -1 ] ~ }}"), 3, SQUARE),
        (FACES.replace("] }", "] ~ }"), 2, SQUARE),
        (FACES.replace("] }", "]~ }"), 2, SQUARE),
        (format!("Array {{ numElements1 2 ~ separation1 10 0 0 {FACES} }}"), 4, two),
        (format!("Array {{ numElements1 2 separation1 10 0 0 ~ {FACES} }}"), 4, two),
        (format!("Array {{ numElements1 2 separation1 10 0 0 origin LAST ~ {FACES} }}"), 4, two),
        (format!("MultipleCopy {{ matrix [ {matrix} ] ~ {FACES} }}"), 4, two),
        ("FaceSet { numVertices [ 3, 3 ] ~ }".replace("3, 3", "3"), 1, TRIANGLE),
        ("TriangleStripSet { numVertices [ 3 ] ~ }".into(), 1, TRIANGLE),
        ("IndexedTriangleStripSet { coordIndex [ 0, 1, 2, 3 ] ~ }".into(), 2, SQUARE),
        ("QuadMesh { verticesPerColumn 2 ~ verticesPerRow 2 ~ }".into(), 2, SQUARE),
    ] {
        is_box(&text, &iv(&format!("{POINTS}{text}")), triangles, bounds);
    }
    let six = POINTS.replace("] }", ", 0 0 0, 2 0 0, 0 3 0 ] }").replace(", 2 3 1", "");
    is_box("FaceSet", &iv(&format!("{six}FaceSet {{ numVertices [ 3, 3 ] ~ }}")), 2, TRIANGLE);
    for node in ["Cube { width 9 ~ }", "Switch { whichChild 0 ~ Cube {} } Cube {}"] {
        is_box(node, &iv(node), 12, [[-1.0; 3], [1.0; 3]]);
    }
}

#[test]
fn strings_instead_of_indices_are_warnings() {
    for (setup, field, warning) in [
        ("MaterialBinding { value PER_FACE_INDEXED }", "materialIndex [ 0 \"x\" ]", "materialIndex: NaN"),
        ("MaterialBinding { value PER_FACE_INDEXED }", "materialIndex \"\"", "materialIndex: NaN"),
        ("Normal { vector 0 0 -1 }", "normalIndex [ \"\" ]", "normals are computed"),
    ] {
        let faces = FACES.replace(" ] }", &format!(" ] {field} }}"));
        let scene = iv(&format!("{setup}{POINTS}{faces}"));
        is_box(field, &scene, 2, SQUARE);
        warns(field, &scene, warning);
    }
}
