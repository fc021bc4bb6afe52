//! Tests of the program as a user runs it, on the CPU twins and with tiny scenes.

use crate::support::csv_rows;
use rtbench::record::journal::{FILE_NAME, Journal};
use rtbench::record::row::Status;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

const PROGRAM: &str = env!("CARGO_BIN_EXE_rtbench");

/// Arguments of a sweep that takes less than a second.
const TINY: &str = "--backend cpu --scene scan:triangles=1000 --frames 2 --passes 2 --resolution 16";

/// The arguments of [`TINY`] without a scene.
const TINY_ROWS: &str = "--backend cpu --frames 2 --passes 2 --resolution 16";

fn command(arguments: &str) -> Command {
    let mut command = Command::new(PROGRAM);
    command.args(arguments.split_whitespace()).env_remove("RTBENCH_SCENES");
    command
}

fn run(arguments: &str) -> Output {
    command(arguments).output().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Runs the program, asserts that it succeeds, and returns its standard output.
fn good(arguments: &str) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments}\n{}", stderr(&output));
    stdout(&output)
}

/// Asserts that the program failed with exit code 2 and one line of error that contains all `words`, and did not panic.
#[track_caller]
fn one_error(output: &Output, words: &[&str]) {
    let text = stderr(output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(!text.contains("panicked"), "{text}");
    let errors: Vec<&str> = text.lines().filter(|line| line.starts_with("rtbench: error: ")).collect();
    assert_eq!(errors.len(), 1, "{text}");
    // Notes about the device may precede the error; nothing follows it, and it is one line.
    assert!(text.lines().all(|line| line.starts_with("rtbench: ")), "{text}");
    for word in words {
        assert!(errors[0].contains(word), "{word:?} is missing: {text}");
    }
}

#[test]
fn the_outputs_of_a_sweep_are_consistent() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("deep/run");
    let text = good(&format!("sweep {TINY} --config P,PS --resolution 16,24x20 --out {}", out.display()));
    assert!(text.contains("on the CPU") && text.contains("do not rank algorithms for a GPU"), "{text}");

    let journal = Journal::read(&out.join(FILE_NAME)).unwrap();
    let json: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(out.join("run.json")).unwrap()).unwrap();
    let rows = csv_rows(&out.join("summary.csv"));
    assert_eq!(json["rows"].as_array().unwrap().len(), rows.len());
    for (row, json) in rows.iter().zip(json["rows"].as_array().unwrap()) {
        for (column, cell) in row {
            let same = match &json[column] {
                serde_json::Value::Null => cell.is_empty(),
                serde_json::Value::String(text) => text == cell,
                number => number.as_f64() == cell.parse().ok(),
            };
            assert!(same, "{column}: {cell} {}", json[column]);
        }
    }

    // Five structures, two configurations, and both the sizes of the command line and no other.
    assert_eq!((rows.len(), csv_rows(&out.join("structures.csv")).len(), journal.rows.len()), (5 * 2 * 2, 5, 20));
    let number = |row: &std::collections::BTreeMap<String, String>, column: &str| row[column].parse::<f64>().unwrap();
    for row in &rows {
        assert_eq!((row["status"].as_str(), row["verified"].as_str()), ("ok", "true"));
        assert_eq!((row["frames"].as_str(), row["passes"].as_str()), ("2", "2"));
        assert!(number(row, "frame_ms_mean") > 0.0);
        assert_eq!(number(row, "primary_rays"), 2.0 * number(row, "width") * number(row, "height"));
    }
    // The same frame is the same picture through every structure.
    for (a, b) in rows.iter().flat_map(|a| rows.iter().map(move |b| (a, b))) {
        if (&a["config"], &a["resolution"]) == (&b["config"], &b["resolution"]) {
            assert_eq!(a["image_hash"], b["image_hash"], "{} {}", a["structure"], b["structure"]);
            assert_eq!(a["shadow_rays"], b["shadow_rays"]);
        }
    }
    assert!(journal.end.as_ref().unwrap().complete);
    assert!(journal.provenance.arguments.contains(&"--config".to_string()));
    assert!(!journal.provenance.program.lock_hash.is_empty() && journal.provenance.environment.memory_bytes > 0);
    // A second run does not go into the same folder.
    one_error(&run(&format!("sweep {TINY} --out {}", out.display())), &["--out", "not empty"]);
}

