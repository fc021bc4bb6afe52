//! Samples, photons and clusters by the twins; the passes of a technique over them on a device.

use super::super::frames::{self, camera_of, closed_box, estimate, light_at, lit, on_cpu};
use glam::{Vec3, Vec4};
use rayon::ThreadPool;
use rtbench::camera::Camera;
use rtbench::device::{CpuDevice, Frame, VulkanDevice};
use rtbench::scene::{self, Scene};
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::Stages;
use rtbench::workloads::splat::clusters::setting::{ClusterSetting, HierarchyBy, Space, Unique};
use rtbench::workloads::splat::clusters::{self, Clusters, KeyLayout, Placement};
use rtbench::workloads::splat::gpu::clusters::{ClusterBuffers, ClusterCount, ClusterSizes};
use rtbench::workloads::splat::gpu::splatting::{
    Clustered, Inputs, Needs, SplatBuffers, SplatSizes, SplatState, steps,
};
use rtbench::workloads::splat::gpu::{GROUP_SIZE, Steps, View};
use rtbench::workloads::splat::lit::LitScene;
use rtbench::workloads::splat::setting::{Estimate, Setting};
use rtbench::workloads::splat::splatting::setting::{Atomics, BucketSetting, Gather};
use rtbench::workloads::splat::splatting::walk::Walk;
use rtbench::workloads::splat::splatting::{Buckets, Lists, blur, buckets, lists, per_sample, tiled};
use std::sync::LazyLock;

/// Never.
pub const ON: &dyn Fn() -> bool = &|| false;

/// Threads of all tests here.
pub static DEVICE: LazyLock<CpuDevice> = LazyLock::new(|| CpuDevice::new(0).unwrap());

pub fn pool() -> &'static ThreadPool {
    DEVICE.pool()
}

/// A view with its photons.
pub struct Given {
    pub lit: LitScene,
    pub camera: Camera,
    pub size: Size,
    pub stages: Stages,
    pub estimate: Estimate,
}

/// A view of a scene with two lights; the radius is a share of the diagonal.
pub fn given(scene: Scene, camera: Camera, size: Size, paths: u32, share: f32) -> Given {
    let lights = [
        light_at(&scene, [0.45, 0.6, 0.55], Vec3::new(5.0, 4.0, 3.0)),
        light_at(&scene, [0.7, 0.8, 0.3], Vec3::new(0.5, 1.0, 2.0)),
    ];
    let lit = lit(scene, &lights);
    let estimate = estimate(&lit, share);
    let setting = Setting { paths, ..frames::SETTING };
    let stages = on_cpu(&DEVICE, &lit, "bvh", (setting, estimate, size), &camera);
    Given { lit, camera, size, stages, estimate }
}

/// The closed box, from inside.
pub fn boxed(share: f32) -> Given {
    let direction = Vec3::new(-0.35, -0.15, -1.0).normalize();
    let camera = Camera { position: Vec3::new(0.4, 0.3, 0.8), direction, up: Vec3::Y, field_of_view: 75.0 };
    given(closed_box(), camera, Size { width: 67, height: 45 }, 700, share)
}

/// A room with spheres and pillars.
pub fn room(share: f32) -> Given {
    let scene = scene::load("room:triangles=20000").unwrap();
    let camera = camera_of(&scene);
    given(scene, camera, Size { width: 96, height: 54 }, 500, share)
}

/// Clusters of a view, and what they were made with.
pub struct Grouped {
    pub setting: ClusterSetting,
    pub layout: KeyLayout,
    pub placement: Placement,
    pub clusters: Clusters,
}

impl Given {
    pub fn grouped(&self, setting: ClusterSetting) -> Grouped {
        let diagonal = self.lit.diagonal();
        let angle = self.camera.field_of_view;
        let layout = KeyLayout::new(&setting, self.size, angle, (diagonal / 2000.0, diagonal * 5.0)).unwrap();
        let placement = self.placement(setting.space);
        let clusters = clusters::build(pool(), &setting, &layout, &placement, angle, &self.stages.samples);
        assert!(clusters.len() > 2, "{}", clusters.len());
        Grouped { setting, layout, placement, clusters }
    }

    pub fn placement(&self, space: Space) -> Placement {
        Placement::new(space, &self.camera, self.lit.extent)
    }

    pub fn with(&self, estimate: Estimate) -> Given {
        Given { lit: self.lit.clone(), stages: self.stages.clone(), estimate, ..*self }
    }
}

impl Grouped {
    pub fn walk(&self, radius: f32, level: u32) -> Walk<'_> {
        Walk::new(&self.clusters, &self.layout, &self.placement, radius, level).unwrap()
    }
}

/// What a technique made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Made {
    pub lists: Lists,
    pub buckets: Buckets,
    pub irradiance: Vec<Vec4>,
}

