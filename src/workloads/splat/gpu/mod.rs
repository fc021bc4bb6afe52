//! A frame on a Vulkan device: passes over buffers that stay there, and are read back only to be checked.

mod buffers;
pub mod clusters;
mod gather;
mod inputs;
pub mod kernels;
mod passes;
pub mod splatting;
mod steps;
mod uniforms;

pub use kernels::{GROUP_SIZE, Kernel, kernels};
pub use passes::MAX_TESTS;
pub use steps::{Count, Steps, Variant};
pub use uniforms::*;

use super::Stages;
use super::cluster_axes::Sync;
use super::clusters::Clusters;
use super::clusters::setting::{ClusterSetting, HierarchyBy};
use super::gathered::Gathered;
use super::gathering::Gathering;
use super::lit::LitScene;
use super::photons::{Photons, Traced};
use super::samples::Samples;
use super::setting::Setting;
use super::splatting::setting::Gather;
use crate::camera::Camera;
use crate::device::vulkan::{Buffer, Dispatch};
use crate::device::{Frame, FrameTime, Interrupted, KernelInfo, Submissions, VulkanDevice};
use crate::error::{Error, Result};
use crate::workloads::size::Size;
use crate::workloads::trace::gpu::RayCaster;
use crate::workloads::trace::{Method, Structure};
use buffers::{Buffers, Sizes};
use gather::Gatherer;
use glam::Vec4;
use inputs::Inputs;
use passes::Maker;

/// Frames whose cameras are on the device at a time.
const MAX_FRAMES: usize = 256;

/// The stages of a frame, in their order.
pub fn stages(setting: Setting, gather: Gather, clusters: &ClusterSetting) -> Vec<&'static str> {
    let hits = passes::HITS.iter().take(setting.hits as usize).map(|stage| stage.0);
    let mut stages: Vec<&str> = hits.chain(["compaction", "samples", "direct"]).collect();
    if gather.has_clusters() {
        stages.extend(["keys", "unique", "bounds"]);
        stages.extend((clusters.hierarchy == HierarchyBy::Masks).then_some("hierarchy"));
    }
    stages.extend(splatting::stages(gather));
    stages.push("mix");
    stages
}

/// A scene and a structure on a device, with everything that decides a frame but the camera.
pub struct GpuFrame<'a> {
    device: &'a VulkanDevice,
    lit: &'a LitScene,
    setting: Setting,
    gathering: Gathering,
    size: Size,
    sizes: Sizes,
    buffers: Buffers,
    inputs: Inputs,
    steps: Steps<'a>,
    /// Absent for the reference estimate.
    gatherer: Option<Gatherer>,
    /// Bytes of vertices and materials, and of the structure.
    scene_bytes: (u64, u64),
    /// No frame has run since the buffers were poisoned.
    is_poisoned: bool,
}

