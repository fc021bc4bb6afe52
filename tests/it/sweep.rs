//! The measuring loop on a device that breaks in the ways devices break, and the plan before it.

use crate::fakes::{Fault, Seen, Step, faulty};
use rtbench::device::{CpuDevice, Device};
use rtbench::harness::previous::PreviousRun;
use rtbench::harness::run::{self, Job, Opened, Outcome};
use rtbench::harness::workload::{Event, Library};
use rtbench::harness::{Plan, Request, order, parse_list};
use rtbench::record::journal::{FILE_NAME, Journal};
use rtbench::record::row::{Row, Status};
use rtbench::workloads::size::parse_size;
use rtbench::workloads::trace::backend::{Backend, Size};
use rtbench::workloads::trace::{Selection, TRACE, Trace, input};
use rtbench::{Error, Result};
use std::cell::{Cell, RefCell};
use std::sync::Arc;

/// Values by axis.
fn values(pairs: &[(&str, &[&str])]) -> std::collections::BTreeMap<String, Vec<String>> {
    pairs.iter().map(|(axis, values)| (axis.to_string(), values.iter().map(|v| v.to_string()).collect())).collect()
}

fn request() -> Request {
    Request {
        values: values(&[
            ("scene", &["scan:triangles=1000"]),
            ("structure", &["grid,bvh-stack"]),
            ("config", &["P,PS"]),
            ("resolution", &["24x16"]),
        ]),
        frames: Some(2),
        passes: Some(2),
        ..Request::default()
    }
}

fn with(axis: &str, value: &str) -> Request {
    let mut request = request();
    request.values.insert(axis.into(), vec![value.into()]);
    request
}

