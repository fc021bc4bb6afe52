//! Spheres on a Vulkan device: the reference's bits for every kernel, its work, and what is wrong is found.

use crate::support::gpu;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use rtbench::device::{Feature, VulkanDevice};
use rtbench::workloads::size::Size;
use rtbench::workloads::spheres::gpu::kernels::{Kernel, MAX_UNIFORM_SPHERES};
use rtbench::workloads::spheres::gpu::{Counted, GpuRenderer, kernels};
use rtbench::workloads::spheres::options::{Algorithm, HitRecord, Options, Precision};
use rtbench::workloads::spheres::render::compare::{compare, rmse};
use rtbench::workloads::spheres::render::{half, reference};
use rtbench::workloads::spheres::scene::Scene;
use rtbench::workloads::spheres::verify::{self, Exactness};
use rtbench::workloads::spheres::view::View;
use rtbench::workloads::spheres::work;

const ALGORITHMS: [Algorithm; 2] = [Algorithm::TwoPass, Algorithm::OnePass];

fn options(algorithm: Algorithm, exit_on_miss: bool) -> Options {
    let hit = HitRecord::Index;
    Options { algorithm, exit_on_miss, skip_no_hit: false, skip_no_discriminant: false, hit }
}

/// The first pixel whose number of searches does not follow from its live hits: up to its first miss, or all trips.
fn wrong_searches(searches: &[u32], hits: &[u32], trips: u32, exits: bool) -> Option<usize> {
    assert_eq!(searches.len(), hits.len());
    let expected = |hits: u32| if exits { trips.min(hits + 1) } else { trips };
    searches.iter().zip(hits).position(|(&searches, &hits)| searches != expected(hits))
}

/// Compares all four kernels with the reference, timed and counting, in one frame of three.
fn check(gpu: &VulkanDevice, scene: &Scene, (width, height): (u32, u32), trips: u32) {
    let size = Size { width, height };
    let view = View::of(scene, size, trips, 1, 3);
    let spheres = scene.packed();
    for algorithm in ALGORITHMS {
        let expected = reference::render(&spheres, &view, algorithm);
        for exits in [false, true] {
            let renderer = GpuRenderer::new(gpu, &spheres, options(algorithm, exits), size, trips).unwrap();
            let what = format!("{} {width}x{height} {algorithm:?} {exits}", scene.name);
            let image = renderer.render(&view).unwrap();
            let Counted { image: counted, hits, searches } = renderer.count(&view).unwrap();
            assert_eq!(wrong_searches(&searches, &hits, trips, exits), None, "{what}");
            if gpu.info().agrees_with_twins() {
                assert_eq!(hits, expected.hits, "{what}");
                assert_eq!(compare(&counted, &image, width as usize), None, "{what}");
                assert_eq!(compare(&image, &expected.image, width as usize), None, "{what}");
            } else {
                // A compiler that contracts does so in each kernel as it likes
                let checks = [
                    verify::hits(&hits, &expected.hits, size, 1, Exactness::Levels),
                    verify::picture(&image, &expected.image, size, 1, Exactness::Levels),
                    verify::picture(&counted, &expected.image, size, 1, Exactness::Levels),
                ];
                checks.iter().for_each(|check| assert!(check.ok, "{what}: {}", check.message));
            }
        }
    }
}

#[test]
fn every_kernel_makes_the_bits_of_the_reference() {
    let Some(gpu) = gpu() else { return };
    for name in ["default", "random20", "random100"] {
        let scene = Scene::load(name).unwrap();
        for size in [(1, 1), (7, 5), (509, 3), (64, 36)] {
            check(gpu, &scene, size, 5);
        }
        check(gpu, &scene, (17, 9), 1);
        check(gpu, &scene, (17, 9), 64);
    }
}

/// More pixels than work-groups of one dispatch: the image has several parts.
#[test]
fn wide_images_have_several_parts() {
    let Some(gpu) = gpu() else { return };
    let width = gpu.max_groups().min(65_535) * 8 + 100;
    check(gpu, &Scene::load("default").unwrap(), (width, 1), 2);
}

#[test]
fn many_spheres_are_in_a_storage_buffer() {
    let Some(gpu) = gpu() else { return };
    let room = u64::from(MAX_UNIFORM_SPHERES).min(gpu.max_uniform_binding() / 32);
    for spheres in [room, room + 1, 3000] {
        let scene = Scene::load(&format!("random:spheres={spheres},seed=3")).unwrap();
        check(gpu, &scene, (32, 18), 3);
        let size = Size { width: 8, height: 8 };
        let renderer = GpuRenderer::new(gpu, &scene.packed(), options(Algorithm::OnePass, true), size, 3).unwrap();
        let uploaded = if spheres <= room { room } else { spheres };
        assert_eq!(renderer.allocated(), 32 * uploaded + 64 * 16);
    }
}

