//! Plans that are divided among machines, runs that are merged, and runs that are killed and resumed.

use crate::support::{csv_rows, random};
use rtbench::harness::shard;
use rtbench::harness::workload::Case;
use rtbench::record::journal::{FILE_NAME, Journal};
use rtbench::record::row::Status;
use rtbench::record::run::Shard;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

const PROGRAM: &str = env!("CARGO_BIN_EXE_rtbench");

/// A plan of 24 rows in 8 turns that takes about a second.
const PLAN: &str = "--backend cpu --scene scan:triangles=1000 --scene mesh.obj --structure grid,bvh-stack,kdtree \
                    --config P,PS --resolution 16,24 --frames 2 --passes 2";

const MESH: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nf 1 2 3\nf 1 3 4\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("mesh.obj"), MESH).unwrap();
    folder
}

fn command(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(PROGRAM);
    command.current_dir(folder).args(arguments.split_whitespace()).env_remove("RTBENCH_SCENES");
    command
}

fn run(folder: &Path, arguments: &str) -> Output {
    command(folder, arguments).output().unwrap()
}

#[track_caller]
fn ends_with(output: &Output, code: i32) -> String {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(code) && !text.contains("panicked"), "{:?} {text}", output.status);
    text
}

#[track_caller]
fn refused(output: &Output, words: &[&str]) {
    let text = ends_with(output, 2);
    let errors: Vec<&str> = text.lines().filter(|line| line.starts_with("rtbench: error: ")).collect();
    assert_eq!(errors.len(), 1, "{text}");
    words.iter().for_each(|word| assert!(errors[0].contains(word), "{word}: {text}"));
}

/// Columns of `summary.csv` that depend on the moment.
const VARYING: [&str; 12] = [
    "frame_ms_min",
    "frame_ms_max",
    "frame_ms_mean",
    "frame_ms_p95",
    "noise_pct",
    "wall_ms_mean",
    "device_ms_mean",
    "pass_overhead",
    "mrays_per_s",
    "build_ms",
    "warnings",
    "interleaved_with",
];

/// The exact columns of a run's rows, in an order of their own.
fn exact(run: &Path) -> BTreeSet<BTreeMap<String, String>> {
    let mut rows = csv_rows(&run.join("summary.csv"));
    rows.iter_mut().for_each(|row| row.retain(|column, _| !VARYING.contains(&column.as_str())));
    let all = rows.len();
    let set: BTreeSet<_> = rows.into_iter().collect();
    assert_eq!(set.len(), all, "a row is there twice");
    set
}

#[test]
fn a_shard_is_one_of_so_many() {
    assert_eq!("2/4".parse::<Shard>().unwrap(), Shard { index: 2, count: 4 });
    let folder = folder();
    for wrong in ["0/4", "5/4", "1/0", "0/0", "-1/4", "1", "1/", "/4", "a/b", "1/4/2", "1/100001", "1.5/4"] {
        assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        refused(&run(folder.path(), &format!("sweep {PLAN} --shard={wrong} --out run")), &["--shard"]);
        assert!(!folder.path().join("run").exists());
    }
    let many = run(folder.path(), &format!("sweep {PLAN} --shard 9/9 --out run"));
    refused(&many, &["shard 9 of 9 is empty", "at most 8"]);
}

/// Every case is in one shard, turns are whole, and no shard has more than the largest turn above another.
#[test]
fn plans_are_divided_evenly() {
    let mut number = random(7);
    for count in 1..9 {
        let cases: Vec<Case> = (0..60)
            .map(|index| Case {
                axes: [("n".to_owned(), index.to_string())].into(),
                input: format!("input {}", index % 4),
                group: format!("group {}", index % 3),
                turn: format!("turn {}", index / 3),
                device: 0,
                work: 1 + ((number() + 1.0) * 1000.0) as u64,
            })
            .collect();
        let shards = shard::assign(&cases, count);
        assert_eq!(shards, shard::assign(&cases, count));
        let mut turns = BTreeMap::new();
        let mut work = vec![0; count];
        for (case, shard) in cases.iter().zip(&shards) {
            assert!((1..=count).contains(shard));
            assert_eq!(turns.entry((&case.input, &case.turn)).or_insert((shard, 0)).0, shard);
            turns.get_mut(&(&case.input, &case.turn)).unwrap().1 += case.work;
            work[shard - 1] += case.work;
        }
        let largest = turns.values().map(|(_, work)| *work).max().unwrap();
        assert!(work.iter().max().unwrap() - work.iter().min().unwrap() <= largest, "{work:?}");
        let all: usize = (1..=count).map(|index| shard::select(&cases, Shard { index, count }).unwrap().len()).sum();
        assert_eq!(all, cases.len());
    }
}

