//! Tables 4.4 to 4.6 of a run, computed again from the text of its journal by code of their own: numbers, orders,
//! percentages, and whether a gain is within the margin of a claim.

use super::synthetic::everything;
use crate::sources::synthetic::write_run;
use rtbench::compare::judge::Outcome;
use rtbench::record::journal::FILE_NAME;
use rtbench::report::{Cell, Table};
use rtbench::sources::Options;
use rtbench::sources::claims::Finding;
use rtbench::sources::rt2::SOURCE;
use rtbench::sources::runs::RecordedRun;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const ROPES: &str = "kdtree:build=sort,search=ropes";
const STACK: &str = "kdtree:build=sort,search=stack";
const BVH: &str = "bvh-stack:build=sweep,max_leaf=3,cull=off";
const CULLED: &str = "bvh-stack:build=sweep,max_leaf=3";
const MIN_MAX: &str = "kdtree:build=min-max,search=stack";
const SORT: &str = "kdtree:build=sort,sorting=every-node,search=stack";
const SWEEP: &str = "bvh-stack:build=sweep,max_leaf=3,sorting=every-node";

/// What a journal has of a scene, by structure with its options.
#[derive(Default)]
struct Numbers {
    ms: BTreeMap<String, f64>,
    steps: BTreeMap<String, f64>,
    built: BTreeMap<String, f64>,
    model: BTreeMap<String, f64>,
    allocated: BTreeMap<String, f64>,
}

fn metric(of: &Value, ray: Option<&str>, name: &str) -> Option<f64> {
    let metrics = of["metrics"].as_array()?;
    metrics.iter().find(|m| m["name"] == name && m.get("of").and_then(Value::as_str) == ray)?["value"].as_f64()
}

fn structure(of: &Value) -> String {
    let axes = &of["key"]["axes"];
    let axis = |name: &str| axes[name].as_str().unwrap_or_default();
    let options: Vec<&str> = ["build", "traversal", "ray_options", "device_options"]
        .map(axis)
        .into_iter()
        .filter(|o| !o.is_empty())
        .collect();
    let name = axis("structure");
    // In any order: a set of options
    let mut options: Vec<&str> = options.iter().flat_map(|o| o.split(',')).collect();
    options.sort_unstable();
    if options.is_empty() { name.to_owned() } else { format!("{name}:{}", options.join(",")) }
}

/// A selection with its options sorted, as [`structure`] gives them.
fn sorted(selection: &str) -> String {
    let (name, options) = selection.split_once(':').unwrap_or((selection, ""));
    let mut options: Vec<&str> = options.split(',').collect();
    options.sort_unstable();
    format!("{name}:{}", options.join(","))
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 { values[middle] } else { (values[middle - 1] + values[middle]) / 2.0 }
}

/// Mean over frames of the median over passes.
fn mean_ms(row: &Value) -> Option<f64> {
    let samples =
        if row["timing_source"] == "device" { &row["samples"]["device_ns"] } else { &row["samples"]["wall_ns"] };
    let passes: Vec<Vec<f64>> = serde_json::from_value(samples.clone()).ok()?;
    let frames = passes.first()?.len();
    let frame = |index: usize| median(passes.iter().map(|pass| pass[index]).collect());
    Some((0..frames).map(frame).sum::<f64>() / frames as f64 / 1e6)
}

/// Numbers by scene, each scene as tables name it.
fn read(journal: &str) -> BTreeMap<String, Numbers> {
    let records: Vec<Value> = journal.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let mut scenes: BTreeMap<String, Numbers> = BTreeMap::new();
    let triangles = |name: &str| {
        let of = records.iter().find(|r| r["kind"] == "scene" && r["name"] == name).unwrap();
        metric(of, None, "triangles").unwrap()
    };
    let title = |record: &Value| {
        let name = record["key"]["axes"]["scene"].as_str().unwrap();
        let (base, options) = name.split_once(':').unwrap_or((name, ""));
        let kept: Vec<&str> = options.split(',').filter(|o| !o.is_empty() && !o.starts_with("triangles=")).collect();
        let options = if kept.is_empty() { String::new() } else { format!(":{}", kept.join(",")) };
        format!("{base}{options} ({})", triangles(name))
    };
    for record in &records {
        match record["record"].as_str() {
            Some("artifact") => {
                let (numbers, name) = (scenes.entry(title(record)).or_default(), structure(record));
                let of = |name: &str| metric(record, None, name).unwrap();
                numbers.built.insert(name.clone(), of("build_ms"));
                numbers.model.insert(name.clone(), of("rt2_bytes") / 1_048_576.0);
                numbers.allocated.insert(name, of("structure_bytes") / 1_048_576.0);
            }
            Some("row") if record["key"]["axes"]["config"] == "P" && record["status"] == "ok" => {
                let (numbers, name) = (scenes.entry(title(record)).or_default(), structure(record));
                numbers.ms.extend(mean_ms(record).map(|ms| (name.clone(), ms)));
                let primary = |name: &str| metric(record, Some("primary"), name);
                if let (Some(rays), Some(inner), Some(leaves)) = (primary("rays"), primary("inner"), primary("leaves"))
                {
                    numbers.steps.insert(name, (inner + leaves) / rays);
                }
            }
            _ => {}
        }
    }
    scenes
}

