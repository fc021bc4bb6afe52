//! Tables 1 to 4, speed-ups, Karp-Flatt metrics and all verdicts of a run, computed again from the text of its journal
//! by code of their own.

use super::synthetic::{everything, write_run};
use rtbench::compare::judge::{Outcome, Verdict};
use rtbench::record::journal::FILE_NAME;
use rtbench::report::{Cell, Table};
use rtbench::sources::Options;
use rtbench::sources::claims::Finding;
use rtbench::sources::runs::RecordedRun;
use rtbench::sources::spheres::SOURCE;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const SCENES: [&str; 3] = ["default", "random20", "random100"];

/// Columns of table 2, then the GPU.
const RENDERERS: [(&str, &str); 5] = [
    ("sequential", "sequential"),
    ("simd-threads", "SIMD + threads"),
    ("simd", "SIMD"),
    ("threads", "threads"),
    ("gpu", "GPU"),
];

/// Milliseconds, noise as a share, and processors of a row; 0 where they are not known.
#[derive(Clone, Copy)]
struct Time {
    ms: f64,
    noise: f64,
    processors: f64,
}

/// Times by scene and setting, and errors of half precision by scene.
struct Journal {
    times: BTreeMap<(String, String), Time>,
    errors: Vec<f64>,
    fastest_simd: BTreeMap<String, (Time, f64)>,
}

fn metric(of: &Value, name: &str) -> Option<f64> {
    of["metrics"].as_array()?.iter().find(|m| m["name"] == name && m.get("of").is_none())?["value"].as_f64()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 { values[middle] } else { (values[middle - 1] + values[middle]) / 2.0 }
}

fn time(row: &Value) -> Option<(f64, f64)> {
    let samples =
        if row["timing_source"] == "device" { &row["samples"]["device_ns"] } else { &row["samples"]["wall_ns"] };
    let passes: Vec<Vec<f64>> = serde_json::from_value(samples.clone()).ok()?;
    let (mut sum, mut spreads) = (0.0, Vec::new());
    let frames = passes.first()?.len();
    for frame in 0..frames {
        let of_frame: Vec<f64> = passes.iter().map(|pass| pass[frame] / 1e6).collect();
        let middle = median(of_frame.clone());
        sum += middle;
        spreads.push(median(of_frame.iter().map(|ms| (ms - middle).abs()).collect()) / middle);
    }
    // A single pass has no spread: five percent are assumed
    Some((sum / frames as f64, if passes.len() > 1 { median(spreads) } else { 0.05 }))
}

fn read(text: &str) -> Journal {
    let records: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let mut journal = Journal { times: BTreeMap::new(), errors: Vec::new(), fastest_simd: BTreeMap::new() };
    // The terms of most rows; of equals, the largest image
    let terms = |row: &Value| ["resolution", "trips", "frames"].map(|axis| row["key"]["axes"][axis].to_string());
    let of_paper = |row: &&Value| {
        let axes = &row["key"]["axes"];
        SCENES.iter().any(|scene| axes["scene"] == *scene) && row["record"] == "row"
    };
    let timed = |row: &&Value| row["status"] == "ok" && row["key"]["axes"]["precision"] == "f32";
    let mut numbers: BTreeMap<[String; 3], usize> = BTreeMap::new();
    records.iter().filter(of_paper).filter(timed).for_each(|row| *numbers.entry(terms(row)).or_default() += 1);
    let chosen = numbers.into_iter().max_by_key(|(_, number)| *number).unwrap().0;
    for row in records.iter().filter(of_paper) {
        let axis = |name: &str| row["key"]["axes"][name].as_str().unwrap_or_default();
        let scene = axis("scene").to_owned();
        if axis("precision") == "f16" {
            journal.errors.extend(metric(row, "rmse"));
            continue;
        }
        if row["status"] != "ok" || terms(row) != chosen {
            continue;
        }
        let Some((ms, noise)) = time(row) else { continue };
        let lanes: f64 = axis("lanes").parse().unwrap_or(1.0);
        let threads = metric(row, "processor_threads").unwrap_or(0.0);
        let processors = match axis("renderer") {
            "gpu" => 0.0,
            "sequential" => 1.0,
            "simd" => lanes,
            "threads" => threads,
            _ => threads * lanes,
        };
        let time = Time { ms, noise, processors };
        if axis("renderer") == "simd" {
            let best = journal.fastest_simd.entry(scene.clone()).or_insert((time, lanes));
            if ms < best.0.ms {
                *best = (time, lanes);
            }
        }
        let is_structure = ["", "4"].contains(&axis("lanes")) && axis("hit") != "index";
        if is_structure && axis("level").is_empty() && axis("threads").is_empty() {
            let on = |name: &str| if axis(name) == "on" { "+" } else { "-" };
            let switches = ["exit_on_miss", "skip_no_hit", "skip_no_discriminant"].map(on).concat();
            let setting = format!("{} {}{switches}", axis("renderer"), axis("algorithm"));
            journal.times.insert((scene, setting), time);
        }
    }
    journal
}