fn plan() -> Plan {
    Plan::new(&TRACE, &request()).unwrap()
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
fn swept(fault: Fault, rows: usize, again: &dyn Fn() -> Result<Opened>) -> Swept {
    let folder = tempfile::tempdir().unwrap();
    sweep_into(folder, &plan(), PreviousRun::default(), fault, rows, again)
}

/// The same, of a plan, into a folder that may hold an earlier session's rows.
fn sweep_into(
    folder: tempfile::TempDir,
    plan: &Plan,
    previous: PreviousRun,
    fault: Fault,
    rows: usize,
    again: &dyn Fn() -> Result<Opened>,
) -> Swept {
    sweep_with(&faulty(fault, "grid", Arc::default()), folder, plan, previous, rows, again)
}

fn sweep_with(
    workload: &Trace,
    folder: tempfile::TempDir,
    plan: &Plan,
    previous: PreviousRun,
    rows: usize,
    again: &dyn Fn() -> Result<Opened>,
) -> Swept {
    let (finished, opened_again) = (RefCell::new(0), Cell::new(0));
    let outcome = run::run(Job {
        workload,
        plan,
        out: folder.path(),
        previous,
        arguments: vec!["rtbench".into()],
        devices: vec![device()],
        open: &|_| {
            opened_again.set(opened_again.get() + 1);
            again()
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

fn device() -> Opened {
    Opened { device: Device::Cpu(CpuDevice::new(1).unwrap()), reason: "a test".into() }
}

/// The same device comes back.
fn back() -> Result<Opened> {
    Ok(device())
}

/// Structure, configuration and status of each row, the grid's rows first.
fn rows(journal: &Journal) -> Vec<(&str, &str, Status)> {
    let mut rows: Vec<_> =
        journal.rows.iter().map(|row| (row.key.axis("structure"), row.key.axis("config"), row.status)).collect();
    rows.sort_by_key(|(structure, ..)| *structure != "grid");
    rows
}

/// Both rows of the grid with a status, and good rows of the other structure.
fn grid_rows(status: Status) -> Vec<(&'static str, &'static str, Status)> {
    vec![("grid", "P", status), ("grid", "PS", status), ("bvh-stack", "P", Status::Ok), ("bvh-stack", "PS", Status::Ok)]
}

/// The row of the grid with shadows.
fn grid_ps(journal: &Journal) -> &Row {
    journal.rows.iter().find(|row| row.key.axis("structure") == "grid" && row.key.axis("config") == "PS").unwrap()
}

/// Numbers of rows that are wrong, failed and skipped.
fn counts(outcome: &Outcome) -> [usize; 3] {
    [Status::Wrong, Status::Failed, Status::Skipped].map(|status| outcome.count(status))
}

#[test]
fn everything_in_order() {
    let swept = swept(Fault::None, usize::MAX, &back);
    assert_eq!((counts(&swept.outcome.unwrap()), swept.opened_again), ([0, 0, 0], 0));
    assert_eq!((swept.journal.artifacts.len(), swept.journal.rows.len()), (2, 4));
    // The scene, and a camera path for rays with shadows and one for rays without
    assert_eq!(swept.journal.inputs.len(), 3);
    assert!(swept.journal.end.as_ref().unwrap().complete);
    for row in &swept.journal.rows {
        assert!(row.status == Status::Ok && row.message.is_empty(), "{row:?}");
        // Twice on the small image with the twin, once at full size.
        let twin = |check: &rtbench::record::row::Check| {
            check.metrics.iter().any(|m| m.name == "twin" && m.value == 1u64.into())
        };
        assert_eq!(row.checks.iter().map(twin).collect::<Vec<_>>(), [true, true, false]);
        let samples = row.samples.as_ref().unwrap();
        assert_eq!((samples.wall_ns.len(), samples.wall_ns[0].len()), (2, 2));
        let rays = |of: &str| row.metric(Some(of), "rays").unwrap().integer().unwrap();
        assert_eq!(rays("primary"), 2 * 24 * 16);
        assert_eq!(rays("shadow") > 0, row.key.axis("config") == "PS");
        assert_eq!(row.outputs["image"], row.outputs["reference_image"]);
        assert!(row.metric(None, "structure_bytes").unwrap().integer().unwrap() > 0);
        assert_eq!(row.key.axis("camera_path"), swept.journal.input(&row.key, "camera_path").unwrap().name);
        assert_eq!((row.key.axis("scene"), row.key.axis("frames")), ("scan:triangles=1000", "2"));
    }
}

#[test]
fn a_wrong_pixel_is_a_row_without_a_time() {
    let swept = swept(Fault::WrongTriangle, usize::MAX, &back);
    assert_eq!(counts(&swept.outcome.unwrap()), [2, 0, 0]);
    assert_eq!(rows(&swept.journal), grid_rows(Status::Wrong));
    let bad = &swept.journal.rows[0];
    assert!(bad.samples.is_none() && bad.metric(Some("primary"), "rays").is_none() && !bad.message.is_empty());
    let picture = swept.folder.path().join(bad.difference.as_ref().unwrap());
    assert!(image::open(&picture).unwrap().width() > 0);
    let summary = std::fs::read_to_string(swept.folder.path().join("summary.csv")).unwrap();
    let mut lines = csv::Reader::from_reader(summary.as_bytes());
    let column = lines.headers().unwrap().iter().position(|name| name == "frame_ms_mean").unwrap();
    assert_eq!(&lines.records().next().unwrap().unwrap()[column], "");
}

#[test]
fn a_counting_kernel_that_draws_something_else_is_noticed() {
    let swept = swept(Fault::CountingDiffers, usize::MAX, &back);
    assert_eq!(counts(&swept.outcome.unwrap()), [2, 0, 0]);
    assert_eq!(rows(&swept.journal), grid_rows(Status::Wrong));
}

#[test]
fn a_timed_frame_that_is_not_the_verified_one_is_noticed() {
    let swept = swept(Fault::TimedDiffers, usize::MAX, &back);
    assert_eq!(counts(&swept.outcome.unwrap()), [2, 0, 0]);
    assert_eq!(rows(&swept.journal), grid_rows(Status::Wrong));
    let bad = &swept.journal.rows[0];
    assert!(bad.samples.is_none() && bad.message.contains("the last timed frame has 1 pixels"), "{}", bad.message);
}

/// Each kind of refusal and failure at each step is a row, and all other rows are measured.
#[test]
fn what_a_case_cannot_do_is_a_row_at_every_step() {
    for step in [Step::Prepare, Step::Verify, Step::Count, Step::Pass, Step::Recheck] {
        for (fault, status, words) in [
            (Fault::TooLarge(step), Status::Skipped, "too large: the structure: 5 GiB are needed"),
            (Fault::Unsupported(step), Status::Skipped, "unsupported: no such feature"),
            (Fault::Device(step), Status::Failed, "the driver says no"),
        ] {
            let swept = swept(fault, usize::MAX, &back);
            assert_eq!(swept.opened_again, 0, "{fault:?}");
            assert_eq!(rows(&swept.journal), grid_rows(status), "{fault:?}");
            let bad = grid_ps(&swept.journal);
            assert!(bad.message.contains(words) && bad.samples.is_none(), "{fault:?}: {}", bad.message);
            // What was built is known all the same
            assert!(bad.metric(None, "build_ms").is_some() && bad.metric(None, "nodes").is_none(), "{fault:?}");
            assert!(swept.outcome.unwrap().journal.end.unwrap().complete, "{fault:?}");
        }
    }
}

/// A builder that refuses a scene leaves the other structures and scenes measured.
#[test]
fn a_structure_that_cannot_be_built_is_a_row() {
    let mut request = with("structure", "grid:x=1000000,bvh-stack");
    request.values.insert("scene".into(), vec!["scan:triangles=1000".into(), "hall:triangles=15000".into()]);
    let plan = Plan::new(&TRACE, &request).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let swept = sweep_into(folder, &plan, PreviousRun::default(), Fault::None, usize::MAX, &back);
    assert_eq!(counts(&swept.outcome.unwrap()), [0, 0, 4]);
    assert_eq!(swept.journal.rows.iter().filter(|row| row.status == Status::Ok).count(), 4);
    let refused = grid_ps(&swept.journal);
    assert!(refused.message.starts_with("too large: grid over scan") && refused.message.contains("cells, more than"));
    assert_eq!((refused.key.axis("build"), refused.key.axis("traversal")), ("x=1000000", ""));
    // It is not tried again
    let previous = PreviousRun::read(swept.folder.path()).unwrap();
    assert!(previous.is_complete() && previous.done() == 8);
}

/// A scene that cannot be read costs its own rows.
#[test]
fn an_input_that_cannot_be_read_is_rows() {
    let broken = tempfile::Builder::new().suffix(".ply").tempfile().unwrap();
    std::fs::write(broken.path(), "ply\nformat ascii 1.0\nnonsense\n").unwrap();
    let mut request = request();
    let scenes = vec![broken.path().to_str().unwrap().to_owned(), "scan:triangles=1000".into()];
    request.values.insert("scene".into(), scenes);
    let plan = Plan::new(&TRACE, &request).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let swept = sweep_into(folder, &plan, PreviousRun::default(), Fault::None, usize::MAX, &back);
    assert_eq!(counts(&swept.outcome.unwrap()), [0, 4, 0]);
    assert!(swept.journal.rows[0].message.contains("end_header"), "{}", swept.journal.rows[0].message);
    assert_eq!(swept.journal.rows.iter().filter(|row| row.status == Status::Ok).count(), 4);
    // Alone, it is the error of the run, and nothing is begun
    request.values.insert("scene".into(), vec![broken.path().to_str().unwrap().to_owned()]);
    let folder = tempfile::tempdir().unwrap();
    let ended = run::run(Job {
        workload: &TRACE,
        plan: &Plan::new(&TRACE, &request).unwrap(),
        out: folder.path(),
        previous: PreviousRun::default(),
        arguments: vec![],
        devices: vec![device()],
        open: &|_| back(),
        interrupted: &|| false,
        watch: &mut |_| (),
    });
    assert!(matches!(ended, Err(Error::Input(_))) && !folder.path().join(FILE_NAME).exists());
}

#[test]
fn images_of_a_few_pixels() {
    let plan = Plan::new(&TRACE, &with("resolution", "1,3x5")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let swept = sweep_into(folder, &plan, PreviousRun::default(), Fault::None, usize::MAX, &back);
    assert_eq!((counts(&swept.outcome.unwrap()), swept.finished), ([0, 0, 0], 8));
    assert!(swept.journal.rows.iter().all(|row| row.status == Status::Ok), "{:?}", rows(&swept.journal));
}

#[test]
fn a_lost_device_costs_one_row() {
    let swept = swept(Fault::LostOnce, usize::MAX, &back);
    assert_eq!((counts(&swept.outcome.unwrap()), swept.opened_again), ([0, 1, 0], 1));
    let mut expected = grid_rows(Status::Ok);
    expected[1].2 = Status::Failed;
    assert_eq!(rows(&swept.journal), expected);
    assert_eq!(grid_ps(&swept.journal).message, "device lost: the driver reset");
}

#[test]
fn what_does_not_fit_next_to_others_is_measured_alone() {
    let plan = Plan::new(&TRACE, &with("structure", "bvh-stack,grid")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let swept = sweep_into(folder, &plan, PreviousRun::default(), Fault::NoRoomBeside, usize::MAX, &back);
    assert_eq!((counts(&swept.outcome.unwrap()), swept.journal.artifacts.len()), ([0, 0, 0], 2));
    assert_eq!(rows(&swept.journal), grid_rows(Status::Ok));
    assert!(swept.journal.rows.iter().all(|row| row.interleaved_with == 1));
}

#[test]
fn structures_are_timed_pass_by_pass() {
    let seen: Arc<Seen> = Arc::default();
    let request = Request { passes: Some(4), warmup: Some(1), ..with("config", "P") };
    let plan = Plan::new(&TRACE, &request).unwrap();
    let workload = faulty(Fault::None, "grid", seen.clone());
    let folder = tempfile::tempdir().unwrap();
    let swept = sweep_with(&workload, folder, &plan, PreviousRun::default(), usize::MAX, &back);
    assert_eq!(counts(&swept.outcome.unwrap()), [0, 0, 0]);
    // A frame to warm up, then the path's two, of one and then of the other, and back
    let (grid, stack) = ("grid", "bvh-stack");
    let turns = [grid, stack, stack, grid, stack, grid, grid, stack];
    let expected: Vec<_> = turns.into_iter().flat_map(|who| [(who.to_owned(), 1), (who.to_owned(), 2)]).collect();
    assert_eq!(*seen.timed.lock().unwrap(), expected);
    assert!(swept.journal.rows.iter().all(|row| row.interleaved_with == 2), "{:?}", rows(&swept.journal));
}

/// `rtbench build`, which brings nothing to a device, gives the sizes that a sweep gives.
#[test]
fn sizes_are_the_same_without_a_device() {
    let scene = rtbench::scene::load("hall:triangles=15000").unwrap();
    let cpu = CpuDevice::new(1).unwrap();
    for structure in ["grid", "kdtree", "bvh-stack"] {
        let selection = Selection::parse(structure).unwrap();
        let built = selection.build(&scene, 1).unwrap();
        let allocated = cpu.prepare(&scene, &*built.structure, selection.method()).unwrap().allocated();
        assert_eq!(input::memory(&built, &scene, None), input::memory(&built, &scene, Some(allocated)), "{structure}");
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
    let gone = || Err(Error::Device("no such device".into()));
    let other = || {
        let device = CpuDevice::new(1).unwrap().named("another");
        Ok(Opened { device: Device::Cpu(device), reason: "a test".into() })
    };
    for again in [&gone as &dyn Fn() -> Result<Opened>, &other] {
        let swept = swept(Fault::LostOnce, usize::MAX, again);
        let error = swept.outcome.unwrap_err();
        assert!(matches!(error, Error::DeviceLost(_)) && error.exit_code() == 2, "{error}");
        // Both rows with primary rays alone, and the one that lost it
        assert_eq!(swept.journal.rows.len(), 3);
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
    assert_eq!(swept.journal.rows.len(), 2);
    assert!(swept.journal.end.unwrap().interrupted);
    for file in ["summary.csv", "structures.csv", "run.json"] {
        assert!(swept.folder.path().join(file).is_file(), "{file}");
    }
}

#[test]
fn a_run_is_taken_up_where_it_was_interrupted() {
    let first = swept(Fault::None, 1, &back);
    let (folder, kept) = (first.folder, first.journal.rows[0].clone());
    // Killed while it wrote: half a line more
    let path = folder.path().join(FILE_NAME);
    let mut bytes = std::fs::read(&path).unwrap();
    bytes.extend(b"{\"record\":\"row\",\"key\":");
    std::fs::write(&path, bytes).unwrap();
    let previous = PreviousRun::read(folder.path()).unwrap();
    assert_eq!((previous.done(), previous.is_complete()), (2, false));
    let plan = plan();
    let second = sweep_into(folder, &plan, previous, Fault::None, usize::MAX, &back);
    let outcome = second.outcome.unwrap();
    assert_eq!((counts(&outcome), second.finished), ([0, 0, 0], 2));
    let journal = &second.journal;
    assert_eq!((journal.rows.len(), journal.artifacts.len(), journal.resumed.len()), (4, 2, 1));
    assert_eq!(journal.rows[0], kept);
    assert!(journal.end.as_ref().unwrap().complete && journal.truncated.is_none());
    // As if it had run in one go, but for what the clocks say
    let whole = swept(Fault::None, usize::MAX, &back).journal;
    let facts = |journal: &Journal| {
        let rows = journal.rows.iter();
        let counted = |r: &Row| r.metrics.iter().filter(|m| m.of.is_some()).cloned().collect::<Vec<_>>();
        rows.map(|r| (r.key.clone(), counted(r), r.outputs.clone())).collect::<Vec<_>>()
    };
    assert_eq!(facts(journal), facts(&whole));
    assert!(outcome.journal.resumed.len() == 1 && outcome.journal.rows.len() == 4);
    let previous = PreviousRun::read(second.folder.path()).unwrap();
    assert!(previous.is_complete() && previous.done() == 4);
}

/// Some editors and short writes take the end of the last line.
#[test]
fn a_whole_last_line_without_its_end_is_kept() {
    for kept in [1, 2, 3] {
        let first = swept(Fault::None, usize::MAX, &back);
        let path = first.folder.path().join(FILE_NAME);
        let text = std::fs::read_to_string(&path).unwrap();
        let rows = text.lines().enumerate().filter(|(_, line)| line.starts_with("{\"record\":\"row\""));
        let last = rows.map(|(index, _)| index).nth(kept - 1).unwrap();
        let cut: Vec<&str> = text.lines().take(last + 1).collect();
        std::fs::write(&path, cut.join("\n")).unwrap();
        let previous = PreviousRun::read(first.folder.path()).unwrap();
        assert_eq!(previous.done(), kept);
        let second = sweep_into(first.folder, &plan(), previous, Fault::None, usize::MAX, &back);
        assert_eq!((second.outcome.unwrap().journal.rows.len(), second.finished), (4, 4 - kept));
    }
    // The first line as well
    let first = swept(Fault::None, 1, &back);
    let path = first.folder.path().join(FILE_NAME);
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.lines().next().unwrap()).unwrap();
    let previous = PreviousRun::read(first.folder.path()).unwrap();
    let second = sweep_into(first.folder, &plan(), previous, Fault::None, usize::MAX, &back);
    assert_eq!(second.outcome.unwrap().journal.rows.len(), 4);
}

#[test]
fn a_row_that_lost_the_device_is_tried_again_and_a_wrong_one_is_not() {
    let plan = plan();
    let lost = swept(Fault::LostOnce, usize::MAX, &back);
    assert_eq!(grid_ps(&lost.journal).status, Status::Failed);
    let previous = PreviousRun::read(lost.folder.path()).unwrap();
    assert_eq!((previous.done(), previous.is_complete()), (3, false));
    let again = sweep_into(lost.folder, &plan, previous, Fault::None, usize::MAX, &back);
    assert_eq!((again.finished, counts(&again.outcome.unwrap())), (1, [0, 0, 0]));
    assert_eq!(rows(&again.journal), grid_rows(Status::Ok));

    let wrong = swept(Fault::WrongTriangle, 3, &back);
    let previous = PreviousRun::read(wrong.folder.path()).unwrap();
    let again = sweep_into(wrong.folder, &plan, previous, Fault::None, usize::MAX, &back);
    assert_eq!((again.finished, counts(&again.outcome.unwrap())), (1, [2, 0, 0]));
    assert_eq!(rows(&again.journal), grid_rows(Status::Wrong));
}

#[test]
fn a_run_is_not_taken_up_by_another_program_device_or_plan() {
    let refused = |change: &dyn Fn(&mut String), plan: &Plan| {
        let first = swept(Fault::None, 1, &back);
        let path = first.folder.path().join(FILE_NAME);
        let mut text = std::fs::read_to_string(&path).unwrap();
        change(&mut text);
        std::fs::write(&path, &text).unwrap();
        let previous = PreviousRun::read(first.folder.path()).unwrap();
        let second = sweep_into(first.folder, plan, previous, Fault::None, usize::MAX, &back);
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
    let plan = plan();
    let hash = rtbench::harness::environment::program().executable_hash.unwrap();
    let error = refused(&replace(&hash, "0123"), &plan);
    assert!(error.contains("another build of the program") && error.contains("begin a new run"), "{error}");
    let error = refused(&replace("\"devices\":[{\"name\":\"", "\"devices\":[{\"name\":\"not "), &plan);
    assert!(error.contains("it was measured on not "), "{error}");
    let error = refused(&replace("\"logical_cpus\":", "\"logical_cpus\":1000"), &plan);
    assert!(error.contains("the machine"), "{error}");
    let more = Plan::new(&TRACE, &Request { passes: Some(3), ..request() }).unwrap();
    assert!(refused(&|_| (), &more).contains("not the same"));
}

/// Two programs that write one journal would measure the same rows, at the same time.
#[test]
fn a_run_that_is_being_written_is_not_taken_up() {
    let first = swept(Fault::None, 1, &back);
    let path = first.folder.path().join(FILE_NAME);
    let text = std::fs::read(&path).unwrap();
    let plan = plan();
    let refused = |folder, previous| {
        let second = sweep_into(folder, &plan, previous, Fault::None, usize::MAX, &back);
        let error = second.outcome.unwrap_err();
        assert!(matches!(error, Error::Input(_)), "{error}");
        assert!(error.to_string().contains("another process is writing this run"), "{error}");
        second.folder
    };
    let writer = std::fs::File::open(&path).unwrap();
    writer.lock().unwrap();
    let folder = refused(first.folder, PreviousRun::read(path.parent().unwrap()).unwrap());
    assert_eq!(std::fs::read(&path).unwrap(), text);
    // One that wrote to it and is done
    drop(writer);
    let previous = PreviousRun::read(path.parent().unwrap()).unwrap();
    let more = [&text[..], text.split_inclusive(|&b| b == b'\n').next_back().unwrap()].concat();
    std::fs::write(&path, &more).unwrap();
    let folder = refused(folder, previous);
    assert_eq!(std::fs::read(&path).unwrap(), more);
    // Alone it goes on
    std::fs::write(&path, &text).unwrap();
    let previous = PreviousRun::read(path.parent().unwrap()).unwrap();
    assert!(sweep_into(folder, &plan, previous, Fault::None, usize::MAX, &back).outcome.is_ok());
}

/// Structure and width of the cases of a plan, each pair once.
fn compared(plan: &Plan) -> Vec<String> {
    let mut pairs: Vec<String> = Vec::new();
    for case in &plan.cases {
        let pair = format!("{} {}", case.group, case.axis("resolution"));
        if !pairs.contains(&pair) {
            pairs.push(pair);
        }
    }
    pairs
}

fn preset_file(text: &str) -> tempfile::NamedTempFile {
    let file = tempfile::Builder::new().suffix(".toml").tempfile().unwrap();
    std::fs::write(file.path(), text).unwrap();
    file
}

fn of_preset(file: &tempfile::NamedTempFile) -> Request {
    Request { preset: Some(file.path().to_str().unwrap().into()), ..Request::default() }
}

#[test]
fn a_scene_that_the_preset_names_keeps_its_own_parts() {
    let file = preset_file(
        "structure = [\"grid\", \"bvh\"]\nconfig = \"P\"\nresolution = 64\npasses = 1\nwarmup = 0\n\
        [[part]]\nscene = \"hall\"\nstructure = [\"grid:x=9\"]\n\
        [[part]]\nscene = \"scan\"\n\
        [[part]]\nscene = \"hall\"\nstructure = [\"kdtree\"]\nresolution = [\"32\"]\n",
    );
    let plan = |scene: &str, structures: &[&str]| {
        let mut request = of_preset(&file);
        request.values = values(&[("scene", &[scene]), ("structure", structures)]);
        request.values.retain(|_, values| !values.is_empty());
        compared(&Plan::new(&TRACE, &request).unwrap())
    };
    assert_eq!(plan("hall", &[]), ["grid:x=9 64x64", "kdtree 32x32"]);
    assert_eq!(plan("scan", &[]), ["grid 64x64", "bvh 64x64"]);
    assert_eq!(plan("hall", &["bvh-stack"]), ["bvh-stack 64x64"]);
    assert_eq!(plan("room", &[]), ["grid 64x64", "bvh 64x64"]);
}

#[test]
fn a_part_sets_what_holds_for_its_scene_also_where_the_scene_is_common() {
    let file = preset_file(
        "scene = [\"hall\", \"scan\"]\nstructure = \"grid\"\nresolution = 64\npasses = 1\nwarmup = 0\n\
        [[part]]\nconfig = [\"PS\"]\n",
    );
    for scene in ["hall", "scan"] {
        let mut request = of_preset(&file);
        request.values = values(&[("scene", &[scene])]);
        let plan = Plan::new(&TRACE, &request).unwrap();
        assert_eq!((&plan.axes()["scene"], &plan.axes()["config"]), (&vec![scene.to_owned()], &vec!["PS".to_owned()]));
    }
}

#[test]
fn an_absent_scene_does_not_take_others_with_it() {
    let file = preset_file(
        "\u{feff}scene = [\"bunny\", \"hall\"]\nstructure = \"grid\"\nconfig = \"P\"\nresolution = 64\npasses = 1\nwarmup = 0\n",
    );
    let nowhere = tempfile::tempdir().unwrap();
    let library = Library { scenes_folder: Some(nowhere.path().into()), scene_time: None };
    let plan = Plan::new(&TRACE, &Request { library, ..of_preset(&file) }).unwrap();
    assert_eq!((plan.axes()["scene"].clone(), plan.absent.len()), (vec!["hall".to_owned()], 1));
}

/// What is left out is said.
#[test]
fn cases_that_differ_in_their_frames_only() {
    let file = preset_file(
        "scene = \"hall\"\nconfig = \"P\"\nresolution = 64\npasses = 1\nwarmup = 0\n\
        [[part]]\nstructure = \"grid\"\nframes = 2\n[[part]]\nstructure = [\"grid\", \"bvh\"]\nframes = 1\n",
    );
    let plan = Plan::new(&TRACE, &of_preset(&file)).unwrap();
    let cases: Vec<_> = plan.cases.iter().map(|case| (case.axis("structure"), case.axis("frames"))).collect();
    assert_eq!(cases, [("grid", "2"), ("bvh", "1")]);
    assert!(plan.notes.len() == 1 && plan.notes[0].contains("1 cases"), "{:?}", plan.notes);
}

#[test]
fn camera_paths_are_an_axis() {
    let mut request = request();
    request.values.insert("camera_path".into(), vec!["orbit".into(), "light-orbit".into()]);
    request.values.insert("structure".into(), vec!["grid".into()]);
    let plan = Plan::new(&TRACE, &request).unwrap();
    assert_eq!(plan.axes()["camera_path"], ["orbit", "light-orbit"]);
    let folder = tempfile::tempdir().unwrap();
    let swept = sweep_into(folder, &plan, PreviousRun::default(), Fault::None, usize::MAX, &back);
    let rows = swept.outcome.unwrap().journal.rows;
    assert_eq!((rows.len(), rows.iter().filter(|row| row.status == Status::Ok).count()), (4, 4));
    let keys: std::collections::HashSet<_> = rows.iter().map(|row| &row.key).collect();
    let images: std::collections::HashSet<_> = rows.iter().map(|row| format!("{:?}", row.outputs)).collect();
    assert_eq!((keys.len(), images.len()), (4, 4));
}

#[test]
fn mistakes_in_presets_are_located() {
    let good = "structure = [\"grid\"]\nconfig = \"P\"\nresolution = 64\npasses = 1\nwarmup = 0\n";
    let wrong = |text: &str, words: &[&str]| {
        let file = preset_file(text);
        let error = Plan::new(&TRACE, &of_preset(&file)).unwrap_err().to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
        assert!(!error.contains('\n'), "{error}");
    };
    wrong(
        &format!("{good}structures = [\"bvh\"]\n"),
        &[".toml:6: ", "called structure now", "presets/sweep/quick.toml"],
    );
    wrong(&format!("{good}[[scene]]\nscene = \"hall\"\n"), &[".toml:6: [[scene]] is called [[part]] now"]);
    wrong(&good.replace("warmup", "warmup_frames"), &[".toml:5: ", "called warmup now"]);
    wrong(&format!("{good}[[part]]\nscene = \"hall\"\nwarmup_frames = 1\n"), &[".toml:8: ", "called warmup now"]);
    for value in ["true", "{ a = 1 }", "[[\"grid\"]]", "[16.5]", "[]"] {
        let text = good.replace("64", value);
        wrong(&format!("{text}[[part]]\nscene = \"hall\"\n"), &[".toml:3: resolution = "]);
        wrong(&format!("{good}[[part]]\nscene = {value}\n"), &[".toml:7: scene = "]);
        wrong(&good.replace("passes = 1", &format!("passes = {value}")), &[".toml:4: passes = "]);
    }
    wrong(&format!("{good}part = 5\n"), &[".toml:6: ", "[[part]]"]);
    wrong(&good.replace("passes = 1\n", ""), &["passes is not set"]);
    // A part without a scene, next to a good one
    wrong(&format!("{good}[[part]]\nscene = \"hall\"\n[[part]]\nframes = 1\n"), &["--scene", "no scene is given"]);
    wrong(&good.replace("config = \"P\"\n", "scene = \"hall\"\n"), &["--config", "no config is given"]);
    wrong(&format!("{good}workload = \"spheres\"\n"), &[".toml:6: ", "of the workload spheres, not of sweep"]);
    wrong(&format!("{good}[[part]]\nscene = \"hall\"\ncolour = \"red\"\n"), &[".toml:8: unknown key colour", "scene"]);
    wrong(&format!("{good}build = \"x\"\n"), &["unknown key build"]);
    wrong(&good.replace("passes = 1", "passes = true"), &[".toml:4: "]);
    wrong(&good.replace("passes = 1", "passes = 0"), &["--passes: 0 is out of range"]);
    wrong(&good.replace("64", "0"), &["--resolution", "no pixels"]);
}

#[test]
fn presets_are_sound() {
    let plan = Plan::new(&TRACE, &Request::default()).unwrap();
    assert_eq!((plan.preset.as_str(), plan.cases.len()), ("quick", 90 + 42 + 14));
    let names = "grid kdtree bvh bvh-stack ploc-stack bih bvh-quantised bvh4 bvh8 cwbvh bvh-subgroup bvh-stackless";
    assert_eq!(plan.axes()["structure"], names.split(' ').collect::<Vec<_>>());
    assert_eq!((plan.axes()["config"].len(), plan.axes()["resolution"].len()), (5, 2));
    for (preset, cases) in [("rt2", 60), ("rt2-lite", 48)] {
        // Without the catalogue's bunny, dragon and sponza
        let library = Library { scenes_folder: Some("nowhere".into()), scene_time: None };
        let request = Request { preset: Some(preset.into()), library, ..Request::default() };
        let plan = Plan::new(&TRACE, &request).unwrap();
        assert_eq!((plan.cases.len(), plan.absent.len()), (cases, 3), "{preset}");
        assert_eq!(plan.axes()["resolution"], ["1408x768"]);
    }
    // The thesis's scenes are not here: nothing takes their place.
    let nowhere = tempfile::tempdir().unwrap();
    let library = Library { scenes_folder: Some(nowhere.path().into()), scene_time: None };
    let mut thesis = Request { preset: Some("thesis".into()), library, ..Request::default() };
    let error = Plan::new(&TRACE, &thesis).unwrap_err().to_string();
    assert!(error.contains("bunny") && error.contains("https://"), "{error}");
    std::fs::create_dir(nowhere.path().join("dragon")).unwrap();
    std::fs::write(nowhere.path().join("dragon/dragon_vrip.ply"), "").unwrap();
    let plan = Plan::new(&TRACE, &thesis).unwrap();
    assert_eq!((plan.axes()["scene"].clone(), plan.absent.len()), (vec!["dragon".to_owned()], 8));
    assert_eq!(plan.axes()["frames"], ["all"]);
    assert_eq!(plan.axes()["resolution"], ["256x256", "512x512", "768x768", "1024x1024"]);
    thesis.frames = Some(10);
    assert_eq!(Plan::new(&TRACE, &thesis).unwrap().axes()["frames"], ["10"]);
}

/// Planning reads no scene: what is wrong with a name is known at once, what is wrong inside a file is not.
#[test]
fn a_plan_checks_names_and_camera_paths() {
    let refused = |axis: &str, value: &str| Plan::new(&TRACE, &with(axis, value)).unwrap_err().to_string();
    assert!(refused("scene", "hal").contains("hall"));
    assert!(refused("scene", "hall:triangles=0").contains("out of range"));
    assert!(refused("scene", "hall:colour=1").contains("no parameter"));
    assert!(refused("scene", "nowhere/mesh.ply").contains("no such file"));
    assert!(refused("camera_path", "orbt").contains("orbit"));
    assert!(refused("structure", "octree").contains("there is no structure"));
    let all = Plan::new(&TRACE, &with("structure", "all")).unwrap();
    assert!(all.axes()["structure"].contains(&"grid-coop".to_owned()));
    assert!(!all.axes()["structure"].contains(&"brute".to_owned()));
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
}
