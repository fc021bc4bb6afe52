//! Every claim in every verdict, also where it is false.

use super::synthetic::{Builder, everything, sums};
use rtbench::compare::judge::Verdict;
use rtbench::sources::claims::{Basis, Finding, Form, summary, write};
use rtbench::sources::thesis::claims::{UNIFORM_CROWDING, crowding, judge};
use rtbench::sources::thesis::{measured, published};
use rtbench::workloads::trace::backend::{Config, DeviceType};
use rtbench::workloads::trace::record::by_ray_type;

fn findings(builder: Builder) -> Vec<Finding> {
    judge(&measured::data(&[builder.run]), &published::data(), 0)
}

pub fn verdict(builder: Builder, claim: &str) -> Verdict {
    finding(builder, claim).verdict
}

pub fn finding(builder: Builder, claim: &str) -> Finding {
    findings(builder).into_iter().find(|f| f.claim == claim).unwrap()
}

/// A run with a little in it that decides nothing.
fn nothing() -> Builder {
    let mut b = Builder::new();
    b.frame("bunny", "brute", Config::P, 64, 1.0);
    b
}

/// A run as `fill` makes it.
pub fn with(fill: impl Fn(&mut Builder)) -> Builder {
    let mut b = nothing();
    fill(&mut b);
    b
}

#[test]
fn nothing_measured_is_its_own_verdict() {
    let all = findings(nothing());
    assert_eq!(all.len(), 15);
    assert!(all.iter().all(|f| f.verdict == Verdict::NotMeasured && f.scenes == 0 && f.cases.is_empty()), "{all:?}");
    for form in [Form::Text, Form::Markdown, Form::Json] {
        let text = write(std::slice::from_ref(&all), "1 run", form).to_lowercase();
        assert!(text.contains("not measured") || text.contains("not-measured"), "{text}");
        assert!(!text.contains("holds"), "{text}");
    }
}

