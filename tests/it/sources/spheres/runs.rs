//! Which source, machine, scene and setting a row belongs to.

use super::synthetic::{Builder, everything, write_run};
use crate::sources::synthetic as traces;
use rtbench::report::{Cell, Table};
use rtbench::sources::runs::RecordedRun;
use rtbench::sources::spheres::SOURCE;
use rtbench::sources::{Options, Rows, select};
use rtbench::workloads::trace::rays::Config;
use rtbench::workloads::trace::record::SceneRecord;

fn fitting(runs: &[RecordedRun]) -> Vec<&'static str> {
    select(&[], runs).map(|sources| sources.iter().map(|source| source.name).collect()).unwrap_or_default()
}

fn sweep() -> RecordedRun {
    let mut b = traces::Builder::new();
    let scene = SceneRecord { name: "bunny".into(), triangles: 69_451, ..SceneRecord::default() };
    b.row(scene, "grid", Config::P, (64, 64), 1.0);
    b.run
}

#[test]
fn a_run_is_shown_by_the_sources_that_it_fits() {
    assert_eq!(fitting(&[everything()]), ["spheres"]);
    let folder = tempfile::tempdir().unwrap();
    write_run(&everything(), &folder.path().join("run"));
    let read = RecordedRun::read(&folder.path().join("run")).unwrap();
    assert_eq!((fitting(std::slice::from_ref(&read)), read.has_traces()), (vec!["spheres"], false));
    assert_eq!(read.general.rows, everything().general.rows);
    // A run of ray tracing, and both
    traces::write_run(&sweep(), &folder.path().join("sweep"));
    let swept = RecordedRun::read(&folder.path().join("sweep")).unwrap();
    assert_eq!((fitting(std::slice::from_ref(&swept)), swept.has_traces()), (vec!["thesis"], true));
    assert_eq!(fitting(&[swept, read]), ["thesis", "spheres"]);
}

#[test]
fn a_mixed_list_of_runs_has_no_devices_of_the_other_workload() {
    let runs = [sweep(), everything()];
    let titles = |name: &str, runs: &[RecordedRun]| {
        let source = select(&[name.to_owned()], runs).unwrap()[0];
        let tables = (source.read)(runs).tables(source.tables, &Options::default());
        tables.into_iter().map(|table| table.title).collect::<Vec<_>>()
    };
    assert_eq!(titles("thesis", &runs), titles("thesis", &runs[..1]));
    assert_eq!(titles("spheres", &runs), titles("spheres", &runs[1..]));
    // By its name, a source shows its tables of any run, without numbers
    for table in (SOURCE.read)(&[sweep()]).tables(SOURCE.tables, &Options::default()) {
        assert!(table.rows.iter().all(|row| !row.is_filled()), "{}", table.title);
    }
}

#[test]
fn a_run_without_any_row_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut unread = Builder::new();
    unread.row("a/file.json", "sequential two-pass", 1.0).refuse(rtbench::record::row::Status::Failed, "not JSON");
    let row = unread.general.rows.last_mut().unwrap();
    row.key.inputs.clear();
    write_run(&unread.run(), &folder.path().join("run"));
    let error = RecordedRun::read(&folder.path().join("run")).unwrap_err().to_string();
    assert!(error.contains("no case of it has a result"), "{error}");
}

fn table(runs: &[RecordedRun], id: &'static str, options: &Options) -> Vec<Table> {
    (SOURCE.read)(runs).tables(&[id], options)
}

fn value(table: &Table, key: &str, column: usize) -> Option<f64> {
    match table.rows.iter().find(|row| row.keys[0] == key)?.cells[column] {
        Cell::Number { value, .. } => value.map(|v| v.value),
        _ => None,
    }
}

