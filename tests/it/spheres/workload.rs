//! The sphere tracer on the harness: what is typed, what is planned, and what becomes of what cannot be or is wrong.

use crate::support::own_gpu;
use rtbench::device::{CpuDevice, Device, VulkanDevice};
use rtbench::harness::previous::PreviousRun;
use rtbench::harness::run::{self, Job, Opened};
use rtbench::harness::workload::{Library, Part, Workload};
use rtbench::harness::{Plan, Request};
use rtbench::record::journal::Journal;
use rtbench::record::row::{Row, Status};
use rtbench::workloads::spheres::case::SpheresCase;
use rtbench::workloads::spheres::options::Renderer;
use rtbench::workloads::spheres::render::{Exit, Fault, FaultKind};
use rtbench::workloads::spheres::{SPHERES, Spheres};
use std::path::Path;

fn request(values: &[(&str, &str)]) -> Request {
    let common = [("scene", "random20"), ("resolution", "37x23")];
    let values = common.iter().chain(values).map(|(axis, value)| (axis.to_string(), vec![value.to_string()]));
    Request { values: values.collect(), frames: Some(2), passes: Some(2), warmup: Some(0), ..Request::default() }
}

/// Runs a plan on the CPU alone, as on a machine without a Vulkan device.
fn measured(workload: &Spheres, request: &Request, out: &Path) -> Journal {
    measured_on(None, workload, request, out)
}

/// Runs a plan on the CPU, and on a Vulkan device where there is one.
fn measured_on(gpu: Option<VulkanDevice>, workload: &Spheres, request: &Request, out: &Path) -> Journal {
    let cpu = Device::Cpu(CpuDevice::new(2).unwrap());
    let devices: Vec<Opened> = std::iter::once(cpu)
        .chain(gpu.map(Device::Vulkan))
        .map(|device| Opened { device, reason: "a test".into() })
        .collect();
    let plan = Plan::new(workload, request).unwrap().on_devices(devices.len());
    let outcome = run::run(Job {
        workload,
        plan: &plan,
        out,
        previous: PreviousRun::default(),
        arguments: vec![],
        devices,
        open: &|_| panic!("no device is lost"),
        interrupted: &|| false,
        watch: &mut |_| (),
    });
    outcome.unwrap().journal
}

fn of<'j>(journal: &'j Journal, renderer: &str) -> &'j Row {
    journal.rows.iter().find(|row| row.key.axis("renderer") == renderer).unwrap()
}

#[test]
fn renderers_are_read_as_they_are_written() {
    let texts = [
        "sequential",
        "threads",
        "threads:threads=3",
        "simd:lanes=4",
        "simd:lanes=16,level=avx512",
        "simd-threads:lanes=8,level=neon,threads=2",
        "gpu",
    ];
    for text in texts {
        assert_eq!(Renderer::parse(text).unwrap().to_string(), text);
    }
    assert_eq!(Renderer::parse("simd").unwrap().to_string(), "simd:lanes=8");
    assert_eq!(Renderer::parse_all("all").unwrap().len(), 5);
    for (wrong, problem) in [
        ("simdd", "there is no renderer 'simdd'"),
        ("", "there is no renderer ''"),
        ("gpu:lanes=4", "gpu has no options"),
        ("threads:lanes=4", "threads has threads"),
        ("simd:threads=2", "simd has no option 'threads'"),
        ("simd:lanes=5", "one of 4, 8, 16"),
        ("simd:lanes", "'' is no value"),
        ("simd:level=sse3", "one of sse2, avx2, avx512, neon"),
        ("simd:lanes=4,lanes=8", "given twice"),
        ("simd:", "simd has no option ''"),
        ("simd:lanes=4,", "simd has no option ''"),
        ("sequential:", "sequential has no options"),
        ("threads:threads=0", "1 to 1024"),
        ("threads:threads=99999", "1 to 1024"),
    ] {
        let error = Renderer::parse(wrong).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains(problem), "{wrong}: {error}");
    }
}

