//! Which rows are compared, shown and named.

use super::synthetic::{Builder, everything, set};
use rtbench::record::row::Status;
use rtbench::report::{Cell, Table};
use rtbench::sources::runs::RecordedRun;
use rtbench::sources::splat::SOURCE;
use rtbench::sources::splat::axes::{DEFAULTS, OF_TECHNIQUE};
use rtbench::sources::{ALL, Options, Rows, select};

fn tables(runs: &[RecordedRun], id: &'static str, options: &Options) -> Vec<Table> {
    (SOURCE.read)(runs).tables(&[id], options)
}

fn published() -> Options {
    Options { published: true, ..Options::default() }
}

/// The number of a row, found by the begin of its keys.
fn value(table: &Table, keys: &[&str], column: usize) -> Option<f64> {
    let row = table.rows.iter().find(|row| row.keys.iter().zip(keys).all(|(a, b)| a == b));
    match &row.unwrap_or_else(|| panic!("{keys:?} in {:?}", table.rows)).cells[column] {
        Cell::Number { value, .. } => value.map(|v| v.value),
        _ => None,
    }
}

fn printed(table: &Table, keys: &[&str], column: usize) -> Option<f64> {
    let row = table.rows.iter().find(|row| row.keys.iter().zip(keys).all(|(a, b)| a == b)).unwrap();
    match &row.cells[column] {
        Cell::Number { published, .. } => published.map(|v| v.value),
        _ => None,
    }
}

#[test]
fn a_run_with_rows_of_the_workload_fits_this_source_alone() {
    let runs = [everything()];
    let fitting: Vec<&str> = select(&[], &runs).unwrap().iter().map(|source| source.name).collect();
    assert_eq!(fitting, ["splat"]);
    assert!(ALL.iter().any(|source| source.name == "splat"));
    let mut other = everything();
    other.general.rows.iter_mut().for_each(|row| row.key.workload = "spheres".into());
    assert!(!(SOURCE.fits)(&[other]));
}

#[test]
fn groups_of_stages_are_next_to_the_printed_ones() {
    let all = tables(&[everything()], "5.2", &published());
    let keys = ["sponza", "per-sample", "480x270", "8", "0.1"];
    let row: Vec<f64> = (0..7).map(|column| value(&all[0], &keys, column).unwrap()).collect();
    for (own, expected) in row.iter().zip([1.7, 0.6, 3.4, 14.9, 68.7, 89.3, 89.3]) {
        assert!((own - expected).abs() < 1e-9, "{row:?}");
    }
    assert_eq!(printed(&all[0], &keys, 4), Some(68.7));
    assert_eq!(printed(&all[0], &["sibenik", "per-sample"], 4), None);
    let share = value(&all[1], &["sponza", "buckets", "480x270", "8", "0.1"], 3).unwrap();
    assert!((share - 100.0 * 13.1 / 19.2).abs() < 1e-9, "{share}");
    // A technique without clusters has no groups C and D
    assert_eq!(value(&all[0], &["sponza", "reference"], 2), None);
    // Rows with an option that is not usual have their own table
    assert!(all[0].rows.iter().all(|row| !row.keys[1].contains("unique")));
}

#[test]
fn without_times_of_stages_frames_are_left() {
    let mut b = Builder::new();
    let row = b.row("sponza", "per-sample", &[]);
    row.samples.as_mut().unwrap().stage_ns = None;
    row.timing_source = Some(rtbench::record::row::TimingSource::Wall);
    let runs = [b.run()];
    let table = &tables(&runs, "5.2", &Options::default())[0];
    assert_eq!(value(table, &["sponza", "per-sample"], 4), None);
    assert!((value(table, &["sponza", "per-sample"], 6).unwrap() - 89.3).abs() < 1e-9);
    let claims = (SOURCE.read)(&runs).claims(&Options::default());
    assert!(claims.iter().filter(|f| ["1", "5a", "7"].contains(&f.claim)).all(|f| f.cases.is_empty()));
}