#[test]
fn each_invalid_argument_is_one_error() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let file = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).unwrap();
        at(name)
    };
    let ply = |name: &str, vertices: &str, faces: &str, body: &str| {
        let head = format!(
            "ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
             element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
        );
        file(name, &(head + body))
    };
    let corners = "0 0 0\n1 0 0\n0 1 0\n";
    let truncated = ply("truncated.ply", "3", "2", &format!("{corners}3 0 1 2\n"));
    let index = ply("index.ply", "3", "1", &format!("{corners}3 0 1 3\n"));
    let count = ply("count.ply", "1099511627776", "1", corners);
    let nan = ply("nan.ply", "3", "1", "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n");
    let infinite = ply("infinite.ply", "3", "1", "0 0 inf\n1 0 0\n0 1 0\n3 0 1 2\n");
    let empty = ply("empty.ply", "3", "0", corners);
    let preset =
        file("typo.toml", "structure = [\"grid\"]\nconfig = [\"P\"]\nresolutionz = [\"16\"]\npasses = 1\nwarmup = 0\n");
    let plain = file("plain", "");
    let out = at("out");
    for (arguments, words) in [
        (format!("--scene {}", at("missing.ply")), vec!["missing.ply"]),
        (format!("--scene {truncated}"), vec!["truncated.ply"]),
        (format!("--scene {index}"), vec!["index.ply", "3"]),
        (format!("--scene {count}"), vec!["count.ply"]),
        (format!("--scene {nan}"), vec!["nan.ply"]),
        (format!("--scene {infinite}"), vec!["infinite.ply"]),
        (format!("--scene {empty}"), vec!["empty.ply"]),
        ("--scene nosuchscene".into(), vec!["nosuchscene"]),
        ("--scene bunny".into(), vec!["bunny", "RTBENCH_SCENES", "scenes fetch bunny"]),
        ("--resolution 0".into(), vec!["--resolution", "no pixels"]),
        ("--resolution 12x0".into(), vec!["--resolution", "no pixels"]),
        ("--resolution 100000x100000".into(), vec!["--resolution", "pixels"]),
        ("--resolution big".into(), vec!["--resolution", "\"big\""]),
        ("--structure octree".into(), vec!["--structure", "octree", "kdtree"]),
        ("--structure grid:nosuch=1".into(), vec!["--structure", "nosuch"]),
        ("--config PX".into(), vec!["--config", "PSR"]),
        ("--frames 0".into(), vec!["--frames"]),
        ("--frames 1000000000".into(), vec!["--frames"]),
        ("--passes 0".into(), vec!["--passes"]),
        ("--frames many".into(), vec!["--frames", "many"]),
        ("--camera-path nosuchpath".into(), vec!["nosuchpath"]),
        ("--threads 5000".into(), vec!["--threads"]),
        ("--adapter 0".into(), vec!["--adapter"]),
        ("--preset nosuchpreset".into(), vec!["--preset", "quick, thesis"]),
        (format!("--preset {preset}"), vec!["typo.toml:3", "resolutionz"]),
        (format!("--preset {}", at("missing.toml")), vec!["missing.toml"]),
        (format!("--out {plain}/run"), vec!["cannot write", "plain"]),
        ("--out /proc/nowhere/run".into(), vec!["cannot write", "/proc/nowhere"]),
        ("--nosuchflag".into(), vec!["--nosuchflag"]),
    ] {
        // Some flags can be repeated, in which case all of their values are used; each flag is therefore given once.
        let flag = arguments.split_whitespace().next().unwrap();
        let mut all = vec!["--scene scan:triangles=1000", "--frames 2", "--resolution 16", "--backend cpu"];
        all.retain(|given| !given.starts_with(flag));
        let out = if flag == "--out" { String::new() } else { format!("--out {out}") };
        let output = run(&format!("sweep {} {arguments} {out}", all.join(" ")));
        println!("{arguments}: {}", stderr(&output));
        one_error(&output, &words);
        // No output was started.
        assert!(!Path::new(&at("out")).join(FILE_NAME).exists(), "{arguments}");
    }
    one_error(&run("sweep --preset thesis --backend cpu"), &["bunny", "https://"]);
    one_error(&run("nosuchcommand"), &["nosuchcommand"]);
    one_error(&run(&format!("render --scene scan --backend cpu --frame 400 -o {}", at("x.png"))), &["--frame", "399"]);
    one_error(&run(&format!("render --scene scan --resolution 0 -o {}", at("x.png"))), &["--resolution"]);
    one_error(&run(&format!("build --scene scan --runs 0 --csv {}", at("x.csv"))), &["--runs"]);
    one_error(&run("scenes info nosuchscene"), &["nosuchscene"]);
    assert!(!Path::new(&at("x.png")).exists() && !Path::new(&at("x.csv")).exists());
}

