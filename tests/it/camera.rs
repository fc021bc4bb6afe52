//! Tests of camera paths: files, selection of frames, fitting, errors.

use crate::support::file_below;
use glam::Vec3;
use rtbench::camera::{CameraPath, View, names, to_csv, to_toml};
use rtbench::math::{Ray, T_MAX};
use rtbench::scene::{self, Pose, Scene, SceneCamera};
use rtbench::workloads::trace::backend::Config;
use rtbench::workloads::trace::intersect::watertight::intersect;
use std::process::Command;

fn small(name: &str) -> Scene {
    let info = *scene::list().iter().find(|info| info.name == name).unwrap();
    scene::load(&format!("{name}:triangles={}", info.parameters[0].min)).unwrap()
}

/// Loads a path file with this text.
fn from_text(text: &str) -> rtbench::Result<CameraPath> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("path.toml");
    std::fs::write(&file, text).unwrap();
    CameraPath::load(file.to_str().unwrap())
}

const WALK: &str = "kind = \"walk\"
frames = 10
[[keys]]
time = 0
position = [0, 0, 5]
target = [0, 0, 0]
[[keys]]
time = 1
position = [5, 0, 0]
target = [0, 0, 0]
";

#[test]
fn every_embedded_path_is_valid_and_has_400_frames_as_in_the_thesis() {
    for name in names() {
        let path = CameraPath::load(name).unwrap();
        assert_eq!((path.name.as_str(), path.frames), (name, 400));
        assert_eq!(path.content_hash().len(), 64);
        let scene = if scene::list().iter().any(|info| info.name == name) { small(name) } else { small("scan") };
        let views = path.views(&scene, None).unwrap();
        assert_eq!(views.len(), 400, "{name}");
        for View { camera, lights } in &views {
            assert!(camera.direction.is_normalized() && camera.position.is_finite(), "{name}");
            assert!(!lights.is_empty(), "{name}");
        }
    }
}

#[test]
fn every_built_in_scene_has_its_default_path() {
    for info in scene::list() {
        let scene = small(info.name);
        let p = CameraPath::for_scene(&scene, Config::P.shadows());
        let psr = CameraPath::for_scene(&scene, Config::PSR.shadows());
        match &scene.camera_path {
            Some(own) => assert_eq!((&p.name, &psr.name), (own, own)),
            None => assert_eq!((p.name.as_str(), psr.name.as_str()), ("orbit", "light-orbit")),
        }
    }
    let unknown = Scene { camera_path: Some("gone".into()), ..small("hall") };
    assert_eq!(CameraPath::for_scene(&unknown, Config::PS.shadows()).name, "light-orbit");
}

#[test]
fn selected_frames_are_evenly_spaced_and_include_the_first() {
    let scene = small("scan");
    let path = CameraPath::load("orbit").unwrap();
    let all = path.views(&scene, None).unwrap();
    for n in [1, 2, 7, 50, 399, 400] {
        let thinned = path.views(&scene, Some(n)).unwrap();
        let expected: Vec<View> = (0..n).map(|i| all[((i * 400) as f64 / n as f64).round() as usize].clone()).collect();
        assert_eq!(thinned, expected, "{n}");
    }
    for n in [0, 401, usize::MAX] {
        let message = path.views(&scene, Some(n)).unwrap_err().to_string();
        assert!(message.contains("1 to 400 frames"), "{message}");
    }
}

/// The largest distance of a vertex from the centre of the image, in half images; infinite if a vertex is behind the
/// camera.
fn reach(scene: &Scene, view: &View) -> f32 {
    let c = &view.camera;
    let right = c.direction.cross(c.up).normalize();
    let up = right.cross(c.direction);
    let half = (c.field_of_view.to_radians() * 0.5).tan();
    let share = |p: Vec3| {
        let to = p - c.position;
        let depth = to.dot(c.direction);
        if depth > 0.0 { to.dot(right).abs().max(to.dot(up).abs()) / (depth * half) } else { f32::INFINITY }
    };
    scene.vertices.iter().map(|v| share(v.position)).fold(0.0, f32::max)
}

