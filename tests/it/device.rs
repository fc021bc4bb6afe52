//! Devices without a workload: frames of several passes and stages, indirect dispatch, buffers, textures, errors.

use crate::support::{gpu, own_gpu};
use rtbench::Error;
use rtbench::device::vulkan::{
    Binding, BindingKind, Bindings, Buffer, Dispatch, Groups, Pipeline, PipelineDescription, ReadBuffer, Resource,
    Texel,
};
use rtbench::device::{CpuDevice, Device, Frame, POISON, Pass, Stage, Submissions, VulkanDevice};
use std::cell::Cell;
use std::sync::Arc;

/// Writes how many groups the second kernel needs and the numbers that it works on.
const FILL: &str = "
@group(0) @binding(0) var<uniform> job: vec4<u32>; // first and number of elements
@group(0) @binding(1) var<storage, read_write> groups: array<u32, 3>;
@group(0) @binding(2) var<storage, read_write> numbers: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x == 0u) {
        groups[0] = 4096u / 64u;
        groups[1] = 1u;
        groups[2] = 1u;
    }
    if (id.x < job.y) {
        numbers[job.x + id.x] = job.x + id.x;
    }
}
";

/// Hashes each number a hundred times.
const WORK: &str = "
@group(0) @binding(0) var<storage, read> numbers: array<u32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    var x = numbers[id.x];
    for (var i = 0u; i < 100u; i += 1u) {
        x = x * 1664525u + 1013904223u;
    }
    results[id.x] = x;
}
";

const NUMBERS: u32 = 4096;
const FILL_STAGE: Stage = Stage("fill");
const WORK_STAGE: Stage = Stage("work");

fn expected() -> Vec<u32> {
    let hash = |x: u32| (0..100).fold(x, |x, _| x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    (0..NUMBERS).map(hash).collect()
}

fn pipeline(device: &VulkanDevice, label: &str, text: &str, kinds: &[BindingKind]) -> Arc<Pipeline> {
    let layout: Vec<Binding> = (0..).zip(kinds).map(|(number, &kind)| Binding::new(number, kind)).collect();
    let description =
        PipelineDescription { label, text, layout: &layout, checked: false, zero_workgroup_memory: false };
    device.pipeline(&description).unwrap()
}

/// Everything that frames of both kernels need on a device.
struct Job {
    fill: (Arc<Pipeline>, Bindings),
    work: (Arc<Pipeline>, Bindings),
    stride: u32,
    groups: Buffer,
    results: Buffer,
}

impl Job {
    fn new(device: &VulkanDevice) -> Job {
        let fill = pipeline(
            device,
            "fill",
            FILL,
            &[BindingKind::MovingUniform, BindingKind::ReadWrite, BindingKind::ReadWrite],
        );
        let work = pipeline(device, "work", WORK, &[BindingKind::Read, BindingKind::ReadWrite]);
        // Two halves, each a part of the first stage
        let stride = device.uniform_stride(16);
        let mut uniforms = vec![0u32; stride as usize / 2];
        uniforms[..2].copy_from_slice(&[0, NUMBERS / 2]);
        uniforms[stride as usize / 4..][..2].copy_from_slice(&[NUMBERS / 2, NUMBERS / 2]);
        let uniforms = device.uniform("the jobs", &uniforms).unwrap();
        let groups = device.zeroed("the groups", 12).unwrap();
        let numbers = device.zeroed("the numbers", u64::from(NUMBERS) * 4).unwrap();
        let results = device.poisoned("the results", u64::from(NUMBERS) * 4).unwrap();
        let window = Resource::Window(&uniforms, 16);
        let fill_bindings = device.bind(&fill, &[(0, window), (1, (&groups).into()), (2, (&numbers).into())]);
        let work_bindings = device.bind(&work, &[(0, (&numbers).into()), (1, (&results).into())]);
        device.check().unwrap();
        Job { fill: (fill, fill_bindings), work: (work, work_bindings), stride, groups, results }
    }

    fn frame(&self, submissions: Submissions) -> Frame<Dispatch<'_>> {
        let fill = |part: u32| {
            let (pipeline, bindings) = &self.fill;
            let groups = Groups::Fixed(NUMBERS / 2 / 64, 1, 1);
            Pass { stage: FILL_STAGE, work: Dispatch { pipeline, bindings, offset: Some(part * self.stride), groups } }
        };
        let (pipeline, bindings) = &self.work;
        let groups = Groups::Indirect { buffer: &self.groups, offset: 0 };
        let work = Pass { stage: WORK_STAGE, work: Dispatch { pipeline, bindings, offset: None, groups } };
        Frame { passes: vec![fill(0), fill(1), work], submissions }
    }
}

