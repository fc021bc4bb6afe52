//! Reading and comparing runs of many rows. `cargo bench --bench journals` writes journals of 10,000 and 100,000 rows
//! into a temporary folder (about a gigabyte) and prints seconds; the bars are 1 s and 10 s for comparing two of them.

#![allow(missing_docs)]

#[path = "../tests/it/journals.rs"]
mod journals;

use journals::{Generated, write};
use rtbench::compare::conditions::ComparedRun;
use rtbench::compare::runs::{self, Options, Side};
use rtbench::record::stream::{LeanRun, Names};
use rtbench::sources;
use rtbench::sources::runs::RecordedRun;
use std::path::Path;
use std::time::Instant;

fn compare(folders: [&Path; 2]) -> usize {
    let mut names = Names::default();
    let read = |folder: &Path, names: &mut Names| ComparedRun::new(LeanRun::read(folder, names).expect("a run"));
    let runs = folders.map(|folder| read(folder, &mut names)).into();
    let sides = vec![Side { name: "old".into(), runs: vec![0] }, Side { name: "new".into(), runs: vec![1] }];
    let options = Options { margin_pct: runs::MARGIN_PCT, ..Options::default() };
    let comparison = runs::compare(&mut names, runs, sides, &options).expect("equal conditions");
    assert!(comparison.changes.is_empty());
    comparison.rows.len()
}

fn tables(folder: &Path) -> usize {
    let runs = [RecordedRun::read(folder).expect("a run")];
    let source = sources::ALL[0];
    let results = (source.read)(&runs);
    results.tables(source.tables, &sources::Options::default()).len()
}

fn main() {
    let sizes: &[usize] =
        if std::env::args().any(|arg| arg == "--bench") { &[10_000, 20_000, 100_000] } else { &[300] };
    let folder = tempfile::tempdir().expect("a folder");
    for &rows in sizes {
        let paths = ["old", "new"].map(|name| folder.path().join(format!("{name}-{rows}")));
        paths.iter().for_each(|path| write(path, &Generated::new(rows)));
        let start = Instant::now();
        let compared = compare([&paths[0], &paths[1]]);
        println!("compare 2 x {rows} rows: {:.2} s", start.elapsed().as_secs_f64());
        assert_eq!(compared, rows);
        if rows <= 20_000 {
            let start = Instant::now();
            tables(&paths[0]);
            println!("tables {rows} rows: {:.2} s", start.elapsed().as_secs_f64());
        }
        paths.iter().for_each(|path| std::fs::remove_dir_all(path).expect("a folder"));
    }
}