#[test]
fn an_orbit_keeps_its_distance_and_the_whole_object_in_view() {
    let path = CameraPath::load("orbit").unwrap();
    let stretched = |x: f32, y: f32, z: f32| {
        let mut scene = small("scan");
        for v in &mut scene.vertices {
            v.position = v.position * Vec3::new(x, y, z) + Vec3::new(100.0, -7.0, 3.0);
        }
        scene
    };
    for scene in
        [stretched(1.0, 1.0, 1.0), stretched(30.0, 1.0, 1.0), stretched(1.0, 40.0, 1.0), stretched(9.0, 0.0, 9.0)]
    {
        let center = scene.bounds().center();
        let views = path.views(&scene, None).unwrap();
        let distance = views[0].camera.position.distance(center);
        let mut widest = 0.0f32;
        for view in &views {
            let to = center - view.camera.position;
            assert!((to.length() - distance).abs() < 1e-4 * distance);
            assert!(view.camera.direction.dot(to.normalize()) > 0.99999);
            widest = widest.max(reach(&scene, view));
        }
        // The object is in view in all frames, and fills the image in at least one.
        assert!((0.80..=1.0).contains(&widest), "{widest}");
        // Frames are evenly spaced in a full turn: opposite frames have opposite positions.
        let flat = |i: usize| (views[i].camera.position - center) * Vec3::new(1.0, 0.0, 1.0);
        assert!((flat(0) + flat(200)).length() < 1e-3 * distance);
        assert!((flat(100) + flat(300)).length() < 1e-3 * distance);
    }
}

#[test]
fn a_light_orbit_keeps_the_camera_and_turns_one_light() {
    let scene = small("scan");
    let views = CameraPath::load("light-orbit").unwrap().views(&scene, None).unwrap();
    let bounds = scene.bounds();
    for view in &views {
        assert_eq!(view.camera, views[0].camera);
        assert_eq!(view.lights.len(), 1);
        let offset = view.lights[0].position - bounds.center();
        assert!((offset.length() - (views[0].lights[0].position - bounds.center()).length()).abs() < 1e-3);
        assert!(offset.length() > bounds.diagonal() * 0.5, "outside of the object");
    }
    assert_ne!(views[0].lights, views[200].lights);
    assert!(reach(&scene, &views[0]) <= 1.0);
}

#[test]
fn any_axis_can_be_up() {
    let scene = small("scan");
    for up in [Vec3::X, Vec3::NEG_Y, Vec3::Z, Vec3::ONE] {
        let text = format!("kind = \"orbit\"\nframes = 8\nup = [{}, {}, {}]\n", up.x, up.y, up.z);
        let views = from_text(&text).unwrap().views(&scene, None).unwrap();
        let center = scene.bounds().center();
        let heights: Vec<f32> = views.iter().map(|v| (v.camera.position - center).dot(up.normalize())).collect();
        assert!(heights.iter().all(|h| (h - heights[0]).abs() < 1e-4 && *h > 0.0), "{up}: {heights:?}");
    }
}

#[test]
fn a_walk_passes_through_its_keys_and_follows_the_bounds() {
    let scene = small("scan");
    let views = from_text(WALK).unwrap().views(&scene, None).unwrap();
    assert_eq!(views[0].camera.position, Vec3::new(0.0, 0.0, 5.0));
    assert!(views[9].camera.position.abs_diff_eq(Vec3::new(5.0, 0.0, 0.0), 1e-5));
    for view in &views {
        assert!(view.camera.direction.abs_diff_eq(-view.camera.position.normalize(), 1e-5), "looks at the target");
        assert_eq!(view.lights, scene.lights);
    }
    let relative = WALK.replace("frames", "relative = true\nframes");
    let views = from_text(&relative).unwrap().views(&scene, None).unwrap();
    let bounds = scene.bounds();
    assert_eq!(views[0].camera.position, bounds.min + bounds.extent() * Vec3::new(0.0, 0.0, 5.0));
    // The speed is constant if keys are on a line at equal intervals.
    let line = "kind = \"walk\"\nframes = 31\n".to_owned()
        + &(0..4)
            .map(|i| format!("[[keys]]\ntime = {i}\nposition = [{i}, 0, 0]\ndirection = [0, 0, 1]\n"))
            .collect::<String>();
    for (i, view) in from_text(&line).unwrap().views(&scene, None).unwrap().iter().enumerate() {
        assert!(view.camera.position.abs_diff_eq(Vec3::X * (i as f32 * 0.1), 1e-5), "{i}: {:?}", view.camera);
    }
}

