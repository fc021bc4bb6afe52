//! Runs against each other: pairing, conditions, verdicts, and what reading takes.

use crate::journals::{Generated, write, write_with};
use rtbench::Result;
use rtbench::compare::conditions::{ComparedRun, check_across};
use rtbench::compare::runs::{self, Comparison, Options, Shown, Side, Verdict};
use rtbench::record::row::{Row, Status};
use rtbench::record::stream::{LeanRun, Names};
use std::path::Path;

fn options(across: &[&str]) -> Options {
    Options {
        across: across.iter().map(|name| name.to_string()).collect(),
        margin_pct: 3.0,
        axes: ["scene", "structure", "config", "resolution"].map(str::to_owned).into(),
        machine: vec!["dispatches".into()],
    }
}

/// Compares sides of so many runs each.
fn compared(names: &mut Names, sides: &[&[&Path]], across: &[&str]) -> Result<Comparison> {
    let mut all = Vec::new();
    let mut named = Vec::new();
    for (index, side) in sides.iter().enumerate() {
        let first = all.len();
        for folder in *side {
            all.push(ComparedRun::new(LeanRun::read(folder, names)?));
        }
        named.push(Side { name: format!("side {index}"), runs: (first..all.len()).collect() });
    }
    check_across(&options(across).across, names, &all)?;
    runs::compare(names, all, named, &options(across))
}

/// Two runs, the second one edited.
fn pair(across: &[&str], edit: impl FnMut(&mut Row)) -> (Names, Result<Comparison>) {
    let folder = tempfile::tempdir().unwrap();
    let (old, new) = (folder.path().join("old"), folder.path().join("new"));
    write(&old, &Generated::new(30));
    write_with(&new, &Generated::new(30), edit);
    let mut names = Names::default();
    let comparison = compared(&mut names, &[&[&old], &[&new]], across);
    (names, comparison)
}

#[test]
fn equal_runs_differ_in_nothing_exact_and_times_stay_ambiguous() {
    let (_, comparison) = pair(&[], |_| {});
    let comparison = comparison.unwrap();
    assert!(comparison.changes.is_empty());
    // 1 + 18 whole numbers and a hash per row; `dispatches` is the machine's, `build_ms` is no whole number
    assert_eq!(comparison.exact_compared, 30 * 20);
    assert_eq!(comparison.count("ambiguous"), 30);
    assert_eq!(comparison.means[0].ratio, 1.0);
    // All rows, then five structures, three configurations, two sizes; there is one scene
    assert_eq!(comparison.means.len(), 1 + 5 + 3 + 2);
}

#[test]
fn one_count_more_is_named() {
    let mut index = 0;
    let (names, comparison) = pair(&[], |row| {
        if index == 7 {
            let metric =
                row.metrics.iter_mut().find(|m| m.name == "inner" && m.of.as_deref() == Some("shadow")).unwrap();
            metric.value = 601u64.into();
        }
        index += 1;
    });
    let comparison = comparison.unwrap();
    assert_eq!(comparison.changes.len(), 1);
    let change = comparison.changes[0];
    assert_eq!(comparison.rows[change.row].label, "scan:triangles=1000 bvh PS 64x64");
    assert_eq!(names.text(change.quantity), "shadow.inner");
    assert_eq!((change.old.write(&names), change.new.write(&names)), ("600".into(), "601".into()));
}

#[test]
fn unlike_conditions_are_refused_by_name_and_compared_on_request() {
    type Edit = fn(&mut Row);
    let cases: [(&str, Edit); 4] = [
        ("scene", |row| drop(row.key.inputs.insert("scene".into(), "other".into()))),
        ("camera-path", |row| drop(row.key.inputs.insert("camera_path".into(), "other".into()))),
        ("kernel", |row| row.kernels[0].hash = "ffffffffffffffff".into()),
        ("settings", |row| row.settings.passes = 9),
    ];
    for (condition, edit) in cases {
        let (_, refused) = pair(&[], edit);
        let error = refused.unwrap_err().to_string();
        assert!(
            error.contains(&format!("{condition} ")) && error.contains(&format!("--across {condition}")),
            "{error}"
        );
        let (_, allowed) = pair(&[condition], edit);
        assert_eq!(allowed.unwrap().count("ambiguous"), 30, "{condition}");
        // One row of thirty is split off
        let mut first = true;
        let (_, split) = pair(&[], |row| {
            if std::mem::take(&mut first) {
                edit(row);
            }
        });
        let split = split.unwrap();
        assert_eq!((split.count("incomparable"), split.count("ambiguous")), (1, 29), "{condition}");
        assert!(split.rows[0].verdict.reason().contains(condition), "{:?}", split.rows[0].verdict);
    }
    let (_, unknown) = pair(&["weather"], |_| {});
    assert!(unknown.unwrap_err().to_string().contains("there is no condition 'weather'"));
}

