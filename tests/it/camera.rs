//! Camera paths: files, thinning, fitting, errors.

use glam::Vec3;
use rtbench::backend::Config;
use rtbench::camera::{CameraPath, View, names};
use rtbench::math::{Ray, T_MAX, intersect};
use rtbench::scene::{self, Scene};

fn small(name: &str) -> Scene {
    let info = *scene::list().iter().find(|info| info.name == name).unwrap();
    scene::load(&format!("{name}:triangles={}", info.parameters[0].min)).unwrap()
}

/// A path from a file of this text.
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
fn every_embedded_path_is_sound_and_has_the_thesis_number_of_frames() {
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
fn every_built_in_scene_finds_its_path() {
    for info in scene::list() {
        let scene = small(info.name);
        let p = CameraPath::for_scene(&scene, Config::P);
        let psr = CameraPath::for_scene(&scene, Config::PSR);
        match &scene.camera_path {
            Some(own) => assert_eq!((&p.name, &psr.name), (own, own)),
            None => assert_eq!((p.name.as_str(), psr.name.as_str()), ("orbit", "light-orbit")),
        }
    }
    let unknown = Scene { camera_path: Some("gone".into()), ..small("hall") };
    assert_eq!(CameraPath::for_scene(&unknown, Config::PS).name, "light-orbit");
}

#[test]
fn thinning_is_even_and_keeps_the_first_frame() {
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

/// Largest share of the half image that any vertex reaches; infinite if one lies behind the camera.
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
fn the_orbit_keeps_its_distance_and_shows_the_whole_object() {
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
        // In view from every side, and filling the image from at least one.
        assert!((0.80..=1.0).contains(&widest), "{widest}");
        // A full turn, evenly: opposite frames stand opposite to each other.
        let flat = |i: usize| (views[i].camera.position - center) * Vec3::new(1.0, 0.0, 1.0);
        assert!((flat(0) + flat(200)).length() < 1e-3 * distance);
        assert!((flat(100) + flat(300)).length() < 1e-3 * distance);
    }
}

#[test]
fn the_light_orbit_keeps_the_camera_and_turns_one_light() {
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
fn up_may_be_any_axis() {
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
    // Constant speed where keys lie on a line at even times.
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

/// Between any two frames the camera sees where it goes: no walk passes through a wall or a column.
#[test]
fn walks_keep_out_of_the_geometry() {
    for name in ["terrain", "sphereflake", "stadium", "hall", "room"] {
        let scene = small(name);
        let views = CameraPath::load(name).unwrap().views(&scene, None).unwrap();
        let triangles: Vec<_> = (0..scene.triangles.len() as u32).map(|i| scene.corners(i)).collect();
        for pair in views.windows(2) {
            let [from, to] = [pair[0].camera.position, pair[1].camera.position];
            let ray = Ray::new(from.into(), (to - from).into());
            let hit = triangles.iter().position(|&[a, b, c]| intersect(&ray, a, b, c, 1.0).is_some());
            assert_eq!(hit, None, "{name}: from {from} to {to}");
        }
        // And it looks at something most of the time.
        let sees = |view: &&View| {
            let ray = Ray::new(view.camera.position.into(), view.camera.direction.into());
            triangles.iter().any(|&[a, b, c]| intersect(&ray, a, b, c, T_MAX).is_some())
        };
        let seeing = views.iter().step_by(20).filter(sees).count();
        assert!(seeing >= 18, "{name}: {seeing} of 20");
    }
}

#[test]
fn bad_files_are_refused_with_line_and_mend() {
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
        ("position = [5, 0, 0]", "position = [0, 0, 0]", &[":10: the camera stands on its target"]),
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
        (&WALK[WALK.rfind("[[keys]]").unwrap_or(0)..], "", &["two keys or more, here are 1"]),
        (&WALK[WALK.find("[[keys]]").unwrap_or(0)..], "", &["two keys or more, here are 0"]),
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
fn what_only_shows_in_a_scene_is_refused_there() {
    let scene = small("scan");
    // The interpolated direction turns through zero and through up.
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