#[test]
fn every_case_is_read_as_it_is_written() {
    let plan = Plan::new(&SPHERES, &Request { preset: Some("spheres-lite".into()), ..Request::default() }).unwrap();
    assert!(plan.cases.len() > 100);
    for case in &plan.cases {
        let read = SpheresCase::parse(case).unwrap();
        let again = read.to_case(case.axis("scene"), 1);
        assert_eq!(again.axes, case.axes);
    }
}

#[test]
fn presets_are_complete() {
    let plan =
        |preset: &str| Plan::new(&SPHERES, &Request { preset: Some(preset.into()), ..Request::default() }).unwrap();
    let quick = plan("quick");
    assert_eq!((quick.cases.len(), quick.axes()["scene"].len(), quick.axes()["renderer"].len()), (3 * 7, 3, 5));
    let lite = plan("spheres-lite");
    // The source's three stages, by its structure, on its three numbers of spheres
    for scene in ["default", "random20", "random100"] {
        for (algorithm, exit, skips) in
            [("two-pass", "off", "off"), ("one-pass", "on", "off"), ("one-pass", "on", "on")]
        {
            for renderer in ["simd", "simd-threads"] {
                let is = |case: &&rtbench::harness::workload::Case| {
                    let axes =
                        [("scene", scene), ("algorithm", algorithm), ("exit_on_miss", exit), ("renderer", renderer)];
                    let others =
                        [("skip_no_hit", skips), ("skip_no_discriminant", skips), ("lanes", "4"), ("hit", "in-loop")];
                    axes.iter().chain(&others).all(|(axis, value)| case.axis(axis) == *value)
                };
                assert_eq!(lite.cases.iter().filter(is).count(), 1, "{scene} {algorithm} {skips} {renderer}");
            }
        }
    }
    assert_eq!(plan("spheres").axes()["resolution"], ["1920x1080", "960x540"]);
}

/// A switch that a renderer does not have is no part of its row, and is refused where nothing has it.
#[test]
fn switches_are_those_of_the_renderer() {
    let values = [("renderer", "sequential,simd,gpu"), ("skip_no_hit", "on,off"), ("hit", "index,in-loop")];
    let plan = Plan::new(&SPHERES, &request(&values)).unwrap();
    let count = |renderer: &str| plan.cases.iter().filter(|case| case.axis("renderer") == renderer).count();
    assert_eq!((count("sequential"), count("simd"), count("gpu")), (2, 4, 1));
    let refused = |values: &[(&str, &str)]| Plan::new(&SPHERES, &request(values)).unwrap_err().to_string();
    for (axis, renderers) in [("skip_no_hit", "sequential,gpu"), ("skip_no_discriminant", "threads"), ("hit", "gpu")] {
        let error = refused(&[("renderer", renderers), (axis, if axis == "hit" { "index" } else { "off" })]);
        assert!(error.starts_with(&format!("--{}: it is for", axis.replace('_', "-"))), "{error}");
    }
    for (axis, value, problem) in [
        ("algorithm", "three-pass", "one of one-pass, two-pass"),
        ("exit_on_miss", "yes", "one of on, off"),
        ("precision", "f64", "one of f32, f16"),
        ("trips", "0", "give 1 to 64"),
        ("trips", "65", "give 1 to 64"),
        ("resolution", "0x4", "no pixels"),
        ("scene", "random:spheres=0", "spheres"),
    ] {
        let error = refused(&[("renderer", "simd"), (axis, value)]);
        assert!(error.contains(problem), "{axis}={value}: {error}");
    }
    let nothing = Part::default();
    assert!(SPHERES.plan(&nothing, &Library::default()).unwrap_err().to_string().contains("renderer"));
}

