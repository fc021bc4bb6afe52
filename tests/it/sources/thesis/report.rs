//! The report: one page, nothing from outside, everything escaped.

use super::synthetic::{Builder, everything, scene};
use super::tables::{compared, options};
use rtbench::sources::report::{self, Part};
use rtbench::sources::runs::RecordedRun;
use rtbench::sources::thesis::{Numbers, SOURCE};
use rtbench::sources::{Options, Rows};
use rtbench::workloads::trace::backend::Config;

fn page(runs: &[RecordedRun]) -> rtbench::Result<String> {
    page_with(runs, compared())
}

fn page_with(runs: &[RecordedRun], options: Options) -> rtbench::Result<String> {
    report::write(&[Part { source: &SOURCE, results: &Numbers::of(runs), options }], runs)
}

/// Elements that would fetch something.
fn assert_self_contained(html: &str) {
    for (index, _) in html.match_indices("src=\"").chain(html.match_indices("href=\"")) {
        let value = html[index..].split('"').nth(1).unwrap();
        assert!(value.starts_with("data:image/png;base64,") || value.starts_with('#'), "{value}");
    }
    for word in ["<script", "<link", "<iframe", "@import", "url(", "http://", "https://", "srcset", "onload"] {
        assert!(!html.contains(word), "{word}");
    }
}

#[test]
fn everything_is_on_one_page() {
    let runs = everything();
    let html = page(&runs).unwrap();
    assert_self_contained(&html);
    assert_eq!(html, page(&runs).unwrap(), "not the same bytes");
    for id in ["claims", "tables", "figures", "pictures", "differences", "provenance"] {
        assert!(html.contains(&format!("<section id=\"{id}\">")) && html.contains(&format!("href=\"#{id}\"")), "{id}");
    }
    for id in rtbench::sources::thesis::tables::IDS {
        assert!(html.contains(&format!("<h3>Table {id}: ")), "{id}");
    }
    assert!(html.matches("<svg").count() >= 8 && html.matches("<style>").count() == 1);
    assert!(html.contains("Fast GPU") && html.contains("Slow GPU") && html.contains("register limit"));
    // Every element that was opened is closed.
    for tag in ["section", "table", "tr", "td", "div", "figure", "svg", "details", "dl", "p", "h3"] {
        let open = html.matches(&format!("<{tag}>")).count() + html.matches(&format!("<{tag} ")).count();
        assert_eq!(open, html.matches(&format!("</{tag}>")).count(), "{tag}");
    }
    // The published numbers alone are a page as well.
    assert_self_contained(&page_with(&[], options()).unwrap());
    // Two sources on one page: each with its own anchors, the runs' sections once.
    let numbers = Numbers::of(&runs);
    let part = || Part { source: &SOURCE, results: &numbers, options: compared() };
    let html = report::write(&[part(), part()], &runs).unwrap();
    assert!(html.matches("<section id=\"thesis-claims\">").count() == 2 && html.matches("<h1>").count() == 2);
    assert_eq!(html.matches("<section id=\"thesis-provenance\">").count(), 1);
}

#[test]
fn nothing_in_a_record_becomes_markup() {
    let evil = "<script src=x onerror='a'>&\"";
    let mut b = Builder::new().device(evil, rtbench::workloads::trace::backend::DeviceType::DiscreteGpu);
    b.frame("bunny", "grid", Config::P, 64, 1.0).scene = scene(evil);
    b.frame("museum", "bvh", Config::P, 64, 1.0).status = rtbench::record::row::Status::Failed;
    b.run.journal.configurations[1].message = evil.into();
    b.run.journal.provenance.arguments.push(evil.into());
    let html = page(&[b.run]).unwrap();
    assert!(!html.contains("<script") && html.contains("&lt;script"), "{html}");
    // Inside an attribute a quote would be the way out.
    assert!(!html.contains("=\"<") && html.matches("onerror=&#39;").count() > 5);
}

