//! Which scene, device, variant and conditions a record belongs to.

use super::synthetic::{Builder, sums};
use rtbench::compare::judge::Verdict;
use rtbench::harness::preset::Preset;
use rtbench::harness::workload::Workload;
use rtbench::sources::thesis::claims::judge;
use rtbench::sources::thesis::data::Data;
use rtbench::sources::thesis::scenes::{SceneKey, ThesisScene};
use rtbench::sources::thesis::variant::Variant;
use rtbench::sources::thesis::{measured, published};
use rtbench::workloads::trace::TRACE;
use rtbench::workloads::trace::backend::{Config, DeviceType};
use rtbench::workloads::trace::record::by_ray_type;

#[test]
fn a_scene_is_the_thesis_s_by_name_and_counts() {
    let key = SceneKey::of;
    let thesis = SceneKey::Thesis;
    assert_eq!(key("bunny", 69_451, 35_947), thesis(ThesisScene::Bunny));
    assert_eq!(key("bun_zipper", 69_451, 35_947), thesis(ThesisScene::Bunny));
    assert_eq!(key("dragon_vrip", 871_414, 437_645), thesis(ThesisScene::Dragon));
    // The robots' vertices depend on who splits them: the name decides.
    assert_eq!(key("robots", 71_708, 99_999), thesis(ThesisScene::Robots));
    // The office has two published numbers of triangles.
    assert_eq!(key("office", 36_310, 1), thesis(ThesisScene::Office));
    // Nothing in the name: both counts decide.
    assert_eq!(key("my-scan", 1_087_716, 543_652), thesis(ThesisScene::Buddha));
    assert_eq!(key("my-scan", 1_087_716, 543_651), SceneKey::Other("my-scan".into(), 1_087_716));
    // Another tessellation never takes the thesis's place.
    let conference = key("conference", 207_512, 229_642);
    assert_eq!((conference.thesis(), conference.tessellation_of()), (None, Some(ThesisScene::Conference)));
    assert_eq!(conference.to_string(), "conference (207512)");
    assert_eq!(key("conference-obj", 207_512, 219_830).tessellation_of(), Some(ThesisScene::Conference));
    assert_eq!(key("hall", 15_000, 9).tessellation_of(), None);
    // A built-in scene's size is not said twice, other options are.
    assert_eq!(key("hall:triangles=15000", 14_752, 9).to_string(), "hall (14752)");
    assert_eq!(key("hall:triangles=15000,seed=2", 14_752, 9).to_string(), "hall:triangles=15000,seed=2 (14752)");
}

#[test]
fn another_pose_is_another_scene() {
    let museum = |name: &str| SceneKey::of(name, 14_380, 17_889);
    // As the catalogue has it, also where a file of it is named with the catalogue's options, in any form.
    for name in ["museum", "museum:time=3", "museum:outside=yes", "museum6:fov=53.130,time=3.0,cones=no"] {
        assert_eq!(museum(name), SceneKey::Thesis(ThesisScene::Museum), "{name}");
    }
    for name in ["museum:time=0", "museum:fov=45", "museum:camera=other", "museum6:time=3", "my-scan:time=3"] {
        let key = museum(name);
        assert_eq!((key.thesis(), key.tessellation_of()), (None, None), "{name}");
        assert_eq!(key.to_string(), format!("{name} (14380)"));
    }
    assert_eq!(museum("museum:time=0").base_scene(), Some(ThesisScene::Museum));
    // A file that says nothing of its pose is not in the catalogue's, and the row says so.
    let key = SceneKey::of("Robot", 71_708, 1);
    assert_eq!(key.to_string(), "Robot without time=6 (71708)");
    assert_eq!(SceneKey::of("Robot:time=6", 71_708, 1), SceneKey::Thesis(ThesisScene::Robots));
}

/// A row along a path of this name.
fn along(name: &str, config: Config, path: &str) -> String {
    let scene = super::synthetic::scene(name);
    let key = SceneKey::of(&scene.name, scene.triangles, scene.vertices);
    key.along(&scene.name, scene.triangles, path, config.shadows()).to_string()
}

