//! The bars of the builders, as ratios of interleaved rounds in one run: `cargo bench --bench bars`. Those of two
//! threads mean something only on a machine on which two builds at once take no longer than one.
//!
//! Every round builds each contestant once, in alternating order; a ratio is the median of the rounds' ratios, with the
//! interval that an exact sign test gives at about 95 %.

mod common;

use common::{Input, median, ratio};
use glam::Vec3;
use rtbench::record::statistics::sorted;
use rtbench::scene::Scene;
use rtbench::workloads::trace::Selection;
use std::hint::black_box;
use std::time::Instant;

/// Milliseconds of one build.
type Contestant<'a> = (&'static str, Box<dyn FnMut() -> f64 + 'a>);

fn own<'a>(name: &'static str, structure: &str, threads: usize, scene: &'a Scene) -> Contestant<'a> {
    let selection = Selection::parse(structure).expect("a name of the table");
    (name, Box::new(move || selection.build(scene, threads).expect("builds").build_ms))
}

fn timed<'a, T>(name: &'static str, build: impl Fn() -> T + 'a) -> Contestant<'a> {
    let run = move || {
        let start = Instant::now();
        black_box(build());
        start.elapsed().as_secs_f64() * 1e3
    };
    (name, Box::new(run))
}

fn main() {
    if !common::measuring() {
        println!("only a test that this runs: use cargo bench --bench bars");
        bars("scan", &common::scan(1000), 3);
        degenerate(1000, 3);
        return;
    }
    let mut scenes = common::models();
    if scenes.is_empty() {
        scenes = vec![("scan", common::scan(70_000))];
    }
    for (name, scene) in &scenes {
        let rounds = if scene.triangles.len() > 500_000 { 11 } else { 41 };
        bars(name, scene, rounds);
    }
    if !degenerate(20_000, 11) {
        std::process::exit(1);
    }
}

/// Where PLOC alone would take time with the square of the triangles: `ploc-stack` may take three times as long as
/// `bvh`, and a second. False where it takes longer.
fn degenerate(triangles: usize, rounds: usize) -> bool {
    let mut within = true;
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let steps = [("in one place", Vec3::ZERO), ("cards", Vec3::Z), ("in a row", Vec3::X)];
    for (name, step) in steps {
        let scene = common::soup((0..triangles).map(|i| corners.map(|corner| corner + step * i as f32)));
        let mut contestants = [
            own("bvh", "bvh", 0, &scene),
            own("ploc-stack", "ploc-stack", 0, &scene),
            own("ploc-stack, very-slow", "ploc-stack:preset=very-slow", 0, &scene),
            own("kdtree", "kdtree", 0, &scene),
            own("grid", "grid", 0, &scene),
        ];
        let mut runs: Vec<&mut dyn FnMut() -> f64> = contestants.iter_mut().map(|c| &mut *c.1 as _).collect();
        let times = common::interleaved(&mut runs, rounds);
        println!("{triangles} triangles {name}, all threads, {rounds} interleaved rounds");
        for ((label, _), times) in contestants.iter().zip(&times) {
            println!("  {label:28} median {:8.2} ms, slowest {:8.2} ms", median(times), sorted(times)[rounds - 1]);
        }
        let allowed = 3.0 * median(&times[0]) + 1000.0;
        let slowest = median(&times[1]).max(median(&times[2]));
        println!("  ploc-stack: {slowest:.2} ms, bar: at most {allowed:.2} ms");
        within &= slowest <= allowed;
    }
    within
}

fn bars(name: &str, scene: &Scene, rounds: usize) {
    let input = Input::new(scene);
    let one = common::pool(1);
    let mut contestants: Vec<Contestant> = vec![
        own("bvh, 1 thread", "bvh", 1, scene),
        own("bvh, 2 threads", "bvh", 2, scene),
        own("bvh leaves of 3, 1 thread", "bvh:max_leaf=3", 1, scene),
        own("sweep, 1 thread", "bvh:build=sweep,max_leaf=3", 1, scene),
        own("sweep, 2 threads", "bvh:build=sweep,max_leaf=3", 2, scene),
        own("spatial, 1 thread", "bvh:build=spatial,max_leaf=3", 1, scene),
        own("spatial, 2 threads", "bvh:build=spatial,max_leaf=3", 2, scene),
        own("bih, 1 thread", "bih", 1, scene),
        own("bih, 2 threads", "bih", 2, scene),
        own("kdtree, 1 thread", "kdtree", 1, scene),
        own("kdtree, 2 threads", "kdtree", 2, scene),
        own("grid, 1 thread", "grid", 1, scene),
        timed("parry3d binned, 1 thread", || common::parry(&input)),
        timed("obvhs medium, 1 thread", || {
            one.install(|| common::obvhs(&input, obvhs::BvhBuildParams::medium_build()))
        }),
    ];
    let mut runs: Vec<&mut dyn FnMut() -> f64> = contestants.iter_mut().map(|c| &mut *c.1 as _).collect();
    let times = common::interleaved(&mut runs, rounds);

    println!("{name}: {} triangles, {rounds} interleaved rounds", scene.triangles.len());
    for ((label, _), times) in contestants.iter().zip(&times) {
        println!("  {label:28} median {:8.2} ms, fastest {:8.2} ms", median(times), sorted(times)[0]);
    }
    let of = |label: &str| &times[contestants.iter().position(|c| c.0 == label).expect("a contestant")];
    for (a, b, bar) in [
        ("bvh, 1 thread", "parry3d binned, 1 thread", "at most 1"),
        ("bvh, 1 thread", "bvh, 2 threads", "at least 1.6"),
        ("sweep, 1 thread", "bvh leaves of 3, 1 thread", "at most 4"),
        ("sweep, 1 thread", "sweep, 2 threads", "at least 1.6"),
        ("spatial, 1 thread", "bvh leaves of 3, 1 thread", "at most 10"),
        ("spatial, 1 thread", "spatial, 2 threads", "at least 1.6"),
        ("bih, 1 thread", "bih, 2 threads", "at least 1.6"),
        ("kdtree, 1 thread", "bvh, 1 thread", "at most 5"),
        ("kdtree, 2 threads", "bvh, 2 threads", "at most 5"),
        ("grid, 1 thread", "bvh, 1 thread", "less than 1"),
        ("bvh, 1 thread", "obvhs medium, 1 thread", "none"),
    ] {
        let ratio = ratio(of(a), of(b));
        println!("  {a} / {b}: {:.3} ({:.3} to {:.3}), bar: {bar}", ratio.value, ratio.low, ratio.high);
    }
}
