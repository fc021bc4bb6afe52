//! What must not be mixed: the thesis's numbers and a run's, and build times of unlike builders.

use super::synthetic::{Builder, everything};
use super::tables::{compared, noted, options, row, table, tables};
use rtbench::report::Line;
use rtbench::report::format::{self, Format};
use rtbench::sources::Options;
use rtbench::sources::thesis::data::Data;
use rtbench::sources::thesis::tables::IDS;
use rtbench::sources::thesis::{measured, published};

/// Lines of the CSV form: number of the table, value, published value.
fn csv_lines(data: &Data, options: &Options) -> Vec<[String; 3]> {
    let text = format::write(&tables(data, options, &IDS), Format::Csv);
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    reader.records().map(|r| r.unwrap()).map(|r| [1, 7, 8].map(|i| r[i].to_owned())).collect()
}

#[test]
fn a_published_number_is_never_a_value_of_the_csv() {
    // No run: nothing was measured, and every table has something of 2009.
    let lines = csv_lines(&published::data(), &options());
    assert!(lines.iter().all(|[_, value, _]| value.is_empty()), "a value without a run");
    // The model's table has printed times next to work only
    for id in IDS.into_iter().filter(|id| *id != "simt") {
        assert!(lines.iter().any(|[own, _, published]| own == id && !published.is_empty()), "{id}");
    }
    // With runs, tables of published numbers only keep to that column too: devices, register limit, speed-ups.
    let lines = csv_lines(&measured::data(&everything()), &compared());
    for (id, printed) in [("5.2", "22.4 GB/s"), ("5.7", "261.35"), ("5.8", "430.67"), ("5.3.4", "7.149719")] {
        let of_table = || lines.iter().filter(|[own, ..]| own == id);
        assert!(
            of_table().any(|[_, value, published]| value.is_empty() && published == printed),
            "{id}: {printed} is not there"
        );
        assert!(of_table().all(|[_, value, _]| value != printed), "{id}");
        assert!(of_table().any(|[_, value, _]| !value.is_empty()), "{id}: the run's own are gone");
    }
}

#[test]
fn build_times_of_unlike_builders_have_their_own_tables() {
    let build = |cpu: &str, threads: usize, builds: usize, scenes: &[&str], ms: f64| {
        let mut b = Builder::new();
        b.run.journal.provenance.environment.cpu = cpu.into();
        b.run.journal.provenance.plan.settings.builds = builds;
        for scene in scenes {
            for (structure, times) in [("grid", 1.0), ("kdtree", 3.0), ("bvh", 2.0)] {
                b.built(scene, structure, times * ms, 1.0, 4).build_threads = threads;
            }
        }
        b.run
    };
    let thesis_like = build("old", 1, 3, &["bunny", "museum"], 10.0);
    let later = build("new", 2, 1, &["museum", "dragon"], 1.0);
    let data = measured::data(&[thesis_like, later]);
    let all = tables(&data, &compared(), &["5.3"]);
    let titles: Vec<&str> = all.iter().map(|t| t.title.as_str()).collect();
    assert_eq!(titles, ["Build times, one thread of old", "Build times, 2 threads of new"]);
    // The later run has not replaced the row of one thread, and no column has times of both.
    assert_eq!(row(&all[0], &["museum"], Line::Value), ["10.00", "30.00", "20.00"]);
    assert_eq!(row(&all[0], &["dragon"], Line::Value), ["-"; 3]);
    assert_eq!(row(&all[1], &["museum"], Line::Value), ["1.00", "3.00", "2.00"]);
    assert_eq!(row(&all[1], &["bunny"], Line::Value), ["-"; 3]);
    noted(&all[0], "median of 3 builds");
    noted(&all[1], "built once");
    assert!(!all.iter().flat_map(|t| &t.notes).any(|note| note.contains("more than once")));
    // Every builder builds the same: one table, which says that there were two builds.
    noted(&table(&data, &compared(), "5.4"), "1 of these measurements were made more than once");
    // In any order of the runs, one thread is first.
    let runs = [build("new", 2, 1, &["museum"], 1.0), build("old", 1, 3, &["museum"], 10.0)];
    assert!(tables(&measured::data(&runs), &compared(), &["5.3"])[0].title.ends_with("one thread of old"));
    // The same builder twice is one, and the last time counts.
    let runs = [build("old", 1, 3, &["museum"], 10.0), build("old", 1, 1, &["museum", "bunny"], 20.0)];
    let t = table(&measured::data(&runs), &compared(), "5.3");
    assert_eq!(row(&t, &["museum"], Line::Value)[0], "20.00");
    noted(&t, "3 of these measurements were made more than once");
    let runs = [build("old", 1, 3, &["museum"], 10.0), build("old", 1, 1, &["bunny"], 20.0)];
    noted(&table(&measured::data(&runs), &compared(), "5.3"), "unlike numbers of builds: 1 or 3");
}