const FIRST: &str = "two-pass---";
const ONE: &str = "one-pass+--";
const LAST: &str = "one-pass+++";

impl Journal {
    /// A renderer's time; switches that it does not have are off.
    fn at(&self, scene: &str, renderer: &str, version: &str) -> Option<Time> {
        let version = if renderer.starts_with("simd") { version.to_owned() } else { version.replace("+++", "+--") };
        self.times.get(&(scene.to_owned(), format!("{renderer} {version}"))).copied()
    }
}

/// Is `a` less than `b / factor`? 1, -1, or 0 within noise and a margin of a tenth.
fn less(a: Time, b: Time, factor: f64) -> i32 {
    let (quotient, margin) = (b.ms / a.ms / factor, 1.1 + a.noise + b.noise);
    if quotient > margin {
        1
    } else if quotient * margin < 1.0 {
        -1
    } else {
        0
    }
}

fn over(a: Time, b: Time) -> Time {
    Time { ms: a.ms / b.ms, noise: a.noise + b.noise, processors: a.processors }
}

fn all(outcomes: &[i32]) -> i32 {
    if outcomes.contains(&-1) { -1 } else { i32::from(!outcomes.contains(&0)) }
}

fn karp_flatt(share: f64, processors: f64) -> f64 {
    (share - 1.0 / processors) / (1.0 - 1.0 / processors)
}

/// Is the metric of `a` below that of `b`, with both shares changed by noise and margin together?
fn less_serial(a: Time, b: Time) -> i32 {
    let doubt = (1.1 + a.noise + b.noise).sqrt();
    let e = |time: Time, factor: f64| karp_flatt(time.ms * factor, time.processors);
    if e(a, doubt) < e(b, 1.0 / doubt) {
        1
    } else if e(a, 1.0 / doubt) > e(b, doubt) {
        -1
    } else {
        0
    }
}

