//! The twins' own events.

use rtbench::camera::CameraPath;
use rtbench::scene::{Scene, load};
use rtbench::workloads::trace::backend::{Backend, Config, Counters, RAY_TYPES, Size, Warps};
use rtbench::workloads::trace::simt::{EVENTS, Event, Sums};
use rtbench::workloads::trace::{CpuBackend, Selection, algorithms};

/// Not a multiple of the pixels of a work-group.
const SIZE: Size = Size { width: 68, height: 60 };

/// What warps of `width` lanes issue in the first frame, and what its rays count, by ray type.
fn counted(
    cpu: &CpuBackend,
    scene: &Scene,
    selection: &Selection,
    config: Config,
    width: u32,
) -> ([Sums; RAY_TYPES.len()], Vec<[Counters; RAY_TYPES.len()]>) {
    let built = selection.build(scene, 0).unwrap();
    let mut prepared = cpu.prepare(scene, &*built.structure, selection.method()).unwrap();
    let view = CameraPath::for_scene(scene, true).views(scene, Some(1)).unwrap().remove(0);
    let sums = prepared.in_warps(config, &view, SIZE, Warps::all(width)).unwrap();
    let mut pixels = Vec::new();
    prepared.counted(config, &view, SIZE, &mut |_, band| pixels.extend(band.iter().map(|p| p.counters))).unwrap();
    (sums, pixels)
}

/// Every traversal that is modelled, with every form of its loops.
const SELECTIONS: [&str; 26] = [
    "brute",
    "grid",
    "grid-coop",
    "grid-packet",
    "kdtree",
    "kdtree:stack=1",
    "kdtree:search=restart",
    "kdtree:search=pushdown",
    "kdtree:search=stack",
    "kdtree:search=ropes",
    "bih",
    "bvh",
    "bvh:vote=original",
    "bvh:packet=8x4",
    "bvh-stack",
    "bvh-stack:cull=off",
    "bvh-stack:loop=if-if",
    "bvh-stack:loop=persistent",
    "bvh-stack:loop=speculative",
    "bvh-quantised",
    "bvh4",
    "bvh8:stack=short,entries=2",
    "bvh8:order=octant",
    "cwbvh",
    "bvh-stackless",
    "bvh-stackless:search=trail",
];

