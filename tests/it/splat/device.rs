//! Frames on a Vulkan device: the twins' bits in everything that a frame makes, limits, times.

use super::frames::*;
use crate::support::{file_below, gpu, soup};
use glam::{Vec3, Vec4};
use rtbench::camera::Camera;
use rtbench::device::{CpuDevice, POISON, VulkanDevice};
use rtbench::scene::{self, Scene};
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::clusters::setting::ClusterSetting;
use rtbench::workloads::splat::gpu::{GpuFrame, stages};
use rtbench::workloads::splat::lit::{LitScene, PointLight};
use rtbench::workloads::splat::setting::{Energy, Estimate, EstimateKernel, Falloff, Setting, Weight};
use rtbench::workloads::splat::splatting::setting::Gather;
use rtbench::workloads::splat::{CpuFrame, Stages};
use rtbench::workloads::trace::Selection;
use rtbench::workloads::trace::backend::Backend;

const SIZE: Size = Size { width: 33, height: 31 };

/// Never.
const ON: &dyn Fn() -> bool = &|| false;

/// A frame by both devices; panics at the first difference. A GPU contracts and approximates as it likes: there the
/// counts of paths must be close.
fn check(
    gpu: &VulkanDevice,
    cpu: &CpuDevice,
    lit: &LitScene,
    structure: &str,
    (setting, estimate, size): (Setting, Estimate, Size),
    camera: &Camera,
) -> Stages {
    let what = format!("{} {structure} {setting:?} {estimate:?} {size:?}", lit.scene.name);
    let expected = on_cpu(cpu, lit, structure, (setting, estimate, size), camera);
    let found = on_gpu(gpu, lit, structure, (setting, estimate, size), camera);
    if gpu.info().agrees_with_twins() {
        assert_eq!(difference(&found, &expected), None, "{what}");
    } else {
        for (found, expected) in found.traced.arrived.iter().zip(&expected.traced.arrived) {
            assert!(found.abs_diff(*expected) <= setting.paths / 50 + 1, "{what}: {found} paths instead of {expected}");
        }
    }
    expected
}

fn two_lights(scene: &Scene) -> Vec<PointLight> {
    vec![
        light_at(scene, [0.45, 0.6, 0.55], Vec3::new(5.0, 4.0, 3.0)),
        light_at(scene, [0.7, 0.8, 0.3], Vec3::new(0.5, 1.0, 2.0)),
    ]
}

#[test]
fn every_structure_makes_the_bits_of_the_twins() {
    let Some(gpu) = gpu() else { return };
    let cpu = CpuDevice::new(2).unwrap();
    for scene in [scene::load("room:triangles=20000").unwrap(), soup(300, 5, false), closed_box()] {
        let camera = camera_of(&scene);
        let lit = lit(scene.clone(), &two_lights(&scene));
        let estimate = estimate(&lit, 0.1);
        let mut photons = Vec::new();
        for structure in ["bvh", "bvh-stack", "kdtree", "grid", "bih"] {
            let stages = check(gpu, &cpu, &lit, structure, (SETTING, estimate, SIZE), &camera);
            photons.push(stages.photons);
        }
        assert!(!photons[0].is_empty(), "{}", lit.scene.name);
        assert!(photons.iter().all(|other| other == &photons[0]), "{}: a structure changes photons", lit.scene.name);
    }
}

