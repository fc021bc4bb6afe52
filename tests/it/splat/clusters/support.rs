//! Views of made-up samples, and frames of clusters.

use glam::{Vec3, Vec4};
use rtbench::camera::Camera;
use rtbench::device::vulkan::{Binding, BindingKind, Buffer, Dispatch, Groups, PipelineDescription};
use rtbench::device::{CpuDevice, Frame, Pass, Stage, VulkanDevice};
use rtbench::math::Aabb;
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::clusters::setting::ClusterSetting;
use rtbench::workloads::splat::clusters::{self, Clusters, KeyLayout, Placement};
use rtbench::workloads::splat::gpu::clusters::{self as passes, ClusterBuffers, ClusterCount, ClusterSizes};
use rtbench::workloads::splat::gpu::{GROUP_SIZE, Steps, View};
use rtbench::workloads::splat::samples::Samples;

/// Nearest and farthest depth of a slice.
pub const DEPTHS: (f32, f32) = (0.05, 500.0);

/// Closer together, so that keys of small tiles of a large image fit.
pub const FEW_DEPTHS: (f32, f32) = (1.0, 10.0);

pub const CAMERA: Camera =
    Camera { position: Vec3::new(3.0, -2.0, 7.5), direction: Vec3::NEG_X, up: Vec3::Y, field_of_view: 60.0 };

/// A camera that looks along no axis.
pub fn slanted() -> Camera {
    Camera { direction: Vec3::new(0.48, -0.6, 0.64).normalize(), field_of_view: 75.0, ..CAMERA }
}

/// A camera whose slices are as thin at any height of the image as they are at 1080 rows.
pub fn narrow(height: u32) -> Camera {
    let half = (30.0_f32.to_radians().tan() * height as f32 / 1080.0).atan();
    Camera { field_of_view: 2.0 * half.to_degrees(), ..CAMERA }
}

/// What a view sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scene {
    /// Any depth, beyond those of slices too, or nothing.
    Random(u32),
    /// One depth and one normal everywhere.
    Equal,
    /// For tiles of 8, [`FEW_DEPTHS`] and [`narrow`]: each pixel of a tile in a slice of its own.
    Different,
    /// Nothing.
    Empty,
    /// Waves, with nothing in places.
    Waves,
}

/// A number in [0, 1) for two words.
pub fn random(index: u32, of: u32) -> f32 {
    let mut word = index.wrapping_mul(747_796_405) ^ of.wrapping_mul(2_891_336_453).wrapping_add(97);
    for shift in [16, 13, 17] {
        word = (word ^ (word >> shift)).wrapping_mul(2_246_822_519);
    }
    (word >> 8) as f32 / (1 << 24) as f32
}

fn depth(scene: Scene, layout: &KeyLayout, borders: &[f32], pixel: u32) -> f32 {
    let (x, y) = (pixel % layout.size.width, pixel / layout.size.width);
    match scene {
        Scene::Random(seed) if random(pixel, seed) < 0.1 => 0.0,
        Scene::Random(seed) => 0.02 * 5e4_f32.powf(random(pixel, seed + 1)),
        Scene::Equal => 5.0,
        Scene::Different => borders[(4 * (y % 8 * 8 + x % 8)) as usize] * 1.001,
        Scene::Empty => 0.0,
        Scene::Waves if (x / 5 + y / 7) % 4 == 0 => 0.0,
        Scene::Waves => 4.0 + 3.0 * (x as f32 * 0.07).sin() * (y as f32 * 0.05).cos() + 0.02 * y as f32,
    }
}

