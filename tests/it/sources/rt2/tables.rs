//! Every table, published and measured, in every format.

use super::synthetic::{Builder, everything, scene};
use rtbench::record::row::Status;
use rtbench::report::format::{self, Format};
use rtbench::report::{Cell, Line, Table};
use rtbench::sources::rt2::SOURCE;
use rtbench::sources::rt2::structures::{BVH, ROPES, STACK};
use rtbench::sources::runs::RecordedRun;
use rtbench::sources::{Options, Rows, without_numbers};
use rtbench::workloads::trace::rays::Config;

fn compared() -> Options {
    Options { published: true, ..Options::default() }
}

fn tables(runs: &[RecordedRun], options: &Options) -> Vec<Table> {
    (SOURCE.read)(runs).tables(SOURCE.tables, options)
}

/// The table whose title begins so.
#[track_caller]
fn titled(tables: &[Table], id: &str, title: &str) -> Table {
    let found = tables.iter().find(|t| t.id == id && t.title.starts_with(title));
    found
        .unwrap_or_else(|| panic!("no {id} {title}: {:?}", tables.iter().map(|t| &t.title).collect::<Vec<_>>()))
        .clone()
}

/// What is written in the row of these keys, by line.
#[track_caller]
fn row(table: &Table, keys: &[&str], line: Line) -> Vec<String> {
    let row = table.rows.iter().find(|row| row.keys == keys).unwrap_or_else(|| panic!("no row {keys:?}: {table:?}"));
    let cells = row.cells.iter().zip(&table.columns);
    cells.map(|(cell, column)| cell.write(column.form, line).unwrap_or_else(|| "-".into())).collect()
}

#[test]
fn published_orders_and_percentages_are_all_there_is() {
    let all = tables(&[], &Options::default());
    assert!(all.iter().all(|table| table.is_published && table.rows.len() == 3));
    let rates = titled(&all, "4.4", "Frames per second");
    let alien = ["Alien", "32 thousand triangles"];
    assert_eq!(row(&rates, &alien, Line::Value), ["-", "-", "-", "ropes, kd, BVH", "-", "-"]);
    let gains = titled(&all, "4.4", "Gain");
    assert_eq!(row(&gains, &[alien[0], alien[1], "as printed"], Line::Value), ["-", "18", "1.18", "18", "1.22"]);
    assert_eq!(row(&gains, &["Dragon", "847 thousand triangles", "as printed"], Line::Value), ["-"; 5]);
    let builds = titled(&all, "4.5", "Gain of the BVH");
    assert_eq!(
        row(&builds, &["Dragon", "847 thousand triangles", "every node"], Line::Value)[1..],
        ["-13", "0.87", "-13", "0.88"]
    );
    let memory = titled(&all, "4.6", "Memory");
    assert_eq!(row(&memory, &["Dino", "107 thousand triangles"], Line::Value)[3], "BVH, kd, ropes");
    // No number that was not printed: gains, and the ratios that they are read as.
    let numbers = all.iter().flat_map(|t| &t.rows).flat_map(|r| &r.cells);
    let numbers = numbers.filter(|cell| matches!(cell, Cell::Number { value: Some(_), .. })).count();
    assert_eq!(numbers, 5 * 4);
    // In CSV none of it is a value.
    let text = format::write(&all, Format::Csv);
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let lines: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert!(lines.iter().all(|line| line[7].is_empty()) && lines.iter().any(|line| &line[8] == "ropes, kd, BVH"));
}

#[test]
fn measured_numbers_have_their_order_and_percentages() {
    let all = tables(&[everything()], &compared());
    let alien = ["Alien", "scan (32168)"];
    let rates = titled(&all, "4.4", "Frames per second at 1408x768, P, Fast GPU");
    assert_eq!(
        row(&rates, &alien, Line::Value),
        ["111.11", "100.00", "84.75", "ropes, kd, BVH", "125.00", "BVH, ropes, kd"]
    );
    assert_eq!(row(&rates, &alien, Line::Published), ["-", "-", "-", "ropes, kd, BVH", "-", "-"]);
    let gains = titled(&all, "4.4", "Gain of the kd-tree over the BVH in frames");
    let of = |kind| [alien[0], alien[1], kind];
    assert_eq!(row(&gains, &of("as printed"), Line::Value), ["1.18", "18", "1.18", "15", "1.18"]);
    assert_eq!(row(&gains, &of("as printed"), Line::Published), ["-", "18", "1.18", "18", "1.22"]);
    assert_eq!(row(&gains, &of("culled"), Line::Value), ["0.80", "-20", "0.80", "-25", "0.80"]);
    assert!(row(&gains, &of("culled"), Line::Published).iter().all(|cell| cell == "-"), "the document culled nothing");
    let steps = titled(&all, "4.4", "Steps per ray");
    assert_eq!(
        row(&steps, &alien, Line::Value),
        ["9.00", "12.00", "20.00", "ropes, kd, BVH", "10.00", "12.00", "8.00", "40.00"]
    );
    let by_steps = titled(&all, "4.4", "Gain of the kd-tree over the BVH in steps");
    assert_eq!(row(&by_steps, &of("as printed"), Line::Value)[..2], ["1.67", "67"]);
    let builds = titled(&all, "4.5", "Build times, one thread");
    assert_eq!(row(&builds, &alien, Line::Value), ["20.00", "45.00", "100.00", "min-max, BVH, sort"]);
    let others = titled(&all, "4.5", "Build times of trees sorted once");
    assert_eq!(row(&others, &alien, Line::Value), ["45.00", "100.00", "120.00", "110.00", "200.00", "5.00"]);
    let saved = titled(&all, "4.5", "Gain of the BVH over the kd-tree in build time");
    assert_eq!(row(&saved, &of("every node"), Line::Value), ["2.22", "122", "2.22", "55", "2.22"]);
    assert_eq!(row(&saved, &of("every node"), Line::Published)[3], "55");
    assert!(row(&saved, &of("once"), Line::Published).iter().all(|cell| cell == "-"), "it sorted in every node");
    let memory = titled(&all, "4.6", "Memory of structures");
    assert_eq!(row(&memory, &alien, Line::Value)[3], "kd, BVH, ropes");
    assert_eq!(row(&memory, &["Dino", "scan:spikes=1000 (108000)"], Line::Value)[3], "BVH, kd, ropes");
    let counts = titled(&all, "4.6", "What the sizes are made of");
    assert_eq!(row(&counts, &alien, Line::Value), ["1.000", "2.000", "0.938", "20.0", "45.0", "68.0"]);
    assert!(memory.with_published && !counts.with_published, "a line of nothing but dashes");
    assert!(titled(&all, "4.6", "Expected costs").notes.iter().any(|note| note.contains("cost of 1")));
    // Every counterpart of a model has a row below the model's name, other scenes are last.
    let names: Vec<&str> = rates.rows.iter().map(|row| row.keys[0].as_str()).collect();
    assert_eq!(names, ["Alien", "Dino", "Dino", "Dragon", "Dragon", "other"]);
}

