//! Records and what is made of them: statistics by hand, journals whole and cut off, CSV and JSON that agree.

use crate::fakes::{configuration, provenance, structure};
use crate::support::csv_rows;
use proptest::prelude::*;
use rtbench::Error;
use rtbench::harness::measure;
use rtbench::harness::summary::{self, Wide};
use rtbench::math::{Hit, MISS};
use rtbench::names;
use rtbench::record::journal::Record;
use rtbench::record::journal::{Journal, JournalWriter};
use rtbench::record::row::{SCHEMA, Samples, Status, TimingSource};
use rtbench::record::run::End;
use rtbench::record::{files, picture, statistics};
use rtbench::workloads::trace::backend::{Config, GivenRay};
use rtbench::workloads::trace::record::{CounterSums, TraceJournal};
use rtbench::workloads::trace::{TRACE, artifacts, rays_csv};
use std::path::{Path, PathBuf};

/// Columns that scripts of users read, in any order.
const SUMMARY: &str = "device,device_type,scene,triangles,structure,variant,config,width,height,frames,passes,\
    frame_ms_min,frame_ms_max,frame_ms_mean,noise_pct,timing_source,wall_ms_mean,mrays_per_s,primary_rays,shadow_rays,\
    reflected_rays,primary_steps_per_ray,primary_tests_per_ray,primary_restarts_per_ray,shadow_steps_per_ray,\
    shadow_tests_per_ray,shadow_restarts_per_ray,reflected_steps_per_ray,reflected_tests_per_ray,\
    reflected_restarts_per_ray,build_ms,structure_bytes,geometry_bytes,thesis_bytes,image_hash,verified,status,message,\
    build,traversal,ray_options,device_options,resolution,camera_path,interleaved_with,kernel_hash";
const STRUCTURES: &str = "scene,structure,variant,cells_x,cells_y,cells_z,max_cell_triangles,references_per_triangle,\
    leaves,empty_leaves,max_leaf_triangles,nodes,depth,sah_cost,build_ms,build_threads,build_stages_ms,build_upload_ms,\
    upload_ms,driver_build_ms,structure_bytes,leaf_order_bytes,geometry_bytes,thesis_bytes,rt2_bytes,triangles,vertices,note";

#[test]
fn statistics_by_hand() {
    // Three passes over two frames. Frame 0: 10, 12, 20 ms: median 12, deviations 2, 0, 8: MAD 2, noise 2/12.
    // Frame 1: 30, 30, 33 ms: median 30, MAD 0, noise 0. Median of the noises: 1/12 = 8.333 %.
    let ms = |v: &[u64]| v.iter().map(|x| x * 1_000_000).collect::<Vec<_>>();
    let s = statistics::frames(&[ms(&[10, 30]), ms(&[20, 30]), ms(&[12, 33])]).unwrap();
    assert_eq!((s.min_ms, s.max_ms, s.mean_ms, s.total_ms), (12.0, 30.0, 21.0, 42.0));
    assert_eq!(s.p95_ms, 30.0);
    assert!((s.noise_pct.unwrap() - 100.0 / 12.0).abs() < 1e-9, "{s:?}");
    // An even number of passes: the mean of the middle two. One pass: the noise is unknown, not zero.
    assert_eq!(statistics::frames(&[ms(&[10]), ms(&[20])]).unwrap().mean_ms, 15.0);
    assert_eq!(statistics::frames(&[ms(&[10, 20])]).unwrap().noise_pct, None);
    assert_eq!(statistics::frames(&[ms(&[1, 2]), ms(&[1])]), None);
    assert_eq!(statistics::frames(&[]), None);
    assert_eq!(statistics::frames(&[vec![]]), None);
    let twenty: Vec<f64> = (1..=20).map(f64::from).collect();
    assert_eq!(statistics::percentile(&twenty, 95.0), Some(19.0));
    assert_eq!(statistics::percentile(&twenty[..19], 95.0), Some(19.0));
    assert_eq!(statistics::percentile(&[], 95.0), None);
}