#[test]
fn every_option_is_compared_with_the_usual_row() {
    let mut run = everything();
    let concat = run.general.rows.iter_mut().find(|row| row.key.axis("key") == "concat").unwrap();
    set(concat, "box_tests_mean", 14_200_000.0);
    let table = &tables(&[run], "options", &Options::default())[0];
    assert_eq!(value(table, &["sponza", "per-sample", "key: morton -> concat"], 5), Some(2.0));
    assert_eq!(value(table, &["sponza", "per-sample", "unique: flags -> sort"], 0), Some(1.0));
    let options: Vec<&str> = table.rows.iter().map(|row| row.keys[2].split(':').next().unwrap()).collect();
    assert_eq!(options, ["blur", "bounds", "key", "normals", "sync", "unique", "unique"]);
    assert!(table.notes.iter().any(|note| note.contains("unique=flags")), "{:?}", table.notes);
}

/// The value that most rows have is the usual one, whatever the default.
#[test]
fn most_rows_decide_what_is_usual() {
    let mut b = Builder::new();
    for radius in ["0.01", "0.03"] {
        b.row("sponza", &format!("buckets unique=bits radius={radius}"), &[]);
    }
    b.row("sponza", "buckets unique=flags radius=0.03", &[]);
    let runs = [b.run()];
    let table = &tables(&runs, "options", &Options::default())[0];
    assert_eq!(table.rows[0].keys[2], "unique: bits -> flags");
    let clusters = &tables(&runs, "clusters", &Options::default())[0];
    let names: Vec<&str> = clusters.rows.iter().map(|row| row.keys[1].as_str()).collect();
    assert_eq!(names, ["buckets", "buckets", "buckets unique=flags"]);
}

#[test]
fn sweeps_are_rows_that_differ_in_one_number() {
    let all = tables(&[everything()], "sweeps", &Options::default());
    let of = |title: &str| all.iter().find(|table| table.title.starts_with(title)).unwrap();
    // Three scenes, three techniques, two radii; and no row with another option
    assert_eq!(of("By radius").rows.len(), 18);
    let paths: Vec<&str> = of("By number of paths").rows.iter().map(|row| row.keys[5].as_str()).collect();
    assert_eq!(paths, ["5667", "20000", "5667", "20000"]);
    assert_eq!(of("By size of a tile").rows.iter().map(|row| row.keys[3].as_str()).collect::<Vec<_>>(), ["8", "16"]);
}

#[test]
fn frames_and_clusters_are_next_to_the_ends_of_axes() {
    let options = Options { device: Some(1), ..published() };
    let frames = &tables(&[everything()], "frames", &options)[0];
    let keys = ["sibenik", "buckets"];
    let own: Vec<f64> = (0..6).map(|column| value(frames, &keys, column).unwrap()).collect();
    for (own, expected) in own.iter().zip([17.28, 19.2, 21.12, 3.51e6, 3.9e6, 4.29e6]) {
        assert!((own / expected - 1.0).abs() < 1e-9, "{own} {expected}");
    }
    assert_eq!((printed(frames, &keys, 2), printed(frames, &keys, 5)), (Some(37.5), Some(5e6)));
    let clusters = &tables(&[everything()], "clusters", &published())[0];
    let keys = ["sponza", "per-sample"];
    assert_eq!((value(clusters, &keys, 6), printed(clusters, &keys, 5)), (Some(2.25), Some(3750.0)));
}

#[test]
fn memory_has_the_accounting_and_the_buffers() {
    let all = tables(&[everything()], "memory", &published());
    let keys = ["sponza", "per-sample"];
    assert_eq!((value(&all[0], &keys, 0), printed(&all[0], &keys, 0)), (Some(33.554432), Some(34.0)));
    assert_eq!((value(&all[0], &keys, 3), value(&all[0], &keys, 6)), (Some(134.217728), Some(64.0)));
    let buffers: Vec<&str> = all[1].rows.iter().map(|row| row.keys[6].as_str()).collect();
    // Largest first, and nothing of the accounting
    assert_eq!(buffers[..2], ["identifiers by key", "positions of photons"]);
    assert!(buffers.iter().all(|name| !name.starts_with("source-")));
    let keys = tables(&[everything()], "keys", &Options::default());
    assert_eq!(value(&keys[1], &["480x270", "8", "off", "sponza, sibenik, box"], 0), Some(23.0));
}

/// The printed lists are those of 10 million entries.
#[test]
fn printed_lists_are_next_to_rows_of_their_capacity() {
    let of = |setting: &str| {
        let mut b = Builder::new();
        b.row("sponza", setting, &[]);
        let table = tables(&[b.run()], "memory", &published()).remove(0);
        printed(&table, &["sponza"], 3)
    };
    assert_eq!((of("per-sample"), of("per-sample capacity=10000000")), (None, Some(40.0)));
}