#[test]
fn hashes_are_compared_within_one_driver_only() {
    let folder = tempfile::tempdir().unwrap();
    let (old, new) = (folder.path().join("old"), folder.path().join("new"));
    write(&old, &Generated::new(30));
    write(&new, &Generated { image: "2".repeat(64), ..Generated::new(30) });
    let mut names = Names::default();
    assert_eq!(compared(&mut names, &[&[&old], &[&new]], &[]).unwrap().changes.len(), 30);
    let journal = new.join("journal.jsonl");
    let text = std::fs::read_to_string(&journal).unwrap().replace("driver 1", "driver 2");
    std::fs::write(&journal, text).unwrap();
    let error = compared(&mut names, &[&[&old], &[&new]], &[]).unwrap_err().to_string();
    assert!(error.contains("driver driver 2, not driver 1"), "{error}");
    let across = compared(&mut names, &[&[&old], &[&new]], &["driver"]).unwrap();
    assert!(across.changes.is_empty());
    assert_eq!(across.exact_compared, 30 * 19);
}

#[test]
fn rows_without_a_partner_and_without_a_result_have_their_words() {
    let mut index = 0;
    let (_, comparison) = pair(&[], |row| {
        match index {
            0 => row.refuse(Status::Wrong, "3 of 100 pixels differ"),
            1 => drop(row.key.axes.insert("structure".into(), "brand-new".into())),
            _ => {}
        }
        index += 1;
    });
    let comparison = comparison.unwrap();
    assert_eq!(comparison.rows[0].verdict, Verdict::Error("wrong: 3 of 100 pixels differ".into()));
    assert_eq!((comparison.count("gone"), comparison.count("new"), comparison.count("error")), (1, 1, 1));
    assert_eq!(comparison.rows.last().unwrap().label, "scan:triangles=1000 brand-new P 64x64");
}

#[test]
fn three_runs_on_each_side_get_a_verdict_and_two_do_not() {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str, ns: u64| {
        let path = folder.path().join(name);
        write(&path, &Generated { passes_ns: vec![ns; 3], ..Generated::new(30) });
        path
    };
    let old: Vec<_> = [1_000_000, 1_010_000, 1_020_000].iter().map(|&ns| run(&format!("old-{ns}"), ns)).collect();
    let new: Vec<_> = [800_000, 810_000, 820_000].iter().map(|&ns| run(&format!("new-{ns}"), ns)).collect();
    let near: Vec<_> = [1_005_000, 1_015_000, 1_012_000].iter().map(|&ns| run(&format!("near-{ns}"), ns)).collect();
    let paths = |list: &'_ [std::path::PathBuf]| list.iter().map(|path| path.as_path().to_owned()).collect::<Vec<_>>();
    let of = |a: &[std::path::PathBuf], b: &[std::path::PathBuf]| {
        let (a, b) = (paths(a), paths(b));
        let (a, b): (Vec<&Path>, Vec<&Path>) = (a.iter().map(|p| &**p).collect(), b.iter().map(|p| &**p).collect());
        compared(&mut Names::default(), &[&a, &b], &[]).unwrap()
    };
    let faster = of(&old, &new);
    assert_eq!(faster.count("faster"), 30);
    assert!((faster.means[0].ratio - 0.81 / 1.01).abs() < 1e-3, "{}", faster.means[0].ratio);
    assert_eq!(of(&new, &old).count("slower"), 30);
    assert_eq!(of(&old, &near).count("same"), 30);
    assert_eq!(of(&old[..2], &new).count("ambiguous"), 30);
}

