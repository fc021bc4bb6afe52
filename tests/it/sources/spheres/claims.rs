//! Every claim in every verdict.

use super::synthetic::{Builder, STAGES, everything};
use rtbench::compare::judge::Verdict;
use rtbench::device::DeviceType;
use rtbench::record::row::Status;
use rtbench::sources::Options;
use rtbench::sources::claims::{Basis, Finding, Form, write};
use rtbench::sources::spheres::SOURCE;

fn findings(b: Builder, processors: Option<u32>) -> Vec<Finding> {
    (SOURCE.read)(&[b.run()]).claims(&Options { processors, ..Options::default() })
}

fn finding(b: Builder, claim: &str) -> Finding {
    findings(b, Some(1024)).into_iter().find(|f| f.claim == claim).unwrap()
}

/// A run that `fill` makes of one that decides nothing.
fn with(fill: impl Fn(&mut Builder)) -> Builder {
    let mut b = Builder::new();
    b.row("a/file.json", "sequential two-pass", 1.0);
    fill(&mut b);
    b
}

/// Rows of a scene of 20 spheres.
fn rows(b: &mut Builder, rows: &[(&str, f64)]) {
    for (setting, ms) in rows {
        b.row("random20", setting, *ms);
    }
}

/// Sequential and SIMD alone in a version.
fn pair(b: &mut Builder, stage: usize, sequential: f64, simd: f64) {
    // The exits change SIMD alone
    let of_sequential = STAGES[stage.min(1)];
    let simd_setting = format!("simd:4 {}", STAGES[stage]);
    rows(b, &[(&format!("sequential {of_sequential}"), sequential), (&simd_setting, simd)]);
}

/// Two passes and one pass of sequential and SIMD.
fn one_pass(b: &mut Builder, sequential: [f64; 2], simd: [f64; 2]) {
    for (renderer, times) in [("sequential", sequential), ("simd:4", simd)] {
        for (stage, ms) in STAGES.iter().zip(times) {
            rows(b, &[(&format!("{renderer} {stage}"), ms)]);
        }
    }
}

/// Sequential in the four combinations of algorithm and exit: two-pass without and with, one-pass without and with.
fn combinations(b: &mut Builder, renderer: &str, times: [f64; 4]) {
    for (words, ms) in ["two-pass", "two-pass exit", "one-pass", "one-pass exit"].iter().zip(times) {
        rows(b, &[(&format!("{renderer} {words}"), ms)]);
    }
}

/// First and last version of SIMD alone, on all three scenes.
fn first_to_last(b: &mut Builder, gains: [f64; 3]) {
    for (scene, gain) in ["default", "random20", "random100"].iter().zip(gains) {
        b.row(scene, "simd:4 two-pass", 10.0 * gain);
        b.row(scene, "simd:4 one-pass exit nohit nodisc", 10.0);
    }
}

/// Half precision in half of the time, or in as much of it as `ms`.
fn half_speed(b: &mut Builder, ms: f64) {
    rows(b, &[("simd:4 one-pass exit nohit nodisc", 10.0), ("simd:4 one-pass exit nohit nodisc f16", ms)]);
    b.general.rows.last_mut().unwrap().metrics.push(rtbench::record::row::Metric::new("rmse", 0.1));
}

fn half(b: &mut Builder, rmse: f64) {
    b.half("random20", rmse);
}

/// The GPU's time with 100 spheres in every version, where the others take seconds.
fn gpu(b: &mut Builder, sequential: f64, gpu: f64) {
    for stage in &STAGES[..2] {
        b.row("random100", &format!("sequential {stage}"), sequential);
        b.row("random100", &format!("gpu {stage}"), gpu);
    }
}

/// Times of SIMD with threads in the first and the last version, where sequential takes 100 ms.
fn serial(b: &mut Builder, first: f64, last: f64) {
    rows(b, &[("sequential two-pass", 100.0), ("sequential one-pass exit", 100.0)]);
    rows(b, &[("simd-threads:4 two-pass", first), ("simd-threads:4 one-pass exit nohit nodisc", last)]);
}