#[test]
fn a_frame_of_two_stages_runs_and_each_is_timed() {
    let Some(gpu) = gpu() else { return };
    for submissions in [Submissions::PerPass, Submissions::PerFrame] {
        let job = Job::new(gpu);
        assert_eq!(gpu.read::<u32>(&job.results, 2).unwrap(), [POISON; 2]);
        let frames = vec![job.frame(submissions); 3];
        assert_eq!(frames[0].stages(), [FILL_STAGE, WORK_STAGE]);
        let times = gpu.run_frames(&frames, &|| false).unwrap();
        assert_eq!(gpu.read::<u32>(&job.results, NUMBERS as usize).unwrap(), expected());
        assert_eq!(gpu.read::<u32>(&job.groups, 3).unwrap(), [NUMBERS / 64, 1, 1]);
        assert_eq!(times.len(), 3);
        for time in times {
            assert!(time.wall_ns > 0, "{time:?}");
            let Some(frame) = time.device_ns else {
                assert!(gpu.info().timestamp_period_ns.is_none() && time.stages.is_empty());
                continue;
            };
            assert_eq!(time.stages.len(), 2);
            assert!(time.stages.iter().all(|&ns| ns > 0) && time.stages.iter().sum::<u64>() <= frame, "{time:?}");
        }
    }
}

#[test]
fn many_frames_take_several_query_sets() {
    let Some(gpu) = gpu() else { return };
    let job = Job::new(gpu);
    let frames = vec![job.frame(Submissions::PerFrame); 1030];
    let times = gpu.run_frames(&frames, &|| false).unwrap();
    assert_eq!(times.len(), frames.len());
    if gpu.info().timestamp_period_ns.is_some() {
        assert!(times.iter().all(|time| time.stages.iter().all(|&ns| ns > 0)));
    }
}

#[test]
fn a_frame_is_interrupted_between_its_passes() {
    let Some(gpu) = gpu() else { return };
    let job = Job::new(gpu);
    let asked = Cell::new(0);
    let stop = || {
        asked.set(asked.get() + 1);
        asked.get() == 3
    };
    let result = gpu.run_frames(&[job.frame(Submissions::PerPass)], &stop);
    assert!(matches!(result, Err(Error::Interrupted)));
    // The third pass never ran
    assert_eq!(gpu.read::<u32>(&job.results, 1).unwrap(), [POISON]);
    assert_eq!(gpu.read::<u32>(&job.groups, 1).unwrap(), [NUMBERS / 64]);
}

#[test]
fn frames_without_an_end_to_time_are_refused() {
    let Some(gpu) = gpu() else { return };
    let job = Job::new(gpu);
    let empty = Frame::new(Vec::new());
    assert!(gpu.run_frames(&[empty], &|| false).unwrap_err().to_string().contains("no pass"));
    let frame = job.frame(Submissions::PerFrame);
    let passes = frame.passes.iter().rev().take(2).cycle().take(4098).copied().collect();
    let restless = Frame { passes, ..frame };
    let error = gpu.run_frames(&[restless], &|| false).unwrap_err();
    assert!(error.to_string().contains("changes its stage 4098 times"), "{error}");
}

/// Adds up the words of its input, which are read from buffers or from textures.
const SUM: &str = "
@group(0) @binding(1) var<storage, read_write> sum: array<atomic<u32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let words = fetch(id.x);
    atomicAdd(&sum[0], words.x + words.y);
    atomicAdd(&sum[1], words.y);
}
";