#[test]
fn a_full_disk_keeps_the_rows() {
    if cfg!(not(unix)) {
        eprintln!("a_full_disk_keeps_the_rows did not run: it needs a Unix shell");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    // A limit on the size of files, in blocks of 512 bytes, is reached in the middle of the journal, as on a full disk.
    let whole = folder.path().join("whole");
    good(&format!("sweep {TINY} --config P --out {}", whole.display()));
    let text = std::fs::read_to_string(whole.join(FILE_NAME)).unwrap();
    let third_row = text.match_indices("{\"record\":\"row\"").nth(2).unwrap().0;
    let limit = (third_row + 300) / 512;
    let run = format!("exec {PROGRAM} sweep {TINY} --config P --out {}", out.display());
    let script = format!("trap '' XFSZ; ulimit -f {limit}; {run}");
    let output = Command::new("sh").args(["-c", &script]).env_remove("RTBENCH_SCENES").output().unwrap();
    one_error(&output, &["cannot write", FILE_NAME]);
    let journal = Journal::read(&out.join(FILE_NAME)).unwrap();
    assert!((1..5).contains(&journal.rows.len()), "{}", journal.rows.len());
    assert_eq!(journal.truncated, None);
    assert!(stderr(&output).contains("what was measured is in"), "{}", stderr(&output));
}

#[test]
fn errors_of_standard_output_are_reported() {
    if !Path::new("/dev/full").exists() {
        eprintln!("errors_of_standard_output_are_reported did not run: there is no /dev/full");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let rays = folder.path().join("rays.csv");
    std::fs::write(&rays, "origin_x,origin_y,origin_z,direction_x,direction_y,direction_z\n0,0,9,0,0,-1\n").unwrap();
    for arguments in [
        "render --scene scan:triangles=1000 --backend cpu --resolution 16 -o /dev/full".to_owned(),
        "build --scene scan:triangles=1000 --csv /dev/full".to_owned(),
        format!("trace --scene scan:triangles=1000 --backend cpu --rays {} -o /dev/full", rays.display()),
    ] {
        one_error(&run(&arguments), &["cannot write /dev/full"]);
    }
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = command("structures").stdout(full).stderr(Stdio::piped()).spawn().unwrap().wait_with_output().unwrap();
    one_error(&output, &["standard output"]);
    assert!(!std::fs::metadata("/dev/full").unwrap().is_file());
}

#[test]
fn a_closed_pipe_is_not_an_error() {
    for arguments in ["structures", "scenes list", "--help", "completions bash", "scenes info scan:triangles=1000"] {
        let mut child = command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments}: {}", stderr(&output));
        assert!(!stderr(&output).contains("panicked"), "{arguments}");
    }
}

#[test]
fn ctrl_c_keeps_the_finished_rows() {
    if cfg!(not(unix)) {
        eprintln!("ctrl_c_keeps_the_finished_rows did not run: it needs Unix signals");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let arguments = format!(
        "sweep --backend cpu --scene scan:triangles=1000 --frames 400 --passes 40 --resolution 16,512 \
         --config P --structure bvh-stack --out {}",
        out.display()
    );
    let child = command(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // The first row takes a moment, the second one would take an hour.
    let journal = out.join(FILE_NAME);
    let begun = Instant::now();
    while std::fs::read_to_string(&journal).map_or(0, |text| text.matches("\"record\":\"row\"").count()) < 1 {
        assert!(begun.elapsed() < Duration::from_secs(120), "no row after two minutes");
        std::thread::sleep(Duration::from_millis(50));
    }
    let killed = Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    assert!(killed.success());
    let output = child.wait_with_output().unwrap();
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(130), "{text}");
    assert!(text.contains("rtbench: error: interrupted") && !text.contains("panicked"), "{text}");
    assert_eq!(text.matches("rtbench: stopping after this frame; Ctrl-C again ends at once\n").count(), 1, "{text}");
    let journal = Journal::read(&journal).unwrap();
    assert_eq!(journal.rows.len(), 1);
    assert!(journal.end.as_ref().unwrap().interrupted);
    assert!(std::fs::read_to_string(out.join("run.json")).unwrap().contains("\"interrupted\": true"));
    assert_eq!(std::fs::read_to_string(out.join("summary.csv")).unwrap().lines().count(), 2);
}

/// Starts the program, sends Ctrl-C when a line of its standard error begins with `line`, and waits for its end.
#[cfg(unix)]
fn interrupted_at(arguments: &str, line: &str) -> Output {
    let mut child = command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut text = String::new();
    let mut lines = BufReader::new(child.stderr.take().unwrap());
    while !text.lines().any(|said| said.starts_with(line)) {
        assert!(lines.read_line(&mut text).unwrap() > 0, "it ended without '{line}': {text}");
    }
    let killed = Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    assert!(killed.success());
    lines.read_to_string(&mut text).unwrap();
    let mut output = child.wait_with_output().unwrap();
    output.stderr = text.into_bytes();
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert_eq!(stderr(&output).matches("rtbench: error: interrupted\n").count(), 1, "{}", stderr(&output));
    assert!(!stderr(&output).contains("panicked"), "{}", stderr(&output));
    output
}

/// Arguments of a build that takes seconds on one thread, in code that cannot be interrupted.
#[cfg(unix)]
const LONG: &str = "--structure grid,ploc-stack:preset=very-slow --threads 1";

#[cfg(unix)]
#[test]
fn ctrl_c_during_a_build_reports_the_finished_structures() {
    let output = interrupted_at(
        &format!("build --scene scan:triangles=300000 {LONG}"),
        "rtbench: building ploc-stack:preset=very-slow of scan:triangles=300000",
    );
    // The structure that was built before is reported.
    assert!(stdout(&output).contains(" grid "), "{}", stdout(&output));
    assert!(!stdout(&output).contains("ploc-stack"), "the build was too fast: {}", stdout(&output));
    let output = interrupted_at(
        "render --backend cpu --scene scan:triangles=1000 --resolution 4096 --config PSR --threads 1 -o /dev/null",
        "rtbench: device: ",
    );
    assert_eq!(stdout(&output), "");
}

#[cfg(unix)]
#[test]
fn ctrl_c_during_a_build_of_a_sweep_keeps_the_finished_rows() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let arguments = format!(
        "sweep --scene scan:triangles=1000 --scene scan:triangles=300000 {LONG} --backend cpu --frames 2 --passes 2 \
         --resolution 16 --config P --out {}",
        out.display()
    );
    let output = interrupted_at(&arguments, "rtbench: building ploc-stack of scan:triangles=300000");
    let journal = Journal::read(&out.join(FILE_NAME)).unwrap();
    assert!(journal.end.as_ref().unwrap().interrupted);
    // Both rows of the small scene are there, none of the large one
    assert_eq!(journal.rows.len(), 2, "{}", stderr(&output));
    assert_eq!(std::fs::read_to_string(out.join("summary.csv")).unwrap().lines().count(), 3);
    let output = run(&format!("sweep --resume {}", out.display()));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("2 of 4 rows are there already"), "{}", stderr(&output));
    let journal = Journal::read(&out.join(FILE_NAME)).unwrap();
    assert_eq!(journal.rows.len(), 4);
    assert!(journal.end.as_ref().unwrap().complete);
}