#[test]
fn another_path_has_its_own_row() {
    for (scene, config, path) in [
        ("museum", Config::PS, "museum"),
        ("bunny", Config::P, "orbit"),
        ("bunny", Config::PS, "light-orbit"),
        ("hall", Config::P, "hall"),
        ("sponza", Config::P, "sponza"),
        ("soda", Config::PSR, "inside"),
        ("scan", Config::P, "orbit"),
        ("conference", Config::P, "orbit"),
    ] {
        assert!(!along(scene, config, path).contains("along"), "{scene} {path}");
    }
    assert_eq!(along("museum", Config::P, "orbit"), "museum along orbit (14380)");
    assert_eq!(along("bunny", Config::P, "light-orbit"), "bunny along light-orbit (69451)");
    assert_eq!(along("hall", Config::P, "orbit"), "hall along orbit (5000)");
    assert_eq!(along("sponza", Config::P, "orbit"), "sponza along orbit (5000)");
    assert_eq!(along("museum:time=0", Config::P, "orbit"), "museum:time=0 along orbit (5000)");
    // Its frames are in that row; structures know no path.
    let mut b = Builder::new();
    b.frame("museum", "grid", Config::P, 64, 1.0).camera_path.name = "orbit".into();
    b.built("museum", "grid", 1.0, 1.0, 4);
    let data = measured::data(&[b.run]);
    let museum = SceneKey::Thesis(ThesisScene::Museum);
    assert!(data.thesis_frame(0, &museum, "grid", Config::P, 64).is_none());
    assert!(data.thesis_frame(0, &data.frames[0].scene, "grid", Config::P, 64).is_some());
    assert!(data.thesis_built(&museum, "grid").is_some() && data.thesis_built(&data.frames[0].scene, "grid").is_some());
}

/// Two runs of the hall on one device, each with its structures and as `change` makes its records.
fn two_runs(first: &[&str], second: &[&str], change: fn(&mut Builder)) -> Data {
    let run = |structures: &[&str], change: Option<fn(&mut Builder)>| {
        let mut b = Builder::new();
        for (index, structure) in structures.iter().enumerate() {
            b.frame("hall", structure, Config::P, 64, 10.0 * (index + 1) as f64);
        }
        if let Some(change) = change {
            change(&mut b);
        }
        b.run
    };
    measured::data(&[run(first, None), run(second, Some(change))])
}

fn structures(data: &Data) -> Vec<&str> {
    data.frames.iter().map(|f| f.structure.as_str()).collect()
}

