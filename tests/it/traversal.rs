//! Every traversal against brute force, and the GPU against the CPU twins to the bit: random triangles, meshes with
//! shared edges, rays from outside and inside, along axes and in planes of triangles.

use crate::support::{gpu, random, soup};
use glam::Vec3;
use proptest::prelude::*;
use rtbench::camera::{Camera, View};
use rtbench::math::{Hit, MISS};
use rtbench::scene::{Light, Material, Scene};
use rtbench::workloads::trace::CpuBackend;
use rtbench::workloads::trace::backend::{
    Backend, Config, CountedPixel, DeviceInfo, DeviceType, GivenRay, Pixel, Size,
};
use rtbench::workloads::trace::verify::COUNTER_SHARE;
use rtbench::workloads::trace::{Selection, algorithms};

/// Rays of every character around a box from -1 to 1.
fn rays(count: usize, seed: u32) -> Vec<GivenRay> {
    let mut random = random(seed);
    (0..count)
        .map(|index| {
            let mut point = |scale: f32| Vec3::new(random(), random(), random()) * scale;
            let (outside, inside, target) = (point(if index % 2 == 0 { 3.0 } else { 30.0 }), point(1.0), point(1.0));
            let direction = (target - outside).normalize_or(Vec3::X);
            match index % 5 {
                0 => GivenRay { origin: outside, direction },
                1 => GivenRay { origin: inside, direction },
                // Along an axis: two components are exactly zero
                2 => GivenRay { origin: inside - Vec3::Z * 3.0, direction: Vec3::Z },
                // In a plane of the lattice that flat soups lie in, with one zero component and no unit length
                3 => GivenRay {
                    origin: (outside * 4.0).round() / 4.0,
                    direction: Vec3::new(direction.x, 0.0, direction.z) * 7.0,
                },
                _ => GivenRay { origin: inside, direction: -Vec3::Y * 0.01 },
            }
        })
        .filter(|ray| ray.direction != Vec3::ZERO)
        .collect()
}

pub fn trace(backend: &dyn Backend, scene: &Scene, selection: &str, rays: &[GivenRay], any_hit: bool) -> Vec<Hit> {
    let selection = Selection::parse(selection).unwrap();
    let built = selection.build(scene, 1).unwrap();
    backend.prepare(scene, &*built.structure, selection.method()).unwrap().trace(rays, any_hit).unwrap()
}

/// How many of `of` may differ: none where the device computes to the bit. Elsewhere (a GPU may contract and
/// approximate) rounding decides about rays in the planes of triangles, of which there are many here.
fn allowed(device: &DeviceInfo, of: usize) -> usize {
    if device.agrees_with_twins() { 0 } else { (of as f64 * COUNTER_SHARE) as usize }
}

pub fn assert_same(device: &DeviceInfo, name: &str, rays: &[GivenRay], expected: &[Hit], found: &[Hit]) {
    assert_eq!(expected.len(), found.len());
    let near = |a: f32, b: f32| {
        a.to_bits() == b.to_bits()
            || (!device.agrees_with_twins() && (a - b).abs() <= 1e-5 * a.abs().max(b.abs()).max(1.0))
    };
    let same = |a: &Hit, b: &Hit| a.triangle == b.triangle && near(a.t, b.t);
    let wrong: Vec<usize> = (0..rays.len()).filter(|&index| !same(&expected[index], &found[index])).collect();
    if wrong.len() > allowed(device, rays.len()) {
        let (index, count) = (wrong[0], wrong.len());
        let (ray, expected, found) = (&rays[index], &expected[index], &found[index]);
        panic!("{name}: {count} rays differ, the first: {ray:?}: expected {expected:?}, found {found:?}");
    }
}

/// As many of `pairs` as a device may get wrong may differ.
fn assert_equal<T: PartialEq + std::fmt::Debug>(device: &DeviceInfo, what: &str, expected: &[T], found: &[T]) {
    assert_eq!(expected.len(), found.len(), "{what}");
    let wrong: Vec<usize> = (0..expected.len()).filter(|&index| expected[index] != found[index]).collect();
    if wrong.len() > allowed(device, expected.len()) {
        let (index, count) = (wrong[0], wrong.len());
        panic!("{what}: {count} differ, the first is {index}: {:?} instead of {:?}", found[index], expected[index]);
    }
}

