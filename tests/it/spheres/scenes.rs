//! Scenes of spheres: what is read, what is refused and how, the schema, random scenes, and mutated files.

use jsonschema::Validator;
use proptest::prelude::*;
use rtbench::Error;
use rtbench::workloads::size::Size;
use rtbench::workloads::spheres::scene::{NAMES, Scene, schema};
use rtbench::workloads::spheres::view::View;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Set to write the schema anew.
const RENEW: &str = "RTBENCH_RENEW_SCHEMA";

fn project(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(file)
}

fn text_of(name: &str) -> String {
    std::fs::read_to_string(project(&format!("scenes/spheres/{name}.json"))).unwrap()
}

/// Reads a text as a file.
fn read(text: impl AsRef<[u8]>) -> Result<Scene, Error> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.json");
    std::fs::write(&path, text).unwrap();
    Scene::load(path.to_str().unwrap())
}

/// The message of a text that is refused, from its line on: it has one line, and exit code 2.
fn refused(text: impl AsRef<[u8]>) -> String {
    let error = read(text).expect_err("the scene must be refused");
    assert_eq!(error.exit_code(), 2);
    let message = error.to_string();
    assert!(!message.contains('\n'), "{message}");
    message.split_once("scene.json").map(|(_, rest)| rest.to_owned()).unwrap_or(message)
}

/// A valid scene with all keys, one per line.
const WHOLE: &str = r#"{
"camera": {
"position": [0, 1, 5.5],
"forward": [0, 0, -1],
"fov": 40,
"focusPoint": [0, 0, 0],
"orbitVelocity": -0.5
},
"lightData": {
"directionalLightDirection": [0, -1, 0],
"directionalLightColor": [1, 1, 1],
"ambientLightColor": [0.1, 0.1, 0.1]
},
"rendering": { "intensity": 0.25, "epsilon": 1e-4 },
"spheres": [
{ "position": [1, 2, 3], "radius": 2, "color": [0.5, 0.25, 1] }
]
}
"#;

fn with(from: &str, to: &str) -> String {
    assert_eq!(WHOLE.matches(from).count(), 1, "{from}");
    WHOLE.replace(from, to)
}

fn validator() -> Validator {
    jsonschema::validator_for(&schema()).unwrap()
}

#[test]
fn a_file_is_read_as_it_says() {
    let scene = read(WHOLE).unwrap();
    assert_eq!(scene.camera.position.to_array(), [0.0, 1.0, 5.5]);
    assert_eq!((scene.camera.fov, scene.camera.orbit_velocity), (40.0, -0.5));
    assert_eq!(scene.light.ambient.to_array(), [0.1; 3]);
    assert_eq!(scene.rendering.intensity, 0.25);
    let sphere = scene.spheres[0];
    assert_eq!(
        (sphere.position.to_array(), sphere.radius, sphere.color.to_array()),
        ([1.0, 2.0, 3.0], 2.0, [0.5, 0.25, 1.0])
    );
    let packed = scene.packed()[0];
    assert_eq!((packed.center.to_array(), packed.radius2), ([1.0, 2.0, 3.0], 4.0));
    // A share of the box's diagonal, which is that of a cube of side 4
    assert!((scene.extent() - 48_f64.sqrt()).abs() < 1e-12);
    assert_eq!(scene.rendering.epsilon, (48_f64.sqrt() * 1e-4) as f32);
    let standard = read(with("\"rendering\": { \"intensity\": 0.25, \"epsilon\": 1e-4 },\n", "")).unwrap();
    assert_eq!((standard.rendering.intensity, standard.rendering.epsilon), (0.5, (48_f64.sqrt() * 5e-5) as f32));
}