#[test]
fn only_measurements_of_the_same_frames_are_in_the_same_rows() {
    type Change = (fn(&mut Builder), &'static str);
    let changes: [Change; 4] = [
        (|b| b.run.journal.configurations.iter_mut().for_each(|r| r.frames = 7), "7 frames (kept: 2 frames)"),
        (|b| b.run.journal.configurations.iter_mut().for_each(|r| r.scene.hash = "abc".into()), "scene abc"),
        (
            |b| b.run.journal.configurations.iter_mut().for_each(|r| r.camera_path.hash = "def".into()),
            "camera path def",
        ),
        (|b| b.run.journal.provenance.devices[0].info.checked = true, "shader checks on (kept: shader checks off)"),
    ];
    for (change, words) in changes {
        // Most structures win, and the rest is named.
        let data = two_runs(&["grid", "kdtree"], &["bvh"], change);
        assert_eq!(structures(&data), ["grid", "kdtree"], "{words}");
        let note = data.notes.iter().find(|note| note.contains("left out")).unwrap_or_else(|| panic!("{words}"));
        assert!(
            note.starts_with("1 measurement of hall (5000) on Fast GPU left out") && note.contains(words),
            "{note}"
        );
        assert!(!data.devices[0].checked);
        // Of equals the later.
        assert_eq!(structures(&two_runs(&["grid"], &["bvh"], change)), ["bvh"], "{words}");
        // Then the one with more options.
        let data = two_runs(&["grid", "grid:factor=2"], &["bvh"], change);
        assert_eq!(structures(&data), ["grid", "grid"], "{words}");
    }
    // The same frames: all are in the same rows, and there is no note.
    let data = two_runs(&["grid", "kdtree"], &["bvh"], |_| ());
    assert_eq!((structures(&data), data.notes.len()), (vec!["grid", "kdtree", "bvh"], 0));
}

#[test]
fn claims_compare_only_the_same_frames() {
    let judged = |frames: usize| {
        let mut a = Builder::new();
        a.frame("museum", "kdtree", Config::P, 64, 10.0);
        a.frame("museum", "grid", Config::P, 64, 10.0);
        let mut b = Builder::new();
        b.frame("museum", "kdtree:search=restart", Config::P, 64, 30.0).frames = frames;
        let all = judge(&measured::data(&[a.run, b.run]), &published::data(), 0);
        all.into_iter().find(|f| f.claim == "7").unwrap().verdict
    };
    assert_eq!((judged(2), judged(3)), (Verdict::Holds, Verdict::NotMeasured));
    // Nor sizes of unlike frames.
    let falls = |frames: usize| {
        let mut b = Builder::new();
        b.trio("museum", Config::P, 64, [10.0; 3]);
        b.run.journal.configurations.iter_mut().for_each(|r| r.frames = frames);
        b.trio("museum", Config::P, 128, [20.0; 3]);
        let all = judge(&measured::data(&[b.run]), &published::data(), 0);
        all.into_iter().find(|f| f.claim == "6a").unwrap().verdict
    };
    assert_eq!((falls(2), falls(3)), (Verdict::Holds, Verdict::NotMeasured));
}

#[test]
fn devices_keep_their_counts() {
    let run = |name: &str, steps: u64| {
        let mut b = Builder::new().device(name, DeviceType::DiscreteGpu);
        let record = b.frame("museum", "grid", Config::P, 64, 1.0);
        record.counters = Some(by_ray_type([sums(steps, 1); 3]));
        record.frames = steps as usize;
        b.run
    };
    let data = measured::data(&[run("one", 11), run("two", 22)]);
    let steps: Vec<f64> = data.counts.iter().filter(|c| c.ray == 0).map(|c| c.steps.by(Default::default())).collect();
    assert_eq!(steps, [11.0, 22.0]);
    // Without a device, the first one's.
    let key = SceneKey::Thesis(ThesisScene::Museum);
    assert_eq!(data.thesis_counts(&key, "grid", 0).unwrap().device, 0);
    // And their times are said not to compare.
    assert!(data.notes.iter().any(|n| n.contains("one and two measured unlike frames")), "{:?}", data.notes);
}

#[test]
fn presets_measure_a_scene_with_one_number_of_frames() {
    for preset in ["quick", "thesis", "thesis-lite", "rt2", "rt2-lite"] {
        let preset = Preset::load(TRACE.info(), preset).unwrap();
        for part in &preset.parts {
            let of_scene = preset.parts.iter().filter(|p| p.of("scene") == part.of("scene"));
            assert!(of_scene.into_iter().all(|p| p.frames == part.frames), "{} {:?}", preset.name, part.of("scene"));
        }
    }
}

#[test]
fn variants_are_read_as_records_write_them() {
    assert!(Variant::parse("default").is_default() && Variant::parse("").is_default());
    let variant = Variant::parse("x=128,shadows=to-light");
    assert_eq!((variant.get("shadows"), variant.get("y")), (Some("to-light"), None));
    assert_eq!(variant.to_string(), "x=128,shadows=to-light");
    let base = Variant::of_thesis(Some(ThesisScene::Robots), "grid");
    assert_eq!(base, Variant::of("x", "128"));
    assert!(Variant::of_thesis(Some(ThesisScene::Robots), "bvh").is_default());
    assert_eq!(variant.only_beyond(&base), Some(("shadows", "to-light")));
    assert_eq!(variant.only_beyond(&Variant::default()), None);
    assert_eq!(Variant::parse("x=64,shadows=to-light").only_beyond(&base), None);
    assert_eq!(base.only_beyond(&base), None);
    // What cannot be read is not the default.
    assert!(!Variant::parse("odd").is_default());
    assert_eq!(Variant::parse("odd").to_string(), "odd");
}
