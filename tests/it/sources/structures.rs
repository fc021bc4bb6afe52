//! The structures of today from hand-made rows: order, break-even, the Pareto front, figures.

use super::synthetic::{Builder, sums, write_run};
use rtbench::device::DeviceType;
use rtbench::record::row::Status;
use rtbench::report::{Cell, Table};
use rtbench::sources::runs::RecordedRun;
use rtbench::sources::structures::{BreakEven, Cost, SOURCE, break_even, front};
use rtbench::sources::{Options, select};
use rtbench::workloads::trace::Properties;
use rtbench::workloads::trace::rays::Config;
use rtbench::workloads::trace::record::{CounterSums, Memory, SceneRecord};

fn scene() -> SceneRecord {
    SceneRecord { name: "hall".into(), hash: "hall".into(), triangles: 1000, ..SceneRecord::default() }
}

/// A structure with 100 primary rays in two frames of `ms` each, and what it took to build it.
fn add(run: &mut Builder, name: &str, ms: f64, (build_ms, upload_ms): (f64, Option<f64>), bytes: u64) {
    let row = run.row(scene(), name, Config::P, (64, 64), ms);
    row.memory = Memory { structure_bytes: bytes, ..Memory::default() };
    let mut counters = row.counters.unwrap();
    counters.iter_mut().skip(1).for_each(|of_type| *of_type = CounterSums::default());
    counters[0] = CounterSums { boxes: 1200, ..sums(10, 3) };
    row.counters = Some(counters);
    let built = run.structure(scene(), name, build_ms);
    built.upload_ms = upload_ms;
    built.properties = Properties { sah_cost: Some(12.5), ..Properties::default() };
}

/// bvh8 traces twice as fast as bvh and is ready 3 ms later; slow is worse than bvh in both.
fn run() -> RecordedRun {
    let mut run = Builder::new();
    add(&mut run, "bvh", 2.0, (4.0, Some(1.0)), 32_000);
    add(&mut run, "bvh8:build=ploc", 1.0, (7.0, Some(1.0)), 20_000);
    add(&mut run, "cwbvh", 4.0, (20.0, None), 10_000);
    run.run
}

fn tables(run: &RecordedRun, id: &str) -> Vec<Table> {
    (SOURCE.read)(std::slice::from_ref(run)).tables(&[id], &Options::default())
}

fn names(table: &Table) -> Vec<&str> {
    table.rows.iter().map(|row| row.keys[0].as_str()).collect()
}

fn number(cell: &Cell) -> f64 {
    match cell {
        Cell::Number { value: Some(value), .. } => value.value,
        other => panic!("{other:?} is no number"),
    }
}

#[test]
fn rows_are_sorted_by_rays_per_second() {
    let tables = tables(&run(), "rates");
    assert_eq!(tables.len(), 1);
    let rates = &tables[0];
    assert_eq!(names(rates), ["bvh8:build=ploc", "bvh", "cwbvh"]);
    assert!(rates.title.contains("hall, P, 64x64, Fast GPU"), "{}", rates.title);
    let first = &rates.rows[0].cells;
    // 100 rays in two frames of 1 ms; 20,000 bytes for 1,000 triangles
    assert!((number(&first[0]) - 100.0 / 2.0 / 1e3).abs() < 1e-9);
    assert_eq!([number(&first[3]), number(&first[4]), number(&first[5]), number(&first[6])], [12.5, 20.0, 7.0, 1.0]);
    // 3 ms later, 20 us a ray where bvh takes 40 us: after 150 rays
    assert!((number(&first[8]) - 150e-6).abs() < 1e-12, "{first:?}");
    assert_eq!(rates.rows[1].cells[8], Cell::number(None));
    assert_eq!(rates.rows[2].cells[8], Cell::Text("none".into()));
    assert!(rates.notes.iter().any(|note| note.contains("those of bvh, which is ready first")), "{:?}", rates.notes);
}

#[test]
fn work_is_by_ray() {
    let tables = tables(&run(), "work");
    let cells = &tables[0].rows[0].cells;
    assert_eq!([number(&cells[0]), number(&cells[1]), number(&cells[2]), number(&cells[3])], [6.0, 4.0, 12.0, 3.0]);
}

#[test]
fn what_was_not_counted_is_empty() {
    let mut run = run();
    let row = &mut run.journal.configurations[0];
    row.counters =
        Some(row.counters.unwrap().map(|of_type| CounterSums { rays: of_type.rays, ..CounterSums::default() }));
    let tables = tables(&run, "work");
    let bvh = tables[0].rows.iter().find(|row| row.keys[0] == "bvh").unwrap();
    assert!(bvh.cells.iter().all(|cell| !cell.is_filled()));
}

#[test]
fn all_pairs_break_even_or_do_not() {
    let tables = tables(&run(), "break-even");
    let table = &tables[0];
    let columns: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(columns, ["bvh8:build=ploc", "bvh"], "cwbvh is beaten in both");
    let text = |row: usize, column: usize| table.rows[row].cells[column].clone();
    assert_eq!(text(0, 1), Cell::Text("from 0.000150".into()));
    assert_eq!(text(1, 0), Cell::Text("until 0.000150".into()));
    assert_eq!([text(2, 0), text(2, 1)], [Cell::Text("never".into()), Cell::Text("never".into())]);
}