#[test]
fn rows_are_those_that_were_asked_for() {
    let mut b = Builder::new();
    b.shot("alien", &STACK, 1.0);
    b.shot("room", &STACK, 1.0);
    let run = [b.run];
    let rows = |rows| titled(&tables(&run, &Options { rows, ..compared() }), "4.4", "Frames per second").rows.len();
    assert_eq!([Rows::All, Rows::Source, Rows::Measured].map(rows), [4, 3, 2]);
    let rates = titled(&tables(&run, &compared()), "4.4", "Frames per second");
    assert_eq!(row(&rates, &["Dragon", "not measured"], Line::Published)[3], "ropes, kd, BVH");
    assert!(rates.notes.iter().any(|note| note == "Not measured: Dino, Dragon."), "{:?}", rates.notes);
    // An order needs all three numbers.
    assert_eq!(row(&rates, &["Alien", "scan (32168)"], Line::Value)[1..4], ["1000.00", "-", "-"]);
    let results = (SOURCE.read)(&run);
    assert_eq!(without_numbers(&*results, SOURCE.tables, &compared()), ["4.5", "4.6"]);
}

#[test]
fn the_document_s_size_comes_first() {
    let mut b = Builder::new();
    for name in ["alien", "dragon", "room"] {
        b.row(scene(name), &STACK.selection(), Config::P, (320, 200), 2.0);
    }
    let title = |run: &RecordedRun, resolution| {
        let options = Options { resolution, ..Options::default() };
        tables(std::slice::from_ref(run), &options)[0].title.clone()
    };
    assert!(title(&b.run, None).contains("at 320x200"));
    b.shot("alien", &STACK, 1.0);
    assert!(title(&b.run, None).contains("at 1408x768") && title(&b.run, Some(320)).contains("at 320x200"));
    let rates = &tables(&[b.run], &Options::default())[0];
    assert!(rates.notes.iter().any(|note| note.contains("other sizes as well: 320x200")), "{:?}", rates.notes);
}

#[test]
fn a_row_without_a_result_is_never_a_number() {
    let mut b = Builder::new();
    b.shot("alien", &ROPES, 1.0).verified = false;
    let record = b.shot("alien", &BVH, 1.0);
    (record.status, record.message) = (Status::Skipped, "too large".into());
    let all = tables(&[b.run], &compared());
    assert!(all.iter().flat_map(|t| &t.rows).flat_map(|r| &r.cells).all(|cell| !cell.is_filled()));
    let notes = &titled(&all, "4.4", "Frames per second").notes;
    assert!(notes.iter().any(|note| note.contains("cull=off P 1408x768 (too large)")), "{notes:?}");
}

#[test]
fn every_format_has_every_table_and_a_terminal_is_wide_enough() {
    let mut run = everything();
    run.journal.provenance.environment.cpu = "A Processor With A Rather Long Name And 64 Cores @ 3.00GHz".into();
    for (runs, options) in [(vec![], Options::default()), (vec![run], compared())] {
        let all = tables(&runs, &options);
        for table in &all {
            let text = format::write(std::slice::from_ref(table), Format::Text);
            let longest = text.lines().map(|line| line.chars().count()).max().unwrap();
            assert!(longest <= 100, "{longest}:\n{text}");
        }
        for form in [Format::Text, Format::Markdown, Format::Csv, Format::Latex] {
            let text = format::write(&all, form);
            assert_eq!(text, format::write(&tables(&runs, &options), form), "not the same bytes");
            assert!(text.contains("ropes, kd, BVH") || form == Format::Text, "{text}");
        }
    }
}