fn selections() -> Vec<Selection> {
    SELECTIONS.map(|text| Selection::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"))).into()
}

#[test]
fn all_traversals_with_twins_are_modelled_but_packets_of_subgroups() {
    let modelled: Vec<_> = selections().iter().map(|selection| selection.method().traversal).collect();
    for algorithm in algorithms() {
        let traversal = Selection::parse(algorithm.name).unwrap().method().traversal;
        let expected = traversal.twin.is_some() && algorithm.name != "bvh-subgroup";
        assert_eq!(traversal.lockstep.is_some(), expected, "{}", algorithm.name);
        assert!(!expected || modelled.contains(&traversal) || algorithm.name == "bvh8", "{}", algorithm.name);
    }
}

#[test]
fn warps_of_one_lane_count_what_rays_count() {
    let cpu = CpuBackend::new(2).unwrap();
    let scene = load("hall:triangles=15000").unwrap();
    for selection in selections() {
        for config in [Config::PSR, Config::AO, Config::DIFFUSE] {
            let (sums, pixels) = counted(&cpu, &scene, &selection, config, 1);
            let of = |kind: usize, counter: fn(&Counters) -> u32| -> u64 {
                pixels.iter().map(|counters| u64::from(counter(&counters[kind]))).sum()
            };
            for (kind, sums) in sums.iter().enumerate() {
                let counters: [fn(&Counters) -> u32; 7] =
                    [|c| c.inner, |c| c.leaves, |c| c.tests, |c| c.pops, |c| c.restarts, |c| c.ropes, |c| c.fallbacks];
                let expected = counters.map(|counter| of(kind, counter));
                let name = format!("{} {config:?} {}", selection.full_name(), RAY_TYPES[kind]);
                assert_eq!(sums.lanes[..7], expected, "{name}");
                // Where barriers keep a group together, all of its warps issue
                if !selection.method().traversal.cooperative {
                    assert_eq!((sums.issued, sums.warps), (sums.lanes, of(kind, |c| c.rays)), "{name}");
                }
            }
        }
    }
}

/// Each event that reads something says what: a test reads a triangle reference and three positions. In a warp of 64
/// lanes the work-group is one, also where barriers keep it together.
#[test]
fn events_read_what_is_stated() {
    let cpu = CpuBackend::new(2).unwrap();
    let scene = load("hall:triangles=15000").unwrap();
    for selection in selections() {
        let method = selection.method();
        let reads = method.traversal.lockstep.unwrap()(&method.parameters).reads;
        let name = selection.full_name();
        assert!(!reads.is_empty() || name == "brute", "{name}");
        for sums in counted(&cpu, &scene, &selection, Config::PSR, 64).0 {
            let of_events: u64 = reads.iter().map(|read| sums.issued[read.event as usize]).sum();
            assert_eq!(sums.loads.issued, of_events + 4 * sums.issued[Event::Test as usize], "{name}");
            let [small, middle, large] = sums.loads.segments;
            assert!(large <= middle && middle <= small && sums.loads.issued <= large, "{name} {:?}", sums.loads);
        }
    }
}

/// Loads and segments of primary rays: what a wrong index, stride or size would change.
#[test]
fn segments_are_those_of_before() {
    let cpu = CpuBackend::new(2).unwrap();
    let scene = load("hall:triangles=15000").unwrap();
    let found = selections().into_iter().map(|selection| {
        let loads = counted(&cpu, &scene, &selection, Config::P, 32).0[0].loads;
        (selection.full_name(), loads.issued, loads.segments)
    });
    let found: Vec<(String, u64, [u64; 3])> = found.collect();
    let lines: String = found.iter().map(|(name, loads, [a, b, c])| format!("{name} {loads} {a} {b} {c}\n")).collect();
    assert_eq!(lines, SEGMENTS);
}

/// Of each selection its loads, and their segments of 32, 64 and 128 bytes.
const SEGMENTS: &str = "\
brute 7966080 7966080 7966080 7966080
grid 106003 301253 296069 291660
grid-coop 32987 276422 236271 211845
grid-packet 1252511 1252511 1252511 1252511
kdtree 47731 87780 85467 82943
kdtree:stack=1 56695 103635 101050 98725
kdtree:search=restart 70319 136384 132821 130267
kdtree:search=pushdown 70737 138199 134355 131709
kdtree:search=stack 30502 74456 71728 68726
kdtree:search=ropes 28087 75068 65110 62329
bih 267135 914962 851631 794462
bvh 46072 56312 46072 46072
bvh:vote=original 49738 60260 49738 49738
bvh:packet=8x4 29329 36770 29329 29329
bvh-stack 13231 58752 42323 40299
bvh-stack:cull=off 20367 101731 76732 73034
bvh-stack:loop=if-if 17431 76872 56323 52709
bvh-stack:loop=persistent 13231 58752 42323 40299
bvh-stack:loop=speculative 14005 65749 47853 45422
bvh-quantised 13258 43225 41828 39509
bvh4 9702 38997 32016 30289
bvh8:stack=short,entries=2 16403 51847 41519 35354
bvh8:order=octant 18236 63729 53190 46761
cwbvh 12467 39001 33178 29429
bvh-stackless 34860 88886 87290 83706
bvh-stackless:search=trail 21282 92376 59135 56773
";

#[test]
fn wider_warps_issue_less_for_the_same_lanes() {
    let scene = load("stadium:triangles=8000").unwrap();
    let (one, two) = (CpuBackend::new(1).unwrap(), CpuBackend::new(2).unwrap());
    for selection in selections() {
        let name = selection.full_name();
        let by_width = [8, 16, 32, 64].map(|width| counted(&two, &scene, &selection, Config::PSR, width).0);
        for (sums, width) in by_width.iter().zip([8, 16, 32, 64]) {
            for (event, (&issued, &lanes)) in sums.iter().flat_map(|s| s.issued.iter().zip(&s.lanes)).enumerate() {
                let event = EVENTS[event % EVENTS.len()];
                assert!(issued * width >= lanes, "{name}, {width} lanes: {event} {issued} {lanes}");
                assert!((issued > 0) == (lanes > 0), "{name}, {width} lanes: {event} {issued} {lanes}");
            }
        }
        for pair in by_width.windows(2) {
            for (narrow, wide) in pair[0].iter().zip(&pair[1]) {
                assert_eq!(narrow.lanes, wide.lanes, "{name}");
                assert!(narrow.issued.iter().zip(&wide.issued).all(|(a, b)| a >= b), "{name}: {narrow:?} {wide:?}");
            }
        }
        assert_eq!(counted(&one, &scene, &selection, Config::PSR, 32).0, by_width[2], "{name}: threads");
    }
}

#[test]
fn what_is_not_modelled_is_refused() {
    let cpu = CpuBackend::new(1).unwrap();
    let scene = load("scan:triangles=1000").unwrap();
    let view = CameraPath::for_scene(&scene, true).views(&scene, Some(1)).unwrap().remove(0);
    for (text, words) in [("bvh-subgroup", "not modelled"), ("bvh-stack:group=32x1", "32x1")] {
        let selection = Selection::parse(text).unwrap();
        let built = selection.build(&scene, 0).unwrap();
        let mut prepared = cpu.prepare(&scene, &*built.structure, selection.method()).unwrap();
        let error = prepared.in_warps(Config::P, &view, SIZE, Warps::all(32)).unwrap_err().to_string();
        assert!(error.contains(words), "{text}: {error}");
    }
}

#[test]
fn a_heat_map_has_the_percentage_of_each_work_group() {
    let cpu = CpuBackend::new(2).unwrap();
    let scene = load("hall:triangles=15000").unwrap();
    let selection = Selection::parse("bvh-stack").unwrap();
    let built = selection.build(&scene, 0).unwrap();
    let mut prepared = cpu.prepare(&scene, &*built.structure, selection.method()).unwrap();
    let view = CameraPath::for_scene(&scene, true).views(&scene, Some(1)).unwrap().remove(0);
    let percent = prepared.utilisation(Config::P, &view, SIZE, 32).unwrap();
    assert_eq!(percent.len(), SIZE.pixels());
    let at = |x: u32, y: u32| percent[(y * SIZE.width + x) as usize];
    for (x, y) in (0..SIZE.width).flat_map(|x| (0..SIZE.height).map(move |y| (x, y))) {
        assert_eq!(at(x, y), at(x / 8 * 8, y / 8 * 8), "{x} {y}");
        assert!((1..=100).contains(&at(x, y)), "{x} {y}: {}", at(x, y));
    }
    assert!(percent.iter().any(|&value| value != percent[0]));
    // One lane is all of its warp
    assert!(prepared.utilisation(Config::PSR, &view, SIZE, 1).unwrap().iter().all(|&value| value == 100));
}