proptest! {
    #[test]
    fn statistics_are_ordered(passes in prop::collection::vec(prop::collection::vec(1u64..1 << 40, 5), 1..8)) {
        let s = statistics::frames(&passes).unwrap();
        prop_assert!(s.min_ms <= s.mean_ms * (1.0 + 1e-12) && s.mean_ms <= s.max_ms * (1.0 + 1e-12));
        prop_assert!(s.min_ms <= s.p95_ms && s.p95_ms <= s.max_ms);
        prop_assert!(s.noise_pct.is_none_or(|n| (0.0..=100.0).contains(&n)));
        // The order of the passes says nothing.
        let mut reversed = passes;
        reversed.reverse();
        prop_assert_eq!(statistics::frames(&reversed).unwrap(), s);
    }
}

/// A structure, a good row and a wrong one.
fn typed() -> TraceJournal {
    let mut bad = configuration("kdtree", Config::P);
    bad.status = Status::Wrong;
    bad.verified = false;
    bad.message = "3 hits differ, \"quoted\", with a comma".into();
    TraceJournal {
        provenance: provenance(),
        structures: vec![structure("grid")],
        configurations: vec![configuration("grid", Config::PS), bad],
        resumed: vec![],
        end: None,
        truncated: None,
    }
}

/// Their journal, as its writer leaves it.
fn written() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let mut writer = JournalWriter::create(folder.path(), provenance()).unwrap();
    typed().records().iter().for_each(|record| writer.write(record).unwrap());
    let path = writer.path().to_owned();
    (folder, path)
}

#[test]
fn journal_round_trip() {
    let (folder, path) = written();
    let journal = Journal::read(&path).unwrap();
    assert_eq!(journal.provenance, provenance());
    assert_eq!((journal.inputs.len(), journal.artifacts.len(), journal.rows.len()), (2, 1, 2));
    assert_eq!((&journal.end, &journal.truncated), (&None, &None));
    // Nothing is lost between the typed rows and the general schema
    assert_eq!(TraceJournal::new(&journal), typed());
    let text = std::fs::read_to_string(&path).unwrap();
    let first: serde_json::Value = serde_json::from_str(text.lines().next().unwrap()).unwrap();
    assert_eq!((first["record"].as_str(), first["schema"].as_str()), (Some("run"), Some(SCHEMA)));
    // Integers stay integers, also beyond what a float holds
    let mut row = journal.rows[0].clone();
    row.metrics = vec![rtbench::record::row::Metric::new("large", u64::MAX)];
    let text = serde_json::to_string(&row).unwrap();
    assert!(text.contains("18446744073709551615"), "{text}");
    assert_eq!(serde_json::from_str::<rtbench::record::row::Row>(&text).unwrap(), row);
    // The folder is taken now.
    let again = JournalWriter::create(folder.path(), provenance()).err().unwrap();
    assert!(matches!(again, Error::Input(_)) && again.to_string().contains("not empty"), "{again}");
}

#[test]
fn journal_cut_off_anywhere() {
    let (_folder, path) = written();
    let bytes = std::fs::read(&path).unwrap();
    let ends: Vec<usize> = (0..bytes.len()).filter(|&i| bytes[i] == b'\n').collect();
    for length in 0..=bytes.len() {
        let read = Journal::parse(&path, &bytes[..length]);
        if length < ends[0] {
            assert!(read.is_err(), "nothing is known without the first line, {length}");
            continue;
        }
        let journal = read.unwrap_or_else(|e| panic!("cut off at {length}: {e}"));
        // A line that only lacks its newline is whole.
        let whole = ends.iter().filter(|&&end| end <= length).count();
        let records = journal.inputs.len() + journal.artifacts.len() + journal.rows.len();
        assert_eq!(1 + records, whole, "{length}");
        let clean = length == ends[whole - 1] || length == ends[whole - 1] + 1;
        assert_eq!(journal.truncated.is_none(), clean, "{length}");
    }
}