/// Table, journal and CSV note that a structure was built as another one than its name says.
#[test]
fn a_substitute_structure_is_noted_in_all_outputs() {
    let folder = tempfile::tempdir().unwrap();
    let [scene, out] = ["heap.obj", "run"].map(|name| folder.path().join(name));
    let heap = format!("v 0 0 0\nv 1 0 0.1\nv 0 1 0\n{}", "f 1 2 3\n".repeat(3000));
    std::fs::write(&scene, heap).unwrap();
    let [scene, csv] = [scene.display().to_string(), folder.path().join("b.csv").display().to_string()];
    let output = run(&format!("build --scene {scene} --structure bvh,ploc-stack --csv {csv}"));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let notes = stderr(&output);
    assert!(notes.contains("heap.obj~") && notes.contains(" ploc-stack: built as bvh: "), "{notes}");
    good(&format!("sweep --scene {scene} {TINY_ROWS} --structure bvh,ploc-stack --out {}", out.display()));
    let journal = Journal::read(&out.join(FILE_NAME)).unwrap();
    let notes: Vec<&str> = journal.artifacts.iter().map(|s| s.note.split(':').next().unwrap()).collect();
    assert_eq!(notes, ["", "built as bvh"]);
    for csv in [std::path::PathBuf::from(csv), out.join("structures.csv")] {
        let rows = csv_rows(&csv);
        let notes: Vec<&str> = rows.iter().map(|row| row["note"].split(':').next().unwrap()).collect();
        assert_eq!(notes, ["", "built as bvh"]);
    }
}

