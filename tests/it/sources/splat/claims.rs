//! Every claim in every verdict.

use super::synthetic::{Builder, FRAMES, everything, set, set_part};
use rtbench::compare::judge::Verdict;
use rtbench::record::row::Status;
use rtbench::sources::Options;
use rtbench::sources::claims::{Basis, Finding, Form, write};
use rtbench::sources::splat::SOURCE;

fn findings(b: Builder) -> Vec<Finding> {
    (SOURCE.read)(&[b.run()]).claims(&Options::default())
}

fn finding(b: Builder, claim: &str) -> Finding {
    findings(b).into_iter().find(|f| f.claim == claim).unwrap()
}

/// A row that decides nothing, and those of `fill`.
fn filled(mut b: Builder, fill: impl Fn(&mut Builder)) -> Builder {
    b.row("box", "reference", &[]).metrics.clear();
    fill(&mut b);
    b
}

/// Two rows of Sponza that differ in an option, with times of stages.
fn pair(b: &mut Builder, technique: &str, options: [&str; 2], stage: &str, times: [f64; 2]) {
    for (option, ms) in options.iter().zip(times) {
        b.row("sponza", &format!("{technique} {option}"), &[(stage, ms)]);
    }
}

/// Two rows of Sponza that differ in an option, with values of metrics.
fn counts(b: &mut Builder, technique: &str, options: [&str; 2], metrics: &[(&str, [f64; 2])]) {
    for (index, option) in options.iter().enumerate() {
        let row = b.row("sponza", &format!("{technique} {option}"), &[]);
        metrics.iter().for_each(|(name, values)| set(row, name, values[index]));
    }
}

/// A row of per-sample and one of buckets, with a metric each.
fn both(b: &mut Builder, of_lists: (&str, f64), of_buckets: (&str, f64)) {
    set(b.row("sponza", "per-sample", &[]), of_lists.0, of_lists.1);
    set(b.row("sponza", "buckets", &[]), of_buckets.0, of_buckets.1);
}

/// Photon evaluations of three frames, as factors.
fn evaluations(b: &mut Builder, factors: [f64; 3]) {
    let row = b.row("sponza", "per-sample", &[]);
    for (frame, factor) in factors.iter().enumerate() {
        set_part(row, &format!("frame-{}", frame + 1), "evaluations", (1e6 * factor) as u64);
    }
}

/// Errors of the smaller and the larger radius with 1000 and with 10,000 paths.
fn errors(b: &mut Builder, small: [f64; 2], large: [f64; 2]) {
    for (radius, errors) in [("0.01", small), ("0.1", large)] {
        for (paths, error) in ["1000", "10000"].iter().zip(errors) {
            set(b.row("sponza", &format!("per-sample radius={radius} paths={paths}"), &[]), "rmse", error);
        }
    }
}

/// Paths of Sponza that arrive at the last hit.
fn arrived(b: &mut Builder, last: u64) {
    set_part(b.row("sponza", "reference", &[]), "hit-4", "arrived", last);
}

/// Bytes of identifiers by key in two scenes.
fn flags(b: &mut Builder, bytes: [u64; 2]) {
    for (scene, bytes) in ["sponza", "sibenik"].iter().zip(bytes) {
        set_part(b.row(scene, "per-sample", &[]), "identifiers by key", "bytes", bytes);
    }
}

type Fill = fn(&mut Builder);

