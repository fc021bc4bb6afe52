//! File names of all kinds, and files that a command must not write over.

use crate::support::csv_rows;
use proptest::prelude::*;
use rtbench::harness::measure;
use rtbench::record::files;
use rtbench::record::journal::{FILE_NAME, Journal};
use rtbench::record::row::{Samples, TimingSource};
use rtbench::{guard, names};
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const PROGRAM: &str = env!("CARGO_BIN_EXE_rtbench");

/// Two triangles in front of the origin.
const MESH: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";

/// Arguments of a small sweep without a scene.
const TINY: &[&str] = &[
    "sweep",
    "--backend",
    "cpu",
    "--frames",
    "1",
    "--passes",
    "1",
    "--resolution",
    "16",
    "--config",
    "P",
    "--structure",
    "bvh-stack",
];

fn program(folder: &Path) -> Command {
    let mut command = Command::new(PROGRAM);
    command.current_dir(folder).env_remove("RTBENCH_SCENES");
    command
}

#[track_caller]
fn ends_with(output: &Output, code: i32) -> String {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(code) && !text.contains("panicked"), "{:?} {text}", output.status);
    text
}

#[test]
fn names_of_files_are_read_back_to_the_same_bytes() {
    for (name, text) in [("a b.ply", "a b.ply"), ("100%.ply", "100%.ply"), ("%FF%41", "%25FF%41"), ("%25", "%2525")] {
        assert_eq!(names::text(OsStr::new(name)), text);
        assert_eq!(names::file(text), PathBuf::from(name));
    }
}

#[cfg(unix)]
proptest! {
    #[test]
    fn any_bytes_are_a_name(bytes in proptest::collection::vec(prop_oneof![Just(b'%'), Just(b'F'), Just(b'2'), Just(b'5'), any::<u8>()], 0..24)) {
        use std::os::unix::ffi::OsStrExt;
        let name = OsStr::from_bytes(&bytes);
        prop_assert_eq!(names::file(&names::text(name)), PathBuf::from(name));
    }
}

#[test]
fn a_scene_s_name_depends_on_its_path_alone() {
    let of = |path: &str| names::of_file(Path::new(path));
    assert_eq!(of("scene.gltf"), "scene.gltf");
    assert_eq!(of("./car/scene.gltf"), "car/scene.gltf");
    let paths = [
        "scene.gltf",
        "Scene.gltf",
        "scene.glb",
        "car/scene.gltf",
        "truck/scene.gltf",
        "a/car/scene.gltf",
        "b/car/scene.gltf",
        "/b/car/scene.gltf",
        "../scene.gltf",
        "/scene.gltf",
        "../../scene.gltf",
    ];
    let all: BTreeSet<String> = paths.iter().map(|path| of(path)).collect();
    assert_eq!(all.len(), paths.len(), "{all:?}");
    for name in &all {
        assert_eq!(names::stem(name).to_lowercase(), "scene", "{name}");
        assert_eq!(names::stem(&format!("{name}:scale=2.5")).to_lowercase(), "scene", "{name}");
    }
    assert_eq!((names::stem("hall"), names::stem("scan:triangles=1000")), ("hall", "scan"));
    assert_eq!(names::stem("conference-obj"), "conference-obj");
}

#[test]
fn output_files_of_different_names_are_different() {
    let long = "x".repeat(90);
    let names: Vec<String> = ["hall", "Hall", "hall:", "hall?", "a/b", "a-b", "a\\b", ".a", "a", "a.", "", "-"]
        .map(str::to_owned)
        .into_iter()
        .chain([format!("{long}1"), format!("{long}2"), "\u{fc}".repeat(90)])
        .collect();
    let slugs: BTreeSet<String> = names.iter().map(|name| names::distinct_slug(name).to_lowercase()).collect();
    assert_eq!(slugs.len(), names.len(), "{slugs:?}");
    assert!(slugs.iter().all(|slug| slug.len() < 200 && !slug.contains(['/', '\\', ':']) && !slug.starts_with('.')));
    assert_eq!(names::distinct_slug("hall"), "hall");
}

