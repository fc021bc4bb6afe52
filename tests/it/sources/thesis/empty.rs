//! Tables that nothing was measured for, published devices, and the image size that represents a run.

use super::synthetic::{Builder, everything};
use super::tables::{compared, noted, options, row, table, tables};
use rtbench::report::format::{self, Format};
use rtbench::report::{Cell, Line};
use rtbench::sources::thesis::data::Data;
use rtbench::sources::thesis::tables::{IDS, side};
use rtbench::sources::thesis::{Numbers, measured, published};
use rtbench::sources::{Options, Rows, without_numbers};
use rtbench::workloads::trace::backend::{Config, DeviceType};

#[test]
fn a_table_without_a_measurement_is_empty_above_the_published_numbers() {
    let one = measured::data(&everything()[..1]);
    let at = |options: &Options, id: &str| tables(&one, options, &[id]);
    // No second device: its frame times are dashes above those of the thesis's second device.
    let b4 = &at(&compared(), "B.4")[0];
    assert_eq!(row(b4, &["bunny", "512"], Line::Value), ["-"; 9]);
    assert_eq!(row(b4, &["bunny", "512"], Line::Published)[2], "45.19");
    noted(b4, "2009: 8600GT.");
    noted(b4, "Not measured: a second device.");
    // Without the published numbers a row per scene is left: the thesis's nine, and two that only the run has.
    let alone = &at(&options(), "B.4")[0];
    assert_eq!((alone.rows.len(), row(alone, &["bunny", ""], Line::Value)), (11, vec!["-".to_owned(); 9]));
    let t = at(&compared(), "5.7");
    assert_eq!(row(&t[0], &["kd-tree", "memory=private"], Line::Value), ["-"; 6]);
    noted(&t[0], "Not measured: a second device.");
    assert!(t[1].title.contains("8600GT (published as table 5.7)"), "{}", t[1].title);
    let t = at(&compared(), "5.3.4");
    assert!(t[0].rows.is_empty() && t[1].title == "Speed-up of GTX280 over 8600GT in 2009");
    noted(&t[0], "Not measured: a second device.");
    // Nothing at all was measured of this structure.
    let mut b = Builder::new();
    b.frame("bunny", "bvh-stack", Config::P, 256, 1.0);
    let bare = measured::data(&[b.run]);
    for id in IDS {
        let first = tables(&bare, &compared(), &[id]).remove(0);
        let named = first.notes.iter().any(|note| note.starts_with("Not measured: "));
        assert!(named || id == "5.2", "{id}: {:?}", first.notes);
    }
    let without: Vec<&str> = IDS.into_iter().filter(|id| !["5.1", "5.2"].contains(id)).collect();
    let without_numbers = |data: &Data, ids: &[&'static str]| {
        let numbers = Numbers { data: data.clone(), published: published::data(), modelled: Vec::new() };
        without_numbers(&numbers, ids, &compared())
    };
    assert_eq!(without_numbers(&bare, &IDS), without);
    assert_eq!(without_numbers(&one, &["5.7", "5.8", "B.1", "B.4"]), ["5.7", "B.4"]);
    // Only what was measured: no rows, but still the heading and the note; every form can be without rows.
    let only = Options { rows: Rows::Measured, ..compared() };
    let b4 = at(&only, "B.4").remove(0);
    assert!(b4.rows.is_empty());
    noted(&b4, "Not measured: bunny, dragon, buddha,");
    for format in [Format::Text, Format::Markdown, Format::Latex] {
        let text = format::write(std::slice::from_ref(&b4), format);
        assert!(text.contains("Not measured: bunny") && text.contains("a second device"), "{text}");
    }
}

#[test]
fn the_device_that_was_asked_for_or_none() {
    let data = published::data();
    let of = |device| Options { device: Some(device), resolution: Some(512), ..options() };
    // Published times of the slower device, which the thesis printed in its table B.4.
    let t = table(&data, &of(1), "5.12");
    assert!(t.title.ends_with("8600GT"), "{}", t.title);
    assert_eq!(row(&t, &["bunny"], Line::Value)[2], "45.19");
    noted(&t, "printed this table of the GTX280 only; these are rows of its table B.4");
    assert!(table(&data, &of(0), "5.12").notes.is_empty());
    // A table that has only the other device's numbers says which table has those of this one.
    for (id, device, name, place) in [
        ("B.2", 1, "8600GT", "table B.5"),
        ("B.4", 0, "GTX280", "table B.1"),
        ("5.7", 0, "GTX280", "table 5.8"),
        ("5.8", 1, "8600GT", "table 5.7"),
    ] {
        let t = table(&data, &of(device), id);
        assert!(t.rows.is_empty() && t.title.ends_with(name), "{id}: {}", t.title);
        noted(&t, &format!("no numbers of the {name} in this table: they are in {place}"));
        assert!(!table(&data, &of(1 - device), id).rows.is_empty(), "{id}");
    }
    // With a run: the device's own register limit and times.
    let data = measured::data(&everything());
    let t = tables(&data, &Options { device: Some(1), ..compared() }, &["5.8"]);
    assert!(t[1].title.contains("8600GT (published as table 5.7)"), "{}", t[1].title);
    assert_eq!(row(&t[1], &["grid", "32", "33"], Line::Value)[0], "240.96");
    let t = tables(&data, &compared(), &["5.8"]);
    assert!(t[1].title.contains("GTX280 (published as table 5.8)"), "{}", t[1].title);
    // Each table's own device if none is asked for: the second measured device is compared with the slower one.
    let t = table(&data, &compared(), "B.4");
    assert_eq!(row(&t, &["bunny", "512"], Line::Published)[2], "45.19");
    let t = table(&data, &Options { device: Some(0), ..compared() }, "B.4");
    noted(&t, "2009: GTX280.");
}