#[test]
fn all_renderers_of_the_cpu_are_verified_counted_and_timed() {
    let out = tempfile::tempdir().unwrap();
    let values = [
        ("renderer", "sequential,threads,simd:lanes=4,simd:lanes=16,simd-threads"),
        ("algorithm", "one-pass,two-pass"),
    ];
    let journal = measured(&Spheres::default(), &request(&values), out.path());
    assert_eq!(journal.rows.len(), 10);
    for row in &journal.rows {
        assert_eq!(row.status, Status::Ok, "{}", row.message);
        assert_eq!(row.samples.as_ref().unwrap().wall_ns.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
        let integer = |name: &str| row.metric(None, name).and_then(|value| value.integer());
        assert_eq!(integer("tests"), integer("rays").map(|rays| 20 * rays));
        assert_eq!(integer("rays"), journal.rows[0].metric(None, "rays").and_then(|value| value.integer()));
        assert_eq!(row.metric(Some("bounce-1"), "rays").and_then(|v| v.integer()), Some(2 * 37 * 23));
        let occupancy = row.metric(None, "occupancy").and_then(|value| value.number());
        assert_eq!(occupancy.is_some(), row.key.axis("renderer").starts_with("simd"));
        assert!(occupancy.is_none_or(|share| share > 0.0 && share <= 1.0));
        assert!(row.checks.len() >= 5 && row.checks.iter().all(|check| check.ok));
    }
    assert!(out.path().join("pictures/random20.png").is_file());
}

#[test]
fn a_broken_lane_is_a_wrong_row_before_anything_is_timed() {
    let kinds = [
        FaultKind::ShiftDistance,
        FaultKind::DropMask,
        FaultKind::AllForAny(Exit::Miss),
        FaultKind::AllForAny(Exit::NoHit),
        FaultKind::AllForAny(Exit::NoDiscriminant),
    ];
    for kind in kinds {
        let out = tempfile::tempdir().unwrap();
        let workload = Spheres { fault: Some(Fault { lane: 3, kind }), ..Spheres::default() };
        let journal = measured(&workload, &request(&[("renderer", "sequential,simd,simd-threads")]), out.path());
        assert_eq!(of(&journal, "sequential").status, Status::Ok);
        for renderer in ["simd", "simd-threads"] {
            let row = of(&journal, renderer);
            assert_eq!((row.status, row.samples.is_none()), (Status::Wrong, true), "{kind:?}");
            assert!(row.message.contains("pixels differ; the first is ("), "{kind:?}: {}", row.message);
            let difference = row.difference.as_ref().unwrap();
            assert!(out.path().join(difference).is_file(), "{difference}");
        }
    }
}

#[test]
fn a_sphere_that_is_wrong_on_the_gpu_is_a_wrong_row_before_anything_is_timed() {
    let request = request(&[("scene", "default"), ("renderer", "sequential,gpu")]);
    for wrong_sphere in [None, Some(0)] {
        let Some(gpu) = own_gpu(false) else { return };
        let out = tempfile::tempdir().unwrap();
        let workload = Spheres { wrong_sphere, ..Spheres::default() };
        let journal = measured_on(Some(gpu), &workload, &request, out.path());
        assert_eq!(of(&journal, "sequential").status, Status::Ok);
        let row = of(&journal, "gpu");
        if wrong_sphere.is_none() {
            assert_eq!((row.status, row.samples.is_some()), (Status::Ok, true), "{}", row.message);
            continue;
        }
        assert_eq!((row.status, row.samples.is_none()), (Status::Wrong, true), "{}", row.message);
        assert!(row.message.contains("pixels differ; the first is ("), "{}", row.message);
        assert!(out.path().join(row.difference.as_ref().unwrap()).is_file());
    }
}

#[test]
fn what_cannot_be_is_a_row_with_its_reason() {
    let out = tempfile::tempdir().unwrap();
    let absent = if cfg!(target_arch = "x86_64") { "neon" } else { "avx2" };
    let renderers = format!("sequential,simd:lanes=4,level={absent},gpu");
    let journal = measured(&Spheres::default(), &request(&[("renderer", &renderers)]), out.path());
    assert_eq!(of(&journal, "sequential").status, Status::Ok);
    let skipped = |renderer: &str| {
        let row = of(&journal, renderer);
        assert_eq!(row.status, Status::Skipped);
        row.message.clone()
    };
    assert!(skipped("simd").contains(absent), "{}", skipped("simd"));
    assert!(skipped("gpu").contains("no Vulkan device"));
    // Above the budget: need and limit, and the others are measured
    let out = tempfile::tempdir().unwrap();
    let values = [("renderer", "simd"), ("resolution", "8x4,64x32")];
    let request = Request { budget: Some(8 * 4 * 5 * 20 * 2), ..request(&values) };
    let journal = measured(&Spheres::default(), &request, out.path());
    let by_size = |size: &str| journal.rows.iter().find(|row| row.key.axis("resolution") == size).unwrap();
    assert_eq!(by_size("8x4").status, Status::Ok);
    let message = &by_size("64x32").message;
    assert!(message.starts_with("too large: ") && message.contains("409600 ray/sphere tests"), "{message}");
    assert!(message.contains("the budget is 6400"), "{message}");
}

/// A file that cannot be read ends nothing but its own rows; alone it is the error.
#[test]
fn a_broken_file_is_rows_and_no_end() {
    let folder = tempfile::tempdir().unwrap();
    let broken = folder.path().join("broken.json");
    std::fs::write(&broken, "{\"camera\": 3}").unwrap();
    let broken = broken.to_str().unwrap();
    let mut both = request(&[("renderer", "sequential")]);
    both.values.insert("scene".into(), vec![broken.into(), "random20".into()]);
    let out = tempfile::tempdir().unwrap();
    let journal = measured(&Spheres::default(), &both, out.path());
    let of_scene = |scene: &str| journal.rows.iter().find(|row| row.key.axis("scene") == scene).unwrap();
    assert_eq!(of_scene("random20").status, Status::Ok);
    assert_eq!(of_scene(broken).status, Status::Failed);
    assert!(of_scene(broken).message.contains("broken.json:1"), "{}", of_scene(broken).message);
    let absent = Plan::new(&SPHERES, &request(&[("renderer", "simd"), ("scene", "nowhere.json")])).unwrap_err();
    assert!(absent.to_string().contains("nowhere.json"), "{absent}");
}

/// What is far from the usual scenes is verified as well: very many spheres, bright light, long paths.
#[test]
fn unusual_scenes_are_verified() {
    let file = include_str!("../../../scenes/spheres/default.json");
    let mut scene: serde_json::Value = serde_json::from_str(file).unwrap();
    scene["lightData"]["directionalLightColor"] = serde_json::json!([50.0, 40.0, 30.0]);
    scene["rendering"] = serde_json::json!({"intensity": 1.0});
    for sphere in scene["spheres"].as_array_mut().unwrap() {
        sphere["color"] = serde_json::json!([1.0, 1.0, 1.0]);
    }
    let folder = tempfile::tempdir().unwrap();
    let bright = folder.path().join("bright.json");
    std::fs::write(&bright, scene.to_string()).unwrap();
    for (scene, trips) in
        [("random:spheres=20000,seed=3", "5"), (bright.to_str().unwrap(), "5"), (bright.to_str().unwrap(), "64")]
    {
        let mut request = request(&[("renderer", "simd-threads"), ("trips", trips), ("resolution", "16x9")]);
        request.values.insert("scene".into(), vec![scene.into()]);
        request.frames = Some(1);
        let out = tempfile::tempdir().unwrap();
        let journal = measured(&Spheres::default(), &request, out.path());
        assert_eq!(journal.rows[0].status, Status::Ok, "{scene} {trips}: {}", journal.rows[0].message);
    }
}

/// Half precision on the CPU: its error is measured, its speed is not.
#[test]
fn half_precision_has_an_error_and_no_speed() {
    let out = tempfile::tempdir().unwrap();
    let values = [("renderer", "sequential,threads"), ("precision", "f16,f32")];
    let journal = measured(&Spheres::default(), &request(&values), out.path());
    let rows = |precision: &str, renderer: &str| {
        let is = |row: &&Row| row.key.axis("precision") == precision && row.key.axis("renderer") == renderer;
        journal.rows.iter().find(is).unwrap()
    };
    assert_eq!(rows("f32", "sequential").status, Status::Ok);
    let half = rows("f16", "sequential");
    assert_eq!((half.status, half.samples.is_none()), (Status::Skipped, true));
    assert!(half.message.contains("speed not measured"), "{}", half.message);
    let rmse = half.metric(None, "rmse").and_then(|value| value.number()).unwrap();
    assert!(rmse > 1e-4 && rmse < 0.5, "{rmse}");
    assert!(rows("f16", "threads").message.contains("no half precision"));
    for file in ["random20-half.png", "random20-half-difference.png"] {
        assert!(out.path().join("pictures").join(file).is_file(), "{file}");
    }
}
