//! The bars of the traversals, as ratios of interleaved rounds in one run: `cargo bench --bench rays`.
//!
//! One frame of primary rays, 1024 squared: obvhs's own CPU traversal (medium build, precomputed triangles, hit or miss
//! only) against `bvh-stack` of each builder, `bih`, `ploc-stack` and kd-trees, which also shade and store, as CPU
//! twins and on the best Vulkan device. Rounds alternate in order; a ratio is the median of the rounds' ratios, with
//! the interval that an exact sign test gives at about 95 %.

mod common;

use common::{Input, median, ratio};
use obvhs::BvhBuildParams;
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;
use rayon::prelude::*;
use rtbench::camera::{CameraPath, View};
use rtbench::device::VulkanDevice;
use rtbench::device::vulkan::{Selector, VulkanOptions, adapters, choose};
use rtbench::record::statistics::sorted;
use rtbench::scene::Scene;
use rtbench::workloads::trace::CpuBackend;
use rtbench::workloads::trace::backend::{Backend, Config, Prepared, Size};
use rtbench::workloads::trace::{Built, Selection};
use std::hint::black_box;
use std::time::Instant;

/// Milliseconds of one frame.
type Contestant<'a> = (String, Box<dyn FnMut() -> f64 + 'a>);

const STRUCTURES: [&str; 16] = [
    "bvh-stack",
    "bvh-stack:build=sweep,max_leaf=3",
    "bvh-stack:build=sweep,max_leaf=3,cull=off",
    "bvh-stack:build=spatial,max_leaf=3",
    "bih",
    "ploc-stack",
    "kdtree:build=sort",
    "kdtree:build=sort,search=stack",
    "kdtree:build=sort,search=ropes",
    "bvh-quantised",
    "bvh4",
    "bvh8",
    "bvh8:order=octant",
    "bvh8:stack=short",
    "bvh8:build=ploc",
    "cwbvh",
];

fn main() {
    if !common::measuring() {
        println!("only a test that this runs: use cargo bench --bench rays");
        rays("scan", &common::scan(1000), 32, 3);
        return;
    }
    let mut scenes = common::models();
    if scenes.is_empty() {
        scenes = vec![("scan", common::scan(70_000))];
    }
    for (name, scene) in &scenes {
        rays(name, scene, 1024, 21);
    }
}

fn rays(name: &str, scene: &Scene, side: u32, rounds: usize) {
    let size = Size { width: side, height: side };
    let path = CameraPath::for_scene(scene, Config::P.shadows());
    let view = &path.views(scene, Some(1)).expect("a path that fits")[0];
    let input = Input::new(scene);
    let tree = common::obvhs(&input, BvhBuildParams::medium_build());
    let triangles: Vec<RtTriangle> =
        tree.primitive_indices.iter().map(|&i| RtTriangle::from(&input.triangles[i as usize])).collect();
    let built: Vec<(Selection, Built)> = STRUCTURES
        .map(|name| Selection::parse(name).expect("a name of the table"))
        .into_iter()
        .map(|selection| {
            let built = selection.build(scene, 0).expect("builds");
            (selection, built)
        })
        .collect();
    let cpu = CpuBackend::new(0).expect("threads");
    let gpu = choose(&adapters(), &Selector::Best).and_then(|best| VulkanDevice::open(best, VulkanOptions::default()));
    if let Err(error) = &gpu {
        println!("the GPU is left out: {error}");
    }
    let mut contestants: Vec<Contestant> =
        vec![("obvhs".into(), Box::new(|| obvhs_frame(&tree, &triangles, view, size)))];
    for backend in [Some(&cpu as &dyn Backend), gpu.as_ref().ok().map(|gpu| gpu as &dyn Backend)].into_iter().flatten()
    {
        for (selection, built) in &built {
            let mut prepared = backend.prepare(scene, &*built.structure, selection.method()).expect("fits");
            frame(prepared.as_mut(), view, size);
            let label = format!("{} ({})", selection.full_name(), backend.info().backend);
            contestants.push((label, Box::new(move || frame(prepared.as_mut(), view, size))));
        }
    }

    let mut runs: Vec<&mut dyn FnMut() -> f64> = contestants.iter_mut().map(|c| &mut *c.1 as _).collect();
    let times = common::interleaved(&mut runs, rounds);
    println!("{name}: {} triangles, P at {side}x{side}, {rounds} interleaved rounds", scene.triangles.len());
    for ((label, _), own) in contestants.iter().zip(&times) {
        let rate = size.pixels() as f64 / median(own) * 1e-3;
        print!("  {label:50} median {:8.2} ms, fastest {:8.2} ms, {rate:6.2} Mrays/s", median(own), sorted(own)[0]);
        let ratio = ratio(&times[0], own);
        println!(", {:.3} ({:.3} to {:.3}) of obvhs's rays per second", ratio.value, ratio.low, ratio.high);
    }
}

fn frame(prepared: &mut dyn Prepared, view: &View, size: Size) -> f64 {
    let times = prepared.time_path(Config::P, std::slice::from_ref(view), size, &|| false).expect("runs");
    times[0].wall_ns as f64 * 1e-6
}

fn obvhs_frame(tree: &obvhs::bvh2::Bvh2, triangles: &[RtTriangle], view: &View, size: Size) -> f64 {
    let start = Instant::now();
    let groups = size.width / 8;
    let grid = view.camera.pixel_grid(size.width, size.height);
    let hits: usize = (0..groups * groups)
        .into_par_iter()
        .map(|group| {
            let (left, top) = (group % groups * 8, group / groups * 8);
            let hits = |lane: &u32| {
                let (x, y) = ((left + lane % 8) as f32 + 0.5, (top + lane / 8) as f32 + 0.5);
                let direction = (grid.corner + grid.right * x + grid.down * y).normalize();
                let mut hit = RayHit::none();
                let ray = Ray::new_inf(grid.origin.into(), direction.into());
                tree.ray_traverse(ray, &mut hit, |ray, i| triangles[i].intersect(ray));
                hit.t < f32::INFINITY
            };
            (0..64).filter(hits).count()
        })
        .sum();
    assert!(black_box(hits) > 0, "the camera looks past the scene");
    start.elapsed().as_secs_f64() * 1e3
}
