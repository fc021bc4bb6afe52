//! The committed runs are whole, and what the README shows of them is what the program makes of them.

use rtbench::record::journal::Journal;
use rtbench::record::schema::Status;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

const PROGRAM: &str = env!("CARGO_BIN_EXE_rtbench");

/// The run that the README shows.
const SHOWN: &str = "results/lavapipe-2core-2026-11-29";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Folders below `results/` that hold a journal and are kept in git.
fn committed() -> Vec<PathBuf> {
    let ignore = std::fs::read_to_string(root().join(".gitignore")).unwrap();
    let kept =
        ignore.lines().filter_map(|line| line.strip_prefix("!/results/")).map(|name| root().join("results").join(name));
    kept.filter(|folder| folder.join("journal.jsonl").exists()).collect()
}

#[test]
fn every_row_is_verified() {
    let runs = committed();
    assert!(runs.contains(&root().join(format!("{SHOWN}/"))), "{runs:?}");
    for run in runs {
        let journal = Journal::read(&run.join("journal.jsonl")).unwrap();
        assert!(!journal.configurations.is_empty() && journal.truncated.is_none(), "{}", run.display());
        for record in journal.configurations {
            let name = format!("{} {} {} {:?}", run.display(), record.scene.name, record.structure, record.config);
            assert!(record.verified && record.status == Status::Ok, "{name}");
        }
    }
}

/// A reader that makes another scene of the same file leaves a run behind that nobody can repeat.
#[test]
fn their_scenes_are_what_is_read_today() {
    let Some(folder) = std::env::var_os("RTBENCH_SCENES").filter(|folder| !folder.is_empty()) else {
        eprintln!("NOT RUN: set RTBENCH_SCENES to the folder of scenes");
        return;
    };
    let mut scenes: BTreeMap<String, String> = BTreeMap::new();
    for run in committed() {
        let journal = Journal::read(&run.join("journal.jsonl")).unwrap();
        scenes.extend(journal.structures.into_iter().map(|s| (s.scene.name, s.scene.hash)));
    }
    assert!(scenes.len() >= 9, "{scenes:?}");
    for (name, hash) in scenes {
        let scene = rtbench::scene::load_in(&name, Some(Path::new(&folder))).unwrap();
        assert_eq!(scene.content_hash(), hash, "{name} has changed: record the committed runs again");
    }
}

#[test]
fn no_path_of_the_machine_is_in_them() {
    for run in committed() {
        let text = std::fs::read_to_string(run.join("journal.jsonl")).unwrap();
        for start in ["\"/", "=/", " /home", " /root"] {
            assert!(!text.contains(start), "{}: {start}", run.display());
        }
    }
}

/// `rtbench tables` says so if the README's table is another one.
fn check_table(readme: &Path) -> bool {
    let mut command = Command::new(PROGRAM);
    command
        .args(["tables", SHOWN, "--beside", "thesis", "--table", "5.4", "--rows", "measured", "--into"])
        .arg(readme)
        .arg("--check");
    command.current_dir(root()).output().unwrap().status.success()
}

#[test]
fn the_readme_shows_their_table() {
    assert!(
        check_table(&root().join("README.md")),
        "run: rtbench tables {SHOWN} --beside thesis --table 5.4 --rows measured --into README.md"
    );
    // Seen to fail on a README with another number in the table
    let folder = tempfile::tempdir().unwrap();
    let copy = folder.path().join("README.md");
    let text = std::fs::read_to_string(root().join("README.md")).unwrap();
    let (before, table) = text.split_once("<!-- rtbench:5.4 -->").unwrap();
    std::fs::write(&copy, format!("{before}<!-- rtbench:5.4 -->{}", table.replacen("83", "84", 1))).unwrap();
    assert!(!check_table(&copy));
}

#[test]
fn their_figures_are_what_the_program_draws() {
    let folder = tempfile::tempdir().unwrap();
    let output = Command::new(PROGRAM)
        .args(["figures", SHOWN, "--output"])
        .arg(folder.path())
        .current_dir(root())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let kept = root().join(SHOWN).join("figures");
    let mut names: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    names.sort();
    assert!(!names.is_empty());
    for name in &names {
        let read = |folder: &Path| std::fs::read_to_string(folder.join(name)).unwrap_or_default();
        let same = read(&kept) == read(folder.path());
        assert!(same, "{name:?} differs; run: rtbench figures {SHOWN} -o {SHOWN}/figures");
    }
    let readme = std::fs::read_to_string(root().join("README.md")).unwrap();
    assert!(names.iter().any(|name| readme.contains(&format!("{SHOWN}/figures/{}", name.to_string_lossy()))));
}