/// What a cell should have.
enum Expected {
    Number(Option<f64>),
    Words(Option<String>),
}

use Expected::{Number, Words};

fn order(numbers: [(&str, Option<f64>); 3], most_first: bool) -> Expected {
    let mut known: Vec<(f64, &str)> = numbers.iter().filter_map(|(name, number)| Some(((*number)?, *name))).collect();
    known.sort_by(|a, b| if most_first { b.0.total_cmp(&a.0) } else { a.0.total_cmp(&b.0) });
    Words((known.len() == 3).then(|| known.iter().map(|(_, name)| *name).collect::<Vec<_>>().join(", ")))
}

fn gains(ratio: Option<f64>) -> Vec<Expected> {
    let (more, less) = (ratio.map(|r| 100.0 * (r - 1.0)), ratio.map(|r| 100.0 - 100.0 / r));
    vec![Number(ratio), Number(more), Number(ratio), Number(less), Number(ratio)]
}

/// Compares the row of a scene with what it should be; the number of cells that have something.
fn compare(table: &Table, scene: &str, kind: Option<&str>, expected: &[Expected]) -> Result<usize, String> {
    let is_row = |keys: &[String]| keys[1] == scene && kind.is_none_or(|kind| keys[2] == kind);
    let Some(row) = table.rows.iter().find(|row| is_row(&row.keys)) else {
        return if expected.iter().all(|e| matches!(e, Number(None) | Words(None))) {
            Ok(0)
        } else {
            Err(format!("{}: no row of {scene} {kind:?}", table.title))
        };
    };
    let mut filled = 0;
    for (index, (cell, expected)) in row.cells.iter().zip(expected).enumerate() {
        let same = match (cell, expected) {
            (Cell::Number { value, .. }, Number(number)) => match (value, number) {
                (Some(value), Some(number)) => (value.value - number).abs() <= 1e-6 * number.abs().max(1e-3),
                (None, None) => true,
                _ => false,
            },
            (Cell::Words { value, .. }, Words(words)) => value == words,
            _ => false,
        };
        if !same {
            return Err(format!("{}: {scene} {kind:?}, column {index}: {cell:?}", table.title));
        }
        filled += usize::from(cell.is_filled());
    }
    Ok(filled)
}

/// The percentages of `results/rt2-2010/gains.csv`, by the model and the quantity.
fn printed(scene: &str, quantity: &str) -> Option<f64> {
    let model = match scene {
        "scan (32168)" => "Alien",
        "scan (107516)" => "Dino",
        s if s.starts_with("scan:spikes=") => "Dino",
        "dragon (871414)" | "scan (847216)" => "Dragon",
        _ => return None,
    };
    let text = std::fs::read_to_string(root().join("results/rt2-2010/gains.csv")).unwrap();
    let line =
        text.lines().map(|line| line.split(',').collect::<Vec<_>>()).find(|l| l[1] == model && l[2] == quantity)?;
    line[5].parse().ok()
}

/// A case of a claim agrees exactly if its gain is within ten points of the printed one in a reading.
fn margin(findings: &[Finding], claim: &str, scene: &str, ratio: Option<f64>, quantity: &str) -> Result<usize, String> {
    let finding = findings.iter().find(|f| f.claim == claim).unwrap();
    let case = finding.cases.iter().find(|case| case.scene == scene);
    let Some((ratio, printed)) = ratio.zip(printed(scene, quantity)) else {
        return if case.is_none() { Ok(0) } else { Err(format!("claim {claim} has a case of {scene}")) };
    };
    let within = [100.0 * (ratio - 1.0), 100.0 - 100.0 / ratio].iter().any(|gain| (gain - printed).abs() <= 10.0);
    match case {
        Some(case) if (case.outcome == Outcome::Agrees) == within => Ok(1),
        _ => Err(format!("claim {claim}, {scene}, ratio {ratio}, printed {printed}: {case:?}")),
    }
}

