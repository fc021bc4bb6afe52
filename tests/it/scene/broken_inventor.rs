//! Tests of invalid Open Inventor files and of other languages: each gives one line of error.

use super::inventor::{HEADER, POINTS};
use super::{Files, refusal};

#[test]
fn each_error_has_its_line() {
    // Every node contains the previous one twice: 2^40 cubes.
    let doubling: String = (1..40).map(|i| format!("DEF n{i} Group {{ USE n{} USE n{} }}\n", i - 1, i - 1)).collect();
    let chain: String = (1..400).map(|i| format!("DEF n{i} Group {{ USE n{} }}\n", i - 1)).collect();
    for (text, words) in [
        ("", "there is no triangle"),
        ("Text3 {}", "there is no triangle: Text3 ignored"),
        ("Separator {", "main.iv:2: the Separator that begins here has no `}`"),
        ("Separator {\nCube {\n", ":3: the Cube that begins here has no `}`"),
        ("Cube {} }", ":2: `}` is not the start of a node"),
        ("Cube", "the file ends within a node"),
        ("Cube [", "`Cube` has no `{`"),
        ("Cube {\n5 }", ":3: `5` is not the start of a field or a node"),
        ("Cube {\nSphere {} }", ":3: a Cube cannot contain nodes"),
        ("Cube { width }", "width: `}` is not a value"),
        ("Cube {\n\nwidth wide }", ":4: width: `wide` is not a number"),
        ("Cube { width 1 2 }", "width: needs 1 numbers"),
        ("Cube { width 1e999 }", "width: `1e999` is not a finite number"),
        ("Cube { width 1e99 }", "is not finite in single precision"),
        ("Cube { width 1..2 }", "`1..2` is not a finite number"),
        ("USE nothing", ":2: USE `nothing`: the name is not defined"),
        ("DEF a Group { USE a }", "USE `a`: the name is not defined"),
        ("\nCoordinate3 {\npoint [ 0 0 0, 1 0 ] }", ":4: point: 5 numbers are not a multiple of 3"),
        ("IndexedFaceSet { coordIndex [ 0, 1, 2 ] }", "there are no coordinates"),
        ("POINTS\nIndexedFaceSet {\ncoordIndex [ 0, 1, 5 ] }", ":4: coordIndex: index 5 is out of range (give 0 to 4)"),
        ("POINTS IndexedFaceSet { coordIndex [ 0, 1, 2.5 ] }", "index 2.5 is out of range"),
        ("POINTS FaceSet { numVertices [ 3, 3 ] }", "6 coordinates are needed, but there are 5"),
        ("POINTS FaceSet { startIndex -1 }", "startIndex: -1 is negative"),
        ("POINTS QuadMesh { verticesPerColumn 1000000000 verticesPerRow 1000000000 }", "coordinates are needed"),
        ("MaterialBinding { value PER_MOON }", "value: `PER_MOON` is not one of its values"),
        ("RotationXYZ { axis W }", "axis: `W` is not an axis"),
        ("Units { units CUBITS }", "`CUBITS` is not a unit"),
        ("MatrixTransform { matrix 1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1 }", "matrix: the fourth column"),
        ("Switch { whichChild .5 }", "whichChild: 0.5 is not a whole number"),
        ("PointLight { on PERHAPS }", "on: give TRUE or FALSE"),
        ("FaceSet { vertexProperty Cube {} }", "vertexProperty: the node has another type"),
        ("FaceSet { vertexProperty 3 }", "vertexProperty: a node is needed"),
        ("Scale { scaleFactor 1e30 1e30 1e30 } Cube {}", "main.iv"),
        ("DOUBLING USE n39", "more than 64 MiB"),
        ("DEF n0 Group {} DOUBLINGUSE n39", "nested copies repeat too many values"),
        ("DEF n0 Group {} CHAIN", "nodes are nested more than"),
        ("Array { numElements1 1000000000 numElements2 1000000000 }", "nested copies repeat too many values"),
        ("NESTED", "nodes are nested more than"),
    ] {
        let whole = text
            .replace("DOUBLING USE", &format!("DEF n0 Cube {{}}\n{doubling} USE"))
            .replace("DOUBLING", &doubling)
            .replace("CHAIN", &chain)
            .replace("POINTS", POINTS.trim_end())
            .replace("NESTED", &"Separator {".repeat(100_000));
        let files = Files::new(&[("main.iv", &format!("{HEADER}{whole}"))]);
        let message = refusal(files.load("main.iv:memory=64M"));
        assert!(message.contains(words), "{text:?}: {message}");
    }
}

#[test]
fn other_languages_are_refused_with_a_hint() {
    for (bytes, words) in [
        (&b"#Inventor V2.1 binary  \n\0\0\0"[..], "ivcat -o out.iv in.iv"),
        (b"#VRML V2.0 utf8\nShape {}", "MeshLab"),
        (b"\x1f\x8b\x08\0\0", "gunzip it first"),
        (b"Separator { Cube {} }", "the first line must be `#Inventor V2.1 ascii`"),
        (b"", "is not a header"),
        (b"\xff\xfe#\0I\0", "is not a header"),
    ] {
        let files = Files::new(&[]);
        files.write("main.wrl", bytes);
        let message = refusal(files.load("main.wrl"));
        assert!(message.contains("main.wrl:1: ") && message.contains(words), "{message}");
    }
}

#[test]
fn line_ends_encodings_and_missing_last_line_ends_do_not_matter() {
    let text = format!("{HEADER}Info {{ string \"caf\u{e9}\" }}\nSeparator {{\n\tCube {{ }} # \u{fc}ber\n}}\n");
    let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
    for bytes in [
        text.clone().into_bytes(),
        text.replace('\n', "\r\n").into_bytes(),
        text.replace('\n', "\r").into_bytes(),
        text.trim_end().as_bytes().to_vec(),
        latin,
    ] {
        let files = Files::new(&[]);
        files.write("main.iv", &bytes);
        assert_eq!(files.load("main.iv").unwrap().triangles.len(), 12, "{}", String::from_utf8_lossy(&bytes));
    }
    let files = Files::new(&[("main.iv", &format!("{HEADER}\n\nCube {{\n").replace('\n', "\r\n"))]);
    assert!(refusal(files.load("main.iv")).contains("main.iv:4: "));
}