#[test]
fn broken_journals_are_refused_with_their_line() {
    let (_folder, path) = written();
    let text = std::fs::read_to_string(&path).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let refused = |lines: &[&str], wanted: &str| {
        let error = Journal::parse(Path::new("j"), (lines.join("\n") + "\n").as_bytes()).unwrap_err().to_string();
        assert!(error.contains(wanted) && !error.contains('\n'), "{error}");
    };
    refused(&[lines[0], "rubbish", lines[2]], "j:2: not a record");
    refused(&[lines[1], lines[2]], "j:1: the first line is no run's provenance");
    refused(&[lines[0], lines[0]], "j:2: a second provenance");
    refused(&[&lines[0].replace(SCHEMA, "rtbench/9")], "j:1: schema \"rtbench/9\"");
    assert!(Journal::parse(Path::new("j"), b"").unwrap_err().to_string().contains("empty"));
    assert!(Journal::read(Path::new("/nowhere/j")).unwrap_err().to_string().contains("/nowhere/j"));
}

#[test]
fn a_device_node_is_never_replaced() {
    if !Path::new("/dev/full").exists() {
        eprintln!("a_device_node_is_never_replaced did not run: there is no /dev/full");
        return;
    }
    let error = files::replace(Path::new("/dev/full"), b"x").unwrap_err();
    assert!(matches!(error, Error::Output { .. }) && error.exit_code() == 2, "{error}");
    assert!(!std::fs::metadata("/dev/full").unwrap().is_file(), "the device node was replaced by a file");
}

#[test]
fn headers_keep_their_columns() {
    let (_folder, path) = written();
    let mut journal = Journal::read(&path).unwrap();
    let header = |csv: Vec<u8>| String::from_utf8(csv).unwrap().lines().next().unwrap().to_owned();
    // With rows and without.
    for rows in [true, false] {
        if !rows {
            (journal.rows, journal.artifacts) = (vec![], vec![]);
        }
        let header_of_summary = header(Wide::new(&TRACE, &journal).csv().unwrap());
        let columns: Vec<&str> = header_of_summary.split(',').collect();
        for column in SUMMARY.split(',') {
            assert_eq!(columns.iter().filter(|known| **known == column).count(), 1, "{column}: {header_of_summary}");
        }
        assert_eq!(header(artifacts::csv(&artifacts::rows(&journal)).unwrap()), STRUCTURES);
    }
}

