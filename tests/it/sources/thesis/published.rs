//! `results/thesis-2009`: complete, consistent with itself where it is, and with the memory model.

use super::tables::{options, row, table};
use rtbench::report::Line;
use rtbench::sources::thesis::data::Data;
use rtbench::sources::thesis::published::{self, GT8600, GTX280};
use rtbench::sources::thesis::scenes::{SceneKey, ThesisScene};
use rtbench::sources::thesis::structures::{self, STRUCTURES};
use rtbench::workloads::trace::backend::Config;
use rtbench::workloads::trace::common::memory;

#[test]
fn every_row_is_there() {
    let data = published::data();
    assert_eq!((data.scenes.len(), data.devices.len()), (9, 2));
    assert_eq!((data.built.len(), data.counts.len(), data.frames.len()), (27, 72, 463));
    assert_eq!(data.register_limit.len(), 36);
    assert_eq!([&data.devices[0].label, &data.devices[1].label], [GTX280, GT8600]);
    for scene in ThesisScene::ALL {
        let key = SceneKey::Thesis(scene);
        assert!(data.scene(&key).is_some());
        for structure in STRUCTURES {
            let built = data.thesis_built(&key, structure).unwrap();
            assert!(built.build_ms.is_some() && built.thesis_mib.is_some(), "{scene:?} {structure}");
            let rays = if scene.is_object() { 2 } else { 3 };
            assert!((0..rays).all(|ray| data.thesis_counts(&key, structure, ray).is_some()), "{scene:?} {structure}");
        }
    }
    // 5.12 to 5.14 are all there, but for the kd-tree in the conference room with reflections.
    let full = |config| data.frames.iter().filter(|f| (f.device, f.width, f.config) == (0, 1024, config)).count();
    assert_eq!([Config::P, Config::PS, Config::PSR].map(full), [27, 27, 17]);
    for frame in data.frames.iter() {
        assert!(0.0 < frame.min_ms && frame.min_ms <= frame.mean_ms && frame.mean_ms <= frame.max_ms, "{frame:?}");
    }
}

/// The largest difference between the memory model and the published sizes of a structure, in MiB.
fn largest_difference(data: &Data, structure: &str) -> f64 {
    let mut largest: f64 = 0.0;
    for scene in &data.scenes {
        let built = data.thesis_built(&scene.key, structure).unwrap();
        let p = &built.properties;
        let records = (p.references_per_triangle.unwrap_or(0.0) * scene.triangles as f64).round() as u64;
        let cells = [p.cells_x, p.cells_y, p.cells_z].map(|n| u64::from(n.unwrap_or(0))).iter().product();
        let bytes = match structure {
            "grid" => memory::grid_bytes(cells, records, scene.vertices),
            "kdtree" => memory::kdtree_bytes(2 * u64::from(p.leaves.unwrap()) - 1, records, scene.vertices),
            _ => memory::bvh_bytes(p.nodes.unwrap().into(), scene.vertices),
        };
        let difference = (bytes as f64 / f64::from(1 << 20) - built.thesis_mib.unwrap()).abs();
        eprintln!("{structure} {}: {difference:.3} MiB off", scene.key);
        // The buddha's numbers of cells do not follow the rule (docs/thesis-2009.md): it has its own bound.
        let bound = if structure == "grid" && scene.key.thesis() != Some(ThesisScene::Buddha) { 0.025 } else { 0.075 };
        assert!(difference <= bound, "{structure} {}: {difference}", scene.key);
        largest = largest.max(difference);
    }
    largest
}

#[test]
fn the_memory_model_gives_all_27_published_sizes() {
    let mut data = published::data();
    // docs/thesis-2009.md states 0.07, 0.07 and 0.01.
    let largest = STRUCTURES.map(|structure| largest_difference(&data, structure));
    for (found, stated) in largest.into_iter().zip([0.075, 0.075, 0.015]) {
        assert!(found <= stated, "{largest:?}");
    }
    // A wrong size is noticed.
    let mut wrong: Vec<_> = data.built.iter().cloned().collect();
    let row = wrong.iter_mut().find(|b| b.structure == "kdtree").unwrap();
    row.thesis_mib = row.thesis_mib.map(|mib| mib + 0.2);
    data.built = wrong.into_iter().collect();
    assert!(std::panic::catch_unwind(|| largest_difference(&data, "kdtree")).is_err());
}

#[test]
fn speedups_follow_from_the_times_but_for_one() {
    let data = published::data();
    let mut odd = Vec::new();
    for limited in data.register_limit.iter().filter(|row| row.speedup.is_some()) {
        let same = |row: &&rtbench::sources::thesis::data::RegisterLimit| {
            (row.device, row.scene, &row.structure) == (limited.device, limited.scene, &limited.structure)
                && row.speedup.is_none()
        };
        let unlimited = data.register_limit.iter().find(same).unwrap();
        let speedup = 100.0 * (1.0 - limited.mean_ms / unlimited.mean_ms);
        if (speedup - f64::from(limited.speedup.unwrap())).abs() > 2.0 {
            odd.push((limited.device, limited.scene, limited.structure.as_str()));
        }
    }
    assert_eq!(odd, [(0, ThesisScene::Robots, "bvh")], "results/thesis-2009/README.md says so");
}