#[test]
fn a_sweep_is_resumed_with_its_original_flags() {
    let folder = tempfile::tempdir().unwrap();
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
               element face 4\nproperty list uchar int vertex_indices\nend_header\n\
               0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n3 0 2 3\n3 1 2 3\n";
    let scene = folder.path().join("pyramid.ply");
    std::fs::write(&scene, ply).unwrap();
    let out = folder.path().join("run");
    let (scene_name, out_name) = (scene.display(), out.display());
    good(&format!(
        "sweep --backend cpu --scene {scene_name} --frames 2 --passes 2 --resolution 16,20 --config P \
         --structure grid,bvh-stack --out {out_name}"
    ));
    let journal = out.join(FILE_NAME);
    let whole = std::fs::read_to_string(&journal).unwrap();
    let resume = format!("sweep --resume {out_name}");
    assert!(stderr(&run(&resume)).contains("nothing is left to measure"));
    assert_eq!(stderr(&run(&format!("{resume}/{FILE_NAME}"))), stderr(&run(&resume)));
    assert_eq!(stderr(&run(&format!("{resume} -q"))), "");
    assert_eq!(std::fs::read_to_string(&journal).unwrap(), whole);

    // Killed in the middle of its third row
    let third = whole.match_indices("\"record\":\"row\"").nth(2).unwrap().0;
    std::fs::write(&journal, &whole[..third + 40]).unwrap();
    let output = run(&resume);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("2 of 4 rows are there already"), "{}", stderr(&output));
    let resumed = Journal::read(&journal).unwrap();
    // With --quiet, and by the journal's name
    let by_journal = tempfile::tempdir().unwrap();
    std::fs::write(by_journal.path().join(FILE_NAME), &whole[..third + 40]).unwrap();
    let output = command(&format!("sweep --quiet --resume {FILE_NAME}")).current_dir(&by_journal).output().unwrap();
    assert_eq!((output.status.code(), stderr(&output), stdout(&output)), (Some(0), String::new(), String::new()));
    assert!(by_journal.path().join("summary.csv").is_file());
    assert_eq!((resumed.rows.len(), resumed.artifacts.len(), resumed.resumed.len()), (4, 2, 1));
    assert_eq!(resumed.resumed[0].arguments[1..], ["sweep".to_owned(), "--resume".to_owned(), out_name.to_string()]);
    assert!(resumed.rows.iter().all(|row| row.status == Status::Ok));
    assert_eq!(std::fs::read_to_string(out.join("summary.csv")).unwrap().lines().count(), 5);
    let report = good(&format!("report {out_name} -o /dev/stdout"));
    assert!(report.contains(&resumed.resumed[0].started), "the report does not tell that the run was resumed");

    // Refused: another scene under the same name, other flags, a folder without a run, another command
    std::fs::write(&journal, &whole[..third + 40]).unwrap();
    std::fs::write(&scene, ply.replace("0 0 1\n", "0 0 2\n")).unwrap();
    one_error(&run(&resume), &["journal.jsonl", "pyramid.ply~", "is not the scene that it was", "begin a new run"]);
    one_error(&run(&format!("{resume} --frames 3")), &["--resume", "cannot be used with", "--frames"]);
    one_error(
        &run(&format!("sweep --resume {}", folder.path().display())),
        &["journal.jsonl", "cannot read", "the folder of a run"],
    );
    std::fs::write(&journal, whole[..third].replacen("\"sweep\",\"--backend", "\"swoop\",\"--backend", 1)).unwrap();
    one_error(&run(&resume), &["journal.jsonl:1:", "does not know"]);
}

/// `--resume` refuses every other flag that `--help` lists, and the error names the flag.
#[test]
fn a_resumed_run_accepts_no_other_flags() {
    let help = good("sweep --help");
    let flags: Vec<&str> = help.lines().map(str::trim).filter(|line| line.starts_with("--")).collect();
    assert!(flags.len() > 15, "{help}");
    for line in flags {
        let (flag, value) = line.split_once(' ').unwrap_or((line, ""));
        let value = match flag {
            "--resume" | "--strict" => continue,
            "--backend" => "cpu",
            "--shard" => "1/2",
            _ if value.is_empty() => "",
            _ => "1",
        };
        one_error(&run(&format!("sweep --resume nosuch {flag} {value}")), &["--resume", "cannot be used with", flag]);
    }
    one_error(&run("sweep --resume nosuch -q"), &["nosuch/journal.jsonl", "give the folder of a run"]);
}

