//! The program: broken and empty runs, files, documents.

use super::synthetic::everything;
use crate::sources::synthetic::write_run;
use rtbench::record::journal::FILE_NAME;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn rtbench(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rtbench")).args(arguments).output().unwrap()
}

fn good(arguments: &[&str]) -> String {
    let output = rtbench(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Exit code 2 and exactly one line of error, which has these words.
#[track_caller]
fn one_error(arguments: &[&str], words: &[&str]) {
    one_line(arguments, 2, words);
}

/// This exit code and exactly one line of error, which has these words.
#[track_caller]
fn one_line(arguments: &[&str], code: i32, words: &[&str]) {
    let output = rtbench(arguments);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {text}");
    assert_eq!(text.lines().filter(|l| l.starts_with("rtbench: error: ")).count(), 1, "{text}");
    assert!(output.stdout.is_empty() && words.iter().all(|w| text.contains(w)) && !text.contains("panicked"), "{text}");
}

/// Both synthetic runs on disk.
fn on_disk() -> (tempfile::TempDir, PathBuf, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let runs = everything();
    let (a, b) = (folder.path().join("a"), folder.path().join("b"));
    write_run(&runs[0], &a);
    write_run(&runs[1], &b);
    (folder, a, b)
}

const READERS: [&[&str]; 4] = [
    &["tables"],
    &["claims"],
    &["figures", "-o", "/nonexistent/figures"],
    &["report", "-o", "/nonexistent/report.html"],
];

#[test]
fn a_broken_or_empty_run_is_one_clear_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::create_dir(path("empty")).unwrap();
    std::fs::create_dir(path("garbage")).unwrap();
    std::fs::write(Path::new(&path("garbage")).join(FILE_NAME), "{\"record\":\"nonsense\"}\n").unwrap();
    let mut bare = everything().remove(0);
    (bare.journal.structures, bare.journal.configurations) = (Vec::new(), Vec::new());
    write_run(&bare, Path::new(&path("bare")));
    for reader in READERS {
        let with = |run: &str| [reader, &[run]].concat().iter().map(|s| (*s).to_owned()).collect::<Vec<_>>();
        for (name, words) in [
            ("absent", &["absent", "cannot read"][..]),
            ("empty", &["no run", "journal.jsonl"]),
            ("garbage", &["journal.jsonl:1", "not a record"]),
            ("bare", &["no case of it has a result"]),
        ] {
            let arguments = with(&path(name));
            one_error(&arguments.iter().map(String::as_str).collect::<Vec<_>>(), words);
        }
    }
    one_error(&["tables", "--table", "5.99"], &["there is no table '5.99'"]);
    one_error(&["tables", "--device", "RTX"], &["--device: no published", "device 'RTX'", "GTX280, 8600GT"]);
    for reader in READERS {
        one_error(&[reader, &["--source", "theses"]].concat(), &["no source 'theses'", "one of thesis"]);
    }
}

#[test]
fn a_run_that_was_cut_off_is_read_and_said_to_be() {
    let (_folder, a, _) = on_disk();
    let journal = a.join(FILE_NAME);
    let bytes = std::fs::read(&journal).unwrap();
    std::fs::write(&journal, &bytes[..bytes.len() - 40]).unwrap();
    let output = rtbench(&["tables", a.to_str().unwrap(), "--table", "5.2"]);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && text.contains("killed before its end") && text.contains("cut off"), "{text}");
}

#[test]
fn commands_write_what_they_are_asked_for() {
    let (folder, a, b) = on_disk();
    let (a, b) = (a.to_str().unwrap(), b.to_str().unwrap());
    assert!(good(&["tables", "--table", "5.4"]).contains("Table 5.4: Properties of the uniform grid"));
    let text = good(&["tables", a, b, "--published", "--table", "5.3.4,B.4"]);
    assert!(text.contains("Speed-up of Fast GPU over Slow GPU") && text.contains("ratio"), "{text}");
    assert_eq!(text, good(&["tables", a, b, "--published", "--source", "thesis", "--table", "5.3.4,B.4"]));
    // The former spelling
    assert_eq!(text, good(&["tables", a, b, "--beside", "thesis", "--table", "5.3.4,B.4"]));
    // The journal itself will do for its folder.
    let journal = Path::new(a).join(FILE_NAME);
    assert_eq!(good(&["claims", journal.to_str().unwrap()]), good(&["claims", a]));
    assert!(good(&["claims"]).contains("the numbers that it printed"));
    let figures = folder.path().join("deep/figures");
    let listed = good(&["figures", a, "-o", figures.to_str().unwrap()]);
    assert!(listed.lines().all(|line| Path::new(line).is_file()) && listed.lines().count() > 5, "{listed}");
    let page = folder.path().join("report.html");
    good(&["report", a, b, "-o", page.to_str().unwrap()]);
    assert!(std::fs::read_to_string(page).unwrap().ends_with("</html>\n"));
    one_error(&["report", a, "-o", "/nonexistent/report.html"], &["cannot write"]);
}