#[test]
fn notes_say_what_groups_do_not_show() {
    let notes = |setting: &str| {
        let mut b = Builder::new();
        b.row("sponza", setting, &[]);
        tables(&[b.run()], "5.2", &Options::default())[0].notes.join(" ")
    };
    let (search, wait) = ("contains the search", "contains the wait for the host");
    assert!(notes("tiled").contains(search) && notes("buckets sync=readback").contains(wait));
    assert!(!notes("buckets").contains(search) && !notes("buckets").contains(wait));
}

/// A recorded width is shown in place of that of the flags, and keys of unlike widths are apart.
#[test]
fn keys_have_their_recorded_width() {
    let mut b = Builder::new();
    b.row("sponza", "per-sample", &[]).metrics.retain(|metric| metric.name != "key_bits");
    set(b.row("sibenik", "per-sample", &[]), "key_bits", 24u64);
    let table = &tables(&[b.run()], "keys", &Options::default())[1];
    let bits = |scene: &str| value(table, &["480x270", "8", "off", scene], 0);
    assert_eq!((bits("sponza"), bits("sibenik")), (Some(23.0), Some(24.0)));
}

#[test]
fn a_scene_without_rows_is_named_and_rows_can_be_chosen() {
    let mut b = Builder::new();
    b.row("box", "per-sample", &[]);
    b.row("box", "per-sample resolution=1920x1080", &[]);
    let runs = [b.run()];
    let rows = |options: &Options| {
        let table = tables(&runs, "5.2", options).remove(0);
        table.rows.iter().map(|row| format!("{} {}", row.keys[0], row.keys[2])).collect::<Vec<_>>()
    };
    assert_eq!(rows(&Options::default()), ["box 480x270", "box 1920x1080", "sponza ", "sponza "]);
    assert_eq!(rows(&Options { rows: Rows::Measured, ..published() }), ["box 480x270", "box 1920x1080"]);
    assert_eq!(rows(&Options { rows: Rows::Source, ..Options::default() }), ["sponza ", "sponza "]);
    let wide = Options { resolution: Some(1920), rows: Rows::Measured, ..Options::default() };
    assert_eq!(rows(&wide), ["box 1920x1080"]);
}

#[test]
fn a_row_counts_once_and_a_failure_is_named_until_it_is_measured() {
    let failed = |b: &mut Builder| {
        b.row("sponza", "buckets", &[]).refuse(Status::Failed, "overflow: 12 entries, the capacity is 10");
    };
    let mut first = Builder::new();
    failed(&mut first);
    first.row("sponza", "per-sample", &[("estimate", 10.0)]);
    let mut second = Builder::new();
    second.row("sponza", "per-sample", &[("estimate", 20.0)]);
    let notes = |runs: &[RecordedRun]| tables(runs, "5.2", &Options::default())[0].notes.join(" ");
    let mut runs = vec![first.run(), second.run()];
    let table = &tables(&runs, "5.2", &Options::default())[0];
    assert!((value(table, &["sponza", "per-sample"], 4).unwrap() - 20.7).abs() < 1e-9);
    assert!((SOURCE.read)(&runs).notes().iter().any(|note| note.contains("1 row was measured more than once")));
    assert!(notes(&runs).contains("overflow: 12 entries, the capacity is 10"), "{}", notes(&runs));
    let mut third = Builder::new();
    third.row("sponza", "buckets", &[]);
    runs.push(third.run());
    assert!(!notes(&runs).contains("overflow"), "{}", notes(&runs));
}

/// Defaults that decide between values that equally many rows have are those of the program.
#[test]
fn defaults_are_the_program_s() {
    use rtbench::workloads::splat::technique::Technique;
    for technique in ["per-sample", "buckets", "tiled"] {
        for (axis, value) in Technique::parse(technique).unwrap().axes().into_iter().filter(|(_, v)| !v.is_empty()) {
            assert!(DEFAULTS.contains(&(axis, value.as_str())), "{technique} {axis}={value}");
            assert!(OF_TECHNIQUE.contains(&axis), "{axis}");
        }
    }
}