impl<'a> GpuFrame<'a> {
    /// Uploads a scene and a structure, allocates all buffers and compiles all kernels.
    ///
    /// # Errors
    /// [`Error::Refused`] for what the device cannot bind or walk, and for more slots than photons can have, before
    /// anything is allocated; [`Error::Input`] for fewer paths than lights; the device's.
    pub fn new(
        device: &'a VulkanDevice,
        lit: &'a LitScene,
        structure: &'a dyn Structure,
        method: Method,
        setting: Setting,
        gathering: impl Into<Gathering>,
        size: Size,
    ) -> Result<GpuFrame<'a>> {
        let gathering = gathering.into();
        let sizes = Sizes::new(&setting, size, device.max_binding())?;
        let shares = lit.shares(setting.paths)?;
        Buffers::check(device, &sizes)?;
        let inputs = Inputs::new(device, lit, &shares, setting.falloff)?;
        let caster = RayCaster::new(device, &lit.scene, structure, method)?;
        let buffers = Buffers::new(device, &sizes)?;
        let maker = Maker {
            device,
            caster: &caster,
            lit,
            setting: &setting,
            estimate: &gathering.estimate,
            sizes: &sizes,
            buffers: &buffers,
            inputs: &inputs,
        };
        let mut steps = Steps::new(device);
        let photons = maker.seen(&mut steps)?;
        let gatherer = match gathering.gather {
            Gather::Reference => {
                maker.estimates(&mut steps, &photons)?;
                None
            }
            _ => Some(Gatherer::new(device, &mut steps, &gathering, (&sizes, size), &buffers, &photons)?),
        };
        maker.mix(&mut steps)?;
        let scene_bytes = caster.allocated();
        Ok(GpuFrame {
            device,
            lit,
            setting,
            gathering,
            size,
            sizes,
            buffers,
            inputs,
            steps,
            gatherer,
            scene_bytes,
            is_poisoned: true,
        })
    }

    /// The kernels, each once.
    pub fn kernels(&self) -> Vec<KernelInfo> {
        self.steps.kernels().to_vec()
    }

    /// Name and bytes of each buffer; the scene's and the structure's as one each.
    pub fn buffers(&self) -> Vec<(&'static str, u64)> {
        let mut all = Buffers::bytes(&self.sizes);
        all.extend(self.gatherer.iter().flat_map(Gatherer::bytes));
        all.extend(self.inputs.bytes);
        let scan = self.steps.scan_bytes();
        let (geometry, structure) = self.scene_bytes;
        all.extend([("sums of groups", scan), ("geometry", geometry), ("structure", structure)]);
        all
    }

    /// Renders frames one after another and times each. All buffers are poisoned before, and nothing is read back in
    /// between.
    ///
    /// # Errors
    /// [`Error::Interrupted`] between submissions, or the device's.
    pub fn time(&mut self, cameras: &[Camera], interrupted: Interrupted) -> Result<Vec<FrameTime>> {
        self.poison();
        let mut times = Vec::with_capacity(cameras.len());
        self.is_poisoned = cameras.is_empty();
        for cameras in cameras.chunks(MAX_FRAMES) {
            times.extend(self.run(cameras, |frames| match self.gathering.sync {
                Sync::Device => self.device.run_frames(frames, interrupted),
                Sync::Readback => self.device.run_frames_by_read_back(frames, interrupted),
            })?);
        }
        // One of many frames may have had no room for its photons
        self.gatherer.as_ref().map_or(Ok(()), |gatherer| gatherer.check(self.device))?;
        Ok(times)
    }

    /// Renders a frame into poisoned buffers and reads back everything that it made.
    ///
    /// # Errors
    /// [`Error::Interrupted`] between passes, or the device's.
    pub fn render(&mut self, camera: &Camera, interrupted: Interrupted) -> Result<Stages> {
        self.poison();
        self.is_poisoned = false;
        self.run(std::slice::from_ref(camera), |frames| {
            frames.iter().try_for_each(|frame| self.device.run_until(frame, interrupted).map(drop))
        })?;
        let (slots, buffers) = (self.sizes.slots as usize, &self.buffers);
        let photons = self.photons()?;
        let arrived = self.device.read(&buffers.arrived, self.setting.hits as usize)?;
        let slots =
            self.read_photons([&buffers.slot_positions, &buffers.slot_directions, &buffers.slot_fluxes], slots)?;
        Ok(Stages {
            traced: Traced { slots, arrived },
            photons: self.read_photons([&buffers.positions, &buffers.directions, &buffers.fluxes], photons)?,
            samples: Samples {
                positions: self.image(&buffers.samples)?,
                normals: self.image(&buffers.normals)?,
                albedos: self.image(&buffers.albedos)?,
            },
            direct: self.image(&buffers.direct)?,
            gathered: self.gatherer.as_ref().map_or(Ok(Gathered::default()), |own| own.read(self.device))?,
            irradiance: self.image(&buffers.irradiance)?,
            picture: self.last()?,
        })
    }

    /// The clusters of a view.
    ///
    /// # Errors
    /// [`Error::Device`] for a frame without clusters; [`Error::Interrupted`] between passes; the device's.
    pub fn clusters(&mut self, camera: &Camera, interrupted: Interrupted) -> Result<Clusters> {
        self.is_poisoned = false;
        self.run(std::slice::from_ref(camera), |frames| {
            let is_needed = |stage: &str| ["samples", "keys", "unique", "bounds", "hierarchy"].contains(&stage);
            frames.iter().try_for_each(|frame| {
                let passes = frame.passes.iter().filter(|pass| is_needed(pass.stage.0)).copied().collect();
                self.device.run_until(&Frame { passes, ..frame.clone() }, interrupted).map(drop)
            })
        })?;
        let clusters = self.gatherer.as_ref().map_or(Ok(None), |gatherer| gatherer.clusters(self.device))?;
        clusters.ok_or_else(|| Error::Device("a frame without clusters".into()))
    }

    /// The picture of the last frame, rows from the top.
    ///
    /// # Errors
    /// The device's.
    pub fn last(&self) -> Result<Vec<Vec4>> {
        self.image(&self.buffers.picture)
    }

    /// The number of photons of the last frame.
    ///
    /// # Errors
    /// The device's.
    pub fn photons(&self) -> Result<usize> {
        let scan = self
            .steps
            .scans(passes::COMPACTION)
            .next()
            .ok_or_else(|| Error::Device("a frame without compaction".into()))?;
        Ok((scan.check(self.device)?.min(self.sizes.slots)) as usize)
    }

    /// The numbers of paths of the last frame that reached hit 1, 2, .. `hits`.
    ///
    /// # Errors
    /// The device's.
    pub fn arrived(&self) -> Result<Vec<u32>> {
        self.device.read(&self.buffers.arrived, self.setting.hits as usize)
    }

    fn poison(&mut self) {
        if !self.is_poisoned {
            self.buffers.poison(self.device);
            if let Some(gatherer) = &self.gatherer {
                gatherer.reset(self.device);
            }
            self.is_poisoned = true;
        }
    }

    fn image(&self, buffer: &Buffer) -> Result<Vec<Vec4>> {
        self.device.read(buffer, self.size.pixels())
    }

    fn read_photons(&self, arrays: [&Buffer; 3], count: usize) -> Result<Photons> {
        let [positions, directions, fluxes] = arrays.map(|array| self.device.read(array, count));
        Ok(Photons { positions: positions?, directions: directions?, fluxes: fluxes? })
    }

    /// Uploads cameras and hands their frames over.
    fn run<T>(&self, cameras: &[Camera], work: impl FnOnce(&[Frame<Dispatch>]) -> Result<T>) -> Result<T> {
        let stride = self.device.uniform_stride(size_of::<View>());
        let mut uniforms = vec![0_u8; cameras.len() * stride as usize];
        let mut borders = Borders::default();
        for (place, camera) in uniforms.chunks_exact_mut(stride as usize).zip(cameras) {
            let first_border = borders.of(&self.gathering, camera.field_of_view);
            place[..size_of::<View>()].copy_from_slice(bytemuck::bytes_of(&self.view(camera, first_border)?));
        }
        let views = self.device.uniform("the cameras", &uniforms)?;
        let borders = self.device.storage("the borders of slices", &borders.all)?;
        let bound = self.steps.bind_views(&views, &borders);
        self.device.check()?;
        // A driver's watchdog may end an estimate over very many photons: it alone is divided
        let is_divided = self.gatherer.is_none() && self.steps.count(passes::ESTIMATE) > 1;
        let submissions = if is_divided { Submissions::PerPass } else { Submissions::PerFrame };
        let offsets = (0..cameras.len() as u32).map(|frame| frame * stride);
        let frames: Vec<Frame<Dispatch>> =
            offsets.map(|offset| Frame { passes: self.steps.frame(&bound, offset), submissions }).collect();
        work(&frames)
    }

    fn view(&self, camera: &Camera, first_border: u32) -> Result<View> {
        let Size { width, height } = self.size;
        let grid = camera.pixel_grid(width, height);
        let placement = self.gathering.placement(self.lit, camera);
        Ok(View {
            origin: grid.origin,
            width,
            corner: grid.corner,
            pixels: self.sizes.pixels,
            right: grid.right,
            row_groups: self.device.groups_for(self.sizes.pixels.into(), GROUP_SIZE)?.0,
            down: grid.down,
            epsilon: self.lit.epsilon(),
            forward: camera.direction,
            first_border,
            axis_x: placement.axes[0],
            height,
            axis_y: placement.axes[1],
            pad0: 0,
            axis_z: placement.axes[2],
            pad1: 0,
            axes_origin: placement.origin,
            margin: placement.margin,
        })
    }
}

/// Borders of slices for the fields of view of some cameras.
#[derive(Default)]
struct Borders {
    all: Vec<f32>,
    /// Bits of each field of view, and where its borders begin.
    known: Vec<(u32, u32)>,
}

impl Borders {
    /// Where the borders for a field of view in degrees begin; 0 without clusters.
    fn of(&mut self, gathering: &Gathering, field_of_view: f32) -> u32 {
        let Some(layout) = &gathering.layout else { return 0 };
        if let Some((_, first)) = self.known.iter().find(|(bits, _)| *bits == field_of_view.to_bits()) {
            return *first;
        }
        let first = self.all.len() as u32;
        self.all.extend(layout.borders(field_of_view));
        self.known.push((field_of_view.to_bits(), first));
        first
    }
}