#[test]
fn one_wrong_sphere_is_found_and_the_pixel_is_named() {
    let Some(gpu) = gpu() else { return };
    let scene = Scene::load("random100").unwrap();
    let size = Size { width: 64, height: 36 };
    let view = View::of(&scene, size, 5, 0, 1);
    let right = reference::render(&scene.packed(), &view, Algorithm::OnePass).image;
    let mut found = 0;
    for wrong in (0..100).step_by(9) {
        let mut spheres = scene.packed();
        spheres[wrong].radius2 *= 1.01;
        let expected = reference::render(&spheres, &view, Algorithm::OnePass).image;
        let renderer = GpuRenderer::new(gpu, &spheres, options(Algorithm::OnePass, true), size, 5).unwrap();
        let image = renderer.render(&view).unwrap();
        let place = |difference: Option<rtbench::workloads::spheres::render::compare::FirstDifference>| {
            difference.map(|difference| (difference.x, difference.y, difference.count))
        };
        let (named, expected) = (place(compare(&image, &right, 64)), place(compare(&expected, &right, 64)));
        if gpu.info().agrees_with_twins() {
            assert_eq!(named, expected, "sphere {wrong}");
        }
        found += usize::from(named.is_some());
    }
    assert!(found >= 6, "{found} of 12 spheres are visible");
}

/// The device counts its searches, and a number that is not the reference's is found.
#[test]
fn searches_are_those_of_the_paths() {
    let Some(gpu) = gpu() else { return };
    let scene = Scene::load("random20").unwrap();
    let (size, trips) = (Size { width: 64, height: 36 }, 5);
    let (view, spheres) = (View::of(&scene, size, trips, 0, 1), scene.packed());
    let pixels = size.pixels() as u64;
    for algorithm in ALGORITHMS {
        let count = |exits| {
            let renderer = GpuRenderer::new(gpu, &spheres, options(algorithm, exits), size, trips).unwrap();
            renderer.count(&view).unwrap()
        };
        let Counted { hits, searches: ending, .. } = count(true);
        let Counted { hits: hits_of_all, searches: all, .. } = count(false);
        assert_eq!(wrong_searches(&ending, &hits, trips, true), None);
        assert_eq!(wrong_searches(&all, &hits_of_all, trips, false), None);
        // Each is wrong where the other one is right, and so is one search more or less in the last pixel
        assert!(wrong_searches(&ending, &hits, trips, false).is_some());
        assert!(wrong_searches(&all, &hits_of_all, trips, true).is_some());
        for wrong in [ending[ending.len() - 1] + 1, ending[ending.len() - 1] - 1] {
            let mut searches = ending.clone();
            *searches.last_mut().unwrap() = wrong;
            assert_eq!(wrong_searches(&searches, &hits, trips, true), Some(hits.len() - 1));
        }
        // The sums of a row are those of the counts
        let (on, off) = (work::of_pixels(&hits, &ending, trips, true), work::of_pixels(&hits, &all, trips, false));
        assert_eq!((off.searches, off.exits_on_miss), (pixels * u64::from(trips), 0));
        assert_eq!(on.searches, on.rays.iter().sum::<u64>(), "no search is wasted");
        assert_eq!(on.exits_on_miss, pixels - on.rays[trips as usize - 1]);
        assert!(on.exits_on_miss > 0 && on.searches < off.searches);
        let one_more: Vec<u32> = ending.iter().map(|searches| searches + 1).collect();
        assert_eq!(work::of_pixels(&hits, &one_more, trips, true).searches, on.searches + pixels);
        if gpu.info().agrees_with_twins() {
            let expected = reference::render(&spheres, &view, algorithm);
            assert_eq!(wrong_searches(&ending, &expected.hits, trips, true), None);
            assert_eq!((&on.rays, &on.hits), (&expected.counts.rays, &expected.counts.hits));
        }
    }
}

#[test]
fn frames_are_timed_and_the_last_one_stays() {
    let Some(gpu) = gpu() else { return };
    let scene = Scene::load("default").unwrap();
    let size = Size { width: 40, height: 22 };
    let views: Vec<View> = (0..5).map(|frame| View::of(&scene, size, 5, frame, 5)).collect();
    let renderer = GpuRenderer::new(gpu, &scene.packed(), options(Algorithm::OnePass, true), size, 5).unwrap();
    let times = renderer.time(&views, &|| false).unwrap();
    assert_eq!(times.len(), 5);
    assert!(times.iter().all(|time| time.wall_ns > 0 && time.stages.len() <= 1));
    let last = renderer.last().unwrap();
    assert_eq!(compare(&last, &renderer.render(&views[4]).unwrap(), 40), None);
    assert!(compare(&last, &renderer.render(&views[3]).unwrap(), 40).is_some());
    assert!(renderer.time(&[], &|| false).unwrap().is_empty());
    // No frame was rendered: the image is what it was filled with
    assert!(renderer.last().unwrap().iter().flatten().all(|x| x.to_bits() == rtbench::device::POISON));
    let stopped = renderer.time(&views, &|| true).unwrap_err();
    assert!(matches!(stopped, rtbench::Error::Interrupted), "{stopped}");
    assert_eq!(renderer.kernel().hash.len(), 16);
}

