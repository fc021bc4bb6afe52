//! The published numbers: every row parses, the printed metrics follow from the times as documented.

use rtbench::report::{Cell, Table};
use rtbench::sources::Options;
use rtbench::sources::spheres::SOURCE;
use rtbench::sources::spheres::metrics::{karp_flatt, karp_flatt_as_printed, remark};
use rtbench::sources::spheres::published::data;

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
fn the_four_tables_are_as_printed() {
    let published = data();
    assert_eq!((published.metrics.len(), published.processors.len()), (4, 5));
    let some = |rows: &[&[f64]]| rows.iter().map(|row| row.iter().map(|v| Some(*v)).collect()).collect::<Vec<Vec<_>>>();
    let of = |id| numbers(&tables(id)[0]);
    assert_eq!(of("1"), some(&[&[1852.0, 1192.0, 15.58], &[8660.0, 6303.0, 15.89], &[38236.0, 23969.0, 51.48]]));
    assert_eq!(of("2")[2], [Some(38236.0), Some(23969.0), Some(116026.0), Some(8987.0)]);
    assert_eq!(of("3")[0], [550.0, 154.0, 725.0, 120.0, 15.77].map(Some));
    assert_eq!(of("4")[1], [2197.0, 330.0, 1604.0, 511.0, 15.69].map(Some));
}

#[test]
fn printed_metrics_follow_from_the_times_as_documented() {
    let published = data();
    let rows: Vec<(f64, f64, f64, f64)> = published
        .metrics
        .iter()
        .map(|m| {
            let places = m.karp_flatt.places.unwrap();
            let round = |value: f64| format!("{value:.places$}").parse::<f64>().unwrap();
            let p = f64::from(m.processors);
            let e = |formula: fn(f64, f64) -> Option<f64>| formula(m.speed_up.value, p).unwrap();
            (m.karp_flatt.value, round(e(karp_flatt_as_printed)), e(karp_flatt), m.speed_up.value)
        })
        .collect();
    let expected = [0.615, 0.00037, 0.141, 0.000027];
    for (index, ((printed, added, subtracted, _), expected)) in rows.iter().zip(expected).enumerate() {
        // The first is right but for its last digit
        let within = if index == 0 { 0.0011 } else { 1e-9 };
        assert!((printed - added).abs() < within, "{printed} {added}");
        assert!((printed - subtracted).abs() > 0.05 * printed, "{printed} follows from the formula");
        assert!((subtracted / expected - 1.0).abs() < 0.02, "{subtracted} {expected}");
    }
    let table = &tables("metrics")[0];
    let row = |scene: &str, stage: &str, renderer: &str| {
        table.rows.iter().position(|row| row.keys == [scene, stage, renderer]).unwrap_or_else(|| panic!("{scene}"))
    };
    let numbers = numbers(table);
    let first = &numbers[row("random100", "two-pass", "SIMD + threads")];
    let [s, e] = [first[5], first[6]].map(Option::unwrap);
    assert_eq!((first[0], first[2], first[3]), (Some(32.0), Some(1.596), Some(0.680)));
    assert!((s - 1.5952).abs() < 1e-4 && (e - 0.614_833_5).abs() < 1e-6, "{s} {e}");
    // Slower than sequential: more than all of it is serial, and the remark says why
    let slow = row("default", "two-pass", "SIMD");
    assert!((numbers[slow][6].unwrap() - 3.927_285_8).abs() < 1e-6);
    assert!(matches!(&table.rows[slow].cells[4], Cell::Words { value: Some(words), .. } if words == "S < 1"));
    assert!(table.notes.iter().any(|note| note.contains("1/p is added instead of")));
}

#[test]
fn metrics_are_never_without_sense() {
    assert_eq!(karp_flatt(1.0, 1.0), None);
    assert_eq!(karp_flatt(0.0, 8.0), None);
    assert_eq!(karp_flatt(f64::NAN, 8.0), None);
    assert_eq!((karp_flatt(1.0, 4.0), karp_flatt(4.0, 4.0)), (Some(1.0), Some(0.0)));
    assert!(karp_flatt(0.5, 4.0).unwrap() > 1.0 && karp_flatt(5.0, 4.0).unwrap() < 0.0);
    assert_eq!([Some(1.0), Some(4.0), None].map(|p| remark(2.0, p)), ["p = 1", "", "p unknown"]);
    assert_eq!([5.0, 0.5].map(|s| remark(s, Some(4.0))), ["S > p", "S < 1"]);
}