/// Samples of a scene as a camera sees it.
pub fn samples_of(scene: Scene, camera: &Camera, layout: &KeyLayout) -> Samples {
    let grid = camera.pixel_grid(layout.size.width, layout.size.height);
    let borders = layout.borders(camera.field_of_view);
    let mut samples = Samples::default();
    for pixel in 0..layout.size.pixels() as u32 {
        let depth = depth(scene, layout, &borders, pixel);
        let (x, y) = ((pixel % layout.size.width) as f32, (pixel / layout.size.width) as f32);
        let way = grid.corner + grid.right * (x + 0.5) + grid.down * (y + 0.5);
        let point = grid.origin + way * (depth / way.dot(camera.direction));
        let turned = Vec3::new(random(pixel, 5), random(pixel, 6), random(pixel, 7)) - 0.5;
        let normal = if scene == Scene::Equal { Vec3::Z } else { (turned + 0.001).normalize() };
        let is_there = depth > 0.0;
        samples.positions.push(if is_there { point.extend(depth) } else { Vec4::ZERO });
        samples.normals.push(if is_there { normal.extend(0.0) } else { Vec4::ZERO });
        samples.albedos.push(Vec4::ZERO);
    }
    samples
}

pub fn layout(setting: &ClusterSetting, width: u32, height: u32, depths: (f32, f32)) -> KeyLayout {
    KeyLayout::new(setting, Size { width, height }, 60.0, depths).unwrap()
}

pub fn placement(setting: &ClusterSetting, camera: &Camera) -> Placement {
    let extent = Aabb { min: Vec3::splat(-40.0), max: Vec3::splat(60.0) };
    Placement::new(setting.space, camera, extent)
}

/// Clusters of the twins.
pub fn on_cpu(
    cpu: &CpuDevice,
    setting: &ClusterSetting,
    layout: &KeyLayout,
    camera: &Camera,
    samples: &Samples,
) -> Clusters {
    clusters::build(cpu.pool(), setting, layout, &placement(setting, camera), camera.field_of_view, samples)
}

/// Passes of clusters over buffers for samples.
pub struct Passes<'d> {
    device: &'d VulkanDevice,
    setting: ClusterSetting,
    layout: KeyLayout,
    samples: [Buffer; 2],
    pub buffers: ClusterBuffers,
    count: ClusterCount,
    pub steps: Steps<'d>,
}

const COPY: &str = "
@group(0) @binding(0) var<storage, read> from_words: array<u32>;
@group(0) @binding(1) var<storage, read_write> to_words: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < arrayLength(&from_words); i += 65536u) {
        to_words[i] = from_words[i];
    }
}
";