#[test]
fn a_run_with_relative_paths_is_resumed_in_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("n.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n").unwrap();
    let here = |arguments: &str| command(arguments).current_dir(&folder).output().unwrap();
    let begun =
        here("sweep --backend cpu --scene n.obj --frames 1 --resolution 8 --config P --structure bvh,grid --out k");
    assert_eq!(begun.status.code(), Some(0), "{}", stderr(&begun));
    let journal = folder.path().join("k").join(FILE_NAME);
    let whole = std::fs::read_to_string(&journal).unwrap();
    let second = whole.match_indices("\"record\":\"row\"").nth(1).unwrap().0;
    std::fs::write(&journal, &whole[..second + 40]).unwrap();
    let elsewhere = format!("sweep --resume {}", folder.path().join("k").display());
    one_error(&run(&elsewhere), &["n.obj: no such file", "is resumed from the folder in which it was begun"]);
    assert_eq!(here("sweep --resume k").status.code(), Some(0));
}

#[test]
fn input_files_are_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let rays = "origin_x,origin_y,origin_z,direction_x,direction_y,direction_z\n0,0,5,0,0,-1\n";
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n";
    let files = [("a.csv", rays), ("m.obj", mesh), ("p.toml", "kind = \"orbit\"\n")];
    for (name, text) in files {
        std::fs::write(at(name), text).unwrap();
    }
    std::fs::create_dir(at("sub")).unwrap();
    good(&format!("scenes convert {} {}", at("m.obj"), at("m.rtb")));
    let mut outs = vec![at("a.csv"), at("sub/../a.csv")];
    if cfg!(unix) {
        for kind in ["-s", "-P"] {
            let link = at(&format!("link{kind}.csv"));
            assert!(Command::new("ln").args([kind, &at("a.csv"), &link]).status().unwrap().success());
            outs.push(link);
        }
    }
    for out in outs {
        let trace = format!("trace --scene {} --backend cpu --rays {} -o {out}", at("m.obj"), at("a.csv"));
        one_error(&run(&trace), &["is the same file as", "a.csv", "write to another file"]);
    }
    let scene = at("m.obj");
    one_error(&run(&format!("trace --scene {scene} --backend cpu --rays {} -o {scene}", at("a.csv"))), &["m.obj"]);
    one_error(&run(&format!("scenes convert {0}:scale=2 {0}", at("m.rtb"))), &["m.rtb", "same file"]);
    one_error(&run(&format!("camera-path export {scene} -o {scene}")), &["m.obj", "same file"]);
    let path = at("p.toml");
    one_error(&run(&format!("camera-path export {scene} --camera-path {path} -o {path}")), &["p.toml", "same file"]);
    for (name, text) in files {
        assert_eq!(std::fs::read_to_string(at(name)).unwrap(), text, "{name}");
    }
}

#[test]
fn a_path_with_a_moving_light_is_not_exported() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["lo.toml", "lo.csv"] {
        let out = folder.path().join(name);
        let export = format!("camera-path export scan:triangles=1000 --camera-path light-orbit -o {}", out.display());
        one_error(&run(&export), &["light-orbit", "its light moves", "--camera-path light-orbit"]);
        assert!(!out.exists());
    }
}

#[test]
fn an_empty_rtbench_scenes_counts_as_unset() {
    let output = command("scenes info bunny").env("RTBENCH_SCENES", "").output().unwrap();
    one_error(&output, &["no folder of scenes is given", "RTBENCH_SCENES"]);
}

#[test]
fn the_thesis_preset_lists_absent_scenes() {
    let folder = tempfile::tempdir().unwrap();
    let scenes = folder.path().join("scenes/bunny");
    std::fs::create_dir_all(&scenes).unwrap();
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
               element face 4\nproperty list uchar int vertex_indices\nend_header\n\
               0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n3 0 2 3\n3 1 2 3\n";
    std::fs::write(scenes.join("bun_zipper.ply"), ply).unwrap();
    let out = folder.path().join("run");
    let arguments = format!("sweep --preset thesis --backend cpu --frames 2 --resolution 16 --out {}", out.display());
    let output = command(&arguments).env("RTBENCH_SCENES", folder.path().join("scenes")).output().unwrap();
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{text}");
    assert!(text.contains("left out: dragon") && text.contains("dragon_recon.tar.gz"), "{text}");
    let rows = csv_rows(&out.join("summary.csv"));
    assert!(rows.len() > 5 * 2 + 8, "the tables' rows, and those of figures and claims");
    // P: the camera goes around; PS: the light does.
    for row in &rows {
        assert_eq!((row["triangles"].as_str(), row["passes"].as_str()), ("4", "5"));
        let path = if row["config"] == "P" { "orbit" } else { "light-orbit" };
        assert_eq!(row["camera_path"], path);
    }
}