#[test]
fn break_even_of_all_kinds() {
    let cost = |build_ms, mrays_per_s| Cost { build_ms, mrays_per_s };
    let (cheap, fast) = (cost(10.0, 10.0), cost(60.0, 20.0));
    // 50 ms later, and 50 ms less for each 10^6 rays
    assert_eq!(break_even(fast, cheap), BreakEven::From(1.0));
    assert_eq!(break_even(cheap, fast), BreakEven::Until(1.0));
    assert_eq!(break_even(cost(10.0, 20.0), fast), BreakEven::Always);
    assert_eq!(break_even(cost(5.0, 10.0), cheap), BreakEven::Always);
    assert_eq!(break_even(cost(10.0, 11.0), cheap), BreakEven::Always);
    assert_eq!(break_even(fast, cost(10.0, 20.0)), BreakEven::Never);
    assert_eq!(break_even(cheap, cheap), BreakEven::Never);
    assert_eq!(break_even(cost(11.0, 9.0), cheap), BreakEven::Never);
}

#[test]
fn the_front_has_what_nothing_beats() {
    assert_eq!(front(&[(1.0, 1.0), (2.0, 2.0), (2.0, 1.0), (3.0, 1.5)]), [true, true, false, false]);
    // Equal points do not beat each other
    assert_eq!(front(&[(1.0, 1.0), (1.0, 1.0), (1.0, 0.5)]), [true, true, false]);
    assert!(front(&[]).is_empty());
}

#[test]
fn figures_have_a_mark_for_each_structure_and_the_front() {
    let results = (SOURCE.read)(&[run()]);
    let (figures, missing) = results.figures().unwrap();
    let names: Vec<&str> = figures.iter().map(|figure| figure.name.as_str()).collect();
    assert_eq!((names, missing.len()), (vec!["build-time-p", "bytes-p"], 0));
    for word in ["1 bvh8:build=ploc", "2 bvh", "3 cwbvh", "Pareto front"] {
        assert!(figures[0].svg.contains(word), "{word}");
    }
    assert_eq!((SOURCE.read)(&[]).figures().unwrap().1.len(), 2);
}

#[test]
fn a_row_without_a_result_is_named() {
    let mut run = run();
    let row = &mut run.journal.configurations[2];
    (row.status, row.message) = (Status::Skipped, "the device lacks RayQuery".into());
    let tables = tables(&run, "rates");
    assert_eq!(names(&tables[0]), ["bvh8:build=ploc", "bvh"]);
    assert!(
        tables[0].notes.iter().any(|note| note.contains("cwbvh: the device lacks RayQuery")),
        "{:?}",
        tables[0].notes
    );
}

#[test]
fn what_the_driver_builds_and_leaf_order_count() {
    let mut run = run();
    let built = &mut run.journal.structures[0];
    built.driver_build_ms = Some(6.0);
    run.journal.structures[1].leaf_order_bytes = Some(60_000);
    let folder = tempfile::tempdir().unwrap();
    write_run(&run, folder.path());
    let written = RecordedRun::read(folder.path()).unwrap();
    let tables = tables(&written, "rates");
    let bvh = tables[0].rows.iter().find(|row| row.keys[0] == "bvh").unwrap();
    // 4 ms and 6 ms; how large the driver's structure is is not known
    assert_eq!((bvh.cells[4].clone(), number(&bvh.cells[5])), (Cell::number(None), 10.0));
    // 20,000 and 60,000 bytes for 1,000 triangles
    let bvh8 = tables[0].rows.iter().find(|row| row.keys[0].starts_with("bvh8")).unwrap();
    assert_eq!(number(&bvh8.cells[4]), 80.0);
    let (figures, _) = (SOURCE.read)(&[written]).figures().unwrap();
    let is_marked = |figure: usize| figures[figure].svg.contains("2 bvh");
    assert_eq!((figures[1].name.as_str(), is_marked(0), is_marked(1)), ("bytes-p", true, false));
}

#[test]
fn a_figure_shows_the_size_with_most_structures() {
    let mut builder = Builder::new();
    for name in ["bvh", "bvh4", "bvh8"] {
        add(&mut builder, name, 1.0, (4.0, None), 1);
    }
    for name in ["bvh", "bvh4"] {
        let row = builder.row(scene(), name, Config::P, (128, 128), 4.0);
        row.memory = Memory { structure_bytes: 1, ..Memory::default() };
    }
    let (figures, _) = (SOURCE.read)(&[builder.run]).figures().unwrap();
    assert!(figures[0].svg.contains("64x64") && !figures[0].svg.contains("128x128"));
}

#[test]
fn what_has_no_result_at_all_is_named() {
    let mut run = run();
    for row in &mut run.journal.configurations {
        (row.status, row.message) = (Status::Wrong, "hits differ".into());
    }
    let tables = (SOURCE.read)(std::slice::from_ref(&run)).tables(&["rates", "work"], &Options::default());
    assert_eq!((tables.len(), tables[0].rows.len()), (1, 0));
    assert!(tables[0].notes.iter().any(|note| note.contains("bvh8:build=ploc: hits differ")), "{:?}", tables[0].notes);
}

#[test]
fn later_rows_replace_earlier_ones() {
    let mut builder = Builder::new();
    add(&mut builder, "bvh", 2.0, (4.0, None), 1);
    add(&mut builder, "bvh", 1.0, (4.0, None), 1);
    add(&mut builder, "bvh4", 1.5, (4.0, None), 1);
    let tables = tables(&builder.run, "rates");
    assert_eq!(names(&tables[0]), ["bvh", "bvh4"]);
}

#[test]
fn runs_of_other_sources_do_not_fit() {
    let mut other = Builder::new();
    add(&mut other, "kdtree", 2.0, (4.0, None), 1);
    let names =
        |run: &RecordedRun| select(&[], std::slice::from_ref(run)).unwrap().iter().map(|s| s.name).collect::<Vec<_>>();
    assert!(!names(&other.run).contains(&"structures"));
    assert!(names(&run()).contains(&"structures"));
    assert_eq!(run().journal.provenance.devices[0].info.device_type, DeviceType::DiscreteGpu);
}
