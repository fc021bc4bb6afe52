//! Clusters of view samples and photons on their way to them, by the twins and on a Vulkan device, stage by stage:
//! `cargo bench --bench splat_clusters`. Elements are samples for clusters, and pairs of photon and cluster afterwards.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rtbench::camera::{Camera, CameraPath};
use rtbench::device::vulkan::{Selector, VulkanOptions, adapters, choose};
use rtbench::device::{CpuDevice, VulkanDevice};
use rtbench::scene;
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::clusters::KeyLayout;
use rtbench::workloads::splat::clusters::setting::{BoundsBy, ClusterSetting, Unique};
use rtbench::workloads::splat::gathered::clustered;
use rtbench::workloads::splat::gathering::Gathering;
use rtbench::workloads::splat::gpu::{GpuFrame, stages};
use rtbench::workloads::splat::lit::{LitScene, PointLight};
use rtbench::workloads::splat::setting::{Energy, Estimate, EstimateKernel, Falloff, Setting, Weight};
use rtbench::workloads::splat::splatting::setting::{BucketSetting, Gather, Order, Tasks};
use rtbench::workloads::splat::{CpuFrame, Stages};
use rtbench::workloads::trace::backend::Backend;
use rtbench::workloads::trace::{Built, Selection};
use std::sync::Arc;
use std::time::Duration;

const SETTING: Setting = Setting { paths: 5_667, hits: 4, seed: 1, falloff: Falloff::Square, energy: Energy::Flux };

/// The tiles and slices of 1920x1080 in tiles of 32.
const SIZE: Size = Size { width: 480, height: 270 };

const PER_SAMPLE: Gather = Gather::PerSample { order: Order::Any, tasks: Tasks::Sample };
const BUCKETS: Gather = Gather::Buckets(BucketSetting::DEFAULT);

/// What all benchmarks look at.
struct View<'a> {
    lit: &'a LitScene,
    camera: Camera,
    selection: &'a Selection,
    built: &'a Built,
}

impl View<'_> {
    fn gathering(&self, gather: Gather, unique: Unique, bounds: BoundsBy) -> Gathering {
        let radius = self.lit.diagonal() * 0.05;
        let (kernel, weight) = (EstimateKernel::default(), Weight::default());
        let estimate = Estimate { kernel, weight, form: Default::default(), radius };
        let clusters = ClusterSetting { tile: 8, unique, bounds, ..ClusterSetting::default() };
        let depths = (self.lit.near(), self.lit.far());
        let layout = KeyLayout::new(&clusters, SIZE, self.camera.field_of_view, depths).expect("keys");
        Gathering { gather, clusters, layout: Some(layout), ..Gathering::from(estimate) }
    }

    fn frame<'d>(&'d self, gpu: &'d VulkanDevice, gathering: &Gathering) -> GpuFrame<'d> {
        let (structure, method) = (&*self.built.structure, self.selection.method());
        GpuFrame::new(gpu, self.lit, structure, method, SETTING, gathering.clone(), SIZE).expect("room")
    }
}

/// Nanoseconds of a stage; of the whole frame on a device without timestamps.
fn nanoseconds(frame: &mut GpuFrame, camera: &Camera, gathering: &Gathering, stage: &str) -> u64 {
    let time = frame.time(std::slice::from_ref(camera), &|| false).expect("a frame").remove(0);
    let labels = stages(SETTING, gathering.gather, &gathering.clusters);
    labels.iter().position(|label| *label == stage).and_then(|at| time.stages.get(at)).map_or(time.wall_ns, |ns| *ns)
}

fn measured(
    group: &mut criterion::BenchmarkGroup<criterion::measurement::WallTime>,
    name: BenchmarkId,
    frame: &mut GpuFrame,
    camera: &Camera,
    gathering: &Gathering,
    stage: &str,
) {
    group.bench_function(name, |bencher| {
        bencher.iter_custom(|times| {
            Duration::from_nanos((0..times).map(|_| nanoseconds(frame, camera, gathering, stage)).sum())
        });
    });
}

