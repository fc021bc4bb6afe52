//! Frames of the sphere tracer on one thread, by width, level, hit record and exits: `cargo bench --bench spheres`.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use rtbench::workloads::size::Size;
use rtbench::workloads::spheres::options::{Algorithm, HitRecord, Lanes, Options, Renderer};
use rtbench::workloads::spheres::render::{CpuRenderer, levels};
use rtbench::workloads::spheres::scene::Scene;
use rtbench::workloads::spheres::view::View;

fn options(hit: HitRecord, exits: bool) -> Options {
    Options { algorithm: Algorithm::OnePass, exit_on_miss: true, skip_no_hit: exits, skip_no_discriminant: exits, hit }
}

fn frames(criterion: &mut Criterion) {
    let pool = rtbench::threads::pool(1).expect("a thread");
    let scene = Scene::load("random100").expect("a scene of the program");
    let (spheres, view) = (scene.packed(), View::of(&scene, Size { width: 64, height: 36 }, 5, 0, 1));
    let mut image = vec![[0.0; 4]; (view.width * view.height) as usize];
    let mut group = criterion.benchmark_group("spheres");
    group.sample_size(20);
    let mut renderers = vec![("sequential".to_owned(), Renderer::Sequential)];
    for lanes in [Lanes::Four, Lanes::Eight, Lanes::Sixteen] {
        for level in levels() {
            let name = format!("simd-{}-{}", lanes.count(), level.name());
            renderers.push((name, Renderer::Simd(lanes, Some(level))));
        }
    }
    for (name, renderer) in renderers {
        for (hit, hit_name) in [(HitRecord::InLoop, "in-loop"), (HitRecord::Index, "index")] {
            for (exits, exits_name) in [(false, "no exits"), (true, "exits")] {
                // Scalar renderers have no such exits
                if exits && renderer == Renderer::Sequential {
                    continue;
                }
                let made = CpuRenderer::new(renderer, options(hit, exits), &pool).expect("a renderer");
                group.bench_function(BenchmarkId::new(&name, format!("{hit_name}, {exits_name}")), |bencher| {
                    bencher.iter(|| made.render(&spheres, &view, &mut image));
                });
            }
        }
    }
    group.finish();
}

criterion_group!(benches, frames);
criterion_main!(benches);