#[test]
fn a_merged_run_is_the_whole_run() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    ends_with(&run(folder.path(), &format!("sweep {PLAN} --out whole")), 0);
    let plan = String::from_utf8(run(folder.path(), &format!("plan sweep {PLAN}")).stdout).unwrap();
    let mut planned = Vec::new();
    for index in 1..=3 {
        ends_with(&run(folder.path(), &format!("sweep {PLAN} --shard {index}/3 --out part{index}")), 0);
        let output = run(folder.path(), &format!("plan sweep {PLAN} --shard {index}/3 --like whole"));
        let text = ends_with(&output, 0);
        assert!(text.contains("shard 3/3: ") && text.contains(" like on ") && text.contains("MiB"), "{text}");
        let lines = String::from_utf8(output.stdout).unwrap();
        let own = Journal::read(&at(&format!("part{index}/{FILE_NAME}"))).unwrap();
        assert_eq!(own.rows.len(), lines.lines().count() - 1);
        planned.extend(lines.lines().skip(1).map(|line| line.strip_suffix(&format!(",{index}/3")).unwrap().to_owned()));
    }
    let whole: BTreeSet<&str> = plan.lines().skip(1).collect();
    assert_eq!(planned.iter().map(String::as_str).collect::<BTreeSet<_>>(), whole);
    // The order of the arguments does not matter
    ends_with(&run(folder.path(), "merge part3 part1 part2 --out merged"), 0);
    assert_eq!(exact(&at("merged")), exact(&at("whole")));
    assert_eq!(csv_rows(&at("merged/structures.csv")).len(), csv_rows(&at("whole/structures.csv")).len());
    assert_eq!(std::fs::read_dir(at("merged/pictures")).unwrap().count(), 4);
    let journal = Journal::read(&at("merged").join(FILE_NAME)).unwrap();
    assert!(journal.end.as_ref().unwrap().complete && journal.provenance.merged.len() == 3);
    assert_eq!(journal.provenance.devices.len(), 1, "one machine");
    ends_with(&run(folder.path(), "merge part1 part2 part3 --out again"), 0);
    assert_eq!(exact(&at("again")), exact(&at("merged")));
    // Readers take it, and there is nothing to resume
    ends_with(&run(folder.path(), "tables merged"), 0);
    assert!(ends_with(&run(folder.path(), "sweep --resume merged"), 0).contains("nothing is left"));

    // Gaps and duplicates; what is missing is measured by resuming
    let text = ends_with(&run(folder.path(), "merge part1 part3 part3 --out gaps"), 1);
    assert!(text.contains("no run is shard 2/3") && text.contains("in several runs") && text.contains("--resume gaps"));
    let resumed = ends_with(&run(folder.path(), "sweep --resume gaps"), 0);
    assert!(resumed.contains("of 24 rows are there already"), "{resumed}");
    assert_eq!(exact(&at("gaps")), exact(&at("whole")));
    // A run that was merged may be merged again
    ends_with(&run(folder.path(), "merge part1 part2 --out two"), 1);
    ends_with(&run(folder.path(), "merge two part3 --out three"), 0);
    assert_eq!(exact(&at("three")), exact(&at("whole")));
    refused(&run(folder.path(), "merge part1 part2 --out three"), &["three is not empty"]);
}

