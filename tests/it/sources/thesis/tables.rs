//! Every table, published and measured, in every form.

use super::synthetic::{Builder, everything, scene};
use rtbench::record::row::Status;
use rtbench::report::format::{self, Format};
use rtbench::report::{Cell, Form, Line, Table};
use rtbench::sources::convention::Convention;
use rtbench::sources::thesis::data::Data;
use rtbench::sources::thesis::tables::{IDS, build};
use rtbench::sources::thesis::{Numbers, measured, published};
use rtbench::sources::{ALL, Options, Rows, select_tables};
use rtbench::workloads::trace::backend::{Config, DeviceType};
use rtbench::workloads::trace::record::by_ray_type;

const FORMATS: [Format; 4] = [Format::Text, Format::Markdown, Format::Csv, Format::Latex];

pub fn tables(data: &Data, options: &Options, ids: &[&str]) -> Vec<Table> {
    build(&Numbers { data: data.clone(), published: published::data(), modelled: Vec::new() }, options, ids)
}

/// Tables of one size at the thesis's usual one.
pub fn options() -> Options {
    Options { resolution: Some(1024), ..Options::default() }
}

/// The same, with published numbers.
pub fn compared() -> Options {
    Options { published: true, ..options() }
}

/// The one table of a number.
pub fn table(data: &Data, options: &Options, id: &str) -> Table {
    let mut tables = tables(data, options, &[id]);
    assert_eq!(tables.len(), 1, "{id}");
    tables.remove(0)
}

/// What is written in the row that begins with these keys, by line.
#[track_caller]
pub fn row(table: &Table, keys: &[&str], line: Line) -> Vec<String> {
    let row = table.rows.iter().find(|row| row.keys == keys).unwrap_or_else(|| panic!("no row {keys:?}: {table:?}"));
    let write = |(cell, form): (&Cell, Form)| cell.write(form, line).unwrap_or_else(|| "-".into());
    row.cells.iter().zip(table.columns.iter().map(|c| c.form)).map(write).collect()
}

#[track_caller]
pub fn noted(table: &Table, words: &str) {
    assert!(table.notes.iter().any(|note| note.contains(words)), "{words:?} is not in {:?}", table.notes);
}

#[test]
fn all_published_tables() {
    let data = published::data();
    let all = tables(&data, &options(), &IDS);
    let ids: Vec<&str> = all.iter().map(|t| t.id.as_str()).collect();
    assert_eq!(ids, IDS);
    // Rows as printed; a missing row would be a lost number.
    let rows = |id: &str| all.iter().find(|t| t.id == id).unwrap().rows.len();
    for id in ["5.1", "5.3", "5.4", "5.5", "5.6", "5.9", "5.10", "5.11", "5.12", "5.13"] {
        assert_eq!(rows(id), 9, "{id}");
    }
    assert_eq!(["5.2", "5.7", "5.8", "5.14", "B.1", "B.2", "B.3"].map(rows), [5, 6, 6, 6, 36, 36, 24]);
    assert_eq!(["B.4", "B.5", "B.6"].map(rows), [24, 24, 12]);
    // As many numbers as were printed: 5.12 to 5.14 repeat rows of the B tables.
    let numbers = |t: &Table| t.rows.iter().flat_map(|r| &r.cells).filter(|c| c.is_filled()).count();
    let of_b: usize = all.iter().filter(|t| t.id.starts_with("B.")).map(numbers).sum();
    assert_eq!(of_b, 3 * 463);
    let at = |id: &str| all.iter().find(|t| t.id == id).unwrap();
    assert_eq!(row(at("5.4"), &["bunny"], Line::Value), ["83", "82", "64", "24", "3.69", "8.33"]);
    assert_eq!(row(at("5.3"), &["museum"], Line::Value), ["12", "219", "31"]);
    assert_eq!(row(at("5.14"), &["conference"], Line::Value)[3..6], ["-", "-", "-"]);
    assert_eq!(row(at("5.10"), &["robots"], Line::Value)[6..], ["0.10", "0.21", "0.42"]);
    assert_eq!(
        row(at("5.8"), &["kd-tree", "32", "25"], Line::Value),
        ["128.97", "-18", "496.17", "-15", "278.18", "-15"]
    );
    noted(at("5.14"), "not published");
}