#[test]
fn the_hash_is_of_the_numbers() {
    let hash = |text: &str| read(text).unwrap().hash;
    let whole = hash(WHOLE);
    assert_eq!(whole.len(), 64);
    for (from, to) in [("5.5]", "55e-1]"), ("[0, -1, 0]", "[-0.0,\n -1, 0]"), ("\"fov\": 40,\n", "\"fov\":40.0,")] {
        assert_eq!(hash(&with(from, to)), whole, "{from}");
    }
    let mut order: serde_json::Map<String, Value> = serde_json::from_str(WHOLE).unwrap();
    let spheres = order.remove("spheres").unwrap();
    let reordered = format!("{{\"spheres\": {spheres}, {}", &Value::Object(order).to_string()[1..]);
    assert_eq!(hash(&reordered), whole);
    for (from, to) in [
        ("5.5]", "5.25]"),
        ("[0, 0, -1]", "[0, 1, -1]"),
        ("\"fov\": 40", "\"fov\": 41"),
        ("[0, 0, 0]", "[0, 0, 1]"),
        ("-0.5", "0.5"),
        ("[0, -1, 0]", "[0, -2, 0]"),
        ("[1, 1, 1]", "[1, 1, 2]"),
        ("[0.1, 0.1, 0.1]", "[0.1, 0.1, 0]"),
        ("0.25, \"eps", "0.5, \"eps"),
        ("1e-4", "1e-5"),
        ("[1, 2, 3]", "[1, 2, 4]"),
        ("\"radius\": 2", "\"radius\": 3"),
        ("[0.5, 0.25, 1]", "[0.5, 0.5, 1]"),
    ] {
        assert_ne!(hash(&with(from, to)), whole, "{from}");
    }
}

/// What a file says that is refused, as a change of [`WHOLE`]; the line and a part of the message; whether the schema
/// refuses it as well.
const BROKEN: &[(&str, &str, usize, &str, bool)] = &[
    ("\"fov\": 40", "\"fov\": 40, \"fow\": 1", 5, "unknown field `fow`", true),
    ("\"radius\": 2", "\"radius\": 2, \"material\": 1", 16, "unknown field `material`", true),
    ("\"camera\"", "\"kamera\"", 2, "unknown field `kamera`", true),
    ("\"fov\": 40", "\"fov\": 40, \"fov\": 40", 5, "duplicate field `fov`", false),
    ("\"radius\": 2", "\"radius\": 2, \"radius\": 2", 16, "duplicate field `radius`", false),
    ("\"fov\": 40,\n", "", 7, "missing field `fov`", true),
    ("\"fov\": 40", "\"fov\": NaN", 5, "expected value", false),
    ("\"fov\": 40", "\"fov\": Infinity", 5, "expected value", false),
    ("\"fov\": 40", "\"fov\": \"40\"", 5, "camera.fov: invalid type: string", true),
    ("\"fov\": 40", "\"fov\": null", 5, "camera.fov", true),
    ("\"fov\": 40", "\"fov\": 0", 5, "camera.fov: a field of view of 0 degrees is not between 0 and 180", true),
    ("\"fov\": 40", "\"fov\": 180", 5, "180", true),
    ("\"fov\": 40", "\"fov\": -40", 5, "-40", true),
    ("[0, 1, 5.5]", "[0, 1, 1e39]", 3, "camera.position[2]: 1e39 is beyond 1e18", true),
    ("[0, 1, 5.5]", "[0, 1, 1e400]", 3, "number out of range", false),
    ("[0, 1, 5.5]", "[0, 1]", 3, "expected a list of three numbers", true),
    ("[0, 1, 5.5]", "[0, 1, 5.5, 1]", 3, "more than three numbers", true),
    ("[0, 1, 5.5]", "5", 3, "camera.position: invalid type", true),
    ("[0, 0, -1]", "[0, 0, 0]", 4, "camera.forward: the direction is zero", true),
    ("[0, 0, -1]", "[0, 2, 0]", 4, "camera.forward: the direction is vertical", true),
    ("[0, 0, -1]", "[0, -1, -0.0]", 4, "vertical", true),
    ("[0, 0, -1]", "[1e-310, 1e17, 0]", 4, "vertical", false),
    ("[0, 0, 0]", "[0, 0, -1e19]", 6, "camera.focusPoint", true),
    ("-0.5", "1e39", 7, "camera.orbitVelocity: 1e39 is beyond 1e18", true),
    ("[0, -1, 0]", "[0, 0.0, 0]", 10, "lightData.directionalLightDirection: the direction is zero", true),
    ("[1, 1, 1]", "[1, -1, 1]", 11, "-1e0 is negative", true),
    ("[0.1, 0.1, 0.1]", "[0.1, 0.1, -0.1]", 12, "lightData.ambientLightColor", true),
    ("0.25, \"eps", "1.5, \"eps", 14, "rendering.intensity: 1.5e0 is not 0 to 1", true),
    ("1e-4", "-1e-4", 14, "rendering.epsilon", true),
    ("{ \"intensity\": 0.25, \"epsilon\": 1e-4 }", "null", 14, "rendering", true),
    ("{ \"intensity\": 0.25, \"epsilon\": 1e-4 }", "[0.25, 1e-4]", 14, "expected an object", true),
    ("\"radius\": 2", "\"radius\": 0", 16, "spheres[0].radius", true),
    ("\"radius\": 2", "\"radius\": -2", 16, "a radius of -2e0 is not between", true),
    ("\"radius\": 2", "\"radius\": 1e-20", 16, "a radius of 1e-20", true),
    ("\"radius\": 2", "\"radius\": 1e19", 16, "a radius of 1e19 is not between", true),
    ("[0.5, 0.25, 1]", "[0.5, 0.25, 1.01]", 16, "spheres[0].color[2]: 1.01e0 is not 0 to 1", true),
    ("[0.5, 0.25, 1]", "[0.5, -0.25, 1]", 16, "spheres[0].color", true),
    ("{ \"position\": [1, 2, 3], \"radius\": 2, \"color\": [0.5, 0.25, 1] }\n", "", 16, "there are no spheres", true),
    (
        "{ \"position\": [1, 2, 3], \"radius\": 2, \"color\": [0.5, 0.25, 1] }\n",
        "[[1, 2, 3], 2, [0.5, 0.25, 1]]\n",
        16,
        "expected an object",
        true,
    ),
];

