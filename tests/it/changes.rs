//! compare, gate, bless and ab as a user runs them, on real small runs of the CPU twins.

mod review;

use rtbench::compare::baseline::Baseline;
use rtbench::compare::bless::KernelCosts;
use rtbench::compare::conditions::ComparedRun;
use rtbench::compare::{bless, gate};
use rtbench::record::stream::{LeanRun, Names};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const PROGRAM: &str = env!("CARGO_BIN_EXE_rtbench");

const FLAGS: [&str; 12] = [
    "--backend",
    "cpu",
    "--scene",
    "scan:triangles=1000",
    "--frames",
    "2",
    "--passes",
    "2",
    "--resolution",
    "16",
    "--config",
    "P,PS",
];

fn rtbench<I: AsRef<std::ffi::OsStr>>(arguments: impl IntoIterator<Item = I>) -> Output {
    Command::new(PROGRAM).args(arguments).env_remove("RTBENCH_SCENES").output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A folder with a real run and its baseline.
struct Gated {
    folder: tempfile::TempDir,
    run: PathBuf,
    baseline: PathBuf,
}

impl Gated {
    fn new() -> Gated {
        let folder = tempfile::tempdir().unwrap();
        let (run, baseline) = (folder.path().join("run"), folder.path().join("base.json"));
        let mut arguments: Vec<String> =
            vec!["sweep".into(), "--quiet".into(), "--out".into(), run.display().to_string()];
        arguments.extend(FLAGS.map(str::to_owned));
        arguments.extend(["--structure", "kdtree,bvh"].map(str::to_owned));
        let output = rtbench(arguments);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let gated = Gated { folder, run, baseline };
        gated.bless(0);
        gated
    }

    fn bless(&self, code: i32) -> String {
        let output =
            rtbench(["bless".as_ref(), self.run.as_os_str(), "--baseline".as_ref(), self.baseline.as_os_str()]);
        assert_eq!(output.status.code(), Some(code), "{}", text(&output.stderr));
        text(&output.stderr)
    }

    fn gate_with(&self, code: i32, flags: &[&str]) -> String {
        let own = ["gate".as_ref(), self.run.as_os_str(), "--baseline".as_ref(), self.baseline.as_os_str()];
        let output = rtbench(own.into_iter().chain(flags.iter().map(|flag| flag.as_ref())));
        let all = text(&output.stdout) + &text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{all}");
        assert!(!all.contains("panicked"), "{all}");
        if code == 2 {
            assert_eq!(all.matches("rtbench: error: ").count(), 1, "{all}");
        }
        all
    }

    fn gate(&self, code: i32) -> String {
        self.gate_with(code, &[])
    }

    /// Edits the records of the journal; `edit` returns false for a record to leave out.
    fn edit(&self, mut edit: impl FnMut(&mut Value) -> bool) {
        let journal = self.run.join("journal.jsonl");
        let mut edited = String::new();
        for line in std::fs::read_to_string(&journal).unwrap().lines() {
            let mut record: Value = serde_json::from_str(line).unwrap();
            if edit(&mut record) {
                edited += &format!("{record}\n");
            }
        }
        std::fs::write(journal, edited).unwrap();
    }

    /// Edits the first row of a structure.
    fn edit_row(&self, structure: &str, edit: impl FnOnce(&mut Value)) {
        let mut edit = Some(edit);
        self.edit(|record| {
            if record["record"] == "row"
                && record["key"]["axes"]["structure"] == structure
                && let Some(edit) = edit.take()
            {
                edit(record);
            }
            true
        });
        assert!(edit.is_none(), "there is no row of {structure}");
    }

    fn edit_baseline(&self, from: &str, to: &str) {
        let text = std::fs::read_to_string(&self.baseline).unwrap();
        assert!(text.contains(from), "{from}");
        std::fs::write(&self.baseline, text.replacen(from, to, 1)).unwrap();
    }
}

/// Adds one to a metric; its old and new value.
fn add_one(metrics: &mut Value, of: Option<&str>, name: &str) -> (u64, u64) {
    let is = |metric: &&mut Value| metric["name"] == name && metric.get("of").and_then(Value::as_str) == of;
    let metric = metrics.as_array_mut().unwrap().iter_mut().find(is).unwrap();
    let old = metric["value"].as_u64().unwrap();
    metric["value"] = json!(old + 1);
    (old, old + 1)
}

#[test]
fn an_unchanged_run_is_green_and_four_planted_changes_are_red() {
    let gated = Gated::new();
    let green = gated.gate_with(0, &["--strict"]);
    assert!(green.contains("gate: green: 0 differences") && green.contains("4 of 4 rows compared"), "{green}");
    let original = std::fs::read(gated.run.join("journal.jsonl")).unwrap();
    let restore = || std::fs::write(gated.run.join("journal.jsonl"), &original).unwrap();
    let row = "config=P; frames=2; resolution=16x16; scene=scan:triangles=1000; structure=kdtree: ";

    // A traversal visits one node too many
    let mut values = (0, 0);
    gated.edit_row("kdtree", |row| values = add_one(&mut row["metrics"], Some("primary"), "inner"));
    let red = gated.gate(1);
    assert!(red.contains(&format!("{row}primary.inner: {} -> {}", values.0, values.1)), "{red}");
    assert!(
        red.contains("gate: red: 1 differences") && red.contains("if the differences are intended: rtbench bless"),
        "{red}"
    );
    restore();

    // A picture is off by one triangle
    let other = "0123456789abcdef".repeat(4);
    let mut before = String::new();
    gated.edit_row("kdtree", |row| {
        before = row["outputs"]["image"].as_str().unwrap()[..16].to_owned();
        row["outputs"]["image"] = json!(other);
    });
    let red = gated.gate(1);
    assert!(red.contains(&format!("{row}image hash: {before} -> 0123456789abcdef")), "{red}");
    restore();

    // A builder makes one node more
    gated.edit(|record| {
        if record["record"] == "artifact" && record["key"]["axes"]["structure"] == "bvh" {
            values = add_one(&mut record["metrics"], None, "nodes");
        }
        true
    });
    let red = gated.gate(1);
    let artifact = format!("scene=scan:triangles=1000; structure=bvh: nodes: {} -> {}", values.0, values.1);
    assert!(red.contains(&artifact), "{red}");
    for (format, wanted) in
        [("markdown", "| red | scene=scan:triangles=1000; structure=bvh | nodes |"), ("json", "\"green\": false")]
    {
        let red = gated.gate_with(1, &["--format", format]);
        assert!(red.contains(wanted), "{red}");
    }
    restore();

    // A kernel reads one buffer twice
    let mut names = Names::default();
    let run = ComparedRun::new(LeanRun::read(&gated.run, &mut names).unwrap());
    let costs = |loads: u64| -> KernelCosts {
        [("trace/render bvh".to_owned(), [("load".to_owned(), loads), ("store".to_owned(), 2)].into())].into()
    };
    let baseline = bless::bless(&names, &run, &costs(17), &[], None).unwrap();
    let read_back = Baseline::parse(Path::new("base.json"), &baseline.write()).unwrap();
    assert_eq!(read_back, baseline);
    let judged =
        |loads: u64| gate::judge(&names, &run, &costs(loads), &[], &read_back, Path::new("base.json")).unwrap();
    assert!(judged(17).is_green());
    let red = gate::text(&judged(18));
    assert!(red.contains("red: kernel trace/render bvh: load: 17 -> 18 (+1"), "{red}");
    let gone = gate::judge(&names, &run, &KernelCosts::new(), &[], &read_back, Path::new("base.json")).unwrap();
    assert!(gate::text(&gone).contains("kernel trace/render bvh: status: there -> gone"));

    // A sample of reruns: measured again, the same program is green
    let mut arguments: Vec<String> = ["gate", "--run", "quick", "--strict", "--baseline"].map(str::to_owned).into();
    arguments.push(gated.baseline.display().to_string());
    arguments.push("--".into());
    arguments.extend(FLAGS.map(str::to_owned));
    arguments.extend(["--structure", "kdtree,bvh"].map(str::to_owned));
    for _ in 0..2 {
        let output = rtbench(&arguments);
        assert_eq!(output.status.code(), Some(0), "{}{}", text(&output.stdout), text(&output.stderr));
    }
}

#[test]
fn rows_that_are_missing_new_or_without_a_result() {
    let gated = Gated::new();
    let original = std::fs::read(gated.run.join("journal.jsonl")).unwrap();
    let restore = || std::fs::write(gated.run.join("journal.jsonl"), &original).unwrap();
    // A row vanished
    let mut rows = 0;
    gated.edit(|record| {
        rows += usize::from(record["record"] == "row");
        record["record"] != "row" || rows > 1
    });
    assert!(gated.gate(1).contains(": status: ok -> no row"));
    restore();
    // A row failed to verify
    gated.edit_row("bvh", |row| (row["status"], row["message"]) = (json!("wrong"), json!("3 pixels differ")));
    assert!(gated.gate(1).contains("structure=bvh: status: ok -> wrong: 3 pixels differ"));
    let before = std::fs::read(&gated.baseline).unwrap();
    assert!(gated.bless(2).contains("is wrong: 3 pixels differ"));
    assert_eq!(std::fs::read(&gated.baseline).unwrap(), before);
    restore();
    // A row without a baseline passes and is announced
    gated.edit_row("bvh", |row| row["key"]["axes"]["config"] = json!("PSR"));
    let new = gated.gate(1);
    assert!(new.contains("rows without a baseline, which pass: 1 such as"), "{new}");
    restore();
    // With all rows new, nothing is judged
    gated.edit(|record| {
        if record["record"] == "row" {
            record["key"]["axes"]["config"] = json!("PSR");
        }
        true
    });
    let nothing = gated.gate(2);
    assert!(nothing.contains("only 0 of 4 rows") && nothing.contains("rtbench bless"), "{nothing}");
    restore();
    // Fewer than the baseline's share
    gated.edit_baseline("\"min_compared_share\": 0.5", "\"min_compared_share\": 0.9");
    gated.edit(|record| {
        if record["record"] == "row" && record["key"]["axes"]["structure"] == "bvh" {
            record["key"]["axes"]["structure"] = json!("brand-new");
        }
        true
    });
    assert!(gated.gate(2).contains("only 2 of 4 rows"));
}

#[test]
fn budgets_are_a_persons_and_times_are_judged_only_with_one() {
    let gated = Gated::new();
    gated.edit_row("kdtree", |row| {
        add_one(&mut row["metrics"], Some("primary"), "tests");
    });
    gated.gate(1);
    gated.edit_baseline(
        "\"budgets\": {}",
        "\"budgets\": {\n    \"primary.tests\": {\"absolute\": 1},\n    \"frame_ms\": {\"share\": 0.5}\n  }",
    );
    let within = gated.gate(0);
    assert!(within.contains("within its budget") && within.contains("primary.tests"), "{within}");
    gated.bless(0);
    let baseline = Baseline::read(&gated.baseline).unwrap();
    assert_eq!(baseline.budgets.len(), 2);
    assert!(baseline.rows.values().all(|row| row.frame_ms.is_some()));
    // Blessing the same again changes nothing
    let before = std::fs::read(&gated.baseline).unwrap();
    gated.bless(0);
    assert_eq!(std::fs::read(&gated.baseline).unwrap(), before);
    // Three times as slow, in every pass alike: beyond budget and noise
    let slower = |passes: [u64; 2]| {
        gated.edit(|record| {
            if record["record"] == "row" {
                record["timing_source"] = json!("wall");
                record["samples"]["wall_ns"] = json!(passes.map(|ns| [ns, ns]));
            }
            true
        });
    };
    slower([1_000_000, 1_000_000]);
    gated.bless(0);
    slower([3_000_000, 3_000_000]);
    assert!(gated.gate(1).contains("frame_ms: 1.0000 -> 3.0000"));
    // The noise of both sides explains it
    slower([1_000_000, 2_800_000]);
    assert!(gated.gate(0).contains("ambiguous: "));
    gated.gate_with(1, &["--strict"]);
}

#[test]
fn another_driver_leaves_hashes_out_and_says_so() {
    let gated = Gated::new();
    gated.edit_baseline("\"driver\": \"cpu\"", "\"driver\": \"another driver\"");
    let out = gated.gate(0);
    assert!(out.contains("4 hashes were not compared: they are of another driver"), "{out}");
    let strict = gated.gate_with(2, &["--strict"]);
    assert!(strict.contains("4 hashes are of another driver") && strict.contains("rtbench bless"), "{strict}");
}

#[test]
fn what_cannot_be_judged_is_one_error_and_nothing_is_overwritten() {
    let gated = Gated::new();
    let good = std::fs::read_to_string(&gated.baseline).unwrap();
    let line = |needle: &str| good.lines().position(|line| line.contains(needle)).unwrap() + 1;
    // Behind the end of a line the parser would be on the next one
    let cut = good[..good.len() / 2].trim_end().to_owned();
    let broken: [(String, String); 7] = [
        (good.replace("rtbench-baseline/1", "rtbench-baseline/9"), ":2: schema \"rtbench-baseline/9\"".into()),
        (good.replacen("\"tests\": ", "\"tests\": -", 1), format!(":{}: no baseline", line("\"tests\": "))),
        (good.replacen("\"rows\": {", "\"rows\" {", 1), format!(":{}", line("\"rows\": {"))),
        (
            good.replacen("\"budgets\": {}", "\"budgets\": {\"innner\": {\"absolute\": 1}}", 1),
            "there is no quantity 'innner'".into(),
        ),
        (cut.clone(), format!(":{}: no baseline", cut.lines().count())),
        (String::new(), "the baseline is empty".into()),
        ("{}".into(), "names no schema".into()),
    ];
    for (text, wanted) in broken {
        std::fs::write(&gated.baseline, &text).unwrap();
        let error = gated.gate(2);
        assert!(error.contains(&wanted), "{wanted}: {error}");
        // Bless does not write over what it cannot read: budgets would be lost
        gated.bless(2);
        assert_eq!(std::fs::read_to_string(&gated.baseline).unwrap(), text);
    }
    std::fs::write(&gated.baseline, &good).unwrap();
    let journal = gated.run.join("journal.jsonl");
    let original = std::fs::read_to_string(&journal).unwrap();
    // Another workload, another scene, a run that is still being written
    std::fs::write(&journal, original.replace("\"workload\":\"sweep\"", "\"workload\":\"spheres\"")).unwrap();
    assert!(gated.gate(2).contains("it is of `rtbench sweep`"));
    assert!(gated.bless(2).contains("it is of `rtbench sweep`"));
    gated.edit(|record| {
        if record["record"] == "row" {
            record["key"]["workload"] = json!("sweep");
            record["key"]["inputs"]["scene"] = json!("f".repeat(64));
        } else if record["record"] == "run" {
            record["workload"] = json!("sweep");
        }
        true
    });
    let scene = gated.gate(2);
    assert!(scene.contains("scene of") && scene.contains("is not the one of the baseline"), "{scene}");
    std::fs::write(&journal, &original).unwrap();
    gated.edit(|record| record["record"] != "end");
    assert!(gated.gate(2).contains("the run has not ended"));
    assert!(gated.bless(2).contains("the run has not ended"));
    assert_eq!(std::fs::read_to_string(&gated.baseline).unwrap(), good);
    let nowhere = rtbench(["gate", "nowhere", "--baseline", gated.baseline.to_str().unwrap()]);
    assert_eq!(nowhere.status.code(), Some(2));
    assert!(text(&nowhere.stderr).contains("there is no journal.jsonl"));
}

#[test]
fn compare_prints_every_format_and_refuses_unlike_workloads() {
    let gated = Gated::new();
    let other = gated.folder.path().join("other");
    std::fs::create_dir(&other).unwrap();
    let journal = std::fs::read_to_string(gated.run.join("journal.jsonl")).unwrap();
    std::fs::write(other.join("journal.jsonl"), &journal).unwrap();
    let page = gated.folder.path().join("page.html");
    let compare = |flags: &[&str]| {
        let sides = ["compare".as_ref(), gated.run.as_os_str(), other.as_os_str()];
        rtbench(sides.into_iter().chain(flags.iter().map(|flag| flag.as_ref())))
    };
    let plain = compare(&["--html", page.to_str().unwrap()]);
    let plain_text = text(&plain.stdout);
    assert_eq!(plain.status.code(), Some(0), "{}", text(&plain.stderr));
    assert!(plain_text.find("exact quantities agree") < plain_text.find("ambiguous"), "{plain_text}");
    assert!(std::fs::read_to_string(&page).unwrap().contains("<svg"));
    assert!(text(&compare(&["--format", "markdown"]).stdout).contains("| verdict |"));
    let json: Value = serde_json::from_slice(&compare(&["--format", "json"]).stdout).unwrap();
    assert_eq!(json["rows"].as_array().unwrap().len(), 4);
    assert!(text(&compare(&["--format", "csv"]).stdout).starts_with("kind,row,quantity,old,new,ratio"));
    // The output is not one of the inputs
    let own = compare(&["-o", other.join("journal.jsonl").to_str().unwrap()]);
    assert_eq!(own.status.code(), Some(2), "{}", text(&own.stderr));
    assert_eq!(std::fs::read_to_string(other.join("journal.jsonl")).unwrap(), journal);
    std::fs::write(other.join("journal.jsonl"), journal.replace("\"workload\":\"sweep\"", "\"workload\":\"spheres\""))
        .unwrap();
    let refused = compare(&[]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("it is a run of `rtbench spheres`"), "{}", text(&refused.stderr));
}

/// `ab` with these sides, into a folder.
fn ab(out: &Path, sides: &[&str]) -> Output {
    let own = ["ab", "--out", out.to_str().unwrap()].into_iter().chain(sides.iter().copied());
    rtbench(own.chain(["--"]).chain(FLAGS))
}

#[test]
fn two_configurations_are_measured_in_rounds_with_a_null_run() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("ab");
    let output = ab(&out, &["structure=kdtree", "structure=bvh"]);
    // Passes are the rounds
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("--passes has no meaning here"), "{}", text(&output.stderr));
    let flags = FLAGS.iter().copied().filter(|flag| *flag != "--passes" && *flag != "2");
    let sides = ["ab", "--out", out.to_str().unwrap(), "structure=kdtree", "structure=bvh", "--", "--warmup", "0"];
    let output = rtbench(sides.into_iter().chain(flags.filter(|flag| *flag != "--frames")).chain(["--frames", "1"]));
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let stdout = text(&output.stdout);
    assert!(stdout.contains("null A/A") && stdout.contains("10 rounds, interleaved"), "{stdout}");
    let rounds = std::fs::read_to_string(out.join("rounds.jsonl")).unwrap();
    // A head, and ten rounds of two cases
    assert_eq!(rounds.lines().count(), 1 + 2 * 10);
    let last: Value = serde_json::from_str(rounds.lines().last().unwrap()).unwrap();
    assert!(["a_ms", "b_ms", "null_ms"].iter().all(|side| last[side].as_f64().unwrap() > 0.0), "{last}");
    assert_eq!(last["round"], 10);
    let json: Value = serde_json::from_str(&std::fs::read_to_string(out.join("ab.json")).unwrap()).unwrap();
    assert_eq!(json["cells"].as_array().unwrap().len(), 2);
}