/// Algorithms with a twin, whose hits are those of all others to the bit.
fn names() -> Vec<&'static str> {
    let has_twin = |name: &&str| Selection::parse(name).unwrap().method().traversal.twin.is_some();
    algorithms().iter().map(|algorithm| algorithm.name).filter(has_twin).collect()
}

/// Ways to walk a structure other than each one's own.
const OTHERS: [&str; 80] = [
    "kdtree:search=restart",
    "kdtree:search=pushdown",
    "kdtree:stack=1",
    "kdtree:stack=3,memory=private",
    "kdtree:stack=2",
    "kdtree:stack=5,memory=private",
    "kdtree:stack=32",
    "kdtree:search=stack",
    "kdtree:search=ropes",
    "kdtree:push=off,search=ropes",
    "kdtree:thin=0,search=stack",
    "kdtree:thin=0,search=ropes",
    "kdtree:build=sort,search=ropes",
    "kdtree:build=min-max,search=ropes",
    "kdtree:thin=0,search=restart",
    "kdtree:thin=0,stack=1",
    "bvh:vote=original",
    "bvh:packet=8x4",
    "bvh:packet=4x4,vote=original",
    "bvh:build=spatial,max_leaf=2,alpha=0",
    "bvh-stack:cull=off",
    "bvh-stack:build=sweep,max_leaf=3",
    "bvh-stack:build=spatial,max_leaf=3",
    "bvh-stack:build=spatial,max_leaf=1,alpha=0,cull=off",
    "ploc-stack:preset=slow",
    "bih:max_leaf=1",
    "grid-coop:packet=4x4",
    "grid-packet:packet=4x4",
    "grid:group=32x1,tiles=3",
    "bvh-stack:group=16x16,checks=on",
    "bvh:tiles=2",
    // Frames of several passes
    "bvh-stack:reflections=staged",
    "kdtree:reflections=staged,tiles=2",
    "grid:reflections=staged,group=16x16,fetch=buffers",
    // Scene and structure in both kinds of memory, whichever a device would take by itself
    "grid:fetch=buffers",
    "kdtree:fetch=buffers",
    "bvh:fetch=buffers",
    "bvh-stack:fetch=buffers",
    "bih:fetch=buffers",
    "kdtree:search=ropes,fetch=buffers",
    "grid:fetch=textures",
    "kdtree:fetch=textures",
    "kdtree:search=ropes,fetch=textures",
    "bvh:fetch=textures",
    "bvh-stack:fetch=textures",
    "bih:fetch=textures",
    "bvh-quantised:cull=off",
    "bvh-quantised:build=spatial,max_leaf=1,alpha=0",
    "bvh4:order=octant",
    "bvh4:build=spatial,max_leaf=3",
    "bvh8:order=octant",
    "bvh8:cull=off",
    "bvh8:build=ploc,preset=slow",
    "bvh8:build=spatial,max_leaf=1,alpha=0,order=octant",
    "cwbvh:build=binned",
    "cwbvh:build=spatial",
    "cwbvh:preset=slow",
    "bvh-quantised:fetch=buffers",
    "bvh8:fetch=buffers",
    "bvh8:order=octant,fetch=buffers",
    "cwbvh:fetch=buffers",
    "bvh4:stack=short,entries=1",
    "bvh4:stack=short,entries=3",
    "bvh8:stack=short",
    "bvh8:build=spatial,max_leaf=1,alpha=0,stack=short,entries=2",
    "bvh-stack:triangles=indexed",
    "bvh-stack:triangles=leaf-order",
    "bvh-stack:triangles=leaf-order,fetch=buffers",
    "bvh-subgroup:rays=1",
    "bvh-subgroup:rays=2,width=2",
    "bvh-subgroup:rays=4,width=4,fetch=buffers",
    "bvh-subgroup:build=spatial,max_leaf=1,alpha=0",
    "bvh-subgroup:max_leaf=15,tiles=2",
    "bvh-stack:loop=if-if",
    "bvh-stack:loop=persistent",
    "bvh-stack:loop=speculative",
    "bvh-stack:loop=speculative,cull=off",
    "bvh-stackless:search=trail",
    "bvh-stackless:build=spatial,max_leaf=1,alpha=0",
    "bvh-stackless:build=spatial,max_leaf=1,alpha=0,search=trail",
];