#[test]
fn what_is_wrong_is_named_with_its_line() {
    for (from, to, line, part, _) in BROKEN {
        let message = refused(with(from, to));
        assert!(message.starts_with(&format!(":{line}: ")) && message.contains(part), "{to}: {message}");
    }
    // Of files as a whole
    for (text, part) in [
        (b"".as_slice(), ": the file is empty"),
        (b"\n\n", ":3: EOF while parsing"),
        (b"[]", ":1: invalid type: sequence, expected an object"),
        (b"3", ":1: invalid type: integer `3`"),
        (b"{\n\xff", ":2: the file is not UTF-8"),
        (b"{}\n", ":1: missing field `camera`"),
    ] {
        let message = refused(text);
        assert!(message.starts_with(part), "{part}: {message}");
    }
    assert!(refused(format!("{WHOLE}{{}}")).starts_with(":19: trailing characters"));
    // Names that are not one line are shown as one
    assert!(refused(with("\"fov\": 40", "\"fo\\nv\": 40")).contains("unknown field `fov`"));
    assert!(refused(with("\"fov\": 40", &format!("\"{}\": 40", "x".repeat(1 << 20)))).len() < 600);
}

#[test]
fn large_files_and_deep_ones_are_refused() {
    let sphere = "{\"position\":[0,0,0],\"radius\":1,\"color\":[1,1,1]}";
    let all = |count: usize| {
        let spheres = vec![sphere; count].join(",");
        with("{ \"position\": [1, 2, 3], \"radius\": 2, \"color\": [0.5, 0.25, 1] }", &spheres)
    };
    assert_eq!(read(all(100_000)).unwrap().spheres.len(), 100_000);
    let message = refused(all(100_001));
    assert!(message.starts_with(":1") && message.contains("there are more than 100000 spheres"), "{message}");
    for deep in ["[", "{\"a\":", "{\"camera\":", "[[0,"] {
        refused(deep.repeat(200_000));
        refused(with("[0, 1, 5.5]", &deep.repeat(200_000)));
        refused(with("\"fov\": 40", &format!("\"fow\": {}", deep.repeat(200_000))));
    }
    let mut large = WHOLE.to_owned();
    large.extend(std::iter::repeat_n(' ', 64 << 20));
    assert!(refused(large).starts_with(": the file has more than 64 MiB"));
    let folder = tempfile::tempdir().unwrap();
    let message = Scene::load(folder.path().to_str().unwrap()).unwrap_err().to_string();
    assert!(message.contains("not a regular file"), "{message}");
}