/// By the twins.
pub fn by_twins(given: &Given, grouped: &Grouped, gather: Gather, tile: u32) -> Made {
    let (samples, photons, estimate) = (&given.stages.samples, &given.stages.photons, &given.estimate);
    let mut made = Made::default();
    match gather {
        Gather::Reference => made.irradiance = given.stages.irradiance.clone(),
        Gather::Tiled => {
            let placement = given.placement(Space::View);
            let of = (given.size, tile);
            made.irradiance = tiled::irradiance(pool(), samples, of, &placement, photons, estimate, ON).unwrap();
        }
        Gather::PerSample { .. } => {
            made.lists = lists::lists(pool(), &grouped.walk(estimate.radius, 5), photons).unwrap();
            let of = (samples, &grouped.clusters.identifiers[..]);
            made.irradiance = per_sample::irradiance(pool(), of, &made.lists, photons, estimate, ON).unwrap();
        }
        Gather::Buckets(setting) => {
            let walk = grouped.walk(estimate.radius, setting.level);
            let found = lists::lists(pool(), &walk, photons).unwrap();
            made.buckets = buckets::fill(pool(), &walk, &found, photons, &setting, estimate);
            made.irradiance = read(given, grouped, &made.buckets, &setting);
        }
    }
    made
}

/// Irradiance from buckets by the twins.
pub fn read(given: &Given, grouped: &Grouped, found: &Buckets, setting: &BucketSetting) -> Vec<Vec4> {
    let (samples, of) = (&given.stages.samples, (setting, &given.estimate));
    let sharp = buckets::irradiance(pool(), samples, &grouped.clusters, found, of, ON).unwrap();
    match setting.blur {
        0 => sharp,
        deviation => blur::blurred(pool(), samples, given.size, &sharp, deviation, ON).unwrap(),
    }
}

/// Room for lists and buckets.
#[derive(Clone, Copy, Debug)]
pub struct Room {
    pub entries: u32,
    pub clusters: u32,
    /// Entries that are allocated, and must not be touched, beyond the others.
    pub spare: u32,
}

pub const ROOM: Room = Room { entries: 1 << 21, clusters: 10_000, spare: 0 };

/// What ran on a device.
pub struct Ran {
    pub made: Made,
    pub needs: Needs,
    pub sizes: SplatSizes,
    /// The words beyond the room for entries.
    pub spare: Vec<u32>,
}

fn uploaded(gpu: &VulkanDevice, given: &Given, grouped: &Grouped) -> (ClusterBuffers, ClusterCount) {
    let Grouped { setting, layout, placement, clusters } = grouped;
    let sizes = ClusterSizes::new(setting, layout, given.size.pixels() as u32);
    let mut buffers = ClusterBuffers::new(gpu, &sizes).unwrap();
    let [x, y, z] = placement.axes.map(|axis| axis.extend(0.0));
    let axes = [x, y, z, placement.origin.extend(placement.margin)];
    buffers.placement = gpu.storage("axes", &axes).unwrap();
    buffers.identifiers = gpu.storage("identifiers", &clusters.identifiers).unwrap();
    buffers.cluster_keys = gpu.storage("keys of clusters", &clusters.cluster_keys).unwrap();
    let words: Vec<[u32; 6]> = clusters.boxes.iter().map(|bounds| bounds.words()).collect();
    buffers.boxes = gpu.storage("boxes", &words).unwrap();
    if let Some(nodes) = &clusters.nodes {
        buffers.masks = gpu.storage("masks", &nodes.masks).unwrap();
        let words: Vec<[u32; 6]> = nodes.boxes.iter().map(|bounds| bounds.words()).collect();
        buffers.node_boxes = gpu.storage("boxes of nodes", &words).unwrap();
        let places: Vec<u32> = match setting.unique {
            Unique::Bits => {
                let mut before = 0;
                let last = &nodes.masks[layout.level_offset(4) as usize..];
                let mut place = |mask: &u32| {
                    before += mask.count_ones();
                    before - mask.count_ones()
                };
                last.iter().map(&mut place).collect()
            }
            _ => {
                let mut places = vec![0x00c0_ffee_u32; 1 << layout.key_bits()];
                (0..).zip(&clusters.cluster_keys).for_each(|(number, &key)| places[key as usize] = number);
                places
            }
        };
        buffers.places = gpu.storage("places", &places).unwrap();
    }
    assert!(setting.hierarchy == HierarchyBy::None || clusters.nodes.is_some());
    let count = clusters.len() as u32;
    let groups = count.div_ceil(GROUP_SIZE);
    let state = gpu.indirect("the number of clusters", &[count, 0, 0, 0, groups, 1, 1, 0]).unwrap();
    (buffers, ClusterCount { state })
}