#[test]
fn every_setting_makes_the_bits_of_the_twins() {
    let Some(gpu) = gpu() else { return };
    let cpu = CpuDevice::new(2).unwrap();
    let mut settings = Vec::new();
    for hits in [2, 3, 16] {
        settings.push(Setting { hits, paths: 333, ..SETTING });
    }
    settings.push(Setting { paths: 1, ..SETTING });
    settings.push(Setting { paths: 64, hits: 2, ..SETTING });
    settings.push(Setting { seed: u32::MAX, ..SETTING });
    settings.push(Setting { energy: Energy::Shared, ..SETTING });
    settings.push(Setting { falloff: Falloff::Source, ..SETTING });
    settings.push(Setting { falloff: Falloff::Source, energy: Energy::Shared, hits: 16, ..SETTING });
    for scene in [scene::load("room:triangles=20000").unwrap(), closed_box()] {
        let camera = camera_of(&scene);
        let lights = two_lights(&scene);
        let (one, two) = (lit(scene.clone(), &lights[..1]), lit(scene, &lights));
        for &setting in &settings {
            check(gpu, &cpu, &one, "bvh", (setting, estimate(&one, 0.1), SIZE), &camera);
            if setting.paths > 1 {
                check(gpu, &cpu, &two, "bvh", (setting, estimate(&two, 0.1), SIZE), &camera);
            }
        }
        let default = estimate(&two, 0.15);
        for kernel in [EstimateKernel::Epanechnikov, EstimateKernel::Constant] {
            for weight in [Weight::Side, Weight::Cosine] {
                let estimate = Estimate { kernel, weight, ..default };
                let stages = check(gpu, &cpu, &two, "bvh", (SETTING, estimate, SIZE), &camera);
                assert!(stages.irradiance.iter().any(|irradiance| irradiance.y > 0.0));
            }
        }
        for (width, height) in [(1, 1), (67, 45), (1, 130), (64, 1)] {
            check(gpu, &cpu, &two, "bvh-stack", (SETTING, default, Size { width, height }), &camera);
        }
        // Flux that falls below the smallest normal float after some hits, and a light in the eye
        let faint = PointLight { flux: Vec3::new(1e-34, 1e-36, 1e-30), ..lights[0] };
        let in_the_eye = PointLight { position: camera.position, flux: Vec3::ONE };
        let strange = lit(two.scene.as_ref().clone(), &[faint, in_the_eye]);
        check(gpu, &cpu, &strange, "bvh", (Setting { hits: 16, ..SETTING }, default, SIZE), &camera);
    }
}

#[test]
fn sponza_makes_the_bits_of_the_twins() {
    let Some(gpu) = gpu() else { return };
    let Some(file) = file_below("RTBENCH_SCENES", "sponza/sponza.obj") else { return };
    let cpu = CpuDevice::new(2).unwrap();
    let scene = scene::load(file.to_str().unwrap()).unwrap();
    let bounds = scene.bounds();
    let camera = Camera { position: bounds.center(), direction: Vec3::X, up: Vec3::Y, field_of_view: 60.0 };
    let lights = two_lights(&scene);
    let lit = lit(scene, &lights);
    let size = Size { width: 67, height: 45 };
    for structure in ["bvh", "bih"] {
        let setting = Setting { paths: 3000, ..SETTING };
        let stages = check(gpu, &cpu, &lit, structure, (setting, estimate(&lit, 0.05), size), &camera);
        assert!(stages.irradiance.iter().filter(|irradiance| irradiance.y > 0.0).count() > 1000);
    }
}

