//! Every claim in every verdict, by times and by steps, also where it is false.

use super::synthetic::{Builder, everything, scene, steps};
use rtbench::compare::judge::Verdict;
use rtbench::device::DeviceType;
use rtbench::record::row::Status;
use rtbench::sources::claims::{Basis, Finding, Form, write};
use rtbench::sources::rt2::SOURCE;
use rtbench::sources::rt2::structures::{BIH, BVH, CULLED, MIN_MAX, ROPES, SORT, SPATIAL, STACK, SWEEP, Structure};
use rtbench::workloads::trace::rays::Config;
use rtbench::workloads::trace::record::by_ray_type;
use rtbench::workloads::trace::simt::Sums;

fn findings(builder: Builder) -> Vec<Finding> {
    (SOURCE.read)(&[builder.run]).claims(&Default::default())
}

fn finding(builder: Builder, claim: &str) -> Finding {
    findings(builder).into_iter().find(|f| f.claim == claim).unwrap()
}

/// A run that `fill` makes of one that decides nothing.
fn with(fill: impl Fn(&mut Builder)) -> Builder {
    let mut b = Builder::new();
    b.row(scene("alien"), "brute", Config::P, (64, 64), 1.0);
    fill(&mut b);
    b
}

fn frames(b: &mut Builder, name: &str, times: &[(&'static Structure, f64)]) {
    for (structure, ms) in times {
        b.shot(name, structure, *ms);
    }
}

/// Build times of min-max, BVH and sort.
fn builds(b: &mut Builder, name: &str, [min_max, bvh, sort]: [f64; 3]) {
    for (tree, ms) in [(&MIN_MAX, min_max), (&SWEEP, bvh), (&SORT, sort)] {
        b.tree(name, tree, ms, 1, 1);
    }
}

/// Bytes of kd-tree, BVH and ropes.
fn bytes(b: &mut Builder, name: &str, [kdtree, bvh, ropes]: [u64; 3]) {
    for (tree, bytes) in [(&STACK, kdtree), (&BVH, bvh), (&ROPES, ropes)] {
        b.tree(name, tree, 1.0, bytes, 10);
    }
}

/// The BVH's time on an even scan and on one with spikes, where the kd-tree takes 10 ms.
fn leads(b: &mut Builder, even: f64, spiky: f64) {
    frames(b, "alien", &[(&STACK, 10.0), (&BVH, even)]);
    frames(b, "spiky", &[(&STACK, 10.0), (&BVH, spiky)]);
}

/// Expected costs of spatial and object splits.
fn costs(b: &mut Builder, name: &str, spatial: f64, object: f64) {
    b.tree(name, &SPATIAL, 1.0, 1, 1).properties.sah_cost = Some(spatial);
    b.tree(name, &CULLED, 1.0, 1, 1).properties.sah_cost = Some(object);
}

fn leaves(b: &mut Builder, spiky: u32, even: u32) {
    b.tree("spiky", &STACK, 1.0, 1, spiky);
    b.tree("even", &STACK, 1.0, 1, even);
}

fn spatial(b: &mut Builder, splits: u32, overlap: f64) {
    let properties = &mut b.tree("room", &SPATIAL, 1.0, 1, 1).properties;
    (properties.spatial_splits, properties.spatial_overlap) = (Some(splits), Some(overlap));
}

fn skipping(b: &mut Builder, skips: u64) {
    let mut sums = steps(1000);
    sums.skips = skips;
    b.shot("room", &BIH, 1.0).counters = Some(by_ray_type([sums, steps(0), steps(0)]));
}

/// The kd-tree's time in the room, where a BVH and everything on the scan takes 10 ms.
fn separate(b: &mut Builder, room: f64) {
    frames(b, "even", &[(&STACK, 10.0), (&CULLED, 10.0)]);
    frames(b, "room", &[(&STACK, room), (&CULLED, 10.0)]);
}

/// A claim, rows of which it holds, rows of which it does not, and rows that do not decide it. Counts and sizes are
/// exact: of two different ones one is less.
type Trial = (&'static str, fn(&mut Builder), fn(&mut Builder), Option<fn(&mut Builder)>);

const TRIALS: [Trial; 15] = [
    (
        "1",
        |b| frames(b, "alien", &[(&ROPES, 10.0), (&STACK, 13.0), (&BVH, 14.0)]),
        |b| frames(b, "alien", &[(&ROPES, 13.0), (&STACK, 10.0), (&BVH, 16.0)]),
        Some(|b| frames(b, "alien", &[(&ROPES, 10.0), (&STACK, 10.2), (&BVH, 14.0)])),
    ),
    (
        "2u",
        |b| frames(b, "dragon", &[(&STACK, 10.0), (&BVH, 13.0)]),
        |b| frames(b, "dragon", &[(&STACK, 13.0), (&BVH, 10.0)]),
        Some(|b| frames(b, "dragon", &[(&STACK, 10.0), (&BVH, 10.2)])),
    ),
    (
        "2c",
        |b| frames(b, "dragon", &[(&STACK, 10.0), (&CULLED, 13.0)]),
        |b| frames(b, "dragon", &[(&STACK, 13.0), (&CULLED, 10.0)]),
        Some(|b| frames(b, "dragon", &[(&STACK, 10.0), (&CULLED, 10.2)])),
    ),
    (
        "2a",
        |b| frames(b, "alien", &[(&STACK, 10.0), (&BVH, 12.0)]),
        |b| frames(b, "alien", &[(&STACK, 10.0), (&BVH, 20.0)]),
        Some(|b| frames(b, "alien", &[(&STACK, 10.0), (&BVH, 14.2)])),
    ),
    ("3", |b| leads(b, 16.0, 11.0), |b| leads(b, 11.0, 16.0), Some(|b| leads(b, 11.1, 11.0))),
    (
        "4",
        |b| builds(b, "alien", [1.0, 2.0, 4.0]),
        |b| builds(b, "alien", [2.0, 1.0, 4.0]),
        Some(|b| builds(b, "alien", [1.0, 1.05, 4.0])),
    ),
    (
        "4a",
        |b| builds(b, "large", [1.0, 4.0, 2.0]),
        |b| builds(b, "large", [1.0, 2.0, 4.0]),
        Some(|b| builds(b, "large", [1.0, 2.1, 2.0])),
    ),
    (
        "5",
        |b| builds(b, "alien", [1.0, 45.0, 100.0]),
        |b| builds(b, "alien", [1.0, 100.0, 100.0]),
        Some(|b| builds(b, "alien", [1.0, 100.0, 130.0])),
    ),
    ("6", |b| bytes(b, "alien", [27, 45, 79]), |b| bytes(b, "alien", [50, 45, 79]), None),
    ("6a", |b| leaves(b, 300_000, 100_000), |b| leaves(b, 100_000, 300_000), None),
    ("7", |b| bytes(b, "room", [100, 9, 580]), |b| bytes(b, "room", [100, 9, 581]), None),
    ("8", |b| separate(b, 20.0), |b| separate(b, 5.0), Some(|b| separate(b, 10.2))),
    ("9", |b| costs(b, "alien", 20.0, 30.0), |b| costs(b, "room", 20.0, 30.0), Some(|b| costs(b, "bunny", 30.0, 30.1))),
    ("10", |b| spatial(b, 9, 0.0), |b| spatial(b, 9, 0.01), Some(|b| spatial(b, 0, 0.0))),
    ("11", |b| skipping(b, 900), |b| skipping(b, 0), Some(|b| skipping(b, 1))),
];

#[test]
fn every_claim_holds_or_not_as_the_rows_say() {
    for (claim, good, bad, undecided) in TRIALS {
        let noisy = |fill: fn(&mut Builder)| {
            with(|b| {
                b.noise = 2.0;
                fill(b);
            })
        };
        assert_eq!(finding(with(good), claim).verdict, Verdict::Holds, "{claim}, good rows");
        assert_eq!(finding(with(bad), claim).verdict, Verdict::DoesNotHold, "{claim}, bad rows");
        if let Some(undecided) = undecided {
            assert_eq!(finding(noisy(undecided), claim).verdict, Verdict::Undecided, "{claim}, noisy rows");
        }
        assert_eq!(finding(with(|_| ()), claim).verdict, Verdict::NotMeasured, "{claim}, other rows");
    }
}

#[test]
fn nothing_measured_is_its_own_verdict() {
    let all = findings(with(|_| ()));
    assert_eq!(all.iter().map(|f| f.claim).collect::<Vec<_>>(), TRIALS.map(|trial| trial.0));
    assert!(all.iter().all(|f| f.verdict == Verdict::NotMeasured && f.cases.is_empty()), "{all:?}");
}

#[test]
fn the_pointed_shape_has_another_order_of_memory() {
    let verdict = |name: &'static str, order| finding(with(|b| bytes(b, name, order)), "6").verdict;
    assert_eq!(verdict("spiky", [50, 45, 79]), Verdict::Holds);
    assert_eq!(verdict("spiky", [40, 45, 79]), Verdict::DoesNotHold);
    assert_eq!(verdict("dragon", [40, 45, 44]), Verdict::DoesNotHold);
    // The Dino's size alone is not its shape.
    assert_eq!(verdict("even", [40, 45, 79]), Verdict::NotMeasured);
}

#[test]
fn on_a_software_device_steps_decide() {
    // By time each of these would be the other way round.
    let software = |ropes, stack, bvh| {
        let mut b = Builder::new().device("llvmpipe", DeviceType::SoftwareRasteriser);
        b.walk("alien", &ROPES, 30.0, ropes);
        b.walk("alien", &STACK, 20.0, stack);
        b.walk("alien", &BVH, 10.0, bvh);
        findings(b)
    };
    let of = |all: &[Finding], claim: &str| all.iter().find(|f| f.claim == claim).unwrap().clone();
    let all = software(9, 11, 13);
    for claim in ["1", "2u", "2a"] {
        let f = of(&all, claim);
        assert_eq!((f.verdict, f.basis, f.without_gpu), (Verdict::Holds, Basis::Counts, false), "{claim}");
        assert!(f.warnings.iter().any(|w| w.starts_with("Judged by steps per ray")), "{f:?}");
    }
    assert!(of(&all, "1").cases[0].numbers.contains("BVH 13.00 steps per ray"), "{all:?}");
    let all = software(13, 11, 9);
    assert!(["1", "2u", "2a"].iter().all(|claim| of(&all, claim).verdict == Verdict::DoesNotHold));
}

#[test]
fn builds_are_compared_only_with_those_of_the_same_builder() {
    let threads = |numbers: [usize; 3]| {
        let mut b = with(|b| builds(b, "alien", [1.0, 45.0, 100.0]));
        b.run.journal.structures.iter_mut().zip(numbers).for_each(|(record, threads)| record.build_threads = threads);
        finding(b, "5")
    };
    assert_eq!(threads([2, 2, 2]).verdict, Verdict::Holds);
    let f = threads([1, 1, 2]);
    assert_eq!(f.verdict, Verdict::NotMeasured);
    assert!(f.left_out[0].contains("Not measured on scan (32168)") && f.left_out[0].contains("--threads 1"), "{f:?}");
    // A tree that was sorted once says nothing about builders that sort in every node.
    let once = with(|b| {
        b.tree("alien", &STACK, 100.0, 1, 1);
        b.tree("alien", &CULLED, 45.0, 1, 1);
    });
    assert_eq!(finding(once, "5").verdict, Verdict::NotMeasured);
}

#[test]
fn what_failed_is_named_and_decides_nothing() {
    let fill = |b: &mut Builder| {
        frames(b, "alien", &[(&STACK, 10.0), (&BVH, 13.0)]);
        for (name, structure) in [("dragon", &BVH), ("dragon", &CULLED), ("alien", &BVH)] {
            let record = b.shot(name, structure, 1.0);
            (record.status, record.message) = (Status::Skipped, "too large".into());
        }
    };
    let f = finding(with(fill), "2u");
    assert_eq!((f.verdict, f.cases.len()), (Verdict::Holds, 1));
    // The other one has a result, and the third is no part of this claim.
    assert_eq!(f.failed.len(), 1, "{:?}", f.failed);
    assert!(f.failed[0].starts_with("dragon (871414) bvh-stack:build=sweep,max_leaf=3,cull=off"), "{:?}", f.failed);
    let unverified = |b: &mut Builder| {
        fill(b);
        b.run.journal.configurations.iter_mut().for_each(|record| record.verified = false);
    };
    assert_eq!(finding(with(unverified), "2u").verdict, Verdict::NotMeasured);
}

#[test]
fn what_was_printed_is_judged_by_the_same_rule() {
    let all = (SOURCE.read)(&[]).claims(&Default::default());
    let of = |claim: &str| all.iter().find(|f| f.claim == claim).unwrap();
    for claim in ["1", "2u", "3", "4", "4a", "6"] {
        assert_eq!(of(claim).verdict, Verdict::Holds, "{claim}");
    }
    // A claim that is a printed number is not judged by itself.
    assert!(["2a", "2c", "5", "7"].iter().all(|claim| of(claim).verdict == Verdict::NotMeasured));
    // Measured numbers have the count of the printed ones next to them.
    let measured = (SOURCE.read)(&[everything()]).claims(&Default::default());
    let of = |claim: &str| measured.iter().find(|f| f.claim == claim).unwrap();
    assert_eq!((of("1").published, of("4").published, of("2a").published), (Some((3, 3)), Some((2, 2)), None));
    assert!(["1", "2u", "4", "5", "6", "7", "10"].iter().all(|claim| of(claim).verdict == Verdict::Holds));
    assert_eq!(of("4a").verdict, Verdict::Undecided, "13 % are within the margin of build times");
}

#[test]
fn forms_agree_and_repeat() {
    let all = (SOURCE.read)(&[everything()]).claims(&Default::default());
    for form in [Form::Text, Form::Markdown, Form::Json] {
        let once = write(std::slice::from_ref(&all), "1 run", form);
        assert_eq!(once, write(&[(SOURCE.read)(&[everything()]).claims(&Default::default())], "1 run", form));
        assert!(once.contains("rt2") || once.contains("thesis of 2010"), "{once}");
    }
    let text = write(std::slice::from_ref(&all), "1 run", Form::Text);
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
}

#[test]
fn the_model_judges_claims_about_frames() {
    // By time and by steps each of these would be the other way round
    let modelled = |ropes: u64, stack: u64, bvh: u64| {
        let mut b = Builder::new();
        for (structure, warps, ms) in [(&ROPES, ropes, 30.0), (&STACK, stack, 20.0), (&BVH, bvh, 10.0)] {
            let record = b.shot("alien", structure, ms);
            record.warp_width = Some(32);
            record.issued =
                Some(std::array::from_fn(|ray| Sums { warps: if ray == 0 { warps } else { 0 }, ..Sums::default() }));
        }
        findings(b)
    };
    let of = |all: &[Finding], claim: &str, basis: Basis| {
        let mut found = all.iter().filter(|f| (f.claim, f.basis) == (claim, basis));
        found.find(|f| f.basis != Basis::SimtModel || f.device == "GeForce GTX 280").cloned()
    };
    let verdict = |all: &[Finding], claim| of(all, claim, Basis::SimtModel).unwrap().verdict;
    // Weights of rays differ between the kernels, by less than these numbers do
    let all = modelled(1_000_000, 10_000_000, 100_000_000);
    assert_eq!(["1", "2u"].map(|claim| verdict(&all, claim)), [Verdict::Holds; 2], "{all:?}");
    let measured = |all: &[Finding]| ["1", "2u"].map(|claim| of(all, claim, Basis::FrameTimes).unwrap().verdict);
    assert_eq!(measured(&all), [Verdict::DoesNotHold; 2]);
    let all = modelled(100_000_000, 10_000_000, 1_000_000);
    assert_eq!(["1", "2u", "2a"].map(|claim| verdict(&all, claim)), [Verdict::DoesNotHold; 3], "{all:?}");
    assert!(of(&all, "2u", Basis::SimtModel).unwrap().cases[0].numbers.contains(" M: "), "{all:?}");
    // Build times and sizes are not the model's, and without counts there are no verdicts by it
    assert!(["4", "6", "11"].iter().all(|claim| of(&all, claim, Basis::SimtModel).is_none()));
    assert!(findings(with(|b| frames(b, "alien", &[(&ROPES, 1.0)]))).iter().all(|f| f.basis != Basis::SimtModel));
}
