//! The sweep loop on a device that breaks in the ways devices break, and the plan before it.

use crate::fakes::{Fault, Faulty};
use rtbench::accel::{Selection, Traversal};
use rtbench::backend::{Config, Size};
use rtbench::bench::plan::{Plan, Request, check_size, parse_list, parse_size};
use rtbench::bench::sweep::{self, Event, Job, Opened, Outcome};
use rtbench::results::journal::{FILE_NAME, Journal};
use rtbench::results::record::{Failure, Status};
use rtbench::{Error, Result};
use std::cell::{Cell, RefCell};
use std::rc::Rc;

fn request() -> Request {
    Request {
        preset: "quick".into(),
        scenes: vec!["scan:triangles=1000".into()],
        structures: vec!["grid,bvh-stack".into()],
        configs: vec!["P,PS".into()],
        resolutions: vec!["24x16".into()],
        frames: Some(2),
        passes: Some(2),
        ..Request::default()
    }
}

/// What came of a sweep.
struct Swept {
    outcome: Result<Outcome>,
    journal: Journal,
    folder: tempfile::TempDir,
    opened_again: usize,
}

/// A sweep over `request()` with a fault in the grid's traversal, interrupted after so many rows; the device is opened
/// again by `again`.
fn swept(fault: Fault, rows: usize, again: &dyn Fn(Rc<Cell<bool>>) -> Result<Opened>) -> Swept {
    let folder = tempfile::tempdir().unwrap();
    let plan = Plan::new(&request()).unwrap();
    let spent = Rc::new(Cell::new(false));
    let (finished, opened_again) = (RefCell::new(0), Cell::new(0));
    let outcome = sweep::run(Job {
        plan: &plan,
        out: folder.path(),
        threads: 1,
        arguments: vec!["rtbench".into()],
        device: device(Faulty::new(fault, Traversal::Grid, spent.clone())),
        open: &|| {
            opened_again.set(opened_again.get() + 1);
            again(spent.clone())
        },
        interrupted: &|| *finished.borrow() >= rows,
        watch: &mut |event| {
            if let Event::Finished(_) = event {
                *finished.borrow_mut() += 1;
            }
        },
    });
    let journal = Journal::read(&folder.path().join(FILE_NAME)).unwrap();
    Swept { outcome, journal, folder, opened_again: opened_again.get() }
}

fn device(backend: Faulty) -> Opened {
    Opened { backend: Box::new(backend), reason: "a test".into() }
}

/// The same device comes back.
fn back(spent: Rc<Cell<bool>>) -> Result<Opened> {
    Ok(device(Faulty::new(Fault::LostOnce, Traversal::Grid, spent)))
}

/// Structure, configuration and status of each row.
fn rows(journal: &Journal) -> Vec<(&str, Config, Status)> {
    journal.configurations.iter().map(|c| (c.structure.as_str(), c.config, c.status)).collect()
}

const GOOD_STACK: [(&str, Config, Status); 2] =
    [("bvh-stack", Config::P, Status::Ok), ("bvh-stack", Config::PS, Status::Ok)];
const BAD_GRID: [(&str, Config, Status); 2] = [("grid", Config::P, Status::Error), ("grid", Config::PS, Status::Error)];

#[test]
fn everything_in_order() {
    let swept = swept(Fault::None, usize::MAX, &back);
    let outcome = swept.outcome.unwrap();
    assert_eq!((outcome.disagreeing, outcome.failed, swept.opened_again), (0, 0, 0));
    assert_eq!(swept.journal.structures.len(), 2);
    assert_eq!(swept.journal.configurations.len(), 4);
    assert!(swept.journal.end.unwrap().complete);
    for row in &swept.journal.configurations {
        assert!(row.status == Status::Ok && row.verified, "{row:?}");
        // Twice on the small image with the twin, once at full size.
        assert_eq!(row.verification.iter().map(|v| v.twin).collect::<Vec<_>>(), [true, true, false]);
        let samples = row.samples.as_ref().unwrap();
        assert_eq!((samples.wall_ns.len(), samples.wall_ns[0].len()), (2, 2));
        assert_eq!(row.counters.unwrap()[0].rays, 2 * 24 * 16);
        assert_eq!(row.counters.unwrap()[1].rays > 0, row.config == Config::PS);
        assert_eq!(row.image_hash, row.reference_image_hash);
    }
}

#[test]
fn a_wrong_pixel_is_an_error_row_without_a_time() {
    let swept = swept(Fault::WrongTriangle, usize::MAX, &back);
    let outcome = swept.outcome.unwrap();
    assert_eq!((outcome.disagreeing, outcome.failed), (2, 0));
    assert_eq!(rows(&swept.journal), [BAD_GRID, GOOD_STACK].concat());
    let bad = &swept.journal.configurations[0];
    assert_eq!((bad.failure, bad.verified), (Some(Failure::Verification), false));
    assert!(bad.samples.is_none() && bad.counters.is_none() && !bad.message.is_empty());
    let picture = swept.folder.path().join(bad.difference.as_ref().unwrap());
    assert!(image::open(&picture).unwrap().width() > 0);
    assert!(outcome.run.configurations[0].frame_ms_mean.is_none());
}

#[test]
fn a_counting_kernel_that_draws_something_else_is_noticed() {
    let swept = swept(Fault::CountingDiffers, usize::MAX, &back);
    assert_eq!(swept.outcome.unwrap().disagreeing, 2);
    assert_eq!(rows(&swept.journal), [BAD_GRID, GOOD_STACK].concat());
}