/// Work-groups of another size trace the same photons, and neither the order of frames nor the light's strength changes
/// what they should not.
#[test]
fn groups_and_the_order_of_frames_change_no_bit() {
    let Some(gpu) = gpu() else { return };
    let scene = scene::load("room:triangles=20000").unwrap();
    let camera = camera_of(&scene);
    let lights = two_lights(&scene);
    let lit = lit(scene, &lights);
    let job = (SETTING, estimate(&lit, 0.1), SIZE);
    let first = on_gpu(gpu, &lit, "bvh-stack", job, &camera);
    for structure in ["bvh-stack:group=64x1", "bvh-stack:group=16x16", "bvh:packet=4x4", "bvh", "grid-packet"] {
        let other = on_gpu(gpu, &lit, structure, job, &camera);
        assert_eq!(difference(&first, &other), None, "{structure}");
    }
    let selection = Selection::parse("bvh").unwrap();
    let built = selection.build(&lit.scene, 1).unwrap();
    let mut frame = GpuFrame::new(gpu, &lit, &*built.structure, selection.method(), SETTING, job.1, SIZE).unwrap();
    let turned = Camera { direction: (camera.direction + Vec3::new(0.1, 0.05, 0.2)).normalize(), ..camera };
    let (a, b) = (frame.render(&camera, ON).unwrap(), frame.render(&turned, ON).unwrap());
    assert_eq!(difference(&frame.render(&camera, ON).unwrap(), &a), None, "B A");
    assert_eq!(difference(&first, &a), None);
    assert!(difference(&a, &b).is_some());
    assert_eq!(difference_of_photons("photons", &a.photons, &b.photons), None);
    // Timed, in one submission, without anything read in between
    for (cameras, last) in [(vec![camera, turned], &b), (vec![turned, camera], &a), (vec![camera; 3], &a)] {
        let times = frame.time(&cameras, &|| false).unwrap();
        assert_eq!(times.len(), cameras.len());
        assert!(times.iter().all(|time| time.stages.is_empty()
            || time.stages.len() == stages(SETTING, Gather::Reference, &ClusterSetting::default()).len()));
        assert_eq!(frame.last().unwrap(), last.picture);
        assert_eq!(frame.photons().unwrap(), last.photons.len());
        assert_eq!(frame.arrived().unwrap(), last.traced.arrived);
    }
    assert!(frame.time(&[], &|| false).unwrap().is_empty());
    assert!(frame.last().unwrap().iter().all(|pixel| pixel.x.to_bits() == POISON), "no frame was rendered");
    assert!(matches!(frame.time(&[camera], &|| true), Err(rtbench::Error::Interrupted)));
    // Interrupted at every place where it asks
    for most in 0.. {
        let asked = std::cell::Cell::new(0);
        let later = || asked.replace(asked.get() + 1) >= most;
        match frame.render(&camera, &later) {
            Ok(stages) => {
                assert_eq!(difference(&first, &stages), None);
                assert!(most > 12, "it asks {most} times only");
                break;
            }
            Err(error) => assert!(matches!(error, rtbench::Error::Interrupted), "{error}"),
        }
    }
    assert_eq!(
        stages(SETTING, Gather::Reference, &ClusterSetting::default()),
        ["hit-1", "hit-2", "hit-3", "hit-4", "compaction", "samples", "direct", "estimate", "mix"]
    );
    let kernels = frame.kernels();
    assert!(kernels.len() >= 12 && kernels.iter().all(|kernel| kernel.hash.len() == 16), "{kernels:?}");
    let total: u64 = frame.buffers().iter().map(|(_, bytes)| bytes).sum();
    assert!(total > 2100 * 96 + 33 * 31 * 160, "{:?}", frame.buffers());
    // Twice the light
    let twice: Vec<PointLight> = lights.iter().map(|light| PointLight { flux: light.flux * 2.0, ..*light }).collect();
    let twice = on_gpu(gpu, &super::frames::lit(lit.scene.as_ref().clone(), &twice), "bvh", job, &camera);
    for (once, twice) in first.irradiance.iter().zip(&twice.irradiance) {
        assert_eq!((*once * 2.0).to_array().map(f32::to_bits), twice.to_array().map(f32::to_bits));
    }
    // Another seed
    let other = on_gpu(gpu, &lit, "bvh", (Setting { seed: 2, ..SETTING }, job.1, SIZE), &camera);
    assert!(difference_of_photons("photons", &first.photons, &other.photons).is_some());
}

#[test]
fn more_slots_than_photons_can_have_are_refused() {
    let scene = closed_box();
    let light = light_at(&scene, [0.4, 0.5, 0.6], Vec3::ONE);
    let lit = lit(scene, &[light]);
    let selection = Selection::parse("bvh").unwrap();
    let built = selection.build(&lit.scene, 1).unwrap();
    let setting = Setting { paths: (1 << 23) + 1, hits: 2, ..SETTING };
    let estimate = estimate(&lit, 0.1);
    let is_refusal = |error: rtbench::Error| {
        let text = error.to_string();
        assert!(matches!(error, rtbench::Error::Refused(_)), "{text}");
        assert!(text.contains("8388609") && text.contains("8388608") && text.contains("--paths"), "{text}");
    };
    let cpu = CpuDevice::new(2).unwrap();
    let caster = cpu.prepare(&lit.scene, &*built.structure, selection.method()).unwrap();
    is_refusal(CpuFrame::new(&cpu, caster, &lit, setting, estimate, SIZE).trace(ON).unwrap_err());
    let Some(gpu) = gpu() else { return };
    let frame =
        |setting, size| GpuFrame::new(gpu, &lit, &*built.structure, selection.method(), setting, estimate, size);
    is_refusal(frame(setting, SIZE).err().unwrap());
    is_refusal(frame(Setting { paths: 8_388_609, hits: 2, ..SETTING }, SIZE).err().unwrap());
    let size = Size { width: 1 << 15, height: 1 << 15 };
    if gpu.max_binding() < 32 << 30 {
        let text = frame(SETTING, size).err().unwrap().to_string();
        assert!(text.contains("the rays of the camera: 32768 MiB are needed"), "{text}");
    }
    // A scene with more lights than paths
    let many = super::frames::lit(lit.scene.as_ref().clone(), &[light; 5]);
    let few = Setting { paths: 4, ..SETTING };
    let error = GpuFrame::new(gpu, &many, &*built.structure, selection.method(), few, estimate, SIZE).err().unwrap();
    assert!(error.to_string().contains("5 lights"), "{error}");
}