#[test]
fn lights_come_from_the_path_or_the_scene_or_the_default() {
    let scene = small("hall");
    assert_eq!(from_text(WALK).unwrap().views(&scene, Some(1)).unwrap()[0].lights, scene.lights);
    let own = format!("{WALK}[[lights]]\nposition = [0.5, 1, 0.5]\nrelative = true\ncolour = [1, 0.5, 0]\n");
    let lights = &from_text(&own).unwrap().views(&scene, None).unwrap()[3].lights;
    let bounds = scene.bounds();
    assert_eq!(lights.len(), 1);
    assert_eq!(lights[0].position, bounds.min + bounds.extent() * Vec3::new(0.5, 1.0, 0.5));
    assert_eq!(lights[0].colour, Vec3::new(1.0, 0.5, 0.0));
    let dark = Scene { lights: Vec::new(), ..scene };
    let views = from_text(WALK).unwrap().views(&dark, None).unwrap();
    for view in &views {
        assert_eq!(view.lights.len(), 1);
        assert!(view.lights[0].position.y > view.camera.position.y, "above the camera");
    }
}

/// No ray from a frame's position to the next is blocked: no walk passes through a wall or a column.
#[test]
fn walks_keep_out_of_the_geometry() {
    for name in ["terrain", "sphereflake", "stadium", "hall", "room", "sphere", "box", "plane"] {
        let scene = small(name);
        let views = CameraPath::load(name).unwrap().views(&scene, None).unwrap();
        let triangles: Vec<_> = (0..scene.triangles.len() as u32).map(|i| scene.corners(i)).collect();
        for pair in views.windows(2) {
            let [from, to] = [pair[0].camera.position, pair[1].camera.position];
            let ray = Ray::new(from.into(), (to - from).into());
            let hit = triangles.iter().position(|&corners| intersect(&ray, corners, 1.0).is_some());
            assert_eq!(hit, None, "{name}: from {from} to {to}");
        }
        // The camera looks at a surface in most frames.
        let sees = |view: &&View| {
            let ray = Ray::new(view.camera.position.into(), view.camera.direction.into());
            triangles.iter().any(|&corners| intersect(&ray, corners, T_MAX).is_some())
        };
        let seeing = views.iter().step_by(20).filter(sees).count();
        assert!(seeing >= 18, "{name}: {seeing} of 20");
    }
}

#[test]
fn invalid_files_are_refused_with_line_and_hint() {
    let cases: &[(&str, &str, &[&str])] = &[
        ("\"walk\"", "\"stroll\"", &["path.toml:1: kind \"stroll\" is unknown", "light-orbit"]),
        ("kind = \"walk\"", "", &["missing field `kind`"]),
        ("frames = 10", "frames = 0", &[":2: frames = 0", "1 to"]),
        ("frames = 10", "frames = 99999999999", &[":2: frames"]),
        ("frames = 10", "frames = -1", &[":2:"]),
        ("frames = 10", "frames = \"ten\"", &[":2:"]),
        ("frames = 10", "frames =", &[":2:"]),
        ("frames = 10", "frame = 10", &[":2:", "unknown field `frame`"]),
        ("frames = 10", "field_of_view = 180", &[":2: field_of_view = 180 is out of range", "between 0 and 180"]),
        ("frames = 10", "field_of_view = 0", &[":2: field_of_view"]),
        ("frames = 10", "field_of_view = nan", &[":2: field_of_view"]),
        ("frames = 10", "up = [0, 0, 0]", &[":2: up is zero"]),
        ("frames = 10", "up = [0, inf, 0]", &[":2: up is not finite"]),
        ("frames = 10", "up = [0, 1]", &[":2:"]),
        ("frames = 10", "distance = 3", &[":2: `distance` has no meaning for kind walk"]),
        ("\"walk\"", "\"orbit\"", &["`keys` have no meaning for kind orbit"]),
        ("time = 1", "time = 0", &[":8: time = 0 is not greater"]),
        ("time = 1", "time = nan", &[":8: time = NaN"]),
        ("time = 1\n", "", &["missing field `time`"]),
        ("position = [5, 0, 0]", "position = [0, 0, 0]", &[":10: the camera's position is its target"]),
        (
            "position = [5, 0, 0]",
            "position = [0, 7, 0]",
            &[":10: the camera looks along its up vector", "another `up`"],
        ),
        ("position = [5, 0, 0]", "position = [nan, 7, 0]", &[":9: position is not finite"]),
        ("target = [0, 0, 0]", "", &["needs either a target or a direction"]),
        ("target = [0, 0, 0]", "target = [0, 0, 0]\ndirection = [0, 0, 1]", &[":3: a key needs either"]),
        ("target = [0, 0, 0]", "direction = [0, 0, 0]", &[":6: direction is zero"]),
        ("target = [0, 0, 0]", "direction = [0, -2, 0]", &[":6: the camera looks along its up vector"]),
        (&WALK[WALK.rfind("[[keys]]").unwrap_or(0)..], "", &["two keys or more, but there are 1"]),
        (&WALK[WALK.find("[[keys]]").unwrap_or(0)..], "", &["two keys or more, but there are 0"]),
        ("[[keys]]", "[[lights]]\nposition = [0, 0, 0]\ncolour = [-1, 0, 0]\n[[keys]]", &[":5: colour is negative"]),
    ];
    for (from, to, words) in cases {
        assert!(WALK.contains(from), "{from}");
        let message = from_text(&WALK.replacen(from, to, 1)).expect_err(to).to_string();
        assert!(!message.contains('\n'), "{message}");
        for word in *words {
            assert!(message.contains(word), "{from:?} -> {to:?}: {message}");
        }
    }
    let message = CameraPath::load("orbitt").unwrap_err().to_string();
    assert!(message.contains("did you mean orbit?") && message.contains("light-orbit"), "{message}");
}