/// Clusters in every way.
fn clusters(criterion: &mut Criterion, view: &View, gpu: Option<&VulkanDevice>, cpu: &CpuDevice, seen: &Stages) {
    let mut group = criterion.benchmark_group("splat clusters");
    group.sample_size(10);
    group.throughput(Throughput::Elements(SIZE.pixels() as u64));
    let caster = cpu.prepare(&view.lit.scene, &*view.built.structure, view.selection.method()).expect("a twin");
    for (name, unique) in [("flags", Unique::Flags), ("sort", Unique::Sort), ("bits", Unique::Bits)] {
        let gathering = view.gathering(PER_SAMPLE, unique, BoundsBy::TwoStep);
        if let Some(gpu) = gpu {
            let mut frame = view.frame(gpu, &gathering);
            let id = BenchmarkId::new("device unique", name);
            measured(&mut group, id, &mut frame, &view.camera, &gathering, "unique");
        }
    }
    for (name, bounds) in [("direct", BoundsBy::Direct), ("two-step", BoundsBy::TwoStep)] {
        let gathering = view.gathering(PER_SAMPLE, Unique::Bits, bounds);
        if let Some(gpu) = gpu {
            let mut frame = view.frame(gpu, &gathering);
            let id = BenchmarkId::new("device bounds", name);
            measured(&mut group, id, &mut frame, &view.camera, &gathering, "bounds");
        }
    }
    let gathering = view.gathering(PER_SAMPLE, Unique::Bits, BoundsBy::TwoStep);
    let twin = CpuFrame::new(cpu, caster, view.lit, SETTING, gathering.clone(), SIZE);
    let scenery = twin.scenery(&view.camera, &seen.samples, &seen.photons);
    group.bench_function("twin", |bencher| {
        bencher.iter(|| clustered(cpu.pool(), &gathering, &scenery).expect("clusters"));
    });
    group.finish();
}

/// Photons into lists and buckets, and the estimates from both.
fn gathers(criterion: &mut Criterion, view: &View, gpu: Option<&VulkanDevice>, cpu: &CpuDevice, seen: &Stages) {
    let mut group = criterion.benchmark_group("splat photons");
    group.sample_size(10);
    for (name, gather, splats) in [("per-sample", PER_SAMPLE, "fill"), ("buckets", BUCKETS, "buckets")] {
        let gathering = view.gathering(gather, Unique::Bits, BoundsBy::TwoStep);
        let caster = cpu.prepare(&view.lit.scene, &*view.built.structure, view.selection.method()).expect("a twin");
        let twin = CpuFrame::new(cpu, caster, view.lit, SETTING, gathering.clone(), SIZE);
        group.throughput(Throughput::Elements(seen.photons.len() as u64));
        group.bench_function(BenchmarkId::new("twin", name), |bencher| {
            bencher.iter(|| twin.gather(&view.camera, &seen.samples, &seen.photons, &|| false).expect("an estimate"));
        });
        if let Some(gpu) = gpu {
            let mut frame = view.frame(gpu, &gathering);
            for stage in [splats, "estimate"] {
                let id = BenchmarkId::new(format!("device {stage}"), name);
                measured(&mut group, id, &mut frame, &view.camera, &gathering, stage);
            }
        }
    }
    group.finish();
}

fn all(criterion: &mut Criterion) {
    let scene = scene::load("room:triangles=20000").expect("a built-in scene");
    let camera = CameraPath::for_scene(&scene, false).views(&scene, Some(1)).expect("a view")[0].camera;
    let bounds = scene.bounds();
    let light = PointLight { position: bounds.center(), flux: glam::Vec3::ONE };
    let lit = LitScene { scene: Arc::new(scene), lights: vec![light], extent: bounds, warnings: Vec::new() };
    let selection = Selection::parse("bvh-stack").expect("a name of the table");
    let built = selection.build(&lit.scene, 0).expect("a structure");
    let cpu = CpuDevice::new(0).expect("threads");
    let gpu = choose(&adapters(), &Selector::Best).and_then(|best| VulkanDevice::open(best, VulkanOptions::default()));
    let gpu = gpu.inspect_err(|error| println!("the GPU is left out: {error}")).ok();
    let view = View { lit: &lit, camera, selection: &selection, built: &built };
    let gathering = view.gathering(BUCKETS, Unique::Bits, BoundsBy::TwoStep);
    let caster = cpu.prepare(&lit.scene, &*built.structure, selection.method()).expect("a twin");
    let seen = CpuFrame::new(&cpu, caster, &lit, SETTING, gathering, SIZE).render(&camera, &|| false).expect("a frame");
    clusters(criterion, &view, gpu.as_ref(), &cpu, &seen);
    gathers(criterion, &view, gpu.as_ref(), &cpu, &seen);
}

criterion_group!(benches, all);
criterion_main!(benches);
