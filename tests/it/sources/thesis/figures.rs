//! Figures: well-formed XML, what is drawn and what is not.

use super::synthetic::{Builder, everything};
use rtbench::report::figure::Figure;
use rtbench::sources::thesis::figures::all;
use rtbench::sources::thesis::{measured, published};
use rtbench::workloads::trace::backend::Config;

fn count(figure: &Figure, tag: &str) -> usize {
    let document = roxmltree::Document::parse(&figure.svg).unwrap();
    document.descendants().filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", tag))).count()
}

#[test]
fn everything_that_has_data_is_drawn_as_xml() {
    let (figures, missing) = all(&measured::data(&everything())).unwrap();
    assert!(missing.is_empty(), "{missing:?}");
    for id in ["5.1", "5.2", "5.3", "5.4", "bars"] {
        assert!(figures.iter().any(|f| f.id == id), "{id}");
    }
    let mut names: Vec<&str> = figures.iter().map(|f| f.name.as_str()).collect();
    for figure in &figures {
        assert!(count(figure, "text") > 5 && count(figure, "title") == 1, "{}", figure.name);
        assert!(figure.svg.contains("prefers-color-scheme:dark") && figure.svg.contains("fill=\"#FFFFFF\""));
        // Units on the axis of time.
        assert!(figure.svg.contains("[ms]"), "{}", figure.name);
    }
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), figures.len(), "two figures of the same name");
    // Figure 5.1 has a line with three points and a ring around the rule's.
    let figure = figures.iter().find(|f| f.id == "5.1").unwrap();
    assert_eq!((count(figure, "circle"), count(figure, "polygon")), (1, 3 + 1), "{}", figure.svg);
    // 5.4: two numbers of tiles and the whole image, three sizes each, with a legend.
    let figure = figures.iter().find(|f| f.id == "5.4").unwrap();
    assert!(figure.svg.contains("whole image") && figure.svg.contains("4x4 tiles"));
    assert_eq!(all(&measured::data(&everything())).unwrap().0, figures, "not the same bytes");
}

#[test]
fn a_figure_without_data_is_named() {
    let (figures, missing) = all(&published::data()).unwrap();
    assert_eq!(missing.iter().map(|m| m.id).collect::<Vec<_>>(), ["5.1", "5.3", "5.4"]);
    // Both devices, three configurations: 5.2 and bars.
    assert_eq!(figures.len(), 12);
    // Plain names are those of the device that the thesis shows: figure 5.2 is of tables B.4 to B.6.
    let title = |name: &str| {
        let figure = figures.iter().find(|f| f.name == name).unwrap_or_else(|| panic!("no {name}"));
        let document = roxmltree::Document::parse(&figure.svg).unwrap();
        let title = document.descendants().find(|n| n.has_tag_name(("http://www.w3.org/2000/svg", "title")));
        title.unwrap().text().unwrap().to_owned()
    };
    for (name, device) in [
        ("figure-5.2-p", "8600GT"),
        ("figure-5.2-psr", "8600GT"),
        ("figure-5.2-p-gtx280", "GTX280"),
        ("frame-times-p", "GTX280"),
        ("frame-times-p-8600gt", "8600GT"),
    ] {
        assert!(title(name).contains(device), "{name}: {}", title(name));
    }
    let mut b = Builder::new();
    b.frame("bunny", "grid", Config::P, 64, 1.0).verified = false;
    let (figures, missing) = all(&measured::data(&[b.run])).unwrap();
    assert_eq!((figures.len(), missing.len()), (0, 5));
}

#[test]
fn odd_names_and_numbers_do_not_break_a_figure() {
    for ms in [1e-6, 1.0, 1e9] {
        let mut b =
            Builder::new().device("<GPU> & \"co\"", rtbench::workloads::trace::backend::DeviceType::DiscreteGpu);
        b.frame("a<b>&c", "grid", Config::P, 64, ms);
        b.frame("a<b>&c", "grid", Config::P, 128, ms);
        let (figures, _) = all(&measured::data(&[b.run])).unwrap();
        assert_eq!(figures.len(), 2);
        assert!(figures.iter().all(|f| count(f, "text") > 3));
    }
}

#[test]
fn the_fine_sweep_has_only_sizes_of_both_its_lines() {
    let mut b = Builder::new();
    for side in [224, 240, 256] {
        b.frame("bunny", "grid:pattern=four", Config::P, side, 5.0);
    }
    for side in [128, 224, 240, 256, 384] {
        b.frame("bunny", "grid", Config::P, side, 6.0);
    }
    let (figures, _) = all(&measured::data(&[b.run])).unwrap();
    let figure = figures.iter().find(|f| f.id == "5.3").unwrap();
    let document = roxmltree::Document::parse(&figure.svg).unwrap();
    let words: Vec<String> = document
        .descendants()
        .filter(|n| n.has_tag_name(("http://www.w3.org/2000/svg", "text")))
        .map(|n| n.text().unwrap_or_default().trim().to_owned())
        .collect();
    let has = |word: &str| words.iter().any(|w| w == word);
    assert!(has("grid, four rays") && has("grid, image") && has("224") && has("256"), "{words:?}");
    assert!(!has("128") && !has("384"), "{words:?}");
}

#[test]
fn bars_stand_at_a_published_size() {
    let mut b = Builder::new();
    for scene in ["bunny", "museum"] {
        b.trio(scene, Config::P, 128, [3.0, 2.0, 1.0]);
        b.frame(scene, "bvh-stack", Config::P, 128, 1.0);
        b.trio(scene, Config::P, 256, [3.0, 2.0, 1.0]);
    }
    let (figures, _) = all(&measured::data(&[b.run])).unwrap();
    let bars = figures.iter().find(|f| f.id == "bars").unwrap();
    assert!(bars.caption.contains("256x256"), "{}", bars.caption);
}