#[test]
fn the_schema_agrees_with_the_reader() {
    let path = project("docs/schema/spheres-scene.schema.json");
    let text = serde_json::to_string_pretty(&schema()).unwrap() + "\n";
    if std::env::var_os(RENEW).is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    let hint = format!("renew it: {RENEW}=1 cargo test --release --test it spheres::scenes");
    assert!(std::fs::read_to_string(path).unwrap_or_default() == text, "the schema is not what the types give; {hint}");
    assert!(jsonschema::meta::is_valid(&schema()));
    let validator = validator();
    let fits = |text: &str| validator.is_valid(&serde_json::from_str(text).unwrap());
    for name in NAMES {
        assert!(fits(&text_of(name)), "{name}");
        assert_eq!(read(text_of(name)).unwrap().hash, Scene::load(name).unwrap().hash);
    }
    assert!(fits(WHOLE));
    for (from, to, _, _, refuses) in BROKEN {
        let text = with(from, to);
        if *refuses {
            assert!(!fits(&text), "the schema accepts {to}");
        }
    }
    // What both accept
    for (from, to) in [
        ("{ \"intensity\": 0.25, \"epsilon\": 1e-4 }", "{}"),
        ("[0, 0, -1]", "[1e-9, 1, 0]"),
        ("[0, 0, -1]", "[0, 1, 1e-9]"),
        ("-0.5", "0"),
        ("[0.5, 0.25, 1]", "[0, 0, 0]"),
        ("1e-4", "0"),
        ("\"radius\": 2", "\"radius\": 1e18"),
        ("\"fov\": 40", "\"fov\": 179.99"),
    ] {
        assert!(fits(&with(from, to)), "the schema refuses {to}");
        read(with(from, to)).unwrap_or_else(|error| panic!("{to}: {error}"));
    }
}

#[test]
fn names_are_those_of_scenes_or_of_files() {
    let counts = NAMES.map(|name| {
        let scene = Scene::load(name).unwrap();
        assert_eq!(scene.name, name);
        assert!((15.0..25.0).contains(&scene.extent()), "{name}: {}", scene.extent());
        scene.spheres.len()
    });
    assert_eq!(counts, [3, 20, 100]);
    let scene = Scene::load("random:seed=7,spheres=5").unwrap();
    assert_eq!((scene.name.as_str(), scene.spheres.len()), ("random:spheres=5,seed=7", 5));
    assert_eq!(Scene::load("random:spheres=5").unwrap().name, "random:spheres=5,seed=1");
    for (name, part) in [
        ("defualt", "no file and no scene of spheres is called `defualt` (did you mean default?"),
        ("randm20", "did you mean random20?"),
        ("", "there are: default, random20, random100, random; or name a file"),
        ("no/such.json", "no/such.json: no such file"),
        ("none.json", "none.json: no such file"),
        ("random:", "`` is not of the form key=value"),
        ("random:seed=1", "the number of spheres is missing"),
        ("random:spheres=0", "spheres=0 is out of range (a scene has 1 to 100000 spheres)"),
        ("random:spheres=100001", "out of range"),
        ("random:spheres=-1", "`-1` is not such a whole number"),
        ("random:spheres=1e3", "`1e3`"),
        ("random:spheres=9,spheres=9", "spheres is given twice"),
        ("random:spheres=9,sed=1", "did you mean seed?"),
        ("random:spheres=9,seed=18446744073709551616", "seed: `18446744073709551616`"),
        ("random:spheres", "`spheres` is not of the form key=value"),
    ] {
        let message = Scene::load(name).unwrap_err().to_string();
        assert!(message.contains(part) && !message.contains('\n'), "{name}: {message}");
    }
}