#[test]
fn errors_that_depend_on_the_scene_are_reported_for_the_scene() {
    let scene = small("scan");
    // The interpolated direction passes through zero and through the up vector.
    let turn = "kind = \"walk\"\nframes = 3\n[[keys]]\ntime = 0\nposition = [0, 0, 5]\ndirection = [0, 0, 1]\n\
        [[keys]]\ntime = 1\nposition = [0, 0, 5]\ndirection = [0, 0, -1]\n";
    let message = from_text(turn).unwrap().views(&scene, None).unwrap_err().to_string();
    assert!(message.contains("frame 1: the camera has no direction"), "{message}");
    let mut point = scene.clone();
    for v in &mut point.vertices {
        v.position = Vec3::ONE;
    }
    let message = CameraPath::load("orbit").unwrap().views(&point, None).unwrap_err().to_string();
    assert!(message.contains("single point"), "{message}");
    let above = "kind = \"orbit\"\nframes = 4\ndistance = 1e-6\nheight = 3\n";
    let message = from_text(above).unwrap().views(&scene, None).unwrap_err().to_string();
    assert!(message.contains("looks along its up vector"), "{message}");
}

/// A scene with a camera in its file, which turns slightly.
fn filmed(frames: usize) -> Scene {
    let mut random = crate::support::random(7);
    let frames = (0..frames)
        .map(|i| {
            let direction = Vec3::new(random(), random(), random() - 2.0).normalize();
            Pose { time: 0.1 * i as f64, position: Vec3::new(random(), 1.0 / 3.0, 1e-7), direction, up: Vec3::Y }
        })
        .collect();
    let camera = Some(SceneCamera { field_of_view: 36.869_892, frames });
    Scene { name: "film:time=3".into(), camera, camera_path: Some("hall".into()), ..small("scan") }
}

#[test]
fn the_camera_of_the_scene_file_is_the_default_path() {
    let scene = filmed(30);
    let poses = &scene.camera.as_ref().unwrap().frames;
    for config in Config::ALL {
        let path = CameraPath::for_scene(&scene, config.shadows());
        assert_eq!((path.name.as_str(), path.frames, path.field_of_view), ("film", 30, 36.869_892));
        let views = path.views(&scene, None).unwrap();
        assert_eq!(views.len(), 30);
        for (view, pose) in views.iter().zip(poses) {
            assert_eq!(
                (view.camera.position, view.camera.direction, view.camera.up),
                (pose.position, pose.direction, pose.up)
            );
        }
        let thinned = path.views(&scene, Some(10)).unwrap();
        assert_eq!(
            thinned.iter().map(|v| v.camera).collect::<Vec<_>>(),
            views.iter().step_by(3).map(|v| v.camera).collect::<Vec<_>>()
        );
        assert!(path.views(&scene, Some(31)).is_err());
    }
    let moved = Scene { camera: filmed(31).camera, ..filmed(30) };
    let hash = |scene: &Scene| CameraPath::for_scene(scene, Config::P.shadows()).content_hash();
    assert_ne!(hash(&scene), hash(&moved));
    // A static camera gives one frame for any number of requested frames.
    let still = filmed(1);
    let path = CameraPath::for_scene(&still, Config::PSR.shadows());
    for frames in [None, Some(1), Some(20)] {
        assert_eq!(path.views(&still, frames).unwrap().len(), 1);
    }
}