/// Rows of a file of `results/thesis-2009`, as text by the name of their column.
fn lines(file: &str) -> Vec<impl Fn(&str) -> String> {
    let path = format!("{}/results/thesis-2009/{file}", env!("CARGO_MANIFEST_DIR"));
    let mut reader = csv::Reader::from_path(path).unwrap();
    let headings = reader.headers().unwrap().clone();
    let index = move |name: &str| headings.iter().position(|h| h == name).unwrap();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    rows.into_iter()
        .map(|row| {
            let index = index.clone();
            move |name: &str| row[index(name)].to_owned()
        })
        .collect()
}

/// What a printed table has in the row of these keys.
#[track_caller]
fn printed(data: &Data, id: &str, keys: &[&str]) -> Vec<String> {
    row(&table(data, &options(), id), keys, Line::Value)
}

#[test]
fn a_printed_time_is_written_with_the_digits_that_were_printed() {
    let data = published::data();
    for line in lines("build_times_ms.csv") {
        let times = ["grid_ms", "kdtree_ms", "bvh_ms"].map(&line);
        assert_eq!(printed(&data, "5.3", &[&line("scene")]), times);
    }
    let number = |line: &dyn Fn(&str) -> String| ["P", "PS", "PSR"].iter().position(|c| *c == line("config")).unwrap();
    let b = ["B.1", "B.2", "B.3", "B.4", "B.5", "B.6"].map(|id| table(&data, &options(), id));
    let at_1024 = ["5.12", "5.13", "5.14"].map(|id| table(&data, &options(), id));
    for line in lines("frame_times_ms.csv") {
        let times = ["min_ms", "max_ms", "mean_ms"].map(&line);
        let (scene, side) = (line("scene"), line("resolution"));
        let from = 3 * STRUCTURES.iter().position(|s| *s == line("structure")).unwrap();
        let of_faster = line("device") == GTX280;
        let t = &b[number(&line) + if of_faster { 0 } else { 3 }];
        assert_eq!(row(t, &[&scene, &side], Line::Value)[from..from + 3], times, "{scene} {side} {}", t.title);
        if of_faster && side == "1024" {
            assert_eq!(row(&at_1024[number(&line)], &[&scene], Line::Value)[from..from + 3], times, "{scene}");
        }
    }
}

#[test]
fn every_other_printed_number_has_its_digits_too() {
    let data = published::data();
    for (file, id, columns) in [
        ("scenes.csv", "5.1", &["triangles", "vertices"][..]),
        (
            "grid_properties.csv",
            "5.4",
            &["cells_x", "cells_y", "cells_z", "max_cell_triangles", "references_per_triangle", "size_mib"],
        ),
        (
            "kdtree_properties.csv",
            "5.5",
            &["leaves", "empty_leaves", "max_leaf_triangles", "references_per_triangle", "size_mib"],
        ),
        ("bvh_properties.csv", "5.6", &["nodes", "size_mib"]),
    ] {
        for line in lines(file) {
            let numbers: Vec<String> = columns.iter().map(|name| line(name)).collect();
            assert_eq!(printed(&data, id, &[&line("scene")])[..columns.len()], numbers, "{file}");
        }
    }
    for line in lines("traversal_counts.csv") {
        let ray = ["primary", "shadow", "reflected"].iter().position(|r| *r == line("ray_type")).unwrap();
        let id = ["5.9", "5.10", "5.11"][STRUCTURES.iter().position(|s| *s == line("structure")).unwrap()];
        let cells = printed(&data, id, &[&line("scene")]);
        let numbers = ["steps_per_ray", "primitive_tests_per_ray", "restarts_per_ray"].map(&line);
        for (group, number) in numbers.iter().enumerate().filter(|(_, number)| !number.is_empty()) {
            assert_eq!(cells[3 * group + ray], *number, "{id} {}", line("scene"));
        }
    }
    for line in lines("register_limit.csv") {
        let id = if line("device") == GTX280 { "5.8" } else { "5.7" };
        let structure = structures::title(&line("structure")).to_owned();
        let cells = printed(&data, id, &[&structure, &line("registers"), &line("occupancy_percent")]);
        let from = 2 * ["robots", "kitchen", "museum"].iter().position(|s| *s == line("scene")).unwrap();
        let numbers = ["mean_ms", "speedup_percent"].map(&line).map(|n| if n.is_empty() { "-".into() } else { n });
        assert_eq!(cells[from..from + 2], numbers, "{id}");
    }
}