/// Holds the tables and claims against the text of a journal; the number of cells with something.
fn check(tables: &[Table], findings: &[Finding], journal: &str) -> Result<usize, String> {
    let titled = |title: &str| {
        let found: Vec<&Table> = tables.iter().filter(|table| table.title.starts_with(title)).collect();
        // One device, one builder
        assert_eq!(found.len(), 1, "{title}");
        found[0]
    };
    let mut cells = 0;
    for (scene, numbers) in &read(journal) {
        let scene = scene.as_str();
        let of = |map: &BTreeMap<String, f64>, name: &str| map.get(&sorted(name)).copied();
        let first = |map: &BTreeMap<String, f64>, names: &[&str]| names.iter().find_map(|name| of(map, name));
        let rate = |name: &str| of(&numbers.ms, name).map(|ms| 1000.0 / ms);
        let (ropes, stack, bvh, culled) = (rate(ROPES), rate(STACK), rate(BVH), rate(CULLED));
        let alike = order([("ropes", ropes), ("kd", stack), ("BVH", bvh)], true);
        let other = order([("ropes", ropes), ("kd", stack), ("BVH", culled)], true);
        let expected = [Number(ropes), Number(stack), Number(bvh), alike, Number(culled), other];
        cells += compare(titled("Frames per second at"), scene, None, &expected)?;
        for (kind, bvh) in [("as printed", BVH), ("culled", CULLED)] {
            let by_time = stack.zip(rate(bvh)).map(|(kd, bvh)| kd / bvh);
            let table = titled("Gain of the kd-tree over the BVH in frames per second");
            cells += compare(table, scene, Some(kind), &gains(by_time))?;
            let by_steps = of(&numbers.steps, bvh).zip(of(&numbers.steps, STACK)).map(|(bvh, kd)| bvh / kd);
            cells += compare(titled("Gain of the kd-tree over the BVH in steps"), scene, Some(kind), &gains(by_steps))?;
            if kind == "as printed" {
                let by_counts =
                    findings.iter().any(|f| f.claim == "2a" && f.basis == rtbench::sources::claims::Basis::Counts);
                let ratio = if by_counts { by_steps } else { by_time };
                cells += margin(findings, "2a", scene, ratio, "frame_rate")?;
            }
        }
        let built = |name: &str| of(&numbers.built, name);
        let (min_max, sweep, sort) = (built(MIN_MAX), built(SWEEP), built(SORT));
        let times = order([("min-max", min_max), ("BVH", sweep), ("sort", sort)], false);
        cells += compare(
            titled("Build times, one thread"),
            scene,
            None,
            &[Number(min_max), Number(sweep), Number(sort), times],
        )?;
        let saved = sort.zip(sweep).map(|(sort, bvh)| sort / bvh);
        cells += compare(titled("Gain of the BVH over the kd-tree"), scene, Some("every node"), &gains(saved))?;
        cells += margin(findings, "5", scene, saved, "build_time")?;
        let mut expected = Vec::new();
        for map in [&numbers.model, &numbers.allocated] {
            let (kd, bvh) = (first(map, &[STACK, SORT]), first(map, &[BVH, CULLED, SWEEP]));
            let ropes = of(map, ROPES);
            expected.extend([Number(kd), Number(bvh), Number(ropes)]);
            expected.push(order([("kd", kd), ("BVH", bvh), ("ropes", ropes)], false));
        }
        cells += compare(titled("Memory of structures"), scene, None, &expected)?;
    }
    Ok(cells)
}

/// Tables and claims of a run in a folder, and the text of its journal.
fn shown(folder: &Path) -> (Vec<Table>, Vec<Finding>, String) {
    let run = RecordedRun::read(folder).unwrap();
    let results = (SOURCE.read)(&[run]);
    let options = Options { published: true, ..Options::default() };
    let journal = std::fs::read_to_string(folder.join(FILE_NAME)).unwrap();
    (results.tables(SOURCE.tables, &options), results.claims(&Default::default()), journal)
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Folders of runs of the preset `rt2-lite` that are kept in git.
fn committed() -> Vec<PathBuf> {
    let ignore = std::fs::read_to_string(root().join(".gitignore")).unwrap();
    let names = ignore.lines().filter_map(|line| line.strip_prefix("!/results/"));
    names.filter(|name| name.starts_with("rt2-lite-")).map(|name| root().join("results").join(name)).collect()
}

#[test]
fn tables_of_a_run_are_what_its_journal_says() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    write_run(&everything(), &run);
    let (tables, findings, journal) = shown(&run);
    assert!(check(&tables, &findings, &journal).unwrap() > 200);
    // Seen to fail: a build time, a size, a count and a time that are others
    for (old, new) in [
        ("\"build_ms\",\"value\":45.0", "\"build_ms\",\"value\":46.0"),
        ("\"rt2_bytes\",\"value\":643360", "\"rt2_bytes\",\"value\":643361"),
        ("\"inner\",\"of\":\"primary\",\"value\":900", "\"inner\",\"of\":\"primary\",\"value\":901"),
        ("10619999", "10629999"),
    ] {
        assert!(journal.contains(old), "{old} is not in the journal");
        assert!(check(&tables, &findings, &journal.replace(old, new)).is_err(), "{old} -> {new} is not found");
    }
}

#[test]
fn tables_of_the_committed_run_are_what_its_journal_says() {
    let runs = committed();
    if runs.is_empty() {
        eprintln!("NOT RUN: results/ keeps no run rt2-lite-*");
    }
    for folder in runs {
        let (tables, findings, journal) = shown(&folder);
        let cells = check(&tables, &findings, &journal).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
        assert!(cells > 100, "{}: {cells}", folder.display());
    }
}