/// The outcomes of a claim's cases on all scenes, where `gpu` processors are said of the GPU.
fn outcomes(journal: &Journal, claim: &str, gpu: Option<f64>) -> Vec<i32> {
    let nothing = Time { ms: 1.0, noise: 0.0, processors: 0.0 };
    let mut found: Vec<Option<i32>> = Vec::new();
    for scene in SCENES {
        let at = |renderer: &str, version: &str| journal.at(scene, renderer, version);
        let simd_slow = |version| Some(less(at("sequential", version)?, at("simd", version)?, 1.0));
        let share = |renderer: &str, version: &str| Some(over(at(renderer, version)?, at("sequential", version)?));
        match claim {
            "1" => found.push(simd_slow(FIRST)),
            "6" => found.push(simd_slow(ONE)),
            "8" => found.push(simd_slow(LAST).map(|outcome| -outcome)),
            "2" => found.push((|| {
                let threads = at("threads", FIRST)?;
                (threads.processors > 1.0).then_some(())?;
                Some(less(threads, at("sequential", FIRST)?, threads.processors / 2.0))
            })()),
            "3" => {
                let gain = |renderer: &str| Some(over(at(renderer, FIRST)?, at(renderer, ONE)?));
                for (renderer, _) in RENDERERS {
                    found.push((|| Some(less(at(renderer, ONE)?, at(renderer, FIRST)?, 1.0)))());
                }
                let others: Vec<Time> = ["sequential", "threads", "gpu"].into_iter().filter_map(gain).collect();
                let simd = gain("simd").or_else(|| gain("simd-threads"));
                let most = |simd: Time| all(&others.iter().map(|other| less(*other, simd, 1.0)).collect::<Vec<_>>());
                found.push(simd.filter(|_| !others.is_empty()).map(most));
            }
            "4" => {
                for (renderer, _) in &RENDERERS[..4] {
                    found.push((|| {
                        let [a, d] = [FIRST, "two-pass+--"].map(|version| at(renderer, version));
                        let [c, b] = ["one-pass---", ONE].map(|version| at(renderer, version));
                        let (a, b, c, d) = (a?, b?, c?, d?);
                        let parts = [less(over(d, b), over(a, d), 1.0), less(over(a, c), over(c, b), 1.0)];
                        Some(if less(b, a, 1.0) == 1 { all(&parts) } else { 0 })
                    })());
                }
            }
            "5" => {
                for (from, to) in [(FIRST, "one-pass---"), ("two-pass+--", ONE)] {
                    let gain = |renderer: &str| Some(over(at(renderer, from)?, at(renderer, to)?));
                    found.push((|| {
                        let (simd, sequential) = (gain("simd")?, gain("sequential")?);
                        Some(all(&[less(nothing, simd, 1.0), less(sequential, simd, 1.0)]))
                    })());
                }
            }
            "7" => {
                for renderer in ["simd", "simd-threads"] {
                    found.push((|| Some(less(at(renderer, LAST)?, at(renderer, ONE)?, 1.0)))());
                }
            }
            "11" => {
                for version in [FIRST, ONE, LAST] {
                    let others = RENDERERS[..4].iter().filter_map(|(renderer, _)| at(renderer, version));
                    let others: Vec<Time> = others.collect();
                    let gpu = at("gpu", version).filter(|_| at("sequential", version).is_some());
                    found.push(gpu.map(|g| all(&others.iter().map(|o| less(g, *o, 1.0)).collect::<Vec<_>>())));
                    if scene == "random100" && version == LAST {
                        found.push(gpu.and_then(|g| Some(less(g, at("sequential", version)?, 500.0))));
                    }
                }
            }
            "12" => {
                for version in [FIRST, LAST] {
                    found.push((|| {
                        let own = Time { processors: gpu?, ..share("gpu", version)? };
                        Some(less_serial(own, share("simd-threads", version)?))
                    })());
                }
                found.push((|| Some(less_serial(share("simd-threads", LAST)?, share("simd-threads", FIRST)?)))());
            }
            "13" => {
                let own = at("simd", LAST);
                let below = |time: Time, lanes: f64| Some(less(at("sequential", LAST)?, time, 2.0 / lanes));
                found.push(own.and_then(|own| below(own, 4.0)));
                let best = journal.fastest_simd.get(scene).filter(|best| own.is_some_and(|own| own.ms != best.0.ms));
                found.push(best.and_then(|(time, lanes)| below(*time, *lanes)));
            }
            _ => {}
        }
    }
    if claim == "9" {
        let gain = |scene: &&str| Some((journal.at(scene, "simd", FIRST)?, journal.at(scene, "simd", LAST)?));
        let gains: Option<Vec<(Time, Time)>> = SCENES.iter().map(gain).collect();
        let most =
            gains.and_then(|gains| gains.into_iter().max_by(|a, b| (a.0.ms / a.1.ms).total_cmp(&(b.0.ms / b.1.ms))));
        found.push(most.map(|(first, last)| less(last, first, 15.0)));
    }
    if claim == "10b" {
        let limit = Time { ms: 10f64.powf(-1.5), ..nothing };
        found.extend(journal.errors.iter().map(|rmse| Some(less(limit, Time { ms: *rmse, ..nothing }, 1.0))));
    }
    found.into_iter().flatten().collect()
}

fn verdict(outcomes: &[i32]) -> Verdict {
    match outcomes {
        [] => Verdict::NotMeasured,
        some if some.contains(&-1) => Verdict::DoesNotHold,
        some if some.contains(&1) => Verdict::Holds,
        _ => Verdict::Undecided,
    }
}

/// The number in a cell of a row by its keys.
fn number(table: &Table, keys: &[&str], column: usize) -> Option<f64> {
    match table.rows.iter().find(|row| row.keys.iter().zip(keys).all(|(a, b)| a == b))?.cells[column] {
        Cell::Number { value, .. } => value.map(|v| v.value),
        _ => None,
    }
}

fn is_same(shown: Option<f64>, expected: Option<f64>) -> bool {
    match (shown, expected) {
        (Some(a), Some(b)) => (a - b).abs() <= 1e-5 * b.abs().max(1e-3),
        (None, None) => true,
        _ => false,
    }
}

