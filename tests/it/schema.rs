//! JSON Schema of journals and run.json: the files in docs/schema are what the types give, files of every workload
//! fit, and broken ones do not.

use crate::{fakes, toy};
use jsonschema::Validator;
use rtbench::record::journal::{FILE_NAME, schema_of};
use rtbench::record::{row, schema};
use rtbench::workloads::trace::schema1;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Set to write the files anew.
const RENEW: &str = "RTBENCH_RENEW_SCHEMA";

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/schema").join(name)
}

#[test]
fn the_files_are_what_the_types_give() {
    for (name, schema) in [
        ("journal.schema.json", schema::journal()),
        ("journal-1.schema.json", schema1::json_schema()),
        ("run.schema.json", schema::run()),
    ] {
        let text = serde_json::to_string_pretty(&schema).unwrap() + "\n";
        if std::env::var_os(RENEW).is_some() {
            std::fs::create_dir_all(file(name).parent().unwrap()).unwrap();
            std::fs::write(file(name), &text).unwrap();
        }
        let committed = std::fs::read_to_string(file(name)).unwrap_or_default();
        let hint = format!("renew it: {RENEW}=1 cargo test --release --test it schema::");
        assert!(committed == text, "docs/schema/{name} is not what the types give; {hint}");
        assert!(jsonschema::meta::is_valid(&schema), "{name} is no JSON Schema");
    }
}

fn validator(name: &str) -> Validator {
    let text = std::fs::read_to_string(file(name)).unwrap();
    jsonschema::validator_for(&serde_json::from_str(&text).unwrap()).unwrap()
}

/// The first line of a journal that does not fit the schema of its version: its number, and why.
fn journal_problem(text: &str) -> Option<String> {
    let name = match schema_of(text.as_bytes()).as_deref() {
        Some(schema1::SCHEMA) => "journal-1.schema.json",
        _ => "journal.schema.json",
    };
    let validator = validator(name);
    text.lines().enumerate().find_map(|(index, line)| {
        let Ok(value) = serde_json::from_str::<Value>(line) else { return Some(format!("{}: no JSON", index + 1)) };
        let error = validator.validate(&value).err()?;
        Some(format!("{}: {} at {}", index + 1, error, error.instance_path()))
    })
}

fn run_problem(text: &str) -> Option<String> {
    let value: Value = serde_json::from_str(text).unwrap();
    let error = validator("run.schema.json").validate(&value).err()?;
    Some(format!("{error} at {}", error.instance_path()))
}

/// Checks a run's folder of the current schema; returns its journal and its run.json.
fn check_folder(folder: &Path) -> (String, String) {
    let journal = std::fs::read_to_string(folder.join(FILE_NAME)).unwrap();
    let run = std::fs::read_to_string(folder.join("run.json")).unwrap();
    assert_eq!(schema_of(journal.as_bytes()).as_deref(), Some(row::SCHEMA));
    assert_eq!(journal_problem(&journal), None, "{}", folder.display());
    assert_eq!(run_problem(&run), None, "{}", folder.display());
    (journal, run)
}

/// A small sweep with rows of every status but wrong: one structure cannot be built, one scene cannot be read; resumed.
fn sweep(folder: &Path) {
    let broken = folder.join("broken.ply");
    std::fs::write(&broken, "ply\nformat ascii 1.0\nelement vertex 1\n").unwrap();
    let out = folder.join("run");
    let run = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_rtbench")).args(arguments).output().unwrap();
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let (out, broken) = (out.to_str().unwrap(), broken.to_str().unwrap());
    let common = ["--backend", "cpu", "--config", "P,PSR", "--resolution", "8", "--frames", "2", "--passes", "2"];
    let scenes = ["--scene", "scan:triangles=3000", "--scene", broken, "--structure", "bvh-stack,grid,kdtree"];
    let said = run(&[&["sweep"][..], &scenes, &common, &["--quiet", "--out", out]].concat());
    assert!(Path::new(out).join("run.json").exists(), "{said}");
    let said = run(&["sweep", "--quiet", "--resume", out]);
    let journal = std::fs::read_to_string(Path::new(out).join(FILE_NAME)).unwrap();
    for record in ["run", "input", "artifact", "row", "resumed", "end"] {
        assert!(journal.contains(&format!("\"record\":\"{record}\"")), "no record {record}: {said}");
    }
    for status in ["ok", "failed"] {
        assert!(journal.contains(&format!("\"status\":\"{status}\"")), "no row {status}: {said}");
    }
}

