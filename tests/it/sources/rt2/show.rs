//! Figures and report.

use super::synthetic::{Builder, everything};
use crate::sources::synthetic::write_run;
use rtbench::sources::Options;
use rtbench::sources::report::{self, Part};
use rtbench::sources::rt2::SOURCE;
use rtbench::sources::rt2::structures::STACK;

#[test]
fn three_bar_charts_and_the_steps_are_drawn() {
    let (figures, missing) = (SOURCE.read)(&[everything()]).figures().unwrap();
    let names: Vec<&str> = figures.iter().map(|f| f.name.as_str()).collect();
    assert_eq!((names, missing.len()), (vec!["figure-4.4", "figure-4.5", "figure-4.6", "steps-per-ray"], 0));
    for (figure, bars) in figures.iter().zip([4, 3, 3, 4]) {
        let document = roxmltree::Document::parse(&figure.svg).unwrap();
        let words: Vec<String> = document
            .descendants()
            .filter(|n| n.has_tag_name(("http://www.w3.org/2000/svg", "text")))
            .filter_map(|n| n.text())
            .map(|t| t.trim().to_owned())
            .collect();
        let has = |word: &str| words.iter().any(|w| w == word);
        assert!(["scan 32 k", "spiky scan 108 k", "dragon 871 k", "room 78 k"].into_iter().all(has), "{words:?}");
        // A bar of each structure for each of six scenes, and one in the legend; the ground is one more.
        let rectangles =
            document.descendants().filter(|n| n.has_tag_name(("http://www.w3.org/2000/svg", "rect"))).count();
        assert!(rectangles > 7 * bars, "{}: {rectangles}", figure.name);
    }
    assert_eq!((SOURCE.read)(&[everything()]).figures().unwrap().0, figures, "not the same bytes");
}

#[test]
fn a_figure_without_data_is_named() {
    let (figures, missing) = (SOURCE.read)(&[]).figures().unwrap();
    assert_eq!(
        (figures.len(), missing.iter().map(|m| m.id).collect::<Vec<_>>()),
        (0, vec!["4.4", "4.5", "4.6", "steps"])
    );
    let mut b = Builder::new();
    b.shot("alien", &STACK, 1.0);
    let (figures, missing) = (SOURCE.read)(&[b.run]).figures().unwrap();
    assert_eq!(figures.iter().map(|f| f.id).collect::<Vec<_>>(), ["4.4", "steps"]);
    assert!(missing.iter().all(|m| m.needs.contains("its own numbers are in no text")), "{missing:?}");
}

#[test]
fn everything_is_on_one_page() {
    let runs = [everything()];
    let page = |runs: &[_]| {
        let results = (SOURCE.read)(runs);
        let options = Options { published: true, ..Options::default() };
        report::write(&[Part { source: &SOURCE, results: &*results, options }], runs).unwrap()
    };
    let html = page(&runs);
    for words in [
        "The thesis of 2010 on RT2, measured anew",
        "<h3>Table 4.4: ",
        "<h3>Table 4.5: ",
        "<h3>Table 4.6: ",
        "What differs from 2010, and why",
        "greatest depth 440",
        "<td class=\"words\">ropes, kd, BVH</td>",
    ] {
        assert!(html.contains(words), "{words}");
    }
    assert_eq!(html.matches("<svg").count(), 4);
    for tag in ["section", "table", "tr", "td", "figure", "dl", "p"] {
        let open = html.matches(&format!("<{tag}>")).count() + html.matches(&format!("<{tag} ")).count();
        assert_eq!(open, html.matches(&format!("</{tag}>")).count(), "{tag}");
    }
    let html = page(&[]);
    assert!(
        html.contains("as printed") && html.contains("results/rt2-2010") && html.contains("is not drawn"),
        "{html}"
    );
}

#[test]
fn the_program_shows_the_source() {
    let run = |arguments: &[&str]| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_rtbench")).args(arguments).output().unwrap();
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    assert!(run(&["tables", "--source", "rt2", "--table", "4.6"]).contains("BVH, kd,"));
    assert!(run(&["claims", "--source", "rt2"]).contains("Claims of the thesis of 2010, judged by the numbers"));
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("run");
    write_run(&everything(), &journal);
    let text = run(&["tables", journal.to_str().unwrap(), "--published"]);
    assert!(text.contains("Table 4.4") && !text.contains("Table 5.4"), "{text}");
    let figures = folder.path().join("figures");
    assert_eq!(run(&["figures", journal.to_str().unwrap(), "-o", figures.to_str().unwrap()]).lines().count(), 4);
}
