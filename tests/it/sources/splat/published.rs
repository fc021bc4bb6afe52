//! The published numbers: every row parses, and what follows from them.

use rtbench::report::{Cell, Table};
use rtbench::sources::Options;
use rtbench::sources::splat::published::{DEVICES, data};
use rtbench::sources::splat::stages::{Group, STAGES, group};
use rtbench::sources::splat::{SOURCE, slices};

fn tables(id: &'static str) -> Vec<Table> {
    (SOURCE.read)(&[]).tables(&[id], &Options::default())
}

fn numbers(table: &Table) -> Vec<Vec<Option<f64>>> {
    let of = |cell: &Cell| match cell {
        Cell::Number { value, .. } => value.map(|v| v.value),
        _ => None,
    };
    table.rows.iter().map(|row| row.cells.iter().map(of).collect()).collect()
}

#[test]
fn every_file_has_its_rows() {
    let p = data();
    let rows = [p.stage_times.len(), p.charts.len(), p.scenes.len(), p.gpus.len(), p.sizes.len()];
    assert_eq!((rows, p.key_bits.len()), ([10, 10, 3, 4, 13], 64));
    assert_eq!((p.kernels.len(), p.statements.len()), (21, 37));
    let charted = p.gpus.iter().filter(|gpu| !gpu.charts.is_empty());
    let charted: Vec<&str> = charted.map(|gpu| gpu.device.as_str()).collect();
    assert_eq!(charted, DEVICES);
    // Every kernel's stage is one of ours, in the same group
    for kernel in &p.kernels {
        let of = if kernel.stage_here == "hit-N" { Some(Group::A) } else { group(&kernel.stage_here) };
        assert_eq!(of, Some(kernel.group), "{}", kernel.kernel);
    }
    assert!(STAGES.iter().all(|(name, of)| group(name) == Some(*of)) && group("other").is_none());
}

#[test]
fn figure_5_2_is_as_printed_with_its_sums_and_shares() {
    let tables = tables("5.2");
    let ms = numbers(&tables[0]);
    assert_eq!(ms[0], [1.7, 0.6, 3.4, 14.9, 68.7].map(Some).into_iter().chain([ms[0][5], None]).collect::<Vec<_>>());
    let sums = [ms[0][5], ms[1][5]].map(Option::unwrap);
    assert!((sums[0] - 89.3).abs() < 1e-9 && (sums[1] - 19.2).abs() < 1e-9, "{sums:?}");
    let shares = numbers(&tables[1]);
    let (of_lists, of_buckets) = (shares[0][4].unwrap(), shares[1][3].unwrap());
    assert!((of_lists - 76.93).abs() < 0.01 && (of_buckets - 68.23).abs() < 0.01, "{of_lists} {of_buckets}");
}

#[test]
fn charts_and_sizes_are_as_printed() {
    let frames = numbers(&tables("frames")[0]);
    assert_eq!(frames.len(), 8);
    assert_eq!((frames[0][2], frames[0][5]), (Some(240.0), Some(14e6)));
    assert_eq!((frames[7][2], frames[7][5]), (Some(37.5), Some(5e6)));
    for size in data().sizes {
        let Some((printed, bytes)) = size.printed.zip(size.bytes.map(|bytes| bytes as f64)) else { continue };
        let unit = |giga: f64, mega: f64| if size.unit == "GiB" { giga } else { mega };
        let exact = match size.agrees_as.as_str() {
            "exact" => bytes,
            "MiB" => bytes / 1_048_576.0,
            _ => bytes / unit(1e9, 1e6),
        };
        // Rounded, or as the thesis says "almost" and "about"
        assert!((exact / printed.value - 1.0).abs() < 0.1, "{}: {exact} {}", size.quantity, printed.value);
    }
}

#[test]
fn bits_of_keys_follow_from_the_formula() {
    let table = &tables("keys")[0];
    assert!(table.notes.iter().any(|note| note.contains("64 of 64 rows agree")), "{:?}", table.notes);
    assert!(table.notes.iter().any(|note| note.contains("they need 9 and 10")), "{:?}", table.notes);
    assert!((slices(2160.0, 32.0, 90.0, 1e4) - 315.4).abs() < 0.05);
    // The workload's own keys have as many slices
    use rtbench::workloads::size::Size;
    use rtbench::workloads::splat::clusters::layout::KeyLayout;
    use rtbench::workloads::splat::clusters::setting::ClusterSetting;
    for tile in [16, 32, 64] {
        let setting = ClusterSetting { tile, ..ClusterSetting::default() };
        let layout = KeyLayout::new(&setting, Size { width: 1920, height: 1080 }, 60.0, (0.001, 10.0)).unwrap();
        let own = slices(1080.0, f64::from(tile), 60.0, 1e4);
        assert_eq!(f64::from(layout.slices), own.floor() + 1.0, "tile {tile}");
    }
}