#[test]
fn csv_json_and_journal_agree() {
    let (folder, path) = written();
    let journal = Journal::read(&path).unwrap();
    summary::write(&TRACE, &journal, folder.path()).unwrap();
    let rows = csv_rows(&folder.path().join("summary.csv"));
    let text = std::fs::read_to_string(folder.path().join("run.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["rows"][0]["primary_rays"], 100);
    assert_eq!(json["rows"].as_array().unwrap().len(), rows.len());
    assert_eq!(json["artifacts"].as_array().unwrap().len(), 1);
    assert_eq!(csv_rows(&folder.path().join("structures.csv"))[0]["cells_x"], "3");
    // Derived twice from the same journal: the same bytes.
    summary::write(&TRACE, &Journal::read(&path).unwrap(), folder.path()).unwrap();
    assert_eq!(std::fs::read_to_string(folder.path().join("run.json")).unwrap(), text);

    // By hand, see `fakes::configuration`: frames of 2 and 4 ms by the device's clock, 100 + 50 rays.
    let good = |column: &str| rows[0][column].as_str();
    assert_eq!([good("frame_ms_min"), good("frame_ms_max"), good("frame_ms_mean")], ["2", "4", "3"]);
    assert_eq!([good("wall_ms_mean"), good("timing_source")], ["3.3", "device"]);
    assert_eq!(good("mrays_per_s"), "0.025"); // 150 rays in 6 ms
    assert_eq!([good("primary_rays"), good("shadow_rays"), good("reflected_rays")], ["100", "50", "0"]);
    assert_eq!([good("primary_steps_per_ray"), good("shadow_tests_per_ray")], ["7.5", "2"]);
    assert_eq!([good("reflected_steps_per_ray"), good("variant"), good("triangles")], ["", "default", "12"]);
    // A row without a result has no time, even though the record beneath it still holds samples here.
    let bad = |column: &str| rows[1][column].as_str();
    assert!(journal.rows[1].samples.is_some());
    for column in ["frame_ms_mean", "wall_ms_mean", "mrays_per_s", "timing_source", "pass_overhead"] {
        assert_eq!(bad(column), "", "{column}");
    }
    assert_eq!([bad("status"), bad("verified")], ["wrong", "false"]);
    assert_eq!(bad("message"), "3 hits differ, \"quoted\", with a comma");
}

#[test]
fn tables_say_what_the_device_is_good_for() {
    let (_folder, path) = written();
    let mut journal = Journal::read(&path).unwrap();
    let text = summary::terminal(&TRACE, &journal);
    assert!(text.contains("software rasteriser") && text.contains("do not rank algorithms for a GPU"), "{text}");
    assert!(text.contains("WRONG") && text.contains("3 hits differ"), "{text}");
    journal.provenance.devices[0].info.device_type = rtbench::device::DeviceType::DiscreteGpu;
    assert!(!summary::terminal(&TRACE, &journal).contains("do not rank"));
}

/// A frame of several stages has a time per stage, and a column for each.
#[test]
fn stages_are_columns() {
    let (_folder, path) = written();
    let mut journal = Journal::read(&path).unwrap();
    journal.rows.truncate(1);
    let samples = journal.rows[0].samples.as_mut().unwrap();
    samples.stages = vec!["emit".into(), "prefix-sum".into()];
    samples.stage_ns = Some(vec![vec![vec![1_000_000, 500_000], vec![3_000_000, 500_000]]; 2]);
    let wide = Wide::new(&TRACE, &journal);
    let value = |column: &str| wide.rows[0][wide.column(column).unwrap()].clone().unwrap().number().unwrap();
    assert_eq!((value("emit_ms_mean"), value("prefix_sum_ms_mean"), value("frame_ms_mean")), (2.0, 0.5, 3.0));
}

#[test]
fn the_clock_is_chosen_by_what_it_says() {
    let samples = |device: Option<Vec<u64>>, wall: Vec<u64>| Samples {
        pass_ns: vec![wall.iter().sum()],
        device_ns: device.map(|d| vec![d]),
        wall_ns: vec![wall],
        ..Samples::default()
    };
    let choose = |device, wall| measure::choose_source(&samples(device, wall));
    assert_eq!(choose(Some(vec![100, 100]), vec![105, 105]), (TimingSource::Device, vec![]));
    assert_eq!(choose(None, vec![105, 105]), (TimingSource::Wall, vec![]));
    let (source, warnings) = choose(Some(vec![100, 100]), vec![150, 150]);
    assert_eq!(source, TimingSource::Device);
    assert!(warnings.len() == 1 && warnings[0].contains("+50 %"), "{warnings:?}");
    for broken in [vec![0, 100], vec![u64::MAX - 5, 100]] {
        let (source, warnings) = choose(Some(broken), vec![105, 105]);
        assert_eq!(source, TimingSource::Wall);
        assert!(warnings[0].contains("zero or run backwards"), "{warnings:?}");
    }
    let slow =
        Samples { wall_ns: vec![vec![200], vec![100], vec![101]], pass_ns: vec![200, 100, 101], ..Samples::default() };
    assert!(measure::choose_source(&slow).1[0].contains("first pass"));
}

#[test]
fn rays_and_hits_as_csv() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rays.csv");
    let read = |text: &str| {
        std::fs::write(&path, text).unwrap();
        rays_csv::read(&path)
    };
    // Any order, further columns, spaces, Windows line ends, a byte order mark.
    let given = read(
        "\u{feff}origin_x,note,direction_z,direction_y,direction_x,origin_z,origin_y\r\n1, hello , -1,0,0,3e0,2,extra\r\n",
    )
    .unwrap();
    let wanted = GivenRay { origin: glam::Vec3::new(1.0, 2.0, 3.0), direction: glam::Vec3::new(0.0, 0.0, -1.0) };
    assert_eq!(given, [wanted]);
    let head = "origin_x,origin_y,origin_z,direction_x,direction_y,direction_z\n";
    for (text, problem) in [
        ("origin_x,origin_y,origin_z,direction_x,direction_y\n1,2,3,4,5\n".into(), ":1: no column direction_z"),
        (format!("{head}0,0,0,0,0,1\n0,0,zero,0,0,1\n"), ":3: origin_z is \"zero\""),
        (format!("{head}0,0,0,0,0,1\n0,0,0,0,0\n"), ":3: direction_z is \"\""),
        (format!("{head}0,0,nan,0,0,1\n"), ":2: origin_z is \"nan\""),
        (format!("{head}0,0,0,0,0,1e39\n"), ":2: direction_z is \"1e39\""),
        (format!("{head}0,0,0,0,-0,0\n"), ":2: the direction has no length"),
        (head.into(), ": no rays"),
        (String::new(), ":1: no column origin_x"),
    ] {
        let error = read(&text).unwrap_err().to_string();
        assert!(error.contains(problem) && !error.contains('\n'), "{text:?}: {error}");
    }
    std::fs::write(&path, b"\xff\xfe\x00").unwrap();
    assert!(matches!(rays_csv::read(&path), Err(Error::Input(_))));
    let hits = [Hit { t: 0.1, triangle: 7 }, Hit::NONE, Hit { t: 1.0e-30, triangle: 0 }];
    let text = rays_csv::to_csv(&hits);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!((lines[0], lines[1], lines[2]), ("t,triangle", "0.1,7", ",-1"));
    assert_eq!(lines[3].split(',').next().unwrap().parse::<f32>().unwrap(), 1.0e-30);
    assert_eq!(Hit::NONE.triangle, MISS);
}

proptest! {
    /// Reading any file ends in rays or in one line of error.
    #[test]
    fn any_bytes_as_rays(bytes in prop::collection::vec(any::<u8>(), 0..200), with_header in any::<bool>()) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rays.csv");
        let mut content = if with_header { rays_csv::COLUMNS.join(",").into_bytes() } else { Vec::new() };
        content.push(b'\n');
        content.extend(bytes);
        std::fs::write(&path, content).unwrap();
        if let Err(error) = rays_csv::read(&path) {
            prop_assert!(!error.to_string().contains('\n'), "{}", error);
        }
    }
}