/// Passes of a technique on a device, ready to run.
pub struct OnDevice<'a> {
    gpu: &'a VulkanDevice,
    given: &'a Given,
    grouped: &'a Grouped,
    gather: Gather,
    steps: Steps<'a>,
    state: SplatState,
    sizes: SplatSizes,
    buffers: SplatBuffers,
    irradiance: rtbench::device::vulkan::Buffer,
    room: Room,
}

impl<'a> OnDevice<'a> {
    pub fn new(
        gpu: &'a VulkanDevice,
        given: &'a Given,
        grouped: &'a Grouped,
        (gather, tile): (Gather, u32),
        room: Room,
    ) -> rtbench::error::Result<OnDevice<'a>> {
        let Stages { samples, photons, .. } = &given.stages;
        let (of_clusters, count) = uploaded(gpu, given, grouped);
        let pixels = given.size.pixels() as u32;
        // A slot more than photons, whose contents nothing may use
        let slots = photons.len() as u32 + 1;
        let photon_array = |what: &str, all: &[Vec4]| {
            gpu.storage(what, &[all, &[Vec4::splat(f32::from_bits(0xffc0_dead))]].concat()).unwrap()
        };
        let positions = photon_array("positions", &photons.positions);
        let directions = photon_array("directions", &photons.directions);
        let fluxes = photon_array("fluxes", &photons.fluxes);
        let photons = gpu.storage("the number of photons", &[photons.len() as u32, 0]).unwrap();
        let normals = gpu.storage("normals", &samples.normals).unwrap();
        let samples = gpu.storage("samples", &samples.positions).unwrap();
        let irradiance = gpu.poisoned("irradiance", u64::from(pixels) * 16).unwrap();
        let most = (pixels.min(1 << grouped.layout.key_bits()), room.entries, room.clusters);
        let sizes = SplatSizes::new(gather, Some(&grouped.layout), pixels, most);
        SplatBuffers::check(gpu, &sizes)?;
        let larger = SplatSizes { entries: sizes.entries + room.spare, ..sizes };
        let buffers = SplatBuffers::new(gpu, &larger).unwrap();
        let clusters =
            Clustered { buffers: &of_clusters, count: &count, layout: &grouped.layout, setting: &grouped.setting };
        let inputs = Inputs {
            samples: &samples,
            normals: &normals,
            positions: &positions,
            directions: &directions,
            fluxes: &fluxes,
            photons: &photons,
            irradiance: &irradiance,
            clusters: Some(clusters),
            slots,
            size: given.size,
            tile,
            gather,
            estimate: given.estimate,
        };
        let mut all = Steps::new(gpu);
        let state = steps(&mut all, gpu, &inputs, (&sizes, &buffers))?;
        gpu.check().unwrap();
        Ok(OnDevice { gpu, given, grouped, gather, steps: all, state, sizes, buffers, irradiance, room })
    }

    pub fn poison(&self) {
        self.buffers.poison(self.gpu);
        self.gpu.poison(&self.irradiance);
    }

    pub fn run(&self) -> Ran {
        let OnDevice { gpu, given, grouped, sizes, buffers, .. } = self;
        let Size { width, height } = given.size;
        let placement = given.placement(Space::View);
        let pixels = given.size.pixels() as u32;
        let mut view: View = bytemuck::Zeroable::zeroed();
        (view.width, view.height, view.pixels) = (width, height, pixels);
        [view.axis_x, view.axis_y, view.axis_z] = placement.axes;
        (view.axes_origin, view.margin) = (placement.origin, placement.margin);
        let views = gpu.uniform("the camera", &[view]).unwrap();
        let borders = gpu.storage("borders", &[0.0_f32]).unwrap();
        let bound = self.steps.bind_views(&views, &borders);
        gpu.check().unwrap();
        gpu.run(&Frame::new(self.steps.frame(&bound, 0))).unwrap();
        let mut made = Made { irradiance: gpu.read(&self.irradiance, pixels as usize).unwrap(), ..Made::default() };
        let clusters = grouped.clusters.len() as u32;
        match self.gather {
            Gather::PerSample { .. } => made.lists = self.state.lists(gpu, sizes, buffers, clusters).unwrap(),
            Gather::Buckets(BucketSetting { atomics, level, .. }) => {
                let count = if level < 5 { grouped.layout.level_nodes(level) } else { clusters };
                let of = (count, atomics == Atomics::Fixed);
                made.buckets = self.state.buckets(gpu, sizes, buffers, of).unwrap();
            }
            _ => {}
        }
        let all: Vec<u32> = match self.room.spare {
            0 => Vec::new(),
            spare => gpu.read(&buffers.entries, (sizes.entries + spare) as usize).unwrap(),
        };
        let spare = all.get(sizes.entries as usize..).unwrap_or_default().to_vec();
        Ran { made, needs: self.state.needs(gpu).unwrap(), sizes: *sizes, spare }
    }

    pub fn reset(&self) {
        self.state.reset(self.gpu);
    }
}
