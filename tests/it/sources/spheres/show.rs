//! Figures and report, and tables in every format.

use super::synthetic::{Builder, everything, write_run};
use rtbench::report::Cell;
use rtbench::report::format::{self, Format};
use rtbench::sources::Options;
use rtbench::sources::report::{self, Part};
use rtbench::sources::runs::RecordedRun;
use rtbench::sources::spheres::SOURCE;
use std::process::Command;

fn page(runs: &[RecordedRun]) -> String {
    let results = (SOURCE.read)(runs);
    let options = Options { published: true, ..Options::default() };
    report::write(&[Part { source: &SOURCE, results: &*results, options }], runs).unwrap()
}

#[test]
fn every_figure_is_drawn_and_those_without_data_are_named() {
    let figures = |runs: &[RecordedRun]| (SOURCE.read)(runs).figures().unwrap();
    let (drawn, missing) = figures(&[everything()]);
    let names: Vec<&str> = drawn.iter().map(|figure| figure.name.as_str()).collect();
    assert_eq!(names, ["times", "speed-up", "threads", "lanes", "spheres"]);
    assert!(missing.is_empty());
    for figure in &drawn {
        assert!(figure.svg.contains("<title>") && !figure.svg.contains("NaN"), "{}", figure.name);
        assert!(figure.caption.contains("64x32") && figure.caption.contains("Test CPU"), "{}", figure.caption);
    }
    assert!(drawn[2].svg.contains("ideal") && drawn[1].svg.contains("printed"));
    assert_eq!(figures(&[everything()]).0, drawn);
    let (printed, missing) = figures(&[]);
    assert_eq!(printed.iter().map(|figure| figure.id).collect::<Vec<_>>(), ["times", "spheres"]);
    assert_eq!(missing.len(), 3);
    let mut b = Builder::new();
    b.row("default", "sequential two-pass", 1.0);
    assert_eq!(
        figures(&[b.run()]).1.iter().map(|m| m.id).collect::<Vec<_>>(),
        ["speed-up", "threads", "lanes", "spheres"]
    );
}

#[test]
fn the_page_has_everything_of_a_run() {
    let folder = tempfile::tempdir().unwrap();
    let pictures = folder.path().join("pictures");
    std::fs::create_dir(&pictures).unwrap();
    for name in ["default.png", "default-half.png", "random20.png"] {
        rtbench::record::picture::write_png(&pictures.join(name), 2, 1, &[255; 8]).unwrap();
    }
    let mut run = everything();
    run.folder = folder.path().into();
    let rows = run.general.rows.len();
    let html = page(&[run]);
    let failed = 4;
    for words in [
        "The term paper on spheres, measured anew",
        "Table metrics",
        "Table switches",
        "What differs from the paper, and why",
        "<h3>default</h3>",
        "alt=\"default, in half precision",
        "8 threads x 4 lanes",
        "device lost",
        "Measured here: avx2, x86_64 sse2",
        &format!("{rows} rows, {failed} without a result"),
    ] {
        assert!(html.contains(words), "{words}");
    }
    // A picture of a scene is no step map, which only a sweep renders
    assert!(!html.contains("steps of bvh-stack") && html.matches("<img ").count() == 3);
    assert!(!html.contains("NaN") && !html.contains(">inf"));
    assert!(page(&[]).contains("The term paper on spheres, as printed"));
    let mut evil = Builder::new();
    evil.row("<script src=x>", "sequential two-pass", 1.0).metrics.push(rtbench::record::row::Metric::new("x", 1u64));
    assert!(!page(&[evil.run()]).contains("<script"));
}

#[test]
fn metrics_without_sense_are_words() {
    let mut b = Builder::new();
    b.general.provenance.devices[0].info.threads = Some(1);
    b.row("default", "sequential two-pass", 10.0);
    b.row("default", "threads two-pass threads=1", 11.0);
    b.row("default", "simd:4 two-pass", 2.0);
    b.row("default", "gpu two-pass", 1.0);
    let run = b.run();
    let of = |processors| {
        let options = Options { processors, ..Options::default() };
        (SOURCE.read)(std::slice::from_ref(&run)).tables(&["metrics"], &options).remove(0)
    };
    let remarks = |processors| {
        let table = of(processors);
        let of_row = |row: &rtbench::report::Row| (row.keys[2].clone(), row.cells[3].clone(), row.cells[4].clone());
        table.rows.iter().map(of_row).collect::<Vec<_>>()
    };
    let words = |text: &str| Cell::Words { value: Some(text.to_owned()), published: None };
    let found = remarks(None);
    let at = |name: &str| found.iter().find(|row| row.0 == name).unwrap_or_else(|| panic!("{name}: {found:?}"));
    for (name, remark) in [("sequential", "p = 1"), ("threads", "p = 1"), ("GPU", "p unknown")] {
        assert_eq!((&at(name).1, &at(name).2), (&Cell::number(None), &words(remark)), "{name}");
    }
    // Faster than four lanes: less than nothing is serial
    assert_eq!(at("SIMD").2, words("S > p"));
    assert!(matches!(at("SIMD").1, Cell::Number { value: Some(e), .. } if e.value < 0.0));
    let gpu = remarks(Some(16)).into_iter().find(|row| row.0 == "GPU").unwrap();
    assert!(matches!(gpu.1, Cell::Number { value: Some(e), .. } if (e.value - 0.04).abs() < 1e-9), "{gpu:?}");
}

#[test]
fn tables_have_every_format_and_a_terminal_s_width() {
    let results = (SOURCE.read)(&[everything()]);
    for published in [false, true] {
        let options = Options { published, ..Options::default() };
        let tables = results.tables(SOURCE.tables, &options);
        for (form, widest) in
            [(Format::Text, 140), (Format::Markdown, 1000), (Format::Csv, 1000), (Format::Latex, 1000)]
        {
            let text = format::write(&tables, form);
            assert!(!text.contains("NaN") && !text.contains("inf,"), "{form:?}");
            let wide = text.lines().find(|line| line.chars().count() > widest);
            assert!(wide.is_none(), "{wide:?}");
        }
        let work = tables.iter().find(|table| table.title.starts_with("Tests, lanes")).unwrap();
        let simd = work.rows.iter().find(|row| row.keys[2] == "SIMD").unwrap();
        let values: Vec<f64> = simd
            .cells
            .iter()
            .filter_map(|cell| match cell {
                Cell::Number { value, .. } => value.map(|v| v.value),
                _ => None,
            })
            .collect();
        // 3000 live rays of 3 spheres in 2 frames; 1000 of 4000 searches wasted; 512 exits of 16 x 32 x 2 vectors
        assert_eq!(values, [4500.0, 0.25, 0.75, 0.5, 0.6, 0.5]);
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
    let (code, text, _) = output(&["tables", "--table", "4,metrics", "--processors", "512"]);
    assert_eq!(code, Some(0));
    assert!(text.contains("Table 4: Mean time per frame, one-pass + exits, 64x32") && text.contains("--processors"));
    let (code, text, _) = output(&["claims"]);
    assert!(code == Some(0) && text.contains("Claims of the term paper, judged by 1 run"), "{text}");
    let (code, _, error) = output(&["claims", "--processors", "0"]);
    assert!(code == Some(2) && error.contains("--processors"), "{error}");
    let (code, _, error) = output(&["tables", "--device", "M1"]);
    assert!(code == Some(2) && error.contains("spheres published times of no device"), "{error}");
}