#[test]
fn pictures_are_embedded_and_broken_ones_refused() {
    let folder = tempfile::tempdir().unwrap();
    let pictures = folder.path().join("pictures");
    std::fs::create_dir(&pictures).unwrap();
    for name in ["hall.png", "hall-steps.png", "bunny.png"] {
        rtbench::record::picture::write_png(&pictures.join(name), 2, 1, &[255; 8]).unwrap();
    }
    std::fs::write(pictures.join("notes.txt"), "no picture").unwrap();
    let mut runs = everything();
    runs[0].folder = folder.path().into();
    let html = page(&runs).unwrap();
    assert_eq!(html.matches("src=\"data:image/png;base64,iVBOR").count(), 3);
    assert!(html.contains("alt=\"hall, steps of bvh-stack"), "the structure of a step map is not named");
    assert_self_contained(&html);
    std::fs::write(pictures.join("bad.png"), "GIF89a").unwrap();
    let error = page(&runs).unwrap_err().to_string();
    assert!(error.contains("bad.png: no PNG") && !error.contains('\n'), "{error}");
}

#[test]
fn a_scene_whose_name_begins_another_s_is_shown_once() {
    let folder = tempfile::tempdir().unwrap();
    let pictures = folder.path().join("pictures");
    std::fs::create_dir(&pictures).unwrap();
    for name in ["conference", "conference-obj"] {
        for end in ["", "-steps"] {
            let path = pictures.join(format!("{name}{end}.png"));
            rtbench::record::picture::write_png(&path, 2, 1, &[255; 8]).unwrap();
        }
    }
    let mut runs = everything();
    runs[0].folder = folder.path().into();
    let html = page(&runs).unwrap();
    for name in ["conference", "conference-obj"] {
        assert_eq!(html.matches(&format!("<h3>{name}</h3>")).count(), 1, "{name}");
    }
    assert_eq!(html.matches("<img ").count(), 4);
}

#[test]
fn what_was_not_measured_is_on_the_page() {
    let runs = [everything().remove(0)];
    let html = page(&runs).unwrap();
    assert!(html.contains("what was not measured is empty and named"), "{html}");
    // Scenes and whole tables without a measurement, with the published numbers.
    for id in rtbench::sources::thesis::tables::IDS {
        assert!(html.contains(&format!("<h3>Table {id}: ")), "{id}");
    }
    let table = |html: &str, id: &str| {
        let from = html.find(&format!("<h3>Table {id}: ")).unwrap();
        html[from..from + html[from..].find("</table>").unwrap()].to_owned()
    };
    assert!(
        table(&html, "5.3").contains("<td class=\"key\">buddha</td>") && table(&html, "5.3").contains("<td>2406</td>")
    );
    assert!(table(&html, "B.4").contains("45.19"), "the second device's times");
    assert!(html.contains("Nothing was measured for: 5.7, 5.3.4, B.4, B.5, B.6, simt."));
    // The words change with the rows.
    let html = page_with(&runs, Options { rows: Rows::Measured, ..compared() }).unwrap();
    assert!(html.contains("what was not measured is left out and named") && !html.contains("<h3>Table B.4"));
    assert!(!table(&html, "5.3").contains("buddha"));
}

#[test]
fn what_differs_follows_from_the_records() {
    let page_of = |threads: [usize; 3], turns: [usize; 2]| {
        let mut b = Builder::new();
        for (structure, threads) in ["grid", "kdtree", "bvh"].into_iter().zip(threads) {
            b.built("bunny", structure, 1.0, 1.0, 4).build_threads = threads;
        }
        for (structure, turns) in ["grid", "bvh"].into_iter().zip(turns) {
            b.frame("bunny", structure, Config::P, 64, 1.0).interleaved_with = turns;
        }
        page(&[b.run]).unwrap()
    };
    let alone = page_of([1; 3], [0, 1]);
    assert!(alone.contains("All structures were built on one thread,") && !alone.contains("all cores"), "{alone}");
    assert!(alone.contains("Each row was timed on its own."), "{alone}");
    let threads = page_of([1, 2, 2], [2; 2]);
    assert!(threads.contains("Built on one thread: grid; on 2 threads: BVH, kd-tree. The thesis built"), "{threads}");
    assert!(threads.contains("Passes of several structures were interleaved."), "{threads}");
    assert!(page_of([1; 3], [2, 1]).contains("In 1 of 2 rows passes of several structures were interleaved"));
}
