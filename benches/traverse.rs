//! CPU traversal of the same primary rays, in blocks of 64 on all threads: the twin of every structure, and obvhs with
//! precomputed triangles.
//!
//! `cargo bench --bench traverse`; set RTBENCH_SCENES for bunny and dragon.

mod common;

use common::Input;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::{Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;
use rayon::prelude::*;
use rtbench::camera::Camera;
use rtbench::scene::Scene;
use rtbench::workloads::trace::CpuBackend;
use rtbench::workloads::trace::backend::{Backend, GivenRay};
use rtbench::workloads::trace::{Selection, algorithms};
use std::hint::black_box;
use std::time::Duration;

/// Edge of a block of pixels that one thread traces at a time.
const BLOCK: u32 = 8;

/// The rays of one image, origin and direction, block by block (rows of 8 within a block): what every contestant
/// gets. `size` is a multiple of 8.
pub fn primary_rays(scene: &Scene, size: u32) -> Vec<(Vec3A, Vec3A)> {
    let bounds = scene.bounds();
    let back = Vec3::new(0.3, 0.2, 1.0).normalize();
    let camera = Camera {
        position: bounds.center() + back * bounds.diagonal() * 1.1,
        direction: -back,
        up: Vec3::Y,
        field_of_view: 45.0,
    };
    let grid = camera.pixel_grid(size, size);
    let ray = |x: u32, y: u32| {
        let direction = grid.corner + grid.right * (x as f32 + 0.5) + grid.down * (y as f32 + 0.5);
        (grid.origin.into(), direction.normalize().into())
    };
    let blocks = size / BLOCK;
    let block_rays = |block: u32| {
        let (left, top) = (block % blocks * BLOCK, block / blocks * BLOCK);
        (0..BLOCK * BLOCK).map(move |i| (left + i % BLOCK, top + i / BLOCK))
    };
    (0..blocks * blocks).flat_map(block_rays).map(|(x, y)| ray(x, y)).collect()
}

/// obvhs's tree and its triangles, in the order of its leaves.
struct Obvhs {
    tree: obvhs::bvh2::Bvh2,
    triangles: Vec<RtTriangle>,
}

impl Obvhs {
    fn new(input: &Input) -> Obvhs {
        let tree = common::obvhs(input, BvhBuildParams::medium_build());
        let triangles =
            tree.primitive_indices.iter().map(|&i| RtTriangle::from(&input.triangles[i as usize])).collect();
        Obvhs { tree, triangles }
    }

    /// Traces all rays on the current pool; returns how many hit anything.
    fn trace(&self, rays: &[(Vec3A, Vec3A)]) -> usize {
        let block = |rays: &[(Vec3A, Vec3A)]| {
            let hits = |&&(origin, direction): &&(Vec3A, Vec3A)| {
                let mut hit = RayHit::none();
                self.tree
                    .ray_traverse(Ray::new_inf(origin, direction), &mut hit, |ray, i| self.triangles[i].intersect(ray));
                hit.t < f32::INFINITY
            };
            rays.iter().filter(hits).count()
        };
        rays.par_chunks((BLOCK * BLOCK) as usize).map(block).sum()
    }
}

fn traverse(c: &mut Criterion) {
    let (triangles, size) = if common::measuring() { (200_000, 512) } else { (1000, 32) };
    traversals(c, &format!("scan-{triangles}"), &common::scan(triangles), size);
    if common::measuring() {
        for (name, scene) in common::models() {
            traversals(c, name, &scene, 1024);
        }
    }
}

fn traversals(c: &mut Criterion, name: &str, scene: &Scene, size: u32) {
    let rays = primary_rays(scene, size);
    let obvhs = Obvhs::new(&Input::new(scene));
    assert!(obvhs.trace(&rays) > rays.len() / 20, "the camera looks past {name}");
    let mut group = c.benchmark_group(format!("traverse/{name}/{size}"));
    group.sample_size(10).measurement_time(Duration::from_secs(3));
    group.throughput(Throughput::Elements(rays.len() as u64));
    group.bench_function("obvhs medium", |b| b.iter(|| black_box(obvhs.trace(&rays))));

    let cpu = CpuBackend::new(0).expect("threads");
    let ray = |&(origin, direction): &(Vec3A, Vec3A)| GivenRay { origin: origin.into(), direction: direction.into() };
    let given: Vec<GivenRay> = rays.iter().map(ray).collect();
    for algorithm in algorithms().iter().filter(|algorithm| algorithm.name != "brute") {
        let selection = Selection::parse(algorithm.name).expect("a name of the table");
        if selection.method().traversal.twin.is_none() {
            continue;
        }
        let built = selection.build(scene, 0).expect("builds");
        let mut twin = cpu.prepare(scene, &*built.structure, selection.method()).expect("fits");
        group.bench_function(algorithm.name, |b| b.iter(|| black_box(twin.trace(&given, false).expect("traces"))));
    }
}

criterion_group!(benches, traverse);
criterion_main!(benches);