pub fn all_names() -> Vec<&'static str> {
    names().into_iter().chain(OTHERS).collect()
}

/// All structures on one backend, nearest and any hit, against brute force on the CPU.
pub fn check_all(backend: &dyn Backend, scene: &Scene, rays: &[GivenRay]) {
    let cpu = CpuBackend::new(2).unwrap();
    let nearest = trace(&cpu, scene, "brute", rays, false);
    let hits: Vec<bool> = nearest.iter().map(|hit| hit.triangle != MISS).collect();
    for name in all_names() {
        assert_same(backend.info(), name, rays, &nearest, &trace(backend, scene, name, rays, false));
        let any: Vec<bool> = trace(backend, scene, name, rays, true).iter().map(|hit| hit.triangle != MISS).collect();
        assert_equal(backend.info(), &format!("{name}: any hit"), &hits, &any);
    }
}

#[test]
fn twins_find_what_brute_force_finds() {
    for (index, flat) in [(0, false), (1, true)] {
        let scene = soup(700, 7 + index, flat);
        check_all(&CpuBackend::new(2).unwrap(), &scene, &rays(4000, 3));
    }
}

#[test]
fn gpu_finds_what_brute_force_finds() {
    let Some(gpu) = gpu() else { return };
    for (index, flat) in [(0, false), (1, true)] {
        let scene = soup(700, 70 + index, flat);
        check_all(gpu, &scene, &rays(4000, 5));
    }
}

/// lavapipe ends a loop after 65,535 turns; the brute-force kernel must not notice.
#[test]
fn gpu_brute_force_sees_all_of_a_large_scene() {
    let Some(gpu) = gpu() else { return };
    let scene = soup(70_000, 1, false);
    let cpu = CpuBackend::new(2).unwrap();
    let rays = rays(200, 9);
    let expected = trace(&cpu, &scene, "bvh-stack", &rays, false);
    assert_same(gpu.info(), "brute", &rays, &expected, &trace(gpu, &scene, "brute", &rays, false));
    let late = expected.iter().filter(|hit| hit.triangle != MISS && hit.triangle > 65_535).count();
    assert!(late > 0, "no ray hits a triangle beyond the 65,535th: the test would see nothing");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn twins_agree_on_random_scenes(triangles in 1usize..120, seed in 0u32..10_000, flat: bool) {
        let scene = soup(triangles, seed, flat);
        check_all(&CpuBackend::new(1).unwrap(), &scene, &rays(300, seed ^ 0x55));
    }
}

pub fn view(lights: usize) -> View {
    let direction = Vec3::new(0.3, -0.35, -1.0).normalize();
    let lights = (0..lights).map(|i| {
        let angle = i as f32 * 2.1;
        Light::new(Vec3::new(3.0 * angle.sin(), 2.5, 3.0 * angle.cos()), Vec3::splat(0.6))
    });
    View {
        camera: Camera { position: direction * -3.2, direction, up: Vec3::Y, field_of_view: 50.0 },
        lights: lights.collect(),
    }
}

pub fn shiny(mut scene: Scene) -> Scene {
    scene.materials.push(Material::matt(Vec3::new(0.3, 0.5, 0.8)).shiny(Vec3::splat(0.5), 30.0, 0.6));
    for (index, triangle) in scene.triangles.iter_mut().enumerate() {
        triangle.material = (index % 3 == 0) as u32;
    }
    scene
}

