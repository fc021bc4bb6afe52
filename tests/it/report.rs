//! Tables in every format for a source of any name, and documents with parts that a command writes.

use rtbench::report::figure::{Axis, Band, Figure, Panel, Picture};
use rtbench::report::format::{self, Format};
use rtbench::report::splice::{Need, splice};
use rtbench::report::{Cell, Column, Form, Number, Origin, Row, Table, html, wrap};
use std::path::Path;

/// A table of a source that is not in the program: one row with a measured and a published number, one with neither.
fn table() -> Table {
    let compared = Cell::Number { value: Some(3.0.into()), published: Some(Number { value: 1.5, places: Some(1) }) };
    Table {
        origin: Origin { source: "other", kind: "list", published: "1999" },
        id: "7".into(),
        title: "Speeds".into(),
        keys: vec!["scene".into()],
        columns: vec![Column::of("tree", "rate", "Mrays/s", Form::Fixed(2)), Column::new("name", "", Form::Whole)],
        rows: vec![
            Row { keys: vec!["hall".into()], cells: vec![compared, Cell::Text("a name".into())] },
            Row { keys: vec!["scan".into()], cells: vec![Cell::number(None), Cell::number(2.0)] },
        ],
        notes: vec!["A note.".into()],
        with_published: true,
        is_published: false,
    }
}

#[test]
fn the_caller_names_the_source_and_its_values() {
    let write = |format| format::write(&[table()], format);
    let text = write(Format::Text);
    assert!(text.starts_with("Table 7: Speeds\n") && text.ends_with("  A note.\n"), "{text}");
    let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
    for line in [&["hall", "run", "3.00", "a", "name"][..], &["1999", "1.5", "-"], &["ratio", "2.00", "-"]] {
        assert!(lines.iter().any(|l| l == line), "{line:?}: {text}");
    }
    let csv = write(Format::Csv);
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines[0], "source,table,title,row,detail,column,unit,value,published,ratio");
    assert_eq!(lines[1], "other,7,Speeds,hall,,tree rate,Mrays/s,3,1.5,2");
    assert_eq!(lines[3], "other,7,Speeds,scan,,tree rate,Mrays/s,,,");
    assert!(write(Format::Latex).contains("\\caption{Speeds (other list 7)}"));
    assert!(write(Format::Markdown).contains("| 1999 | 1.5 | – |"));
    let page = html::table(&table());
    assert!(page.contains("<tr class=\"published\"><td class=\"key\"></td><td class=\"key\">1999</td>"), "{page}");
}

#[test]
fn published_numbers_are_in_their_own_column() {
    let published = Table { is_published: true, with_published: false, ..table() };
    let csv = format::write(&[published], Format::Csv);
    assert!(csv.contains("other,7,Speeds,hall,,tree rate,Mrays/s,,3,"), "{csv}");
}

#[test]
fn words_and_gains_are_compared_without_a_ratio() {
    let words = Cell::Words { value: Some("a, b".into()), published: Some("b, a".into()) };
    let gain = Cell::Number { value: Some(30.0.into()), published: Some(15.0.into()) };
    let none = Cell::Words { value: None, published: Some("b, a".into()) };
    assert!(words.is_filled() && words.has_published() && !none.is_filled() && none.has_published());
    let table = Table {
        columns: vec![Column::new("order", "", Form::Whole), Column::new("gain", "%", Form::Gain)],
        rows: vec![
            Row { keys: vec!["hall".into()], cells: vec![words, gain] },
            Row { keys: vec!["scan".into()], cells: vec![none, Cell::number(None)] },
        ],
        ..table()
    };
    let csv = format::write(std::slice::from_ref(&table), Format::Csv);
    for line in ["hall,,order,,\"a, b\",\"b, a\",", "hall,,gain,%,30,15,", "scan,,order,,,\"b, a\",", "scan,,gain,%,,,"]
    {
        assert!(csv.lines().any(|l| l.ends_with(line)), "{line}: {csv}");
    }
    let text = format::write(std::slice::from_ref(&table), Format::Markdown);
    for line in
        ["| hall | run | a, b | 30 |", "|  | 1999 | b, a | 15 |", "| scan | run | – | – |", "|  | 1999 | b, a | – |"]
    {
        assert!(text.lines().any(|l| l == line), "{line}: {text}");
    }
    assert!(html::table(&table).contains("<td class=\"words\">a, b</td>"));
}