#[test]
fn sides_that_cannot_be_are_one_error_each() {
    let folder = tempfile::tempdir().unwrap();
    let cases: [(&[&str], &str); 7] = [
        (&["colour=red", "structure=bvh"], "there is no axis 'colour'"),
        (&["structure", "structure=bvh"], "'structure' is no value of an axis"),
        (&["structure=nothing", "structure=bvh"], "nothing"),
        (&["config=P,PS", "config=P"], "do not pair"),
        (&["--rounds", "9", "structure=kdtree", "structure=bvh"], "9 is out of range"),
        (&["--exe", PROGRAM], "give it twice"),
        (&["--exe", PROGRAM, "--exe", "nowhere/rtbench"], "there is no such program"),
    ];
    for (sides, wanted) in cases {
        let out = folder.path().join("out");
        let own = ["ab", "--out", out.to_str().unwrap()].into_iter().chain(sides.iter().copied());
        let output = rtbench(own.chain(["--", "--scene", "scan:triangles=1000", "--backend", "cpu"]));
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{sides:?}: {stderr}");
        assert!(stderr.contains(wanted) && stderr.matches("rtbench: error").count() == 1, "{sides:?}: {stderr}");
        assert!(!out.exists(), "{sides:?}");
    }
}

#[cfg(unix)]
#[test]
fn a_side_that_crashes_in_round_seven_is_named_and_the_rounds_before_it_are_kept() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    // Counts its runs, and crashes in the seventh
    let program = folder.path().join("crashes");
    let count = folder.path().join("count");
    let script = format!(
        "#!/bin/sh\necho x >> {count}\nif [ $(wc -l < {count}) -ge 7 ]; then echo 'a bad day' >&2; exit 139; fi\nexec {PROGRAM} \"$@\"\n",
        count = count.display()
    );
    std::fs::write(&program, script).unwrap();
    std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).unwrap();
    let out = folder.path().join("out");
    let flags = ["--scene", "scan:triangles=1000", "--backend", "cpu", "--resolution", "16", "--config", "P"];
    let more = ["--structure", "bvh", "--frames", "1", "--passes", "1"];
    let own = ["ab", "--out", out.to_str().unwrap(), "--exe", PROGRAM, "--exe", program.to_str().unwrap(), "--"];
    let output = rtbench(own.into_iter().chain(flags).chain(more));
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(stderr.contains("round 7, side b") && stderr.contains("a bad day"), "{stderr}");
    assert_eq!(stderr.matches("rtbench: error: ").count(), 1, "{stderr}");
    let rounds = std::fs::read_to_string(out.join("rounds.jsonl")).unwrap();
    assert_eq!(rounds.lines().count(), 1 + 6, "{rounds}");
    // Nothing is overwritten by a second attempt
    let again = rtbench(own.into_iter().chain(flags).chain(more));
    assert!(text(&again.stderr).contains("is not empty"), "{}", text(&again.stderr));
    assert_eq!(std::fs::read_to_string(out.join("rounds.jsonl")).unwrap(), rounds);
}