#[test]
fn what_does_not_belong_together_is_not_merged() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let measure =
        |more: &str, out: &str| ends_with(&run(folder.path(), &format!("sweep {PLAN} {more} --out {out}")), 0);
    measure("--shard 1/2", "part1");
    measure("--shard 2/2", "part2");
    let journal = std::fs::read_to_string(at("part2").join(FILE_NAME)).unwrap();
    let merge = |words: &[&str]| {
        refused(&run(folder.path(), "merge part1 part2 other --out merged"), words);
        assert!(!at("merged").exists());
    };
    let edited = |from: &str, to: &str, words: &[&str]| {
        let _ = std::fs::remove_dir_all(at("other"));
        std::fs::create_dir(at("other")).unwrap();
        let text = journal.replacen(from, to, 1);
        assert_ne!(text, journal, "{from}");
        std::fs::write(at("other").join(FILE_NAME), text).unwrap();
        merge(words);
    };
    edited("\"workload\":\"sweep\"", "\"workload\":\"spheres\"", &["it is a run of `spheres`, not of `sweep`"]);
    edited("\"version\":\"", "\"version\":\"9.", &["another program measured it"]);
    edited("\"passes\":2", "\"passes\":3", &["passes, warm-up"]);
    edited("\"count\":2", "\"count\":3", &["another number of shards"]);
    edited("\"hash\":\"", "\"hash\":\"0", &["a part of another plan"]);
    std::fs::remove_dir_all(at("other")).unwrap();
    measure("--shard 1/2 --warmup 3", "other");
    merge(&["passes, warm-up", "part"]);
    std::fs::remove_dir_all(at("other")).unwrap();
    std::fs::write(at("mesh.obj"), MESH.replace("0.5", "0.25")).unwrap();
    measure("", "other");
    merge(&["scene mesh.obj is another one than in the other runs"]);
    std::fs::remove_dir_all(at("other")).unwrap();
    merge(&["other", "cannot read"]);
    std::fs::create_dir(at("other")).unwrap();
    std::fs::write(at("other").join(FILE_NAME), "").unwrap();
    merge(&["empty"]);
    // A scene that is missing on one machine
    let missing = "sweep --backend cpu --preset thesis-lite --shard 1/2 --out missing";
    refused(&run(folder.path(), missing), &["every machine", "bring it to this machine"]);
    // A run that is being written
    std::fs::write(at("other").join(FILE_NAME), &journal).unwrap();
    let file = std::fs::OpenOptions::new().append(true).open(at("other").join(FILE_NAME)).unwrap();
    file.lock().unwrap();
    merge(&["another process is writing this run"]);
}

/// A row with another result in one of two runs.
#[test]
fn two_results_of_one_row_are_not_merged() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let small = "--backend cpu --scene mesh.obj --structure grid --config P --resolution 16 --frames 1 --passes 1";
    ends_with(&run(folder.path(), &format!("sweep {small} --out a")), 0);
    let text = std::fs::read_to_string(at("a").join(FILE_NAME)).unwrap();
    let row = text.find("\"record\":\"row\"").unwrap();
    let tests = row + text[row..].find("\"name\":\"tests\"").unwrap();
    let value = tests + text[tests..].find("\"value\":").unwrap() + "\"value\":".len();
    std::fs::create_dir(at("b")).unwrap();
    std::fs::write(at("b").join(FILE_NAME), format!("{}9{}", &text[..value], &text[value..])).unwrap();
    refused(&run(folder.path(), "merge a b --out merged"), &["b/journal.jsonl", "tests is ", "but "]);
    std::fs::write(at("b").join(FILE_NAME), &text).unwrap();
    ends_with(&run(folder.path(), "merge a b --out merged"), 0);
}

/// A real sweep, killed at twenty random moments and resumed, has every row once, and equals an undisturbed one.
#[test]
fn a_sweep_survives_twenty_kills() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    ends_with(&run(folder.path(), &format!("sweep {PLAN} --out whole")), 0);
    let mut number = random(11);
    let (mut kills, mut completed) = (0, 0);
    for attempt in 0..200 {
        if kills >= 20 && completed > 0 {
            break;
        }
        let begun = at("run").join(FILE_NAME).is_file();
        if begun
            && Journal::read(&at("run").join(FILE_NAME)).is_ok_and(|journal| journal.end.is_some_and(|e| e.complete))
        {
            // It may have been killed before the files were written that are derived from the journal
            ends_with(&run(folder.path(), "sweep --resume run"), 0);
            assert_eq!(exact(&at("run")), exact(&at("whole")));
            completed += 1;
            std::fs::remove_dir_all(at("run")).unwrap();
            continue;
        }
        let _ = (!begun).then(|| std::fs::remove_dir_all(at("run")));
        let arguments = if begun { "sweep --resume run".into() } else { format!("sweep {PLAN} --out run") };
        let mut command = command(folder.path(), &arguments);
        let mut sweep = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis((20.0 + (number() + 1.0) * 200.0) as u64));
        if sweep.try_wait().unwrap().is_none() {
            sweep.kill().unwrap();
            kills += 1;
        }
        sweep.wait().unwrap();
        assert!(attempt < 199, "{kills} kills, {completed} completed");
    }
    if at("run").join(FILE_NAME).is_file() {
        ends_with(&run(folder.path(), "sweep --resume run"), 0);
        assert_eq!(exact(&at("run")), exact(&at("whole")));
        let rows = Journal::read(&at("run").join(FILE_NAME)).unwrap().rows;
        assert!(rows.len() == 24 && rows.iter().all(|row| row.status == Status::Ok));
    }
}