/// The hint for a path with too few frames is feasible: only a path file of the user can be given more.
#[test]
fn more_frames_than_the_path_has_are_refused() {
    let scene = filmed(30);
    let refused = |path: CameraPath| path.views(&scene, Some(401)).unwrap_err().to_string();
    let poses = "kind = \"frames\"\nposes = [[0, 0, 0, 9, 0, 0, -1, 0, 1, 0], [1, 0, 0, 8, 0, 0, -1, 0, 1, 0]]\n";
    let folder = tempfile::tempdir().unwrap();
    let load = |text: &str| {
        let file = folder.path().join("path.toml");
        std::fs::write(&file, text).unwrap();
        CameraPath::load(file.to_str().unwrap()).unwrap()
    };
    for (path, hint) in [
        (CameraPath::for_scene(&scene, Config::P.shadows()), "(take 1 to 30 frames)"),
        (CameraPath::load("orbit").unwrap(), "(take 1 to 400 frames)"),
        (load(poses), "(take 1 to 2 frames, or add poses to the file)"),
        (load(WALK), "(take 1 to 10 frames, or raise `frames` in the file)"),
    ] {
        let message = refused(path);
        assert!(message.ends_with(hint), "{message}");
    }
}

#[test]
fn an_exported_path_gives_the_same_views_to_the_bit() {
    let scene = filmed(200);
    let with_lights = format!(
        "{WALK}[[lights]]\nposition = [0.3, 1, 0.7]\nrelative = true\n[[lights]]\nposition = [1, 2, 3]\ncolour = [0.1, 0, 1]\n"
    );
    for path in [
        CameraPath::for_scene(&scene, Config::P.shadows()),
        CameraPath::load("orbit").unwrap(),
        from_text(WALK).unwrap(),
        from_text(&with_lights).unwrap(),
    ] {
        let recorded = path.poses(&scene, None).unwrap();
        let again = from_text(&to_toml(&recorded, &path.lights(&scene), "\"quoted\"\nlines")).unwrap();
        assert_eq!(again.description, "\"quoted\"\nlines");
        assert_eq!(again.poses(&scene, None).unwrap(), recorded);
        assert_eq!(again.views(&scene, None).unwrap(), path.views(&scene, None).unwrap(), "{}", path.name);
    }
    let recorded = CameraPath::for_scene(&scene, Config::P.shadows()).poses(&scene, Some(100)).unwrap();
    let csv = to_csv(&recorded);
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("frame,time,pos_x,pos_y,pos_z,dir_x,dir_y,dir_z,up_x,up_y,up_z"));
    assert_eq!(lines.clone().count(), 100);
    let second: Vec<f64> = lines.nth(1).unwrap().split(',').map(|n| n.parse().unwrap()).collect();
    assert_eq!((second[0], second[1], second[3] as f32), (1.0, 0.2, 1.0 / 3.0));
}

#[test]
fn invalid_recorded_frames_are_refused_with_line_and_hint() {
    let whole = "kind = \"frames\"\nfield_of_view = 45\nposes = [\n  [0, 0, 0, 5, 0, 0, -2, 0, 1, 0],\n  [1, 0, 0, 4, 0, 0, -1, 0, 1, 0],\n]\n";
    let views = from_text(whole).unwrap().views(&small("scan"), None).unwrap();
    assert_eq!(
        (views.len(), views[0].camera.direction),
        (2, Vec3::NEG_Z),
        "a direction that is not a unit vector is normalised"
    );
    for (from, to, words) in [
        ("  [1, 0, 0, 4,", "  [1, 0, 0, nan,", &[":5: time or position is not finite"][..]),
        ("  [1, 0, 0, 4,", "  [inf, 0, 0, 4,", &[":5: time or position"]),
        ("  [1, 0, 0, 4,", "  [1, 0, 0,", &[":5:"]),
        ("-2, 0, 1, 0", "0, 0, 1, 0", &[":4: direction or up is zero"]),
        ("-2, 0, 1, 0", "-2, 0, 0, 1", &[":4: direction or up is zero, or the camera looks along"]),
        ("-2, 0, 1, 0", "nan, 0, 1, 0", &[":4: direction"]),
        ("field_of_view = 45", "frames = 2", &[":2: `frames` has no meaning for kind frames"]),
        ("field_of_view = 45", "distance = 2", &[":2: `distance` has no meaning for kind frames"]),
        ("\"frames\"", "\"walk\"", &[":3: `poses` has no meaning for kind walk"]),
        ("poses", "rows", &[":3:", "unknown field `rows`"]),
        (&whole[whole.find("poses").unwrap_or(0)..], "", &["recorded frames need `poses`"]),
        (&whole[whole.find("poses").unwrap_or(0)..], "poses = []", &["recorded frames need `poses`"]),
    ] {
        assert!(whole.contains(from), "{from}");
        let message = from_text(&whole.replacen(from, to, 1)).expect_err(to).to_string();
        for word in words {
            assert!(message.contains(word), "{from:?} -> {to:?}: {message}");
        }
    }
}