/// As many slots as there can be: more work-groups than fit a row, on some devices more rays than fit a binding, and an
/// estimate of several dispatches. Most slots are empty.
#[test]
fn the_most_slots_run() {
    let Some(gpu) = gpu() else { return };
    let floor = [(-5.0, -5.0), (-5.0, 5.0), (5.0, 5.0), (5.0, -5.0)].map(|(x, z)| Vec3::new(x, 0.0, z));
    let wall = [(0.0, 0.5), (0.6, 0.5), (0.6, -0.5), (0.0, -0.5)].map(|(y, z)| Vec3::new(-0.7, y, z));
    let scene = quads(&[(floor, Vec3::new(0.9, 0.6, 0.3)), (wall, Vec3::splat(0.5))]);
    let camera = Camera {
        position: Vec3::new(1.0, 1.0, 0.0),
        direction: Vec3::new(-0.9, -0.4, 0.1).normalize(),
        up: Vec3::Y,
        field_of_view: 70.0,
    };
    let lit = lit(scene, &[PointLight { position: Vec3::new(0.2, 0.8, 0.0), flux: Vec3::ONE }]);
    let setting = Setting { paths: 1 << 23, hits: 2, ..SETTING };
    let job = (setting, estimate(&lit, 0.02), Size { width: 53, height: 23 });
    let found = on_gpu(gpu, &lit, "bvh-stack", job, &camera);
    let photons = found.photons.len();
    assert!((10_000..1_000_000).contains(&photons), "{photons} photons");
    assert_eq!(found.traced.arrived[1] as usize, photons);
    assert!(found.irradiance.iter().filter(|irradiance| irradiance.x > 0.0).count() > 20);
    if gpu.info().agrees_with_twins() {
        let expected = on_cpu(&CpuDevice::new(2).unwrap(), &lit, "bvh-stack", job, &camera);
        assert_eq!(difference(&found, &expected), None);
    }
}

/// The comparison of these tests notices what a broken kernel would do.
#[test]
fn the_comparison_notices() {
    let scene = scene::load("room:triangles=20000").unwrap();
    let camera = camera_of(&scene);
    let lights = two_lights(&scene);
    let lit = lit(scene, &lights);
    let right = on_cpu(&CpuDevice::new(2).unwrap(), &lit, "bvh", (SETTING, estimate(&lit, 0.2), SIZE), &camera);
    assert_eq!(difference(&right, &right.clone()), None);
    type Change = fn(&mut Stages);
    let changes: [(&str, Change); 8] = [
        ("fluxes of photons", |stages| {
            let flux = stages.photons.fluxes.iter_mut().find(|flux| flux.x != flux.z).unwrap();
            *flux = Vec4::new(flux.z, flux.y, flux.x, flux.w);
        }),
        ("positions of photons", |stages| {
            let photon = stages.photons.positions.last_mut().unwrap();
            photon.y = f32::from_bits(photon.y.to_bits() + 1);
        }),
        ("positions of slots", |stages| stages.traced.slots.positions.rotate_right(1)),
        ("directions of slots", |stages| stages.traced.slots.directions[5].w = f32::from_bits(POISON)),
        ("arrived", |stages| stages.traced.arrived[3] += 1),
        ("normals", |stages| stages.samples.normals[0].w = -0.0),
        ("irradiance", |stages| stages.irradiance.swap(0, 500)),
        ("picture", |stages| stages.picture.truncate(7)),
    ];
    for (named, change) in changes {
        let mut wrong = right.clone();
        change(&mut wrong);
        let found = difference(&wrong, &right).unwrap_or_default();
        assert!(found.starts_with(named), "{named}: {found}");
    }
}