pub fn counted(
    backend: &dyn Backend,
    scene: &Scene,
    name: &str,
    config: Config,
    size: Size,
) -> (Vec<CountedPixel>, Vec<Pixel>) {
    let selection = Selection::parse(name).unwrap();
    let built = selection.build(scene, 1).unwrap();
    let mut prepared = backend.prepare(scene, &*built.structure, selection.method()).unwrap();
    let mut pixels = Vec::new();
    prepared.counted(config, &view(3), size, &mut |_, band| pixels.extend_from_slice(band)).unwrap();
    let timed = prepared.image(config, &view(3), size).unwrap();
    (pixels, timed)
}

/// Sizes that are no multiple of a work-group's eight: the last groups hang over the edge.
pub const SIZE: Size = Size { width: 75, height: 43 };

#[test]
fn timed_and_counting_twins_make_the_same_picture() {
    let scene = shiny(soup(400, 11, false));
    let cpu = CpuBackend::new(2).unwrap();
    for config in Config::ALL {
        let (reference, _) = counted(&cpu, &scene, "brute", config, SIZE);
        let rays = |kind: usize| reference.iter().map(|p| p.counters[kind].rays).sum::<u32>();
        assert_eq!(rays(0) as usize, SIZE.pixels());
        assert_eq!(rays(1) > 0, config.shadows());
        assert_eq!(rays(2) > 0, config.bounces() > 0);
        assert_eq!(rays(3) > 0, config == Config::AO);
        assert_eq!(rays(4) > 0, config == Config::DIFFUSE);
        for name in all_names() {
            let (pixels, timed) = counted(&cpu, &scene, name, config, SIZE);
            for (index, (pixel, expected)) in pixels.iter().zip(&reference).enumerate() {
                assert_eq!(pixel.pixel, timed[index], "{name} {config:?} pixel {index}: timed and counting differ");
                assert_eq!(pixel.pixel, expected.pixel, "{name} {config:?} pixel {index}");
                assert_eq!(pixel.t, expected.t, "{name} {config:?} pixel {index}");
                assert_eq!(pixel.counters.map(|c| c.rays), expected.counters.map(|c| c.rays), "{name} pixel {index}");
            }
        }
    }
}

/// On lavapipe, to the bit: triangles, distances, every counter; and colours but for `pow`.
#[test]
fn gpu_counts_what_its_twin_counts() {
    let Some(gpu) = gpu() else { return };
    if !gpu.info().agrees_with_twins() {
        eprintln!("not run: {} is not compared to the bit", gpu.info().name);
        return;
    }
    let cpu = CpuBackend::new(2).unwrap();
    for scene in [shiny(soup(400, 12, false)), shiny(soup(400, 13, true))] {
        for config in Config::ALL {
            // A driver takes a second to compile some kernels: what is not a structure's own way is run with all rays
            let all = config == Config::PSR;
            for name in if all { all_names() } else { names() } {
                let (twin, _) = counted(&cpu, &scene, name, config, SIZE);
                let (kernel, timed) = counted(gpu, &scene, name, config, SIZE);
                for (index, (kernel, twin)) in kernel.iter().zip(&twin).enumerate() {
                    let place = format!("{name} {config:?} pixel {index}");
                    assert_eq!(kernel.pixel, timed[index], "{place}: timed and counting kernels differ");
                    assert_eq!(kernel.pixel.triangle, twin.pixel.triangle, "{place}");
                    assert_eq!(kernel.t, twin.t, "{place}: distance");
                    assert_eq!(kernel.counters, twin.counters, "{place}");
                    let channels = kernel.pixel.rgba.to_le_bytes().into_iter().zip(twin.pixel.rgba.to_le_bytes());
                    let worst = channels.map(|(a, b)| a.abs_diff(b)).max().unwrap();
                    assert!(
                        worst <= rtbench::workloads::trace::verify::COLOUR_LEVELS,
                        "{place}: colours differ by {worst}"
                    );
                }
            }
        }
    }
}