#[test]
fn a_terminal_of_100_columns_is_wide_enough() {
    let published = published::data();
    let mut runs = everything();
    for run in &mut runs {
        run.journal.provenance.environment.cpu = "A Processor With A Rather Long Name And 64 Cores @ 3.00GHz".into();
    }
    let measured = measured::data(&runs);
    for (data, options) in [(&published, options()), (&measured, compared())] {
        for table in tables(data, &options, &IDS) {
            let text = format::write(std::slice::from_ref(&table), Format::Text);
            let longest = text.lines().map(|line| line.chars().count()).max().unwrap();
            assert!(longest <= 100, "{} {longest}:\n{text}", table.id);
        }
    }
}

#[test]
fn measured_numbers_are_shown_with_the_published_ones() {
    let data = measured::data(&everything());
    let all = tables(&data, &compared(), &IDS);
    for id in IDS {
        assert!(all.iter().any(|t| t.id == id), "{id} is missing");
    }
    let t = table(&data, &compared(), "5.3");
    assert_eq!(row(&t, &["bunny"], Line::Value), ["10.00", "90.00", "30.00"]);
    assert_eq!(row(&t, &["bunny"], Line::Published), ["39", "1249", "125"]);
    assert_eq!(row(&t, &["bunny"], Line::Ratio), ["0.26", "0.0721", "0.24"]);
    noted(&t, "Not measured: dragon, buddha, kitchen, theatre, office, conference.");
    assert!(t.title.starts_with("Build times, one thread of "), "{}", t.title);
    noted(&t, "Each structure was built once.");
    // Absent: the published number alone, and no ratio.
    assert_eq!(row(&t, &["dragon"], Line::Value), ["-"; 3]);
    assert_eq!(row(&t, &["dragon"], Line::Ratio), ["-"; 3]);
    // Another tessellation, and a scene of nobody's, have rows of their own and no published numbers.
    assert_eq!(row(&t, &["conference"], Line::Value), ["-"; 3]);
    assert_eq!(row(&t, &["conference (207512)"], Line::Value), ["10.00", "90.00", "30.00"]);
    assert_eq!(row(&t, &["conference (207512)"], Line::Published), ["-"; 3]);
    assert_eq!(row(&t, &["hall (5000)"], Line::Value), ["10.00", "90.00", "30.00"]);
    noted(&t, "another tessellation than the thesis's conference");

    let t = &tables(&data, &compared(), &["5.12"])[0];
    assert!(t.title.contains("1024x1024") && t.title.contains("Fast GPU"), "{}", t.title);
    assert_eq!(row(t, &["museum"], Line::Value)[..3], ["27.65", "33.79", "30.72"]);
    assert_eq!(row(t, &["museum"], Line::Published)[..3], ["4.61", "45.94", "24.99"]);
    assert_eq!(row(t, &["museum"], Line::Ratio)[2], "1.23");
    let t = table(&data, &compared(), "B.1");
    assert_eq!(row(&t, &["bunny", "512"], Line::Value)[2], "15.36");
    assert_eq!(row(&t, &["bunny", "768"], Line::Value)[2], "-");
    assert_eq!(row(&t, &["bunny", "768"], Line::Published)[2], "11.08");
    // The other device, another size.
    let other = Options { device: Some(1), resolution: Some(512), ..compared() };
    let t = &tables(&data, &other, &["5.12"])[0];
    assert_eq!(row(t, &["bunny"], Line::Published)[0], published_mean("8600GT", 512, "min"));
    // The three forms of rows.
    let rows = |rows| tables(&data, &Options { rows, ..compared() }, &["5.3"])[0].rows.len();
    assert_eq!([Rows::All, Rows::Source, Rows::Measured].map(rows), [11, 9, 5]);
}

/// Bunny, grid, P, from the published data itself.
fn published_mean(device: &str, side: u32, _: &str) -> String {
    let data = published::data();
    let index = data.devices.iter().position(|d| d.label == device).unwrap();
    let frame = data.frames.iter().find(|f| {
        (f.device, f.width, f.config) == (index, side, Config::P)
            && f.scene.to_string() == "bunny"
            && f.structure == "grid"
    });
    Form::Time.write(frame.unwrap().min_ms)
}