#[test]
fn the_colour_map_is_ordered() {
    let lightness = |[r, g, b, _]: [u8; 4]| {
        let linear = |c: u8| (f64::from(c) / 255.0).powf(2.2);
        0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b)
    };
    let steps: Vec<f64> = (0..=100).map(|i| lightness(picture::heat(i as f32 / 100.0))).collect();
    assert!(steps.windows(2).all(|pair| pair[0] < pair[1]), "{steps:?}");
    assert!(steps[0] < 0.02 && steps[100] > 0.8, "{steps:?}");
    assert_eq!(picture::heat(f32::NAN), picture::heat(1.0));
    assert_eq!(picture::heat(-1.0), picture::heat(0.0));
}

#[test]
fn names_become_file_names() {
    assert_eq!(names::slug("llvmpipe (LLVM 15.0.6, 256 bits)"), "llvmpipe-llvm-15.0.6-256-bits");
    assert_eq!(names::slug("../../etc/passwd"), "etc-passwd");
    assert!(names::slug(&"x".repeat(1000)).len() <= 80);
}

#[test]
fn counters_and_end_are_plain_numbers() {
    let mut sums = CounterSums::default();
    let counters = rtbench::workloads::trace::backend::Counters {
        rays: 1,
        inner: u32::MAX,
        leaves: 2,
        tests: 3,
        pops: 4,
        restarts: 5,
        ..Default::default()
    };
    sums.add(&counters);
    sums.add(&counters);
    assert_eq!((sums.rays, sums.steps(), sums.pops), (2, 2 * u64::from(u32::MAX) + 4, 8));
    let end =
        End { ended: "now".into(), interrupted: true, complete: false, load_average: [0.5; 3], message: "".into() };
    let line = serde_json::to_string(&Record::End(end.clone())).unwrap();
    assert_eq!(serde_json::from_str::<Record>(&line).unwrap(), Record::End(end));
}