#[test]
fn a_scene_is_the_paper_s_by_its_name_and_number() {
    let mut b = Builder::new();
    b.row("default", "sequential two-pass", 3.0);
    b.row("default.json", "sequential two-pass", 4.0);
    b.row("random:spheres=500,seed=1", "sequential two-pass", 5.0);
    let runs = [b.run()];
    let all = &table(&runs, "2", &Options { published: true, ..Options::default() })[0];
    let names: Vec<&str> = all.rows.iter().map(|row| row.keys[0].as_str()).collect();
    assert_eq!(names, ["default", "random20", "random100", "random:spheres=500,seed=1", "default.json"]);
    let published = |key: &str| all.rows.iter().find(|row| row.keys[0] == key).unwrap().cells[0].has_published();
    assert!(published("default") && published("random20") && !published("default.json"));
    let rows = |rows| table(&runs, "2", &Options { rows, ..Options::default() })[0].rows.len();
    assert_eq!((rows(Rows::Source), rows(Rows::Measured)), (3, 3));
    // Another number of spheres under the name is another scene
    let mut b = Builder::new();
    b.row("default", "sequential two-pass", 3.0);
    b.general.inputs[0].metrics[0].value = 4u64.into();
    let other = &table(&[b.run()], "2", &Options { published: true, ..Options::default() })[0];
    assert_eq!((other.rows.len(), value(other, "default", 0)), (4, None));
}

#[test]
fn tables_show_the_paper_s_structure_alone() {
    let mut b = Builder::new();
    for setting in ["simd:8 two-pass", "simd:4 two-pass index", "simd:4 two-pass exit", "simd:4 two-pass f16"] {
        b.row("default", setting, 1.0);
    }
    let before = table(&[b.run()], "2", &Options::default());
    assert_eq!(value(&before[0], "default", 2), None);
    let mut b = Builder::new();
    b.row("default", "simd:4 two-pass level=avx512", 7.0);
    b.row("default", "simd:4 two-pass level=sse2", 6.0);
    b.row("default", "threads two-pass threads=2", 9.0);
    assert_eq!(value(&table(&[b.run()], "2", &Options::default())[0], "default", 2), Some(6.0));
    let mut b = Builder::new();
    b.row("default", "simd:4 two-pass level=sse2", 6.0);
    b.row("default", "simd:4 two-pass", 5.0);
    b.row("default", "threads two-pass threads=2", 9.0);
    b.row("default", "threads two-pass threads=8", 4.0);
    let shown = &table(&[b.run()], "2", &Options::default())[0];
    assert_eq!((value(shown, "default", 2), value(shown, "default", 3)), (Some(5.0), Some(4.0)));
}

#[test]
fn the_size_with_most_rows_is_shown_and_the_others_named() {
    let mut b = Builder::new();
    b.row("default", "sequential two-pass", 1.0);
    b.row("default", "sequential one-pass exit", 1.0);
    b.row("default", "sequential two-pass", 5.0).key.axes.insert("resolution".into(), "128x64".into());
    let runs = [b.run()];
    let shown = |resolution| table(&runs, "2", &Options { resolution, ..Options::default() }).remove(0);
    let table = shown(None);
    assert_eq!(value(&table, "default", 0), Some(1.0));
    assert!(table.title.contains("64x32, 5 trips, 2 frames, 3 passes, Test CPU"), "{}", table.title);
    assert!(table.notes.iter().any(|note| note.contains("128x64")), "{:?}", table.notes);
    assert_eq!(value(&shown(Some(128)), "default", 0), Some(5.0));
    assert_eq!(value(&shown(Some(7)), "default", 0), None);
}

#[test]
fn machines_have_tables_of_their_own_and_a_repeated_row_counts_once() {
    let mut a = Builder::new();
    a.row("default", "sequential two-pass", 1.0);
    a.row("default", "gpu two-pass", 1.5);
    let mut b = Builder::new();
    b.general.provenance.devices[0].info.name = "Other CPU".into();
    b.row("default", "threads two-pass", 2.0);
    let mut again = Builder::new();
    again.row("default", "sequential two-pass", 3.0);
    let runs = [a.run(), b.run(), again.run()];
    let tables = table(&runs, "2", &Options::default());
    assert_eq!(tables.len(), 2);
    assert_eq!((value(&tables[0], "default", 0), value(&tables[0], "default", 3)), (Some(3.0), None));
    assert_eq!((value(&tables[1], "default", 0), value(&tables[1], "default", 3)), (None, Some(2.0)));
    let results = (SOURCE.read)(&runs);
    assert!(results.notes().iter().any(|note| note.contains("1 row was measured more than once")));
}