#[test]
fn what_was_read_is_not_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for name in ["read", "other"] {
        std::fs::write(path(name), name).unwrap();
    }
    guard::read(&path("read"));
    guard::read(&path("absent"));
    guard::check_output(&path("other")).unwrap();
    guard::check_output(&path("absent")).unwrap();
    let mut same = vec![path("read"), folder.path().join("./read")];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(path("read"), path("link")).unwrap();
        std::fs::hard_link(path("read"), path("hard")).unwrap();
        same.extend([path("link"), path("hard")]);
    }
    for out in &same {
        let error = files::replace(out, b"new").unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains("the same file as"), "{error}");
        assert_eq!(std::fs::read_to_string(path("read")).unwrap(), "read");
    }
    // Another file of this name was not read
    std::fs::rename(path("other"), path("read")).unwrap();
    files::replace(&path("read"), b"new").unwrap();
}

#[test]
fn no_command_writes_over_its_inputs() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let rays = "origin_x,origin_y,origin_z,direction_x,direction_y,direction_z\n0.5,0.25,1,0,0,-1\n";
    let camera = "kind = \"orbit\"\nframes = 4\n";
    let inputs = [("mesh.obj", MESH), ("rays.csv", rays), ("path.toml", camera)];
    let run = |arguments: &str| program(folder.path()).args(arguments.split(' ')).output().unwrap();
    inputs.iter().for_each(|(name, text)| std::fs::write(path(name), text).unwrap());
    ends_with(&run("scenes convert mesh.obj mesh.rtb"), 0);
    let sweep = program(folder.path()).args(TINY).args(["--scene", "mesh.obj", "--out", "run"]).output().unwrap();
    ends_with(&sweep, 0);
    #[cfg(unix)]
    for name in ["mesh.obj", "path.toml", "rays.csv"] {
        std::os::unix::fs::symlink(path(name), path(&format!("link-{name}"))).unwrap();
        std::fs::hard_link(path(name), path(&format!("hard-{name}"))).unwrap();
    }
    let inputs = [
        ("mesh.obj", MESH.into()),
        ("rays.csv", rays.into()),
        ("path.toml", camera.into()),
        ("mesh.rtb", std::fs::read(path("mesh.rtb")).unwrap()),
        ("run/journal.jsonl", std::fs::read(path("run/journal.jsonl")).unwrap()),
    ];
    let inputs: Vec<(&str, Vec<u8>)> = inputs.into_iter().collect();
    for command in [
        "render --scene mesh.obj --backend cpu --resolution 16 -o mesh.obj",
        "render --scene mesh.obj --backend cpu --resolution 16 -o link-mesh.obj",
        "render --scene mesh.obj --backend cpu --resolution 16 -o hard-mesh.obj",
        "render --scene mesh.obj --camera-path path.toml --backend cpu --resolution 16 -o path.toml",
        "render --scene mesh.obj --camera-path path.toml --backend cpu --resolution 16 -o hard-path.toml",
        "build --scene mesh.obj --csv mesh.obj",
        "build --scene mesh.obj --csv link-mesh.obj",
        "trace --scene mesh.obj --rays rays.csv --backend cpu -o rays.csv",
        "trace --scene mesh.obj --rays rays.csv --backend cpu -o hard-rays.csv",
        "trace --scene mesh.obj --rays rays.csv --backend cpu -o mesh.obj",
        "camera-path export mesh.obj -o mesh.obj",
        "camera-path export mesh.obj --camera-path path.toml -o link-path.toml",
        "scenes convert mesh.rtb mesh.rtb",
        "report run -o run/journal.jsonl",
        "tables run -o run/journal.jsonl",
    ] {
        let text = ends_with(&run(command), 2);
        assert!(text.contains("the same file as") && text.contains("write to another file"), "{command}: {text}");
        for (name, content) in &inputs {
            assert_eq!(&std::fs::read(path(name)).unwrap(), content, "{command} changed {name}");
        }
    }
}