#[test]
fn buffers_and_textures_hold_the_same_words() {
    let Some(gpu) = gpu() else { return };
    // More than a row of a texture, and not a whole number of rows
    let pairs: Vec<[u32; 2]> = (0..6400).map(|i| [i, i * i]).collect();
    let contents: &[u8] = bytemuck::cast_slice(&pairs);
    let buffer = ReadBuffer::Buffer(gpu.storage("the words", &pairs).unwrap());
    let texture = ReadBuffer::Texture(gpu.texture("the words", contents, Texel::Bytes8).unwrap());
    let sums = [
        (buffer, "@group(0) @binding(0) var<storage, read> words: array<vec2<u32>>;", "words[i]"),
        (
            texture,
            "@group(0) @binding(0) var words: texture_storage_2d<rg32uint, read>;",
            "textureLoad(words, vec2<u32>(i % 4096u, i / 4096u)).xy",
        ),
    ]
    .map(|(input, declaration, read)| {
        let text = format!("{declaration}\nfn fetch(i: u32) -> vec2<u32> {{ return {read}; }}\n{SUM}");
        let kind = ReadBuffer::kind(matches!(input, ReadBuffer::Texture(_)), Texel::Bytes8);
        let pipeline = pipeline(gpu, "sum", &text, &[kind, BindingKind::ReadWrite]);
        let sum = gpu.zeroed("the sum", 8).unwrap();
        let bindings = gpu.bind(&pipeline, &[(0, (&input).into()), (1, (&sum).into())]);
        let groups = Groups::Fixed(100, 1, 1);
        let work = Dispatch { pipeline: &pipeline, bindings: &bindings, offset: None, groups };
        gpu.run(&Frame::new(vec![Pass { stage: Stage("sum"), work }])).unwrap();
        gpu.read::<u32>(&sum, 2).unwrap()
    });
    let second: u32 = pairs.iter().fold(0, |sum, pair| sum.wrapping_add(pair[1]));
    let first: u32 = pairs.iter().fold(second, |sum, pair| sum.wrapping_add(pair[0]));
    assert_eq!(sums, [vec![first, second], vec![first, second]]);
}

#[test]
fn what_does_not_fit_is_refused_with_a_hint() {
    let Some(gpu) = gpu() else { return };
    let error = gpu.poisoned("the image", u64::MAX / 2).err().unwrap().to_string();
    assert!(error.starts_with("too large: the image: ") && error.ends_with("(use a smaller input, or another device)"));
    let error = gpu.check_texture("the nodes", usize::MAX / 2, Texel::Bytes16, "use less").unwrap_err().to_string();
    assert!(error.starts_with("too large: the nodes: ") && error.ends_with("(use less)"), "{error}");
}

#[test]
fn a_wrong_kernel_is_an_error_and_the_device_stays_usable() {
    let Some(gpu) = own_gpu(false) else { return };
    let layout = [Binding::new(0, BindingKind::ReadWrite)];
    let text = "@compute @workgroup_size(1) fn main() { nonsense(); }";
    let description =
        PipelineDescription { label: "wrong", text, layout: &layout, checked: false, zero_workgroup_memory: false };
    let error = gpu.pipeline(&description).err().unwrap();
    assert!(
        matches!(&error, Error::Device(problem) if problem.contains("nonsense") && !problem.contains('\n')),
        "{error}"
    );
    let job = Job::new(&gpu);
    gpu.run(&job.frame(Submissions::PerPass)).unwrap();
    assert_eq!(gpu.read::<u32>(&job.results, NUMBERS as usize).unwrap(), expected());
}

#[test]
fn the_cpu_times_frames_by_the_wall() {
    let cpu = CpuDevice::new(1).unwrap();
    let mut seen = Vec::new();
    let times = cpu.run_frames(3, |frame| seen.push(frame), &|| false).unwrap();
    assert_eq!(seen, [0, 1, 2]);
    assert!(times.iter().all(|time| time.device_ns.is_none() && time.stages.is_empty()));
    assert!(matches!(cpu.run_frames(3, |_| (), &|| true), Err(Error::Interrupted)));
    assert_eq!(Device::Cpu(cpu).info().device_type.in_words(), "CPU without a driver");
}