#[test]
fn render_writes_images_and_heat_maps() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "--backend cpu --scene scan:triangles=1000 --resolution 40x24";
    let picture = |extra: &str| {
        let path = folder.path().join("a.png");
        let text = good(&format!("render {scene} {extra} -o {}", path.display()));
        (image::open(&path).unwrap().to_rgba8(), text)
    };
    let colours = |image: &image::RgbaImage| {
        let mut colours: Vec<_> = image.pixels().map(|p| p.0).collect();
        colours.sort_unstable();
        colours.dedup();
        colours.len()
    };
    let (first, _) = picture("--config PS");
    assert_eq!(first.dimensions(), (40, 24));
    assert!(colours(&first) > 8, "the image has too few colours");
    assert!(first.pixels().all(|p| p.0[3] == 255));
    // All structures give the same image; another frame gives a different one.
    assert_eq!(picture("--config PS --structure grid").0, first);
    assert_ne!(picture("--config P --frame 100").0, picture("--config P").0);
    let (map, legend) = picture("--heatmap tests --structure brute --config P");
    // Brute force tests every triangle for every pixel: the image has one colour, the brightest, and the legend
    // confirms it.
    assert_eq!(colours(&map), 1, "{legend}");
    assert!(legend.starts_with("triangle tests per pixel: min "), "{legend}");
    let (map, legend) = picture("--heatmap steps --structure grid --config P");
    assert!(colours(&map) > 8, "{legend}");
    assert!(legend.contains("steps per pixel") && legend.contains("mean") && legend.contains("max"), "{legend}");
}

#[test]
fn trace_reports_the_hits_of_input_rays() {
    let folder = tempfile::tempdir().unwrap();
    let (rays, hits) = (folder.path().join("rays.csv"), folder.path().join("hits.csv"));
    let mut file = std::fs::File::create(&rays).unwrap();
    writeln!(file, "note,origin_x,origin_y,origin_z,direction_x,direction_y,direction_z,expected").unwrap();
    for i in 0..50 {
        let x = i as f32 / 25.0 - 1.0;
        writeln!(file, "ray {i},{x},0.9,5,0,0,-2,comment").unwrap();
    }
    let trace = |extra: &str| {
        let (rays, out) = (rays.display(), hits.display());
        good(&format!("trace --scene scan:triangles=2000 --backend cpu --rays {rays} {extra} -o {out}"));
        std::fs::read_to_string(&hits).unwrap()
    };
    let brute = trace("--structure brute");
    let lines: Vec<&str> = brute.lines().collect();
    assert_eq!((lines.len(), lines[0]), (51, "t,triangle"));
    assert_eq!(lines[1], ",-1", "a ray that misses the object");
    let found: Vec<(f32, i64)> = lines[1..]
        .iter()
        .filter_map(|line| line.split_once(',').map(|(t, i)| (t.parse().unwrap_or(f32::NAN), i.parse().unwrap())))
        .filter(|hit| hit.1 >= 0)
        .collect();
    // Distances are in units of the direction's length, which is 2; the object is at a distance of 4 to 6.
    assert!(found.len() > 10 && found.iter().all(|hit| (2.0..3.0).contains(&hit.0)), "{found:?}");
    for structure in ["grid", "kdtree", "bvh", "bvh-stack", "ploc-stack"] {
        assert_eq!(trace(&format!("--structure {structure}")), brute, "{structure}");
    }
    let any: Vec<String> = trace("--structure grid --any-hit").lines().skip(1).map(str::to_owned).collect();
    assert!(any.iter().zip(&lines[1..]).all(|(any, nearest)| any == if *nearest == ",-1" { ",-1" } else { "0,0" }));
    std::fs::write(&rays, "origin_x,origin_y,origin_z,direction_x,direction_y,direction_z\n0,0,5,0,x,-1\n").unwrap();
    let out = format!("trace --scene scan --backend cpu --rays {} -o {}", rays.display(), hits.display());
    one_error(&run(&out), &["rays.csv:2", "direction_y is \"x\""]);
}

#[test]
fn build_reports_structures() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.csv");
    let all = "grid,kdtree,bvh,bvh-stack,ploc-stack,brute";
    let text = good(&format!(
        "build --scene scan:triangles=1000 --structure {all} --threads 1 --runs 3 --validate --csv {}",
        path.display()
    ));
    assert!(text.contains("kdtree") && text.contains("ploc-stack"), "{text}");
    let rows = csv_rows(&path);
    assert_eq!(rows.len(), 6);
    let number = |row: usize, column: &str| rows[row][column].parse::<f64>();
    for row in 0..6 {
        assert_eq!(rows[row]["build_threads"], "1");
        assert!(number(row, "build_ms").unwrap() >= 0.0 && number(row, "structure_bytes").unwrap() > 0.0);
    }
    assert!(number(0, "cells_x").is_ok() && number(1, "leaves").is_ok() && rows[1]["cells_x"].is_empty());
}