/// A claim, data of which it holds, data of which it does not, and data that does not decide it.
type Trial = (&'static str, fn(&mut Builder), fn(&mut Builder), Option<fn(&mut Builder)>);

pub fn build_times(b: &mut Builder, [grid, bvh, kdtree]: [f64; 3]) {
    b.built("museum", "grid", grid, 3.0, 9);
    b.built("museum", "bvh", bvh, 1.0, 0);
    b.built("museum", "kdtree", kdtree, 2.0, 0);
}

fn sizes(b: &mut Builder, [bvh, kdtree, grid]: [f64; 3]) {
    b.built("museum", "grid", 1.0, grid, 9);
    b.built("museum", "bvh", 1.0, bvh, 0);
    b.built("museum", "kdtree", 1.0, kdtree, 0);
}

/// Two resolutions; the time per ray falls by these factors.
fn falls(b: &mut Builder, factors: [f64; 3]) {
    b.trio("museum", Config::PS, 256, [10.0, 10.0, 10.0]);
    b.trio("museum", Config::PS, 512, factors.map(|f| 40.0 / f));
}

pub fn pair(b: &mut Builder, scene: &str, structure: &str, option: &str, config: Config, times: [f64; 2]) {
    let base = if (scene, structure) == ("robots", "grid") { "grid:x=128" } else { structure };
    let separator = if base.contains(':') { "," } else { ":" };
    b.frame(scene, base, config, 256, times[0]);
    b.frame(scene, &format!("{base}{separator}{option}"), config, 256, times[1]);
}

/// A grid sweep: coarser, by rule, finer.
fn sweep(b: &mut Builder, scene: &str, times: [f64; 3]) {
    for (variant, cells, ms) in
        [("grid:factor=2", 8, times[0]), ("grid", 16, times[1]), ("grid:factor=8", 32, times[2])]
    {
        b.built(scene, variant, 1.0, 1.0, cells);
        b.frame(scene, variant, Config::P, 256, ms);
    }
}

const TRIALS: [Trial; 15] = [
    (
        "1",
        |b| build_times(b, [1.0, 2.0, 3.0]),
        |b| build_times(b, [2.0, 1.0, 3.0]),
        Some(|b| build_times(b, [1.0, 1.05, 3.0])),
    ),
    ("2", |b| sizes(b, [1.0, 2.0, 3.0]), |b| sizes(b, [1.0, 3.0, 2.0]), None),
    (
        "3",
        |b| b.trio("museum", Config::P, 256, [3.0, 2.0, 1.0]),
        |b| b.trio("museum", Config::P, 256, [3.0, 1.0, 2.0]),
        Some(|b| b.trio("museum", Config::P, 256, [3.0, 1.02, 1.0])),
    ),
    (
        "4",
        |b| b.trio("robots", Config::PSR, 256, [3.0, 1.0, 2.0]),
        |b| b.trio("robots", Config::PSR, 256, [3.0, 2.0, 1.0]),
        Some(|b| b.trio("robots", Config::PSR, 256, [3.0, 2.0, 2.02])),
    ),
    (
        "5",
        |b| b.trio("robots", Config::PS, 256, [3.0, 2.0, 1.0]),
        |b| b.trio("robots", Config::PS, 256, [1.0, 2.0, 3.0]),
        Some(|b| b.trio("robots", Config::PS, 256, [2.02, 2.0, 1.0])),
    ),
    ("6a", |b| falls(b, [1.2, 1.3, 1.6]), |b| falls(b, [1.2, 0.8, 1.6]), Some(|b| falls(b, [1.2, 1.01, 1.6]))),
    // The thesis's own numbers contradict this claim on the museum: other cases have to carry it.
    (
        "6b",
        |b| {
            for (side, ms) in [(256, [10.0; 3]), (512, [33.0, 30.0, 20.0])] {
                b.trio("hall", Config::P, side, ms)
            }
        },
        |b| {
            for (side, ms) in [(256, [10.0; 3]), (512, [33.0, 20.0, 30.0])] {
                b.trio("hall", Config::P, side, ms)
            }
        },
        Some(|b| {
            for (side, ms) in [(256, [10.0; 3]), (512, [33.0, 20.0, 20.0])] {
                b.trio("hall", Config::P, side, ms)
            }
        }),
    ),
    (
        "7",
        |b| pair(b, "museum", "kdtree", "search=restart", Config::P, [10.0, 25.0]),
        |b| pair(b, "museum", "kdtree", "search=restart", Config::P, [10.0, 15.0]),
        Some(|b| pair(b, "museum", "kdtree", "search=restart", Config::P, [10.0, 20.2])),
    ),
    (
        "8",
        |b| pair(b, "museum", "bvh", "vote=original", Config::PSR, [10.0, 12.0]),
        |b| pair(b, "museum", "bvh", "vote=original", Config::PSR, [12.0, 10.0]),
        Some(|b| pair(b, "museum", "bvh", "vote=original", Config::PSR, [10.0, 10.1])),
    ),
    (
        "9",
        |b| pair(b, "robots", "grid", "shadows=to-light", Config::PS, [10.0, 12.0]),
        |b| pair(b, "robots", "grid", "shadows=to-light", Config::PS, [12.0, 10.0]),
        Some(|b| pair(b, "robots", "grid", "shadows=to-light", Config::PS, [10.0, 10.1])),
    ),
    (
        "10a",
        |b| sweep(b, "bunny", [12.0, 10.0, 10.5]),
        |b| sweep(b, "bunny", [12.0, 10.0, 5.0]),
        Some(|b| sweep(b, "bunny", [12.0, 11.5, 10.0])),
    ),
    (
        "10b",
        |b| sweep(b, "robots", [30.0, 20.0, 5.0]),
        |b| sweep(b, "robots", [12.0, 10.0, 9.5]),
        Some(|b| sweep(b, "robots", [30.0, 15.1, 10.0])),
    ),
    (
        "11a",
        |b| {
            b.frame("museum", "grid", Config::P, 256, 1.0);
            b.frame("museum", "grid-coop", Config::P, 256, 2.0);
        },
        |b| {
            b.frame("museum", "grid", Config::P, 256, 2.0);
            b.frame("museum", "grid-coop", Config::P, 256, 1.0);
        },
        Some(|b| {
            b.frame("museum", "grid", Config::P, 256, 2.0);
            b.frame("museum", "grid-coop", Config::P, 256, 2.02);
        }),
    ),
    (
        "11b",
        |b| {
            b.frame("museum", "grid", Config::P, 256, 1.0);
            b.frame("museum", "grid-packet", Config::P, 256, 2.0);
        },
        |b| {
            b.frame("museum", "grid", Config::P, 256, 2.0);
            b.frame("museum", "grid-packet", Config::P, 256, 1.0);
        },
        Some(|b| {
            b.frame("museum", "grid", Config::P, 256, 2.0);
            b.frame("museum", "grid-packet", Config::P, 256, 2.02);
        }),
    ),
    (
        "12",
        |b| pair(b, "museum", "kdtree", "memory=private", Config::PSR, [10.0, 8.0]),
        |b| pair(b, "museum", "kdtree", "memory=private", Config::PSR, [10.0, 12.0]),
        Some(|b| pair(b, "museum", "kdtree", "memory=private", Config::PSR, [10.0, 9.2])),
    ),
];

#[test]
fn every_claim_holds_or_not_as_the_data_says() {
    for (claim, good, bad, undecided) in TRIALS {
        assert_eq!(verdict(with(good), claim), Verdict::Holds, "{claim}, good data");
        assert_eq!(verdict(with(bad), claim), Verdict::DoesNotHold, "{claim}, bad data");
        if let Some(undecided) = undecided {
            // The same differences, and noise about them.
            let noisy = with(|b| {
                b.noise = 2.0;
                undecided(b);
            });
            assert_eq!(verdict(noisy, claim), Verdict::Undecided, "{claim}, noisy data");
        }
    }
}

#[test]
fn claims_are_about_the_scenes_that_they_name() {
    // Uniform scenes and scenes without mirrors decide nothing.
    let f = findings(with(|b| {
        b.trio("bunny", Config::P, 256, [1.0, 2.0, 3.0]);
        b.trio("hall", Config::PSR, 256, [1.0, 2.0, 3.0]);
        b.built("hall", "grid", 1.0, 1.0, 4).properties.max_cell_triangles = Some(10);
    }));
    for claim in ["3", "4", "5"] {
        assert_eq!(f.iter().find(|f| f.claim == claim).unwrap().verdict, Verdict::NotMeasured, "{claim}");
    }
    // The same scene with a crowded grid is no uniform one.
    let crowded = with(|b| {
        b.trio("hall", Config::P, 256, [1.0, 2.0, 3.0]);
        b.built("hall", "grid", 1.0, 1.0, 4);
    });
    assert_eq!(verdict(crowded, "5"), Verdict::DoesNotHold);
    // A rule without a coarser grid is not judged.
    let half = with(|b| {
        b.built("bunny", "grid", 1.0, 1.0, 16);
        b.built("bunny", "grid:factor=8", 1.0, 1.0, 32);
        b.frame("bunny", "grid", Config::P, 256, 1.0);
        b.frame("bunny", "grid:factor=8", Config::P, 256, 2.0);
    });
    assert_eq!(verdict(half, "10a"), Verdict::NotMeasured);
}

#[test]
fn crowding_tells_the_thesis_s_objects_from_its_rooms() {
    let data = published::data();
    for scene in &data.scenes {
        let fullest = data.thesis_built(&scene.key, "grid").unwrap().properties.max_cell_triangles.unwrap();
        let crowding = crowding(fullest, scene.triangles);
        eprintln!("{}: {crowding:.1}", scene.key);
        let uniform = scene.key.thesis().unwrap().is_object();
        let (low, high) = if uniform { (1.0, UNIFORM_CROWDING / 2.0) } else { (1.5 * UNIFORM_CROWDING, 1000.0) };
        assert!((low..high).contains(&crowding), "{}: {crowding}", scene.key);
    }
}

#[test]
fn on_a_software_device_counts_decide_where_they_can() {
    let software = |restart: u64| {
        let mut b = Builder::new().device("llvmpipe", DeviceType::SoftwareRasteriser);
        // By time the claim would fail.
        b.frame("museum", "kdtree", Config::P, 256, 10.0).counters = Some(by_ray_type([sums(20, 10); 3]));
        b.frame("museum", "kdtree:search=restart", Config::P, 256, 5.0).counters =
            Some(by_ray_type([sums(restart, 10); 3]));
        b.trio("robots", Config::PS, 256, [3.0, 2.0, 1.0]);
        finding(b, "7")
    };
    let f = software(80);
    assert_eq!((f.verdict, f.basis), (Verdict::Holds, Basis::Counts));
    assert!(f.warnings.iter().any(|w| w.contains("say nothing about a GPU")), "{f:?}");
    assert_eq!(software(30).verdict, Verdict::DoesNotHold);
    let mut b = Builder::new().device("llvmpipe", DeviceType::CpuTwin);
    b.trio("robots", Config::PS, 256, [3.0, 2.0, 1.0]);
    let f = finding(b, "5");
    assert_eq!((f.verdict, f.basis), (Verdict::Holds, Basis::FrameTimes));
    assert!(f.warnings.iter().any(|w| w.contains("About this machine only")) && f.without_gpu, "{f:?}");
    // Not even in a single line does it pass for a verdict about a GPU.
    assert!(summary(&[f], "1 run").contains("| frame times without a GPU |"));
}

#[test]
fn devices_are_judged_apart() {
    let all = judge(&measured::data(&everything()), &published::data(), 0);
    let of = |claim: &str| all.iter().filter(|f| f.claim == claim).map(|f| f.device.as_str()).collect::<Vec<_>>();
    assert_eq!((of("1"), of("5")), (vec![""], vec!["Fast GPU", "Slow GPU"]));
}

#[test]
fn forms_agree_and_repeat() {
    let all = judge(&measured::data(&everything()), &published::data(), 0);
    for form in [Form::Text, Form::Markdown, Form::Json] {
        assert_eq!(
            write(std::slice::from_ref(&all), "2 runs", form),
            write(std::slice::from_ref(&all), "2 runs", form)
        );
    }
    let json: serde_json::Value =
        serde_json::from_str(&write(std::slice::from_ref(&all), "2 runs", Form::Json)).unwrap();
    assert_eq!(json.as_array().unwrap().len(), all.len());
    let text = write(std::slice::from_ref(&all), "2 runs", Form::Text);
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    assert_eq!(
        text.matches("[ NOT MEASURED ]").count(),
        all.iter().filter(|f| f.verdict == Verdict::NotMeasured).count()
    );
}