/// Seeds of the random scenes that are files.
const SEEDS: [(&str, &str); 2] = [("random20", "random:spheres=20,seed=1"), ("random100", "random:spheres=100,seed=1")];

#[test]
fn random_scenes_are_the_same_everywhere() {
    for (name, spec) in SEEDS {
        let random = Scene::load(spec).unwrap();
        assert_eq!(Scene::load(name).unwrap().hash, random.hash, "{name}");
    }
    let specs = [
        "random:spheres=20,seed=1",
        "random:spheres=100,seed=1",
        "random:spheres=1,seed=0",
        "random:spheres=100000,seed=18446744073709551615",
    ];
    let hashes = specs.map(|spec| Scene::load(spec).unwrap().hash[..16].to_owned());
    assert_eq!(hashes, ["1f79a31a5d187cb8", "7388cd300126680e", "a2e744e244a790de", "bee85585f339f477"]);
}

#[test]
fn spheres_of_random_scenes_do_not_meet() {
    for spec in ["random:spheres=100,seed=1", "random:spheres=300,seed=5"] {
        let spheres = Scene::load(spec).unwrap().spheres;
        for (index, a) in spheres.iter().enumerate() {
            assert!(spheres[..index].iter().all(|b| a.position.distance(b.position) > a.radius + b.radius - 1e-5));
        }
    }
}

#[test]
fn files_survive_every_mutation() {
    let text = text_of("default");
    let mut accepted = 0;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.json");
    let load = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        Scene::load(path.to_str().unwrap())
    };
    let mut check = |bytes: &[u8]| match load(bytes) {
        Ok(scene) => {
            accepted += 1;
            View::of(&scene, Size { width: 3, height: 2 }, 5, 1, 3);
        }
        Err(error) => {
            assert!(matches!(error, Error::Input(_)), "{error:?}");
            assert!(!error.to_string().contains('\n'), "{error}");
        }
    };
    for text in [text.as_str(), WHOLE] {
        for at in 0..text.len() {
            let mut bytes = text.as_bytes().to_vec();
            for byte in [b'-', b'9', b'e', b'"', b'}', 0xff] {
                bytes[at] = byte;
                check(&bytes);
            }
            check(&text.as_bytes()[..at]);
            check(&[&text.as_bytes()[..at], &text.as_bytes()[at + 1..]].concat());
        }
        // Each number by an extreme one
        let ends: Vec<usize> = (0..text.len()).filter(|&i| text.as_bytes()[i].is_ascii_digit()).collect();
        for at in ends {
            for number in ["-0", "1e-320", "1e18", "-1e18", "1e39", "1e400", "1e-45", "1e999999999999", "0x1"] {
                check(format!("{}{number}{}", &text[..at], &text[at + 1..]).as_bytes());
            }
        }
    }
    assert!(accepted > 100, "{accepted}");
}

proptest! {
    #[test]
    fn any_numbers_give_a_view_without_nan(
        position in prop::array::uniform3(-1e18..1e18),
        forward in prop::array::uniform3(prop_oneof![-1.0..1.0, -1e18..1e18, -1e-300..1e-300, Just(0.0)]),
        fov in prop_oneof![1e-300..1e-3, 1e-3..179.0, Just(179.999_999_999_999_97)],
        (width, height) in prop_oneof![Just((1, 1)), Just((67_108_864, 1)), Just((1, 67_108_864)), (1..500_u32, 1..500_u32)],
        frame in 0..9_usize,
    ) {
        let text = with("[0, 1, 5.5]", &json!(position).to_string());
        let text = text.replace("[0, 0, -1]", &json!(forward).to_string()).replace(": 40", &format!(": {fov:e}"));
        let Ok(scene) = read(text) else { return Ok(()) };
        let view = View::of(&scene, Size { width, height }, 5, frame, 7);
        for x in [view.origin, view.corner, view.right, view.down, view.light].iter().flat_map(|v| v.to_array()) {
            prop_assert!(x.is_finite());
        }
        let end = view.corner + view.right * width as f32 + view.down * height as f32;
        prop_assert!(end.length_squared().is_finite() && view.corner.length_squared().is_finite());
    }
}
