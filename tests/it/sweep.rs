//! The sweep loop on a device that breaks in the ways devices break, and the plan before it.

use crate::fakes::{Fault, Faulty};
use rtbench::harness::batch::order;
use rtbench::harness::plan::{Plan, Request, check_size, parse_list, parse_size};
use rtbench::harness::resume::Earlier;
use rtbench::harness::sweep::{self, Event, Job, Opened, Outcome};
use rtbench::record::journal::{FILE_NAME, Journal};
use rtbench::record::schema::{ConfigurationRecord, Failure, Status};
use rtbench::workloads::trace::CpuBackend;
use rtbench::workloads::trace::backend::{Backend, Config, Size};
use rtbench::workloads::trace::{Selection, Traversal};
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
    /// Rows of this session.
    finished: usize,
}

/// A sweep over `request()` with a fault in the grid's traversal, interrupted after so many rows; the device is opened
/// again by `again`.
fn swept(fault: Fault, rows: usize, again: &dyn Fn(Rc<Cell<bool>>) -> Result<Opened>) -> Swept {
    let folder = tempfile::tempdir().unwrap();
    let plan = Plan::new(&request()).unwrap();
    sweep_into(folder, &plan, Earlier::default(), fault, rows, again)
}

/// The same, of a plan, into a folder that may hold an earlier session's rows.
fn sweep_into(
    folder: tempfile::TempDir,
    plan: &Plan,
    earlier: Earlier,
    fault: Fault,
    rows: usize,
    again: &dyn Fn(Rc<Cell<bool>>) -> Result<Opened>,
) -> Swept {
    let spent = Rc::new(Cell::new(false));
    let (finished, opened_again) = (RefCell::new(0), Cell::new(0));
    let outcome = sweep::run(Job {
        plan,
        out: folder.path(),
        earlier,
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
    Swept { outcome, journal, folder, opened_again: opened_again.get(), finished: finished.into_inner() }
}

fn device(backend: Faulty) -> Opened {
    Opened { backend: Box::new(backend), reason: "a test".into() }
}

/// The same device comes back.
fn back(spent: Rc<Cell<bool>>) -> Result<Opened> {
    Ok(device(Faulty::new(Fault::LostOnce, Traversal::Grid, spent)))
}

/// Structure, configuration and status of each row, the grid's rows first.
fn rows(journal: &Journal) -> Vec<(&str, Config, Status)> {
    let mut rows: Vec<_> = journal.configurations.iter().map(|c| (c.structure.as_str(), c.config, c.status)).collect();
    rows.sort_by_key(|(structure, ..)| *structure != "grid");
    rows
}

/// The row of the grid with shadows.
fn grid_ps(journal: &Journal) -> &ConfigurationRecord {
    journal.configurations.iter().find(|row| row.structure == "grid" && row.config == Config::PS).unwrap()
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
fn a_timed_frame_that_is_not_the_verified_one_is_noticed() {
    let swept = swept(Fault::TimedDiffers, usize::MAX, &back);
    assert_eq!(swept.outcome.unwrap().disagreeing, 2);
    assert_eq!(rows(&swept.journal), [BAD_GRID, GOOD_STACK].concat());
    let bad = &swept.journal.configurations[0];
    assert!(bad.samples.is_none() && bad.message.contains("the last timed frame has 1 pixels"), "{}", bad.message);
}

#[test]
fn images_of_a_few_pixels() {
    let plan = Plan::new(&Request { resolutions: vec!["1,3x5".into()], ..request() }).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let swept = sweep_into(folder, &plan, Earlier::default(), Fault::None, usize::MAX, &back);
    assert_eq!((swept.outcome.unwrap().failed, swept.finished), (0, 8));
    assert!(swept.journal.configurations.iter().all(|row| row.status == Status::Ok), "{:?}", rows(&swept.journal));
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
    assert_eq!(grid_ps(&swept.journal).message, "device lost: the driver reset");
}

#[test]
fn what_does_not_fit_beside_others_is_measured_alone() {
    let plan = Plan::new(&Request { structures: vec!["bvh-stack,grid".into()], ..request() }).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let swept = sweep_into(folder, &plan, Earlier::default(), Fault::NoRoomBeside, usize::MAX, &back);
    assert_eq!((swept.outcome.unwrap().failed, swept.journal.structures.len()), (0, 2));
    let good_grid = [("grid", Config::P, Status::Ok), ("grid", Config::PS, Status::Ok)];
    assert_eq!(rows(&swept.journal), [good_grid, GOOD_STACK].concat());
    assert!(swept.journal.configurations.iter().all(|row| row.turns == 1));
}

#[test]
fn structures_take_turns_pass_by_pass() {
    let timed = Rc::new(RefCell::new(Vec::new()));
    let backend = Faulty::new(Fault::None, Traversal::Grid, Rc::default()).watched(timed.clone());
    let request = Request { configs: vec!["P".into()], passes: Some(4), warmup_frames: Some(1), ..request() };
    let folder = tempfile::tempdir().unwrap();
    let outcome = sweep::run(Job {
        plan: &Plan::new(&request).unwrap(),
        out: folder.path(),
        earlier: Earlier::default(),
        threads: 1,
        arguments: vec!["rtbench".into()],
        device: device(backend),
        open: &|| back(Rc::default()),
        interrupted: &|| false,
        watch: &mut |_| (),
    });
    assert_eq!(outcome.unwrap().failed, 0);
    // A frame to warm up, then the path's two, of one and then of the other, and back
    let (grid, stack) = (Traversal::Grid, Traversal::BvhStack);
    let turns = [grid, stack, stack, grid, stack, grid, grid, stack];
    let expected: Vec<_> = turns.into_iter().flat_map(|who| [(who, 1), (who, 2)]).collect();
    assert_eq!(*timed.borrow(), expected);
    let journal = Journal::read(&folder.path().join(FILE_NAME)).unwrap();
    assert!(journal.configurations.iter().all(|row| row.turns == 2), "{:?}", rows(&journal));
}

/// `rtbench build`, which brings nothing to a device, gives the sizes that a sweep gives.
#[test]
fn sizes_are_the_same_without_a_device() {
    let scene = rtbench::scene::load("hall:triangles=15000").unwrap();
    let cpu = CpuBackend::new(1).unwrap();
    for structure in ["grid", "kdtree", "bvh-stack"] {
        let selection = Selection::parse(structure).unwrap();
        let built = selection.build(&scene, 1).unwrap();
        let allocated = cpu.prepare(&scene, &built.structure, selection.method()).unwrap().allocated();
        assert_eq!(sweep::memory(&built, &scene, None), sweep::memory(&built, &scene, Some(allocated)), "{structure}");
    }
}

#[test]
fn turns_are_fair() {
    assert_eq!((order(0, 3), order(1, 3)), (vec![], vec![0]));
    for count in 2..7 {
        // Within two passes everybody has the same mean place; within all everybody begins as often as the others
        let mut first = vec![0; count];
        for pair in 0..count {
            let (there, back) = (order(count, 2 * pair), order(count, 2 * pair + 1));
            let place = |order: &[usize], who| order.iter().position(|&other| other == who).unwrap();
            assert!((0..count).all(|who| place(&there, who) + place(&back, who) == count - 1), "{there:?} {back:?}");
            first[there[0]] += 1;
        }
        assert!(first.iter().all(|&times| times == 1), "{first:?}");
    }
}

#[test]
fn a_device_that_does_not_come_back_ends_the_sweep() {
    let gone = |_| Err(Error::Device("no such device".into()));
    let other = |spent| Ok(device(Faulty::new(Fault::None, Traversal::Grid, spent).named("another")));
    for again in [&gone as &dyn Fn(_) -> Result<Opened>, &other] {
        let swept = swept(Fault::LostOnce, usize::MAX, again);
        let error = swept.outcome.unwrap_err();
        assert!(matches!(error, Error::DeviceLost(_)) && error.exit_code() == 2, "{error}");
        // Both rows with primary rays alone, and the one that lost it
        assert_eq!(swept.journal.configurations.len(), 3);
        assert!(!swept.journal.end.unwrap().complete);
        let summary = std::fs::read_to_string(swept.folder.path().join("summary.csv")).unwrap();
        assert_eq!(summary.lines().count(), 4);
    }
}

#[test]
fn an_interrupt_keeps_the_rows() {
    let swept = swept(Fault::None, 1, &back);
    let error = swept.outcome.unwrap_err();
    assert!(matches!(error, Error::Interrupted) && error.exit_code() == 130);
    // What had taken turns with the first row was measured as well
    assert_eq!(swept.journal.configurations.len(), 2);
    assert!(swept.journal.end.unwrap().interrupted);
    for file in ["summary.csv", "structures.csv", "run.json"] {
        assert!(swept.folder.path().join(file).is_file(), "{file}");
    }
}

#[test]
fn a_run_is_taken_up_where_it_was_interrupted() {
    let first = swept(Fault::None, 1, &back);
    let (folder, kept) = (first.folder, first.journal.configurations[0].clone());
    // Killed while it wrote: half a line more
    let path = folder.path().join(FILE_NAME);
    let mut bytes = std::fs::read(&path).unwrap();
    bytes.extend(b"{\"record\":\"configuration\",\"scene\":");
    std::fs::write(&path, bytes).unwrap();
    let earlier = Earlier::read(folder.path()).unwrap();
    assert_eq!((earlier.settled(), earlier.is_complete()), (2, false));
    let plan = Plan::new(&request()).unwrap();
    let second = sweep_into(folder, &plan, earlier, Fault::None, usize::MAX, &back);
    let outcome = second.outcome.unwrap();
    assert_eq!((outcome.disagreeing, outcome.failed, second.finished), (0, 0, 2));
    let journal = &second.journal;
    assert_eq!((journal.configurations.len(), journal.structures.len(), journal.resumed.len()), (4, 2, 1));
    assert_eq!(journal.configurations[0], kept);
    assert!(journal.end.as_ref().unwrap().complete && journal.truncated.is_none());
    // As if it had run in one go, but for what the clocks say
    let whole = swept(Fault::None, usize::MAX, &back).journal;
    let facts = |journal: &Journal| {
        let rows = journal.configurations.iter();
        rows.map(|r| (r.identity(), r.counters, r.image_hash.clone(), r.reference_image_hash.clone()))
            .collect::<Vec<_>>()
    };
    assert_eq!(facts(journal), facts(&whole));
    assert!(outcome.run.resumed.len() == 1 && outcome.run.configurations.len() == 4);
    let earlier = Earlier::read(second.folder.path()).unwrap();
    assert!(earlier.is_complete() && earlier.settled() == 4);
}

#[test]
fn a_row_that_lost_the_device_is_tried_again_and_a_wrong_one_is_not() {
    let plan = Plan::new(&request()).unwrap();
    let lost = swept(Fault::LostOnce, usize::MAX, &back);
    assert_eq!(grid_ps(&lost.journal).failure, Some(Failure::Device));
    let earlier = Earlier::read(lost.folder.path()).unwrap();
    assert_eq!((earlier.settled(), earlier.is_complete()), (3, false));
    let again = sweep_into(lost.folder, &plan, earlier, Fault::None, usize::MAX, &back);
    assert_eq!((again.finished, again.outcome.unwrap().failed), (1, 0));
    let good_grid = [("grid", Config::P, Status::Ok), ("grid", Config::PS, Status::Ok)];
    assert_eq!(rows(&again.journal), [good_grid, GOOD_STACK].concat());

    let wrong = swept(Fault::WrongTriangle, 3, &back);
    let earlier = Earlier::read(wrong.folder.path()).unwrap();
    let again = sweep_into(wrong.folder, &plan, earlier, Fault::None, usize::MAX, &back);
    assert_eq!((again.finished, again.outcome.unwrap().disagreeing), (1, 2));
    assert_eq!(rows(&again.journal), [BAD_GRID, GOOD_STACK].concat());
}

#[test]
fn a_run_is_not_taken_up_by_another_program_device_or_plan() {
    let refused = |change: &dyn Fn(&mut String), plan: &Plan| {
        let first = swept(Fault::None, 1, &back);
        let path = first.folder.path().join(FILE_NAME);
        let mut text = std::fs::read_to_string(&path).unwrap();
        change(&mut text);
        std::fs::write(&path, &text).unwrap();
        let earlier = Earlier::read(first.folder.path()).unwrap();
        let second = sweep_into(first.folder, plan, earlier, Fault::None, usize::MAX, &back);
        // Nothing is added
        assert_eq!(std::fs::read_to_string(second.folder.path().join(FILE_NAME)).unwrap(), text);
        let error = second.outcome.unwrap_err();
        assert!(matches!(error, Error::Input(_)) && error.exit_code() == 2, "{error}");
        error.to_string()
    };
    let replace = |from: &str, to: &str| {
        let (from, to) = (from.to_owned(), to.to_owned());
        move |text: &mut String| {
            assert!(text.contains(&from), "{from}");
            *text = text.replacen(&from, &to, 1);
        }
    };
    let plan = Plan::new(&request()).unwrap();
    let hash = rtbench::harness::environment::program().executable_hash.unwrap();
    let error = refused(&replace(&hash, "0123"), &plan);
    assert!(error.contains("another build of the program") && error.contains("begin a new run"), "{error}");
    let error = refused(&replace("\"device\":{\"name\":\"", "\"device\":{\"name\":\"not "), &plan);
    assert!(error.contains("it was measured on not "), "{error}");
    let error = refused(&replace("\"logical_cpus\":", "\"logical_cpus\":1000"), &plan);
    assert!(error.contains("the machine"), "{error}");
    let more = Plan::new(&Request { passes: Some(3), ..request() }).unwrap();
    assert!(refused(&|_| (), &more).contains("not the same"));
}

/// Two programs that write one journal would measure the same rows, at the same time.
#[test]
fn a_run_that_is_being_written_is_not_taken_up() {
    let first = swept(Fault::None, 1, &back);
    let path = first.folder.path().join(FILE_NAME);
    let text = std::fs::read(&path).unwrap();
    let plan = Plan::new(&request()).unwrap();
    let refused = |folder, earlier| {
        let second = sweep_into(folder, &plan, earlier, Fault::None, usize::MAX, &back);
        let error = second.outcome.unwrap_err();
        assert!(matches!(error, Error::Input(_)), "{error}");
        assert!(error.to_string().contains("another sweep is writing this run"), "{error}");
        second.folder
    };
    let writer = std::fs::File::open(&path).unwrap();
    writer.lock().unwrap();
    let folder = refused(first.folder, Earlier::read(path.parent().unwrap()).unwrap());
    assert_eq!(std::fs::read(&path).unwrap(), text);
    // One that wrote to it and is done
    drop(writer);
    let earlier = Earlier::read(path.parent().unwrap()).unwrap();
    let more = [&text[..], text.split_inclusive(|&b| b == b'\n').next_back().unwrap()].concat();
    std::fs::write(&path, &more).unwrap();
    let folder = refused(folder, earlier);
    assert_eq!(std::fs::read(&path).unwrap(), more);
    // Alone it goes on
    std::fs::write(&path, &text).unwrap();
    let earlier = Earlier::read(path.parent().unwrap()).unwrap();
    assert!(sweep_into(folder, &plan, earlier, Fault::None, usize::MAX, &back).outcome.is_ok());
}

#[test]
fn a_scene_that_the_preset_names_keeps_its_own_parts() {
    let file = tempfile::Builder::new().suffix(".toml").tempfile().unwrap();
    let preset = "structures = [\"grid\", \"bvh\"]\nconfigs = [\"P\"]\nresolutions = [\"64\"]\npasses = 1\nwarmup_frames = 0\n\
        [[scene]]\nscene = \"hall\"\nstructures = [\"grid:x=9\"]\n\
        [[scene]]\nscene = \"scan\"\n\
        [[scene]]\nscene = \"hall\"\nstructures = [\"kdtree\"]\nresolutions = [\"32\"]\n";
    std::fs::write(file.path(), preset).unwrap();
    let plan = |scene: &str, structures: &[&str]| {
        let plan = Plan::new(&Request {
            preset: file.path().to_str().unwrap().into(),
            scenes: vec![scene.into()],
            structures: structures.iter().map(|s| s.to_string()).collect(),
            ..Request::default()
        });
        let part = |part: &rtbench::harness::plan::Part| {
            let names = part.selections.iter().map(|s| format!("{} {}", s.name(), s.variant()));
            (names.collect::<Vec<_>>().join(", "), part.sizes[0].width)
        };
        plan.unwrap().parts.iter().map(part).collect::<Vec<_>>()
    };
    assert_eq!(plan("hall", &[]), [("grid x=9".into(), 64), ("kdtree default".into(), 32)]);
    assert_eq!(plan("scan", &[]), [("grid default, bvh default".into(), 64)]);
    assert_eq!(plan("hall", &["bvh-stack"]), [("bvh-stack default".into(), 64)]);
    assert_eq!(plan("room", &[]), [("grid default, bvh default".into(), 64)]);
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