#[test]
fn two_devices_are_compared() {
    let data = measured::data(&everything());
    let t = &tables(&data, &compared(), &["5.2"]);
    assert_eq!((t.len(), t[0].columns.len()), (2, 2));
    let t = &tables(&data, &compared(), &["5.3.4"])[0];
    assert_eq!(t.title, "Speed-up of Fast GPU over Slow GPU");
    // 512: 15.36, 10.24 and 5.12 ms against 60, 50 and 40.
    assert_eq!(row(t, &["bunny", "P", "512"], Line::Value), ["3.91", "4.88", "7.81"]);
    assert_eq!(tables(&data, &options(), &["B.4"])[0].title, "Frame times, P (primary rays), Slow GPU");
    assert!(tables(&data, &options(), &["B.1"])[0].title.ends_with("Fast GPU"));
    // Two runs on the same device are one device.
    let runs = [everything().remove(0), everything().remove(0)];
    assert_eq!(measured::data(&runs).devices.len(), 1);
    // The same name with another driver is another device, and has another name here.
    let mut runs = runs;
    runs[1].journal.provenance.devices[0].info.driver = "Mesa 99".into();
    let labels: Vec<String> = measured::data(&runs).devices.into_iter().map(|d| d.label).collect();
    assert_eq!(labels, ["Fast GPU", "Fast GPU #2"]);
}

#[test]
fn the_register_limit_has_substitute_options_that_say_so() {
    let data = measured::data(&everything());
    let t = &tables(&data, &options(), &["5.8"])[0];
    assert_eq!(row(t, &["kd-tree", "default"], Line::Value), ["-", "-", "-", "-", "61.44", "-"]);
    assert_eq!(row(t, &["kd-tree", "memory=private"], Line::Value)[4..], ["45.00", "27"]);
    assert_eq!(row(t, &["grid", "group=16x4"], Line::Value)[4..], ["99.00", "-7"]);
    noted(t, "Substitute options: wgpu has no register limit");
    // One order of scenes for what was measured and what was printed below it
    let order = |t: &Table| t.columns.iter().step_by(2).map(|c| c.group.clone()).collect::<Vec<_>>();
    for id in ["5.7", "5.8"] {
        let both = tables(&data, &compared(), &[id]);
        assert!(both.len() == 2 && both.iter().all(|t| order(t) == ["robots", "kitchen", "museum"]), "{id}");
    }
    noted(t, "Not measured: robots, kitchen.");
    let only = Options { rows: Rows::Measured, ..options() };
    assert_eq!(row(&tables(&data, &only, &["5.8"])[0], &["kd-tree", "default"], Line::Value), ["61.44", "-"]);
    assert_eq!(
        row(&tables(&data, &options(), &["5.7"])[0], &["BVH", "group=32x2"], Line::Value)[4..],
        ["44.00", "-10"]
    );
}

#[test]
fn a_wrong_or_unverified_row_is_never_a_number() {
    let mut b = Builder::new();
    b.trio("bunny", Config::P, 1024, [3.0, 2.0, 1.0]);
    b.frame("dragon", "grid", Config::P, 1024, 7777.0).status = Status::Failed;
    b.run.journal.configurations.last_mut().unwrap().message = "3 hits differ".into();
    b.frame("dragon", "bvh", Config::P, 1024, 8888.0).verified = false;
    let data = measured::data(&[b.run]);
    for format in FORMATS {
        let text = format::write(&tables(&data, &compared(), &IDS), format);
        assert!(!text.contains("7777") && !text.contains("8888"), "{text}");
    }
    let t = table(&data, &compared(), "5.12");
    assert_eq!(row(&t, &["dragon"], Line::Value), ["-"; 9]);
    noted(&t, "dragon grid P 1024x1024 (3 hits differ); dragon bvh P 1024x1024 (not verified)");
    // Its counts are no counts either.
    assert_eq!(row(&table(&data, &compared(), "5.9"), &["dragon"], Line::Value), ["-"; 6]);
}

#[test]
fn of_several_measurements_the_last_complete_one_counts() {
    let mut b = Builder::new();
    b.frame("bunny", "grid", Config::P, 1024, 5.0);
    b.frame("bunny", "grid", Config::P, 1024, 7.0);
    b.frame("bunny", "grid", Config::P, 1024, 9.0).status = Status::Failed;
    b.built("bunny", "grid", 5.0, 1.0, 4);
    b.built("bunny", "grid", 6.0, 1.0, 4);
    let data = measured::data(&[b.run]);
    let t = table(&data, &options(), "5.12");
    assert_eq!(row(&t, &["bunny"], Line::Value)[2], "7.00");
    noted(&t, "1 of these measurements were made more than once");
    let t = table(&data, &options(), "5.3");
    assert_eq!(row(&t, &["bunny"], Line::Value)[0], "6.00");
    noted(&t, "more than once");
}