/// A claim, rows of which it holds, rows of which it does not, and rows that do not decide it.
type Trial = (&'static str, fn(&mut Builder), fn(&mut Builder), fn(&mut Builder));

const TRIALS: [Trial; 14] = [
    ("1", |b| pair(b, 0, 10.0, 30.0), |b| pair(b, 0, 30.0, 10.0), |b| pair(b, 0, 10.0, 10.5)),
    (
        "2",
        |b| rows(b, &[("sequential two-pass", 100.0), ("threads two-pass", 15.0)]),
        |b| rows(b, &[("sequential two-pass", 100.0), ("threads two-pass", 35.0)]),
        |b| rows(b, &[("sequential two-pass", 100.0), ("threads two-pass", 24.0)]),
    ),
    (
        "3",
        |b| one_pass(b, [20.0, 10.0], [60.0, 10.0]),
        |b| one_pass(b, [60.0, 10.0], [20.0, 10.0]),
        |b| one_pass(b, [10.5, 10.0], [10.2, 10.0]),
    ),
    (
        "4",
        |b| combinations(b, "simd:4", [40.0, 12.0, 38.0, 10.0]),
        |b| combinations(b, "simd:4", [40.0, 38.0, 12.0, 10.0]),
        |b| combinations(b, "simd:4", [40.0, 20.0, 20.0, 10.0]),
    ),
    (
        "5",
        |b| {
            combinations(b, "simd:4", [40.0, 20.0, 20.0, 10.0]);
            combinations(b, "sequential", [40.0, 20.0, 40.0, 20.0]);
        },
        |b| {
            combinations(b, "simd:4", [40.0, 20.0, 40.0, 20.0]);
            combinations(b, "sequential", [40.0, 20.0, 20.0, 10.0]);
        },
        |b| {
            combinations(b, "simd:4", [40.0, 20.0, 40.0, 20.0]);
            combinations(b, "sequential", [40.0, 20.0, 40.0, 20.0]);
        },
    ),
    ("6", |b| pair(b, 1, 10.0, 20.0), |b| pair(b, 1, 20.0, 10.0), |b| pair(b, 1, 10.0, 10.5)),
    (
        "7",
        |b| rows(b, &[("simd-threads:4 one-pass exit", 20.0), ("simd-threads:4 one-pass exit nohit nodisc", 10.0)]),
        |b| rows(b, &[("simd:4 one-pass exit", 10.0), ("simd:4 one-pass exit nohit nodisc", 12.0)]),
        |b| rows(b, &[("simd:4 one-pass exit", 10.0), ("simd:4 one-pass exit nohit nodisc", 9.8)]),
    ),
    ("8", |b| pair(b, 2, 15.0, 10.0), |b| pair(b, 2, 10.0, 15.0), |b| pair(b, 2, 10.0, 10.5)),
    (
        "9",
        |b| first_to_last(b, [16.0, 20.0, 8.0]),
        |b| first_to_last(b, [9.0, 10.0, 8.0]),
        |b| first_to_last(b, [9.0, 15.0, 8.0]),
    ),
    ("10a", |b| half_speed(b, 5.0), |b| half_speed(b, 10.0), |b| half_speed(b, 6.0)),
    ("10b", |b| half(b, 0.05), |b| half(b, 0.01), |b| half(b, 0.0316)),
    (
        "11",
        |b| gpu(b, 1000.0, 1.0),
        |b| gpu(b, 1000.0, 20.0),
        |b| rows(b, &[("sequential two-pass", 10.0), ("gpu two-pass", 10.2)]),
    ),
    ("12", |b| serial(b, 60.0, 20.0), |b| serial(b, 20.0, 60.0), |b| serial(b, 20.0, 20.5)),
    ("13", |b| pair(b, 2, 13.0, 10.0), |b| pair(b, 2, 30.0, 10.0), |b| pair(b, 2, 20.0, 10.0)),
];

#[test]
fn every_claim_in_every_verdict() {
    let all = (SOURCE.read)(&[everything()]).claims(&Options::default());
    let ids: Vec<&str> = all.iter().map(|finding| finding.claim).collect();
    assert_eq!(ids, TRIALS.map(|trial| trial.0));
    for (id, holds, fails, undecided) in TRIALS {
        for (fill, verdict) in [
            (holds, Verdict::Holds),
            (fails, Verdict::DoesNotHold),
            (undecided, Verdict::Undecided),
            ((|_| ()) as fn(&mut Builder), Verdict::NotMeasured),
        ] {
            let finding = finding(with(fill), id);
            assert_eq!(finding.verdict, verdict, "{id}: {:?}", finding.cases);
        }
    }
}

#[test]
fn one_thread_decides_nothing_about_threads() {
    let one = with(|b| {
        b.general.provenance.devices[0].info.threads = Some(1);
        rows(b, &[("sequential two-pass", 100.0), ("threads two-pass", 15.0)]);
        let metrics = &mut b.general.rows.last_mut().unwrap().metrics;
        metrics.iter_mut().filter(|m| m.name == "processor_threads").for_each(|m| m.value = 1u64.into());
    });
    assert_eq!(finding(one, "2").verdict, Verdict::NotMeasured);
}

#[test]
fn a_gpu_s_metric_needs_its_processors() {
    let gpu = |ms: f64| {
        with(move |b| {
            serial(b, 60.0, 20.0);
            rows(b, &[("gpu two-pass", ms), ("gpu one-pass exit", ms)]);
        })
    };
    let without = findings(gpu(1.0), None).into_iter().find(|f| f.claim == "12").unwrap();
    assert_eq!((without.cases.len(), without.left_out.len()), (1, 1), "{without:?}");
    let found = finding(gpu(1.0), "12");
    assert_eq!((found.verdict, found.cases.len(), found.left_out.len()), (Verdict::Holds, 3, 0));
    // A GPU no faster than the processor: all of it is serial
    assert_eq!(finding(gpu(99.0), "12").verdict, Verdict::DoesNotHold);
    // More than 1024 times as fast: a negative metric is below any other
    assert_eq!(finding(gpu(0.01), "12").verdict, Verdict::Holds);
}

#[test]
fn a_driver_on_the_cpu_is_called_so_where_it_matters() {
    let software = |b: &mut Builder| b.general.provenance.devices[1].info.device_type = DeviceType::SoftwareRasteriser;
    let all = findings(
        with(|b| {
            software(b);
            gpu(b, 1000.0, 20.0);
            pair(b, 0, 10.0, 30.0);
            b.half("default", 0.1);
        }),
        None,
    );
    let of = |id: &str| all.iter().find(|f| f.claim == id).unwrap();
    assert!(of("11").without_gpu && of("11").device == "Fast GPU" && of("11").warnings[0].contains("no GPU"));
    assert!(!of("1").without_gpu && of("1").device == "Test CPU");
    assert!(of("3").warnings.iter().any(|w| w.contains("computes on the CPU")), "{:?}", of("3").warnings);
    assert_eq!(of("10b").basis, Basis::Pictures);
}

/// A software driver converts to half precision and back: its speed is no device's.
#[test]
fn half_precision_of_a_software_driver_is_not_judged() {
    let judged = |is_software: bool| {
        let run = with(|b| {
            if is_software {
                b.general.provenance.devices[1].info.device_type = DeviceType::SoftwareRasteriser;
            }
            rows(b, &[("gpu one-pass exit", 10.0), ("gpu one-pass exit f16", 5.0)]);
            b.general.rows.last_mut().unwrap().metrics.push(rtbench::record::row::Metric::new("rmse", 0.1));
        });
        finding(run, "10a")
    };
    assert_eq!(judged(false).verdict, Verdict::Holds);
    let software = judged(true);
    assert_eq!(software.verdict, Verdict::NotMeasured);
    assert!(software.left_out[0].contains("by conversions"), "{:?}", software.left_out);
}

#[test]
fn rows_of_unlike_terms_are_not_compared() {
    let unlike = with(|b| {
        pair(b, 0, 10.0, 30.0);
        b.general.rows.last_mut().unwrap().key.axes.insert("trips".into(), "2".into());
    });
    assert_eq!(finding(unlike, "1").verdict, Verdict::NotMeasured);
    let wrong = with(|b| {
        pair(b, 0, 10.0, 30.0);
        b.general.rows.last_mut().unwrap().refuse(Status::Wrong, "pixel 3 differs");
    });
    let finding = finding(wrong, "1");
    assert_eq!(finding.verdict, Verdict::NotMeasured);
    assert!(finding.failed[0].contains("pixel 3 differs"), "{:?}", finding.failed);
}

#[test]
fn noise_leaves_a_small_difference_undecided() {
    let noisy = |noise: f64| {
        with(move |b| {
            b.noise = noise;
            pair(b, 0, 10.0, 13.0);
        })
    };
    assert_eq!(finding(noisy(1.0), "1").verdict, Verdict::Holds);
    assert_eq!(finding(noisy(15.0), "1").verdict, Verdict::Undecided);
}

#[test]
fn published_numbers_are_judged_in_the_same_way() {
    let all = (SOURCE.read)(&[]).claims(&Options::default());
    for finding in &all {
        let expected = match finding.claim {
            "4" | "5" | "10a" | "10b" => Verdict::NotMeasured,
            _ => Verdict::Holds,
        };
        assert_eq!((finding.verdict, finding.contradicting), (expected, 0), "{}", finding.claim);
    }
    let measured = (SOURCE.read)(&[everything()]).claims(&Options::default());
    for form in [Form::Text, Form::Markdown, Form::Json] {
        let text = write(std::slice::from_ref(&measured), "1 run", form);
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    }
}