/// Compares BART's cameras with values computed by the benchmark's own code.
#[test]
fn the_cameras_of_the_real_scenes_equal_the_references() {
    let variable = if std::env::var_os("RTBENCH_REFERENCE").is_some() { "RTBENCH_REFERENCE" } else { "RTBENCH_SCENES" };
    let folder = if variable == "RTBENCH_SCENES" { "../reference/" } else { "" };
    for (scene, reference, frames) in [
        ("bart/museum/museum6-derived.aff", "bart_museum_camera.csv", 300),
        ("bart/robots/Robot.aff", "bart_robots_camera.csv", 800),
    ] {
        let Some(scene) = file_below("RTBENCH_SCENES", scene) else { return };
        let Some(reference) = file_below(variable, &format!("{folder}{reference}")) else { return };
        let scene = rtbench::scene::load(scene.to_str().unwrap()).unwrap();
        let recorded = CameraPath::for_scene(&scene, Config::PSR.shadows()).poses(&scene, None).unwrap();
        assert_eq!(recorded.frames.len(), frames);
        let mut rows = 0;
        for row in csv::Reader::from_path(reference).unwrap().records() {
            let numbers: Vec<f64> = row.unwrap().iter().map(|n| n.parse().unwrap()).collect();
            let pose = &recorded.frames[numbers[0] as usize];
            let found = [pose.position, pose.direction, pose.up].map(|v| v.to_array());
            let found: Vec<f64> =
                std::iter::once(pose.time).chain(found.iter().flatten().map(|&x| f64::from(x))).collect();
            for (column, (a, b)) in found.iter().zip(&numbers[1..]).enumerate() {
                assert!((a - b).abs() < 1e-4, "{}: frame {}, column {column}: {a}, not {b}", scene.name, numbers[0]);
            }
            rows += 1;
        }
        assert!(rows > 20, "only {rows} reference values");
    }
}

#[test]
fn the_program_exports_the_camera_path_of_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let keys = "transl 4 0 0 0 9 0 0 0 1 0 0 9 0 0 0 2 1 0 9 0 0 0 3 1 0 9 0 0 0";
    std::fs::write(file("film.aff"), format!("s 0 0 0 1 x camera {{ s 3 0 0 1 }} a 1 2 5 k camera {{ {keys} }}"))
        .unwrap();
    let run = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_rtbench")).args(arguments).output().unwrap();
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    for out in ["path.toml", "path.csv"] {
        assert!(run(&["camera-path", "export", &file("film.aff"), "-o", &file(out)]).contains("/film.aff~"));
    }
    assert_eq!(std::fs::read_to_string(file("path.csv")).unwrap().lines().count(), 6);
    let scene = scene::load(&file("film.aff")).unwrap();
    let [own, exported] =
        [CameraPath::for_scene(&scene, Config::P.shadows()), CameraPath::load(&file("path.toml")).unwrap()];
    assert_eq!(own.views(&scene, None).unwrap(), exported.views(&scene, None).unwrap());
    assert!(run(&["camera-path", "list"]).contains("sphereflake"));
    for (time, right) in [(None, 4.0), (Some("1"), 4.0), (Some("2"), 5.0)] {
        let mut arguments = vec!["scenes", "info"];
        let name = file("film.aff");
        arguments.push(&name);
        arguments.extend(time.iter().flat_map(|time| ["--scene-time", time]));
        let expected = format!("largest corner        [{right}, 1, 10]");
        let text = run(&arguments);
        assert!(text.contains(&expected), "{arguments:?}: {text}");
    }
}
