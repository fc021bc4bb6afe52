//! The bars of the fastest rays on a driver that computes on the CPU, as ratios of interleaved rounds in one run:
//! `cargo bench --bench lavapipe`.
//!
//! Primary rays, 1024 squared, and diffuse rays that start where they hit, 512 squared: obvhs's own CPU traversal on
//! all threads (medium build, precomputed triangles, hits only), `bvh-stack` with indexed triangles and with triangles
//! in leaf order, `bvh-quantised`, and `bvh-subgroup`. A frame traces, shades and stores; "hits" is the stage of
//! `bvh-subgroup` that only finds hits; "rays" are rays in a buffer, of which a kernel finds the nearest hits. Rounds
//! alternate in order; a ratio is the median of the rounds' ratios, with the interval that an exact sign test gives at
//! about 95 %. obvhs is at its best with `RUSTFLAGS="-C target-cpu=native"`.

mod common;

use common::{Input, median, ratio};
use glam::{Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;
use rayon::prelude::*;
use rtbench::camera::{CameraPath, View};
use rtbench::device::vulkan::{Selector, VulkanOptions, adapters, choose};
use rtbench::device::{Frame, Pass, Stage, VulkanDevice};
use rtbench::math::{Hit, MISS};
use rtbench::record::statistics::sorted;
use rtbench::scene::Scene;
use rtbench::workloads::trace::backend::{Backend, Config, Prepared, Size, TraceRay};
use rtbench::workloads::trace::gpu::{HIT_BYTES, RayCaster};
use rtbench::workloads::trace::{Built, Selection};
use std::hint::black_box;
use std::time::Instant;

const STRUCTURES: [&str; 6] = [
    "bvh-stack:triangles=indexed",
    "bvh-stack",
    "bvh-quantised",
    "bvh-subgroup",
    "bvh-subgroup:max_leaf=4",
    "bvh-subgroup:width=2,rays=1",
];

/// Those of the structures above that cast rays in a buffer.
const ONE_BY_ONE: usize = 3;

/// Of two contestants, the first one's time as a multiple of the second one's: on the bunny, on the dragon.
type Bar = (&'static str, &'static str, &'static str, [f64; 2]);

const BARS: [Bar; 9] = [
    ("hits, obvhs", "obvhs", "bvh-subgroup hits", [3.8, 2.4]),
    ("hits with leaves of four, obvhs", "obvhs", "bvh-subgroup:max_leaf=4 hits", [3.8, 2.4]),
    ("hits, bvh-stack's frame", "bvh-stack:triangles=indexed", "bvh-subgroup hits", [3.8, 2.3]),
    ("frame, obvhs", "obvhs", "bvh-subgroup", [2.0, 1.6]),
    ("frame, bvh-stack as it was", "bvh-stack:triangles=indexed", "bvh-subgroup", [2.0, 1.6]),
    (
        "frame with leaves of four, bvh-stack as it was",
        "bvh-stack:triangles=indexed",
        "bvh-subgroup:max_leaf=4",
        [2.0, 1.6],
    ),
    ("traversal laid out anew", "bvh-stack:triangles=indexed rays", "bvh-quantised rays", [1.15, 1.12]),
    ("traversal, leaf order alone", "bvh-stack:triangles=indexed rays", "bvh-stack rays", [1.0, 1.0]),
    ("diffuse rays", "bvh-stack:triangles=indexed diffuse", "bvh-quantised diffuse", [1.08, 1.08]),
];

/// Milliseconds of one frame, by name: a frame may have several times.
type Times = Vec<(String, f64)>;
type Contestant<'a> = Box<dyn FnMut() -> Times + 'a>;

fn main() {
    let gpu = choose(&adapters(), &Selector::Best).and_then(|best| VulkanDevice::open(best, VulkanOptions::default()));
    let device = match &gpu {
        Ok(device) => device,
        Err(error) => return println!("not run: {error}"),
    };
    if !common::measuring() {
        println!("only a test that this runs: use cargo bench --bench lavapipe");
        rays("scan", &common::scan(1000), device, (32, 32), 3);
        return;
    }
    let mut scenes = common::models();
    if scenes.is_empty() {
        scenes = vec![("scan", common::scan(70_000))];
    }
    let rounds = std::env::var("ROUNDS").ok().and_then(|text| text.parse().ok()).unwrap_or(11);
    for (name, scene) in &scenes {
        rays(name, scene, device, (1024, 512), rounds);
    }
}

fn rays(name: &str, scene: &Scene, device: &VulkanDevice, (side, diffuse_side): (u32, u32), rounds: usize) {
    let view = &CameraPath::for_scene(scene, false).views(scene, Some(1)).expect("a path that fits")[0];
    let size = Size { width: side, height: side };
    let input = Input::new(scene);
    let tree = common::obvhs(&input, BvhBuildParams::medium_build());
    let of_leaf = |&i: &u32| RtTriangle::from(&input.triangles[i as usize]);
    let triangles: Vec<RtTriangle> = tree.primitive_indices.iter().map(of_leaf).collect();
    let built: Vec<(Selection, Built)> = STRUCTURES
        .map(|name| Selection::parse(name).expect("a name of the table"))
        .into_iter()
        .map(|selection| {
            let built = selection.build(scene, 0).expect("builds");
            (selection, built)
        })
        .collect();
    let primary = primary_rays(view, size);
    let diffuse =
        diffuse_rays(scene, device, &built[1], &primary_rays(view, Size { width: diffuse_side, height: diffuse_side }));

    let mut contestants: Vec<Contestant> = Vec::new();
    for (suffix, rays) in [("", &primary), (" diffuse", &diffuse)] {
        let (tree, triangles) = (&tree, &triangles);
        contestants.push(Box::new(move || vec![(format!("obvhs{suffix}"), obvhs_rays(tree, triangles, rays))]));
    }
    for (selection, built) in &built {
        let mut prepared = device.prepare(scene, &*built.structure, selection.method()).expect("fits");
        let label = selection.full_name();
        contestants.push(Box::new(move || frame(&label, prepared.as_mut(), view, size)));
    }
    for (selection, built) in &built[..ONE_BY_ONE] {
        for (suffix, rays) in [(" rays", &primary), (" diffuse", &diffuse)] {
            let label = selection.full_name() + suffix;
            contestants.push(cast(label, scene, device, selection, built, rays, &input, (&tree, &triangles)));
        }
    }

    let mut times: Vec<(String, Vec<f64>)> = Vec::new();
    for round in 0..=rounds {
        for i in rtbench::record::statistics::interleaved_order(contestants.len(), round) {
            for (label, ms) in contestants[i]() {
                let place = times.iter().position(|(known, _)| *known == label).unwrap_or_else(|| {
                    times.push((label, Vec::new()));
                    times.len() - 1
                });
                times[place].1.push(ms);
            }
        }
    }
    // The first round warms up
    times.iter_mut().for_each(|(_, times)| _ = times.remove(0));
    let of = |label: &str| times.iter().find(|(known, _)| known == label).map(|(_, times)| times);
    println!(
        "{name}: {} triangles, P at {side}x{side}, {} diffuse rays, {rounds} interleaved rounds",
        scene.triangles.len(),
        diffuse.len()
    );
    for (label, own) in &times {
        let base = if label.ends_with("diffuse") { "obvhs diffuse" } else { "obvhs" };
        print!("  {label:40} median {:8.2} ms, fastest {:8.2} ms", median(own), sorted(own)[0]);
        let ratio = ratio(of(base).expect("a contestant"), own);
        println!(", {:.3} ({:.3} to {:.3}) of obvhs's rays per second", ratio.value, ratio.low, ratio.high);
    }
    for (what, slow, fast, bars) in BARS {
        let (Some(slow), Some(fast)) = (of(slow), of(fast)) else { continue };
        let ratio = ratio(slow, fast);
        let bar = match name {
            "bunny" => format!("at least {}", bars[0]),
            "dragon" => format!("at least {}", bars[1]),
            _ => "none".to_owned(),
        };
        println!("  {what}: {:.3} ({:.3} to {:.3}), bar: {bar}", ratio.value, ratio.low, ratio.high);
    }
}

/// The time of a frame, and those of its stages.
fn frame(label: &str, prepared: &mut dyn Prepared, view: &View, size: Size) -> Times {
    let times = prepared.time_path(Config::P, std::slice::from_ref(view), size, &|| false).expect("runs");
    let stages = prepared.stages(Config::P);
    let mut all = vec![(label.to_owned(), times[0].wall_ns as f64 * 1e-6)];
    if stages.len() > 1 {
        all.extend(
            stages.iter().zip(&times[0].stages).map(|(stage, &ns)| (format!("{label} {stage}"), ns as f64 * 1e-6)),
        );
    }
    all
}

/// The rays of a frame, tile by tile of 8 x 8 pixels.
fn primary_rays(view: &View, size: Size) -> Vec<TraceRay> {
    let grid = view.camera.pixel_grid(size.width, size.height);
    let groups = size.width / 8;
    let of_group = |group: u32| {
        (0..64).map(move |lane| {
            let (x, y) = (group % groups * 8 + lane % 8, group / groups * 8 + lane / 8);
            let direction = grid.corner + grid.right * (x as f32 + 0.5) + grid.down * (y as f32 + 0.5);
            TraceRay::new(grid.origin, direction.normalize())
        })
    };
    (0..groups * groups).flat_map(of_group).collect()
}

/// One ray from each point that is hit, in a cosine-distributed direction.
fn diffuse_rays(scene: &Scene, device: &VulkanDevice, built: &(Selection, Built), rays: &[TraceRay]) -> Vec<TraceRay> {
    let (selection, built) = built;
    let mut prepared = device.prepare(scene, &*built.structure, selection.method()).expect("fits");
    let hits = prepared.cast(rays, None).expect("runs");
    let epsilon = rtbench::workloads::trace::backend::surface_epsilon(scene.bounds());
    let mut state = 1u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    };
    let hits = rays.iter().zip(hits).filter(|(_, hit)| hit.triangle != MISS);
    hits.map(|(ray, hit)| {
        let [a, b, c] = scene.corners(hit.triangle);
        let normal = Vec3::from((b - a).cross(c - a)).normalize_or(Vec3::Y);
        let normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
        let (radius, angle) = (random().sqrt(), random() * std::f32::consts::TAU);
        let (x, y) = normal.any_orthonormal_pair();
        let across = (x * angle.cos() + y * angle.sin()) * radius;
        let direction = (across + normal * (1.0 - radius * radius).max(0.0).sqrt()).normalize();
        TraceRay::new(ray.origin + ray.direction * hit.t + normal * epsilon, direction)
    })
    .collect()
}

/// Casts rays in a buffer of the device; what is found is compared with obvhs's hits before.
#[allow(clippy::too_many_arguments)]
fn cast<'a>(
    label: String,
    scene: &'a Scene,
    device: &'a VulkanDevice,
    selection: &Selection,
    built: &'a Built,
    rays: &'a [TraceRay],
    input: &Input,
    (tree, triangles): (&Bvh2, &[RtTriangle]),
) -> Contestant<'a> {
    let caster = RayCaster::new(device, scene, &*built.structure, selection.method()).expect("fits");
    let given = device.storage("the rays", rays).expect("fits");
    let hits = device.poisoned("the hits", rays.len() as u64 * HIT_BYTES).expect("fits");
    let cast = caster.cast(&given, &hits, rays.len() as u32, None).expect("compiles");
    device.run(&Frame::new(vec![Pass { stage: Stage("cast"), work: cast.dispatch() }])).expect("runs");
    let found: Vec<[u32; 2]> = device.read(&hits, rays.len()).expect("comes back");
    let found: Vec<Hit> = found.iter().map(|&[t, triangle]| Hit { t: f32::from_bits(t), triangle }).collect();
    let differing =
        rays.par_iter().zip(&found).filter(|(ray, hit)| obvhs_hit(tree, triangles, ray) != (hit.triangle != MISS));
    let differing = differing.count();
    println!("{label}: {differing} of {} rays hit something by one and nothing by the other", rays.len());
    assert!(differing <= rays.len() / 2000, "{} triangles", input.triangles.len());
    Box::new(move || {
        let frame = Frame::new(vec![Pass { stage: Stage("cast"), work: cast.dispatch() }]);
        let times = device.run_frames(&[frame], &|| false).expect("runs");
        vec![(label.clone(), times[0].wall_ns as f64 * 1e-6)]
    })
}

fn obvhs_hit(tree: &Bvh2, triangles: &[RtTriangle], ray: &TraceRay) -> bool {
    let mut hit = RayHit::none();
    let ray = Ray::new_inf(Vec3A::from(ray.origin), Vec3A::from(ray.direction));
    tree.ray_traverse(ray, &mut hit, |ray, i| triangles[i].intersect(ray));
    hit.t < f32::INFINITY
}

fn obvhs_rays(tree: &Bvh2, triangles: &[RtTriangle], rays: &[TraceRay]) -> f64 {
    let start = Instant::now();
    let hits: usize =
        rays.par_chunks(64).map(|rays| rays.iter().filter(|ray| obvhs_hit(tree, triangles, ray)).count()).sum();
    black_box(hits);
    start.elapsed().as_secs_f64() * 1e3
}