/// A claim, rows of which it holds, rows of which it does not, and rows that do not decide it, if there can be any.
type Trial = (&'static str, Fill, Fill, Option<Fill>);

const UNIQUE: [&str; 2] = ["unique=flags", "unique=sort"];
const BOUNDS: [&str; 2] = ["bounds=direct", "bounds=two-step"];
const KEYS: [&str; 2] = ["key=morton", "key=concat"];
const NORMALS: [&str; 2] = ["normals=off", "normals=faces"];
const SYNC: [&str; 2] = ["sync=device", "sync=readback"];
const RADII: [&str; 2] = ["radius=0.03", "radius=0.1"];
const TILES: [&str; 2] = ["tile=8", "tile=16"];

fn row(b: &mut Builder, technique: &str, times: &[(&str, f64)]) {
    b.row("sponza", technique, times);
}

fn metric(b: &mut Builder, technique: &str, name: &str, value: f64) {
    set(b.row("sponza", technique, &[]), name, value);
}

/// On a GPU: by times where the claim is about times.
const TRIALS: [Trial; 18] = [
    (
        "1",
        |b| row(b, "per-sample", &[]),
        |b| row(b, "buckets", &[("keys", 5.0)]),
        Some(|b| row(b, "per-sample", &[("keys", 0.7)])),
    ),
    (
        "2",
        |b| pair(b, "buckets", TILES, "unique", [0.2, 0.21]),
        |b| pair(b, "buckets", TILES, "unique", [0.2, 0.5]),
        Some(|b| pair(b, "buckets", TILES, "unique", [0.2, 0.235])),
    ),
    (
        "3",
        |b| pair(b, "per-sample", UNIQUE, "unique", [0.2, 0.8]),
        |b| pair(b, "per-sample", UNIQUE, "unique", [0.8, 0.2]),
        Some(|b| pair(b, "per-sample", UNIQUE, "unique", [0.2, 0.21])),
    ),
    (
        "4",
        |b| pair(b, "buckets", BOUNDS, "bounds", [2.0, 0.2]),
        |b| pair(b, "buckets", BOUNDS, "bounds", [2.0, 1.0]),
        Some(|b| pair(b, "buckets", BOUNDS, "bounds", [2.0, 0.25])),
    ),
    (
        "5a",
        |b| row(b, "per-sample", &[]),
        |b| row(b, "per-sample", &[("estimate", 5.0)]),
        Some(|b| row(b, "per-sample", &[("estimate", 19.9)])),
    ),
    (
        "5b",
        |b| row(b, "buckets", &[]),
        |b| row(b, "buckets", &[("estimate", 10.0)]),
        Some(|b| row(b, "buckets", &[("estimate", 0.9)])),
    ),
    (
        "6",
        |b| both(b, ("x", 0.0), ("x", 0.0)),
        |b| {
            row(b, "per-sample", &[]);
            row(b, "buckets", &[("estimate", 60.0)]);
        },
        Some(|b| {
            row(b, "per-sample", &[]);
            row(b, "buckets", &[("buckets", 8.7), ("estimate", 7.75)]);
        }),
    ),
    ("7", |b| evaluations(b, FRAMES), |b| evaluations(b, [1.1, 1.0, 0.9]), Some(|b| evaluations(b, [0.9, 1.1, 1.02]))),
    (
        "8",
        |b| pair(b, "buckets", RADII, "estimate", [0.3, 0.31]),
        |b| pair(b, "buckets", RADII, "estimate", [0.3, 0.6]),
        Some(|b| pair(b, "buckets", RADII, "estimate", [0.3, 0.35])),
    ),
    (
        "9",
        |b| metric(b, "buckets", "fullest_cluster_mean", 3000.0),
        |b| metric(b, "buckets", "fullest_cluster_mean", 1000.0),
        Some(|b| metric(b, "buckets", "fullest_cluster_mean", 1350.0)),
    ),
    (
        "10",
        |b| counts(b, "buckets", KEYS, &[("inner_nodes_mean", [975.0, 3500.0]), ("box_tests_mean", [7e6, 11e6])]),
        |b| counts(b, "buckets", KEYS, &[("inner_nodes_mean", [975.0, 3500.0]), ("box_tests_mean", [11e6, 7e6])]),
        Some(|b| counts(b, "buckets", KEYS, &[])),
    ),
    (
        "11",
        |b| counts(b, "buckets", TILES, &[("clusters_mean", [6500.0, 2500.0])]),
        |b| metric(b, "buckets", "clusters_max", 60_000.0),
        Some(|b| metric(b, "buckets", "clusters_max", 45_000.0)),
    ),
    (
        "12",
        |b| pair(b, "per-sample", SYNC, "estimate", [68.0, 69.0]),
        |b| pair(b, "per-sample", SYNC, "estimate", [68.0, 98.0]),
        Some(|b| pair(b, "per-sample", SYNC, "estimate", [68.0, 83.0])),
    ),
    (
        "13",
        |b| both(b, ("rmse", 0.3), ("rmse", 0.5)),
        |b| both(b, ("rmse", 0.5), ("rmse", 0.3)),
        Some(|b| both(b, ("rmse", 0.3), ("rmse", 0.301))),
    ),
    (
        "14",
        |b| errors(b, [0.5, 0.2], [0.35, 0.3]),
        |b| errors(b, [0.35, 0.3], [0.5, 0.2]),
        Some(|b| errors(b, [0.5, 0.2], [0.5, 0.2])),
    ),
    ("15", |b| arrived(b, 4000), |b| arrived(b, 5660), Some(|b| arrived(b, 5497))),
    (
        "16",
        |b| counts(b, "buckets", NORMALS, &[("assignments_mean", [4e6, 3e6])]),
        |b| counts(b, "buckets", NORMALS, &[("assignments_mean", [4e6, 5e6])]),
        Some(|b| counts(b, "buckets", NORMALS, &[])),
    ),
    ("17", |b| flags(b, [4 << 23; 2]), |b| flags(b, [4 << 23, 4 << 22]), None),
];

/// On a device that computes on the CPU: by counts.
const SOFTWARE_TRIALS: [Trial; 3] = [
    (
        "4",
        |b| counts(b, "buckets", BOUNDS, &[("atomics_bounds_mean", [777_600.0, 0.0])]),
        |b| counts(b, "buckets", BOUNDS, &[]),
        Some(|b| counts(b, "buckets", BOUNDS, &[("atomics_bounds_mean", [777_600.0, 400_000.0])])),
    ),
    (
        "5a",
        |b| row(b, "per-sample", &[]),
        |b| metric(b, "per-sample", "photon_evaluations_mean", 5e6),
        Some(|b| metric(b, "per-sample", "photon_evaluations_mean", 30e6)),
    ),
    (
        "6",
        |b| both(b, ("photon_evaluations_mean", 79e6), ("x", 0.0)),
        |b| both(b, ("photon_evaluations_mean", 10e6), ("x", 0.0)),
        Some(|b| both(b, ("photon_evaluations_mean", 50e6), ("x", 0.0))),
    ),
];

fn verdicts(trials: &[Trial], device: fn() -> Builder) {
    for (id, holds, fails, undecided) in trials {
        let expected = [
            (Some(*holds), Verdict::Holds),
            (Some(*fails), Verdict::DoesNotHold),
            (*undecided, Verdict::Undecided),
            (Some((|_| ()) as Fill), Verdict::NotMeasured),
        ];
        for (fill, verdict) in expected {
            let Some(fill) = fill else { continue };
            let finding = finding(filled(device(), fill), id);
            assert_eq!(finding.verdict, verdict, "{id}: {:?}", finding.cases);
            assert!(finding.cases.iter().all(|case| !case.numbers.contains("NaN")), "{id}: {:?}", finding.cases);
        }
    }
}

#[test]
fn every_claim_has_every_verdict_on_a_gpu() {
    let ids: Vec<&str> = findings(Builder::new()).iter().map(|f| f.claim).collect();
    assert_eq!(ids, TRIALS.map(|(id, ..)| id));
    verdicts(&TRIALS, Builder::new);
}

#[test]
fn counts_decide_in_place_of_times_without_a_gpu() {
    verdicts(&SOFTWARE_TRIALS, Builder::software);
    for (id, holds, ..) in SOFTWARE_TRIALS {
        let finding = finding(filled(Builder::software(), holds), id);
        assert_eq!((finding.basis, finding.without_gpu), (Basis::Counts, false), "{id}");
        assert!(finding.warnings[0].contains("counts of operations"), "{id}: {:?}", finding.warnings);
    }
    // Claims that need no times have the same verdict on any device
    let exact: Vec<Trial> =
        TRIALS.into_iter().filter(|(id, ..)| ["9", "10", "11", "13", "14", "15", "16", "17"].contains(id)).collect();
    assert_eq!(exact.len(), 8);
    verdicts(&exact, Builder::software);
}

#[test]
fn times_of_a_software_device_leave_claims_undecided_with_their_ratio() {
    for (id, holds, fails, _) in TRIALS.into_iter().filter(|(id, ..)| ["1", "2", "3", "8", "12"].contains(id)) {
        for fill in [holds, fails] {
            let finding = finding(filled(Builder::software(), fill), id);
            assert_eq!((finding.verdict, finding.without_gpu), (Verdict::Undecided, true), "{id}");
            assert!(finding.warnings[0].contains("a software device"), "{:?}", finding.warnings);
            let numbers = &finding.cases[0].numbers;
            assert!(numbers.contains(" ms: "), "{id}: {numbers}");
        }
    }
    // Whose counts are of unlike operations
    let of_buckets = finding(filled(Builder::software(), |b| row(b, "buckets", &[])), "5b");
    assert_eq!((of_buckets.verdict, of_buckets.without_gpu), (Verdict::Undecided, true));
    let numbers = &of_buckets.cases[0].numbers;
    assert_eq!(numbers, "6,998,400 directions tested, 11,000,000 box tests and additions");
    // The seventh is about a correlation, which any device has
    let (_, holds, fails, _) = TRIALS[7];
    let of = |fill: Fill| finding(filled(Builder::software(), fill), "7");
    assert_eq!((of(holds).verdict, of(fails).verdict), (Verdict::Holds, Verdict::DoesNotHold));
    assert!(of(holds).without_gpu && of(holds).cases[0].numbers.contains("correlation 1.000 over 3 frames"));
}

#[test]
fn printed_numbers_are_judged_in_the_same_way() {
    for finding in (SOURCE.read)(&[]).claims(&Options::default()) {
        let expected = match finding.claim {
            "1" | "5a" | "5b" | "6" => Verdict::Holds,
            _ => Verdict::NotMeasured,
        };
        assert_eq!((finding.verdict, finding.contradicting), (expected, 0), "{}: {:?}", finding.claim, finding.cases);
    }
    let all = (SOURCE.read)(&[everything()]).claims(&Options::default());
    assert_eq!(all.iter().find(|f| f.claim == "6").unwrap().published, Some((2, 2)));
    for form in [Form::Text, Form::Markdown, Form::Json] {
        let text = write(std::slice::from_ref(&all), "1 run", form);
        assert!(!text.contains("NaN") && !text.contains("inf "), "{text}");
    }
}

#[test]
fn only_rows_that_are_otherwise_equal_are_compared() {
    // Another seed, and another number of passes
    let seeds = filled(Builder::new(), |b| {
        row(b, "per-sample", &[]);
        row(b, "buckets seed=2", &[]);
    });
    assert_eq!(finding(seeds, "6").verdict, Verdict::NotMeasured);
    let passes = filled(Builder::new(), |b| {
        row(b, "per-sample unique=flags", &[]);
        b.row("sponza", "per-sample unique=sort", &[]).settings.passes = 2;
    });
    assert_eq!(finding(passes, "3").verdict, Verdict::NotMeasured);
    let wrong = filled(Builder::new(), |b| {
        row(b, "per-sample", &[]);
        b.row("sponza", "buckets", &[]).refuse(Status::Wrong, "pixel 3 differs");
    });
    let finding = finding(wrong, "6");
    assert_eq!(finding.verdict, Verdict::NotMeasured);
    assert!(finding.failed[0].contains("buckets (pixel 3 differs)"), "{:?}", finding.failed);
}

#[test]
fn noise_leaves_a_small_difference_undecided() {
    let noisy = |noise: f64| {
        let mut b = Builder::new();
        b.noise = noise;
        pair(&mut b, "per-sample", UNIQUE, "unique", [0.2, 0.3]);
        finding(b, "3").verdict
    };
    assert_eq!((noisy(1.0), noisy(20.0)), (Verdict::Holds, Verdict::Undecided));
}

#[test]
fn radii_alone_do_not_decide_about_noise() {
    let of = |rmse: [f64; 3], ratio: [f64; 3]| {
        let mut b = Builder::new();
        for (index, radius) in ["0.01", "0.03", "0.1"].iter().enumerate() {
            let row = b.row("box", &format!("reference radius={radius}"), &[]);
            set(row, "rmse", rmse[index]);
            set(row, "ratio_to_path_traced", ratio[index]);
        }
        finding(b, "14")
    };
    for rmse in [[0.4, 0.2, 0.3], [0.2, 0.4, 0.5]] {
        let undecided = of(rmse, [0.99, 0.97, 0.9]);
        assert_eq!((undecided.verdict, undecided.cases.len()), (Verdict::Undecided, 1), "{:?}", undecided.cases);
    }
    assert_eq!(of([0.4, 0.2, 0.3], [0.9, 0.97, 0.99]).verdict, Verdict::DoesNotHold);
}

#[test]
fn a_closed_scene_says_nothing_about_open_sky_and_is_named() {
    let closed = filled(Builder::new(), |b| set_part(b.row("box", "per-sample", &[]), "hit-4", "arrived", 5667u64));
    let finding = finding(closed, "15");
    assert_eq!(finding.verdict, Verdict::NotMeasured);
    assert!(finding.left_out[0].contains("box loses 0.0 % of its paths"), "{:?}", finding.left_out);
}

/// Where the width of keys was recorded, it decides which rows are compared, and how large their flags must be.
#[test]
fn a_recorded_width_decides_about_flags() {
    let of = |bits: u64| {
        let mut b = Builder::new();
        flags(&mut b, [4 << 23; 2]);
        b.general.rows.iter_mut().for_each(|row| set(row, "key_bits", bits));
        finding(b, "17").verdict
    };
    assert_eq!((of(23), of(24)), (Verdict::Holds, Verdict::DoesNotHold));
}

/// Bits have an identifier for 32 keys. Where no buffers were recorded, the thesis's accounting is judged.
#[test]
fn identifiers_are_judged_as_allocated() {
    let of = |unique: &str, bytes: Option<u64>| {
        let mut b = Builder::new();
        for scene in ["sponza", "sibenik"] {
            let row = b.row(scene, &format!("buckets unique={unique}"), &[]);
            row.metrics.retain(|metric| metric.of.as_deref() != Some("identifiers by key"));
            if let Some(bytes) = bytes {
                set_part(row, "identifiers by key", "bytes", bytes);
            }
        }
        finding(b, "17")
    };
    let verdicts = [of("bits", Some(4 << 18)), of("bits", Some(4 << 23)), of("sort", Some(4 << 23))].map(|f| f.verdict);
    assert_eq!(verdicts, [Verdict::Holds, Verdict::DoesNotHold, Verdict::Holds]);
    let accounting = of("bits", None);
    assert_eq!(accounting.verdict, Verdict::Holds);
    assert!(accounting.cases[0].numbers.contains("by the thesis's accounting"), "{:?}", accounting.cases);
}

#[test]
fn a_blur_is_compared_with_none() {
    let of = |rmse: f64| {
        let blur = filled(Builder::new(), |b| counts(b, "buckets", ["blur=0", "blur=4"], &[("rmse", [0.5, rmse])]));
        finding(blur, "13").verdict
    };
    assert_eq!((of(0.4), of(0.6)), (Verdict::Holds, Verdict::DoesNotHold));
}
