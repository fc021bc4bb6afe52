//! What a review found in compare, gate, bless and merge.

use super::{Gated, rtbench, text};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// A copy of a run under another name, with one edit of its journal.
fn copy(gated: &Gated, name: &str, from: &str, to: &str) -> PathBuf {
    let folder = gated.folder.path().join(name);
    std::fs::create_dir(&folder).unwrap();
    let journal = std::fs::read_to_string(gated.run.join("journal.jsonl")).unwrap();
    let edited = journal.replacen(from, to, 1);
    assert!(edited != journal || from == to, "{from}");
    std::fs::write(folder.join("journal.jsonl"), edited.replacen("\"id\":\"", &format!("\"id\":\"{name}"), 1)).unwrap();
    folder
}

fn compare(code: i32, sides: &[&str]) -> String {
    let output = rtbench(["compare"].iter().chain(sides));
    let all = text(&output.stdout) + &text(&output.stderr);
    assert!(output.status.code() == Some(code) && !all.contains("panicked"), "{sides:?}: {all}");
    all
}

fn list(paths: &[&Path]) -> String {
    paths.iter().map(|path| path.to_str().unwrap()).collect::<Vec<_>>().join(",")
}

#[test]
fn exact_quantities_are_compared_in_every_run() {
    let gated = Gated::new();
    let [a, b, c] = ["a", "b", "c"].map(|name| copy(&gated, name, "", ""));
    let other = copy(
        &gated,
        "other",
        "{\"name\":\"tests\",\"of\":\"primary\",\"value\":",
        "{\"name\":\"tests\",\"of\":\"primary\",\"value\":9",
    );
    let sound = compare(0, &[&list(&[&a, &b]), &list(&[&c])]);
    assert!(sound.contains("exact quantities agree"), "{sound}");
    for sides in [
        vec![list(&[&a, &other]), list(&[&b])],
        vec![list(&[&a]), list(&[&b, &other])],
        vec![list(&[&a]), list(&[&other]), list(&[&b])],
    ] {
        let sides: Vec<&str> = sides.iter().map(String::as_str).collect();
        let text = compare(0, &sides);
        assert!(text.contains("primary.tests") && !text.contains("exact quantities agree"), "{text}");
    }
    // A run is no repetition of itself
    let twice = compare(2, &[&list(&[&a, &a]), &list(&[&b])]);
    assert!(twice.contains("a copy of it"), "{twice}");
}

#[test]
fn sides_in_between_are_held_to_the_same_conditions() {
    let gated = Gated::new();
    let [a, b] = ["a", "b"].map(|name| copy(&gated, name, "", ""));
    let machine = copy(&gated, "machine", "\"logical_cpus\":", "\"logical_cpus\":9");
    let text = compare(0, &[&list(&[&a]), &list(&[&machine]), &list(&[&b])]);
    assert!(text.contains("machine ") && text.contains("not compared"), "{text}");
    let refused = compare(2, &[&list(&[&a]), &list(&[&machine])]);
    assert!(refused.contains("--across machine"), "{refused}");
    let across = compare(0, &[&list(&[&a]), &list(&[&machine]), "--across", "machine"]);
    assert!(across.contains("compared across"), "{across}");
    let wrong = copy(&gated, "wrong", "\"status\":\"ok\"", "\"status\":\"wrong\"");
    let text = compare(0, &[&list(&[&a]), &list(&[&wrong]), &list(&[&b])]);
    assert!(text.contains("1 rows of sides in between have no result"), "{text}");
}

#[test]
fn what_gate_compare_and_ab_read_is_not_written_over() {
    let gated = Gated::new();
    let path = |path: &Path| path.to_str().unwrap().to_owned();
    let (run, baseline) = (path(&gated.run), path(&gated.baseline));
    let picture = path(&std::fs::read_dir(gated.run.join("pictures")).unwrap().next().unwrap().unwrap().path());
    let inside = |name: &str| path(&gated.run.join(name));
    for arguments in [
        vec!["gate", &run, "--baseline", &baseline, "-o", &baseline],
        vec!["compare", &run, &run, "-o", &inside("run.json")],
        vec!["compare", &run, &run, "--html", &inside("summary.csv")],
        vec!["report", &run, "-o", &picture],
        vec!["tables", &run, "-o", &inside("structures.csv")],
    ] {
        let target = arguments.last().unwrap();
        let before = std::fs::read(target).unwrap();
        let output = rtbench(&arguments);
        let error = text(&output.stderr);
        assert!(output.status.code() == Some(2) && error.contains("the same file as"), "{arguments:?}: {error}");
        assert!(std::fs::read(target).unwrap() == before, "{arguments:?}");
    }
    let same = path(&gated.folder.path().join("same.txt"));
    let output = rtbench(["compare", &run, &run, "-o", &same, "--html", &same]);
    assert!(output.status.code() == Some(2) && text(&output.stderr).contains("give two files"));
}