#[test]
fn files_of_every_workload_fit_and_broken_ones_do_not() {
    let folder = tempfile::tempdir().unwrap();
    sweep(folder.path());
    let (journal, run) = check_folder(&folder.path().join("run"));
    let other = tempfile::tempdir().unwrap();
    toy::small_run(other.path());
    check_folder(other.path());

    // Each change of a line breaks it; of each kind of record at least one
    let broken: [(&str, &str, &str); 9] = [
        ("run", "/schema", "\"rtbench/3\""),
        ("run", "/environment/logical_cpus", "\"two\""),
        ("run", "/devices/0/device_type", "\"toaster\""),
        ("input", "/metrics/0/value", "[1]"),
        ("artifact", "/key/axes/structure", "7"),
        ("row", "/status", "\"fine\""),
        ("row", "/samples/wall_ns", "[[-1]]"),
        ("resumed", "/started", "null"),
        ("end", "/complete", "\"yes\""),
    ];
    for (record, pointer, value) in broken {
        let start = format!("{{\"record\":\"{record}\"");
        let line = journal.lines().find(|line| line.starts_with(&start)).unwrap();
        let mut changed: Value = serde_json::from_str(line).unwrap();
        *changed.pointer_mut(pointer).unwrap_or_else(|| panic!("{record} has no {pointer}")) =
            serde_json::from_str(value).unwrap();
        let text = journal.replacen(line, &changed.to_string(), 1);
        assert!(journal_problem(&text).is_some(), "{record}: {pointer} = {value} fits");
    }
    let unknown = journal.replacen("{\"record\":\"row\"", "{\"record\":\"line\"", 1);
    assert!(journal_problem(&unknown).is_some());
    // And of run.json
    for (pointer, value) in [
        ("/run/schema", json!("rtbench/1")),
        ("/rows/0/status", json!({})),
        ("/inputs", json!(null)),
        ("/end", json!(1)),
    ] {
        let mut changed: Value = serde_json::from_str(&run).unwrap();
        *changed.pointer_mut(pointer).unwrap() = value;
        assert!(run_problem(&changed.to_string()).is_some(), "{pointer}");
    }
    let mut changed: Value = serde_json::from_str(&run).unwrap();
    changed.as_object_mut().unwrap().remove("artifacts");
    assert!(run_problem(&changed.to_string()).is_some(), "a run without artifacts");
}

#[test]
fn a_limit_of_64_bits_fits() {
    let mut line = serde_json::to_value(fakes::provenance()).unwrap();
    line["record"] = json!("run");
    assert_eq!(journal_problem(&line.to_string()), None);
}

#[test]
fn committed_runs_fit_the_schema_of_their_version() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut versions: Vec<String> = Vec::new();
    // Other folders of results/ are runs of this machine, which may be in progress
    let ignored = std::fs::read_to_string(root.join(".gitignore")).unwrap();
    for name in ignored.lines().filter_map(|line| line.strip_prefix("!/results/")?.strip_suffix('/')) {
        let folder = root.join("results").join(name);
        let Ok(journal) = std::fs::read_to_string(folder.join(FILE_NAME)) else { continue };
        assert_eq!(journal_problem(&journal), None, "{}", folder.display());
        let version = schema_of(journal.as_bytes()).unwrap();
        let run = std::fs::read_to_string(folder.join("run.json")).unwrap();
        // No program reads run.json of version 1; its journal has a schema
        assert_eq!(run_problem(&run).is_none(), version == row::SCHEMA, "{}", folder.display());
        if version == schema1::SCHEMA {
            let wrong = journal.replacen("\"status\":\"ok\"", "\"status\":\"fine\"", 1);
            assert!(wrong != journal && journal_problem(&wrong).is_some());
        }
        versions.push(version);
    }
    assert!(!versions.is_empty(), "no committed run");
}