#[test]
fn a_document_s_tables_are_replaced_and_held() {
    let (folder, a, _) = on_disk();
    let a = a.to_str().unwrap();
    let document = folder.path().join("README.md");
    let path = document.to_str().unwrap();
    let text = "# Title\n\n<!-- rtbench:5.12 -->\nold\n<!-- /rtbench:5.12 -->\nbetween\n<!-- rtbench:claims -->\n\
                <!-- /rtbench:claims -->\nend, no newline";
    std::fs::write(&document, text).unwrap();
    let tables = ["tables", a, "--table", "5.12", "--into", path];
    // Not being up to date is an answer, no failure.
    let check = [&tables[..], &["--check"]].concat();
    one_line(&check, 1, &["README.md: is not up to date (run the same without --check)"]);
    one_line(&["claims", a, "--into", path, "--check"], 1, &["not up to date"]);
    assert_eq!(std::fs::read_to_string(&document).unwrap(), text, "a check has changed something");
    one_error(&["tables", a, "--check"], &["the following required arguments were not provided: --into <FILE>"]);
    one_error(&["tables", a, "--into", "/nonexistent/README.md", "--check"], &["cannot read"]);
    good(&tables);
    good(&["claims", a, "--into", path]);
    let once = std::fs::read_to_string(&document).unwrap();
    assert!(
        once.starts_with("# Title\n\n<!-- rtbench:5.12 -->\n\n**Table 5.12") && !once.contains("\nold\n"),
        "{once}"
    );
    assert!(once.contains("\nbetween\n") && once.contains("| claim | verdict |") && once.ends_with("end, no newline"));
    // Twice is once, and now it is up to date.
    good(&tables);
    good(&["claims", a, "--into", path]);
    assert_eq!(std::fs::read_to_string(&document).unwrap(), once);
    good(&check);
    // All tables: those that have a place.
    good(&["tables", a, "--into", path]);
    one_error(&["tables", a, "--table", "5.1", "--into", path], &["no place for 5.1", "<!-- rtbench:5.1 -->"]);
    one_error(&["tables", a, "--into", path, "-o", "x"], &["--output"]);
}

#[test]
fn a_table_asked_for_by_name_is_printed_also_when_it_is_empty() {
    let (_folder, a, _) = on_disk();
    let a = a.to_str().unwrap();
    let text = good(&["tables", a, "--table", "5.7,B.4", "--published"]);
    for words in ["Table 5.7: Group shape", "Table 5.7: Effect of a register limit", "Table B.4", "240.96", "45.19"] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert!(good(&["tables", a, "--table", "B.4", "--rows", "measured"]).contains("Not measured: bunny, "));
    // All that was measured: no empty tables, they are named on standard error.
    let output = rtbench(&["tables", a, "--rows", "measured"]);
    let (text, notes) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(!text.contains("Table B.4") && notes.contains("nothing was measured for: 5.7, 5.3.4, B.4"), "{notes}");
    // The size follows the device; `--card` is its former name.
    assert!(good(&["tables", "--device", "GTX280", "--table", "5.12"]).contains("1024x1024"));
    assert!(good(&["tables", "--card", "8600gt", "--table", "5.12"]).contains("512x512, P (primary rays), 8600GT"));
    assert!(good(&["tables", "--table", "5.12"]).contains("1024x1024, P (primary rays), GTX280"));
}

#[test]
fn structures_are_listed_with_the_values_that_their_options_take() {
    let text = good(&["structures"]);
    for line in [
        "where the short stack lies (default workgroup)\n                     = workgroup, private\n",
        "entries of the short stack (default 4)\n                     = 1 to 32\n",
        "direction of shadow rays (default from-light)\n                     = from-light, to-light\n",
        "= image, four\n",
        "= off, on\n",
        "= auto, or 1 to 1048576\n",
        "= a number from 0.01 to 1000\n",
        "= 8x8, 8x4, 4x8, 4x4, 16x4, 4x16\n",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
    assert!(text.lines().all(|line| line.chars().count() <= 122), "{text}");
}
