//! Figures and report, and tables in every format.

use super::synthetic::{Builder, everything, write_run};
use rtbench::report::figure::Figure;
use rtbench::report::format::{self, Format};
use rtbench::sources::Options;
use rtbench::sources::report::{self, Part};
use rtbench::sources::runs::RecordedRun;
use rtbench::sources::splat::SOURCE;
use std::process::Command;

fn page(runs: &[RecordedRun]) -> String {
    let results = (SOURCE.read)(runs);
    let options = Options { published: true, ..Options::default() };
    report::write(&[Part { source: &SOURCE, results: &*results, options }], runs).unwrap()
}

fn count(figure: &Figure, tag: &str) -> usize {
    let document = roxmltree::Document::parse(&figure.svg).unwrap();
    document.descendants().filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", tag))).count()
}

#[test]
fn every_figure_is_drawn_and_those_without_data_are_named() {
    let figures = |runs: &[RecordedRun]| (SOURCE.read)(runs).figures().unwrap();
    let (drawn, missing) = figures(&[everything()]);
    let names: Vec<&str> = drawn.iter().map(|figure| figure.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "figure-5.2",
            "figure-5.1-sponza",
            "figure-5.1-sibenik",
            "figure-5.1-box",
            "frames-sponza",
            "frames-sibenik",
            "frames-box",
            "histogram",
            "quality"
        ]
    );
    assert!(missing.is_empty());
    for figure in &drawn {
        assert!(figure.svg.contains("<title>") && !figure.svg.contains("NaN"), "{}", figure.name);
        assert!(figure.caption.contains("Fast GPU"), "{}", figure.caption);
    }
    assert!(drawn[0].svg.contains("buckets, printed") && drawn[4].svg.contains("assignments"));
    // Eight bands of per-sample and of buckets, which have the same ones
    assert_eq!(count(&drawn[1], "polygon"), 16);
    assert_eq!(figures(&[everything()]).0, drawn);
    let (printed, missing) = figures(&[]);
    assert_eq!(printed.iter().map(|figure| figure.id).collect::<Vec<_>>(), ["5.2"]);
    assert_eq!(missing.len(), 4);
    let mut b = Builder::new();
    let row = b.row("sponza", "per-sample", &[]);
    row.samples.as_mut().unwrap().stage_ns = None;
    row.metrics.clear();
    assert_eq!(figures(&[b.run()]).1.iter().map(|m| m.id).collect::<Vec<_>>(), ["5.2", "5.1", "histogram", "quality"]);
}

#[test]
fn the_page_has_everything_of_a_run() {
    let run = everything();
    let rows = run.general.rows.len();
    let html = page(&[run]);
    for words in [
        "The thesis on photon splatting, measured anew",
        "Table 5.2",
        "Table options",
        "What differs from the thesis, and why",
        "<dt>GenClusterKeys</dt><dd>C: keys and flags; here <code>keys</code></dd>",
        "the capacity is 1,000",
        &format!("{rows} rows, 1 without a result"),
    ] {
        assert!(html.contains(words), "{words}");
    }
    assert!(!html.contains("NaN") && !html.contains(">inf"));
    assert!(page(&[]).contains("The thesis on photon splatting, as printed"));
    let mut evil = Builder::new();
    evil.row("<script src=x>", "per-sample", &[]);
    assert!(!page(&[evil.run()]).contains("<script"));
    let warned = page(&[{
        let mut b = Builder::software();
        b.row("sponza", "buckets", &[]);
        b.run()
    }]);
    assert!(warned.contains("In place of a GPU: Fast GPU"));
}

#[test]
fn tables_have_every_format_and_a_terminal_s_width() {
    let results = (SOURCE.read)(&[everything()]);
    let printed = (SOURCE.read)(&[]);
    for published in [false, true] {
        let options = Options { published, ..Options::default() };
        for results in [&results, &printed] {
            let tables = results.tables(SOURCE.tables, &options);
            for (form, widest) in
                [(Format::Text, 150), (Format::Markdown, 1000), (Format::Csv, 1000), (Format::Latex, 1000)]
            {
                let text = format::write(&tables, form);
                assert!(!text.contains("NaN") && !text.contains("inf,"), "{form:?}");
                let wide = text.lines().find(|line| line.chars().count() > widest);
                assert!(wide.is_none(), "{wide:?}");
            }
        }
    }
}

#[test]
fn the_command_shows_a_run_of_this_workload() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    write_run(&everything(), &run);
    let output = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_rtbench")).args(arguments).arg(&run).output().unwrap();
        (output.status.code(), String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    let (code, text, _) = output(&["tables", "--table", "5.2,options"]);
    assert!(code == Some(0) && text.contains("Table 5.2: Mean frame by groups of stages, Fast GPU"), "{text}");
    let (code, text, _) = output(&["claims"]);
    assert!(code == Some(0) && text.contains("Claims of the thesis on photon splatting, judged by 1 run"), "{text}");
    let (code, _, error) = output(&["tables", "--device", "GTX280"]);
    assert!(code == Some(2) && error.contains("NVIDIA RTX 2080"), "{error}");
}