/// Scenes of one stem, and names that differ only in case: rows, pictures and resumed rows are apart.
#[test]
fn scenes_of_one_stem_are_apart() {
    let folder = tempfile::tempdir().unwrap();
    let scenes = ["car/scene.obj", "truck/scene.obj", "Truck/scene.obj", "deep/car/scene.obj", "scene.obj"];
    for (index, name) in scenes.iter().enumerate() {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, MESH.replace("v 1 1 0", &format!("v 1 1.{index} 0"))).unwrap();
    }
    let mut sweep = program(folder.path());
    sweep.args(TINY).args(["--out", "run"]);
    scenes.iter().for_each(|scene| _ = sweep.args(["--scene", scene]));
    ends_with(&sweep.output().unwrap(), 0);
    let run = folder.path().join("run");
    let names = || csv_rows(&run.join("summary.csv")).iter().map(|row| row["scene"].clone()).collect::<BTreeSet<_>>();
    assert_eq!(names().len(), scenes.len(), "{:?}", names());
    assert_eq!(std::fs::read_dir(run.join("pictures")).unwrap().count(), 2 * scenes.len());
    // The last row again
    let journal = run.join(FILE_NAME);
    let text = std::fs::read_to_string(&journal).unwrap();
    let last =
        text.rmatch_indices("{\"row\"").next().map_or_else(|| text.rfind("\"structure\"").unwrap(), |(at, _)| at);
    let cut = text[..last].rfind('\n').unwrap() + 1;
    std::fs::write(&journal, &text[..cut]).unwrap();
    let before = Journal::read(&journal).unwrap().rows.len();
    assert!(before < scenes.len());
    ends_with(&program(folder.path()).args(["sweep", "--resume", "run"]).output().unwrap(), 0);
    assert_eq!(names().len(), scenes.len());
    assert_eq!(Journal::read(&journal).unwrap().rows.len(), scenes.len());
}

#[cfg(unix)]
#[test]
fn names_that_are_not_utf_8_are_measured_and_resumed() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let name = OsStr::from_bytes(b"caf\xe9%FF.obj");
    std::fs::write(folder.path().join(name), MESH).unwrap();
    let library = Command::new(PROGRAM).current_dir(folder.path()).args(["scenes", "info"]).arg(name).output().unwrap();
    ends_with(&library, 0);
    let sweep = program(folder.path()).args(TINY).arg("--scene").arg(name).args(["--out", "run"]).output().unwrap();
    ends_with(&sweep, 0);
    let journal = folder.path().join("run").join(FILE_NAME);
    let rows = || Journal::read(&journal).unwrap().rows;
    assert_eq!(rows()[0].key.axis("scene"), "caf%E9%25FF.obj");
    let text = std::fs::read_to_string(&journal).unwrap();
    // Without its rows the run has to find the file again
    let lines: Vec<&str> = text.lines().take(2).collect();
    std::fs::write(&journal, lines.join("\n") + "\n").unwrap();
    assert!(rows().is_empty());
    ends_with(&program(folder.path()).args(["sweep", "--resume", "run"]).output().unwrap(), 0);
    assert_eq!(rows().len(), 1);
    let missing =
        program(folder.path()).args(TINY).arg("--scene").arg(OsStr::from_bytes(b"\xff.obj")).output().unwrap();
    assert!(ends_with(&missing, 2).contains("%FF.obj: no such file"));
}

#[test]
fn runs_begun_in_the_same_second_have_folders_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("results/time-device");
    let made: Vec<PathBuf> = (0..3).map(|_| files::create_numbered_folder(&path).unwrap()).collect();
    let names: Vec<_> = made.iter().map(|p| p.file_name().unwrap().to_str().unwrap()).collect();
    assert_eq!(names, ["time-device", "time-device-2", "time-device-3"]);
    let sweeps: Vec<_> = (0..2)
        .map(|_| program(folder.path()).args(TINY).args(["--scene", "scan:triangles=1000"]).spawn().unwrap())
        .collect();
    for mut sweep in sweeps {
        assert!(sweep.wait().unwrap().success());
    }
    let runs = std::fs::read_dir(folder.path().join("results")).unwrap();
    let whole = runs.filter(|run| run.as_ref().unwrap().path().join("summary.csv").is_file()).count();
    assert_eq!(whole, 2);
}