/// A run of two devices: each row's hash is compared with the driver that it is of.
#[test]
fn rows_of_several_devices_have_their_own_driver() {
    let gated = Gated::new();
    gated.edit(|record| {
        if record["record"] == "run" {
            let mut second = record["devices"][0].clone();
            second["driver"] = json!("Second 1.0");
            record["devices"].as_array_mut().unwrap().push(second);
        }
        if record["record"] == "row" && record["key"]["axes"]["structure"] == "kdtree" {
            record["device"] = json!(1);
        }
        true
    });
    gated.bless(0);
    let baseline = std::fs::read_to_string(&gated.baseline).unwrap();
    assert_eq!(
        baseline.matches("Second 1.0").count() + baseline.matches("\"driver\": \"cpu\"").count(),
        3,
        "{baseline}"
    );
    assert!(gated.gate_with(0, &["--strict"]).contains("green"));
    // A hash of either device that changed is found
    for structure in ["kdtree", "bvh"] {
        let changed =
            Gated { folder: tempfile::tempdir().unwrap(), run: gated.run.clone(), baseline: gated.baseline.clone() };
        let before = std::fs::read_to_string(changed.run.join("journal.jsonl")).unwrap();
        changed.edit_row(structure, |row| row["outputs"]["image"] = json!("0123456789abcdef0123"));
        let red = changed.gate(1);
        assert!(red.contains("image hash") && red.contains(structure), "{red}");
        std::fs::write(changed.run.join("journal.jsonl"), before).unwrap();
    }
    // Another driver's hash is not compared
    gated.edit_baseline("\"Second 1.0\"", "\"Second 2.0\"");
    let text = gated.gate(0);
    assert!(text.contains("hashes were not compared"), "{text}");
}
