//! Tables of the committed run, computed again from the text of its journal.

use rtbench::compare::judge::Verdict;
use rtbench::report::Cell;
use rtbench::sources::Options;
use rtbench::sources::runs::RecordedRun;
use rtbench::sources::splat::SOURCE;
use serde_json::Value;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("results/splat-reference-2026-11-30")
}

/// The rows of the journal as JSON.
fn rows() -> Vec<Value> {
    let text = std::fs::read_to_string(folder().join("journal.jsonl")).unwrap();
    let lines = text.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    lines.filter(|value| value["record"] == "row").collect()
}

/// Milliseconds of the stages that `is` accepts, mean over frames and passes.
fn stages_ms(row: &Value, is: impl Fn(&str) -> bool) -> f64 {
    let samples = &row["samples"];
    let names: Vec<&str> = samples["stages"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    let (mut sum, mut frames) = (0.0, 0.0);
    for frame in samples["stage_ns"].as_array().unwrap().iter().flat_map(|pass| pass.as_array().unwrap()) {
        frames += 1.0;
        let times = frame.as_array().unwrap().iter().zip(&names);
        sum += times.filter(|(_, name)| is(name)).map(|(ns, _)| ns.as_f64().unwrap()).sum::<f64>();
    }
    sum / frames / 1e6
}

fn metric(row: &Value, name: &str) -> Option<f64> {
    let metrics = row["metrics"].as_array().unwrap();
    metrics.iter().find(|m| m["name"] == name && m["of"].is_null()).and_then(|m| m["value"].as_f64())
}

fn number(cell: &Cell) -> Option<f64> {
    match cell {
        Cell::Number { value, .. } => value.map(|v| v.value),
        _ => None,
    }
}

#[test]
fn the_committed_run_fills_its_tables() {
    let run = RecordedRun::read(&folder()).unwrap();
    let results = (SOURCE.read)(std::slice::from_ref(&run));
    let rows: Vec<Value> = rows().into_iter().filter(|row| row["status"] == "ok").collect();
    assert_eq!(rows.len(), 32);
    let quality = &results.tables(&["quality"], &Options::default())[0];
    assert_eq!(quality.rows.len(), rows.iter().filter(|row| metric(row, "rmse").is_some()).count());
    // Rows with the options that most rows have
    let usual = |row: &&Value| {
        let axes = &row["key"]["axes"];
        let defaults = [("kernel", "epanechnikov"), ("weight", "side"), ("structure", "bvh-stack"), ("hits", "4")];
        let of_light = [("falloff", "square"), ("energy", "flux")];
        defaults.iter().chain(&of_light).all(|(axis, value)| axes[*axis] == *value)
    };
    let keys = |row: &Value| {
        let axis = |name: &str| row["key"]["axes"][name].as_str().unwrap_or("").to_owned();
        vec![axis("scene"), axis("technique"), axis("resolution"), axis("tile"), axis("radius"), axis("paths")]
    };
    let groups = &results.tables(&["5.2"], &Options::default())[0];
    let mut compared = 0;
    for row in rows.iter().filter(usual) {
        let keys = keys(row);
        let own = quality.rows.iter().find(|other| other.keys == keys).unwrap_or_else(|| panic!("{keys:?}"));
        for (column, name) in [(1, "irradiance_mean"), (4, "ratio_to_path_traced"), (5, "rmse")] {
            assert_eq!(number(&own.cells[column]), metric(row, name), "{keys:?} {name}");
        }
        let own = groups.rows.iter().find(|other| other.keys == keys).unwrap_or_else(|| panic!("{keys:?}"));
        let expected = [
            Some(stages_ms(row, |stage| stage.starts_with("hit-") || stage == "compaction")),
            Some(stages_ms(row, |stage| matches!(stage, "samples" | "direct"))),
            None,
            None,
            Some(stages_ms(row, |stage| matches!(stage, "estimate" | "mix"))),
        ];
        for (cell, expected) in own.cells.iter().zip(expected) {
            let close = match (number(cell), expected) {
                (Some(own), Some(expected)) => (own / expected - 1.0).abs() < 1e-5,
                (own, expected) => own == expected,
            };
            assert!(close, "{keys:?} {cell:?} {expected:?}");
        }
        compared += 1;
    }
    assert!(compared >= 16, "{compared}");
}

#[test]
fn the_committed_run_decides_what_needs_no_clusters() {
    let run = RecordedRun::read(&folder()).unwrap();
    let findings = (SOURCE.read)(&[run]).claims(&Options::default());
    for finding in findings {
        let is_decided = ["14", "15"].contains(&finding.claim);
        assert_eq!(finding.verdict != Verdict::NotMeasured, is_decided, "{}: {:?}", finding.claim, finding.cases);
    }
}
