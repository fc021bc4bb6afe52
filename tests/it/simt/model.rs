//! The orders of recorded rows on a GPU: which rows have a place in them.

use rtbench::record::row::{Row, Status, Value};
use rtbench::report::Table;
use rtbench::sources::runs::RecordedRun;
use rtbench::workloads::trace::record::{ConfigurationRecord, TraceJournal};
use rtbench::workloads::trace::simt::model::{self, Gpu};
use std::path::Path;

fn run() -> RecordedRun {
    RecordedRun::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("results/simt-2026-11-30")).unwrap()
}

/// The default grid, kd-tree and BVH on the bunny, P, 256x256; and others of the same table.
fn is_wanted(record: &ConfigurationRecord) -> bool {
    let place = (record.scene.name.as_str(), format!("{:?}", record.config), record.width);
    place == ("bunny", "P".to_owned(), 256)
}

fn only_one_table(mut run: RecordedRun) -> RecordedRun {
    run.journal.configurations.retain(|record| is_wanted(record) && record.variant == "default");
    assert_eq!(run.journal.configurations.len(), 3);
    run
}

fn tables(run: &RecordedRun) -> rtbench::Result<Vec<Table>> {
    model::tables(&[&run.journal], &Gpu::load("gtx280").unwrap())
}

/// Names in the order, and the note on what has no place in it.
fn order(run: &RecordedRun) -> (Vec<String>, String) {
    let table = tables(run).unwrap().remove(0);
    let names = table.rows.iter().map(|row| row.keys[0].clone()).collect();
    (names, table.notes.iter().find(|note| note.starts_with("Not modelled")).cloned().unwrap_or_default())
}

#[test]
fn rows_without_a_result_have_no_place() {
    let (names, note) = order(&only_one_table(run()));
    assert_eq!((names.len(), note.as_str()), (3, ""));
    let changed = |change: fn(&mut ConfigurationRecord)| {
        let mut run = only_one_table(run());
        change(&mut run.journal.configurations[0]);
        order(&run)
    };
    let (names, note) = changed(|record| (record.status, record.message) = (Status::Failed, "boom".into()));
    assert_eq!((names.len(), note.as_str()), (2, "Not modelled: grid (boom)."));
    let (names, note) = changed(|record| record.verified = false);
    assert!(names.len() == 2 && note.contains("grid"), "{note}");
    let (names, note) = changed(|record| record.issued = None);
    assert!(names.len() == 2 && note.contains("grid (no counts"), "{note}");
    let (names, note) = changed(|record| record.structure = "octree".into());
    assert!(names.len() == 2 && note.contains("octree"), "{note}");
    // Nothing at all is an error that names a reason
    let mut run = only_one_table(run());
    run.journal.configurations.iter_mut().for_each(|record| record.issued = None);
    let message = tables(&run).unwrap_err().to_string();
    assert!(message.contains("nothing of it is modelled: grid (no counts"), "{message}");
    run.journal.configurations.iter_mut().for_each(|record| record.warp_width = Some(8));
    assert!(tables(&run).unwrap_err().to_string().contains("have 8 lanes"));
}

#[test]
fn damaged_counts_are_no_counts() {
    let with = |name: &str, value: Value| {
        let mut run = run();
        let is_first = |row: &&mut Row| row.metric(Some("primary"), "warps").is_some();
        let row = run.general.rows.iter_mut().find(is_first).unwrap();
        let metric = row.metrics.iter_mut().find(|m| m.of.as_deref() == Some("primary") && m.name == name).unwrap();
        metric.value = value;
        TraceJournal::new(&run.general).configurations.iter().filter(|record| record.issued.is_none()).count()
    };
    let before = run().journal.configurations.iter().filter(|record| record.issued.is_none()).count();
    assert_eq!(with("issued_step", Value::Integer(1_000_000_000)), before);
    for (name, value) in [
        ("issued_step", Value::Number(-5.0)),
        ("issued_step", Value::Number(2.5)),
        ("lanes_step", Value::Integer(u64::MAX)),
        ("warps", Value::Integer(0)),
    ] {
        assert_eq!(with(name, value.clone()), before + 1, "{name} {value:?}");
    }
}

#[test]
fn a_row_s_band_does_not_depend_on_others() {
    let all = tables(&only_one_table(run())).unwrap().remove(0);
    let mut run = only_one_table(run());
    run.journal.configurations.reverse();
    let reversed = tables(&run).unwrap().remove(0);
    assert_eq!(all.rows, reversed.rows);
}

#[test]
fn scenes_of_one_name_have_tables_of_their_own() {
    let mut run = only_one_table(run());
    let mut others = run.journal.configurations.clone();
    others.iter_mut().for_each(|record| record.scene.hash = "0123456789abcdef".into());
    run.journal.configurations.extend(others);
    let tables = tables(&run).unwrap();
    assert!(tables.len() == 2 && tables[1].title.contains("scene 01234567"), "{}", tables[1].title);
}