impl<'d> Passes<'d> {
    pub fn new(device: &'d VulkanDevice, setting: &ClusterSetting, layout: &KeyLayout) -> Passes<'d> {
        let bytes = layout.size.pixels() as u64 * 16;
        let samples = [(); 2].map(|()| device.poisoned("the samples", bytes).unwrap());
        let sizes = ClusterSizes::new(setting, layout, layout.size.pixels() as u32);
        ClusterBuffers::check(device, &sizes).unwrap();
        let buffers = ClusterBuffers::new(device, &sizes).unwrap();
        let mut steps = Steps::new(device);
        let [positions, normals] = &samples;
        let count =
            passes::steps(&mut steps, device, setting, layout, layout.size, positions, normals, &buffers).unwrap();
        device.check().unwrap();
        Passes { device, setting: *setting, layout: layout.clone(), samples, buffers, count, steps }
    }

    fn load(&self, samples: &Samples) {
        let device = self.device;
        let layout = [Binding::new(0, BindingKind::Read), Binding::new(1, BindingKind::ReadWrite)];
        let (label, text) = ("copy", COPY);
        let description =
            PipelineDescription { label, text, layout: &layout, checked: false, zero_workgroup_memory: false };
        let pipeline = device.pipeline(&description).unwrap();
        for (to, array) in self.samples.iter().zip([&samples.positions, &samples.normals]) {
            // Shorter buffers do not exist
            let mut all = array.clone();
            all.resize(all.len().max(6), Vec4::ZERO);
            let from = device.storage("the samples", &all).unwrap();
            let bindings = device.bind(&pipeline, &[(0, (&from).into()), (1, to.into())]);
            let groups = Groups::Fixed(1024, 1, 1);
            let work = Dispatch { pipeline: &pipeline, bindings: &bindings, offset: None, groups };
            device.run(&Frame::new(vec![Pass { stage: Stage("copy"), work }])).unwrap();
        }
    }

    fn view(&self, camera: &Camera) -> View {
        let Size { width, height } = self.layout.size;
        let grid = camera.pixel_grid(width, height);
        let placement = placement(&self.setting, camera);
        let pixels = width * height;
        View {
            origin: grid.origin,
            width,
            corner: grid.corner,
            pixels,
            right: grid.right,
            row_groups: self.device.groups_for(pixels.into(), GROUP_SIZE).unwrap().0,
            down: grid.down,
            epsilon: 0.0,
            forward: camera.direction,
            first_border: 3,
            axis_x: placement.axes[0],
            height,
            axis_y: placement.axes[1],
            pad0: 0,
            axis_z: placement.axes[2],
            pad1: 0,
            axes_origin: placement.origin,
            margin: placement.margin,
        }
    }

    /// Runs a frame and reads its clusters.
    pub fn frame(&self, camera: &Camera, samples: &Samples) -> Clusters {
        self.load(samples);
        let device = self.device;
        let views = device.uniform("the camera", &[self.view(camera)]).unwrap();
        // The borders of another camera come first
        let borders = [vec![1e30; 3], self.layout.borders(camera.field_of_view)].concat();
        let bound = self.steps.bind_views(&views, &device.storage("the borders", &borders).unwrap());
        device.check().unwrap();
        device.run(&Frame::new(self.steps.frame(&bound, 0))).unwrap();
        let pixels = self.layout.size.pixels();
        let clusters = passes::read(device, &self.buffers, &self.count, &self.layout, &self.setting, pixels).unwrap();
        let state: Vec<u32> = device.read(&self.count.state, 8).unwrap();
        let groups = clusters.len().div_ceil(GROUP_SIZE as usize) as u32;
        assert_eq!(state, [clusters.len() as u32, 0, 0, 0, groups, u32::from(groups > 0), 1, 0]);
        let found: Vec<Vec4> = device.read(&self.buffers.placement, 4).unwrap();
        let expected = placement(&self.setting, camera);
        assert_eq!(found[3], expected.origin.extend(expected.margin));
        assert_eq!(found[..3], expected.axes.map(|axis| axis.extend(0.0)));
        clusters
    }
}

/// The first array in which clusters differ in a bit.
pub fn difference(a: &Clusters, b: &Clusters) -> Option<String> {
    let bits = |all: &[Vec4]| -> Vec<u32> { all.iter().flat_map(|v| v.to_array().map(f32::to_bits)).collect() };
    let words = |all: &[clusters::Bounds]| -> Vec<u32> { all.iter().flat_map(|bounds| bounds.words()).collect() };
    let first = |name: &str, a: &[u32], b: &[u32]| {
        if a.len() != b.len() {
            return Some(format!("{name}: {} and {} words", a.len(), b.len()));
        }
        let at = (0..a.len()).find(|&at| a[at] != b[at])?;
        Some(format!("{name}: word {at} of {}: {} and {}", a.len(), a[at], b[at]))
    };
    let nodes = || match (&a.nodes, &b.nodes) {
        (None, None) => None,
        (Some(a), Some(b)) => {
            let masks = first("masks", &a.masks, &b.masks);
            masks.or_else(|| first("boxes of nodes", &words(&a.boxes), &words(&b.boxes)))
        }
        _ => Some("one has nodes".to_owned()),
    };
    first("positions", &bits(&a.positions), &bits(&b.positions))
        .or_else(|| first("keys", &a.keys, &b.keys))
        .or_else(|| first("keys of clusters", &a.cluster_keys, &b.cluster_keys))
        .or_else(|| first("identifiers", &a.identifiers, &b.identifiers))
        .or_else(|| first("boxes", &words(&a.boxes), &words(&b.boxes)))
        .or_else(nodes)
}