/// Options that change which rays there are: all traversals with the same option agree, and the option does something.
#[test]
fn other_rays_are_the_same_for_all() {
    let scene = shiny(soup(400, 17, false));
    let cpu = CpuBackend::new(2).unwrap();
    let (plain, _) = counted(&cpu, &scene, "bvh-stack", Config::PS, SIZE);
    let backends = [Some(&cpu as &dyn Backend), gpu().map(|gpu| gpu as &dyn Backend)];
    for option in ["shadows=to-light", "pattern=four", "pattern=four,tiles=2,shadows=to-light"] {
        let (reference, _) = counted(&cpu, &scene, &format!("brute:{option}"), Config::PS, SIZE);
        let (changed, _) = counted(&cpu, &scene, &format!("bvh-stack:{option}"), Config::PS, SIZE);
        assert!(changed != plain, "{option} changes nothing");
        for backend in backends.into_iter().flatten() {
            // On the CPU all of them, on a driver that takes its time to compile two
            let all = ["bvh", "bvh-stack", "grid", "kdtree", "grid-coop", "grid-packet"];
            for name in if backend.info().backend == "cpu" { &all[..] } else { &all[..2] } {
                let (twin, _) = counted(&cpu, &scene, &format!("{name}:{option}"), Config::PS, SIZE);
                let (pixels, _) = counted(backend, &scene, &format!("{name}:{option}"), Config::PS, SIZE);
                let device = backend.info();
                let place = format!("{name}:{option} on {}", device.backend);
                let triangles = |pixels: &[CountedPixel]| pixels.iter().map(|p| p.pixel.triangle).collect::<Vec<_>>();
                assert_equal(device, &place, &triangles(&reference), &triangles(&pixels));
                if device.agrees_with_twins() {
                    let bits = |pixels: &[CountedPixel]| pixels.iter().map(|p| p.t).collect::<Vec<_>>();
                    let counters = |pixels: &[CountedPixel]| pixels.iter().map(|p| p.counters).collect::<Vec<_>>();
                    assert_equal(device, &place, &bits(&reference), &bits(&pixels));
                    assert_equal(device, &place, &counters(&twin), &counters(&pixels));
                }
            }
        }
    }
    // Four rays, each over whole work-groups
    let (four, _) = counted(&cpu, &scene, "brute:pattern=four", Config::P, Size { width: 64, height: 64 });
    let mut distances: Vec<u32> = four.iter().map(|p| p.t).collect();
    assert!((0..8).all(|x| four[x].t == four[0].t && four[x + 16].t == four[0].t));
    distances.sort();
    distances.dedup();
    assert!(distances.len() <= 4, "{} different rays", distances.len());
    // And the same four at every resolution: the test's whole point (figure 5.3)
    for side in [16, 128, 256] {
        let (other, _) = counted(&cpu, &scene, "brute:pattern=four", Config::P, Size { width: side, height: side });
        let group = |pixels: &[CountedPixel], side: usize, x: usize, y: usize| pixels[8 * y * side + 8 * x].t;
        for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            assert_eq!(group(&other, side as usize, x, y), group(&four, 64, x, y), "{side}");
        }
    }
    // The small change of direction finds the same points from both ends
    let (to_light, _) = counted(&cpu, &scene, "bvh-stack:shadows=to-light", Config::PS, SIZE);
    let same = to_light.iter().zip(&plain).filter(|(a, b)| a.pixel == b.pixel).count();
    assert!(same * 100 > plain.len() * 98, "only {same} of {} pixels agree", plain.len());
}

/// `--checked` compiles other code, which must find the same.
#[test]
fn checked_kernels_make_the_same_picture() {
    let (Some(gpu), Some(checked)) = (gpu(), crate::support::own_gpu(true)) else { return };
    let scene = shiny(soup(300, 14, false));
    for name in ["grid", "kdtree", "bvh", "bvh-stack"] {
        let (plain, _) = counted(gpu, &scene, name, Config::PSR, SIZE);
        let (checked, _) = counted(&checked, &scene, name, Config::PSR, SIZE);
        assert_equal(gpu.info(), name, &plain, &checked);
    }
}