#[test]
fn images_that_a_device_cannot_bind_are_refused() {
    let Some(gpu) = gpu() else { return };
    let size = Size { width: 1 << 20, height: 1 << 20 };
    let spheres = Scene::load("default").unwrap().packed();
    let error = GpuRenderer::new(gpu, &spheres, options(Algorithm::OnePass, true), size, 5).err().unwrap();
    assert!(error.to_string().starts_with("too large: the image: 16777216 MiB are needed"), "{error}");
}

/// The module of a kernel.
fn module(kernel: &Kernel) -> naga::Module {
    naga::front::wgsl::parse_str(&kernel.assemble().unwrap().text).unwrap()
}

#[test]
fn every_kernel_is_valid_and_has_its_own_text() {
    let all = kernels().unwrap();
    assert_eq!(all.len(), 20);
    for (name, source) in &all {
        let module = naga::front::wgsl::parse_str(&source.text).unwrap_or_else(|error| panic!("{name}: {error}"));
        Validator::new(ValidationFlags::all(), Capabilities::SHADER_FLOAT16).validate(&module).unwrap();
        assert!(!source.text.contains("dot("), "{name}: the order of its sum is the driver's choice");
        assert_eq!(all.iter().filter(|(_, other)| other.hash() == source.hash()).count(), 1, "{name}");
    }
    let kernel = Kernel {
        algorithm: Algorithm::OnePass,
        exit_on_miss: true,
        trips: 5,
        uniform_spheres: Some(2048),
        precision: Precision::F32,
        counting: false,
    };
    let other = Kernel { uniform_spheres: Some(512), ..kernel };
    assert_ne!(kernel.assemble().unwrap().text, other.assemble().unwrap().text);
    assert_eq!(kernel.assemble().unwrap().hash(), other.assemble().unwrap().hash(), "a limit of the machine");
}

/// Size and members with their offsets.
fn layout(module: &naga::Module, name: &str) -> (u32, Vec<(String, u32)>) {
    let (_, found) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).unwrap();
    let naga::TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no struct") };
    (*span, members.iter().map(|member| (member.name.clone().unwrap(), member.offset)).collect())
}

macro_rules! same_layout {
    ($module:expr, $wgsl:literal, $rust:ty, [$($field:ident),* $(,)?]) => {
        let rust = [$((stringify!($field).to_owned(), std::mem::offset_of!($rust, $field) as u32)),*];
        assert_eq!(layout($module, $wgsl), (size_of::<$rust>() as u32, rust.to_vec()), $wgsl);
    };
}

#[test]
fn struct_layouts_agree() {
    use rtbench::workloads::spheres::{
        gpu::{BandUniform, HalfSphere},
        scene::PackedSphere,
    };
    for uniform_spheres in [None, Some(2048)] {
        let algorithm = Algorithm::TwoPass;
        let module = &module(&Kernel {
            algorithm,
            exit_on_miss: false,
            trips: 5,
            uniform_spheres,
            precision: Precision::F32,
            counting: true,
        });
        same_layout!(
            module,
            "View",
            View,
            [
                origin,
                epsilon,
                corner,
                intensity,
                right,
                half,
                down,
                one,
                light,
                two,
                light_color,
                far,
                ambient,
                spheres,
                width,
                height,
                trips,
                pad
            ]
        );
        same_layout!(module, "Band", BandUniform, [view, first_column, first_row, columns, rows]);
        same_layout!(module, "Sphere", PackedSphere, [center, radius2, color, pad]);
        let kernel = Kernel {
            algorithm,
            exit_on_miss: true,
            trips: 5,
            uniform_spheres,
            precision: Precision::F16,
            counting: true,
        };
        same_layout!(&self::module(&kernel), "Sphere", HalfSphere, [center, radius2, color, pad]);
    }
}

#[test]
fn half_precision_is_rendered_where_the_device_has_it() {
    let Some(gpu) = gpu() else { return };
    let size = Size { width: 48, height: 27 };
    for name in ["default", "random20"] {
        let scene = Scene::load(name).unwrap();
        let (view, spheres) = (View::of(&scene, size, 5, 0, 1), scene.packed());
        for algorithm in ALGORITHMS {
            let renderer = GpuRenderer::in_precision(Precision::F16, gpu, &spheres, options(algorithm, true), size, 5);
            if !gpu.features().has(Feature::Half) {
                let error = renderer.err().unwrap().to_string();
                assert_eq!(error, "unsupported: half precision, which this device has not");
                continue;
            }
            let image = renderer.unwrap().render(&view).unwrap();
            let emulated = half::render(&spheres, &view, algorithm);
            let single = reference::render(&spheres, &view, algorithm).image;
            let (own, other) = (rmse(&image, &emulated), rmse(&image, &single));
            eprintln!("{name} {algorithm:?}: {own} from the emulated picture, {other} from single precision");
            assert!(own <= 0.05 && other > 0.001, "{own} {other}");
        }
    }
}