#[test]
fn what_has_no_published_numbers_says_so() {
    let mut b = Builder::new();
    b.trio("bunny", Config::P, 128, [3.0, 2.0, 1.0]);
    let data = measured::data(&[b.run]);
    let t = table(&data, &Options { resolution: Some(128), ..compared() }, "5.12");
    assert!(!t.rows.iter().flat_map(|row| &row.cells).any(Cell::has_published));
    noted(&t, "the thesis has times of the GTX280 at 256, 512, 768, 1024");
    assert!(!t.notes.iter().any(|note| note.contains("2009: GTX280.")), "{:?}", t.notes);
}

#[test]
fn a_published_size_represents_a_run_before_the_one_with_most_rows() {
    let usual = |fill: &dyn Fn(&mut Builder)| {
        let mut b = Builder::new();
        fill(&mut b);
        side::usual(&measured::data(&[b.run]), 0)
    };
    let scenes = ["bunny", "dragon", "robots", "museum"];
    let all_at = |b: &mut Builder, side| scenes.iter().for_each(|s| b.trio(s, Config::P, side, [3.0, 2.0, 1.0]));
    // More was measured at 128, but the thesis has no 128.
    let lite = |b: &mut Builder| {
        all_at(b, 256);
        all_at(b, 128);
        b.frame("bunny", "bvh-stack", Config::P, 128, 1.0);
        b.frame("bunny", "grid:factor=2", Config::P, 128, 1.0);
    };
    assert_eq!(usual(&lite), 256);
    // One scene at 1024 does not represent four, nor does an option's row for a scene.
    assert_eq!(usual(&|b| (lite(b), b.trio("bunny", Config::P, 1024, [3.0, 2.0, 1.0])).0), 256);
    let options_at_512 = |b: &mut Builder| {
        lite(b);
        for scene in scenes {
            b.frame(scene, "bvh:checks=on", Config::P, 512, 1.0);
        }
    };
    assert_eq!(usual(&options_at_512), 256);
    assert_eq!(usual(&|b| (lite(b), all_at(b, 768)).0), 768);
    // None of the thesis's for all: another one, and if there is none for all, the one with most.
    assert_eq!(usual(&|b| (all_at(b, 128), b.trio("bunny", Config::P, 256, [3.0, 2.0, 1.0])).0), 128);
    let scattered = |b: &mut Builder| {
        b.trio("bunny", Config::P, 100, [3.0, 2.0, 1.0]);
        b.trio("dragon", Config::P, 100, [3.0, 2.0, 1.0]);
        b.trio("museum", Config::P, 200, [3.0, 2.0, 1.0]);
    };
    assert_eq!(usual(&scattered), 100);
    // The published devices: the faster one has all at 1024, the slower one at 512.
    assert_eq!([0, 1].map(|device| side::usual(&published::data(), device)), [1024, 512]);
}

#[test]
fn the_camera_path_s_light_is_a_light() {
    let mut b = Builder::new().device("GPU", DeviceType::DiscreteGpu);
    b.frame("bunny", "grid", Config::P, 64, 1.0).scene.lights = 0;
    b.frame("hall", "grid", Config::P, 64, 1.0).scene.lights = 0;
    b.frame("museum", "grid", Config::P, 64, 1.0).scene.lights = 2;
    let t = table(&measured::data(&[b.run]), &compared(), "5.1");
    assert_eq!(row(&t, &["bunny"], Line::Value)[2], "1");
    assert_eq!(row(&t, &["bunny"], Line::Ratio)[2], "1.00");
    assert_eq!(row(&t, &["museum"], Line::Value)[2], "2");
    // The catalogue knows nothing of this one.
    assert_eq!(row(&t, &["hall (5000)"], Line::Value)[2], "0");
    noted(&t, "Light of the camera path, because the file has none: bunny.");
}