/// The limit of a file's size ends a run like a full disk: with a message, and not by a signal.
#[cfg(target_os = "linux")]
#[test]
fn a_file_size_limit_is_an_error_of_the_write() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = TINY.join(" ");
    let line = format!("ulimit -f 1; exec {PROGRAM} {arguments} --scene scan:triangles=1000 --out run");
    let output = Command::new("bash").current_dir(folder.path()).args(["-c", &line]).output().unwrap();
    let text = ends_with(&output, 2);
    assert!(text.contains("cannot write"), "{text}");
}

#[test]
fn a_clock_that_stands_still_is_a_warning() {
    let samples = |device: Option<Vec<u64>>, wall: Vec<u64>| Samples {
        pass_ns: vec![1000],
        device_ns: device.map(|d| vec![d]),
        wall_ns: vec![wall],
        ..Samples::default()
    };
    let (source, warnings) = measure::choose_source(&samples(None, vec![0, 5, 0]));
    assert_eq!(source, TimingSource::Wall);
    assert!(warnings[0].contains("did not advance in 2 of 3 frames"), "{warnings:?}");
    let (_, warnings) = measure::choose_source(&samples(Some(vec![0, 0]), vec![0, 0]));
    assert!(warnings.iter().any(|warning| warning.contains("did not advance in 2 of 2")), "{warnings:?}");
    assert_eq!(measure::choose_source(&samples(None, vec![5, 5])).1, Vec::<String>::new());
}

/// A camera that looks past the scene, one in a surface, and lights and cameras that cannot be used.
#[test]
fn useless_cameras_and_lights_are_said() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("mesh.obj"), MESH).unwrap();
    let walk = |from: &str, direction: &str, more: &str| {
        let key = |time| format!("[[keys]]\ntime = {time}\nposition = [{from}]\ndirection = [{direction}]\n");
        format!("kind = \"walk\"\nframes = 2\n{}{}{more}", key(0), key(1))
    };
    let light = "[[lights]]\nposition = [1e18, 0, 0]\n";
    let small = MESH.replace(" 1 0\nv", " 1e-15 0\nv").replace("v 1 ", "v 1e-15 ").replace("v 0 1 ", "v 0 1e-15 ");
    std::fs::write(folder.path().join("small.obj"), small).unwrap();
    for (scene, path, code, words) in [
        ("mesh.obj", walk("0.5, 0.5, 3", "0, 0, 1", ""), 0, "no primary ray hits the scene in 1 of 1 frames"),
        ("mesh.obj", walk("0.5, 0.5, 1e-7", "0, 0, -1", ""), 0, "every primary ray hits a surface directly"),
        ("mesh.obj", walk("0.5, 0.5, 3", "0, 0, -1", ""), 0, ""),
        ("small.obj", walk("0.5e-15, 0.5e-15, 3e-15", "0, 0, -1", light), 2, "light 0 is too far away"),
        ("mesh.obj", walk("0.5, 0.5, 3", "0, 0, 0", ""), 2, "path.toml:6: direction is zero"),
    ] {
        std::fs::write(folder.path().join("path.toml"), &path).unwrap();
        let out = format!("run-{}", std::fs::read_dir(folder.path()).unwrap().count());
        let arguments = ["--scene", scene, "--camera-path", "path.toml", "--out", &out];
        let output = program(folder.path()).args(TINY).args(arguments).output().unwrap();
        let all = ends_with(&output, code) + &String::from_utf8_lossy(&output.stdout);
        assert!(all.contains(words), "{path}: {all}");
        assert_eq!(all.contains("warning: "), code == 0 && !words.is_empty(), "{all}");
    }
}