#[test]
fn text_is_broken_at_spaces() {
    let text = wrap::wrap(&"word ".repeat(60), "  ");
    assert!(text.lines().all(|line| line.starts_with("  word") && line.len() <= 100), "{text}");
    assert_eq!(text.split_whitespace().count(), 60);
    let long = "x".repeat(150);
    assert_eq!(wrap::wrap(&format!("a {long} b"), ""), format!("a\n{long}\nb\n"));
}

#[test]
fn markers_come_in_pairs() {
    let path = Path::new("doc.md");
    let block = [("x".to_owned(), "new".to_owned())];
    let error = |text: &str| splice(path, text, &block, Need::All).unwrap_err().to_string();
    assert!(error("<!-- rtbench:x -->\n").contains("doc.md:1: 'x' begins and does not end"));
    assert!(error("\n<!-- /rtbench:x -->\n").contains("doc.md:2: 'x' ends and has not begun"));
    assert!(error("<!-- rtbench:x -->\n<!-- rtbench:y -->\n").contains("doc.md:2: 'y' begins before 'x' ends"));
    assert!(error("no markers").contains("no place for x"));
    // Windows line ends stay; other parts are left alone; every place of a block is filled.
    let text = "a\r\n<!-- rtbench:y -->\r\nkept\r\n<!-- /rtbench:y -->\r\n<!--rtbench:x-->\r\n<!-- /rtbench:x -->\r\nb";
    let once = splice(path, text, &block, Need::All).unwrap();
    assert_eq!(once, text.replace("x-->\r\n", "x-->\r\n\r\nnew\r\n\r\n"));
    assert_eq!(splice(path, &once, &block, Need::All).unwrap(), once);
}

/// Corners of the polygons of an SVG document, in their order.
fn polygons(svg: &str) -> Vec<Vec<(i32, i32)>> {
    let document = roxmltree::Document::parse(svg).unwrap();
    let corner = |text: &str| {
        let (x, y) = text.split_once(',').unwrap();
        (x.parse().unwrap(), y.parse().unwrap())
    };
    let points = document
        .descendants()
        .filter_map(|node| node.attribute("points").filter(|_| node.tag_name().name() == "polygon"));
    points.map(|points| points.split_whitespace().map(corner).collect()).collect()
}

#[test]
fn bands_are_stacked_without_gap_and_as_high_as_their_values() {
    let band = |style: usize, heights: [f64; 3]| Band {
        label: format!("band {style}"),
        style,
        points: [1.0, 2.0, 3.0].into_iter().zip(heights).collect(),
    };
    let panel = Panel {
        title: String::new(),
        x: Axis { label: "frame".into(), log: false, range: (1.0, 3.0), ticks: vec![1.0, 2.0, 3.0] },
        y: Axis { label: "time".into(), log: false, range: (0.0, 10.0), ticks: vec![0.0, 5.0, 10.0] },
        series: Vec::new(),
        groups: Vec::new(),
        bars: Vec::new(),
        bands: vec![band(0, [2.0, 4.0, 2.0]), band(1, [3.0, 1.0, 6.0])],
        marks: Vec::new(),
    };
    let picture = Picture { title: "Bands".into(), panels: vec![panel], columns: 1 };
    let figure = Figure::draw("bands", "bands".into(), String::new(), &picture).unwrap();
    assert!(figure.svg.contains("band 0") && figure.svg.contains("band 1"));
    let found = polygons(&figure.svg);
    assert_eq!(found.len(), 2, "{found:?}");
    // Upper edge from the left, then the lower one from the right
    let (upper, lower) = (&found[0][..3], &found[1][3..]);
    assert_eq!(upper, lower.iter().rev().copied().collect::<Vec<_>>());
    let height = |band: usize, frame: usize| f64::from(found[band][5 - frame].1 - found[band][frame].1);
    let unit = height(0, 0) / 2.0;
    for (band, heights) in [[2.0, 4.0, 2.0], [3.0, 1.0, 6.0]].iter().enumerate() {
        for (frame, expected) in heights.iter().enumerate() {
            assert!((height(band, frame) / unit - expected).abs() < 0.1, "{band} {frame}: {found:?}");
        }
    }
}