#[test]
fn what_one_structure_cannot_do_costs_no_other_one() {
    let arguments = "build --scene scan:triangles=1000 --structure bvh:max_depth=2,bvh:max_leaf=3,bih --validate";
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let notes = stderr(&output);
    assert!(notes.contains("scan:triangles=1000 bvh:max_depth=2: skipped: too large"), "{notes}");
    assert!(notes.contains("bvh:max_leaf=3: valid") && notes.contains("bih: valid"), "{notes}");
    assert!(stdout(&output).contains("bvh:max_leaf=3") && stdout(&output).contains("bih"), "{}", stdout(&output));
    // Without any structure there is an error
    one_error(&run("build --scene scan:triangles=1000 --structure bvh:max_depth=2"), &["max_depth"]);
}

#[test]
fn the_catalogue_is_listed_and_scenes_are_converted() {
    let text = good("scenes list");
    for words in [
        "  bunny *",
        "not present: `rtbench scenes fetch bunny`",
        "expected as bart/robots/Robot.aff",
        "RTBENCH_SCENES",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().display();
    std::fs::create_dir(folder.path().join("sponza")).unwrap();
    std::fs::write(folder.path().join("sponza/sponza.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let text = good(&format!("scenes list --scenes-dir {place}"));
    assert!(text.contains(&format!("present: {place}/sponza/sponza.obj")), "{text}");
    let text = good(&format!("scenes info sponza --scenes-dir {place}"));
    assert!(text.contains("1 (the catalogue expects 66450)") && text.contains("licence"), "{text}");
    assert!(good(&format!("build --scene sponza --structure bvh --scenes-dir {place}")).contains("sponza"));
    good(&format!("scenes convert sponza {place}/s.rtb --scenes-dir {place}"));
    let info = |spec: &str| good(&format!("scenes info {spec}"));
    assert!(info(&format!("{place}/s.rtb")).starts_with("sponza\n"));
    good(&format!("scenes convert hall {place}/hall.rtb"));
    let hash = |text: String| text.lines().find(|l| l.contains("content hash")).unwrap().to_owned();
    assert_eq!(hash(info(&format!("{place}/hall.rtb"))), hash(info("hall")));
    one_error(&run(&format!("scenes convert hall {place}/hall.ply")), &["does not end in .rtb"]);
    one_error(&run("scenes fetch bunny"), &["--scenes-dir"]);
    one_error(&run(&format!("scenes fetch buny --scenes-dir {place}")), &["did you mean bunny?"]);
    one_error(&run(&format!("scenes fetch kitchen --scenes-dir {place}")), &["no official address", "BART"]);
    // A file that exists is not downloaded again.
    let fetch = run(&format!("scenes fetch sponza --scenes-dir {place}"));
    one_error(&fetch, &["sponza.obj: this is not the catalogue's sponza", "nothing is overwritten"]);
    std::fs::create_dir(folder.path().join("buddha")).unwrap();
    std::fs::write(folder.path().join("buddha/happy_vrip.ply"), "ply\n").unwrap();
    assert!(good(&format!("scenes fetch buddha --scenes-dir {place}")).contains("is here"));
    one_error(&run("scenes info hall --scene-time nan"), &["--scene-time", "finite"]);
}

#[test]
fn lists_and_help() {
    for name in ["grid", "kdtree", "bvh", "bvh-stack", "ploc-stack", "brute"] {
        assert!(good("structures").lines().any(|line| line.trim() == name), "{name}");
    }
    for name in ["scan", "terrain", "sphereflake", "stadium", "hall", "room"] {
        assert!(good("scenes list").lines().any(|line| line.trim() == name), "{name}");
    }
    let text = good("scenes info scan:triangles=1000");
    assert!(
        text.contains("content hash") && text.contains("kdtree, estimated") && text.contains("within a factor of 2"),
        "{text}"
    );
    assert!(good("devices").contains("--backend cpu"));
    assert!(good("completions bash").contains("rtbench"));
    assert!(good("--version").contains("revision"));
    for command in ["sweep", "render", "build", "trace", "scenes", "completions"] {
        let help = good(&format!("{command} --help"));
        assert!(help.contains("Examples:") && help.contains("rtbench "), "{command}: {help}");
    }
    // Without a command the exit code is not 0, and the help lists the commands.
    assert_eq!(run("").status.code(), Some(2));
}