#[test]
fn what_does_not_fit_is_an_error_row() {
    let swept = swept(Fault::NoRoom, usize::MAX, &back);
    let outcome = swept.outcome.unwrap();
    assert_eq!((outcome.disagreeing, outcome.failed, swept.opened_again), (0, 2, 0));
    assert_eq!(rows(&swept.journal), [BAD_GRID, GOOD_STACK].concat());
    assert!(swept.journal.configurations[0].message.contains("5 GiB"));
}

#[test]
fn a_lost_device_costs_one_row() {
    let swept = swept(Fault::LostOnce, usize::MAX, &back);
    let outcome = swept.outcome.unwrap();
    assert_eq!((outcome.disagreeing, outcome.failed, swept.opened_again), (0, 1, 1));
    let lost = [("grid", Config::P, Status::Ok), ("grid", Config::PS, Status::Error)];
    assert_eq!(rows(&swept.journal), [lost, GOOD_STACK].concat());
    assert_eq!(swept.journal.configurations[1].message, "device lost: the driver reset");
}

#[test]
fn a_device_that_does_not_come_back_ends_the_sweep() {
    let gone = |_| Err(Error::Device("no such device".into()));
    let other = |spent| Ok(device(Faulty::new(Fault::None, Traversal::Grid, spent).named("another")));
    for again in [&gone as &dyn Fn(_) -> Result<Opened>, &other] {
        let swept = swept(Fault::LostOnce, usize::MAX, again);
        let error = swept.outcome.unwrap_err();
        assert!(matches!(error, Error::DeviceLost(_)) && error.exit_code() == 2, "{error}");
        assert_eq!(swept.journal.configurations.len(), 2);
        assert!(!swept.journal.end.unwrap().complete);
        let summary = std::fs::read_to_string(swept.folder.path().join("summary.csv")).unwrap();
        assert_eq!(summary.lines().count(), 3);
    }
}

#[test]
fn an_interrupt_keeps_the_rows() {
    let swept = swept(Fault::None, 1, &back);
    let error = swept.outcome.unwrap_err();
    assert!(matches!(error, Error::Interrupted) && error.exit_code() == 130);
    assert_eq!(swept.journal.configurations.len(), 1);
    assert!(swept.journal.end.unwrap().interrupted);
    for file in ["summary.csv", "structures.csv", "run.json"] {
        assert!(swept.folder.path().join(file).is_file(), "{file}");
    }
}

#[test]
fn presets_are_sound() {
    let plan = Plan::new(&Request { preset: "quick".into(), ..Request::default() }).unwrap();
    let names: Vec<&str> = plan.parts[0].selections.iter().map(|s| s.name()).collect();
    assert_eq!(names, ["grid", "kdtree", "bvh", "bvh-stack", "ploc-stack"]);
    assert_eq!((plan.parts[0].configs.len(), plan.parts[0].sizes.len(), plan.configurations()), (3, 2, 90));
    plan.survey().unwrap();
    // The thesis's scenes are not here: nothing takes their place.
    let nowhere = tempfile::tempdir().unwrap();
    let mut thesis =
        Request { preset: "thesis".into(), scenes_folder: Some(nowhere.path().into()), ..Request::default() };
    let error = Plan::new(&thesis).unwrap_err().to_string();
    assert!(error.contains("bunny") && error.contains("https://"), "{error}");
    std::fs::create_dir(nowhere.path().join("dragon")).unwrap();
    std::fs::write(nowhere.path().join("dragon/dragon_vrip.ply"), "").unwrap();
    let plan = Plan::new(&thesis).unwrap();
    assert_eq!((plan.scenes(), plan.skipped.len()), (vec!["dragon"], 8));
    assert_eq!(plan.parts[0].frames, None);
    assert_eq!(plan.parts[0].sizes.iter().map(|s| s.width).collect::<Vec<_>>(), [256, 512, 768, 1024]);
    thesis.frames = Some(10);
    assert!(Plan::new(&thesis).unwrap().parts.iter().all(|part| part.frames == Some(10)));
}

#[test]
fn lists_of_structures_with_options() {
    let parse = |texts: &[&str]| {
        let texts: Vec<String> = texts.iter().map(|t| t.to_string()).collect();
        parse_list(&texts, Selection::parse)
    };
    let names = |s: Vec<Selection>| s.iter().map(|s| format!("{} {}", s.name(), s.variant())).collect::<Vec<_>>();
    assert_eq!(names(parse(&["grid,bvh", "grid"]).unwrap()), ["grid default", "bvh default"]);
    let list = parse(&["grid:x=64,y=32,bvh", "kdtree:bins=8"]).unwrap();
    assert_eq!(names(list), ["grid x=64,y=32", "bvh default", "kdtree bins=8"]);
    for wrong in ["", "grid,", "octree", "grid:x", "bins=8", "grid:q=1"] {
        assert!(matches!(parse(&[wrong]), Err(Error::Input(_))), "{wrong}");
    }
}

#[test]
fn sizes() {
    assert_eq!(parse_size("512").unwrap(), Size { width: 512, height: 512 });
    assert_eq!(parse_size("640x480").unwrap(), Size { width: 640, height: 480 });
    for wrong in ["0", "0x5", "5x0", "", "x", "5x", "-1", "1.5", "1x2x3", "4294967296", "65536x65536", "ten"] {
        let error = parse_size(wrong).unwrap_err().to_string();
        assert!(error.starts_with("--resolution: ") && !error.contains('\n'), "{wrong}: {error}");
    }
    let mut device = crate::fakes::provenance().device;
    device.limits = [("max_storage_buffer_binding_size".to_owned(), 8 * 100)].into();
    assert!(check_size(Size { width: 10, height: 10 }, &device).is_ok());
    let error = check_size(Size { width: 10, height: 11 }, &device).unwrap_err().to_string();
    assert!(error.contains("max_storage_buffer_binding_size = 800"), "{error}");
}