/// Holds tables and claims against the text of a journal; the number of numbers and verdicts that are there.
fn check(tables: &[Table], findings: &[Finding], text: &str, gpu: Option<f64>) -> Result<usize, String> {
    let journal = read(text);
    let titled = |id: &str| tables.iter().find(|table| table.id == id).unwrap();
    let mut numbers = 0;
    let mut compare = |what: &str, shown: Option<f64>, expected: Option<f64>| {
        numbers += usize::from(shown.is_some());
        if is_same(shown, expected) { Ok(()) } else { Err(format!("{what}: {shown:?} instead of {expected:?}")) }
    };
    for scene in SCENES {
        let columns: [(&str, &str, &[usize]); 4] = [
            ("1", FIRST, &[0, 1, 4]),
            ("2", FIRST, &[0, 1, 2, 3]),
            ("3", ONE, &[0, 1, 2, 3, 4]),
            ("4", LAST, &[0, 1, 2, 3, 4]),
        ];
        for (id, version, renderers) in columns {
            for (column, renderer) in renderers.iter().enumerate() {
                let expected = journal.at(scene, RENDERERS[*renderer].0, version).map(|time| time.ms);
                compare(&format!("table {id}, {scene}"), number(titled(id), &[scene], column), expected)?;
            }
        }
        for (title, version) in [("two-pass", FIRST), ("one-pass", ONE), ("one-pass + exits", LAST)] {
            for (renderer, name) in RENDERERS {
                if version == LAST && ["sequential", "threads"].contains(&renderer) {
                    continue;
                }
                let own = journal.at(scene, renderer, version);
                let share = own.zip(journal.at(scene, "sequential", version)).map(|(own, first)| own.ms / first.ms);
                let p = own.and_then(|own| if renderer == "gpu" { gpu } else { Some(own.processors) });
                let e = share.zip(p).filter(|(_, p)| *p > 1.0).map(|(share, p)| karp_flatt(share, p));
                let keys = [scene, title, name];
                for (column, expected) in [(0, p), (2, share.map(|share| 1.0 / share)), (3, e)] {
                    let shown = number(titled("metrics"), &keys, column);
                    compare(&format!("metrics, {keys:?}, column {column}"), shown, expected)?;
                }
            }
        }
    }
    for finding in findings.iter().filter(|finding| finding.claim != "10a") {
        let own = outcomes(&journal, finding.claim, gpu);
        let sign = |outcome: Outcome| match outcome {
            Outcome::Agrees => 1,
            Outcome::Contradicts => -1,
            Outcome::Undecided => 0,
        };
        let (mut shown, mut expected) =
            (finding.cases.iter().map(|c| sign(c.outcome)).collect::<Vec<_>>(), own.clone());
        shown.sort_unstable();
        expected.sort_unstable();
        if shown != expected || finding.verdict != verdict(&own) {
            return Err(format!("claim {}: {:?} {:?} instead of {expected:?}", finding.claim, finding.verdict, shown));
        }
        numbers += 1;
    }
    Ok(numbers)
}

/// Tables and claims of a run in a folder, and the text of its journal.
fn shown(folder: &Path, processors: Option<u32>) -> (Vec<Table>, Vec<Finding>, String) {
    let run = RecordedRun::read(folder).unwrap();
    let results = (SOURCE.read)(&[run]);
    let options = Options { published: true, processors, ..Options::default() };
    let journal = std::fs::read_to_string(folder.join(FILE_NAME)).unwrap();
    (results.tables(SOURCE.tables, &options), results.claims(&options), journal)
}

#[test]
fn tables_and_verdicts_of_a_run_are_what_its_journal_says() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    write_run(&everything(), &run);
    for processors in [None, Some(1024)] {
        let (tables, findings, journal) = shown(&run, processors);
        let gpu = processors.map(f64::from);
        assert!(check(&tables, &findings, &journal, gpu).unwrap() > 150);
        // Seen to fail: a time, a number of threads, an error, and another number of processors
        for (old, new) in [
            ("166680000,203720000", "166680000,303720000"),
            ("\"processor_threads\",\"value\":8", "\"processor_threads\",\"value\":7"),
            ("\"rmse\",\"value\":0.05", "\"rmse\",\"value\":0.005"),
        ] {
            assert!(journal.contains(old), "{old} is not in the journal");
            let other = journal.replace(old, new);
            assert!(check(&tables, &findings, &other, gpu).is_err(), "{old} -> {new} is not found");
        }
        assert!(check(&tables, &findings, &journal, Some(16.0)).is_err());
    }
}

/// Folders of runs of the preset `spheres-lite` that are kept in git.
fn committed() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let ignore = std::fs::read_to_string(root.join(".gitignore")).unwrap();
    let names = ignore.lines().filter_map(|line| line.strip_prefix("!/results/"));
    names.filter(|name| name.starts_with("spheres-lite-")).map(|name| root.join("results").join(name)).collect()
}

#[test]
fn tables_and_verdicts_of_the_committed_run_are_what_its_journal_says() {
    let runs = committed();
    if runs.is_empty() {
        eprintln!("NOT RUN: results/ keeps no run spheres-lite-*");
    }
    for folder in runs {
        let (tables, findings, journal) = shown(&folder, None);
        let numbers = check(&tables, &findings, &journal, None).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
        assert!(numbers > 100, "{}: {numbers}", folder.display());
    }
}
