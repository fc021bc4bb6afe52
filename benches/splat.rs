//! Photon splatting by the twins and on a Vulkan device: rays of paths per second, and tests of the reference estimate:
//! `cargo bench --bench splat`. Elements are rays or tests of photons against samples.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rtbench::camera::{Camera, CameraPath};
use rtbench::device::vulkan::{Selector, VulkanOptions, adapters, choose};
use rtbench::device::{CpuDevice, VulkanDevice};
use rtbench::scene;
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::CpuFrame;
use rtbench::workloads::splat::clusters::setting::ClusterSetting;
use rtbench::workloads::splat::gpu::{GpuFrame, stages};
use rtbench::workloads::splat::lit::{LitScene, PointLight};
use rtbench::workloads::splat::setting::{Energy, Estimate, EstimateKernel, Falloff, Setting, Weight};
use rtbench::workloads::splat::splatting::setting::Gather;
use rtbench::workloads::trace::Selection;
use rtbench::workloads::trace::backend::Backend;
use std::sync::Arc;

const SETTING: Setting = Setting { paths: 0, hits: 4, seed: 1, falloff: Falloff::Square, energy: Energy::Flux };

/// Nanoseconds of a stage, or of the whole frame on a device without timestamps.
fn nanoseconds(frame: &mut GpuFrame, camera: &Camera, stage: impl Fn(&str) -> bool, setting: Setting) -> u64 {
    let time = frame.time(std::slice::from_ref(camera), &|| false).expect("a frame").remove(0);
    if time.stages.is_empty() {
        return time.wall_ns;
    }
    let labels = stages(setting, Gather::Reference, &ClusterSetting::default());
    labels.iter().zip(&time.stages).filter(|(label, _)| stage(label)).map(|(_, ns)| ns).sum()
}

fn frames(criterion: &mut Criterion) {
    let scene = scene::load("room:triangles=20000").expect("a built-in scene");
    let camera = CameraPath::for_scene(&scene, false).views(&scene, Some(1)).expect("a view")[0].camera;
    let bounds = scene.bounds();
    let light = PointLight { position: bounds.center(), flux: glam::Vec3::ONE };
    let lit = LitScene { scene: Arc::new(scene), lights: vec![light], extent: bounds, warnings: Vec::new() };
    let estimate = Estimate {
        kernel: EstimateKernel::default(),
        weight: Weight::default(),
        form: Default::default(),
        radius: lit.diagonal() * 0.03,
    };
    let size = Size { width: 64, height: 36 };
    let selection = Selection::parse("bvh-stack").expect("a name of the table");
    let built = selection.build(&lit.scene, 0).expect("a structure");
    let cpu = CpuDevice::new(0).expect("threads");
    let gpu = choose(&adapters(), &Selector::Best).and_then(|best| VulkanDevice::open(best, VulkanOptions::default()));
    let gpu = gpu.inspect_err(|error| println!("the GPU is left out: {error}")).ok();

    let mut group = criterion.benchmark_group("splat paths");
    group.sample_size(10);
    for paths in [5_667, 100_000] {
        let setting = Setting { paths, ..SETTING };
        group.throughput(Throughput::Elements(u64::from(paths) * u64::from(setting.hits)));
        let caster = cpu.prepare(&lit.scene, &*built.structure, selection.method()).expect("a twin");
        let mut twin = CpuFrame::new(&cpu, caster, &lit, setting, estimate, size);
        group.bench_function(BenchmarkId::new("twin", paths), |bencher| {
            bencher.iter(|| twin.trace(&|| false).expect("paths"))
        });
        if let Some(gpu) = &gpu {
            let one = Size { width: 1, height: 1 };
            let mut frame =
                GpuFrame::new(gpu, &lit, &*built.structure, selection.method(), setting, estimate, one).expect("room");
            let is_hit = |stage: &str| stage.starts_with("hit-");
            group.bench_function(BenchmarkId::new("device", paths), |bencher| {
                bencher.iter_custom(|times| {
                    let times = 0..times;
                    std::time::Duration::from_nanos(
                        times.map(|_| nanoseconds(&mut frame, &camera, is_hit, setting)).sum(),
                    )
                });
            });
        }
    }
    group.finish();

    let mut group = criterion.benchmark_group("splat estimate");
    group.sample_size(10);
    for paths in [1_000, 5_667] {
        let setting = Setting { paths, ..SETTING };
        let caster = cpu.prepare(&lit.scene, &*built.structure, selection.method()).expect("a twin");
        let mut twin = CpuFrame::new(&cpu, caster, &lit, setting, estimate, size);
        let stages = twin.render(&camera, &|| false).expect("a frame");
        group.throughput(Throughput::Elements((stages.photons.len() * size.pixels()) as u64));
        group.bench_function(BenchmarkId::new("twin", stages.photons.len()), |bencher| {
            bencher.iter(|| twin.gather(&camera, &stages.samples, &stages.photons, &|| false).expect("an estimate"));
        });
        if let Some(gpu) = &gpu {
            let mut frame =
                GpuFrame::new(gpu, &lit, &*built.structure, selection.method(), setting, estimate, size).expect("room");
            group.bench_function(BenchmarkId::new("device", stages.photons.len()), |bencher| {
                bencher.iter_custom(|times| {
                    let times = 0..times;
                    let is_estimate = |stage: &str| stage == "estimate";
                    std::time::Duration::from_nanos(
                        times.map(|_| nanoseconds(&mut frame, &camera, is_estimate, setting)).sum(),
                    )
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, frames);
criterion_main!(benches);