#[test]
fn formats_agree() {
    let folder = tempfile::tempdir().unwrap();
    let paths = ["may", "june", "july"].map(|name| folder.path().join(name));
    for (path, ns) in paths.iter().zip([1_000_000, 1_100_000, 1_300_000]) {
        write(path, &Generated { passes_ns: vec![ns; 3], inner: ns / 1000, ..Generated::new(30) });
    }
    let mut names = Names::default();
    let comparison = compared(&mut names, &[&[&paths[0]], &[&paths[1]], &[&paths[2]]], &[]).unwrap();
    assert!((comparison.means[0].ratio - 1.3).abs() < 1e-9);
    assert_eq!(comparison.rows[0].times_ms, [1.0, 1.1, 1.3].map(Some));
    let json = runs::json(&comparison, &names);
    assert_eq!(json["rows"].as_array().unwrap().len(), 30);
    assert_eq!(json["exact"]["differing"][0]["quantity"], "primary.inner");
    assert_eq!(json["exact"]["differing"][0]["new"], 1300);
    let text = runs::csv(&comparison, &names);
    let lines: Vec<csv::StringRecord> =
        csv::Reader::from_reader(text.as_bytes()).records().map(|r| r.unwrap()).collect();
    assert_eq!(lines.len(), 3 * 30 + 30);
    assert_eq!(&lines[0][2], "primary.inner");
    let time = lines.iter().find(|line| &line[0] == "time").unwrap();
    assert_eq!((&time[3], &time[4], &time[5], &time[9]), ("1.000000", "1.300000", "1.300000", "ambiguous"));
    let page = runs::page(&comparison, &names, Shown { rows: 10 }).unwrap();
    assert!(page.contains("<svg") && page.contains("primary.inner") && page.contains("june"));
    // Exact quantities come first, in every form
    assert!(page.find("Exact quantities") < page.find("Rows"));
    let tables = runs::tables(&comparison, &names, Shown { rows: 10 });
    assert_eq!((tables[0].title.as_str(), tables[2].rows.len()), ("Exact quantities that differ", 10));
}

#[test]
fn reading_takes_memory_in_proportion_to_rows() {
    let folder = tempfile::tempdir().unwrap();
    let read = |rows: usize| {
        let path = folder.path().join(rows.to_string());
        write(&path, &Generated::new(rows));
        allocation_counter::measure(|| {
            let mut names = Names::default();
            assert_eq!(LeanRun::read(&path, &mut names).unwrap().rows.len(), rows);
        })
    };
    let (small, large) = (read(1500), read(6000));
    let ratio = large.bytes_max as f64 / small.bytes_max as f64;
    assert!(ratio < 4.8, "{ratio}");
    // 200,000 rows within 500 MB
    assert!(large.bytes_max < 6000 * 2000, "{} bytes per row", large.bytes_max / 6000);
    let ratio = large.count_total as f64 / small.count_total as f64;
    assert!(ratio < 4.4, "{ratio}");
}

#[test]
fn runs_that_have_not_ended_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    write(&path, &Generated::new(30));
    let journal = path.join("journal.jsonl");
    let text = std::fs::read_to_string(&journal).unwrap();
    let error = |text: &str| {
        std::fs::write(&journal, text).unwrap();
        LeanRun::read(&path, &mut Names::default()).unwrap_err().to_string()
    };
    let without_end: String =
        text.lines().filter(|line| !line.contains("\"record\":\"end\"")).map(|l| format!("{l}\n")).collect();
    assert!(error(&without_end).contains("the run has not ended"));
    assert!(error(&without_end[..without_end.len() - 9]).contains("the run has not ended"));
    assert!(error(&text.replace("\"complete\":true", "\"complete\":false")).contains("ended before all rows"));
    assert!(error("").contains("empty"));
    assert!(error(&text.replace("rtbench/2", "rtbench/1")).contains(":1: schema \"rtbench/1\""));
    assert!(error(&text.replacen("\"record\":\"row\"", "\"record\":\"raw\"", 1)).contains(":9: not a record"));
    std::fs::write(&journal, &text).unwrap();
    let writer = std::fs::File::open(&journal).unwrap();
    writer.lock().unwrap();
    let locked = LeanRun::read(&path, &mut Names::default()).unwrap_err().to_string();
    assert!(locked.contains("another process is writing this run"), "{locked}");
}