#[test]
fn a_gate_says_what_it_did_not_judge() {
    let gated = Gated::new();
    // A budget for times in a baseline without times
    gated.edit_baseline("\"budgets\": {}", "\"budgets\": {\"frame_ms\": {\"share\": 0.25}}");
    assert!(gated.gate(0).contains("4 times have a budget and were not judged"));
    assert!(gated.gate_with(2, &["--strict"]).contains("bless"));
    gated.edit_baseline("{\"share\": 0.25}", "{\"share\": 0.25, \"absolute\": 1}");
    assert!(gated.gate(2).contains("give share, not absolute"));
    gated.edit_baseline(", \"absolute\": 1", "");
    gated.bless(0);
    assert!(!gated.gate(0).contains("not judged"));
    let mut baseline: Value = serde_json::from_str(&std::fs::read_to_string(&gated.baseline).unwrap()).unwrap();
    let row = baseline["rows"].as_object_mut().unwrap().values_mut().next().unwrap();
    row["frame_ms"] = json!(-1.0);
    std::fs::write(&gated.baseline, baseline.to_string()).unwrap();
    assert!(gated.gate(2).contains("out of range"));
    // A key that is there twice
    gated.bless(2);
    std::fs::remove_file(&gated.baseline).unwrap();
    gated.bless(0);
    gated.edit_baseline("\"workload\": \"sweep\",", "\"workload\": \"sweep\",\n  \"kernels\": {},");
    assert!(gated.gate(2).contains("\"kernels\" is there twice"));
    std::fs::remove_file(&gated.baseline).unwrap();
    gated.bless(0);
    // Flags for a run that is there already
    assert!(gated.gate_with(2, &["--", "--backend", "cpu"]).contains("--run PRESET"));
    // An artifact that is gone while its rows are there
    gated.edit(|record| record["record"] != "artifact");
    assert!(gated.gate(1).contains("built -> gone"));
}

#[test]
fn rows_outside_of_the_plan_fail_a_strict_gate() {
    let gated = Gated::new();
    gated.edit(|record| {
        if record["record"] == "run" {
            record["plan"]["axes"]["structure"] = json!(["kdtree"]);
        }
        !(record["record"] != "run" && record["key"]["axes"]["structure"] == "bvh")
    });
    assert!(gated.gate(0).contains("2 rows of the baseline are not in the plan"));
    assert!(gated.gate_with(2, &["--strict"]).contains("not in the plan"));
    gated.edit_row("kdtree", |row| row["status"] = json!("wrong"));
    let red = gated.gate(1);
    assert!(!red.contains("if the differences are intended"), "what is wrong cannot be blessed: {red}");
}

#[test]
fn a_budget_without_its_quantity_is_not_blessed() {
    let gated = Gated::new();
    gated.edit_baseline("\"budgets\": {}", "\"budgets\": {\"nodes\": {\"absolute\": 2}}");
    gated.gate(0);
    gated.edit(|record| {
        if let Some(metrics) = record["metrics"].as_array_mut() {
            metrics.retain(|metric| metric["name"] != "nodes");
        }
        true
    });
    let before = std::fs::read(&gated.baseline).unwrap();
    assert!(gated.bless(2).contains("budget for nodes"));
    assert_eq!(std::fs::read(&gated.baseline).unwrap(), before);
}

#[test]
fn a_new_row_that_is_wrong_is_an_error_and_so_is_one_in_a_merged_run() {
    let gated = Gated::new();
    let a = copy(&gated, "a", "", "");
    let b = copy(&gated, "b", "\"status\":\"ok\"", "\"status\":\"wrong\"");
    let journal = a.join("journal.jsonl");
    let kept: String = std::fs::read_to_string(&journal)
        .unwrap()
        .split_inclusive('\n')
        .scan(false, |skipped, line| {
            let skip = !*skipped && line.contains("\"record\":\"row\"");
            *skipped |= skip;
            Some(if skip { "" } else { line })
        })
        .collect();
    std::fs::write(&journal, kept).unwrap();
    let text_of = compare(0, &[&list(&[&a]), &list(&[&b]), "--format", "csv"]);
    assert!(text_of.contains("new, wrong"), "{text_of}");
    let out = gated.folder.path().join("merged");
    let output = rtbench(["merge".as_ref(), b.as_os_str(), "--out".as_ref(), out.as_os_str()]);
    assert!(output.status.code() == Some(1) && text(&output.stderr).contains("1 rows are wrong"), "{output:?}");
}

#[test]
fn sides_of_ab_name_each_axis_once() {
    for (a, flags, words) in [
        ("structure=grid;structure=bvh", vec![], "structure is given twice"),
        ("structure=grid", vec!["--structure", "bvh"], "--structure is what A and B differ in"),
    ] {
        let output = rtbench(["ab", a, "structure=bvh", "--"].into_iter().chain(flags));
        let error = text(&output.stderr);
        assert!(output.status.code() == Some(2) && error.contains(words), "{error}");
    }
}