/// The comparisons above can fail, and are less strict for devices that are not exact, but not blind.
#[test]
fn comparisons_see_what_is_wrong() {
    let exact = CpuBackend::new(1).unwrap().info().clone();
    let inexact = DeviceInfo { device_type: DeviceType::DiscreteGpu, ..exact.clone() };
    let rays = rays(100, 1);
    let expected: Vec<Hit> = (0..rays.len()).map(|i| Hit { t: 1.0 + i as f32, triangle: i as u32 }).collect();
    let with = |wrong: usize, change: fn(&mut Hit)| {
        let mut found = expected.clone();
        found[..wrong].iter_mut().for_each(change);
        found
    };
    let passes = |device: &DeviceInfo, found: &[Hit]| {
        let compare = || assert_same(device, "a test", &rays, &expected, found);
        std::panic::catch_unwind(std::panic::AssertUnwindSafe(compare)).is_ok()
    };
    let other: fn(&mut Hit) = |hit| hit.triangle += 1;
    let last_digit: fn(&mut Hit) = |hit| hit.t = hit.t.next_up();
    assert!(passes(&exact, &expected) && !passes(&exact, &with(1, other)) && !passes(&exact, &with(1, last_digit)));
    assert!(passes(&inexact, &with(rays.len(), last_digit)) && passes(&inexact, &with(2, other)));
    assert!(!passes(&inexact, &with(10, other)) && !passes(&inexact, &with(10, |hit| hit.t *= 1.01)));
}

/// A device that is gone is an error, not a panic, and a new one works.
#[test]
fn a_lost_device_is_an_error() {
    let Some(gpu) = crate::support::own_gpu(false) else { return };
    let scene = soup(50, 15, false);
    let selection = Selection::parse("bvh-stack").unwrap();
    let built = selection.build(&scene, 1).unwrap();
    let mut prepared = gpu.prepare(&scene, &*built.structure, selection.method()).unwrap();
    prepared.image(Config::P, &view(1), SIZE).unwrap();
    gpu.destroy();
    let lost = |error: rtbench::Error| assert!(matches!(error, rtbench::Error::DeviceLost(_)), "{error:?}");
    lost(prepared.image(Config::P, &view(1), SIZE).unwrap_err());
    lost(prepared.time_path(Config::P, &[view(1)], SIZE, &|| false).unwrap_err());
    lost(prepared.counted(Config::P, &view(1), SIZE, &mut |_, _| ()).unwrap_err());
    drop(prepared);
    let again = crate::support::own_gpu(false).expect("the device opens again");
    again.prepare(&scene, &*built.structure, selection.method()).unwrap().image(Config::P, &view(1), SIZE).unwrap();
}

/// The clock: as many times as frames, device times where there are timestamps, and an interrupt is noticed.
#[test]
fn paths_are_timed_frame_by_frame() {
    let scene = soup(50, 16, false);
    let selection = Selection::parse("bvh-stack").unwrap();
    let built = selection.build(&scene, 1).unwrap();
    let cpu = CpuBackend::new(1).unwrap();
    let backends = [Some(&cpu as &dyn Backend), gpu().map(|gpu| gpu as &dyn Backend)];
    for backend in backends.into_iter().flatten() {
        let mut prepared = backend.prepare(&scene, &*built.structure, selection.method()).unwrap();
        let times = prepared.time_path(Config::P, &vec![view(1); 5], SIZE, &|| false).unwrap();
        assert_eq!(times.len(), 5);
        assert!(times.iter().all(|t| t.wall_ns > 0));
        let stamped = backend.info().timestamp_period_ns.is_some();
        assert!(times.iter().all(|t| t.device_ns.is_some_and(|ns| ns > 0) == stamped), "{times:?}");
        let interrupted = prepared.time_path(Config::P, &vec![view(1); 5], SIZE, &|| true).unwrap_err();
        assert!(matches!(interrupted, rtbench::Error::Interrupted));
    }
}
