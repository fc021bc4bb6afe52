//! The committed runs are complete, and every document of them (tables, claims, figures, what the README shows) is what
//! it was when it was last looked at.

use rtbench::record::row::Status;
use rtbench::report::format::{self, Format};
use rtbench::sources::Options;
use rtbench::sources::claims::{self, Form};
use rtbench::sources::runs::RecordedRun;
use rtbench::sources::thesis::SOURCE;
use rtbench::workloads::trace::record;
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
        let RecordedRun { journal, general, .. } = RecordedRun::read(&run).unwrap();
        assert!(!general.rows.is_empty() && general.truncated.is_none(), "{}", run.display());
        for row in general.rows.iter().filter(|row| row.key.workload != record::WORKLOAD) {
            // Half precision that is emulated has a picture and no time
            let is_half = row.key.axis("precision") == "f16" && row.status == Status::Skipped;
            assert!(row.status == Status::Ok || is_half, "{} {:?}: {}", run.display(), row.key, row.message);
        }
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
        let journal = record::read(&run.join("journal.jsonl")).unwrap();
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
        .args(["tables", SHOWN, "--published", "--table", "5.4", "--rows", "measured", "--into"])
        .arg(readme)
        .arg("--check");
    command.current_dir(root()).output().unwrap().status.success()
}

#[test]
fn the_readme_shows_their_table() {
    assert!(
        check_table(&root().join("README.md")),
        "run: rtbench tables {SHOWN} --published --table 5.4 --rows measured --into README.md"
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

/// Documents of committed runs, by the first half of their BLAKE3 hash. A change of these is a change of results or of
/// words in them: compare the outputs of both programs before a new hash is put here.
const DOCUMENTS: [(&str, &str, &str); 12] = [
    ("lavapipe-2core-2026-11-29", "tables as text", "027a56af30590c622531c7baf77d27f9"),
    ("lavapipe-2core-2026-11-29", "tables as CSV", "0c7e00b7b0ed54a488ae367f3380b663"),
    ("lavapipe-2core-2026-11-29", "tables with published numbers as text", "7d34f8ae10b2523f6da64e57c5f7d4bc"),
    ("lavapipe-2core-2026-11-29", "tables with published numbers as CSV", "6811df76bf8317eb90557bbc7b6de0bf"),
    ("lavapipe-2core-2026-11-29", "claims as JSON", "b09aacc434d230c0386282d92170258b"),
    ("lavapipe-2core-2026-11-29", "figures", "84bf6e6bde41d255cab2cec6190ef79b"),
    ("scenes-2026-11-29", "tables as text", "c11b418308c7f0a0e23089910f58fba0"),
    ("scenes-2026-11-29", "tables as CSV", "9fdbb6063919dee7eba347cef39e7405"),
    ("scenes-2026-11-29", "tables with published numbers as text", "eea32d80647749180fee6953b486a708"),
    ("scenes-2026-11-29", "tables with published numbers as CSV", "6446bf3b1065b4fbe84b945f831fbac9"),
    ("scenes-2026-11-29", "claims as JSON", "17d4dcbf595ddc6dad65af81e7a32439"),
    ("scenes-2026-11-29", "figures", "6fb5a091da2cf39fc3974a936f6bdeca"),
];

fn read(run: &str) -> RecordedRun {
    RecordedRun::read(&root().join("results").join(run)).unwrap()
}

/// The documents of a run: name and text.
fn documents(run: RecordedRun) -> Vec<(&'static str, String)> {
    let results = (SOURCE.read)(&[run]);
    let tables = |published, format| {
        let options = Options { published, ..Options::default() };
        format::write(&results.tables(SOURCE.tables, &options), format)
    };
    let figures = results.figures().unwrap().0.into_iter().map(|figure| format!("{}\n{}\n", figure.name, figure.svg));
    vec![
        ("tables as text", tables(false, Format::Text)),
        ("tables as CSV", tables(false, Format::Csv)),
        ("tables with published numbers as text", tables(true, Format::Text)),
        ("tables with published numbers as CSV", tables(true, Format::Csv)),
        ("claims as JSON", claims::write(&[results.claims(&Default::default())], "1 run", Form::Json)),
        ("figures", figures.collect()),
    ]
}

fn hash(text: &str) -> String {
    blake3::hash(text.as_bytes()).to_hex()[..32].to_owned()
}

#[test]
fn their_documents_have_not_changed() {
    let mut differing = Vec::new();
    for run in ["lavapipe-2core-2026-11-29", "scenes-2026-11-29"] {
        for (name, text) in documents(read(run)) {
            let recorded = DOCUMENTS.iter().find(|(of, document, _)| (*of, *document) == (run, name));
            if recorded.is_none_or(|(.., recorded)| *recorded != hash(&text)) {
                differing.push(format!("(\"{run}\", \"{name}\", \"{}\"),", hash(&text)));
            }
        }
    }
    assert!(differing.is_empty(), "other documents than recorded:\n{}", differing.join("\n"));
    // Other times in the records change the tables, and no figure
    let name = "lavapipe-2core-2026-11-29";
    let mut run = read(name);
    run.journal.structures.iter_mut().for_each(|structure| structure.build_ms *= 2.0);
    for (document, text) in documents(run) {
        let same = DOCUMENTS.contains(&(name, document, &hash(&text)));
        assert!(document == "claims as JSON" || same == (document == "figures"), "{document}");
    }
}