#[test]
fn only_the_thesis_s_own_options_fill_its_rows() {
    let mut b = Builder::new();
    b.frame("robots", "grid", Config::P, 1024, 1111.0);
    b.built("robots", "grid", 1111.0, 1.0, 4);
    b.frame("museum", "grid:x=64", Config::P, 1024, 2222.0);
    b.frame("museum", "bvh:checks=on", Config::P, 1024, 3333.0);
    let data = measured::data(&[b.run]);
    for id in ["5.3", "5.4", "5.12", "B.1", "5.9"] {
        let text = format::write(&tables(&data, &options(), &[id]), Format::Csv);
        assert!(["1111", "2222", "3333"].iter().all(|n| !text.contains(n)), "{text}");
    }
    noted(&table(&data, &options(), "5.4"), "--structure grid:x=128");
    let mut b = Builder::new();
    b.frame("robots", "grid:x=128", Config::P, 1024, 4.0);
    let t = table(&measured::data(&[b.run]), &options(), "5.12");
    assert_eq!(row(&t, &["robots"], Line::Value)[2], "4.00");
}

#[test]
fn steps_follow_the_convention() {
    let mut b = Builder::new();
    b.frame("bunny", "kdtree", Config::P, 512, 1.0);
    // A smaller image's counts do not replace a larger one's.
    b.frame("bunny", "kdtree", Config::P, 256, 1.0).counters = Some(by_ray_type([super::synthetic::sums(99, 99); 3]));
    b.frame("bunny", "grid", Config::P, 512, 1.0);
    let data = measured::data(&[b.run]);
    // Of ten steps six are inner nodes and four leaves; five pops.
    let conventions = [Convention::Nodes, Convention::Inner, Convention::InnerPops, Convention::NodesPops];
    for (convention, steps) in conventions.into_iter().zip(["10.00", "6.00", "11.00", "15.00"]) {
        let options = Options { convention, ..compared() };
        let t = table(&data, &options, "5.10");
        assert_eq!(row(&t, &["bunny"], Line::Value), [steps, "-", "-", "10.00", "-", "-", "0.25", "-", "-"]);
        noted(&t, convention.in_words());
        noted(&t, "geometric mean over 1 cells");
        // A grid's step is a cell, by every convention.
        assert_eq!(row(&table(&data, &options, "5.9"), &["bunny"], Line::Value)[0], "10.00");
    }
}

#[test]
fn a_software_device_is_called_one() {
    let mut b = Builder::new().device("llvmpipe", DeviceType::SoftwareRasteriser);
    b.trio("bunny", Config::P, 64, [3.0, 2.0, 1.0]);
    b.run.journal.provenance.devices[0].info.checked = true;
    let t = table(&measured::data(&[b.run]), &options(), "5.12");
    noted(&t, "do not rank structures for a GPU");
    noted(&t, "bounds checks");
    noted(&t, "--resolution 64");
}

#[test]
fn the_same_runs_give_the_same_bytes() {
    for format in FORMATS {
        let write = || format::write(&tables(&measured::data(&everything()), &compared(), &IDS), format);
        assert_eq!(write(), write());
    }
}

#[test]
fn forms_escape_what_they_must() {
    let name = "a|b <c>_&%\\\"d\",e";
    let mut b = Builder::new();
    b.frame("bunny", "grid", Config::P, 1024, 1.0).scene = scene(name);
    let data = measured::data(&[b.run]);
    let only = Options { rows: Rows::Measured, ..options() };
    let write = |format| format::write(&tables(&data, &only, &["5.12"]), format);
    let markdown = write(Format::Markdown);
    let line = markdown.lines().find(|l| l.starts_with("| a")).unwrap();
    assert_eq!(line.replace("\\|", "").matches('|').count(), 11, "{line}");
    assert!(line.contains("&lt;c&gt;\\_&amp;%\\\\"), "{line}");
    let latex = write(Format::Latex);
    assert!(latex.contains("a\\textbar{}b $<$c$>$\\_\\&\\%\\textbackslash{}"), "{latex}");
    let mut csv = csv::Reader::from_reader(write(Format::Csv).into_bytes().leak() as &[u8]);
    let rows: Vec<csv::StringRecord> = csv.records().collect::<Result<_, _>>().unwrap();
    assert_eq!(rows.len(), 9);
    assert_eq!((&rows[2][3], &rows[2][5], &rows[2][7]), (format!("{name} (5000)").as_str(), "grid mean", "1"));
}

#[test]
fn tables_are_selected_by_their_numbers() {
    assert_eq!(select_tables(&ALL, "all").unwrap()[0], IDS);
    assert_eq!(select_tables(&ALL, "5.4, b.1,5.3.4").unwrap()[0], ["5.4", "B.1", "5.3.4"]);
    for wrong in ["5.15", "B.7", "", ","] {
        assert!(select_tables(&ALL, wrong).unwrap_err().to_string().contains("5.3.4"), "{wrong}");
    }
}
