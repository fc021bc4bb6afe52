//! Building every structure, over several sizes, on one thread and on all, and builders of other crates.
//!
//! `cargo bench --bench build`; set RTBENCH_SCENES for bunny and dragon.

mod common;

use bvh::bounding_hierarchy::BoundingHierarchy;
use common::Input;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use obvhs::BvhBuildParams;
use rtbench::scene::Scene;
use rtbench::workloads::trace::Selection;
use std::hint::black_box;
use std::time::Duration;

const STRUCTURES: [&str; 20] = [
    "grid",
    "kdtree",
    "kdtree:build=sort",
    "kdtree:build=sort,sorting=every-node",
    "kdtree:build=min-max",
    "kdtree:build=sort,search=ropes",
    "kdtree:build=sort,push=off,search=ropes",
    "bvh",
    "bvh:max_leaf=3",
    "bvh:build=sweep,max_leaf=3",
    "bvh:build=sweep,max_leaf=3,sorting=every-node",
    "bvh:build=spatial,max_leaf=3",
    "bih",
    "ploc-stack",
    "bvh-quantised",
    "bvh4",
    "bvh8",
    "bvh8:build=ploc",
    "cwbvh",
    "cwbvh:build=binned",
];

fn build(c: &mut Criterion) {
    let sizes: &[usize] = if common::measuring() { &[10_000, 100_000, 1_000_000] } else { &[1000] };
    for &size in sizes {
        builders(c, &format!("scan-{size}"), &common::scan(size));
    }
    if common::measuring() {
        for (name, scene) in common::models() {
            builders(c, name, &scene);
        }
    }
}

fn builders(c: &mut Criterion, name: &str, scene: &Scene) {
    let input = Input::new(scene);
    for (threads, label) in [(1, "1 thread"), (0, "all threads")] {
        let pool = common::pool(threads);
        let mut group = c.benchmark_group(format!("build/{name}"));
        group.sample_size(10).measurement_time(Duration::from_secs(3));
        group.throughput(Throughput::Elements(scene.triangles.len() as u64));
        for structure in STRUCTURES {
            let selection = Selection::parse(structure).expect("a name of the table");
            // The selection brings a pool of its own; starting it is no part of the time that it reports.
            group.bench_function(BenchmarkId::new(structure, label), |b| {
                b.iter_custom(|rounds| {
                    let build = |_| selection.build(scene, threads).expect("builds").build_ms;
                    Duration::from_secs_f64((0..rounds).map(build).sum::<f64>() / 1e3)
                })
            });
        }
        for (builder, params) in [("fast", BvhBuildParams::fast_build()), ("medium", BvhBuildParams::medium_build())] {
            group.bench_function(BenchmarkId::new(format!("obvhs {builder}"), label), |b| {
                b.iter(|| pool.install(|| black_box(common::obvhs(&input, params))))
            });
        }
        // These two know one thread, except for the parallel variant of the bvh crate's.
        group.bench_function(BenchmarkId::new("bvh crate", label), |b| {
            let build = |mut shapes: Vec<_>| match threads {
                1 => bvh::bvh::Bvh::build(&mut shapes),
                _ => pool.install(|| bvh::bvh::Bvh::build_par(&mut shapes)),
            };
            b.iter_batched(|| input.shapes.clone(), build, criterion::BatchSize::LargeInput)
        });
        if threads == 1 {
            group.bench_function(BenchmarkId::new("parry3d binned", label), |b| {
                b.iter(|| black_box(common::parry(&input)))
            });
        }
    }
}

criterion_group!(benches, build);
criterion_main!(benches);
